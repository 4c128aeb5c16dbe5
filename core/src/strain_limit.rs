//! The strain limit (Provot 1995): after each substep no structural or diagonal spring is longer than its family allows, as
//! far as the sweeps reach. What is moved is also given to the velocity, x += D and v += D/dt.

use crate::force::Substep;
use crate::layout::{Layout, copy, take};
use crate::limit::{Reach, Sheet, Sweeps};
use crate::simd::{Pass, Vector};
use crate::within::LongRows;
use crate::{Cloth, Error, simd};

/// The sweeps aim at this share of the limit, since they come close to what they aim at but not below.
pub(crate) const TARGET: f32 = 0.9;

/// Positions before the limits moved them; shared by the strain limit and the levels.
pub(crate) struct Before<'a> {
    pub planes: [&'a mut [f32]; 3],
}

impl<'a> Before<'a> {
    /// f32 numbers that they need.
    pub fn numbers(l: &Layout) -> usize {
        if l.strain_limit || l.levels { 3 * l.plane } else { 0 }
    }

    pub fn new(l: &Layout, block: &mut &'a mut [f32]) -> Result<Self, Error> {
        let n = Self::numbers(l) / 3;
        Ok(Before { planes: [take(block, n)?, take(block, n)?, take(block, n)?] })
    }
}

impl Cloth<'_> {
    /// `target` times the limits on a sheet of every `span`-th particle (u, v); the last link of a row or column spans
    /// `last_span` cells.
    pub(crate) fn reach(&self, c: &Substep, target: f32, span: [usize; 2], last_span: [usize; 2]) -> Reach {
        let [warp, weft, diagonal] = self.def.strain_limit;
        // shear springs whose rest lengths are scaled by themselves
        let scale = c.rest_diagonal / crate::sqrt(c.rest_u * c.rest_u + c.rest_v * c.rest_v);
        Reach {
            u: c.rest_u * (1.0 + target * weft),
            v: c.rest_v * (1.0 + target * warp),
            diagonal: scale * (1.0 + target * diagonal),
            rest_u: c.rest_u,
            rest_v: c.rest_v,
            span,
            last_span,
        }
    }

    /// Rows of the cloth, from `first` to `last`, as a sheet whose links may be `target` times their limits.
    fn sheet(&mut self, c: &Substep, target: f32, (first, last): (usize, usize)) -> Sheet<'_> {
        let l = self.layout;
        let reach = self.reach(c, target, [1, 1], [1, 1]);
        Sheet {
            rows: last.saturating_sub(first) + 1,
            columns: l.columns,
            stride: l.stride,
            first: l.row(first),
            x: [&mut *self.x.x, &mut *self.x.y, &mut *self.x.z],
            inverse: self.inverse,
            mask: self.mask,
            reach,
        }
    }

    /// First and last row of the cloth.
    pub(crate) fn rows(&self) -> (usize, usize) {
        (0, self.layout.rows.saturating_sub(1))
    }

    /// Sweeps over the links of the cloth itself.
    pub(crate) fn sweep_finest(&mut self, c: &Substep, target: f32) {
        self.sweep_rows(c, target, self.rows(), self.def.strain_passes);
    }

    /// Sweeps over the links of some rows.
    pub(crate) fn sweep_rows(&mut self, c: &Substep, target: f32, rows: (usize, usize), sweeps: u32) {
        let width = self.width;
        simd::run(width, Sweeps { sheet: self.sheet(c, target, rows), sweeps });
    }

    /// Whether no structural link, or diagonal if they count, is beyond a share of its limit: with them, whether a sweep that aims
    /// there would move nothing.
    pub(crate) fn is_within(&mut self, c: &Substep, share: f32, diagonals: bool) -> bool {
        let (width, rows) = (self.width, self.rows());
        simd::run(width, LongRows { sheet: self.sheet(c, share, rows), diagonals, any: true }).is_none()
    }

    /// The first and the last row of some where a structural link is beyond its limit.
    pub(crate) fn long_rows(&mut self, c: &Substep, rows: (usize, usize)) -> Option<(usize, usize)> {
        let width = self.width;
        let (first, last) =
            simd::run(width, LongRows { sheet: self.sheet(c, 1.0, rows), diagonals: false, any: false })?;
        Some((rows.0 + first, rows.0 + last))
    }

    /// Keeps the positions as they are, for [`Cloth::finish_limits`].
    pub(crate) fn begin_limits(&mut self) {
        for (to, from) in self.before.planes.iter_mut().zip([&*self.x.x, &*self.x.y, &*self.x.z]) {
            copy(to, from);
        }
    }

    /// Gives what the limits moved to the velocities.
    pub(crate) fn finish_limits(&mut self, c: &Substep) {
        let v = [&mut *self.v.x, &mut *self.v.y, &mut *self.v.z];
        let x = [&*self.x.x, &*self.x.y, &*self.x.z];
        let before = self.before.planes.each_ref().map(|p| &**p);
        simd::run(self.width, Finish { layout: self.layout, per_s: 1.0 / c.dt, x, v, before });
    }

    /// The limit alone: positions and velocities.
    pub(crate) fn apply_strain_limit(&mut self, c: &Substep) {
        if !self.is_within(c, TARGET, true) {
            self.begin_limits();
            self.sweep_finest(c, TARGET);
            self.finish_limits(c);
        }
    }
}

/// v += (x - before) / dt.
struct Finish<'f> {
    layout: Layout,
    per_s: f32,
    x: [&'f [f32]; 3],
    v: [&'f mut [f32]; 3],
    before: [&'f [f32]; 3],
}

impl Pass for Finish<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self, zero: V) {
        let (l, per_s) = (self.layout, zero.all(self.per_s));
        for ((x, v), before) in self.x.into_iter().zip(self.v).zip(self.before) {
            for row in 0..l.rows {
                let (mut at, end) = (l.row(row), l.row(row) + l.columns);
                while at < end {
                    (zero.read(v, at) + (zero.read(x, at) - zero.read(before, at)) * per_s).write(v, at);
                    at += V::LANES;
                }
            }
        }
    }
}
