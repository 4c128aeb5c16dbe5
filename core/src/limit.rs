//! One-sided distance limits between neighbours (Provot 1995): a link longer than its limit is drawn back to it, its ends
//! moving in proportion to their inverse masses; a shorter one is left alone.
//!
//! The order is fixed and red-black, so that the links of one pass share no particle and nothing depends on how the work
//! is split: along u the even columns then the odd ones, along v the even rows then the odd ones, the diagonals likewise.
//! Every second sweep runs the families backwards, so that none always has the last word.

use crate::layout::{read, write};
use crate::mask::cuts;
use crate::math::{max, sqrt};

/// Particles in rows: those of the cloth, or every so manieth of them.
pub(crate) struct Sheet<'s> {
    pub rows: usize,
    pub columns: usize,
    /// Numbers from a row to the next, and the place of the first particle.
    pub stride: usize,
    pub first: usize,
    /// Positions in m.
    pub x: [&'s mut [f32]; 3],
    /// Inverse masses, 0 for what does not move.
    pub inverse: &'s [f32],
    /// 0 for absent particles; empty where all are there.
    pub mask: &'s [f32],
    pub reach: Reach,
}

/// The longest that links may be.
#[derive(Clone, Copy)]
pub(crate) struct Reach {
    /// Limits of a link over one cell along u, along v, and the factor from the rest length of a diagonal to its limit, in m.
    pub u: f32,
    pub v: f32,
    pub diagonal: f32,
    /// Rest lengths of a cell in m.
    pub rest_u: f32,
    pub rest_v: f32,
    /// Cells that a link spans along u and v, and the last link of a row or column, which may be shorter.
    pub span: [usize; 2],
    pub last_span: [usize; 2],
}

impl Reach {
    fn span_u(&self, column: usize, columns: usize) -> f32 {
        (if column + 2 == columns { self.last_span[0] } else { self.span[0] }) as f32
    }

    fn span_v(&self, row: usize, rows: usize) -> f32 {
        (if row + 2 == rows { self.last_span[1] } else { self.span[1] }) as f32
    }
}

impl Sheet<'_> {
    /// `sweeps` sweeps over all links.
    pub fn sweep(&mut self, sweeps: u32) {
        for s in 0..sweeps {
            if s % 2 == 0 {
                self.along_u();
                self.along_v();
                self.diagonals(true);
                self.diagonals(false);
            } else {
                self.diagonals(false);
                self.diagonals(true);
                self.along_v();
                self.along_u();
            }
        }
    }

    fn along_u(&mut self) {
        for row in 0..self.rows {
            let at = self.first + row * self.stride;
            for parity in 0..2 {
                for column in (parity..self.columns.saturating_sub(1)).step_by(2) {
                    let limit = self.reach.u * self.reach.span_u(column, self.columns);
                    self.draw_back(at + column, at + column + 1, 0, limit);
                }
            }
        }
    }

    fn along_v(&mut self) {
        for parity in 0..2 {
            for row in (parity..self.rows.saturating_sub(1)).step_by(2) {
                let at = self.first + row * self.stride;
                let limit = self.reach.v * self.reach.span_v(row, self.rows);
                for column in 0..self.columns {
                    self.draw_back(at + column, at + column + self.stride, 1, limit);
                }
            }
        }
    }

    /// The links to the lower right, or to the lower left.
    fn diagonals(&mut self, right: bool) {
        let (columns, reach) = (self.columns, self.reach);
        for parity in 0..2 {
            for row in (parity..self.rows.saturating_sub(1)).step_by(2) {
                let at = self.first + row * self.stride;
                let v = reach.rest_v * reach.span_v(row, self.rows);
                let limit = |column: usize| {
                    let u = reach.rest_u * reach.span_u(column, columns);
                    reach.diagonal * sqrt(u * u + v * v)
                };
                let (inner, outer) = (limit(0), limit(columns - 2));
                for column in 0..columns.saturating_sub(1) {
                    let limit = if column + 2 == columns { outer } else { inner };
                    let (upper, lower) = (at + column, at + column + self.stride);
                    if right {
                        self.draw_back(upper, lower + 1, 2, limit);
                    } else {
                        self.draw_back(upper + 1, lower, 3, limit);
                    }
                }
            }
        }
    }

    /// Draws a link that is too long back to its limit. `plane` is that of its spring, as [`cuts`] has it.
    #[inline(always)]
    fn draw_back(&mut self, at: usize, other: usize, plane: usize, limit: f32) {
        let [x, y, z] = &mut self.x;
        let way = |p: &[f32]| read(p, other) - read(p, at);
        let d = [way(x), way(y), way(z)];
        let [dx, dy, dz] = d;
        let d2 = dx * dx + dy * dy + dz * dz;
        if d2 > limit * limit && !cuts(self.mask, self.stride, at, other, plane) {
            let (w, w_other) = (read(self.inverse, at), read(self.inverse, other));
            let f = (1.0 - limit / sqrt(d2)) / max(w + w_other, f32::MIN_POSITIVE);
            for (p, d) in [x, y, z].into_iter().zip(d) {
                let (here, there) = (read(p, at) + d * (f * w), read(p, other) - d * (f * w_other));
                write(p, at, here);
                write(p, other, there);
            }
        }
    }
}
