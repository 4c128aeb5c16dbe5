//! The period of a swing at 30 to 240 frames per second, beside that of the hanging chain.

use serde::Serialize;
use taut::{Cloth, ClothDef, Error, GridDef, Vector3};

use super::rates::{Kind, RATES_HZ};
use super::with_cloth;
use crate::scene::Scene;

/// Particles of a side.
const SIDE: u32 = 16;

/// First zero of the Bessel function J0.
pub(super) const J0_ZERO: f64 = 2.404_825_557_695_773;

/// Side-ways at the lower edge at the start, in m: small, so that the swing is linear.
const AMPLITUDE_M: f64 = 0.05;

/// Half swings that are timed.
const HALVES: usize = 8;

/// A swing at one rate.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Swing {
    /// Fabric and solver.
    pub kind: Kind,
    /// Frames per second.
    pub rate_hz: f32,
    /// Mean period of the lowest small swing of the hanging sheet in s.
    pub period_s: f64,
    /// The period of a chain of as many links that do not stretch, in s: the closed form.
    pub chain_s: f64,
    /// From letting it go from level (scene swing) to its passing below the edge, in s.
    pub fall_s: f64,
}

/// omega^2 = (g / l) x with x the smallest zero of the Laguerre polynomial L_n, for n masses on n links of length l (Bernoulli
/// 1733); x = j^2 / (4 n + 2) to the order of n^-3 (Tricomi), with j the first zero of J0.
fn chain_period_s(links: u32, length_m: f64) -> f64 {
    let n = f64::from(links);
    let omega2 = 9.81 * n / length_m * J0_ZERO * J0_ZERO / (4.0 * n + 2.0);
    std::f64::consts::TAU / omega2.sqrt()
}

/// J0 by its series, exact enough for arguments up to 3.
pub(super) fn j0(x: f64) -> f64 {
    let q = -0.25 * x * x;
    let mut term = 1.0;
    (1..20).fold(1.0, |sum, k| {
        term *= q / f64::from(k * k);
        sum + term
    })
}

/// Times the swing of a fabric at every rate.
pub fn swings(kind: Kind) -> Result<Vec<Swing>, Error> {
    let grid = GridDef { rows: SIDE, columns: SIDE, ..GridDef::default() };
    let row = |rate_hz: f32| {
        let def = ClothDef { damping_per_s: 0.0, ..kind.def(rate_hz) };
        let cloth = |scene: Scene, work: &dyn Fn(&mut Cloth<'_>) -> Result<f64, Error>| {
            with_cloth(&grid, &scene.fit(&def, SIDE as usize, SIDE as usize), |cloth| {
                cloth.set_stiffness_uniform(kind.stiffness())?;
                scene.set_up(cloth, 0)?;
                work(cloth)
            })
        };
        Ok(Swing {
            kind,
            rate_hz,
            period_s: cloth(Scene::Edge, &|c| small_swing(c, kind, rate_hz))?,
            chain_s: chain_period_s(SIDE - 1, 1.0),
            fall_s: cloth(Scene::Swing, &|c| fall(c, rate_hz))?,
        })
    };
    RATES_HZ.into_iter().map(row).collect()
}

/// Mean of one coordinate of all particles.
fn mean(cloth: &Cloth<'_>, axis: usize) -> Result<f64, Error> {
    let n = cloth.grid().particles();
    let sum: f64 = (0..n).map(|i| cloth.position(i).map(|p| f64::from(p[axis]))).sum::<Result<f64, Error>>()?;
    Ok(sum / n as f64)
}

/// When in s, counted from now, `height` passes zero for the n-th time, linear between frames; NaN after a minute.
fn crossings(
    cloth: &mut Cloth<'_>,
    rate_hz: f32,
    wanted: usize,
    height: impl Fn(&Cloth<'_>) -> Result<f64, Error>,
) -> Result<Vec<f64>, Error> {
    let dt = 1.0 / f64::from(rate_hz);
    let (mut times, mut last) = (Vec::new(), height(cloth)?);
    for frame in 0..(60.0 * rate_hz) as u32 {
        cloth.step()?;
        let now = height(cloth)?;
        if last * now < 0.0 {
            times.push(dt * (f64::from(frame) + last / (last - now)));
        }
        if times.len() == wanted {
            return Ok(times);
        }
        last = now;
    }
    times.resize(wanted, f64::NAN);
    Ok(times)
}

/// Hung in its stretched equilibrium and put out of its plane in the shape of the lowest swing.
fn small_swing(cloth: &mut Cloth<'_>, kind: Kind, rate_hz: f32) -> Result<f64, Error> {
    let (m, n) = (SIDE as usize, SIDE as usize);
    let rest = 1.0 / f64::from(SIDE - 1);
    // where springs at the border or the pins are cut otherwise, it starts a little off its equilibrium
    let k = f64::from(kind.stiffness()[0]) * f64::from(1.0 - cloth.budget()?.cut_fraction);
    let stretch = f64::from(cloth.particle_mass_kg()) * 9.81 / k;
    let mut y = 0.0;
    for row in 0..m {
        let below = 1.0 - row as f64 / (m - 1) as f64;
        let out = AMPLITUDE_M * j0(J0_ZERO * below.sqrt());
        for column in 0..n {
            let at = cloth.position(row * n + column)?;
            let out = if row == 0 { 0.0 } else { out as f32 };
            cloth.set_position(row * n + column, Vector3::new(at.x, y as f32, out))?;
        }
        // the next spring carries the rows below it
        y -= rest + (m - 1 - row) as f64 * stretch;
    }
    let times = crossings(cloth, rate_hz, HALVES + 1, |c| mean(c, 2))?;
    Ok(2.0 * (times[HALVES] - times[0]) / HALVES as f64)
}

/// From level until the centre of mass passes below the edge that holds it.
fn fall(cloth: &mut Cloth<'_>, rate_hz: f32) -> Result<f64, Error> {
    Ok(crossings(cloth, rate_hz, 1, |c| mean(c, 2))?[0])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// L_1(x) = 1 - x and L_2(x) = 1 - 2 x + x^2/2 have their smallest zeros at 1 and 2 - sqrt 2.
    #[test]
    fn the_chain_is_that_of_bernoulli() {
        for (n, zero) in [(1, 1.0), (2, 2.0 - 2f64.sqrt())] {
            let exact = std::f64::consts::TAU / (9.81 * f64::from(n) * zero).sqrt();
            assert!((chain_period_s(n, 1.0) / exact - 1.0).abs() < 0.02, "{n} links");
        }
        // the heavy rope: 4 pi sqrt(L/g) / j
        let rope = 4.0 * std::f64::consts::PI / J0_ZERO / 9.81f64.sqrt();
        assert!((chain_period_s(10_000, 1.0) / rope - 1.0).abs() < 1e-4);
        assert!(j0(J0_ZERO).abs() < 1e-12 && (j0(1.0) - 0.765_197_686_557_966_6).abs() < 1e-12);
    }

    /// The period is the same at every rate within 2 %, and that of the chain within 3 % (the sheet stretches by 1.6 %).
    #[test]
    fn the_period_does_not_depend_on_the_rate() {
        let rows = swings(Kind::Soft).unwrap();
        let last = rows.last().unwrap().clone();
        for row in &rows {
            assert!((row.period_s / last.period_s - 1.0).abs() < 0.02, "{rows:?}");
            assert!((row.fall_s / last.fall_s - 1.0).abs() < 0.02, "{rows:?}");
            assert!((row.period_s / row.chain_s - 1.0).abs() < 0.03, "{rows:?}");
        }
    }
}
