//! The time integrators around the conjugate gradients.
//!
//! The history is kept as two differences, e = v_n - v_(n-1) and s = x_n - x_(n-1) - dt v_n, with which
//! v_bar = v_n + e / 3 and x_bar = x_n + (dt v_n + s) / 3. So whatever moves or stops a particle between two substeps
//! (a limit, a collider, a teleport, the caller) shifts its past along, as if it had always moved like that: a particle that
//! hits the floor is not thrown back by the speed that it had. After a substep s = (s - dt e) / 3.

use super::Implicit;
use super::gradients::System;
use super::operator::{diagonal_row, residual_row};
use crate::force::{Substep, View};
use crate::layout::{Layout, read, write};
use crate::{Cloth, Solver};

/// A substep of either integrator.
#[derive(Clone, Copy)]
struct Scheme {
    /// b in s.
    b: f32,
    /// Share of the history in what is known: 0 or 1/3.
    past: f32,
}

pub static PASSES: core::sync::atomic::AtomicU32 = core::sync::atomic::AtomicU32::new(1);
pub static THETA: core::sync::atomic::AtomicU32 = core::sync::atomic::AtomicU32::new(0);

impl Cloth<'_> {
    /// One implicit substep, its number in the frame and the share (0 to 1) of the frame that is done after it: positions
    /// and velocities of the free particles; the pins are moved.
    pub(crate) fn implicit_substep(&mut self, c: &Substep, substep: u32, share: f32) {
        let l = self.layout;
        let bdf2 = self.def.solver == Solver::Bdf2 && self.implicit.has_history();
        let scheme = if bdf2 { Scheme { b: 2.0 / 3.0 * c.dt, past: 1.0 / 3.0 } } else { Scheme { b: c.dt, past: 0.0 } };
        self.guess(c, scheme);
        self.place_pins(share);
        let passes = PASSES.load(core::sync::atomic::Ordering::Relaxed);
        for pass in 0..passes {
            if pass > 0 {
                self.move_on(c, scheme);
            }
            if l.force() {
                self.outer_forces(substep);
            }
            match (l.shear, l.bend) {
                (false, false) => self.solve::<false, false>(c, scheme.b, pass),
                (false, true) => self.solve::<false, true>(c, scheme.b, pass),
                (true, false) => self.solve::<true, false>(c, scheme.b, pass),
                (true, true) => self.solve::<true, true>(c, scheme.b, pass),
            }
        }
        self.advance(c, scheme);
        if self.def.solver == Solver::Bdf2 {
            write(self.implicit.history, 0, 1.0);
        }
    }

    fn move_on(&mut self, _c: &Substep, scheme: Scheme) {
        let l = self.layout;
        let Implicit { base, change, residual, .. } = &mut self.implicit;
        for at in 0..l.plane {
            for (((x, v), (t, dv)), base) in [&mut *self.x.x, &mut *self.x.y, &mut *self.x.z]
                .into_iter()
                .zip([&mut *self.v.x, &mut *self.v.y, &mut *self.v.z])
                .zip([&mut *residual.x, &mut *residual.y, &mut *residual.z].into_iter().zip([
                    &mut *change.x,
                    &mut *change.y,
                    &mut *change.z,
                ]))
                .zip([&*base.x, &*base.y, &*base.z])
            {
                let d = read(dv, at);
                let vn = read(v, at) + d;
                let xn = read(x, at) + scheme.b * d;
                write(v, at, vn);
                write(x, at, xn);
                write(t, at, vn - read(base, at));
                write(dv, at, 0.0);
            }
        }
    }

    fn guess(&mut self, c: &Substep, scheme: Scheme) {
        let l = self.layout;
        let known = 1.0 / (1.0 + scheme.b * c.damping);
        let mass = 1.0 + scheme.b * c.damping;
        let Implicit { history, base, change, residual, linear, .. } = &mut self.implicit;
        let [e, s] = differences(&l, history);
        let theta = f32::from_bits(THETA.load(core::sync::atomic::Ordering::Relaxed));
        let axes = e.into_iter().zip(s).zip([&mut *self.x.x, &mut *self.x.y, &mut *self.x.z]);
        let axes = axes.zip([&mut *self.v.x, &mut *self.v.y, &mut *self.v.z]);
        let axes = axes.zip([&mut *residual.x, &mut *residual.y, &mut *residual.z]);
        for plane in [&mut *change.x, &mut *change.y, &mut *change.z] {
            plane.fill(0.0);
        }
        let axes = axes.zip([&mut *change.x, &mut *change.y, &mut *change.z]).zip([&mut *base.x, &mut *base.y, &mut *base.z]);
        for ((((((e, s), x), v), t), dv), base) in axes {
            for row in 0..l.rows {
                let cut = l.row(row)..l.row(row) + l.width;
                let (Some(e), Some(s), Some(x), Some(v), Some(t)) = (
                    e.get_mut(cut.clone()),
                    s.get(cut.clone()),
                    x.get_mut(cut.clone()),
                    v.get_mut(cut.clone()),
                    t.get_mut(cut),
                ) else {
                    return;
                };
                let Some(dv) = dv.get_mut(l.row(row)..l.row(row) + l.width) else { return };
                let Some(base) = base.get_mut(l.row(row)..l.row(row) + l.width) else { return };
                for ((((((e, s), x), v), t), dv), base) in e.iter_mut().zip(s).zip(x).zip(v).zip(t).zip(dv).zip(base) {
                    *base = known * (*v + scheme.past * *e);
                    let v_bar = *v + scheme.past * *e;
                    let way = scheme.past * (c.dt * *v + s);
                    let guess = *v + theta.abs() % 10.0 * *e;
                    *e = *v;
                    if theta >= 0.0 {
                        *v = guess;
                        *x = *x + way + scheme.b * *v;
                    } else {
                        *v = -way / scheme.b;
                        *dv = guess - *v;
                    }
                    *t = *v - known * v_bar;
                }
            }
        }
        for row in 0..l.rows {
            let cut = l.row(row)..l.row(row) + l.width;
            let (Some(to), Some(w)) = (linear.mass.get_mut(cut.clone()), self.inverse.get(cut)) else {
                return;
            };
            for (m, w) in to.iter_mut().zip(w) {
                *m = if *w > 0.0 { mass / w } else { 0.0 };
            }
            for at in l.row(row)..l.row(row) + l.width {
                let f = if read(linear.mass, at) > 0.0 { 1.0 } else { 0.0 };
                write(linear.free, at, f);
            }
        }
        for at in 0..l.plane {
            if read(linear.mass, at) == 0.0 {
                write(change.x, at, 0.0);
                write(change.y, at, 0.0);
                write(change.z, at, 0.0);
            }
        }
    }

    fn solve<const SHEAR: bool, const BEND: bool>(&mut self, c: &Substep, b: f32, pass: u32) {
        let l = self.layout;
        let x = self.x.view();
        let outer = if l.force() {
            [&*self.force[0], &*self.force[1], &*self.force[2]]
        } else if self.has_pull {
            [&*self.pull[0], &*self.pull[1], &*self.pull[2]]
        } else {
            [&[][..]; 3]
        };
        let Implicit { change, residual, search, image, linear, blocks, coarse, .. } = &mut self.implicit;
        linear.linearise(&l, c, x, &self.springs);
        for row in 0..l.rows {
            residual_row::<SHEAR, BEND>(&l, row, b, c.weight, x, linear, outer, residual);
        }
        linear.clamp(&l, b);
        for row in 0..l.rows {
            diagonal_row::<SHEAR, BEND>(&l, row, x, linear, blocks);
        }
        super::coarse::prepare(&l, linear.mass, blocks.each_ref().map(|p| &**p), coarse);
        for row in 0..l.rows {
            super::blocks::invert_row(&l, row, linear.mass, blocks);
        }
        let theta = f32::from_bits(THETA.load(core::sync::atomic::Ordering::Relaxed));
        if theta < 0.0 && pass == 0 {
            for row in 0..l.rows {
                super::operator::apply_row::<SHEAR, BEND>(&l, row, x, linear, change.view(), image);
                for (r, q) in [(&mut *residual.x, &*image.x), (&mut *residual.y, &*image.y), (&mut *residual.z, &*image.z)] {
                    for at in l.row(row)..l.row(row) + l.width {
                        let d = read(r, at) - read(q, at);
                        write(r, at, d);
                    }
                }
            }
        }
        let system = System { l: &l, x, linear, blocks: blocks.each_ref().map(|p| &**p) };
        system.solve::<SHEAR, BEND>(self.def.cg_iterations, change, residual, search, image, coarse);
    }

    fn advance(&mut self, c: &Substep, scheme: Scheme) {
        let l = self.layout;
        let Implicit { history, change, .. } = &mut self.implicit;
        let [e, s] = differences(&l, history);
        let axes = e.into_iter().zip(s).zip([&mut *self.x.x, &mut *self.x.y, &mut *self.x.z]);
        let axes = axes.zip([&mut *self.v.x, &mut *self.v.y, &mut *self.v.z]).zip([&*change.x, &*change.y, &*change.z]);
        for ((((e, s), x), v), dv) in axes {
            for row in 0..l.rows {
                for at in l.row(row)..l.row(row) + l.width {
                    let dv = read(dv, at);
                    let w = read(self.inverse, at);
                    let xn = read(x, at) + scheme.b * dv;
                    write(x, at, xn);
                    let vn = read(v, at) + dv;
                    write(v, at, vn);
                    let en = if w > 0.0 { vn - read(e, at) } else { 0.0 };
                    let sn = if w > 0.0 { scheme.past * (read(s, at) - c.dt * en) } else { 0.0 };
                    write(e, at, en);
                    write(s, at, sn);
                }
            }
        }
    }
}

/// The planes of e and s in the history.
fn differences<'a>(l: &Layout, history: &'a mut [f32]) -> [[&'a mut [f32]; 3]; 2] {
    let (_, planes) = history.split_at_mut_checked(super::FLAGS).unwrap_or((&mut [], &mut []));
    let mut planes = planes.chunks_exact_mut(l.plane.max(1));
    let mut three = || core::array::from_fn(|_| planes.next().unwrap_or(&mut []));
    [three(), three()]
}

#[allow(unused)]
fn unused(_: View<'_>) {}
