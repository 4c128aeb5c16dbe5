//! The functions of include/taut.h that the targets call.
#![allow(dead_code, reason = "every target uses its own part")]

use std::ffi::c_void;

#[path = "../../ffi/src/types.rs"]
mod types;

pub use types::{Air, BudgetReport, ClothDef, ColliderDef, GridDef, Memory, Pose, PositionView, Strain};

/// TAUT_OK.
pub const OK: i32 = 0;

unsafe extern "C" {
    pub fn taut_grid_def_default() -> GridDef;
    pub fn taut_grid_create(def: *const GridDef, block: *mut c_void, size: usize, out: *mut *mut c_void) -> i32;
    pub fn taut_cloth_def_default(grid: *const c_void) -> ClothDef;
    pub fn taut_cloth_memory(grid: *const c_void, def: *const ClothDef, out: *mut Memory) -> i32;
    pub fn taut_cloth_create(
        grid: *const c_void,
        def: *const ClothDef,
        block: *mut c_void,
        size: usize,
        out: *mut *mut c_void,
    ) -> i32;
    pub fn taut_cloth_reset(cloth: *mut c_void) -> i32;
    pub fn taut_cloth_set_stiffness_uniform(cloth: *mut c_void, a: f32, b: f32, c: f32, d: f32) -> i32;
    pub fn taut_cloth_set_stiffness_field(cloth: *mut c_void, c: u32, m: u32, n: u32, data: *const f32) -> i32;
    pub fn taut_cloth_set_stiffness_field_sanitised(
        cloth: *mut c_void,
        c: u32,
        m: u32,
        n: u32,
        data: *const f32,
        out: *mut u32,
    ) -> i32;
    pub fn taut_cloth_load_stiffness(cloth: *mut c_void, data: *const c_void, size: usize, out: *mut c_void) -> i32;
    pub fn taut_cloth_budget(cloth: *mut c_void, out: *mut BudgetReport) -> i32;
    pub fn taut_cloth_pin(cloth: *mut c_void, particle: u32) -> i32;
    pub fn taut_cloth_pin_move(cloth: *mut c_void, particle: u32, world_m: *const f64) -> i32;
    pub fn taut_cloth_unpin(cloth: *mut c_void, particle: u32) -> i32;
    pub fn taut_cloth_set_position(cloth: *mut c_void, particle: u32, local_m: *const f32) -> i32;
    pub fn taut_cloth_set_velocity(cloth: *mut c_void, particle: u32, v_m_s: *const f32) -> i32;
    pub fn taut_cloth_add_force(cloth: *mut c_void, particle: u32, force_n: *const f32) -> i32;
    pub fn taut_cloth_step_many(cloth: *mut c_void, count: u32, flags: *mut u32) -> i32;
    pub fn taut_cloth_positions(cloth: *const c_void, out: *mut PositionView) -> i32;
    pub fn taut_cloth_copy_velocities_f32(cloth: *const c_void, out: *mut c_void, size: usize, stride: usize) -> i32;
    pub fn taut_cloth_strain(cloth: *const c_void, out: *mut Strain) -> i32;
    pub fn taut_cloth_kinetic_energy(cloth: *const c_void, out: *mut f64) -> i32;
    pub fn taut_cloth_snapshot_size_max(cloth: *const c_void, out: *mut usize) -> i32;
    pub fn taut_cloth_snapshot(cloth: *mut c_void, out: *mut c_void, size: usize, written: *mut usize) -> i32;
    pub fn taut_cloth_restore(cloth: *mut c_void, data: *const c_void, size: usize) -> i32;
    pub fn taut_cloth_state_hash(cloth: *mut c_void, out: *mut u64) -> i32;
    pub fn taut_cloth_set_mask(cloth: *mut c_void, count: u32, present: *const u8) -> i32;
    pub fn taut_cloth_set_masses(cloth: *mut c_void, count: u32, mass_kg: *const f32) -> i32;
    pub fn taut_cloth_set_gravity(cloth: *mut c_void, gravity_m_s2: *const f32) -> i32;
    pub fn taut_cloth_set_damping(cloth: *mut c_void, damping_per_s: f32) -> i32;
    pub fn taut_cloth_set_rest_scale(cloth: *mut c_void, warp: f32, weft: f32, diagonal: f32) -> i32;
    pub fn taut_collider_def_default(shape: u32) -> ColliderDef;
    pub fn taut_cloth_collider_add(cloth: *mut c_void, def: *const ColliderDef, out: *mut u32) -> i32;
    pub fn taut_cloth_collider_move(cloth: *mut c_void, id: u32, pose: *const Pose) -> i32;
    pub fn taut_cloth_collider_set_pose(cloth: *mut c_void, id: u32, pose: *const Pose) -> i32;
    pub fn taut_cloth_collider_remove(cloth: *mut c_void, id: u32) -> i32;
    pub fn taut_cloth_set_target_limits(
        cloth: *mut c_void,
        count: u32,
        max_distance_m: *const f32,
        backstop_radius_m: *const f32,
        backstop_distance_m: *const f32,
    ) -> i32;
    pub fn taut_cloth_move_targets(
        cloth: *mut c_void,
        base_m: *const f64,
        count: u32,
        positions_m: *const c_void,
        normals: *const c_void,
        stride: usize,
    ) -> i32;
    pub fn taut_cloth_set_targets(
        cloth: *mut c_void,
        base_m: *const f64,
        count: u32,
        positions_m: *const c_void,
        normals: *const c_void,
        stride: usize,
    ) -> i32;
    pub fn taut_air_default() -> Air;
    pub fn taut_cloth_set_air(cloth: *mut c_void, air: *const Air) -> i32;
    pub fn taut_cloth_set_frame(cloth: *mut c_void, frame: *const Pose, linear: f32, angular: f32) -> i32;
    pub fn taut_cloth_teleport(cloth: *mut c_void, frame: *const Pose) -> i32;
    pub fn taut_cloth_width(cloth: *const c_void, out: *mut u32) -> i32;
    pub fn taut_cloth_set_width(cloth: *mut c_void, number: u32) -> i32;
    pub fn taut_cloth_bands_memory(cloth: *const c_void, rows_per_band: u32, out: *mut Memory) -> i32;
    pub fn taut_cloth_bands_begin(
        cloth: *mut c_void,
        rows_per_band: u32,
        block: *mut c_void,
        size: usize,
        out: *mut *mut c_void,
    ) -> i32;
    pub fn taut_bands_count(bands: *const c_void, count: *mut u32, phases: *mut u32) -> i32;
    pub fn taut_bands_run(bands: *const c_void, phase: u32, band: u32) -> i32;
    pub fn taut_bands_end(bands: *mut c_void, out_flags: *mut u32) -> i32;
}

/// A block of memory, aligned for everything.
pub struct Block(Vec<[u64; 8]>, usize);

impl Block {
    pub fn new(bytes: usize) -> Block {
        // 64 bytes more, from which the first aligned byte is found
        Block(vec![[0; 8]; bytes.div_ceil(64) + 1], bytes)
    }

    pub fn at(&mut self) -> *mut c_void {
        let start = self.0.as_mut_ptr().cast::<u8>();
        start.wrapping_add(start.align_offset(64)).cast()
    }

    pub fn size(&self) -> usize {
        self.1
    }
}

/// A grid in a block of its own; null where it is refused.
///
/// # Safety
/// The grid is used only as long as the block is kept.
pub unsafe fn grid(def: &GridDef) -> (Block, *mut c_void) {
    let (mut block, mut grid) = (Block::new(64), std::ptr::null_mut());
    // SAFETY: a definition, and a block of the size that it is said to have.
    unsafe { taut_grid_create(def, block.at(), 64, &mut grid) };
    (block, grid)
}

/// Whether every position is finite.
///
/// # Safety
/// A cloth.
pub unsafe fn is_finite(cloth: *const c_void) -> bool {
    let mut view = std::mem::MaybeUninit::<PositionView>::uninit();
    // SAFETY: the view's arrays have rows of `columns` numbers, `row_stride` apart.
    unsafe {
        assert_eq!(taut_cloth_positions(cloth, view.as_mut_ptr()), OK);
        let v = view.assume_init();
        (0..v.rows).all(|r| {
            (0..v.columns).all(|c| [v.x, v.y, v.z].iter().all(|p| p.add(r * v.row_stride + c).read().is_finite()))
        })
    }
}
