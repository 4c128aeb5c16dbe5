//! The optional parts of a substep, in their order.

use crate::Cloth;
use crate::force::Substep;
use crate::layout::copy;

impl Cloth<'_> {
    /// The forces beside the springs, in N, summed in the planes that the velocity pass adds: the pull, the weight where
    /// particles have masses of their own, hinges, air.
    pub(crate) fn outer_forces(&mut self, substep: u32) {
        let l = self.layout;
        if substep > 0 && !l.hinge && !l.air {
            // pull and weight are the same in the whole frame
            return;
        }
        for (force, pull) in self.force.iter_mut().zip(&self.pull) {
            if self.has_pull {
                copy(force, pull);
            } else {
                force.fill(0.0);
            }
        }
        if l.mass {
            self.add_weight();
        }
        if l.hinge {
            self.add_hinges();
        }
        if l.air {
            self.add_air(substep);
        }
    }

    /// What moves the particles after they were stepped, `share` (0 to 1) of the frame done: limits first, contacts last, so
    /// that nothing ends inside a collider.
    pub(crate) fn constrain(&mut self, c: &Substep, share: f32) {
        let l = self.layout;
        if l.tethers && !l.levels {
            self.apply_tethers(c);
        }
        if l.levels {
            self.apply_levels(c);
        } else if l.strain_limit {
            self.apply_strain_limit(c);
        }
        if l.targets {
            self.apply_targets(c, share);
        }
        if l.max_colliders > 0 {
            self.apply_colliders(c, share);
        }
    }
}
