//! The drape test of Cusick (1968; BS 5058) with taut's disc, beside pictures of real fabrics: a disc of 15 cm radius on a
//! pedestal of 9 cm.

mod disc;
mod photos;
mod silhouette;

use serde::Serialize;

pub use disc::{Disc, Draped};
pub use photos::Photos;
pub use silhouette::{Silhouette, SilhouetteError};

use crate::scene::PEDESTAL;

/// Radius of the disc in m.
pub const DISC_M: f32 = 0.15;

/// Radius of the pedestal in m.
pub const PEDESTAL_M: f32 = PEDESTAL * DISC_M;

/// What is measured of some drapes of one fabric.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Statistics {
    /// How many drapes.
    pub count: usize,
    /// Mean drape coefficient.
    pub mean: f64,
    /// Its standard deviation.
    pub std: f64,
    /// Mean number of folds of the outline.
    pub nodes: f64,
}

impl Statistics {
    /// Of some silhouettes. Not a number for none.
    pub fn of<'a>(silhouettes: impl IntoIterator<Item = &'a Silhouette>) -> Statistics {
        let all: Vec<(f64, f64)> = silhouettes.into_iter().map(|s| (s.drape_coefficient(), s.nodes() as f64)).collect();
        let n = all.len() as f64;
        let mean = all.iter().map(|a| a.0).sum::<f64>() / n;
        let variance = all.iter().map(|a| (a.0 - mean).powi(2)).sum::<f64>() / n;
        Statistics { count: all.len(), mean, std: variance.sqrt(), nodes: all.iter().map(|a| a.1).sum::<f64>() / n }
    }
}

/// Bending rigidities that a fit looks at, in N m: from thinner than silk to card.
const RIGIDITIES: [f64; 2] = [1e-7, 1e-2];

/// The rigidity in N m at which `measure` gives a drape coefficient, to within `tolerance`, in at most `most` measurements;
/// with the coefficient that was reached. `measure` rises with the rigidity. Regula falsi (Illinois) in the logarithm.
pub fn fit<E>(
    coefficient: f64,
    start_n_m: f64,
    tolerance: f64,
    most: usize,
    mut measure: impl FnMut(f64) -> Result<f64, E>,
) -> Result<(f64, f64), E> {
    let [lowest, highest] = RIGIDITIES.map(f64::ln);
    let at = start_n_m.ln().clamp(lowest, highest);
    let mut best = (at, measure(at.exp())?);
    // steps of a factor 3 until the coefficient lies between two rigidities
    let mut bracket: [Option<(f64, f64)>; 2] = [None, None];
    let mut last = None;
    for i in 1..most {
        let miss = best.1 - coefficient;
        if miss.abs() <= tolerance {
            break;
        }
        let next = match bracket {
            [Some(low), Some(high)] => {
                let share = (low.1 / (low.1 - high.1)).clamp(0.05, 0.95);
                low.0 + (high.0 - low.0) * share
            }
            _ if i == 1 => at - 3f64.ln() * miss.signum(),
            [Some(low), None] => low.0 + 3f64.ln(),
            [None, Some(high)] => high.0 - 3f64.ln(),
            [None, None] => at,
        };
        if i == 1 {
            bracket[usize::from(miss > 0.0)] = Some((at, miss));
        }
        if !(lowest..=highest).contains(&next) {
            break;
        }
        let found = measure(next.exp())?;
        let off = found - coefficient;
        let side = usize::from(off > 0.0);
        // an end that stays twice counts half, so that it does not stay for ever
        if last == Some(side)
            && let Some(end) = &mut bracket[1 - side]
        {
            end.1 *= 0.5;
        }
        last = Some(side);
        bracket[side] = Some((next, off));
        if off.abs() < (best.1 - coefficient).abs() {
            best = (next, found);
        }
    }
    Ok((best.0.exp(), best.1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fit_finds_the_rigidity() {
        // the coefficient over the rigidity as measured of a light cotton, roughly
        let drape = |d: f64| 1.0 / (1.0 + (3e-5 / d).powf(0.7));
        for coefficient in [0.1, 0.3, 0.5, 0.8, 0.95] {
            for start in [1e-6, 3e-5, 1e-3] {
                let mut count = 0;
                let (d, reached) = fit::<()>(coefficient, start, 0.005, 16, |d| {
                    count += 1;
                    Ok(drape(d))
                })
                .unwrap();
                assert!((reached - coefficient).abs() <= 0.005, "{coefficient} from {start}: {reached}");
                assert!((drape(d) - reached).abs() < 1e-12 && count <= 16);
            }
        }
        // out of reach: the nearest there is
        let (d, _) = fit::<()>(2.0, 1e-5, 0.01, 20, |d| Ok(drape(d))).unwrap();
        assert!(d > 3e-3 && d <= 1e-2);
        assert_eq!(fit(0.5, 1e-5, 0.01, 20, |_| Err("no")), Err("no"));
    }

    #[test]
    fn statistics_of_two_discs() {
        let [a, b] = [1.0f32, 0.8].map(|s| Silhouette::of_disc(move |x, z| [x * s, 0.0, z * s]));
        let s = Statistics::of([&a, &b]);
        let low = (0.64 * 0.0225 - 0.0081) / (0.0225 - 0.0081);
        assert!((s.mean - 0.5 * (1.0 + low)).abs() < 0.01 && (s.std - 0.5 * (1.0 - low)).abs() < 0.01, "{s:?}");
        assert_eq!((s.count, s.nodes), (2, 0.0));
        assert!(Statistics::of([]).mean.is_nan());
    }
}
