//! Tethers (long-range attachments, Kim, Chentanez and Mueller 2012): a particle may be no farther from each of the two pins
//! that are nearest to it in the rest grid than the cloth between them is long.
//!
//! One-sided: a tether pulls, it never pushes. What it moves is also given to the velocity, x += D and v += D/dt.

use crate::force::Substep;
use crate::layout::{block, read, take, write};
use crate::math::{max, round16, sqrt};
use crate::simd::{Pass, Three, Vector};
use crate::strain_limit::TARGET;
use crate::{Cloth, Error, simd};

/// Tethers of a particle.
pub(crate) const TETHERS: usize = 2;

/// Particles that are looked at together: one vector of the widest kind.
pub(crate) const BLOCK: usize = 16;
/// Where the particles of a block have different pins. No particle is at this place of a plane.
const MIXED: u32 = 0;
/// Set where the pins of a block follow one another as its particles do, as below a pinned row: the place is the first
/// one's. No plane is so long that a place would have this bit.
const RUN: u32 = 1 << 31;

/// The tethers of particles in rows: of each the places of its two nearest pins, the nearest last, as the bits of a u32, and
/// the largest lengths in m; infinite where there is no such pin or the particle does not move.
pub(crate) struct Tethers<'a> {
    pub pin: [&'a mut [f32]; TETHERS],
    pub length: [&'a mut [f32]; TETHERS],
    /// For each [`BLOCK`] of a plane the place of the pin that all have, as `pin`, or that of the first with [`RUN`], or
    /// [`MIXED`].
    pub common: [&'a mut [f32]; TETHERS],
}

impl<'a> Tethers<'a> {
    /// f32 numbers that they need for planes of a length.
    pub fn numbers(plane: usize) -> usize {
        TETHERS * (2 * plane + round16(plane.div_ceil(BLOCK)))
    }

    pub fn new(plane: usize, block: &mut &'a mut [f32]) -> Result<Self, Error> {
        let blocks = round16(plane.div_ceil(BLOCK));
        Ok(Tethers {
            pin: [take(block, plane)?, take(block, plane)?],
            length: [take(block, plane)?, take(block, plane)?],
            common: [take(block, blocks)?, take(block, blocks)?],
        })
    }

    /// Finds the blocks with one pin or with a run of them, after pins and lengths have been written.
    pub fn find_common(&mut self) {
        for ((pins, lengths), common) in self.pin.iter().zip(&self.length).zip(&mut self.common) {
            for ((pins, lengths), common) in pins.chunks(BLOCK).zip(lengths.chunks(BLOCK)).zip(common.iter_mut()) {
                let held = || {
                    let all = pins.iter().zip(lengths).zip(0u32..);
                    all.filter(|((_, l), _)| **l < f32::INFINITY).map(|((p, _), lane)| (p.to_bits(), lane))
                };
                // where nothing is held any place will do
                let (first, lane) = held().next().unwrap_or((1, 0));
                let start = first.wrapping_sub(lane);
                *common = f32::from_bits(if held().all(|(p, _)| p == first) {
                    first
                } else if first > lane && held().all(|(p, lane)| p == start.wrapping_add(lane)) {
                    start | RUN
                } else {
                    MIXED
                });
            }
        }
    }
}

/// The slack of a tether along (u, v) of the rest grid: that of the nearer axis at 0 degrees, that of the diagonal at 45,
/// linear in the ratio of the sides between.
pub(crate) fn slack(u: f32, v: f32, [warp, weft, diagonal]: [f32; 3]) -> f32 {
    let (long, short, axis) = if u > v { (u, v, weft) } else { (v, u, warp) };
    if long > 0.0 { axis + (diagonal - axis) * (short / long) } else { axis }
}

/// Draws particles to where their tethers let them be. Whether any tether pulled.
pub(crate) struct Pull<'p> {
    pub rows: usize,
    pub columns: usize,
    pub stride: usize,
    pub first: usize,
    pub x: [&'p mut [f32]; 3],
    /// Where the pins are; none where they are among `x`.
    pub anchors: Option<[&'p [f32]; 3]>,
    pub tethers: &'p Tethers<'p>,
    /// Velocities and 1/dt, where they get what was moved.
    pub velocity: Option<([&'p mut [f32]; 3], f32)>,
    /// Nothing is moved, and the answer comes with the first tether that would pull.
    pub look: bool,
}

/// Blocks of a row whose anchors are kept for the next row, where they are often the same: below a pinned edge, or a part of
/// one. To find them one by one takes longer than all else.
const HELD: usize = 4;

/// The anchors of a block, with the places of the pins. While particles are pulled no pin moves.
struct Anchors {
    pins: [u32; BLOCK],
    x: [[f32; BLOCK]; 3],
}

impl Anchors {
    /// No pin is there.
    const NONE: Anchors = Anchors { pins: [u32::MAX; BLOCK], x: [[0.0; BLOCK]; 3] };
}

impl Pass for Pull<'_> {
    type Output = bool;

    #[inline(always)]
    fn run<V: Vector>(mut self, zero: V) -> bool {
        let mut any = false;
        let mut held = [const { [const { Anchors::NONE }; TETHERS] }; HELD];
        for row in 0..self.rows {
            let first = self.first.wrapping_add(row.wrapping_mul(self.stride));
            let mut column = 0;
            while column < self.columns {
                any |= self.block(zero, first.wrapping_add(column), &mut held[column / BLOCK % HELD]);
                if any && self.look {
                    return true;
                }
                column = column.wrapping_add(BLOCK);
            }
        }
        any
    }
}

impl Pull<'_> {
    #[inline(always)]
    fn anchor(&self, place: usize) -> [f32; 3] {
        let [x, y, z] = &self.x;
        let [x, y, z] = match self.anchors {
            Some(anchors) => anchors,
            None => [&**x, &**y, &**z],
        };
        [read(x, place), read(y, place), read(z, place)]
    }

    /// The anchors of lanes that follow one another, from a place on.
    #[inline(always)]
    fn run_of<V: Vector>(&self, zero: V, place: usize) -> Three<V> {
        let [x, y, z] = &self.x;
        let [x, y, z] = match self.anchors {
            Some(anchors) => anchors,
            None => [&**x, &**y, &**z],
        };
        Three([zero.read(x, place), zero.read(y, place), zero.read(z, place)])
    }

    /// The anchors of a block, one by one.
    #[inline(always)]
    fn find(&self, tether: usize, at: usize, held: &mut Anchors) {
        let Some(pins) = self.tethers.pin.get(tether).and_then(|pins| block::<BLOCK>(pins, at)) else {
            return;
        };
        let mut other = 0;
        for (pin, held) in pins.iter().zip(&mut held.pins) {
            other |= pin.to_bits() ^ *held;
            *held = pin.to_bits();
        }
        if other != 0 {
            let [xs, ys, zs] = &mut held.x;
            for (((pin, x), y), z) in held.pins.iter().zip(xs).zip(ys).zip(zs) {
                [*x, *y, *z] = self.anchor(*pin as usize);
            }
        }
    }

    /// The particles of a block.
    #[inline(always)]
    fn block<V: Vector>(&mut self, zero: V, at: usize, held: &mut [Anchors; TETHERS]) -> bool {
        let block = at / BLOCK;
        let [common, common_last] = &self.tethers.common;
        let pins = [read(common, block).to_bits(), read(common_last, block).to_bits()];
        let anchors = [self.anchor(pins[0] as usize), self.anchor(pins[1] as usize)];
        for (tether, held) in held.iter_mut().enumerate() {
            if pins[tether] == MIXED {
                self.find(tether, at, held);
            }
        }
        let (one, half) = (zero.all(1.0), zero.all(0.5));
        let mut any = false;
        let mut lane = 0;
        while lane < BLOCK {
            let at = at.wrapping_add(lane);
            let [x, y, z] = &self.x;
            let from = Three([zero.read(x, at), zero.read(y, at), zero.read(z, at)]);
            let (mut to, mut pulled, mut pulls) = (from, zero, false);
            for tether in 0..TETHERS {
                let length = zero.read(self.tethers.length[tether], at);
                let anchor = if pins[tether] == MIXED {
                    let [x, y, z] = &held[tether].x;
                    Three([zero.read(x, lane), zero.read(y, lane), zero.read(z, lane)])
                } else if pins[tether] & RUN != 0 {
                    self.run_of(zero, (pins[tether] & !RUN) as usize + lane)
                } else {
                    let [x, y, z] = anchors[tether];
                    Three([zero.all(x), zero.all(y), zero.all(z)])
                };
                let (d, square) = (to.minus(anchor), length * length);
                let d2 = d.squared();
                if d2.any_above(square) {
                    to = Three::choose(d2, square, anchor.plus(d.times(length / d2.sqrt())), to);
                    pulled = d2.above(square, one, pulled);
                    pulls = true;
                }
            }
            if pulls && !self.look {
                let [x, y, z] = &mut self.x;
                to.write([x, y, z], at);
                if let Some(([x, y, z], per_s)) = &mut self.velocity {
                    let v = Three([zero.read(x, at), zero.read(y, at), zero.read(z, at)]);
                    let faster = v.plus(to.minus(from).times(zero.all(*per_s)));
                    Three::choose(pulled, half, faster, v).write([x, y, z], at);
                }
            }
            any |= pulls;
            lane = lane.wrapping_add(V::LANES);
        }
        any
    }
}

impl Cloth<'_> {
    /// Finds the tethers anew; called when the pins have changed. O(particles x pins).
    pub(crate) fn attach_tethers(&mut self) {
        let l = self.layout;
        let [scale_u, scale_v, _] = self.ambient.rest_scale();
        let (rest_u, rest_v) = (self.grid.rest_u() * scale_u, self.grid.rest_v() * scale_v);
        let mut slacks = self.def.tether_slack;
        if l.levels {
            // a tether shorter than the limited links below it may get would fight them, and shake the cloth
            for (slack, limit) in slacks.iter_mut().zip(self.def.strain_limit) {
                *slack = max(*slack, TARGET * limit);
            }
        }
        for lengths in &mut self.tethers.length {
            lengths.fill(f32::INFINITY);
        }
        for row in 0..l.rows {
            for column in 0..l.columns {
                let at = l.at(row, column);
                if read(self.inverse, at) == 0.0 {
                    continue;
                }
                // (squared rest distance, place, u, v) of the nearest and of the second
                let mut near = [(f32::INFINITY, 0usize, 0.0f32, 0.0f32); TETHERS];
                for pin in self.pins.iter() {
                    let columns = l.columns.max(1);
                    let (pin_row, pin_column) = (pin.particle / columns, pin.particle % columns);
                    let (u, v) = (pin_column.abs_diff(column) as f32 * rest_u, pin_row.abs_diff(row) as f32 * rest_v);
                    let d2 = u * u + v * v;
                    let i = l.at(pin_row, pin_column);
                    let [first, second] = near;
                    if d2 < first.0 {
                        near = [(d2, i, u, v), first];
                    } else if d2 < second.0 {
                        near = [first, (d2, i, u, v)];
                    }
                }
                let [first, second] = near;
                for ((d2, pin, u, v), (pins, lengths)) in
                    [second, first].into_iter().zip(self.tethers.pin.iter_mut().zip(&mut self.tethers.length))
                {
                    write(pins, at, f32::from_bits(pin as u32));
                    write(lengths, at, sqrt(d2) * (1.0 + slack(u, v, slacks)));
                }
            }
        }
        self.tethers.find_common();
        self.attach_nodes();
    }

    /// Tethers alone: positions and velocities.
    pub(crate) fn apply_tethers(&mut self, c: &Substep) {
        self.pull(Some(1.0 / c.dt), false);
    }

    /// The positions only, where what was moved goes to the velocities later.
    pub(crate) fn tether_particles(&mut self) {
        self.pull(None, false);
    }

    /// Whether no tether pulls.
    pub(crate) fn tethers_are_slack(&mut self) -> bool {
        !self.pull(None, true)
    }

    fn pull(&mut self, per_s: Option<f32>, look: bool) -> bool {
        let l = self.layout;
        let [vx, vy, vz] = [&mut *self.v.x, &mut *self.v.y, &mut *self.v.z];
        let pull = Pull {
            rows: l.rows,
            columns: l.columns,
            stride: l.stride,
            first: l.row(0),
            x: [&mut *self.x.x, &mut *self.x.y, &mut *self.x.z],
            anchors: None,
            tethers: &self.tethers,
            velocity: per_s.map(|per_s| ([vx, vy, vz], per_s)),
            look,
        };
        self.pins.count > 0 && simd::run(self.width, pull)
    }
}
