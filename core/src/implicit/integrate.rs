//! The time integrators around the conjugate gradients.
//!
//! The history of BDF2 is kept as two differences, e = v_n - v_(n-1) and s = x_n - x_(n-1) - dt v_n, with which
//! v_bar = v_n + e / 3 and x_bar = x_n + (dt v_n + s) / 3. So whatever moves or stops a particle between two substeps
//! (a limit, a collider, a teleport, the caller) shifts its past along, as if it had always moved like that: a particle
//! that hits the floor is not thrown back by the speed that it had. After a substep s becomes (s - dt e) / 3.

use super::gradients::{Image, System, Work};
use super::operator::{Diagonal, Linearise, Residual};
use super::{FLAGS, Implicit, blocks, coarse};
use crate::force::{Planes, Substep};
use crate::layout::{Layout, span, write};
use crate::{Cloth, Solver, simd};

/// Springs are linearised this often in a substep: once where they are, which is safe, and once where that leads, which is
/// accurate. Once alone loses the swing, since it takes the turning of a spring for a stretch that must be stopped.
const LINEARISATIONS: u32 = 2;

/// A substep of either integrator.
#[derive(Clone, Copy)]
struct Scheme {
    /// b in s.
    b: f32,
    /// Share of the history in what is known: 0 or 1/3.
    past: f32,
    /// 1 + b c.
    damped: f32,
}

impl Planes<'_> {
    fn axes(&mut self) -> [&mut [f32]; 3] {
        [&mut *self.x, &mut *self.y, &mut *self.z]
    }
}

/// A row of a plane that is written.
#[inline(always)]
fn row_mut<'a>(l: &Layout, row: usize, plane: &'a mut [f32]) -> &'a mut [f32] {
    let at = l.row(row);
    plane.get_mut(at..at + l.width).unwrap_or(&mut [])
}

/// A row of a plane that is read.
#[inline(always)]
fn row_of<'a>(l: &Layout, row: usize, plane: &'a [f32]) -> &'a [f32] {
    span(plane, l.row(row), l.width)
}

impl Cloth<'_> {
    /// One implicit substep, its number in the frame and the share (0 to 1) of the frame that is done after it: positions
    /// and velocities of the free particles; the pins are moved.
    pub(crate) fn implicit_substep(&mut self, c: &Substep, substep: u32, share: f32) {
        let l = self.layout;
        let bdf2 = self.def.solver == Solver::Bdf2;
        let (b, past) = if bdf2 && self.implicit.has_history() { (2.0 / 3.0 * c.dt, 1.0 / 3.0) } else { (c.dt, 0.0) };
        let scheme = Scheme { b, past, damped: 1.0 + b * c.damping };
        if l.force() {
            self.outer_forces(substep);
        }
        self.weigh(scheme);
        self.begin(c, scheme);
        self.place_pins(share);
        for linearisation in 0..LINEARISATIONS {
            let again = linearisation > 0;
            if again {
                self.apply_change(b);
                if l.force() {
                    self.outer_forces(substep);
                }
            }
            self.find_change(c, b, again);
        }
        self.apply_change(b);
        if bdf2 {
            self.remember(c, past);
        }
    }

    /// Which particles are free, and their mass in the operator.
    fn weigh(&mut self, scheme: Scheme) {
        let l = self.layout;
        let linear = &mut self.implicit.linear;
        for row in 0..l.rows {
            let to = row_mut(&l, row, linear.mass).iter_mut().zip(row_mut(&l, row, linear.free));
            for ((mass, free), inverse) in to.zip(row_of(&l, row, self.inverse)) {
                let is_free = *inverse > 0.0;
                *mass = if is_free { scheme.damped / *inverse } else { 0.0 };
                *free = if is_free { 1.0 } else { 0.0 };
            }
        }
    }

    /// Starts with x_g = x_n, so v_g = (x_n - x_bar) / b, and the change that leads to v_n.
    fn begin(&mut self, c: &Substep, scheme: Scheme) {
        let l = self.layout;
        let Implicit { history, known, change, linear, .. } = &mut self.implicit;
        let planes = differences(&l, history).into_iter().zip(self.v.axes());
        for ((([e, s], v), known), change) in planes.zip(known.axes()).zip(change.axes()) {
            for row in 0..l.rows {
                let past = row_mut(&l, row, e).iter_mut().zip(row_of(&l, row, s));
                let free = row_of(&l, row, linear.free);
                let to = row_mut(&l, row, known).iter_mut().zip(row_mut(&l, row, change)).zip(free);
                for (((e, s), v), ((known, change), free)) in past.zip(row_mut(&l, row, v)).zip(to) {
                    let now = *v;
                    *known = (now + scheme.past * *e) / scheme.damped;
                    *v = -(scheme.past * (c.dt * now + s)) / scheme.b;
                    *change = free * (now - *v);
                    // v_n, for `remember`
                    *e = now;
                }
            }
        }
    }

    /// Solves for the change of the velocities, from the one that is there.
    fn find_change(&mut self, c: &Substep, b: f32, again: bool) {
        let l = self.layout;
        let x = self.x.view();
        let outer = if l.force() {
            [&*self.force[0], &*self.force[1], &*self.force[2]]
        } else if self.has_pull {
            [&*self.pull[0], &*self.pull[1], &*self.pull[2]]
        } else {
            [&[][..]; 3]
        };
        let Implicit { known, change, residual, search, image, linear, blocks, coarse, .. } = &mut self.implicit;
        let (width, v) = (self.width, self.v.view());
        simd::run(width, Linearise { l: &l, c, x, springs: &self.springs, linear });
        let (weight, known) = (c.weight, known.view());
        simd::run(width, Residual { l: &l, b, weight, x, v, known, linear, outer, residual });
        simd::run(width, Diagonal { l: &l, b, x, linear, blocks });
        coarse::prepare(width, &l, linear.mass, blocks.each_ref().map(|p| &**p), coarse);
        simd::run(width, blocks::Invert { l: &l, mass: linear.mass, blocks });
        if !again {
            simd::run(width, Image { l: &l, x, linear, share: None, search: change, image, carry: self.carry });
            for (r, q) in residual.axes().into_iter().zip(image.axes()) {
                for row in 0..l.rows {
                    for (r, q) in row_mut(&l, row, r).iter_mut().zip(row_of(&l, row, q)) {
                        *r -= q;
                    }
                }
            }
        }
        let blocks = blocks.each_ref().map(|p| &**p);
        let system = System { width, l: &l, x, linear, blocks, floating: self.pins.count == 0 };
        system.solve(
            self.def.cg_iterations,
            &mut Work { change, residual, search, image, levels: coarse, carry: self.carry },
        );
    }

    /// v += change, x += b change; the change is 0 after it.
    fn apply_change(&mut self, b: f32) {
        let l = self.layout;
        for ((x, v), change) in self.x.axes().into_iter().zip(self.v.axes()).zip(self.implicit.change.axes()) {
            for row in 0..l.rows {
                let to = row_mut(&l, row, x).iter_mut().zip(row_mut(&l, row, v));
                for ((x, v), change) in to.zip(row_mut(&l, row, change)) {
                    *x += b * *change;
                    *v += *change;
                    *change = 0.0;
                }
            }
        }
    }

    /// The history of the next substep. Pinned particles have none.
    fn remember(&mut self, c: &Substep, past: f32) {
        let l = self.layout;
        let Implicit { history, linear, .. } = &mut self.implicit;
        write(history, 0, 1.0);
        for ([e, s], v) in differences(&l, history).into_iter().zip(self.v.axes()) {
            for row in 0..l.rows {
                let to = row_mut(&l, row, e).iter_mut().zip(row_mut(&l, row, s));
                for ((e, s), (v, free)) in to.zip(row_of(&l, row, v).iter().zip(row_of(&l, row, linear.free))) {
                    *e = free * (*v - *e);
                    *s = free * (past * (*s - c.dt * *e));
                }
            }
        }
    }
}

/// The planes of e and s in the history, for x, y and z.
fn differences<'a>(l: &Layout, history: &'a mut [f32]) -> [[&'a mut [f32]; 2]; 3] {
    let (_, planes) = history.split_at_mut_checked(FLAGS).unwrap_or((&mut [], &mut []));
    let mut planes = planes.chunks_exact_mut(l.plane.max(1));
    let mut next = || planes.next().unwrap_or(&mut []);
    core::array::from_fn(|_| [next(), next()])
}
