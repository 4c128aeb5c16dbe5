//! What single precision costs: core beside its twin in f64 ([`crate::twin`]).

use serde::Serialize;
use taut::{ClothDef, Error, GridDef};

use super::{farthest, positions, with_cloth};
use crate::scene::Scene;
use crate::twin::Twin;

/// The difference between f32 and f64 in one scene.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Precision {
    /// The scene.
    pub scene: &'static str,
    /// Particles of a side.
    pub side: u32,
    /// Substeps of a frame at 60 Hz.
    pub substeps: u32,
    /// Simulated time in s.
    pub seconds: f64,
    /// Farthest that a particle of one is from the same of the other, over all frames, in m.
    pub position_peak_m: f64,
    /// The same after the last frame.
    pub position_end_m: f64,
    /// Largest difference of the strain of a spring over all frames, in percent of its rest length.
    pub strain_peak_pct: f64,
    /// The same after the last frame.
    pub strain_end_pct: f64,
    /// Largest strain at the end in f64, in percent: what the differences are to be seen against.
    pub largest_strain_pct: f64,
}

/// Warp, weft, shear, bend in N/m: what 16 x 16 at 60 Hz x 16 substeps carries, uncut.
const STIFFNESS: [f32; 4] = [200.0, 200.0, 70.0, 1.0];

/// Runs both precisions side by side. The substeps grow with the fineness of the grid, so that nothing is cut.
pub fn precision(scene: Scene, side: u32, seconds: f64) -> Result<Precision, Error> {
    let grid = GridDef { rows: side, columns: side, ..GridDef::default() };
    let substeps = side.next_power_of_two().max(16);
    let def = scene.fit(&ClothDef { substeps, ..ClothDef::default() }, side as usize, side as usize);
    with_cloth(&grid, &def, |cloth| {
        cloth.set_stiffness_uniform(STIFFNESS)?;
        scene.set_up(cloth, 0)?;
        let mut twin = Twin::<f64>::of(cloth, STIFFNESS)?.ok_or(Error::StepSize)?;
        let mut row = Precision {
            scene: scene.name(),
            side,
            substeps,
            seconds,
            position_peak_m: 0.0,
            position_end_m: 0.0,
            strain_peak_pct: 0.0,
            strain_end_pct: 0.0,
            largest_strain_pct: 0.0,
        };
        for _ in 0..(seconds * 60.0).round() as u32 {
            cloth.step()?;
            twin.step();
            let doubles: Vec<[f64; 3]> = twin.positions().collect();
            let strains = twin.strains();
            let (mut strain, mut spring) = (0.0f64, 0);
            cloth.each_structural_strain(|_, _, e| {
                strain = strain.max((f64::from(e) - strains[spring]).abs());
                spring += 1;
            });
            row.position_end_m = farthest(&positions(cloth)?, &doubles);
            row.strain_end_pct = 100.0 * strain;
            row.position_peak_m = row.position_peak_m.max(row.position_end_m);
            row.strain_peak_pct = row.strain_peak_pct.max(row.strain_end_pct);
            row.largest_strain_pct = 100.0 * strains.into_iter().fold(f64::NEG_INFINITY, f64::max);
        }
        Ok(row)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// At rest single precision costs a hundredth of a millimetre and of a percent of strain; in the fall, where a sheet
    /// buckles and small differences grow for a while, a percent of the side and half a percent of strain.
    #[test]
    fn single_precision_is_enough() {
        for scene in [Scene::Hang2, Scene::Edge] {
            let p = precision(scene, 16, 10.0).unwrap();
            assert!(p.position_peak_m < 1e-2 && p.strain_peak_pct < 0.5, "{p:?}");
            assert!(p.position_end_m < 1e-5 && p.strain_end_pct < 0.01, "{p:?}");
            assert!(p.position_end_m > 0.0 && p.largest_strain_pct > 0.5, "{p:?}");
        }
    }
}
