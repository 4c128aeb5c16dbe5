//! One-sided distance limits between neighbours (Provot 1995): a link longer than its limit is drawn back to it, its ends
//! moving in proportion to their inverse masses; a shorter one is left alone.
//!
//! The order is fixed and red-black, so that the links of one pass share no particle and nothing depends on how the work
//! is split: along u the even columns then the odd ones, along v the even rows then the odd ones, the diagonals likewise.
//! Every second sweep runs the families backwards, so that none always has the last word.

use crate::layout::{read, span, write};
use crate::mask::is_absent;
use crate::math::{max, sqrt};

/// Below this squared length in m^2 a link has no direction.
const TINY: f32 = 1e-30;

/// Links that are looked at together; where none of them is too long nothing else is done.
const BLOCK: usize = 16;

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

/// A row of positions and inverse masses.
struct Row<'r> {
    x: &'r mut [f32],
    y: &'r mut [f32],
    z: &'r mut [f32],
    w: &'r [f32],
    /// 0 for absent particles; empty where all are there.
    m: &'r [f32],
}

impl Sheet<'_> {
    /// `sweeps` sweeps over all links; diagonals only if asked.
    pub fn sweep(&mut self, sweeps: u32, diagonals: bool) {
        for s in 0..sweeps {
            if s % 2 == 0 {
                self.along_u();
                self.along_v();
                if diagonals {
                    self.diagonals(true);
                    self.diagonals(false);
                }
            } else {
                if diagonals {
                    self.diagonals(false);
                    self.diagonals(true);
                }
                self.along_v();
                self.along_u();
            }
        }
    }

    fn row(&mut self, row: usize) -> Option<Row<'_>> {
        let at = self.first + row * self.stride;
        let range = at..at + self.columns;
        let [x, y, z] = &mut self.x;
        Some(Row {
            x: x.get_mut(range.clone())?,
            y: y.get_mut(range.clone())?,
            z: z.get_mut(range.clone())?,
            w: self.inverse.get(range.clone())?,
            m: self.mask.get(range).unwrap_or(&[]),
        })
    }

    /// A row and the one below.
    fn pair(&mut self, row: usize) -> Option<(Row<'_>, Row<'_>)> {
        let (at, n, stride) = (self.first + row * self.stride, self.columns, self.stride);
        let [x, y, z] = &mut self.x;
        let (ux, lx) = split(x, at, n, stride)?;
        let (uy, ly) = split(y, at, n, stride)?;
        let (uz, lz) = split(z, at, n, stride)?;
        let (uw, lw) = (self.inverse.get(at..at + n)?, self.inverse.get(at + stride..at + stride + n)?);
        let (um, lm) = (span(self.mask, at, n), span(self.mask, at + stride, n));
        Some((Row { x: ux, y: uy, z: uz, w: uw, m: um }, Row { x: lx, y: ly, z: lz, w: lw, m: lm }))
    }

    fn along_u(&mut self) {
        let (rows, columns, reach) = (self.rows, self.columns, self.reach);
        for row in 0..rows {
            let Some(r) = self.row(row) else { return };
            for parity in 0..2 {
                let mut column = parity;
                while column + 1 < columns {
                    let limit = reach.u * reach.span_u(column, columns);
                    let (i, j) = (column, column + 1);
                    if let ([xi, xj], [yi, yj], [zi, zj], [wi, wj]) = (
                        r.x.get_mut(i..=j).unwrap_or(&mut []),
                        r.y.get_mut(i..=j).unwrap_or(&mut []),
                        r.z.get_mut(i..=j).unwrap_or(&mut []),
                        r.w.get(i..=j).unwrap_or(&[]),
                    ) {
                        let d = [*xj - *xi, *yj - *yi, *zj - *zi];
                        let d2 = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
                        if d2 > limit * limit && !is_absent(r.m, i) && !is_absent(r.m, j) {
                            let f = (1.0 - limit / sqrt(d2)) / max(*wi + *wj, f32::MIN_POSITIVE);
                            let (a, b) = (f * *wi, f * *wj);
                            (*xi, *yi, *zi) = (*xi + d[0] * a, *yi + d[1] * a, *zi + d[2] * a);
                            (*xj, *yj, *zj) = (*xj - d[0] * b, *yj - d[1] * b, *zj - d[2] * b);
                        }
                    }
                    column += 2;
                }
            }
        }
    }

    fn along_v(&mut self) {
        let (rows, reach) = (self.rows, self.reach);
        for parity in 0..2 {
            for row in (parity..rows.saturating_sub(1)).step_by(2) {
                let limit = reach.v * reach.span_v(row, rows);
                let Some((up, low)) = self.pair(row) else { return };
                links(up, low, |_| limit);
            }
        }
    }

    /// The links to the lower right, or to the lower left.
    fn diagonals(&mut self, right: bool) {
        let (rows, columns, reach) = (self.rows, self.columns, self.reach);
        for parity in 0..2 {
            for row in (parity..rows.saturating_sub(1)).step_by(2) {
                let v = reach.rest_v * reach.span_v(row, rows);
                let limit = |column: usize| {
                    let u = reach.rest_u * reach.span_u(column, columns);
                    reach.diagonal * sqrt(u * u + v * v)
                };
                let Some((up, low)) = self.pair(row) else { return };
                let (up, low) = if right { (up.first(), low.last()) } else { (up.last(), low.first()) };
                let (inner, outer) = (limit(0), limit(columns - 2));
                links(up, low, |column| if column + 2 == columns { outer } else { inner });
            }
        }
    }
}

impl<'r> Row<'r> {
    /// Without its last particle.
    fn first(self) -> Row<'r> {
        fn cut(p: &mut [f32]) -> &mut [f32] {
            let n = p.len().saturating_sub(1);
            p.split_at_mut_checked(n).map_or(&mut [], |s| s.0)
        }
        Row {
            x: cut(self.x),
            y: cut(self.y),
            z: cut(self.z),
            w: self.w.split_last().map_or(&[], |s| s.1),
            m: self.m.split_last().map_or(&[], |s| s.1),
        }
    }

    /// Without its first particle.
    fn last(self) -> Row<'r> {
        fn cut(p: &mut [f32]) -> &mut [f32] {
            p.split_first_mut().map_or(&mut [], |s| s.1)
        }
        Row {
            x: cut(self.x),
            y: cut(self.y),
            z: cut(self.z),
            w: self.w.split_first().map_or(&[], |s| s.1),
            m: self.m.split_first().map_or(&[], |s| s.1),
        }
    }
}

/// `n` numbers from a place on, and as many one row below.
fn split(plane: &mut [f32], at: usize, n: usize, stride: usize) -> Option<(&mut [f32], &mut [f32])> {
    let (up, low) = plane.get_mut(at..at + stride + n)?.split_at_mut_checked(stride)?;
    Some((up.get_mut(..n)?, low))
}

/// The links between the particles of two rows, the first with the first and so on.
fn links(up: Row<'_>, low: Row<'_>, limit: impl Fn(usize) -> f32) {
    let n = up.x.len();
    let (ux, uy, uz, uw) = (up.x, up.y, up.z, up.w);
    let (lx, ly, lz, lw) = (low.x, low.y, low.z, low.w);
    let (um, lm) = (up.m, low.m);
    let mut start = 0;
    while start < n {
        let end = if start + BLOCK < n { start + BLOCK } else { n };
        let of = |p: &[f32], i: usize| read(p, i);
        let mut long = false;
        for i in start..end {
            let (dx, dy, dz) = (of(lx, i) - of(ux, i), of(ly, i) - of(uy, i), of(lz, i) - of(uz, i));
            let m = limit(i);
            long |= dx * dx + dy * dy + dz * dz > m * m;
        }
        if long {
            for i in start..end {
                let (dx, dy, dz) = (of(lx, i) - of(ux, i), of(ly, i) - of(uy, i), of(lz, i) - of(uz, i));
                let d2 = max(dx * dx + dy * dy + dz * dz, TINY);
                let (wu, wl) = (of(uw, i), of(lw, i));
                let mut f = max(1.0 - limit(i) / sqrt(d2), 0.0) / max(wu + wl, f32::MIN_POSITIVE);
                if is_absent(um, i) || is_absent(lm, i) {
                    f = 0.0;
                }
                let (a, b) = (f * wu, f * wl);
                for (upper, lower, d) in [(&mut *ux, &mut *lx, dx), (&mut *uy, &mut *ly, dy), (&mut *uz, &mut *lz, dz)]
                {
                    let (u, l) = (of(upper, i) + d * a, of(lower, i) - d * b);
                    write(upper, i, u);
                    write(lower, i, l);
                }
            }
        }
        start = end;
    }
}
