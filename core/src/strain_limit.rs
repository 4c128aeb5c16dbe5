//! The strain limit (Provot 1995): after each substep no structural or diagonal spring is longer than its family allows, as
//! far as the sweeps reach. What is moved is also given to the velocity, x += D and v += D/dt.

use crate::force::Substep;
use crate::layout::{Layout, copy, read, span, take};
use crate::limit::{Reach, Sheet};
use crate::mask::cuts;
use crate::{Cloth, Error};

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

    /// `passes` sweeps over the links of the cloth itself.
    pub(crate) fn sweep_finest(&mut self, c: &Substep, target: f32, passes: u32) {
        let l = self.layout;
        let reach = self.reach(c, target, [1, 1], [1, 1]);
        Sheet {
            rows: l.rows,
            columns: l.columns,
            stride: l.stride,
            first: l.row(0),
            x: [&mut *self.x.x, &mut *self.x.y, &mut *self.x.z],
            inverse: self.inverse,
            mask: self.mask,
            reach,
        }
        .sweep(passes);
    }

    /// Keeps the positions as they are, for [`Cloth::finish_limits`].
    pub(crate) fn begin_limits(&mut self) {
        for (to, from) in self.before.planes.iter_mut().zip([&*self.x.x, &*self.x.y, &*self.x.z]) {
            copy(to, from);
        }
    }

    /// Gives what the limits moved to the velocities.
    pub(crate) fn finish_limits(&mut self, c: &Substep) {
        let l = self.layout;
        let per_s = 1.0 / c.dt;
        let planes = [(&*self.x.x, &mut *self.v.x), (&*self.x.y, &mut *self.v.y), (&*self.x.z, &mut *self.v.z)];
        for ((x, v), before) in planes.into_iter().zip(&self.before.planes) {
            for row in 0..l.rows {
                let at = l.row(row);
                let Some(v) = v.get_mut(at..at + l.width) else {
                    continue;
                };
                for ((v, x), b) in v.iter_mut().zip(span(x, at, l.width)).zip(span(before, at, l.width)) {
                    *v += (x - b) * per_s;
                }
            }
        }
    }

    /// Whether no structural link is strained by more than a share of its limit.
    pub(crate) fn within_limits(&self, c: &Substep, share: f32) -> bool {
        let l = self.layout;
        let [warp, weft, _] = self.def.strain_limit;
        let [u, v] = [c.rest_u * (1.0 + share * weft), c.rest_v * (1.0 + share * warp)];
        (0..l.rows).all(|row| {
            let at = l.row(row);
            !self.any_longer(at, at + 1, l.columns.saturating_sub(1), 0, u)
                && (row + 1 == l.rows || !self.any_longer(at, at + l.stride, l.columns, 1, v))
        })
    }

    /// Whether no diagonal is longer than what the sweeps aim at.
    pub(crate) fn diagonals_within(&self, c: &Substep) -> bool {
        let l = self.layout;
        let [_, _, diagonal] = self.def.strain_limit;
        let limit = c.rest_diagonal * (1.0 + TARGET * diagonal);
        let n = l.columns.saturating_sub(1);
        (0..l.rows.saturating_sub(1)).all(|row| {
            let (at, below) = (l.row(row), l.row(row + 1));
            !self.any_longer(at, below + 1, n, 2, limit) && !self.any_longer(at + 1, below, n, 3, limit)
        })
    }

    /// Whether one of `n` links side by side, the first between two places, is longer than a limit. `plane` as in [`cuts`].
    fn any_longer(&self, at: usize, other: usize, n: usize, plane: usize, limit: f32) -> bool {
        let p = self.x.view();
        let mut long = false;
        for i in 0..n {
            let way = |p: &[f32]| read(p, other + i) - read(p, at + i);
            let (dx, dy, dz) = (way(p.x), way(p.y), way(p.z));
            long |= dx * dx + dy * dy + dz * dz > limit * limit
                && !cuts(self.mask, self.layout.stride, at + i, other + i, plane);
        }
        long
    }

    /// The limit alone: positions and velocities.
    pub(crate) fn apply_strain_limit(&mut self, c: &Substep) {
        self.begin_limits();
        self.sweep_finest(c, TARGET, self.def.strain_passes);
        self.finish_limits(c);
    }
}
