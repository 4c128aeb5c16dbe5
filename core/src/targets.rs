//! Largest distance and backstop to skinned targets of the particles.
//!
//! A particle stays within `max_distance` of its target, and out of a ball of `backstop_radius` whose surface lies
//! `backstop_distance` behind the target, against the normal of the skin: the motion and separation constraints of other
//! engines. Velocity against a limit, relative to the target, is taken; along it, it is kept.

use crate::frame::Motion;
use crate::layout::{Layout, copy, read, take, write};
use crate::math::{max, min, sqrt};
use crate::shapes::{direction, length};
use crate::simd::{Pass, Three, Vector};
use crate::{Cloth, Error, Vector3};

type V3 = Vector3<f32>;

/// Planes: position and normal at the start of the frame, then at its end, then the three distances.
pub(crate) const TARGET_PLANES: usize = 15;
const TO: usize = 6;
const NORMAL: usize = 3;
const MAX_DISTANCE: usize = 12;
const RADIUS: usize = 13;
const DISTANCE: usize = 14;

/// What is stored for a particle without a largest distance: a state holds finite numbers only.
const FREE: f32 = f32::MAX;

/// How far a particle may be from its target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TargetLimit {
    /// Largest distance to the target in m, 0 to 1e6, or infinity: free, the default. With 0 the particle is where its
    /// target is.
    pub max_distance_m: f32,
    /// Radius of the backstop in m, 0 to 1e6; 0 = none, the default.
    pub backstop_radius_m: f32,
    /// Distance of the backstop's surface behind the target in m, 0 to 1e6. Default 0.
    pub backstop_distance_m: f32,
}

impl Default for TargetLimit {
    fn default() -> Self {
        TargetLimit { max_distance_m: f32::INFINITY, backstop_radius_m: 0.0, backstop_distance_m: 0.0 }
    }
}

impl TargetLimit {
    /// Errors: [`Error::NotFinite`], [`Error::Negative`], [`Error::OutOfRange`].
    fn check(&self) -> Result<(), Error> {
        let backstop = [self.backstop_radius_m, self.backstop_distance_m];
        if self.max_distance_m.is_nan() || !backstop.iter().all(|x| x.is_finite()) {
            return Err(Error::NotFinite);
        }
        if self.max_distance_m < 0.0 || backstop.iter().any(|x| *x < 0.0) {
            return Err(Error::Negative);
        }
        if (self.max_distance_m > 1e6 && self.max_distance_m < f32::INFINITY) || backstop.iter().any(|x| *x > 1e6) {
            return Err(Error::OutOfRange);
        }
        Ok(())
    }
}

/// Where the skin is at a particle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Target {
    /// Position in m from the base that is handed in beside it.
    pub position_m: Vector3<f32>,
    /// Outward normal of the skin, of any length from 1e-3 to 1e3; zero keeps the last one.
    pub normal: Vector3<f32>,
}

/// The targets of a cloth. All their numbers are state.
pub(crate) struct Targets<'a> {
    pub planes: &'a mut [f32],
}

impl<'a> Targets<'a> {
    /// f32 numbers that they need.
    pub fn numbers(l: &Layout) -> usize {
        if l.targets { TARGET_PLANES * l.plane } else { 0 }
    }

    pub fn new(l: &Layout, block: &mut &'a mut [f32]) -> Result<Self, Error> {
        Ok(Targets { planes: take(block, Self::numbers(l))? })
    }

    fn put(&mut self, plane: usize, size: usize, at: usize, v: V3) {
        for (i, x) in v.iter().enumerate() {
            write(self.planes, (plane + i) * size + at, *x);
        }
    }
}

/// Three planes of targets of `size` numbers each, from one on, at a place.
fn vector(planes: &[f32], plane: usize, size: usize, at: usize) -> V3 {
    let n = |i: usize| read(planes, (plane + i) * size + at);
    V3::new(n(0), n(1), n(2))
}

/// Whether the numbers of a snapshot from `first` on are targets that could have been set.
/// Errors: [`Error::Negative`], [`Error::OutOfRange`].
pub(crate) fn check_stored(number: &impl Fn(usize) -> f32, first: usize, l: &Layout) -> Result<(), Error> {
    for row in 0..l.rows {
        for column in 0..l.columns {
            let n = |plane: usize| number(first + plane * l.plane + l.at(row, column));
            let max_distance_m = if n(MAX_DISTANCE) == FREE { f32::INFINITY } else { n(MAX_DISTANCE) };
            let (backstop_radius_m, backstop_distance_m) = (n(RADIUS), n(DISTANCE));
            TargetLimit { max_distance_m, backstop_radius_m, backstop_distance_m }.check()?;
            for plane in [0, TO] {
                let normal = V3::new(n(plane + NORMAL), n(plane + NORMAL + 1), n(plane + NORMAL + 2));
                if !(0.999..=1.001).contains(&length(normal)) || (0..3).any(|i| n(plane + i).abs() > 2e6) {
                    return Err(Error::OutOfRange);
                }
            }
        }
    }
    Ok(())
}

/// The target of one particle in a substep.
struct Aim {
    position: V3,
    velocity: V3,
    normal: V3,
    /// Change of the normal in 1/s.
    turning: V3,
    max_distance: f32,
    radius: f32,
    distance: f32,
}

impl Aim {
    /// Holds a particle within its limits.
    fn hold(&self, x: &mut V3, v: &mut V3) {
        let (out, away) = direction(*x - self.position);
        if self.max_distance == 0.0 {
            (*x, *v) = (self.position, self.velocity);
        } else if away > self.max_distance {
            *x = self.position + out * self.max_distance;
            *v -= out * max((*v - self.velocity).dot(&out), 0.0);
        }
        if self.radius == 0.0 {
            return;
        }
        let behind = self.radius + self.distance;
        let center = self.position - self.normal * behind;
        let from = *x - center;
        let inside = length(from);
        if inside >= self.radius {
            return;
        }
        let mut out = if inside > 0.0 { from / inside } else { self.normal };
        *x = center + out * self.radius;
        let (_, away) = direction(*x - self.position);
        if away > self.max_distance {
            // Pushed past the largest distance: the nearest place that both allow lies on the circle where the balls meet,
            // `under` below the target against the normal. The target is outside the backstop, so they do meet.
            let (r, d) = (self.radius, self.max_distance);
            let under = (self.distance * (behind + r) + d * d) / (2.0 * behind);
            let (across, _) = direction(out - self.normal * out.dot(&self.normal));
            *x = self.position - self.normal * under + across * sqrt(max(d * d - under * under, 0.0));
            (out, _) = direction(*x - center);
        }
        let velocity = self.velocity - self.turning * behind;
        *v -= out * min((*v - velocity).dot(&out), 0.0);
    }
}

impl Cloth<'_> {
    /// Sets how far each particle may be from its target: `limit(particle)`, particle = row * columns + column.
    ///
    /// Errors: [`Error::FeatureOff`] without [`crate::Features::TARGETS`], [`Error::NotFinite`], [`Error::Negative`],
    /// [`Error::OutOfRange`]; then nothing is changed.
    pub fn set_target_limits(&mut self, limit: impl Fn(usize) -> TargetLimit) -> Result<(), Error> {
        let l = self.layout;
        if !l.targets {
            return Err(Error::FeatureOff);
        }
        for particle in 0..self.grid.particles() {
            limit(particle).check()?;
        }
        for particle in 0..self.grid.particles() {
            let (at, limit) = (l.place(particle)?, limit(particle));
            let max_distance = if limit.max_distance_m == f32::INFINITY { FREE } else { limit.max_distance_m };
            write(self.targets.planes, MAX_DISTANCE * l.plane + at, max_distance);
            write(self.targets.planes, RADIUS * l.plane + at, limit.backstop_radius_m);
            write(self.targets.planes, DISTANCE * l.plane + at, limit.backstop_distance_m);
        }
        self.wake();
        Ok(())
    }

    /// Moves the targets: at the end of the next frame they are at `target(particle)` from `base_m`, a point of the world,
    /// and on the way there they are interpolated linearly over the substeps. Without a new call they then stay. Before the
    /// first call the targets are the places and the normal of the flat cloth at the start.
    ///
    /// Errors: [`Error::FeatureOff`] without [`crate::Features::TARGETS`], [`Error::NotFinite`], [`Error::OutOfRange`] (more
    /// than 1e6 m from the cloth's origin, a normal of another length); then nothing is changed.
    pub fn move_targets(&mut self, base_m: Vector3<f64>, target: impl Fn(usize) -> Target) -> Result<(), Error> {
        self.put_targets(base_m, target, false)
    }

    /// Carries the targets along with the frame: where they were; where they go stays in the world, or is carried too.
    pub(crate) fn carry_targets(&mut self, motion: &Motion, in_world: bool) {
        let l = self.layout;
        if !l.targets {
            return;
        }
        for row in 0..l.rows {
            for column in 0..l.columns {
                let at = l.at(row, column);
                for from in [0, TO] {
                    let planes = &*self.targets.planes;
                    let (p, n) = (vector(planes, from, l.plane, at), vector(planes, from + NORMAL, l.plane, at));
                    let stays = from == TO && in_world;
                    let p = if stays { motion.keep(p.into()) } else { motion.carry(p.into()) };
                    self.targets.put(from, l.plane, at, p.into());
                    if !stays {
                        self.targets.put(from + NORMAL, l.plane, at, motion.carry_vector(n.into()).into());
                    }
                }
            }
        }
    }

    /// Puts the targets somewhere at once, with no way and no velocity between: for the first frame and for teleports.
    ///
    /// Errors: those of [`Cloth::move_targets`].
    pub fn set_targets(&mut self, base_m: Vector3<f64>, target: impl Fn(usize) -> Target) -> Result<(), Error> {
        self.put_targets(base_m, target, true)
    }

    fn put_targets(
        &mut self,
        base_m: Vector3<f64>,
        target: impl Fn(usize) -> Target,
        at_once: bool,
    ) -> Result<(), Error> {
        let l = self.layout;
        if !l.targets {
            return Err(Error::FeatureOff);
        }
        let local = |cloth: &Self, particle: usize| {
            let t = target(particle);
            if !t.normal.iter().all(|x| x.is_finite()) {
                return Err(Error::NotFinite);
            }
            let long = length(t.normal);
            if t.normal != V3::zeros() && !(1e-3..=1e3).contains(&long) {
                return Err(Error::OutOfRange);
            }
            let position = cloth.to_local(base_m + t.position_m.cast::<f64>())?;
            Ok((V3::from(position), if long > 0.0 { Some(t.normal / long) } else { None }))
        };
        for particle in 0..self.grid.particles() {
            local(self, particle)?;
        }
        self.wake();
        for particle in 0..self.grid.particles() {
            let (at, (position, normal)) = (l.place(particle)?, local(self, particle)?);
            for from in [0, TO] {
                if from == TO || at_once {
                    self.targets.put(from, l.plane, at, position);
                    if let Some(normal) = normal {
                        self.targets.put(from + NORMAL, l.plane, at, normal);
                    }
                }
            }
        }
        Ok(())
    }

    /// The targets of the start: the places and the normal of the flat cloth, everything free.
    pub(crate) fn reset_targets(&mut self) {
        let l = self.layout;
        if !l.targets {
            return;
        }
        self.targets.planes.fill(0.0);
        let (u, v) = (V3::from(self.def.u_axis).normalize(), V3::from(self.def.v_axis).normalize());
        let (normal, _) = direction(u.cross(&v));
        for row in 0..l.rows {
            for column in 0..l.columns {
                let at = l.at(row, column);
                let position = V3::from(self.local(at));
                for from in [0, TO] {
                    self.targets.put(from, l.plane, at, position);
                    self.targets.put(from + NORMAL, l.plane, at, normal);
                }
                write(self.targets.planes, MAX_DISTANCE * l.plane + at, FREE);
            }
        }
    }

    /// The next frame starts where this one ended; after a frame that was taken back (`finite` false), where it began.
    pub(crate) fn finish_targets(&mut self, finite: bool) {
        let (from, rest) = self.targets.planes.split_at_mut((TO * self.layout.plane).min(self.targets.planes.len()));
        let to = rest.get_mut(..from.len()).unwrap_or(&mut []);
        if finite {
            copy(from, to);
        } else {
            copy(to, from);
        }
    }
}

/// Holds the particles of some rows within their distance of the targets as they are at `share` (0 to 1) of the frame.
pub(crate) struct Hold<'p> {
    pub layout: &'p Layout,
    /// The planes of all targets.
    pub targets: &'p [f32],
    pub rate_hz: f32,
    pub share: f32,
    /// The rows, from and to.
    pub rows: [usize; 2],
    /// Positions, velocities and inverse masses of these rows.
    pub x: [&'p mut [f32]; 3],
    pub v: [&'p mut [f32]; 3],
    pub inverse: &'p [f32],
}

impl Pass for Hold<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(mut self, zero: V) {
        let [from, to] = self.rows;
        for row in 0..to.saturating_sub(from) {
            for column in (0..self.layout.width).step_by(V::LANES) {
                let at = row * self.layout.stride + column;
                let held = self.may_hold(zero, at);
                if held.any() {
                    let mut each = [0.0; 16];
                    held.write(&mut each, 0);
                    for (held, at) in each.iter().zip(at..) {
                        if *held > 0.0 {
                            self.hold(at);
                        }
                    }
                }
            }
        }
    }
}

impl Hold<'_> {
    /// Which particles from a place of the rows on a limit holds: 1 where one may. A quick look; [`Aim::hold`] looks exactly.
    #[inline(always)]
    fn may_hold<V: Vector>(&self, zero: V, at: usize) -> V {
        let (size, share) = (self.layout.plane, zero.all(self.share));
        let planes = self.targets;
        let of_all = self.layout.row(self.rows[0]).wrapping_add(at);
        let place = |plane: usize| plane.wrapping_mul(size).wrapping_add(of_all);
        let (most, radius) = (zero.read(planes, place(MAX_DISTANCE)), zero.read(planes, place(RADIUS)));
        let backstops = radius.any_above(zero);
        if !backstops && !zero.all(FREE).any_above(most) {
            return zero;
        }
        // from the target, along the three axes
        let from = [zero.read(planes, place(0)), zero.read(planes, place(1)), zero.read(planes, place(2))];
        let to = [zero.read(planes, place(TO)), zero.read(planes, place(TO + 1)), zero.read(planes, place(TO + 2))];
        let [x, y, z] = &self.x;
        let away = Three::read(zero, [x, y, z], at).minus(between(Three(from), Three(to), share));
        // a little less than the limit, since it is a squared and rounded one
        let held = (most * most * zero.all(0.9999)).one_unless_above(away.squared());
        if !backstops {
            return held;
        }
        const END: usize = TO + NORMAL;
        let from = [
            zero.read(planes, place(NORMAL)),
            zero.read(planes, place(NORMAL + 1)),
            zero.read(planes, place(NORMAL + 2)),
        ];
        let to = [zero.read(planes, place(END)), zero.read(planes, place(END + 1)), zero.read(planes, place(END + 2))];
        let normal = between(Three(from), Three(to), share);
        let behind = (radius + zero.read(planes, place(DISTANCE))) / normal.squared().max(zero.all(1e-12)).sqrt();
        let from = away.plus(normal.times(behind));
        from.squared().one_unless_above(radius * radius * zero.all(1.0001)).max(held)
    }

    /// Holds one particle. Pinned and absent ones and spare places go their own way.
    #[inline(never)]
    fn hold(&mut self, at: usize) {
        if read(self.inverse, at) == 0.0 {
            return;
        }
        let get = |[x, y, z]: &[&mut [f32]; 3]| V3::new(read(x, at), read(y, at), read(z, at));
        let (mut x, mut v) = (get(&self.x), get(&self.v));
        self.aim(at).hold(&mut x, &mut v);
        for (planes, value) in [(&mut self.x, x), (&mut self.v, v)] {
            for (plane, value) in planes.iter_mut().zip(value.iter()) {
                write(plane, at, *value);
            }
        }
    }

    fn aim(&self, at: usize) -> Aim {
        let (size, rate, share, t) = (self.layout.plane, self.rate_hz, self.share, self.targets);
        let at = self.layout.row(self.rows[0]) + at;
        let mix = |from: V3, to: V3| if share < 1.0 { from + (to - from) * share } else { to };
        let (p, q) = (vector(t, 0, size, at), vector(t, TO, size, at));
        let (m, n) = (vector(t, NORMAL, size, at), vector(t, TO + NORMAL, size, at));
        Aim {
            position: mix(p, q),
            velocity: (q - p) * rate,
            // opposite ones have no middle
            normal: direction(mix(m, n)).0,
            turning: (n - m) * rate,
            max_distance: read(t, MAX_DISTANCE * size + at),
            radius: read(t, RADIUS * size + at),
            distance: read(t, DISTANCE * size + at),
        }
    }
}

/// From some points to others by a share.
#[inline(always)]
fn between<V: Vector>(from: Three<V>, to: Three<V>, share: V) -> Three<V> {
    from.plus(to.minus(from).times(share))
}
