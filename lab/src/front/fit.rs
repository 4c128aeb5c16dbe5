//! The data-driven correction: three numbers fitted to strains.
//!
//! What it is: one K for the whole cloth, warp, weft and shear in N/m with bend held at 2 % of their structural mean (a free
//! bend channel would carry the load and stick when folded), chosen so that the structural strains of hang2 and edge at rest
//! come as near as possible, in the least-squares sense, to those of the fabric's reference. The fit runs at the grid and
//! step that it is for. The search is a pattern search over the logarithms, 16 tries: simple, and good to about a tenth
//! of what the first try is off.

use taut::Error;

use crate::compare::{self, Case, Setting};
use crate::fabric::Fabric;

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

/// The three numbers of a fabric that come nearest to the structural strains of some cases. The search starts at the ratios 1,
/// 1, 0.3 of a good analytic choice, as stiff as the fabric is.
pub fn to_strains(fabric: &Fabric, goals: &[(Case, Vec<f64>)]) -> Result<[f32; 4], Error> {
    let [warp, weft, shear, _] = fabric.stiffness;
    search([warp, weft, shear.max(0.15 * (warp + weft))], TRIES, |k| {
        let mut squares = 0.0;
        for (case, goal) in goals {
            let outcome = compare::run(case, &Setting::DataDriven(k), |_| ())?;
            squares += strains(case, &outcome.positions).iter().zip(goal).map(|(a, b)| (a - b).powi(2)).sum::<f64>();
        }
        Ok(squares)
    })
}

/// Structural strains of a sheet in the order of its springs: of each row first those along u, then those along v.
pub fn strains(case: &Case, positions: &[[f32; 3]]) -> Vec<f64> {
    let (m, n) = (case.rows as usize, case.columns as usize);
    let rest = [case.size_m[0] / (n - 1) as f32, case.size_m[1] / (m - 1) as f32].map(f64::from);
    let length = |a: usize, b: usize| {
        let squares = positions[a].iter().zip(&positions[b]).map(|(a, b)| f64::from(a - b).powi(2));
        squares.sum::<f64>().sqrt()
    };
    let mut strains = Vec::with_capacity(2 * m * n);
    for i in 0..positions.len() {
        if i % n + 1 < n {
            strains.push(length(i, i + 1) / rest[0] - 1.0);
        }
        if i / n + 1 < m {
            strains.push(length(i, i + n) / rest[1] - 1.0);
        }
    }
    strains
}

fn with_bend([warp, weft, shear]: [f32; 3]) -> [f32; 4] {
    [warp, weft, shear, taut::BEND_SHARE * 0.5 * (warp + weft)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

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

    #[test]
    fn strains_of_a_stretched_sheet() {
        let case = Case::square(Scene::Edge, &Fabric::named("denim").unwrap(), 3, 16, 1.0);
        let x: Vec<[f32; 3]> = (0..9).map(|i| [0.55 * (i % 3) as f32, -0.5 * (i / 3) as f32, 0.0]).collect();
        let s = strains(&case, &x);
        assert_eq!(s.len(), 12);
        let along_u: Vec<&f64> = s.iter().filter(|e| (**e - 0.1).abs() < 1e-6).collect();
        assert_eq!((along_u.len(), s.iter().filter(|e| e.abs() < 1e-6).count()), (6, 6));
    }
}
