//! The scene that is stepped here without std and in `tests/tests/bare.rs` with it.

use taut::{Cloth, ClothDef, Error, Grid, GridDef};

/// Particles of a side.
pub const SIDE: u32 = 8;
/// Frames of 1/60 s that are stepped.
pub const FRAMES: u32 = 60;
/// f32 numbers of memory that the scene may use.
pub const NUMBERS: usize = 10_240;

/// Steps a sheet of 1 m x 1 m that hangs from the two corners of row 0, starts level and swings down; returns the hash
/// of its last state.
///
/// Errors: [`Error::BlockTooSmall`] when `block` is shorter than the cloth needs; [`Error::NotFinite`] when a frame was
/// taken back.
pub fn hash(block: &mut [f32]) -> Result<u64, Error> {
    let grid = Grid::new(&GridDef { rows: SIDE, columns: SIDE, ..GridDef::default() })?;
    // level, so that the sheet swings and the state is far from rest
    let def = ClothDef { max_pins: 2, v_axis: [0.0, 0.0, 1.0], ..ClothDef::default() };
    let mut cloth = Cloth::create(&grid, &def, block)?;
    cloth.set_stiffness_uniform([2000.0, 400.0, 100.0, 8.0])?;
    cloth.pin(0)?;
    cloth.pin(SIDE as usize - 1)?;
    for _ in 0..FRAMES {
        if cloth.step()?.0 != 0 {
            return Err(Error::NotFinite);
        }
    }
    Ok(cloth.state_hash())
}
