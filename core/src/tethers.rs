//! Tethers (long-range attachments, Kim, Chentanez and Mueller 2012): a particle may be no farther from each of the two pins
//! that are nearest to it in the rest grid than the cloth between them is long.
//!
//! One-sided: a tether pulls, it never pushes. What it moves is also given to the velocity, x += D and v += D/dt.

use crate::force::Substep;
use crate::layout::{Layout, read, take, write};
use crate::math::{max, sqrt};
use crate::strain_limit::TARGET;
use crate::{Cloth, Error};

/// Tethers of a particle.
pub(crate) const TETHERS: usize = 2;

/// The tethers of a cloth: of each particle the places of its two nearest pins, the nearest last, as the bits of a u32, and
/// the largest lengths in m; infinite where there is no such pin.
pub(crate) struct Tethers<'a> {
    pub pin: [&'a mut [f32]; TETHERS],
    pub length: [&'a mut [f32]; TETHERS],
}

impl<'a> Tethers<'a> {
    /// f32 numbers that they need.
    pub fn numbers(l: &Layout) -> usize {
        if l.has_tethers() { 2 * TETHERS * l.plane } else { 0 }
    }

    pub fn new(l: &Layout, block: &mut &'a mut [f32]) -> Result<Self, Error> {
        let n = if l.has_tethers() { l.plane } else { 0 };
        Ok(Tethers { pin: [take(block, n)?, take(block, n)?], length: [take(block, n)?, take(block, n)?] })
    }
}

/// The slack of a tether along (u, v) of the rest grid: that of the nearer axis at 0 degrees, that of the diagonal at 45,
/// linear in the ratio of the sides between.
pub(crate) fn slack(u: f32, v: f32, [warp, weft, diagonal]: [f32; 3]) -> f32 {
    let (long, short, axis) = if u > v { (u, v, weft) } else { (v, u, warp) };
    if long > 0.0 { axis + (diagonal - axis) * (short / long) } else { axis }
}

/// Moves a point to at most `length` from an anchor.
#[inline(always)]
pub(crate) fn pull_in(x: [f32; 3], anchor: [f32; 3], length: f32) -> [f32; 3] {
    let d = [x[0] - anchor[0], x[1] - anchor[1], x[2] - anchor[2]];
    let d2 = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    if d2 > length * length {
        let s = length / sqrt(d2);
        [anchor[0] + d[0] * s, anchor[1] + d[1] * s, anchor[2] + d[2] * s]
    } else {
        x
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
        for row in 0..l.rows {
            for column in 0..l.columns {
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
                let at = l.at(row, column);
                let [first, second] = near;
                for ((d2, pin, u, v), (pins, lengths)) in
                    [second, first].into_iter().zip(self.tethers.pin.iter_mut().zip(&mut self.tethers.length))
                {
                    write(pins, at, f32::from_bits(pin as u32));
                    write(lengths, at, sqrt(d2) * (1.0 + slack(u, v, slacks)));
                }
            }
        }
    }

    /// A position after the tethers of the particle at a place.
    #[inline(always)]
    pub(crate) fn tethered(&self, at: usize, mut x: [f32; 3]) -> [f32; 3] {
        for (pin, length) in self.tethers.pin.iter().zip(&self.tethers.length) {
            x = pull_in(x, self.local(read(pin, at).to_bits() as usize), read(length, at));
        }
        x
    }

    /// Tethers alone: positions and velocities.
    pub(crate) fn apply_tethers(&mut self, c: &Substep) {
        let per_s = 1.0 / c.dt;
        self.each_tethered(|cloth, at, from, x| {
            let v = [&*cloth.v.x, &*cloth.v.y, &*cloth.v.z].map(|p| read(p, at));
            let d = [x[0] - from[0], x[1] - from[1], x[2] - from[2]];
            cloth.set_velocity_at(at, [v[0] + d[0] * per_s, v[1] + d[1] * per_s, v[2] + d[2] * per_s]);
        });
    }

    /// The positions only, where what was moved goes to the velocities later.
    pub(crate) fn tether_particles(&mut self) {
        self.each_tethered(|_, _, _, _| ());
    }

    /// Whether no tether pulls.
    pub(crate) fn tethers_are_slack(&self) -> bool {
        let l = self.layout;
        self.pins.count == 0
            || (0..l.rows).all(|row| {
                (0..l.columns).all(|column| {
                    let at = l.at(row, column);
                    read(self.inverse, at) == 0.0 || {
                        let x = self.local(at);
                        self.tethered(at, x) == x
                    }
                })
            })
    }

    fn each_tethered(&mut self, moved: impl Fn(&mut Self, usize, [f32; 3], [f32; 3])) {
        if self.pins.count == 0 {
            return;
        }
        let l = self.layout;
        for row in 0..l.rows {
            for column in 0..l.columns {
                let at = l.at(row, column);
                if read(self.inverse, at) == 0.0 {
                    continue;
                }
                let from = self.local(at);
                let x = self.tethered(at, from);
                if x != from {
                    self.set_position_at(at, x);
                    moved(self, at, from, x);
                }
            }
        }
    }
}
