//! How fast this machine is just now.

use cpu_time::ThreadTime;
use taut::{Cloth, ClothDef, Error, Grid, GridDef};

use crate::block::Block;

/// Frames that are stepped before the clock counts, and those that count.
const WARM: u32 = 2;
const FRAMES: u32 = 9;

/// ns of thread CPU time per particle-step of a plain cloth: 32 x 32, all families, no inertia, two pins, median of nine
/// frames. Costs divided by it are free of the machine and of what else runs on it.
pub fn plain_ns() -> Result<f64, Error> {
    let grid = Grid::new(&GridDef::default())?;
    let def = ClothDef::default();
    let mut block = Block::new(Cloth::memory(&grid, &def)?);
    let mut cloth = Cloth::create(&grid, &def, block.numbers_mut())?;
    cloth.set_stiffness_uniform([1e8; 4])?;
    cloth.pin(0)?;
    cloth.pin(grid.columns() - 1)?;
    let mut times = Vec::new();
    for frame in 0..WARM + FRAMES {
        let start = ThreadTime::now();
        cloth.step()?;
        if frame >= WARM {
            times.push(start.elapsed().as_nanos() as f32);
        }
    }
    let steps = grid.particles() as f64 * f64::from(def.substeps);
    Ok(f64::from(crate::metrics::median(&times)) / steps)
}
