//! The contacts of single particles, written down plainly: what those in vectors must agree with to the bit.

extern crate std;

use std::println;
use std::vec;
use std::vec::Vec;

use super::*;
use crate::layout::read;
use crate::math::sqrt;
use crate::shapes::direction;
use crate::simd::{Pass, Three, Vector, run};
use crate::{Cloth, ClothDef, ColliderDef, Features, Grid, GridDef, Pose, Shape, Width, noise};

fn into_frame(frame: &Frame, x: V3) -> V3 {
    let d = x - frame.position;
    let [a, b, c] = &frame.axes;
    V3::new(a.dot(&d), b.dot(&d), c.dot(&d))
}

/// Distance to the surface in m, negative inside, and the outward normal of the nearest place on it.
fn solid_distance(solid: &Solid, y: V3) -> (f32, V3) {
    match *solid {
        Solid::Sphere { radius } => {
            let (normal, away) = direction(y);
            (away - radius, normal)
        }
        Solid::Capsule { from, axis, length, large, small, sine, cosine, .. } => {
            let w = y - from;
            let along = w.dot(&axis);
            let (across, away) = direction_across(w - axis * along, axis);
            // the normal of the side through y starts on the axis at (along - away * sine / cosine)
            let start = along * cosine - away * sine;
            if start <= 0.0 {
                let (normal, away) = direction(w);
                (away - large, normal)
            } else if start >= length * cosine {
                let (normal, away) = direction(w - axis * length);
                (away - small, normal)
            } else {
                (along * sine + away * cosine - large, axis * sine + across * cosine)
            }
        }
        Solid::Plane { normal } => (normal.dot(&y), normal),
        Solid::Box { half } => {
            let q = V3::new(y.x.abs() - half.x, y.y.abs() - half.y, y.z.abs() - half.z);
            let outside = V3::new(max(q.x, 0.0), max(q.y, 0.0), max(q.z, 0.0));
            let away = length(outside);
            let sign = V3::new(sign(y.x), sign(y.y), sign(y.z));
            if away > 0.0 {
                let n = outside / away;
                return (away, V3::new(n.x * sign.x, n.y * sign.y, n.z * sign.z));
            }
            if q.x >= q.y && q.x >= q.z {
                (q.x, V3::new(sign.x, 0.0, 0.0))
            } else if q.y >= q.z {
                (q.y, V3::new(0.0, sign.y, 0.0))
            } else {
                (q.z, V3::new(0.0, 0.0, sign.z))
            }
        }
    }
}

/// 1 or -1.
#[inline(always)]
fn sign(x: f32) -> f32 {
    if x < 0.0 { -1.0 } else { 1.0 }
}

/// The same for a vector across `axis`; where there is no direction, any across it.
fn direction_across(v: V3, axis: V3) -> (V3, f32) {
    let length = length(v);
    if length > 0.0 {
        return (v / length, length);
    }
    let (x, y, z) = (axis.x.abs(), axis.y.abs(), axis.z.abs());
    let least = min(x, min(y, z));
    let other = if x == least {
        V3::new(0.0, axis.z, -axis.y)
    } else if y == least {
        V3::new(-axis.z, 0.0, axis.x)
    } else {
        V3::new(axis.y, -axis.x, 0.0)
    };
    (direction(other).0, 0.0)
}

impl Moving {
    /// Whether any place in a box can be touched on a way of at most `way`.
    fn near_box_one(&self, low: V3, high: V3, way: f32) -> bool {
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

    /// Whether a place can be touched on a way of at most `way`.
    fn near_one(&self, x: V3, way: f32) -> bool {
        let limit = self.reach + way;
        let (value, limit) = match self.bound {
            Bound::Segment { a, way: along, inverse } => {
                let d = x - a;
                let t = min(max(d.dot(&along) * inverse, 0.0), 1.0);
                let d = d - along * t;
                (d.dot(&d), limit * limit)
            }
            Bound::Plane { normal, at } => {
                let rounding = 8.0 * ROUNDING * (x.x.abs() + x.y.abs() + x.z.abs());
                (normal.dot(&x) - at - rounding, limit)
            }
            Bound::Box { half } => {
                let d = x - self.now.position;
                let out = |axis: V3, half: f32| max(axis.dot(&d).abs() - half, 0.0);
                let [a, b, c] = self.now.axes;
                let d = V3::new(out(a, half.x), out(b, half.y), out(c, half.z));
                (d.dot(&d), limit * limit)
            }
        };
        value < limit
    }

    fn distance_one(&self, y: V3) -> (f32, V3) {
        let (distance, normal) = solid_distance(&self.solid, y);
        (distance - self.skin, normal)
    }

    /// The contact of a particle on its way from `x0` to `x`; `recovery` is the largest way out for one that was inside.
    fn contact(&self, x0: V3, x: V3, recovery: f32) -> Option<Contact> {
        let (start, end) = (into_frame(&self.before, x0), into_frame(&self.now, x));
        let way = end - start;
        let slop = SLOP_M + ROUNDING * (x.x.abs() + x.y.abs() + x.z.abs());
        let (mut distance, mut normal) = self.distance_one(start);
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
                (distance, normal) = self.distance_one(y);
            }
            // in front of the tangent plane through the nearest place on the surface
            let depth = normal.dot(&(y - end)) - distance;
            if depth > 0.0 {
                return Some(self.touch(end, normal, depth, 1.0 - share));
            }
        }
        let (distance, normal) = self.distance_one(end);
        if distance >= 0.0 {
            return None;
        }
        let depth = if outside { -distance } else { min(-distance, recovery + length(way)) };
        Some(self.touch(end, normal, depth, 1.0))
    }

    /// `rest` is the share of the substep that is left after the touch.
    fn touch(&self, end: V3, normal: V3, depth: f32, rest: f32) -> Contact {
        Contact { normal: self.now.turn(normal), depth, rest, place: end + normal * depth }
    }

    /// Velocity of the surface at a place in the collider's frame, in m/s: its way in the substep over dt.
    fn velocity_at_one(&self, place: V3, per_s: f32) -> V3 {
        if !self.turning {
            return self.velocity;
        }
        self.velocity + (self.now.turn(place) - self.before.turn(place)) * per_s
    }
}

/// Where a particle touches a collider.
struct Contact {
    /// Outward, in the frame of the cloth.
    normal: V3,
    depth: f32,
    rest: f32,
    /// Where the particle ends up, in the frame of the collider.
    place: V3,
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
            let looked = if round == 0 {
                mask.wrapping_shr(i as u32) & 1 == 1
            } else {
                i != only && c.near_box_one(*x, *x, way)
            };
            if !looked {
                continue;
            }
            let Some(contact) = c.contact(start, *x, rules.recovery) else {
                continue;
            };
            (touches, last) = (touches + 1, i);
            let normal = contact.normal;
            let relative = *v - c.velocity_at_one(contact.place, rules.per_s);
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

/// What a vector of particles does at a collider.
struct Side<'a> {
    c: &'a Moving,
    x: &'a [V3; 16],
    v: &'a [V3; 16],
    dt: f32,
    recovery: f32,
    way: f32,
}

/// Numbers of a particle: whether it is near, whether its place is near, then those of its contact.
type Found = [f32; 12];

impl Pass for Side<'_> {
    type Output = [Found; 16];

    #[inline(always)]
    fn run<V: Vector>(self, zero: V) -> [Found; 16] {
        let plane = |all: &[V3; 16], axis: usize| all.map(|a| a[axis]);
        let (x, v) = ([0, 1, 2].map(|a| plane(self.x, a)), [0, 1, 2].map(|a| plane(self.v, a)));
        let mut found = [[0.0; 12]; 16];
        for at in (0..16).step_by(V::LANES) {
            let (x, v) = (Three::read(zero, [&x[0], &x[1], &x[2]], at), Three::read(zero, [&v[0], &v[1], &v[2]], at));
            let way = zero.all(self.way);
            let start = x.minus(v.times(zero.all(self.dt)));
            let c = self.c.contacts(zero, zero.all(1.0), start, x, self.recovery);
            let Three([nx, ny, nz]) = c.normal;
            let Three([px, py, pz]) = c.place;
            let near = (self.c.near(zero, x, way), self.c.near_box(zero, x, x, way));
            let numbers = [near.0, near.1, c.hit, c.depth, c.rest, nx, ny, nz, px, py, pz, zero];
            for (i, lanes) in numbers.into_iter().enumerate() {
                let mut each = [0.0; 16];
                lanes.write(&mut each, at);
                for lane in at..at + V::LANES {
                    found[lane][i] = each[lane];
                }
            }
        }
        found
    }
}

/// Near or not, and contacts: random shapes, sizes, places, motions and ways, in every width the bits of the single ones.
/// And the quick look never overlooks what the exact one finds.
#[test]
fn vectors_find_what_single_contacts_find() {
    let mut count = 0;
    let mut random = |size: f32| {
        count += 3;
        let g = |i: u32| size * noise::gaussian(11, count - i);
        V3::new(g(0), g(1), g(2))
    };
    let widths: Vec<Supported> = Width::ALL.into_iter().filter_map(Supported::new).collect();
    for lacking in Width::ALL.into_iter().filter(|w| !w.is_supported()) {
        println!("SKIPPED: this machine has no {}", lacking.name());
    }
    let (mut touched, mut skipped, mut inside) = (0, 0, 0);
    for case in 0..4000u32 {
        let a = random(0.3).abs().add_scalar(1e-3);
        let b = random(0.5);
        let shape = match case % 5 {
            0 => Shape::Sphere { radius_m: a.x },
            1 => Shape::Capsule { ends_m: [[b.x, b.y, b.z], [-b.x, a.y, b.z]], radii_m: [a.x, a.z] },
            2 => Shape::Plane { normal: [b.x, b.y, b.z] },
            3 => Shape::Box { half_m: [a.x, a.y, a.z] },
            _ => Shape::Capsule { ends_m: [[0.0; 3], [0.0, a.x * 0.5, 0.0]], radii_m: [a.x, a.x * 0.1] },
        };
        // from standing still to 5 m/s and a turn of a radian per substep
        let moving = [0.0, 0.005, 0.02][case as usize / 5 % 3];
        let pose = |place: V3, turn: V3| {
            let q = [turn.x, turn.y, turn.z, 1.0];
            LocalPose { position: place, rotation: q.map(|x| x / norm(q)) }
        };
        let far = [0.0, 100.0][case as usize / 15 % 2];
        let (place, turn) = (random(0.5).add_scalar(far), random(1.0));
        let from = pose(place, turn);
        let to = pose(place + random(moving * 16.0), turn + random(moving * 16.0));
        let thickness = random(0.01).x.abs();
        let c = Moving::new(&Collider { shape, friction: 0.3, thickness, from, to }, 0.5, 0.5625, 60.0);
        let (dt, recovery) = (1.0 / 960.0, 0.01);
        for _ in 0..3 {
            let speed = [0.1, 20.0, 0.0][case as usize / 30 % 3];
            let mut x = [V3::zeros(); 16].map(|_| place + random(0.5));
            let v = [V3::zeros(); 16].map(|_| random(speed));
            // where a shape has its edges and its middle
            x[3] = place;
            x[9] = c.now.position + c.now.turn(V3::new(a.x, 0.0, 0.0));
            let way = v.iter().map(|v| length(*v)).fold(0.0, max) * dt;
            let wanted: Vec<Found> = x
                .iter()
                .zip(&v)
                .map(|(x, v)| {
                    let contact = c.contact(*x - *v * dt, *x, recovery);
                    let near = (c.near_one(*x, way), c.near_box_one(*x, *x, way));
                    assert!(contact.is_none() || (near.0 && near.1), "{shape:?} {c:?} {x} {v}");
                    touched += usize::from(contact.is_some());
                    skipped += usize::from(!near.0);
                    inside += usize::from(contact.as_ref().is_some_and(|k| k.rest == 1.0));
                    let near = [f32::from(u8::from(near.0)), f32::from(u8::from(near.1))];
                    contact.map_or([near[0], near[1], 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], |k| {
                        let (n, p) = (k.normal, k.place);
                        [near[0], near[1], 1.0, k.depth, k.rest, n.x, n.y, n.z, p.x, p.y, p.z, 0.0]
                    })
                })
                .collect();
            for width in &widths {
                let found = run(*width, Side { c: &c, x: &x, v: &v, dt, recovery, way });
                for (lane, (found, wanted)) in found.iter().zip(&wanted).enumerate() {
                    // the numbers of a contact that is none are of no use
                    let n = if wanted[2] == 1.0 { 12 } else { 3 };
                    let bits = |f: &Found| f.map(f32::to_bits);
                    assert_eq!(
                        bits(found)[..n],
                        bits(wanted)[..n],
                        "{:?} {shape:?} lane {lane}: {found:?}, not {wanted:?}",
                        width.get()
                    );
                }
            }
        }
    }
    assert!(touched > 10_000 && skipped > 10_000 && inside > 1000, "{touched} {skipped} {inside}");
}

/// A sheet among colliders that push it from one into another: every particle, moved on its own, ends where the vectors put
/// it.
#[test]
fn vectors_push_out_as_particles_on_their_own() {
    let grid = Grid::new(&GridDef { rows: 11, columns: 37, ..GridDef::default() }).unwrap();
    let def = ClothDef { features: Features::COLLIDERS, substeps: 4, ..ClothDef::default() };
    let mut block = vec![0.0; Cloth::memory(&grid, &def).unwrap()];
    let mut cloth = Cloth::create(&grid, &def, &mut block).unwrap();
    cloth.set_stiffness_uniform([10.0; 4]).unwrap();
    let mut count = 0;
    let mut random = |size: f32| {
        count += 3;
        let g = |i: u32| size * noise::gaussian(13, count - i);
        V3::new(g(0), g(1), g(2))
    };
    for i in 0..9 {
        let shape = match i % 3 {
            0 => Shape::Sphere { radius_m: 0.2 },
            1 => Shape::Capsule { ends_m: [[0.0, -0.2, 0.0], [0.1, 0.2, 0.0]], radii_m: [0.1, 0.15] },
            _ => Shape::Box { half_m: [0.1, 0.2, 0.15] },
        };
        let place = V3::new(0.5, -0.5, 0.0) + random(0.25);
        let id = cloth.add_collider(&ColliderDef::new(shape, Pose::at(place.cast()))).unwrap();
        cloth.move_collider(id, &Pose::at((place + random(0.02)).cast())).unwrap();
    }
    cloth.pin(40).unwrap();
    cloth.refresh(true);
    let (l, c) = (cloth.layout, cloth.constants());
    let rules = Rules { dt: c.dt, per_s: 1.0 / c.dt, recovery: RECOVERY * cloth.grid.least_rest() };
    let all = (0..MAX_COLLIDERS).filter_map(|place| cloth.colliders.get(place));
    let colliders: Vec<Moving> = all.map(|c| Moving::new(&c, 0.25, 0.5, 60.0)).collect();
    let (mut moved, mut compared) = (0, 0);
    for width in Width::ALL.into_iter().filter(|w| w.is_supported()) {
        cloth.set_width(width).unwrap();
        let mut wanted = Vec::new();
        for row in 0..l.rows {
            let speeds: Vec<V3> = (0..l.columns).map(|_| random(2.0)).collect();
            // the least speed of a row is that of its places without particles
            let way = speeds.iter().map(|v| v.x * v.x + v.y * v.y + v.z * v.z).fold(0.0, max);
            let way = sqrt(way) * rules.dt;
            for (column, v) in speeds.into_iter().enumerate() {
                let at = l.at(row, column);
                let x = V3::new(column as f32 / 36.0, -(row as f32) / 10.0, 0.0) + random(0.02);
                cloth.set_position_at(at, x.into());
                cloth.set_velocity_at(at, v.into());
                let (mut to, mut v_to) = (x, v);
                let near = |(i, c): (usize, &Moving)| u32::from(c.near_one(x, way)) << i;
                let mask = colliders.iter().enumerate().map(near).sum();
                if read(cloth.inverse, at) > 0.0 {
                    push_out(&colliders, mask, &rules, &mut to, &mut v_to);
                }
                moved += u32::from(to != x);
                wanted.push((at, [to, v_to]));
            }
        }
        cloth.constrain(&c, 0.5);
        for (at, [x, v]) in wanted {
            let found = [&*cloth.x.x, &*cloth.x.y, &*cloth.x.z, &*cloth.v.x, &*cloth.v.y, &*cloth.v.z];
            let found = found.map(|plane| read(plane, at).to_bits());
            assert_eq!(found, [x.x, x.y, x.z, v.x, v.y, v.z].map(f32::to_bits), "{width:?} {at}");
            compared += 1;
        }
    }
    assert!(moved > compared / 5, "{moved} of {compared}");
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
        let c =
            Moving::new(&Collider { shape, friction: 0.0, thickness: 0.002, from: still, to: still }, 0.0, 1.0, 60.0);
        let (x0, x) = (random(0.1), random(0.1));
        if c.distance_one(x0).0 < 0.0 {
            continue;
        }
        let end = c.contact(x0, x, 0.0).map_or(x, |k| {
            touched += 1;
            x + k.normal * k.depth
        });
        // the whole way, in small steps
        for i in 0..=200 {
            let y = x0 + (end - x0) * (i as f32 / 200.0);
            let (distance, _) = c.distance_one(y);
            assert!(distance > -1e-5, "{shape:?}: {x0} to {x}, put to {end}: {distance} at {i}");
        }
    }
    assert!(touched > 3000, "{touched}");
}
