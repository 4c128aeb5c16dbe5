//! Bullet's btSoftBody: position-based links, one soft body in a btSoftRigidDynamicsWorld.

use std::ffi::c_void;

use crate::scene::{DAMPING_PER_S, Engine, MASS_KG, RATE_HZ, SIDE_M};

unsafe extern "C" {
    fn bullet_new(
        side: i32,
        substeps: i32,
        iterations: i32,
        side_m: f64,
        mass_kg: f64,
        damping_per_s: f64,
        rate_hz: f64,
    ) -> *mut c_void;
    fn bullet_step(scene: *mut c_void);
    fn bullet_positions(scene: *const c_void, xyz: *mut f32);
    fn bullet_delete(scene: *mut c_void);
}

/// A sheet in Bullet.
pub struct Bullet {
    scene: *mut c_void,
    side: usize,
}

impl Bullet {
    /// `iterations` of the position solver in each substep.
    pub fn new(side: usize, substeps: u32, iterations: u32) -> Bullet {
        // SAFETY: the function takes any numbers above 0.
        let scene = unsafe {
            bullet_new(side as i32, substeps as i32, iterations as i32, SIDE_M, MASS_KG, DAMPING_PER_S, RATE_HZ)
        };
        Bullet { scene, side }
    }
}

impl Drop for Bullet {
    fn drop(&mut self) {
        // SAFETY: made by `bullet_new`, deleted once.
        unsafe { bullet_delete(self.scene) }
    }
}

impl Engine for Bullet {
    fn step(&mut self) {
        // SAFETY: alive until dropped.
        unsafe { bullet_step(self.scene) }
    }

    fn positions(&self, to: &mut Vec<[f32; 3]>) {
        to.resize(self.side * self.side, [0.0; 3]);
        // SAFETY: there are as many nodes as places.
        unsafe { bullet_positions(self.scene, to.as_mut_ptr().cast()) }
    }
}
