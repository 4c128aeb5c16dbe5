//! A sequence of calls of the C API with any arguments: each is answered, the cloth stays finite, and a snapshot taken on the
//! way brings back the state it was taken from.
#![no_main]

extern crate taut_ffi as _;

mod capi;
mod input;

use std::ptr::null_mut;

use capi::{Block, BudgetReport, Memory, OK, Strain};
use input::Input;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    let mut input = Input(data);
    // SAFETY: plain calls of the C API with memory that lives long enough.
    unsafe {
        let mut grid_def = capi::taut_grid_def_default();
        (grid_def.rows, grid_def.columns) = (2 + u32::from(input.u8() % 5), 2 + u32::from(input.u8() % 18));
        grid_def.families = 1 | u32::from(input.u8()) & 6;
        let particles = (grid_def.rows * grid_def.columns) as usize;
        let (_grid_block, grid) = capi::grid(&grid_def);
        assert!(!grid.is_null());
        let mut def = capi::taut_cloth_def_default(grid);
        let options = input.u8();
        def.features = u32::from(options & 1);
        def.budget = u32::from(options >> 1 & 1);
        def.compression_limit = u32::from(options >> 2 & 1);
        def.inertia_radius_m = if options & 8 != 0 { 0.3 } else { 0.0 };
        def.max_pins = u32::from(options >> 4);
        def.substeps = 1 + u32::from(input.u8() % 4);
        let mut memory = Memory { size: 0, align: 0 };
        assert_eq!(capi::taut_cloth_memory(grid, &def, &mut memory), OK);
        let mut block = Block::new(memory.size);
        let mut cloth = null_mut();
        assert_eq!(capi::taut_cloth_create(grid, &def, block.at(), memory.size, &mut cloth), OK);
        let mut largest = 0;
        assert_eq!(capi::taut_cloth_snapshot_size_max(cloth, &mut largest), OK);
        let mut kept: Option<(Vec<u8>, u64)> = None;
        for _ in 0..64 {
            if input.is_empty() {
                break;
            }
            let particle = |input: &mut Input<'_>| match input.u8() {
                255 => input.u32(),
                p => u32::from(p) % particles as u32,
            };
            match input.u8() % 16 {
                0 => _ = capi::taut_cloth_pin(cloth, particle(&mut input)),
                1 => _ = capi::taut_cloth_unpin(cloth, particle(&mut input)),
                2 => {
                    let (p, to) = (particle(&mut input), [input.f64(), input.f64(), input.f64()]);
                    capi::taut_cloth_pin_move(cloth, p, to.as_ptr());
                }
                3 => {
                    let (p, to) = (particle(&mut input), [input.f32(), input.f32(), input.f32()]);
                    capi::taut_cloth_set_position(cloth, p, to.as_ptr());
                }
                4 => {
                    let (p, to) = (particle(&mut input), [input.f32(), input.f32(), input.f32()]);
                    capi::taut_cloth_set_velocity(cloth, p, to.as_ptr());
                }
                5 => {
                    let (p, f) = (particle(&mut input), [input.f32(), input.f32(), input.f32()]);
                    let code = capi::taut_cloth_add_force(cloth, p, f.as_ptr());
                    assert!(def.features == 1 || code != OK);
                }
                6 => {
                    let k = [input.f32(), input.f32(), input.f32(), input.f32()];
                    let code = capi::taut_cloth_set_stiffness_uniform(cloth, k[0], k[1], k[2], k[3]);
                    assert_eq!(code == OK, k.iter().all(|k| k.is_finite() && *k >= 0.0));
                }
                7 | 8 => {
                    let shape = [1 + 3 * u32::from(input.u8() & 1), 2 + u32::from(input.u8() % 3), 2];
                    let field: Vec<f32> = (0..shape.iter().product()).map(|_| input.f32()).collect();
                    let good = field.iter().all(|k| k.is_finite() && *k >= 0.0);
                    let [c, m, n] = shape;
                    let code = capi::taut_cloth_set_stiffness_field(cloth, c, m, n, field.as_ptr());
                    assert_eq!(code == OK, good);
                    let mut repaired = 0;
                    let code =
                        capi::taut_cloth_set_stiffness_field_sanitised(cloth, c, m, n, field.as_ptr(), &mut repaired);
                    assert!(code == OK && repaired as usize <= field.len());
                }
                9 => {
                    let mut report = std::mem::MaybeUninit::<BudgetReport>::uninit();
                    if capi::taut_cloth_budget(cloth, report.as_mut_ptr()) == OK {
                        let r = report.assume_init();
                        assert!((0.0..=1.0).contains(&r.cut_fraction) && r.max_dt_s > 0.0, "{r:?}");
                    }
                }
                10 => {
                    let mut bytes = vec![0u8; largest];
                    let mut written = 0;
                    assert_eq!(capi::taut_cloth_snapshot(cloth, bytes.as_mut_ptr().cast(), largest, &mut written), OK);
                    bytes.truncate(written);
                    let mut hash = 0;
                    assert_eq!(capi::taut_cloth_state_hash(cloth, &mut hash), OK);
                    kept = Some((bytes, hash));
                }
                11 => {
                    if let Some((bytes, before)) = &kept {
                        let mut hash = 0;
                        assert_eq!(capi::taut_cloth_restore(cloth, bytes.as_ptr().cast(), bytes.len()), OK);
                        assert_eq!(capi::taut_cloth_state_hash(cloth, &mut hash), OK);
                        assert_eq!(hash, *before);
                    }
                }
                12 => {
                    let n = input.0.len().min(usize::from(input.0.first().copied().unwrap_or(0)));
                    capi::taut_cloth_restore(cloth, input.0.as_ptr().cast(), n);
                    capi::taut_cloth_load_stiffness(cloth, input.0.as_ptr().cast(), n, null_mut());
                }
                13 => _ = capi::taut_cloth_reset(cloth),
                14 => {
                    let (mut strain, mut energy) = (std::mem::MaybeUninit::<Strain>::uninit(), 0.0);
                    assert_eq!(capi::taut_cloth_strain(cloth, strain.as_mut_ptr()), OK);
                    assert_eq!(capi::taut_cloth_kinetic_energy(cloth, &mut energy), OK);
                    assert!(energy >= 0.0 && !strain.assume_init().mean.is_nan());
                    let stride = usize::from(input.u8());
                    let mut out = vec![0u8; particles * 16];
                    let code = capi::taut_cloth_copy_velocities_f32(cloth, out.as_mut_ptr().cast(), out.len(), stride);
                    assert!(code != OK || stride >= 12);
                }
                _ => {
                    let mut flags = 0;
                    let count = u32::from(input.u8() % 4);
                    capi::taut_cloth_step_many(cloth, count, &mut flags);
                    assert!(flags <= 1);
                }
            }
            assert!(capi::is_finite(cloth));
        }
    }
});
