//! The forces that hold the pins.

use crate::force::Substep;
use crate::layout::read;
use crate::math::{max, sqrt};
use crate::{Cloth, Error, Vector3};

impl Cloth<'_> {
    /// Force in N with which a pin holds its particle in the state as it is now: the opposite of springs, weight, pull, air
    /// and hinges on the particle. What it is pinned to feels the opposite force. Nothing is stored: it is computed
    /// when asked, at the cost of a particle, or of a pass over the cloth where air, hinges or masses are on; so ask for
    /// many with [`Cloth::pin_forces`].
    ///
    /// It is a force at rest: in a cloth that hangs still the sum over the pins is the weight of the sheet. In motion it
    /// swings with the springs, and what accelerates the pin's own particle is not in it. What tethers, strain limit,
    /// levels, colliders and targets carry is not a force but a displacement, and is missing here: with them the sum
    /// is less than the weight.
    ///
    /// Errors: [`Error::NoSuchParticle`], [`Error::NotPinned`].
    pub fn pin_force(&mut self, particle: usize) -> Result<Vector3<f32>, Error> {
        let at = self.layout.place(particle)?;
        if self.pins.find(particle).is_err() {
            return Err(Error::NotPinned);
        }
        let c = self.prepare_forces();
        Ok(self.holding(at, &c))
    }

    /// Every pinned particle, ascending, with its force as [`Cloth::pin_force`] tells it.
    pub fn pin_forces(&mut self) -> impl Iterator<Item = (usize, Vector3<f32>)> {
        let c = self.prepare_forces();
        let cloth = &*self;
        cloth.pins.iter().map(move |pin| {
            let force = cloth.layout.place(pin.particle).map_or(Vector3::zeros(), |at| cloth.holding(at, &c));
            (pin.particle, force)
        })
    }

    fn prepare_forces(&mut self) -> Substep {
        self.refresh(true);
        if self.layout.force() {
            self.outer_forces(0);
        }
        self.constants()
    }

    /// The opposite of all forces on the particle at a place, summed in the order of the step.
    fn holding(&self, at: usize, c: &Substep) -> Vector3<f32> {
        let (s, k) = (self.layout.stride, &self.springs);
        // the other end, the plane and place of the stiffness, the rest length
        let springs: [(usize, &[f32], usize, f32); 12] = [
            (at + 1, k.u, at, c.rest_u),
            (at - 1, k.u, at - 1, c.rest_u),
            (at + s, k.v, at, c.rest_v),
            (at - s, k.v, at - s, c.rest_v),
            (at + s + 1, k.right, at, c.rest_diagonal),
            (at - s - 1, k.right, at - s - 1, c.rest_diagonal),
            (at + s - 1, k.left, at, c.rest_diagonal),
            (at - s + 1, k.left, at - s + 1, c.rest_diagonal),
            (at + 2, k.bend_u, at, 2.0 * c.rest_u),
            (at - 2, k.bend_u, at - 2, 2.0 * c.rest_u),
            (at + 2 * s, k.bend_v, at, 2.0 * c.rest_v),
            (at - 2 * s, k.bend_v, at - 2 * s, 2.0 * c.rest_v),
        ];
        let here = Vector3::from(self.local(at));
        let mut sum = Vector3::zeros();
        for (other, plane, place, rest) in springs {
            let d = Vector3::from(self.local(other)) - here;
            let length = sqrt(max(d.x * d.x + d.y * d.y + d.z * d.z, crate::force::TINY));
            sum += d * (read(plane, place) * max(1.0 - rest / length, c.floor));
        }
        let outer = if self.layout.force() { &self.force } else { &self.pull };
        -(sum + Vector3::from(c.weight) + Vector3::from([0, 1, 2].map(|a| outer.get(a).map_or(0.0, |p| read(p, at)))))
    }
}
