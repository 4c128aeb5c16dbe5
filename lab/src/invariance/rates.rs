//! The same fabric at 30 to 240 frames per second.

use serde::Serialize;
use taut::{ClothDef, Error, Features, GridDef, Solver};

use super::{farthest, positions, with_cloth};
use crate::scene::Scene;

/// Frames per second that are compared.
pub const RATES_HZ: [f32; 4] = [30.0, 60.0, 120.0, 240.0];

/// Time to come to rest in s.
const SECONDS: f32 = 20.0;

/// Particles of a side.
const SIDE: u32 = 16;

/// A fabric and a solver.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// Soft enough to be stepped as it is at 30 Hz x 16 substeps.
    Soft,
    /// Denim-like, which the budget cuts at each rate to what that rate carries.
    Cut,
    /// The same with the inertia field of 0.3 m.
    CutInertia,
    /// The same as it is, by BDF2 with one substep.
    Bdf2,
}

impl Kind {
    /// All of them.
    pub const ALL: [Kind; 4] = [Kind::Soft, Kind::Cut, Kind::CutInertia, Kind::Bdf2];

    /// The name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Kind::Soft => "soft",
            Kind::Cut => "cut",
            Kind::CutInertia => "cut_inertia",
            Kind::Bdf2 => "bdf2",
        }
    }

    pub(super) fn stiffness(self) -> [f32; 4] {
        if self == Kind::Soft { [60.0, 60.0, 20.0, 0.5] } else { [2000.0, 2000.0, 700.0, 10.0] }
    }

    pub(super) fn def(self, rate_hz: f32) -> ClothDef {
        let plain = ClothDef { rate_hz, ..ClothDef::default() };
        match self {
            Kind::Soft | Kind::Cut => plain,
            Kind::CutInertia => ClothDef { inertia_radius_m: 0.3, ..plain },
            Kind::Bdf2 => ClothDef { solver: Solver::Bdf2, features: Features::IMPLICIT, substeps: 1, ..plain },
        }
    }
}

/// A drape at one rate.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Drape {
    /// The scene.
    pub scene: &'static str,
    /// Fabric and solver.
    pub kind: Kind,
    /// Frames per second.
    pub rate_hz: f32,
    /// Substeps of a frame.
    pub substeps: u32,
    /// Share of the stiffness that the budget cut.
    pub cut_fraction: f64,
    /// Largest structural strain at rest in percent.
    pub strain_pct: f64,
    /// Farthest that a particle is from its place at 240 Hz, in percent of the side.
    pub from_240_hz_pct: f64,
    /// Root mean square speed at the end in m/s: how much at rest it is.
    pub rms_speed_m_s: f64,
}

/// Lets a fabric come to rest in a scene at every rate.
pub fn drapes(scene: Scene, kind: Kind) -> Result<Vec<Drape>, Error> {
    let grid = GridDef { rows: SIDE, columns: SIDE, ..GridDef::default() };
    let mut shapes = Vec::new();
    let mut rows = Vec::new();
    for rate_hz in RATES_HZ {
        let def = scene.fit(&kind.def(rate_hz), SIDE as usize, SIDE as usize);
        let (shape, row) = with_cloth(&grid, &def, |cloth| {
            cloth.set_stiffness_uniform(kind.stiffness())?;
            scene.set_up(cloth, 0)?;
            let cut_fraction = f64::from(cloth.budget()?.cut_fraction);
            for _ in 0..(SECONDS * rate_hz) as u32 {
                cloth.step()?;
            }
            let mass = f64::from(cloth.particle_mass_kg()) * cloth.grid().particles() as f64;
            let row = Drape {
                scene: scene.name(),
                kind,
                rate_hz,
                substeps: def.substeps,
                cut_fraction,
                strain_pct: 100.0 * f64::from(cloth.strain().largest),
                from_240_hz_pct: 0.0,
                rms_speed_m_s: (2.0 * cloth.kinetic_energy_j() / mass).sqrt(),
            };
            Ok((positions(cloth)?, row))
        })?;
        shapes.push(shape);
        rows.push(row);
    }
    if let Some(finest) = shapes.last() {
        for (row, shape) in rows.iter_mut().zip(&shapes) {
            row.from_240_hz_pct = 100.0 * farthest(shape, finest);
        }
    }
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The same fabric drapes the same way at every rate, within 1 % of the side, where no rate cuts it. One that is cut does
    /// not, which shows that the measure sees a difference.
    #[test]
    fn the_drape_does_not_depend_on_the_rate() {
        for scene in [Scene::Hang2, Scene::Edge] {
            for row in drapes(scene, Kind::Soft).unwrap() {
                assert_eq!(row.cut_fraction, 0.0);
                assert!(row.from_240_hz_pct < 1.0, "{row:?}");
            }
        }
        let cut = drapes(Scene::Hang2, Kind::Cut).unwrap();
        assert!(cut[0].cut_fraction > 0.9 && cut[0].from_240_hz_pct > 1.0, "{cut:?}");
    }
}
