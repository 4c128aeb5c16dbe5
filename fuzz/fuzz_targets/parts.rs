//! Clothes with any of the optional parts, solvers and limits, and calls to these parts with any arguments: each is answered
//! and the cloth stays finite. Every frame is stepped again from a snapshot of its beginning, in vectors of another width and in
//! bands, and must end with the same bits.
#![no_main]

extern crate taut_ffi as _;

mod capi;
mod input;

use std::ffi::c_void;
use std::ptr::null_mut;

use capi::{Air, Block, ColliderDef, Memory, OK, Pose};
use input::Input;
use libfuzzer_sys::fuzz_target;

/// All features of the header.
const FEATURES: u32 = 2047;
/// TAUT_FEATURE_IMPLICIT.
const IMPLICIT: u32 = 1024;
/// TAUT_STEP_NON_FINITE; its causes are the flags above 3.
const NON_FINITE: u32 = 1;

fn three(input: &mut Input<'_>) -> [f32; 3] {
    [input.near(), input.near(), input.near()]
}

fn pose(input: &mut Input<'_>) -> Pose {
    let position_m = three(input).map(f64::from);
    let rotation =
        if input.u8() & 1 == 0 { [0.0, 0.0, 0.0, 1.0] } else { [input.near(), input.near(), input.near(), 1.0] };
    Pose { position_m, rotation }
}

/// A collider of any shape near the cloth, or nowhere.
unsafe fn collider(input: &mut Input<'_>) -> ColliderDef {
    // SAFETY: a definition by value.
    let mut def = unsafe { capi::taut_collider_def_default(1 + u32::from(input.u8() % 4)) };
    def.pose = pose(input);
    (def.friction, def.thickness_m) = (input.near().abs(), 0.1 * input.near().abs());
    def.radius_m = [input.near().abs(), input.near().abs()];
    def.half_m = three(input);
    def
}

/// A frame from the state as it is now: its flags and the hash after it.
unsafe fn frame(cloth: *mut c_void, in_bands: Option<u32>) -> (u32, u64) {
    // SAFETY: plain calls of the C API.
    unsafe {
        let (mut flags, mut hash) = (0, 0);
        let mut memory = Memory { size: 0, align: 0 };
        match in_bands {
            Some(rows) if capi::taut_cloth_bands_memory(cloth, rows, &mut memory) == OK => {
                let (mut block, mut bands) = (Block::new(memory.size), null_mut());
                let code = capi::taut_cloth_bands_begin(cloth, rows, block.at(), memory.size, &mut bands);
                assert_eq!(code, OK);
                let (mut count, mut phases) = (0, 0);
                assert_eq!(capi::taut_bands_count(bands, &mut count, &mut phases), OK);
                for phase in 0..phases {
                    for band in (0..count).rev() {
                        assert_eq!(capi::taut_bands_run(bands, phase, band), OK);
                    }
                }
                assert_eq!(capi::taut_bands_end(bands, &mut flags), OK);
            }
            _ => assert_eq!(capi::taut_cloth_step_many(cloth, 1, &mut flags), OK),
        }
        assert_eq!(capi::taut_cloth_state_hash(cloth, &mut hash), OK);
        (flags, hash)
    }
}

fuzz_target!(|data: &[u8]| {
    let mut input = Input(data);
    // SAFETY: plain calls of the C API with memory that lives long enough.
    unsafe {
        let mut grid_def = capi::taut_grid_def_default();
        (grid_def.rows, grid_def.columns) = (2 + u32::from(input.u8() % 24), 2 + u32::from(input.u8() % 34));
        grid_def.families = 1 | u32::from(input.u8()) & 6;
        let particles = grid_def.rows * grid_def.columns;
        let (_grid_block, grid) = capi::grid(&grid_def);
        assert!(!grid.is_null());
        let mut def = capi::taut_cloth_def_default(grid);
        def.features = input.u32() & FEATURES;
        let options = input.u8();
        def.budget = u32::from(options & 1);
        def.inertia_radius_m = if options & 2 != 0 { 0.3 } else { 0.0 };
        def.sleep_speed_m_s = if options & 4 != 0 { 0.5 } else { 0.0 };
        def.solver = if def.features & IMPLICIT != 0 { u32::from(options >> 4) % 3 } else { 0 };
        def.v_axis = if options & 8 != 0 { [0.0, 0.0, 1.0] } else { def.v_axis };
        def.substeps = 1 + u32::from(input.u8() % 3);
        def.cg_iterations = 1 + u32::from(input.u8() % 4);
        def.hinge_rigidity_n_m = input.near().abs();
        let limits = input.u8();
        def.level_cycles = u32::from(limits) % 3;
        def.strain_passes = 1 + u32::from(limits >> 2) % 3;
        def.strain_limit = [[0.05, 0.0, 0.01, 0.5][usize::from(limits >> 4) % 4]; 3];
        def.tether_slack = [[0.0, 0.03][usize::from(limits >> 6) % 2]; 3];
        def.speed_limit = if limits & 128 != 0 { 8.0 } else { def.speed_limit };
        let mut memory = Memory { size: 0, align: 0 };
        if capi::taut_cloth_memory(grid, &def, &mut memory) != OK {
            return;
        }
        let (mut block, mut cloth) = (Block::new(memory.size), null_mut());
        assert_eq!(capi::taut_cloth_create(grid, &def, block.at(), memory.size, &mut cloth), OK);
        let k = [input.near(), input.near(), input.near(), input.near()].map(|k| 1e3 * k.abs());
        if capi::taut_cloth_set_stiffness_uniform(cloth, k[0], k[1], k[2], k[3]) != OK {
            return;
        }
        let mut largest = 0;
        assert_eq!(capi::taut_cloth_snapshot_size_max(cloth, &mut largest), OK);
        let (mut ids, mut bytes) = (Vec::new(), vec![0u8; largest]);
        for _ in 0..48 {
            if input.is_empty() {
                break;
            }
            match input.u8() % 18 {
                0 => _ = capi::taut_cloth_pin(cloth, u32::from(input.u8()) % particles),
                1 => {
                    let (p, to) = (u32::from(input.u8()) % particles, three(&mut input).map(f64::from));
                    capi::taut_cloth_pin_move(cloth, p, to.as_ptr());
                }
                2 => {
                    let (p, to) = (u32::from(input.u8()) % particles, three(&mut input));
                    capi::taut_cloth_set_position(cloth, p, to.as_ptr());
                }
                3 => {
                    let (p, v) = (u32::from(input.u8()) % particles, three(&mut input));
                    capi::taut_cloth_set_velocity(cloth, p, v.as_ptr());
                }
                4 => {
                    let (p, f) = (u32::from(input.u8()) % particles, three(&mut input));
                    capi::taut_cloth_add_force(cloth, p, f.as_ptr());
                }
                5 => {
                    let wind_m_s = three(&mut input);
                    let air = Air { wind_m_s, gust: input.near().abs(), ..capi::taut_air_default() };
                    capi::taut_cloth_set_air(cloth, &air);
                }
                6 => {
                    let (def, mut id) = (collider(&mut input), 0);
                    if capi::taut_cloth_collider_add(cloth, &def, &mut id) == OK {
                        ids.push(id);
                    }
                }
                7 => {
                    let (id, to) = (input.pick(&ids).unwrap_or(0), pose(&mut input));
                    match input.u8() % 3 {
                        0 => _ = capi::taut_cloth_collider_move(cloth, id, &to),
                        1 => _ = capi::taut_cloth_collider_set_pose(cloth, id, &to),
                        _ => _ = capi::taut_cloth_collider_remove(cloth, id),
                    }
                }
                8 => {
                    let seed = input.u8() | 1;
                    let there: Vec<u8> = (0..particles).map(|p| (p as u8).wrapping_mul(seed) & seed & 6).collect();
                    capi::taut_cloth_set_mask(cloth, particles, there.as_ptr());
                }
                9 => {
                    let mean = def.density_kg_m2 * grid_def.width_m * grid_def.height_m / particles as f32;
                    let (all, one) = (input.near().abs(), u32::from(input.u8()));
                    let kg: Vec<f32> =
                        (0..particles).map(|p| mean * if p % 7 == one % 7 { all } else { 1.0 }).collect();
                    capi::taut_cloth_set_masses(cloth, particles, kg.as_ptr());
                }
                10 => {
                    let limits = [input.near().abs(), input.near().abs(), input.near().abs()];
                    let [most, radius, distance] = limits.map(|l| vec![l; particles as usize]);
                    let (most, radius, distance) = (most.as_ptr(), radius.as_ptr(), distance.as_ptr());
                    capi::taut_cloth_set_target_limits(cloth, particles, most, radius, distance);
                }
                11 => {
                    let (base, one, normal) = (three(&mut input).map(f64::from), three(&mut input), three(&mut input));
                    let all: Vec<[f32; 3]> =
                        (0..particles).map(|p| one.map(|x| x * p as f32 / particles as f32)).collect();
                    let normals = vec![normal; particles as usize];
                    let set =
                        if input.u8() & 1 == 0 { capi::taut_cloth_move_targets } else { capi::taut_cloth_set_targets };
                    set(cloth, base.as_ptr(), particles, all.as_ptr().cast(), normals.as_ptr().cast(), 12);
                }
                12 => {
                    let (to, shares) = (pose(&mut input), [input.near().abs(), input.near().abs()]);
                    if input.u8() & 1 == 0 {
                        capi::taut_cloth_set_frame(cloth, &to, shares[0], shares[1]);
                    } else {
                        capi::taut_cloth_teleport(cloth, &to);
                    }
                }
                13 => {
                    let [warp, weft, diagonal] = three(&mut input);
                    capi::taut_cloth_set_rest_scale(cloth, warp, weft, diagonal);
                }
                14 => _ = capi::taut_cloth_set_gravity(cloth, three(&mut input).as_ptr()),
                15 => _ = capi::taut_cloth_set_damping(cloth, input.near()),
                16 => _ = capi::taut_cloth_unpin(cloth, u32::from(input.u8()) % particles),
                _ => {
                    let (mut written, mut width) = (0, 0);
                    let out = bytes.as_mut_ptr().cast();
                    assert_eq!(capi::taut_cloth_snapshot(cloth, out, largest, &mut written), OK);
                    assert_eq!(capi::taut_cloth_width(cloth, &mut width), OK);
                    let found = frame(cloth, None);
                    for other in [Some(u32::from(input.u8()) % 5), None] {
                        assert_eq!(capi::taut_cloth_restore(cloth, bytes.as_ptr().cast(), written), OK);
                        let again = match other {
                            // refused where this machine has no such vectors
                            Some(other) => {
                                capi::taut_cloth_set_width(cloth, other);
                                let again = frame(cloth, None);
                                assert_eq!(capi::taut_cloth_set_width(cloth, width), OK);
                                again
                            }
                            None => frame(cloth, Some(8 + u32::from(input.u8() % 4))),
                        };
                        assert_eq!(again, found, "{other:?}");
                    }
                    assert_eq!(found.0 & NON_FINITE != 0, found.0 > 3, "a cause is named: {found:?}");
                }
            }
            assert!(capi::is_finite(cloth));
        }
    }
});
