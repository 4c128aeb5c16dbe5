//! What colliders do to the particles in a substep.
//!
//! A particle's way in the substep, from x - v dt to x, is seen from the moving collider, where the shape stands still. The
//! way enters the shape (with its thickness) at the first root of the distance along it. All shapes are convex, so that
//! function is convex, Newton's method finds the root from the left without ever passing it, and the shape lies behind the
//! tangent plane there: the particle is put back in front of that plane. So nothing passes through, however thin the
//! collider or fast the way. The normal velocity relative to the surface is taken, and of the tangential one what Coulomb
//! friction can take: an impulse of at most friction times the normal one.

use crate::colliders::{Collider, LocalPose, MAX_COLLIDERS, norm};
use crate::force::Substep;
use crate::lanes::{LANES, Lanes};
use crate::layout::{read, span};
use crate::math::{max, min, sqrt};
use crate::shapes::{Solid, length};
use crate::{Cloth, Vector3};

type V3 = Vector3<f32>;

/// Rounds over the colliders that touch a particle: where it is pushed from one into another.
const ROUNDS: usize = 4;

/// Distances in m below which a place is on the surface, and the share of the coordinates that is added for rounding.
const SLOP_M: f32 = 1e-5;
const ROUNDING: f32 = 1e-6;

/// Steps of Newton's method. Each at least halves what is left of the way to a root, even where the way only grazes.
const NEWTON: usize = 16;

/// Largest way out of a collider per substep for a particle that was inside before, in smallest rest lengths.
const RECOVERY: f32 = 0.0625;

/// A collider's frame: where it is and its axes, in the local frame of the cloth.
#[derive(Clone, Copy, Debug)]
struct Frame {
    position: V3,
    axes: [V3; 3],
}

impl Frame {
    fn new(pose: &LocalPose) -> Frame {
        let [x, y, z, w] = pose.rotation;
        Frame {
            position: pose.position,
            axes: [
                V3::new(1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + z * w), 2.0 * (x * z - y * w)),
                V3::new(2.0 * (x * y - z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + x * w)),
                V3::new(2.0 * (x * z + y * w), 2.0 * (y * z - x * w), 1.0 - 2.0 * (x * x + y * y)),
            ],
        }
    }

    #[inline(always)]
    fn turn(&self, y: V3) -> V3 {
        let [a, b, c] = &self.axes;
        a * y.x + b * y.y + c * y.z
    }

    #[inline(always)]
    fn into_frame(self, x: V3) -> V3 {
        let d = x - self.position;
        let [a, b, c] = &self.axes;
        V3::new(a.dot(&d), b.dot(&d), c.dot(&d))
    }
}

/// The pose at `share` of the frame.
fn between(c: &Collider, share: f32) -> LocalPose {
    if share >= 1.0 || c.from == c.to {
        return c.to;
    }
    let position = c.from.position + (c.to.position - c.from.position) * share;
    let ([ax, ay, az, aw], [bx, by, bz, bw]) = (c.from.rotation, c.to.rotation);
    // the shorter arc: q and -q are the same rotation
    let near = if ax * bx + ay * by + az * bz + aw * bw < 0.0 { -1.0 } else { 1.0 };
    let mix = |a: f32, b: f32| a + (near * b - a) * share;
    let mixed = [mix(ax, bx), mix(ay, by), mix(az, bz), mix(aw, bw)];
    // at most a right angle apart in four dimensions, so the length is at least 0.7
    let long = norm(mixed);
    LocalPose { position, rotation: mixed.map(|x| x / long) }
}

/// What a place must be near to for a collider to touch it, at the end of the substep.
#[derive(Clone, Copy, Debug)]
enum Bound {
    /// A segment from `a` along `way`; `inverse` is 1 / way^2.
    Segment { a: V3, way: V3, inverse: f32 },
    /// A half space: outward normal, and its product with a place on the plane.
    Plane { normal: V3, at: f32 },
    /// A box in the collider's frame.
    Box { half: V3 },
}

/// A collider in this substep.
#[derive(Clone, Copy, Debug)]
struct Moving {
    solid: Solid,
    skin: f32,
    friction: f32,
    /// At the start and at the end of the substep.
    before: Frame,
    now: Frame,
    turning: bool,
    /// Of the position, in m/s.
    velocity: V3,
    bound: Bound,
    /// How near to the bound a resting particle must be.
    reach: f32,
    /// The box around the bound in the axes of the cloth.
    low: V3,
    high: V3,
}

impl Moving {
    fn new(c: &Collider, from: f32, to: f32, rate_hz: f32) -> Moving {
        let solid = Solid::new(&c.shape);
        let (before, now) = (Frame::new(&between(c, from)), Frame::new(&between(c, to)));
        let place = |f: &Frame, y: V3| f.position + f.turn(y);
        let moved = |y: V3| length(place(&now, y) - place(&before, y));
        let (bound, size, way) = match solid {
            Solid::Sphere { radius } => {
                (Bound::Segment { a: now.position, way: V3::zeros(), inverse: 0.0 }, radius, moved(V3::zeros()))
            }
            Solid::Capsule { from, axis, length, large, .. } => {
                let (a, b) = (from, from + axis * length);
                let way = place(&now, b) - place(&now, a);
                let square = way.dot(&way);
                let inverse = if square > 1e-12 { 1.0 / square } else { 0.0 };
                let spare = if square > 1e-12 { 0.0 } else { 1e-6 };
                (Bound::Segment { a: place(&now, a), way, inverse }, large + spare, max(moved(a), moved(b)))
            }
            Solid::Plane { normal } => {
                let normal = now.turn(normal);
                // a plane that turns may sweep any way: then every particle is looked at
                let way = if before.axes == now.axes { moved(V3::zeros()) } else { f32::INFINITY };
                (Bound::Plane { normal, at: normal.dot(&now.position) }, 0.0, way)
            }
            Solid::Box { half } => {
                let mut turned = 0.0;
                for ((a, b), h) in now.axes.iter().zip(&before.axes).zip(half.iter()) {
                    turned += length(a - b) * h;
                }
                (Bound::Box { half }, 0.0, moved(V3::zeros()) + turned)
            }
        };
        let (a, b) = match bound {
            Bound::Segment { a, way, .. } => (a, a + way),
            _ => (now.position, now.position),
        };
        let mut wide = V3::zeros();
        if let Bound::Box { half } = bound {
            for (axis, h) in now.axes.iter().zip(half.iter()) {
                wide += axis.abs() * *h;
            }
        }
        // products of coordinates are compared, so rounding grows with them
        let far = max(length(a), length(b)) + length(wide);
        let reach = (size + c.thickness + way) * 1.001 + SLOP_M + 8.0 * ROUNDING * far;
        let wide = wide.add_scalar(reach);
        Moving {
            solid,
            skin: c.thickness,
            friction: c.friction,
            before,
            now,
            turning: before.axes != now.axes,
            velocity: (c.to.position - c.from.position) * rate_hz,
            bound,
            reach,
            low: V3::new(min(a.x, b.x), min(a.y, b.y), min(a.z, b.z)) - wide,
            high: V3::new(max(a.x, b.x), max(a.y, b.y), max(a.z, b.z)) + wide,
        }
    }

    /// Whether any place in a box can be touched on a way of at most `way`.
    fn near_box(&self, low: V3, high: V3, way: f32) -> bool {
        if let Bound::Plane { normal, at } = self.bound {
            let (middle, half) = ((low + high) * 0.5, (high - low) * 0.5);
            let (size, near) = (normal.abs().dot(&half), normal.dot(&middle) - at);
            let rounding = 8.0 * ROUNDING * (length(middle) + size);
            return near - size <= self.reach + way + rounding;
        }
        let apart = |low: f32, high: f32, from: f32, to: f32| low - way > to || high + way < from;
        !(apart(low.x, high.x, self.low.x, self.high.x)
            || apart(low.y, high.y, self.low.y, self.high.y)
            || apart(low.z, high.z, self.low.z, self.high.z))
    }

    /// Which of some places can be touched on a way of at most `way`: 1 where they can.
    #[inline(always)]
    fn near(&self, [x, y, z]: [Lanes; 3], way: f32) -> [u32; LANES] {
        let all = Lanes::all;
        let limit = self.reach + way;
        let from = |a: V3| (x - all(a.x), y - all(a.y), z - all(a.z));
        let dot = |(x, y, z): (Lanes, Lanes, Lanes), b: V3| x * all(b.x) + y * all(b.y) + z * all(b.z);
        let (value, limit) = match self.bound {
            Bound::Segment { a, way: along, inverse } => {
                let d = from(a);
                let t = (dot(d, along) * all(inverse)).max(all(0.0)).min(all(1.0));
                let (x, y, z) = (d.0 - t * all(along.x), d.1 - t * all(along.y), d.2 - t * all(along.z));
                (x * x + y * y + z * z, limit * limit)
            }
            Bound::Plane { normal, at } => {
                let rounding = all(8.0 * ROUNDING) * (x.abs() + y.abs() + z.abs());
                (dot((x, y, z), normal) - all(at) - rounding, limit)
            }
            Bound::Box { half } => {
                let d = from(self.now.position);
                let [a, b, c] = self.now.axes.map(|axis| dot(d, axis).abs());
                let out = |y: Lanes, half: f32| (y - all(half)).max(all(0.0));
                let (x, y, z) = (out(a, half.x), out(b, half.y), out(c, half.z));
                (x * x + y * y + z * z, limit * limit)
            }
        };
        value.0.map(|value| u32::from(value <= limit))
    }

    #[inline(always)]
    fn distance(&self, y: V3) -> (f32, V3) {
        let (distance, normal) = self.solid.distance(y);
        (distance - self.skin, normal)
    }

    /// The contact of a particle on its way from `x0` to `x`; `recovery` is the largest way out for one that was inside.
    #[inline]
    fn contact(&self, x0: V3, x: V3, recovery: f32) -> Option<Contact> {
        let (start, end) = (self.before.into_frame(x0), self.now.into_frame(x));
        let way = end - start;
        let slop = SLOP_M + ROUNDING * (x.x.abs() + x.y.abs() + x.z.abs());
        let (mut distance, mut normal) = self.distance(start);
        let outside = distance >= -slop;
        if outside {
            let mut share = 0.0;
            let mut y = start;
            for _ in 0..NEWTON {
                let slope = normal.dot(&way);
                if slope >= 0.0 {
                    // The distance grows from here on: where it is above 0 the way never enters.
                    if distance >= 0.0 {
                        return None;
                    }
                    break;
                }
                if distance <= 0.1 * slop {
                    break;
                }
                share -= distance / slope;
                if share > 1.0 {
                    return None;
                }
                y = start + way * share;
                (distance, normal) = self.distance(y);
            }
            // in front of the tangent plane through the nearest place on the surface
            let depth = normal.dot(&(y - end)) - distance;
            if depth > 0.0 {
                return Some(self.touch(end, normal, depth, 1.0 - share));
            }
        }
        let (distance, normal) = self.distance(end);
        if distance >= 0.0 {
            return None;
        }
        let depth = if outside { -distance } else { min(-distance, recovery + length(way)) };
        Some(self.touch(end, normal, depth, 1.0))
    }

    /// `rest` is the share of the substep that is left after the touch.
    #[inline(always)]
    fn touch(&self, end: V3, normal: V3, depth: f32, rest: f32) -> Contact {
        Contact { normal: self.now.turn(normal), depth, rest, place: end + normal * depth }
    }

    /// Velocity of the surface at a place in the collider's frame, in m/s: its way in the substep over dt.
    #[inline(always)]
    fn velocity_at(&self, place: V3, per_s: f32) -> V3 {
        if !self.turning {
            return self.velocity;
        }
        self.velocity + (self.now.turn(place) - self.before.turn(place)) * per_s
    }
}

/// Where a particle touches a collider.
#[derive(Clone, Copy, Debug)]
struct Contact {
    /// Outward, in the frame of the cloth.
    normal: V3,
    depth: f32,
    rest: f32,
    /// Where the particle ends up, in the frame of the collider.
    place: V3,
}

/// The numbers of a substep that every contact needs.
#[derive(Clone, Copy, Debug)]
struct Rules {
    dt: f32,
    per_s: f32,
    recovery: f32,
}

/// Moves a particle out of the colliders: those of `mask` first, then whichever it was pushed into.
fn push_out(colliders: &[Moving], mask: u32, rules: &Rules, x: &mut V3, v: &mut V3) {
    let start = *x - *v * rules.dt;
    let mut only = usize::MAX;
    for round in 0..ROUNDS {
        let (mut deepest, mut touches, mut last) = (0.0, 0, usize::MAX);
        let way = if round > 0 { length(*x - start) } else { 0.0 };
        for (i, c) in colliders.iter().enumerate() {
            // the first time those that were found near; then all that its new place is near to, but the only one that
            // touched: the particle is in front of it
            let looked =
                if round == 0 { mask.wrapping_shr(i as u32) & 1 == 1 } else { i != only && c.near_box(*x, *x, way) };
            if !looked {
                continue;
            }
            let Some(contact) = c.contact(start, *x, rules.recovery) else {
                continue;
            };
            (touches, last) = (touches + 1, i);
            let normal = contact.normal;
            let relative = *v - c.velocity_at(contact.place, rules.per_s);
            let along = relative.dot(&normal);
            if along < 0.0 {
                let across = relative - normal * along;
                let (speed, most) = (length(across), -along * c.friction);
                let taken = if speed > most { most / speed } else { 1.0 };
                *v -= normal * along + across * taken;
                *x -= across * (taken * rules.dt * contact.rest);
            }
            *x += normal * contact.depth;
            deepest = max(contact.depth, deepest);
        }
        if deepest <= SLOP_M || colliders.len() == 1 {
            break;
        }
        only = if touches == 1 { last } else { usize::MAX };
    }
}

/// The box around the particles of a row and their largest speed squared.
struct RowBound {
    low: V3,
    high: V3,
    speed2: f32,
}

/// Numbers of a row, by the lanes.
type Row<'a> = &'a [[f32; LANES]];

impl RowBound {
    /// `rest` are the places after the last full lanes.
    #[inline(never)]
    fn new(x: [Row<'_>; 3], v: [Row<'_>; 3], rest: [&[f32]; 3]) -> RowBound {
        let all = Lanes::all;
        let mut low = [all(f32::INFINITY); 3];
        let mut high = [all(f32::NEG_INFINITY); 3];
        let mut speed2 = all(0.0);
        let ([x, y, z], [vx, vy, vz]) = (x, v);
        for ((x, y), z) in x.iter().zip(y).zip(z) {
            let (x, y, z) = (Lanes(*x), Lanes(*y), Lanes(*z));
            low = [x.min(low[0]), y.min(low[1]), z.min(low[2])];
            high = [x.max(high[0]), y.max(high[1]), z.max(high[2])];
        }
        for ((x, y), z) in vx.iter().zip(vy).zip(vz) {
            let (x, y, z) = (Lanes(*x), Lanes(*y), Lanes(*z));
            speed2 = (x * x + y * y + z * z).max(speed2);
        }
        let least = |lanes: Lanes, rest: &[f32]| rest.iter().copied().chain(lanes.0).fold(f32::INFINITY, min);
        let most = |lanes: Lanes, rest: &[f32]| rest.iter().copied().chain(lanes.0).fold(f32::NEG_INFINITY, max);
        RowBound {
            low: V3::new(least(low[0], rest[0]), least(low[1], rest[1]), least(low[2], rest[2])),
            high: V3::new(most(high[0], rest[0]), most(high[1], rest[1]), most(high[2], rest[2])),
            speed2: most(speed2, &[]),
        }
    }
}

impl Cloth<'_> {
    /// Moves the particles out of the colliders as they are at `share` (0 to 1) of the frame.
    pub(crate) fn apply_colliders(&mut self, c: &Substep, share: f32) {
        let before = max(share - 1.0 / self.def.substeps as f32, 0.0);
        let stored = (0..self.layout.max_colliders).filter_map(|place| self.colliders.get(place));
        let mut ready = [const { None }; MAX_COLLIDERS];
        let mut count = 0;
        for (to, c) in ready.iter_mut().zip(stored) {
            *to = Some(Moving::new(&c, before, share, self.def.rate_hz));
            count += 1;
        }
        let Some(Some(first)) = ready.first() else {
            return;
        };
        let mut moving = [*first; MAX_COLLIDERS];
        for (to, from) in moving.iter_mut().zip(ready.iter().flatten()) {
            *to = *from;
        }
        let rules =
            Rules { dt: c.dt, per_s: 1.0 / c.dt, recovery: RECOVERY * min(self.grid.rest_u(), self.grid.rest_v()) };
        let moving = moving.get(..count).unwrap_or(&[]);
        for row in 0..self.layout.rows {
            self.row_out(row, moving, &rules);
        }
    }

    fn row_out(&mut self, row: usize, colliders: &[Moving], rules: &Rules) {
        let l = self.layout;
        let at = l.row(row);
        let x = [&*self.x.x, &*self.x.y, &*self.x.z].map(|p| span(p, at, l.columns).as_chunks::<LANES>());
        // spare places of the last lanes have no speed
        let v = [&*self.v.x, &*self.v.y, &*self.v.z].map(|p| span(p, at, l.width).as_chunks::<LANES>().0);
        let bound = RowBound::new(x.map(|p| p.0), v, x.map(|p| p.1));
        let way = sqrt(bound.speed2) * rules.dt;
        let mut near: u32 = 0;
        for (i, c) in colliders.iter().enumerate() {
            if c.near_box(bound.low, bound.high, way) {
                near |= 1u32.wrapping_shl(i as u32);
            }
        }
        if near == 0 {
            return;
        }
        for start in (0..l.width).step_by(LANES) {
            let load =
                |p: &[f32]| Lanes(span(p, at + start, LANES).first_chunk::<LANES>().copied().unwrap_or([0.0; LANES]));
            let places = [load(self.x.x), load(self.x.y), load(self.x.z)];
            let mut masks = [0u32; LANES];
            let mut any = 0;
            for (i, c) in colliders.iter().enumerate() {
                if near.wrapping_shr(i as u32) & 1 == 1 {
                    for (mask, hit) in masks.iter_mut().zip(c.near(places, way)) {
                        *mask |= hit.wrapping_shl(i as u32);
                        any |= *mask;
                    }
                }
            }
            if any == 0 {
                continue;
            }
            for (i, mask) in masks.into_iter().enumerate() {
                let at = at + start + i;
                // pinned and absent particles and spare places go their own way
                if mask == 0 || read(self.inverse, at) == 0.0 {
                    continue;
                }
                let mut p = V3::from(self.local(at));
                let mut v = V3::new(read(self.v.x, at), read(self.v.y, at), read(self.v.z, at));
                push_out(colliders, mask, rules, &mut p, &mut v);
                self.set_position_at(at, p.into());
                self.set_velocity_at(at, v.into());
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Shape, noise};

    /// The quick look never overlooks what the exact one finds: random shapes, sizes, places, motions and ways.
    #[test]
    fn whatever_touches_is_looked_at() {
        let mut count = 0;
        let mut random = |size: f32| {
            count += 3;
            let g = |i: u32| size * noise::gaussian(11, count - i);
            V3::new(g(0), g(1), g(2))
        };
        let (mut touched, mut skipped) = (0, 0);
        for case in 0..4000u32 {
            let a = random(0.3).abs().add_scalar(1e-3);
            let b = random(0.5);
            let shape = match case % 4 {
                0 => Shape::Sphere { radius_m: a.x },
                1 => Shape::Capsule { ends_m: [[b.x, b.y, b.z], [-b.x, a.y, b.z]], radii_m: [a.x, a.z] },
                2 => Shape::Plane { normal: [b.x, b.y, b.z] },
                _ => Shape::Box { half_m: [a.x, a.y, a.z] },
            };
            // from standing still to 5 m/s and a turn of a radian per substep
            let moving = [0.0, 0.005, 0.02][case as usize / 4 % 3];
            let pose = |place: V3, turn: V3| {
                let q = [turn.x, turn.y, turn.z, 1.0];
                LocalPose { position: place, rotation: q.map(|x| x / norm(q)) }
            };
            let far = [0.0, 100.0][case as usize / 12 % 2];
            let (place, turn) = (random(0.5).add_scalar(far), random(1.0));
            let from = pose(place, turn);
            let to = pose(place + random(moving * 16.0), turn + random(moving * 16.0));
            let thickness = random(0.01).x.abs();
            let c = Moving::new(&Collider { shape, friction: 0.3, thickness, from, to }, 0.5, 0.5625, 60.0);
            for _ in 0..40 {
                let (x, v) = (place + random(0.5), random([0.1, 20.0][case as usize / 24 % 2]));
                let dt = 1.0 / 960.0;
                let contact = c.contact(x - v * dt, x, 0.01);
                let way = length(v) * dt;
                let near = c.near([Lanes::all(x.x), Lanes::all(x.y), Lanes::all(x.z)], way)[3] == 1;
                let boxed = c.near_box(x, x, way);
                assert!(contact.is_none() || (near && boxed), "{shape:?} {c:?} {x} {v}");
                touched += usize::from(contact.is_some());
                skipped += usize::from(!near);
            }
        }
        assert!(touched > 10_000 && skipped > 10_000, "{touched} {skipped}");
    }

    /// After one contact the particle is outside, wherever it came from: no way from outside ends inside or beyond.
    #[test]
    fn a_way_that_starts_outside_ends_outside() {
        let mut count = 0;
        let mut random = |size: f32| {
            count += 3;
            let g = |i: u32| size * noise::gaussian(12, count - i);
            V3::new(g(0), g(1), g(2))
        };
        let still = LocalPose { position: V3::zeros(), rotation: [0.0, 0.0, 0.0, 1.0] };
        let mut touched = 0;
        for case in 0..20_000 {
            let shape = match case % 3 {
                0 => Shape::Sphere { radius_m: 0.05 },
                1 => Shape::Capsule { ends_m: [[0.0, -0.1, 0.0], [0.0, 0.1, 0.0]], radii_m: [0.01, 0.04] },
                _ => Shape::Box { half_m: [0.1, 0.001, 0.1] },
            };
            let c = Moving::new(
                &Collider { shape, friction: 0.0, thickness: 0.002, from: still, to: still },
                0.0,
                1.0,
                60.0,
            );
            let (x0, x) = (random(0.1), random(0.1));
            if c.distance(x0).0 < 0.0 {
                continue;
            }
            let end = c.contact(x0, x, 0.0).map_or(x, |k| {
                touched += 1;
                x + k.normal * k.depth
            });
            // the whole way, in small steps
            for i in 0..=200 {
                let y = x0 + (end - x0) * (i as f32 / 200.0);
                let (distance, _) = c.distance(y);
                assert!(distance > -1e-5, "{shape:?}: {x0} to {x}, put to {end}: {distance} at {i}");
            }
        }
        assert!(touched > 3000, "{touched}");
    }
}
