//! A hundred characters, each with a cape: what a frame of all of them costs.

use cpu_time::ThreadTime;
use serde::{Deserialize, Serialize};
use taut::{Cloth, ClothDef, ColliderDef, ColliderId, Error, Features, Grid, GridDef, Pose, Shape, Vector3, Width};

use crate::block::Block;
use crate::metrics::percentile;

/// How many characters there are.
pub const CAPES: usize = 100;

const ROWS: u32 = 24;
const COLUMNS: u32 = 16;
const SUBSTEPS: u32 = 8;
const WIDTH_M: f32 = 0.5;
const HEIGHT_M: f32 = 1.1;

/// What a frame costs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Capes {
    /// Median over the frames: ms of thread CPU for all steps of a frame. Where the characters are is set outside of it.
    pub ms_per_frame: f64,
    /// Lower and upper quartile.
    pub quartiles_ms: [f64; 2],
    /// ns per particle and substep.
    pub ns_per_particle_step: f64,
    /// Largest stretch of any cape at the end in percent.
    pub stretch_max_pct: f64,
    /// Bytes of all capes.
    pub memory_bytes: usize,
}

/// Where a character is: he walks at 1.5 m/s along x with the ups and downs of steps, and sways.
fn shoulders(character: usize, time_s: f64) -> Vector3<f64> {
    let phase = 0.37 * character as f64;
    let step = std::f64::consts::TAU * (2.0 * time_s + phase);
    Vector3::new(1.5 * time_s, 1.5 + 0.03 * step.sin(), character as f64 + 0.05 * (0.5 * step).sin())
}

/// Body and legs, as capsules that taper; the cape hangs behind them, 0.15 m from the spine.
fn limbs() -> [Shape; 2] {
    let capsule = |ends_y: [f32; 2], radii_m| {
        let ends_m = ends_y.map(|y| [0.15, y, 0.0]);
        Shape::Capsule { ends_m, radii_m }
    };
    [capsule([-0.5, -0.12], [0.14, 0.13]), capsule([-1.4, -0.6], [0.08, 0.13])]
}

struct Character<'a> {
    cloth: Cloth<'a>,
    limbs: Vec<ColliderId>,
}

impl<'a> Character<'a> {
    fn new(index: usize, width: Width, grid: &Grid, def: &ClothDef, block: &'a mut [f32]) -> Result<Self, Error> {
        let at = shoulders(index, 0.0);
        // the upper edge across his back, centred
        let origin = at - Vector3::new(0.0, 0.0, 0.5 * f64::from(WIDTH_M));
        let def = ClothDef { origin_m: origin.into(), u_axis: [0.0, 0.0, 1.0], ..*def };
        let mut cloth = Cloth::create(grid, &def, block)?;
        cloth.set_width(width)?;
        cloth.set_stiffness_uniform([1e6, 1e6, 3e5, 2e4])?;
        for column in 0..COLUMNS as usize {
            cloth.pin(column)?;
        }
        let mut ids = Vec::new();
        for shape in limbs() {
            ids.push(cloth.add_collider(&ColliderDef::new(shape, Pose::at(at)))?);
        }
        Ok(Character { cloth, limbs: ids })
    }

    fn walk(&mut self, index: usize, time_s: f64) -> Result<(), Error> {
        let at = shoulders(index, time_s);
        for column in 0..COLUMNS as usize {
            let across = f64::from(WIDTH_M) * (column as f64 / f64::from(COLUMNS - 1) - 0.5);
            self.cloth.move_pin(column, at + Vector3::new(0.0, 0.0, across))?;
        }
        for id in &self.limbs {
            self.cloth.move_collider(*id, &Pose::at(at))?;
        }
        Ok(())
    }
}

/// Steps a hundred capes of 16 x 24 particles, one after the other on this thread: 60 Hz, 8 substeps, tethers, two capsules
/// each, for so many frames after a second of walking.
pub fn capes(width: Width, frames: u32) -> Result<Capes, Error> {
    let grid = Grid::new(&GridDef {
        rows: ROWS,
        columns: COLUMNS,
        width_m: WIDTH_M,
        height_m: HEIGHT_M,
        ..GridDef::default()
    })?;
    let def = ClothDef {
        substeps: SUBSTEPS,
        features: Features(Features::TETHERS.0 | Features::COLLIDERS.0),
        max_pins: COLUMNS,
        ..ClothDef::default()
    };
    // each block begins on a cache line
    let numbers = Cloth::memory(&grid, &def)?.next_multiple_of(16);
    let mut memory = Block::new(CAPES * numbers);
    let mut all = Vec::with_capacity(CAPES);
    for (i, block) in memory.numbers_mut().chunks_exact_mut(numbers).enumerate() {
        all.push(Character::new(i, width, &grid, &def, block)?);
    }
    let mut times = Vec::new();
    const BEFORE: u32 = 60;
    for frame in 1..=BEFORE + frames.max(1) {
        let time_s = f64::from(frame) / f64::from(def.rate_hz);
        for (i, character) in all.iter_mut().enumerate() {
            character.walk(i, time_s)?;
        }
        let clock = ThreadTime::now();
        for character in &mut all {
            character.cloth.step()?;
        }
        if frame > BEFORE {
            times.push(1e3 * clock.elapsed().as_secs_f64());
        }
    }
    times.sort_by(f64::total_cmp);
    let median = percentile(&times, 0.5);
    let steps = CAPES as f64 * f64::from(ROWS * COLUMNS * SUBSTEPS);
    let largest = all.iter().map(|c| c.cloth.strain().largest).fold(0.0, f32::max);
    Ok(Capes {
        ms_per_frame: median,
        quartiles_ms: [percentile(&times, 0.25), percentile(&times, 0.75)],
        ns_per_particle_step: 1e6 * median / steps,
        stretch_max_pct: 100.0 * f64::from(largest),
        memory_bytes: CAPES * numbers * size_of::<f32>(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn capes_hang_outside_of_those_who_wear_them() {
        let grid = Grid::new(&GridDef {
            rows: ROWS,
            columns: COLUMNS,
            width_m: WIDTH_M,
            height_m: HEIGHT_M,
            ..GridDef::default()
        })
        .unwrap();
        let def = ClothDef {
            substeps: SUBSTEPS,
            features: Features(Features::TETHERS.0 | Features::COLLIDERS.0),
            max_pins: COLUMNS,
            ..ClothDef::default()
        };
        let mut block = vec![0.0; Cloth::memory(&grid, &def).unwrap()];
        let mut character = Character::new(3, Width::best(), &grid, &def, &mut block).unwrap();
        // he starts to walk at once, so the cape swings out and comes back to his body, and no particle gets into it
        let [Shape::Capsule { ends_m, radii_m }, _] = limbs() else { unreachable!() };
        let mut nearest = f64::INFINITY;
        for frame in 1..=120 {
            let time_s = f64::from(frame) / 60.0;
            character.walk(3, time_s).unwrap();
            assert_eq!(character.cloth.step().unwrap(), taut::StepFlags(0));
            let at = shoulders(3, time_s);
            for i in 0..grid.particles() {
                let p = character.cloth.world_position(i).unwrap() - at;
                let y = p.y.clamp(f64::from(ends_m[0][1]), f64::from(ends_m[1][1]));
                let outside = (p - Vector3::new(0.15, y, 0.0)).norm() - f64::from(radii_m[0].min(radii_m[1]));
                nearest = nearest.min(outside);
            }
        }
        assert!((-0.002..0.03).contains(&nearest), "{nearest}");
        assert!(character.cloth.strain().largest < 0.1, "{}", character.cloth.strain().largest);
    }

    #[test]
    fn a_frame_of_all_is_timed() {
        let c = capes(Width::best(), 3).unwrap();
        assert!(c.ms_per_frame > 0.0 && c.quartiles_ms[0] <= c.ms_per_frame && c.stretch_max_pct < 20.0, "{c:?}");
        assert!(c.memory_bytes > CAPES * 384 * 100);
    }
}
