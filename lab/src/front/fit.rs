//! The data-driven correction: three numbers fitted to strains.
//!
//! What it is: one K for the whole cloth, warp, weft and shear in N/m with bend held at 2 % of their structural mean (a free
//! bend channel would carry the load and stick when folded), chosen so that the structural strains of hang2 and edge at rest
//! come as near as possible, in the least-squares sense, to those of the fabric's reference. The fit runs at the grid and
//! step that it is for. The search is a pattern search over the logarithms, 16 tries: simple, and good to about a tenth
//! of what the first try is off.

use taut::Error;

/// Tries of a fit, and how far the first ones go, as exponents of 2.
pub const TRIES: u32 = 16;
const FIRST: f32 = 1.0;

/// Finds the three numbers from a start. `error` tells how far a choice (warp, weft, shear, bend) is off; what is not finite
/// is the worst.
pub fn search(
    start: [f32; 3],
    tries: u32,
    mut error: impl FnMut([f32; 4]) -> Result<f64, Error>,
) -> Result<[f32; 4], Error> {
    let mut off = |k: [f32; 3]| error(with_bend(k)).map(|e| if e.is_finite() { e } else { f64::INFINITY });
    let (mut best, mut way, mut left) = (start, FIRST, tries);
    let mut least = off(best)?;
    // how the channels are moved: all alike, then shear against the others, then warp against weft
    const WAYS: [[f32; 3]; 3] = [[1.0, 1.0, 1.0], [0.0, 0.0, 1.0], [1.0, -1.0, 0.0]];
    'search: loop {
        let mut better = false;
        for direction in WAYS {
            for sign in [1.0, -1.0] {
                if left == 0 {
                    break 'search;
                }
                left -= 1;
                let mut next = best;
                for (k, d) in next.iter_mut().zip(direction) {
                    *k *= (sign * way * d).exp2();
                }
                let e = off(next)?;
                if e < least {
                    (best, least, better) = (next, e, true);
                    break;
                }
            }
        }
        if !better {
            way *= 0.5;
        }
    }
    Ok(with_bend(best))
}

fn with_bend([warp, weft, shear]: [f32; 3]) -> [f32; 4] {
    [warp, weft, shear, taut::BEND_SHARE * 0.5 * (warp + weft)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_search_finds_the_bottom_of_a_bowl() {
        let goal = [900.0f32, 300.0, 40.0];
        let mut tries = 0;
        let off = |k: [f32; 4]| {
            tries += 1;
            Ok(goal.iter().zip(&k).map(|(g, k)| f64::from((k / g).log2()).powi(2)).sum::<f64>())
        };
        let found = search([1600.0, 400.0, 100.0], 60, off).unwrap();
        for (g, k) in goal.iter().zip(&found) {
            assert!((k / g).log2().abs() < 0.2, "{found:?}");
        }
        assert!((found[3] - 0.01 * (found[0] + found[1])).abs() < 1e-3);
        assert_eq!(tries, 61);
    }

    #[test]
    fn what_blows_up_is_not_chosen() {
        let off = |k: [f32; 4]| Ok(if k[0] > 10.0 { f64::NAN } else { f64::from(11.0 - k[0]) });
        assert!(search([8.0, 8.0, 8.0], 20, off).unwrap()[0] <= 10.0);
    }
}
