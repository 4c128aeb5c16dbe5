//! The scenes of the lab with the reference cloth: where it starts, what holds it, what it meets.

use taut_lab::cusick::DISC_M;
use taut_lab::scene::Scene;

use super::{Cloth, Material, ReferenceError, Sheet, Surroundings, V3};

/// Steps of a simulated second.
pub const STEPS_PER_S: usize = 240;
/// Steps of a frame of a trajectory.
pub const STEPS_PER_FRAME: usize = 8;

/// The lab's bump of about 1 % of the side, made as small as that of ARCSim's scenes: at most 1 mm on 1 m.
const BUMP: f64 = 0.08;

/// How far from the ball the cloth is held, in m, and its friction there.
const THICKNESS_M: f64 = 0.005;
const FRICTION: f64 = 0.3;

/// The sheet of a scene with `side` vertices along each side: a square metre, or the disc of `cusick`. Errors: its size.
pub fn sheet(scene: Scene, side: usize) -> Result<Sheet, ReferenceError> {
    if scene == Scene::Cusick {
        return Sheet::disc(side | 1, f64::from(DISC_M));
    }
    Sheet::rectangle(side, side, 1.0, 1.0)
}

/// The vertices that a scene pins.
pub fn pins(scene: Scene, sheet: &Sheet, side: usize) -> Vec<usize> {
    if scene == Scene::Cusick {
        let cell = 2.0 * f64::from(DISC_M) / ((side | 1) - 1) as f64;
        // a hinge is clamped halfway: half a cell more is held, and the overhang begins at the pedestal's edge
        let held = f64::from(taut_lab::cusick::PEDESTAL_M) + 0.5 * cell + 1e-9;
        return (0..sheet.uv.len()).filter(|i| sheet.uv[*i][0].hypot(sheet.uv[*i][1]) <= held).collect();
    }
    // the lab counts rows from the top
    scene.pins(side, side).into_iter().map(|p| (side - 1 - p / side) * side + p % side).collect()
}

/// Where the vertices start, in m and in the lab's axes (y up); another seed is another bump.
pub fn start(scene: Scene, sheet: &Sheet, seed: u64) -> Vec<V3> {
    let (radius, level) = (f64::from(DISC_M), scene.is_level());
    (sheet.uv.iter())
        .map(|&[u, v]| {
            let (shares, size) = match scene {
                Scene::Cusick => ([0.5 + 0.5 * u / radius, 0.5 - 0.5 * v / radius], DISC_M * 2.0),
                _ => ([u, 1.0 - v], 1.0),
            };
            let mut x = scene.start(shares[0] as f32, shares[1] as f32, size, size, seed).map(f64::from);
            x[if level { 1 } else { 2 }] *= BUMP;
            x
        })
        .collect()
}

/// A cloth of a scene, at `x` or where it starts by itself. Errors: as of [`Cloth::new`].
pub fn set_up(
    scene: Scene,
    side: usize,
    material: Material,
    x: Option<Vec<V3>>,
    seed: u64,
) -> Result<Cloth, ReferenceError> {
    let sheet = sheet(scene, side)?;
    let x = x.unwrap_or_else(|| start(scene, &sheet, seed));
    let pins = pins(scene, &sheet, side);
    Cloth::new(&sheet, material, surroundings(scene), x, &pins)
}

/// What acts on the cloth of a scene.
pub fn surroundings(scene: Scene) -> Surroundings {
    let size = if scene == Scene::Cusick { 2.0 * DISC_M } else { 1.0 };
    Surroundings {
        solid: scene.solid(size, size).map(Into::into),
        thickness_m: if scene == Scene::Drape { THICKNESS_M } else { 0.0 },
        friction: FRICTION,
        ..Surroundings::default()
    }
}
