//! The optional parts of a substep, in their order. They work on some rows, all of them or those of a band, and write only
//! what belongs to these.

use crate::air::{Blow, Weather};
use crate::contact;
use crate::force::{Substep, View};
use crate::hinge::{Bend, Factors};
use crate::layout::{Layout, copy, span};
use crate::targets::Hold;
use crate::width::Supported;
use crate::{Cloth, masses, simd};

/// What the forces of a frame beside those of the springs follow from; nothing of it changes in the frame.
#[derive(Clone, Copy)]
pub(crate) struct Outer {
    weather: Option<Weather>,
    hinges: Option<Factors>,
    /// Where particles have masses of their own, whose weight is not among the constants of the substep.
    gravity: Option<[f32; 3]>,
}

/// Some rows of a cloth whose forces are worked out.
pub(crate) struct Loads<'p> {
    pub layout: &'p Layout,
    /// The rows, from and to.
    pub rows: [usize; 2],
    /// Planes of the cloth.
    pub x: View<'p>,
    pub v: View<'p>,
    pub inverse: &'p [f32],
    pub mask: &'p [f32],
    pub masses: &'p [f32],
    /// The pull, if there is any.
    pub pull: Option<[&'p [f32]; 3]>,
    /// The forces of these rows in N, which the velocity pass adds.
    pub force: [&'p mut [f32]; 3],
}

impl Outer {
    /// The forces of a substep (from 0 on) beside the springs: the pull, the weight, hinges, air, in this order.
    pub fn sum(&self, width: Supported, substep: u32, mut to: Loads<'_>) {
        let (l, rows) = (to.layout, to.rows);
        if substep > 0 && !l.hinge && !l.air {
            // pull and weight are the same in the whole frame
            return;
        }
        match to.pull {
            Some(pull) => {
                for (force, pull) in to.force.iter_mut().zip(pull) {
                    copy(force, span(pull, l.row(rows[0]), force.len()));
                }
            }
            None => to.force.iter_mut().for_each(|force| force.fill(0.0)),
        }
        if let Some(gravity) = self.gravity {
            masses::add_weight(l, rows, to.masses, gravity, &mut to.force);
        }
        if let Some(factors) = self.hinges {
            let force = to.force.each_mut().map(|f| &mut **f);
            let x = [to.x.x, to.x.y, to.x.z];
            simd::run(width, Bend { layout: l, factors, rows, x, mask: to.mask, force });
        }
        if let Some(weather) = &self.weather {
            let Loads { x, v, inverse, mask, force, .. } = to;
            simd::run(width, Blow { layout: l, flow: weather.flow(substep), rows, x, v, inverse, mask, force });
        }
    }
}

/// What holds the particles of some rows after they were moved: targets, then colliders, so that nothing ends inside one.
pub(crate) struct Holders<'p> {
    pub layout: &'p Layout,
    /// Of the targets and of the colliders; empty without.
    pub targets: &'p [f32],
    pub colliders: &'p [f32],
    pub rate_hz: f32,
    pub substeps: u32,
    /// Smallest rest length in m.
    pub spacing: f32,
}

/// Some rows of a cloth whose particles are held.
pub(crate) struct Held<'p> {
    /// The rows, from and to.
    pub rows: [usize; 2],
    /// Positions, velocities and inverse masses of these rows.
    pub x: [&'p mut [f32]; 3],
    pub v: [&'p mut [f32]; 3],
    pub inverse: &'p [f32],
}

impl Holders<'_> {
    /// Holds them as targets and colliders are at `share` (0 to 1) of the frame.
    pub fn hold(&self, width: Supported, c: &Substep, share: f32, mut of: Held<'_>) {
        if !self.targets.is_empty() {
            let x = of.x.each_mut().map(|p| &mut **p);
            let v = of.v.each_mut().map(|p| &mut **p);
            let (layout, targets, rate_hz) = (self.layout, self.targets, self.rate_hz);
            simd::run(width, Hold { layout, targets, rate_hz, share, rows: of.rows, x, v, inverse: of.inverse });
        }
        if !self.colliders.is_empty() {
            contact::push_out(self, width, c, share, of);
        }
    }
}

impl Cloth<'_> {
    /// The forces of this frame beside those of the springs.
    pub(crate) fn outer(&self) -> Outer {
        Outer {
            weather: self.weather(),
            hinges: self.hinge_factors(),
            gravity: self.layout.mass.then(|| self.ambient.gravity()),
        }
    }

    /// The forces beside the springs on all particles.
    pub(crate) fn outer_forces(&mut self, substep: u32) {
        let (l, outer) = (self.layout, self.outer());
        let [x, y, z] = &self.pull;
        let loads = Loads {
            layout: &l,
            rows: [0, l.rows],
            x: self.x.view(),
            v: self.v.view(),
            inverse: self.inverse,
            mask: self.mask,
            masses: self.masses,
            pull: self.has_pull.then_some([&**x, &**y, &**z]),
            force: self.force.each_mut().map(|plane| l.all_rows_mut(plane)),
        };
        outer.sum(self.width, substep, loads);
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
        if l.targets || l.max_colliders > 0 {
            let holders = Holders {
                layout: &l,
                targets: self.targets.planes,
                colliders: self.colliders.numbers,
                rate_hz: self.def.rate_hz,
                substeps: self.def.substeps,
                spacing: self.grid.least_rest(),
            };
            let held = Held {
                rows: [0, l.rows],
                x: [&mut *self.x.x, &mut *self.x.y, &mut *self.x.z].map(|plane| l.all_rows_mut(plane)),
                v: [&mut *self.v.x, &mut *self.v.y, &mut *self.v.z].map(|plane| l.all_rows_mut(plane)),
                inverse: l.all_rows(self.inverse),
            };
            holders.hold(self.width, c, share, held);
        }
    }
}
