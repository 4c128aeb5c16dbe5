//! Convergence of the mesh: the strain of a hanging sheet against that of the continuum.

use serde::Serialize;
use taut::{ClothDef, Error, Families, Features, GridDef, Solver};

use super::with_cloth;
use crate::scene::Scene;

/// Stiffness along the warp in N/m, which is E h of the sheet of square cells.
const EH: f64 = 500.0;
const DENSITY: f64 = 0.2;

/// The sheet of one fineness.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Mesh {
    /// Particles of a side.
    pub side: u32,
    /// Mean strain of the springs along v in percent.
    pub mean_strain_pct: f64,
    /// Strain of the topmost of them in percent.
    pub top_strain_pct: f64,
    /// rho g H / (2 E h), the mean of the continuum, in percent. At the top it is twice that.
    pub continuum_mean_pct: f64,
    /// Mean against the continuum: share of it.
    pub error: f64,
    /// Order of the error from the mesh before: log2 of what halving the cells divides it by.
    pub order: Option<f64>,
}

/// Hangs a sheet of 1 m by its top row (scene edge, without its bump: the sheet is in its plane) at every fineness, with
/// structural springs alone, for which the continuum has a closed form.
///
/// The discrete sheet has the error -1/n: each column stands for a strip of 1/n of the mass, not of 1/(n - 1).
pub fn mesh(sides: &[u32]) -> Result<Vec<Mesh>, Error> {
    let continuum = 100.0 * DENSITY * 9.81 / (2.0 * EH);
    let mut rows: Vec<Mesh> = Vec::new();
    for side in sides.iter().copied() {
        let grid = GridDef { rows: side, columns: side, families: Families::STRUCTURAL, ..GridDef::default() };
        let def = ClothDef {
            density_kg_m2: DENSITY as f32,
            solver: Solver::ImplicitEuler,
            features: Features::IMPLICIT,
            substeps: 1,
            cg_iterations: 40,
            ..Scene::Edge.fit(&ClothDef::default(), side as usize, side as usize)
        };
        let [mean, top] = with_cloth(&grid, &def, |cloth| {
            cloth.set_stiffness_uniform([EH as f32, EH as f32, 0.0, 0.0])?;
            for p in Scene::Edge.pins(side as usize, side as usize) {
                cloth.pin(p)?;
            }
            for _ in 0..90 {
                cloth.step()?;
            }
            let n = side as usize;
            let (mut sum, mut top) = (0.0, 0.0);
            cloth.each_structural_strain(|a, b, e| {
                if b == a + n {
                    sum += f64::from(e);
                    if a < n {
                        top += f64::from(e) / n as f64;
                    }
                }
            });
            Ok([100.0 * sum / (n * (n - 1)) as f64, 100.0 * top])
        })?;
        let error = mean / continuum - 1.0;
        let order = rows
            .last()
            .map(|before| (before.error / error).abs().log2() / (f64::from(side) / f64::from(before.side)).log2());
        rows.push(Mesh {
            side,
            mean_strain_pct: mean,
            top_strain_pct: top,
            continuum_mean_pct: continuum,
            error,
            order,
        });
    }
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The error is that of the lattice, -1/n, and so of first order; in the command up to 128.
    #[test]
    fn the_mesh_converges_to_the_continuum() {
        let rows = mesh(&[16, 32, 64]).unwrap();
        for row in &rows {
            let n = f64::from(row.side);
            assert!((row.error + 1.0 / n).abs() < 0.05 / n, "{row:?}");
            // the top spring carries (n - 1)/n of the sheet
            let top = 2.0 * row.continuum_mean_pct * (1.0 - 1.0 / n) * (1.0 - 1.0 / n);
            assert!((row.top_strain_pct / top - 1.0).abs() < 0.01, "{row:?}, {top}");
        }
        for row in &rows[1..] {
            assert!((row.order.unwrap() - 1.0).abs() < 0.1, "{rows:?}");
        }
    }
}
