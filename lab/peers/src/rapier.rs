//! rapier3d's soft body: distance constraints as springs of a natural frequency, solved by its soft constraint solver.

use rapier3d::prelude::*;

use crate::scene::{DAMPING_PER_S, Engine, MASS_KG, RATE_HZ, SIDE_M};

/// A sheet in rapier3d.
pub struct Rapier {
    world: PhysicsWorld,
    handle: SoftBodyHandle,
}

impl Rapier {
    /// `iterations` sweeps in each substep; links as stiff as it lets them be.
    pub fn new(side: usize, substeps: u32, iterations: u32) -> Rapier {
        let mut world = PhysicsWorld::new();
        world.gravity = Vector::new(0.0, -9.81, 0.0);
        world.integration_parameters.dt = (1.0 / RATE_HZ) as Real;
        world.integration_parameters.num_solver_iterations = substeps as usize;
        world.integration_parameters.num_internal_pgs_iterations = iterations as usize;
        // it would take up to four more substeps where particles are fast
        world.integration_parameters.soft_bodies.max_extra_substeps = 0;
        let spacing = (SIDE_M / (side - 1) as f64) as Real;
        // a frequency far above the rate of the substeps saturates
        let stiffest = SpringCoefficients::new(1.0e6, 1.0);
        // particles column by column of the builder: `i` along du, `j` along dv, index i * nv + j
        let cloth = SoftBodyBuilder::cloth(
            Vector::new(0.0, 0.0, 0.0),
            Vector::new(0.0, 0.0, spacing),
            Vector::new(spacing, 0.0, 0.0),
            side,
            side,
        )
        .pinned_particles([0, (side - 1) as u32])
        .softness(stiffest)
        .particle_mass((MASS_KG / (side * side) as f64) as Real)
        .linear_damping(DAMPING_PER_S as Real)
        .self_contacts(false)
        .no_surface_collider()
        .can_sleep(false);
        let handle = world.insert_soft_body(cloth);
        Rapier { world, handle }
    }
}

impl Engine for Rapier {
    fn step(&mut self) {
        self.world.step();
    }

    fn positions(&self, to: &mut Vec<[f32; 3]>) {
        to.clear();
        to.extend(self.world.soft_bodies[self.handle].particle_positions().map(|p| [p.x, p.y, p.z]));
    }
}
