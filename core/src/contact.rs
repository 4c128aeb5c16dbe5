//! What colliders do to the particles in a substep.
//!
//! A particle's way in the substep, from x - v dt to x, is seen from the moving collider, where the shape stands still. The
//! way enters the shape (with its thickness) at the first root of the distance along it. All shapes are convex, so that
//! function is convex, Newton's method finds the root from the left without ever passing it, and the shape lies behind the
//! tangent plane there: the particle is put back in front of that plane. So nothing passes through, however thin the
//! collider or fast the way. The normal velocity relative to the surface is taken, and of the tangential one what Coulomb
//! friction can take: an impulse of at most friction times the normal one.

mod near;
mod touch;
#[cfg(test)]
mod twin;

use crate::colliders::{Collider, LocalPose, MAX_COLLIDERS, collider_at, norm};
use crate::force::Substep;
use crate::math::{max, min};
use crate::passes::{Held, Holders};
use crate::shapes::{Solid, length};
use crate::width::Supported;
use crate::{Vector3, simd};
use near::PushOut;

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

    fn turn(&self, y: V3) -> V3 {
        let [a, b, c] = &self.axes;
        a * y.x + b * y.y + c * y.z
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
    /// What is added to that where boxes are looked at in place of particles.
    spare: f32,
    /// The box around the bound in the axes of the cloth.
    low: V3,
    high: V3,
}

impl Moving {
    // where it is wanted, or it is copied there
    #[inline(always)]
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
            spare: 0.001 * reach + SLOP_M + 8.0 * ROUNDING * far,
            low: V3::new(min(a.x, b.x), min(a.y, b.y), min(a.z, b.z)) - wide,
            high: V3::new(max(a.x, b.x), max(a.y, b.y), max(a.z, b.z)) + wide,
        }
    }
}

/// The numbers of a substep that every contact needs.
#[derive(Clone, Copy, Debug)]
struct Rules {
    dt: f32,
    per_s: f32,
    recovery: f32,
}

/// Moves the particles of some rows out of the colliders as they are at `share` (0 to 1) of the frame.
pub(crate) fn push_out(all: &Holders<'_>, width: Supported, c: &Substep, share: f32, of: Held<'_>) {
    let before = max(share - 1.0 / all.substeps as f32, 0.0);
    let stored = (0..all.layout.max_colliders).filter_map(|place| collider_at(all.colliders, place));
    let mut colliders = [const { None }; MAX_COLLIDERS];
    let mut count = 0;
    for (to, c) in colliders.iter_mut().zip(stored) {
        *to = Some(Moving::new(&c, before, share, all.rate_hz));
        count += 1;
    }
    if count == 0 {
        return;
    }
    let [from, to] = of.rows;
    let push = PushOut {
        layout: all.layout,
        rows: to.saturating_sub(from),
        colliders: colliders.get(..count).unwrap_or(&colliders),
        alone: count == 1,
        rules: Rules { dt: c.dt, per_s: 1.0 / c.dt, recovery: RECOVERY * all.spacing },
        x: of.x,
        v: of.v,
        inverse: of.inverse,
    };
    simd::run(width, push);
}
