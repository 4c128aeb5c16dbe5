//! One trajectory: the cloth falls, pictures of its motion are taken, then it is brought to rest.

use taut::noise;
use taut_lab::fabric::Fabric;

use super::plan::Trajectory;
use super::{GRID, Scene, material};
use crate::reference::{Cloth, ReferenceError, V3, scenes};

/// Steps of a second; ARCSim's scenes have 240, and their shapes at rest are the same.
const STEPS_PER_S: f64 = 120.0;

/// How long a cloth moves before it is brought to rest, where its motion is not looked at: folds form in it, in s.
const FOLDING_S: f64 = 1.5;
const HANGING_S: f64 = 0.4;

/// The steps of a cloth that blew up are made shorter this often.
const ATTEMPTS: u32 = 3;

/// How far an upright sheet is turned about its top row where it starts, at most, in radians.
const TILT: f64 = 1.0;

/// Largest force that is left at rest, in weights of a vertex, and most steps to get there.
const TOLERANCE: f64 = 1e-3;
const MOST_STEPS: usize = 400;

/// Slower than this is at rest for what lies on a ball, where friction takes part and the forces do not tell; in m/s.
const STILL_M_S: f64 = 5e-3;

/// A moment of a trajectory.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Frame {
    pub time_s: f64,
    pub at_rest: bool,
    /// `[GRID * GRID][3]`, row 0 at the top.
    pub positions: Vec<f32>,
}

/// The pictures' moments of a trajectory.
pub(super) fn frames(t: &Trajectory) -> Result<Vec<Frame>, ReferenceError> {
    let moving = t.frames - 1;
    let at = |k: usize| {
        let share = f64::from(noise::uniform(t.seed ^ 0x74_696d_65, k as u32));
        t.motion_s * (k as f64 + share) / moving as f64
    };
    let times: Vec<f64> = (0..moving).map(at).collect();
    attempts(|steps_per_s| {
        let mut cloth = set_up(&t.fabric, t.scene, GRID, t.seed, true)?;
        let steps = (t.motion_s * steps_per_s).round() as usize;
        let mut frames = Vec::with_capacity(t.frames);
        for step in 1..=steps {
            cloth.step(1.0 / steps_per_s)?;
            let time_s = step as f64 / steps_per_s;
            while frames.len() < moving && times[frames.len()] <= time_s {
                frames.push(Frame { time_s, at_rest: false, positions: positions(&cloth, GRID) });
            }
        }
        let at_rest = rest(&mut cloth, t.scene)?;
        frames.push(Frame { time_s: t.motion_s, at_rest, positions: positions(&cloth, GRID) });
        Ok(frames)
    })
}

/// The continuum cloth of a fabric at rest in a scene, `[side * side][3]` in m with row 0 at the top, and whether it did come to
/// rest. `seed` gives the pins of [`Scene::Pins`] and the first bump.
///
/// # Errors
/// [`ReferenceError`], among others where `side` is below 2.
pub fn settled(fabric: &Fabric, scene: Scene, side: usize, seed: u64) -> Result<(Vec<f32>, bool), ReferenceError> {
    attempts(|steps_per_s| {
        let mut cloth = set_up(fabric, scene, side, seed, false)?;
        let motion_s = if scene.folds() { FOLDING_S } else { HANGING_S };
        for _ in 0..(motion_s * steps_per_s) as usize {
            cloth.step(1.0 / steps_per_s)?;
        }
        let at_rest = rest(&mut cloth, scene)?;
        Ok((positions(&cloth, side), at_rest))
    })
}

/// Again with half the step where a step could not be made.
fn attempts<T>(run: impl Fn(f64) -> Result<T, ReferenceError>) -> Result<T, ReferenceError> {
    let mut last = run(STEPS_PER_S);
    for attempt in 1..ATTEMPTS {
        if !matches!(last, Err(ReferenceError::Factorisation | ReferenceError::NotFinite)) {
            break;
        }
        last = run(STEPS_PER_S * f64::from(1 << attempt));
    }
    last
}

fn set_up(fabric: &Fabric, scene: Scene, side: usize, seed: u64, tilted: bool) -> Result<Cloth, ReferenceError> {
    let lab = scene.lab();
    let sheet = scenes::sheet(lab, side)?;
    let mut x = scenes::start(lab, &sheet, seed);
    // the mesh counts rows from the bottom
    let pins: Vec<usize> = scene.pins(side, seed).iter().map(|p| (side - 1 - p / side) * side + p % side).collect();
    if !scene.folds() {
        let angle = if tilted { TILT * f64::from(2.0 * noise::uniform(seed ^ 0x74_696c_74, 0) - 1.0) } else { 0.0 };
        let (sin, cos) = angle.sin_cos();
        for [_, y, z] in &mut x {
            (*y, *z) = (cos * *y - sin * *z, sin * *y + cos * *z);
        }
        // held where training's cloth is held
        for p in &pins {
            x[*p] = [sheet.uv[*p][0], 0.0, 0.0];
        }
    }
    Cloth::new(&sheet, material(fabric)?, scenes::surroundings(lab), x, &pins)
}

/// Brings a cloth to rest from where it is; whether it came there.
fn rest(cloth: &mut Cloth, scene: Scene) -> Result<bool, ReferenceError> {
    if scene != Scene::Drape {
        match cloth.settle(TOLERANCE, MOST_STEPS) {
            Ok(_) => return Ok(true),
            Err(ReferenceError::NotAtRest { .. }) => {}
            Err(e) => return Err(e),
        }
    }
    // what swings is stopped again and again; friction, which the search for rest leaves out, is at work
    const BETWEEN: usize = 5;
    let vertices = cloth.positions().len();
    let mut fastest = f64::INFINITY;
    for step in 0..MOST_STEPS / 4 {
        cloth.step(1.0 / 60.0)?;
        if step % BETWEEN == BETWEEN - 1 {
            fastest = cloth.rms_speed_m_s();
            if fastest < STILL_M_S {
                break;
            }
            (0..vertices).for_each(|i| cloth.set_velocity(i, [0.0; 3]));
        }
    }
    Ok(fastest < STILL_M_S)
}

fn positions(cloth: &Cloth, side: usize) -> Vec<f32> {
    let row = |r: usize| &cloth.positions()[(side - 1 - r) * side..][..side];
    (0..side).flat_map(row).flat_map(|x: &V3| x.map(|x| x as f32)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use taut_lab::fabric::KINDS;

    /// A hanging sheet: its lower edge hangs lower by rho g/(2 k).
    #[test]
    fn a_sheet_at_rest_is_as_long_as_its_stiffness_says() {
        let denim = KINDS[0].fabric();
        let (x, at_rest) = settled(&denim, Scene::Edge, 9, 4).unwrap();
        assert!(at_rest);
        let expected = 0.324 * 9.8 / (2.0 * 2033.5);
        for column in 0..9 {
            let longer = f64::from(-x[3 * (8 * 9 + column) + 1]) - 1.0;
            assert!((longer / expected - 1.0).abs() < 0.05, "{longer} {expected}");
            assert_eq!(x[3 * column..][..3], [column as f32 / 8.0, 0.0, 0.0]);
        }
    }

    #[test]
    fn pins_hold_and_the_cloth_comes_to_rest_in_every_scene() {
        for scene in Scene::ALL {
            let (x, at_rest) = settled(&KINDS[1].fabric(), scene, 8, 7).unwrap();
            assert!(at_rest, "{scene}");
            for p in scene.pins(8, 7) {
                let start = if scene == Scene::Hang1 { [0.0; 3] } else { [(p % 8) as f32 / 7.0, 0.0, 0.0] };
                for (a, b) in x[3 * p..][..3].iter().zip(start) {
                    assert!((a - b).abs() < 1e-3, "{scene}: pin {p} is at {:?}", &x[3 * p..][..3]);
                }
            }
            let lowest = x.chunks_exact(3).map(|p| p[1]).fold(0.0, f32::min);
            assert!((-2.0..-0.4).contains(&lowest), "{scene}: {lowest}");
        }
    }
}
