//! Any bytes as the definitions of a grid and a cloth through the structures of C: refused with a code, or a cloth that can be
//! stepped and stays finite.
#![no_main]

extern crate taut_ffi as _;

mod capi;
mod input;

use std::ptr::null_mut;

use capi::{Block, Memory, OK};
use input::Input;
use libfuzzer_sys::fuzz_target;

/// Memory and work that a run may take.
const MOST_BYTES: usize = 1 << 20;
const MOST_WORK: u64 = 1 << 16;

fuzz_target!(|data: &[u8]| {
    let mut input = Input(data);
    // which words of the two structures are changed
    // SAFETY: plain calls of the C API with memory that lives long enough.
    unsafe {
        let mut grid_def = capi::taut_grid_def_default();
        change(&mut grid_def, &mut input);
        let mut grid_block = Block::new(64);
        let mut grid = null_mut();
        if capi::taut_grid_create(&grid_def, grid_block.at(), 64, &mut grid) != OK {
            return;
        }
        let mut def = capi::taut_cloth_def_default(grid);
        change(&mut def, &mut input);
        let mut memory = Memory { size: 0, align: 0 };
        if capi::taut_cloth_memory(grid, &def, &mut memory) != OK {
            let mut cloth = null_mut();
            let mut block = Block::new(4096);
            assert_ne!(capi::taut_cloth_create(grid, &def, block.at(), 4096, &mut cloth), OK);
            return;
        }
        assert!(memory.align <= 64);
        if memory.size > MOST_BYTES {
            return;
        }
        let mut block = Block::new(memory.size);
        let mut cloth = null_mut();
        assert_ne!(capi::taut_cloth_create(grid, &def, block.at(), memory.size - 1, &mut cloth), OK);
        assert_eq!(capi::taut_cloth_create(grid, &def, block.at(), memory.size, &mut cloth), OK);
        assert!(capi::is_finite(cloth));
        assert_eq!(capi::taut_cloth_set_stiffness_uniform(cloth, 1e4, 1e3, 1e6, 10.0), OK);
        let pin = input.u32();
        let pinned = capi::taut_cloth_pin(cloth, pin) == OK;
        assert!(!pinned || pin < grid_def.rows * grid_def.columns);
        if u64::from(grid_def.rows) * u64::from(grid_def.columns) * u64::from(def.substeps) <= MOST_WORK {
            let mut flags = 0;
            assert_eq!(capi::taut_cloth_step_many(cloth, 2, &mut flags), OK);
            assert!(capi::is_finite(cloth));
        }
    }
});

/// Overwrites some words of a structure of plain numbers.
fn change<T>(value: &mut T, input: &mut Input<'_>) {
    let words = size_of::<T>() / 4;
    for _ in 0..input.u8() % 8 {
        let (at, word) = (usize::from(input.u8()) % words, input.u32());
        // SAFETY: every bit pattern is a valid value, as ffi/src/types.rs promises.
        unsafe { (value as *mut T).cast::<u32>().add(at).write_unaligned(word) };
    }
}
