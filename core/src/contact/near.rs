//! Which particles may touch which colliders: bands of rows, rows and vectors of particles that cannot are left alone.

use super::touch::push_out;
use super::{Bound, Moving, ROUNDING, Rules};
use crate::layout::{Layout, span};
use crate::math::max;
use crate::simd::{NUMBERS, Pass, Three, Vector};

/// Rows that are looked at together.
const BAND: usize = 8;

/// Places of a row that are looked at together.
const BLOCK: usize = 16;

/// Moves the particles out of the colliders.
pub(super) struct PushOut<'p> {
    pub layout: &'p Layout,
    pub rows: usize,
    pub colliders: &'p [Option<Moving>],
    /// Whether there is only one collider.
    pub alone: bool,
    pub rules: Rules,
    /// Positions, velocities and inverse masses of the rows.
    pub x: [&'p mut [f32]; 3],
    pub v: [&'p mut [f32]; 3],
    pub inverse: &'p [f32],
}

/// Boxes around some particles, one in each lane, and their largest speeds squared.
#[derive(Clone, Copy)]
struct Boxes<V> {
    low: Three<V>,
    high: Three<V>,
    speed2: V,
}

impl<V: Vector> Boxes<V> {
    #[inline(always)]
    fn none(zero: V) -> Boxes<V> {
        let all = zero.all(f32::INFINITY);
        let minus = zero - all;
        Boxes { low: Three([all, all, all]), high: Three([minus, minus, minus]), speed2: zero }
    }

    #[inline(always)]
    fn with(self, other: &Boxes<V>) -> Boxes<V> {
        Boxes { low: other.low.min(self.low), high: other.high.max(self.high), speed2: other.speed2.max(self.speed2) }
    }
}

/// The largest number of all lanes, in each lane.
#[inline(always)]
fn largest<V: Vector>(lanes: V) -> V {
    let mut each = [0.0; BLOCK];
    lanes.write(&mut each, 0);
    // in four steps instead of sixteen that wait for one another
    for half in [8, 4, 2, 1] {
        let (low, high) = each.split_at_mut(half);
        for (most, x) in low.iter_mut().zip(high) {
            *most = max(*x, *most);
        }
    }
    lanes.all(each[0])
}

impl Pass for PushOut<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(mut self, zero: V) {
        let rows = self.rows;
        let dt = zero.all(self.rules.dt);
        let mut first = 0;
        while first < rows {
            let mut band = [Boxes::none(zero); BAND];
            let mut all = Boxes::none(zero);
            for (row, boxes) in (first..rows).zip(&mut band) {
                *boxes = self.boxes(zero, row);
                all = all.with(boxes);
            }
            let near = self.near_boxes(zero, &all, u32::MAX, largest(all.speed2).sqrt() * dt);
            if near != 0 {
                for (row, boxes) in (first..rows).zip(&band) {
                    let way = largest(boxes.speed2).sqrt() * dt;
                    let near = self.near_boxes(zero, boxes, near, way);
                    if near != 0 {
                        self.row(zero, row, near, way);
                    }
                }
            }
            first += BAND;
        }
    }
}

impl PushOut<'_> {
    /// The boxes around the particles of a row.
    #[inline(always)]
    fn boxes<V: Vector>(&self, zero: V, row: usize) -> Boxes<V> {
        let l = self.layout;
        let at = row * l.stride;
        let cut = |plane| span(plane, at, l.width).as_chunks::<BLOCK>().0;
        let [x, y, z] = &self.x;
        let (x, y, z) = (cut(x), cut(y), cut(z));
        let [vx, vy, vz] = &self.v;
        let (vx, vy, vz) = (cut(vx), cut(vy), cut(vz));
        // spare places are where the first particle is; they have no speed
        let some = |from: &[[f32; BLOCK]]| zero.all(from.first().map_or(0.0, |block| block[0]));
        let somewhere = Three([some(x), some(y), some(z)]);
        let mut boxes = Boxes::none(zero);
        let places = x.iter().zip(y).zip(z);
        let mut left = l.columns;
        for (((x, y), z), ((vx, vy), vz)) in places.zip(vx.iter().zip(vy).zip(vz)) {
            let mut lane = 0;
            while lane < BLOCK {
                let mut place = Three::read(zero, [x, y, z], lane);
                if left < BLOCK {
                    let inside = zero.all(left as f32);
                    place = Three::choose(inside, zero.read(&NUMBERS, lane), place, somewhere);
                }
                let speed2 = Three::read(zero, [vx, vy, vz], lane).squared();
                boxes = boxes.with(&Boxes { low: place, high: place, speed2 });
                lane += V::LANES;
            }
            left = left.saturating_sub(BLOCK);
        }
        boxes
    }

    /// Which of some colliders, as bits, may be near to a place in some boxes on ways of at most `way`. Never one less than
    /// [`Moving::near`] finds for the places themselves, or what is worked out would depend on the width: hence the spare.
    #[inline(always)]
    fn near_boxes<V: Vector>(&self, zero: V, boxes: &Boxes<V>, some: u32, way: V) -> u32 {
        let Three([low, low_y, low_z]) = boxes.low.abs();
        let Three([high, high_y, high_z]) = boxes.high.abs();
        let far = (low + low_y + low_z) + (high + high_y + high_z);
        let way = way * zero.all(1.001) + zero.all(8.0 * ROUNDING) * far;
        let mut near = 0;
        for (i, c) in self.colliders.iter().enumerate() {
            let bit = 1u32.wrapping_shl(i as u32);
            if let Some(c) = c
                && some & bit != 0
                && c.near_box(zero, boxes.low, boxes.high, way + zero.all(c.spare)).any()
            {
                near |= bit;
            }
        }
        near
    }

    /// Moves the particles of a row out of some colliders and whatever those push them into.
    #[inline(always)]
    fn row<V: Vector>(&mut self, zero: V, row: usize, near: u32, way: V) {
        let first = row * self.layout.stride;
        let mut column = 0;
        while column < self.layout.width {
            let at = first.wrapping_add(column);
            column = column.wrapping_add(V::LANES);
            let [x, y, z] = &self.x;
            let place = Three::read(zero, [x, y, z], at);
            let mut looked = zero;
            for (i, c) in self.colliders.iter().enumerate() {
                if let Some(c) = c
                    && near.wrapping_shr(i as u32) & 1 == 1
                {
                    looked = c.near(zero, place, way).max(looked);
                }
            }
            // pinned and absent particles and spare places go their own way
            let free = looked * zero.read(self.inverse, at).one_above(zero);
            if !free.any() {
                continue;
            }
            let [x, y, z] = &self.v;
            let v = Three::read(zero, [x, y, z], at);
            let (place, v) = push_out(zero, self, near, way, free, place, v);
            let [x, y, z] = &mut self.x;
            place.write([x, y, z], at);
            let [x, y, z] = &mut self.v;
            v.write([x, y, z], at);
        }
    }
}

impl Moving {
    /// Whether any place in each of some boxes can be touched on a way of at most `way`: 1 where one can.
    #[inline(always)]
    pub(super) fn near_box<V: Vector>(&self, zero: V, low: Three<V>, high: Three<V>, way: V) -> V {
        if let Bound::Plane { normal, at } = self.bound {
            let normal = Three::all(zero, normal);
            let half = zero.all(0.5);
            let (middle, wide) = (low.plus(high).times(half), high.minus(low).times(half));
            let (size, near) = (normal.abs().dot(wide), normal.dot(middle) - zero.all(at));
            let rounding = zero.all(8.0 * ROUNDING) * (middle.length() + size);
            return (near - size).one_unless_above(zero.all(self.reach) + way + rounding);
        }
        let (Three([low_x, low_y, low_z]), Three([high_x, high_y, high_z])) = (low, high);
        let (from, to) = (Three::all(zero, self.low).0, Three::all(zero, self.high).0);
        let x = (low_x - way).one_unless_above(to[0]) * from[0].one_unless_above(high_x + way);
        let y = (low_y - way).one_unless_above(to[1]) * from[1].one_unless_above(high_y + way);
        let z = (low_z - way).one_unless_above(to[2]) * from[2].one_unless_above(high_z + way);
        x * y * z
    }

    /// Which of some places can be touched on a way of at most `way`: 1 where they can. Where several colliders touch, the
    /// result owes to which are looked at, so these numbers are the same for every width.
    #[inline(always)]
    pub(super) fn near<V: Vector>(&self, zero: V, place: Three<V>, way: V) -> V {
        let limit = zero.all(self.reach) + way;
        let (value, limit) = match self.bound {
            Bound::Segment { a, way: along, inverse } => {
                let (d, along) = (place.minus(Three::all(zero, a)), Three::all(zero, along));
                let t = (d.dot(along) * zero.all(inverse)).max(zero).min(zero.all(1.0));
                (d.minus(along.times(t)).squared(), limit * limit)
            }
            Bound::Plane { normal, at } => {
                let [x, y, z] = place.abs().0;
                let rounding = zero.all(8.0 * ROUNDING) * (x + y + z);
                (Three::all(zero, normal).dot(place) - zero.all(at) - rounding, limit)
            }
            Bound::Box { half } => {
                let d = place.minus(Three::all(zero, self.now.position));
                let [a, b, c] = self.now.axes;
                let turned =
                    Three([Three::all(zero, a).dot(d), Three::all(zero, b).dot(d), Three::all(zero, c).dot(d)]);
                let out = turned.abs().minus(Three::all(zero, half)).max(Three([zero; 3]));
                (out.squared(), limit * limit)
            }
        };
        value.one_unless_above(limit)
    }
}
