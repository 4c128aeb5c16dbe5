//! What a collider does to the particles that touch it.

use super::near::PushOut;
use super::{Frame, Moving, NEWTON, ROUNDING, ROUNDS, Rules, SLOP_M};
use crate::simd::{Three, Vector};

impl Frame {
    /// Directions in the frame, in the axes of the cloth.
    #[inline(always)]
    fn turned<V: Vector>(&self, zero: V, y: Three<V>) -> Three<V> {
        let ([a, b, c], Three([x, y, z])) = (self.axes, y);
        Three::all(zero, a).times(x).plus(Three::all(zero, b).times(y)).plus(Three::all(zero, c).times(z))
    }

    /// Places of the cloth, in the frame.
    #[inline(always)]
    fn inside<V: Vector>(&self, zero: V, x: Three<V>) -> Three<V> {
        let d = x.minus(Three::all(zero, self.position));
        let [a, b, c] = self.axes;
        Three([Three::all(zero, a).dot(d), Three::all(zero, b).dot(d), Three::all(zero, c).dot(d)])
    }
}

/// Where particles touch a collider.
pub(super) struct Contacts<V> {
    /// 1 where they do.
    pub hit: V,
    /// Outward, in the frame of the cloth.
    pub normal: Three<V>,
    pub depth: V,
    /// The share of the substep that is left after the touch.
    pub rest: V,
    /// Where the particles end up, in the frame of the collider.
    pub place: Three<V>,
}

impl Moving {
    #[inline(always)]
    fn distance<V: Vector>(&self, zero: V, y: Three<V>) -> (V, Three<V>) {
        let (distance, normal) = self.solid.distance(zero, y);
        (distance - zero.all(self.skin), normal)
    }

    /// The contacts of particles on their ways from `x0` to `x`, of those where `looked` is 1; `recovery` is the largest way
    /// out for one that was inside.
    ///
    /// The distance is taken in one place of the code, since it is most of it: at the starts, along Newton's way and at the
    /// ends.
    #[inline(always)]
    pub(super) fn contacts<V: Vector>(
        &self,
        zero: V,
        looked: V,
        x0: Three<V>,
        x: Three<V>,
        recovery: f32,
    ) -> Contacts<V> {
        let one = zero.all(1.0);
        let (start, end) = (self.before.inside(zero, x0), self.now.inside(zero, x));
        let way = end.minus(start);
        let [ax, ay, az] = x.abs().0;
        let slop = zero.all(SLOP_M) + zero.all(ROUNDING) * (ax + ay + az);
        let near_enough = zero.all(0.1) * slop;
        let (mut y, mut share) = (start, zero);
        let (mut distance, mut normal) = (zero, Three([zero; 3]));
        // those on their way; those that a tangent plane may hold back; those that are looked at where they end
        let (mut searching, mut outside, mut passing) = (looked, looked, zero);
        let (mut hit, mut depth, mut rest) = (zero, zero, one);
        let mut step = 0;
        loop {
            let (d, n) = self.distance(zero, y);
            if step > NEWTON {
                // looked at where they end: still inside
                let deep = zero - d;
                let inside = passing * zero.one_above(d);
                let out = outside.pick(deep, deep.min(zero.all(recovery) + way.length()));
                (hit, depth) = (hit.max(inside), inside.pick(out, depth));
                (normal, rest) = (Three::pick(inside, n, normal), inside.pick(one, rest));
                break;
            }
            (distance, normal) = (searching.pick(d, distance), Three::pick(searching, n, normal));
            if step == 0 {
                outside = looked * (zero - slop).one_unless_above(d);
                searching = outside;
                passing = looked - outside;
            }
            let mut held = outside;
            if step < NEWTON {
                let slope = normal.dot(way);
                let falling = zero.one_above(slope);
                // the distance grows from here on: where it is above 0 the way never enters
                let apart = searching * (one - falling) * zero.one_unless_above(distance);
                let on = searching * falling * distance.one_above(near_enough);
                let next = on.pick(share - distance / slope, share);
                let beyond = on * next.one_above(one);
                (share, searching) = (next, on - beyond);
                outside = outside - apart - beyond;
                y = Three::pick(searching, start.plus(way.times(share)), y);
                held = outside - searching;
            }
            if step == NEWTON || !searching.any() {
                // in front of the tangent plane through the nearest place on the surface
                let into = normal.dot(y.minus(end)) - distance;
                let touched = held * into.one_above(zero);
                (hit, depth) = (touched, touched.pick(into, zero));
                passing = passing + (held - touched);
                rest = one - share;
                if !passing.any() {
                    break;
                }
                y = end;
                step = NEWTON;
            }
            step += 1;
        }
        Contacts { hit, normal: self.now.turned(zero, normal), depth, rest, place: end.plus(normal.times(depth)) }
    }

    /// Velocities of the surface at places in the collider's frame, in m/s: their ways in the substep over dt.
    #[inline(always)]
    fn velocity_at<V: Vector>(&self, zero: V, place: Three<V>, per_s: f32) -> Three<V> {
        let velocity = Three::all(zero, self.velocity);
        if !self.turning {
            return velocity;
        }
        let way = self.now.turned(zero, place).minus(self.before.turned(zero, place));
        velocity.plus(way.times(zero.all(per_s)))
    }

    /// Moves the particles that touch the collider, and takes what they lose of their velocities.
    #[inline(always)]
    fn stop<V: Vector>(&self, zero: V, c: &Contacts<V>, rules: &Rules, x: &mut Three<V>, v: &mut Three<V>) {
        let relative = v.minus(self.velocity_at(zero, c.place, rules.per_s));
        let along = relative.dot(c.normal);
        let coming = c.hit * zero.one_above(along);
        let across = relative.minus(c.normal.times(along));
        let (speed, most) = (across.length(), (zero - along) * zero.all(self.friction));
        let taken = speed.above(most, most / speed, zero.all(1.0));
        let slower = v.minus(c.normal.times(along).plus(across.times(taken)));
        let shorter = x.minus(across.times(taken * zero.all(rules.dt) * c.rest));
        *v = Three::pick(coming, slower, *v);
        *x = Three::pick(coming, shorter, *x);
        *x = Three::pick(c.hit, x.plus(c.normal.times(c.depth)), *x);
    }
}

/// Moves particles out of the colliders of `near` first, then of whichever they were pushed into; those where `free` is 1.
/// Answers with their places and velocities.
#[inline(always)]
pub(super) fn push_out<V: Vector>(
    zero: V,
    all: &PushOut<'_>,
    near: u32,
    reach: V,
    free: V,
    from: Three<V>,
    v: Three<V>,
) -> (Three<V>, Three<V>) {
    let (mut x, mut v, none) = (from, v, zero.all(-1.0));
    let start = from.minus(v.times(zero.all(all.rules.dt)));
    // those that are not out yet, and the only collider that touched each
    let (mut open, mut only) = (free, none);
    for round in 0..ROUNDS {
        let way = if round > 0 { x.minus(start).length() } else { reach };
        let (mut deepest, mut touches, mut last) = (zero, zero, none);
        for (i, c) in all.colliders.iter().enumerate() {
            let Some(c) = c else {
                break;
            };
            // the first time those that were found near; then all that its new place is near to, but the only one that
            // touched: the particle is in front of it
            let looked = if round == 0 {
                if near.wrapping_shr(i as u32) & 1 == 0 {
                    continue;
                }
                open * c.near(zero, from, way)
            } else {
                let (below, above) = (zero.all(i as f32 - 0.5), zero.all(i as f32 + 0.5));
                open * c.near_box(zero, x, x, way) * only.above(below, only.one_above(above), zero.all(1.0))
            };
            if !looked.any() {
                continue;
            }
            let contacts = c.contacts(zero, looked, start, x, all.rules.recovery);
            if !contacts.hit.any() {
                continue;
            }
            touches = touches + contacts.hit;
            last = contacts.hit.pick(zero.all(i as f32), last);
            c.stop(zero, &contacts, &all.rules, &mut x, &mut v);
            deepest = contacts.hit.pick(contacts.depth.max(deepest), deepest);
        }
        open = open * deepest.one_above(zero.all(SLOP_M));
        if all.alone || !open.any() {
            break;
        }
        only = touches.above(zero.all(1.5), none, last);
    }
    (x, v)
}
