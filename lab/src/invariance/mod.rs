//! What must not depend on how it is computed: the drape on the frame rate, the state on the frame times, the result on the
//! step (to the order of the solver), on the mesh and on the precision of the numbers.

mod jitter;
mod mesh;
mod order;
mod precision;
mod rates;
mod report;
mod swing;

use taut::{Cloth, ClothDef, Error, Grid, GridDef};

pub use jitter::{Accumulator, Jitter, jitter};
pub use mesh::{Mesh, mesh};
pub use order::{Order, Smooth, order};
pub use precision::{Precision, precision};
pub use rates::{Drape, Kind, RATES_HZ, drapes};
pub use report::{PARTS, Report, report};
pub use swing::{Swing, swings};

/// Makes a cloth and hands it to `work`.
pub fn with_cloth<R>(
    grid: &GridDef,
    def: &ClothDef,
    work: impl FnOnce(&mut Cloth<'_>) -> Result<R, Error>,
) -> Result<R, Error> {
    let grid = Grid::new(grid)?;
    let mut block = vec![0.0; Cloth::memory(&grid, def)?];
    let mut cloth = Cloth::create(&grid, def, &mut block)?;
    work(&mut cloth)
}

/// All positions in the cloth's frame in m.
fn positions(cloth: &Cloth<'_>) -> Result<Vec<[f64; 3]>, Error> {
    (0..cloth.grid().particles()).map(|i| cloth.position(i).map(|p| [p.x, p.y, p.z].map(f64::from))).collect()
}

fn distance(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}

/// Largest distance between the same particles of two shapes.
fn farthest(a: &[[f64; 3]], b: &[[f64; 3]]) -> f64 {
    a.iter().zip(b).map(|(a, b)| distance(a, b)).fold(0.0, f64::max)
}
