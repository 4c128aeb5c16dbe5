//! What tests/counts.sh counts the instructions of: one frame of each load in each width that callgrind knows. Prints a
//! line for each, in the order in which [`counts_mark`] is called around them.
//!
//! `cargo run --release -p taut-lab --example counts` shows the order alone.

use std::hint::black_box;

use taut::Width;
use taut_lab::block::Block;
use taut_lab::cost::Load;

/// Callgrind writes what it has counted before each call of this one, and begins anew.
#[unsafe(no_mangle)]
#[inline(never)]
pub extern "C" fn counts_mark() {
    black_box(());
}

const SIDE: u32 = 32;

/// Frames that are counted.
const FRAMES: u32 = 1;

const LOADS: [Load; 13] = [
    Load::Plain,
    Load::StructuralOnly,
    Load::NoClamps,
    Load::Mask,
    Load::Air,
    Load::Hinge,
    Load::Tethers,
    Load::StrainLimitIdle,
    Load::StrainLimit,
    Load::LevelsIdle,
    Load::Levels,
    Load::OneCycle,
    Load::ColliderFar,
];

fn main() -> Result<(), taut::Error> {
    for width in [Width::Scalar, Width::Sse2, Width::Avx2] {
        for load in LOADS {
            if !width.is_supported() {
                println!("SKIPPED {}/{}", width.name(), load.name());
                continue;
            }
            let mut block = Block::new(load.memory(SIDE)?);
            let mut cloth = load.create(SIDE, width, block.numbers_mut())?;
            let steps = SIDE * SIDE * cloth.def().substeps * FRAMES;
            counts_mark();
            for _ in 0..FRAMES {
                black_box(cloth.step()?);
            }
            counts_mark();
            println!("{}/{} {steps}", width.name(), load.name());
        }
    }
    Ok(())
}
