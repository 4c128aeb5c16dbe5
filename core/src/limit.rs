//! One-sided distance limits between neighbours (Provot 1995): a link longer than its limit is drawn back to it, its ends
//! moving in proportion to their inverse masses; a shorter one is left alone.
//!
//! The order is fixed and red-black, so that the links of one vector share no particle and nothing depends on how the work
//! is split: rows (even links along u, then odd ones) and the pairs of an even row and the next one (along v, the diagonals
//! to the lower right, to the lower left), then the pairs of an odd row and the next. A few rows are swept as soon as all that
//! comes before them is done, so that a sweep goes through memory once. Every second sweep runs all of that backwards, so
//! that no family always has the last word.
//!
//! A narrow vector without a link that is too long is left after the test of its lengths. In the others the links that are short
//! enough keep the bits of their ends: they are chosen, not added to. So all widths have the same bits.
#![allow(unsafe_code)] // pointers into planes whose lengths are checked once: see `Sheet::pointers`

use crate::force::TINY;
use crate::math::sqrt;
use crate::simd::{Pass, Three, Vector, load};

#[cfg(test)]
mod tests;

/// Particles in rows: those of the cloth, or every so manieth of them.
pub(crate) struct Sheet<'s> {
    pub rows: usize,
    pub columns: usize,
    /// Numbers from a row to the next, and the place of the first particle. A row has whole vectors of 16.
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
    fn over_diagonal(&self, span_u: usize, span_v: usize) -> f32 {
        let (u, v) = (self.rest_u * span_u as f32, self.rest_v * span_v as f32);
        self.diagonal * sqrt(u * u + v * v)
    }

    /// Along v between two rows, and along both diagonals there; where `last`, between the last two rows.
    pub(crate) fn across(&self, columns: usize, last: bool) -> (f32, Family) {
        let ([u, v], [last_u, last_v]) = (self.span, self.last_span);
        let v = if last { last_v } else { v };
        let links = columns.saturating_sub(1);
        (self.v * v as f32, Family::new(self.over_diagonal(u, v), self.over_diagonal(last_u, v), links))
    }

    /// Along u.
    pub(crate) fn along(&self, columns: usize) -> Family {
        let ([u, _], [last_u, _]) = (self.span, self.last_span);
        Family::new(self.u * u as f32, self.u * last_u as f32, columns.saturating_sub(1))
    }
}

/// Numbers of the tables of [`Family`]: whichever lane holds the last link, 16 before it, 16 beyond, and the
/// two vectors that links along u are worked on in.
const TABLE: usize = 64;

/// The limits of the links that start side by side in a row: one for all but the last, another for that, none beyond.
pub(crate) struct Family {
    pub(crate) links: usize,
    limit: f32,
    /// Limits and their squares around the last link, which is number 16.
    ends: [f32; TABLE],
    squares: [f32; TABLE],
}

impl Family {
    fn new(limit: f32, last: f32, links: usize) -> Family {
        let (mut ends, mut squares) = ([limit; TABLE], [f32::INFINITY; TABLE]);
        for (i, (end, square)) in ends.iter_mut().zip(&mut squares).enumerate().take(17) {
            *end = if i == 16 { last } else { limit };
            *square = *end * *end;
        }
        Family { links, limit, ends, squares }
    }

    /// Limits and their squares of the links that start in the lanes from a column of the sheet on.
    #[inline(always)]
    pub(crate) fn at<V: Vector>(&self, zero: V, column: usize) -> (V, V) {
        if column.wrapping_add(V::LANES) < self.links {
            (zero.all(self.limit), zero.all(self.limit * self.limit))
        } else {
            let i = column.wrapping_add(17).wrapping_sub(self.links);
            (zero.read(&self.ends, i), zero.read(&self.squares, i))
        }
    }
}

/// Where the numbers of a sheet lie: column 0 of row 0.
#[derive(Clone, Copy)]
pub(crate) struct Pointers {
    pub x: [*mut f32; 3],
    pub inverse: *const f32,
    pub mask: *const f32,
}

impl Sheet<'_> {
    /// None where a plane is too short: `rows` rows of `stride` numbers and 17 more.
    pub(crate) fn pointers(&mut self) -> Option<Pointers> {
        let end = self.rows.checked_mul(self.stride)?.checked_add(self.first)?.checked_add(17)?;
        if self.columns.div_ceil(16) * 16 > self.stride {
            return None;
        }
        let read = |plane: &[f32]| plane.get(self.first..end).map(|p| p.as_ptr());
        let [x, y, z] = &mut self.x;
        let write = |plane: &mut [f32]| plane.get_mut(self.first..end).map(|p| p.as_mut_ptr());
        Some(Pointers {
            x: [write(x)?, write(y)?, write(z)?],
            inverse: read(self.inverse)?,
            mask: if self.mask.is_empty() { core::ptr::null() } else { read(self.mask)? },
        })
    }
}

/// Sweeps over all links, at most `sweeps`: fewer where one found nothing too long. Whether anything was moved.
pub(crate) struct Sweeps<'s> {
    pub sheet: Sheet<'s>,
    pub sweeps: u32,
}

impl Pass for Sweeps<'_> {
    type Output = bool;

    #[inline(always)]
    fn run<V: Vector>(self, zero: V) -> bool {
        if self.sheet.mask.is_empty() { self.all::<V, false>(zero) } else { self.all::<V, true>(zero) }
    }
}

/// Numbers of a plane in every second of the rows that are worked on at once. What a step of the order below moves is not used before all
/// of them are through it: a processor that reads across what it has just written waits.
const NUMBERS_AT_ONCE: usize = 256;

/// From so many lanes on a vector without a link that is too long is rare, and the guess whether it is one costs more than the
/// square roots that are left out.
const ALWAYS: usize = 16;

/// Links that share no particle.
#[derive(Clone, Copy)]
enum Links {
    /// Along u, from even columns on (0) or odd ones (1).
    Along(usize),
    /// Between the rows of pairs, the second of which are odd (1) or even (0), and the family: along v, the diagonals to the
    /// lower right, to the lower left.
    Across(usize, usize),
}

/// The order of a sweep.
const FORWARD: [Links; 8] = [
    Links::Along(0),
    Links::Along(1),
    Links::Across(1, 0),
    Links::Across(1, 1),
    Links::Across(1, 2),
    Links::Across(0, 0),
    Links::Across(0, 1),
    Links::Across(0, 2),
];
/// The order of every second sweep: backwards, but that links along u always begin with the even ones.
const BACKWARD: [Links; 8] = {
    let [even, odd, a, b, c, d, e, f] = FORWARD;
    [f, e, d, c, b, a, even, odd]
};

/// The links between rows: along v and along the diagonals; those that reach the last row may be shorter.
struct Across {
    usual: (f32, Family),
    last: (f32, Family),
    last_row: usize,
}

/// What is the same in a whole sweep.
struct Constants<V> {
    zero: V,
    tiny: V,
    columns: usize,
    stride: usize,
}

impl Sweeps<'_> {
    #[inline(always)]
    fn all<V: Vector, const MASK: bool>(mut self, zero: V) -> bool {
        let Some(p) = self.sheet.pointers() else {
            return false;
        };
        let s = &self.sheet;
        let c = Constants { zero, tiny: zero.all(TINY), columns: s.columns, stride: s.stride };
        let along = s.reach.along(s.columns);
        let links_across = Across {
            usual: s.reach.across(s.columns, false),
            last: s.reach.across(s.columns, true),
            last_row: s.rows.saturating_sub(1),
        };
        let mut any = false;
        let rows_at_once = (NUMBERS_AT_ONCE / s.stride.max(1)).max(1) * 2;
        let blocks = s.rows.div_ceil(rows_at_once);
        // SAFETY: `pointers` has checked the lengths. The links of a row begin at columns below `columns` rounded up to
        // whole vectors, which is at most the stride, and reach one place farther in the same row or the next; nothing is
        // begun in the last row but links along u.
        unsafe {
            for sweep in 0..self.sweeps {
                let order = if sweep % 2 == 0 { &FORWARD } else { &BACKWARD };
                let mut moved = false;
                for block in 0..blocks {
                    let block = if sweep % 2 == 0 { block } else { blocks - 1 - block };
                    let first = block * rows_at_once;
                    let end = (first + rows_at_once).min(s.rows);
                    for links in order {
                        moved |= match links {
                            Links::Along(parity) => {
                                let mut moved = false;
                                for row in first..end {
                                    moved |= along_u::<V, MASK>(&c, &p, &along, row, *parity);
                                }
                                moved
                            }
                            Links::Across(lower, 0) => across::<V, MASK, 0>(&c, &p, &links_across, first + lower, end),
                            Links::Across(lower, 1) => across::<V, MASK, 1>(&c, &p, &links_across, first + lower, end),
                            Links::Across(lower, _) => across::<V, MASK, 2>(&c, &p, &links_across, first + lower, end),
                        };
                    }
                }
                if !moved {
                    break;
                }
                any = true;
            }
        }
        any
    }
}

/// Squares of limits, without one where absent particles cut the link: one of its ends, or both places beside a diagonal.
///
/// # Safety
/// The mask has the lanes from each place on.
#[inline(always)]
pub(crate) unsafe fn uncut<V: Vector>(
    zero: V,
    p: &Pointers,
    square: V,
    ends: [usize; 2],
    beside: Option<[usize; 2]>,
) -> V {
    // SAFETY: the caller's promise.
    unsafe {
        let mut there = load(zero, p.mask, ends[0]) * load(zero, p.mask, ends[1]);
        if let Some([a, b]) = beside {
            there = there * (load(zero, p.mask, a) + load(zero, p.mask, b));
        }
        there.above(zero, square, zero.all(f32::INFINITY))
    }
}

/// The way of the first ends of links for an inverse mass of 1: d (l - limit) / (l (w + w')).
#[inline(always)]
fn drawn<V: Vector>(c: &Constants<V>, d: Three<V>, d2: V, limit: V, w: V) -> Three<V> {
    let l = d2.sqrt();
    // tiny: where neither end moves
    d.times((l - limit) / (l * w.max(c.tiny)))
}

/// Draws back the links between the lanes at two places, which have no particle in common. Whether any was too long.
///
/// # Safety
/// The planes have the lanes from both places on.
#[inline(always)]
unsafe fn draw_back<V: Vector>(c: &Constants<V>, p: &Pointers, at: [usize; 2], limit: V, square: V) -> bool {
    // SAFETY: the caller's promise.
    unsafe {
        let (here, there) = (Three::load(c.zero, &p.x, at[0]), Three::load(c.zero, &p.x, at[1]));
        let d = there.minus(here);
        let d2 = d.squared();
        let moved = d2.any_above(square);
        if V::LANES < ALWAYS && !moved {
            return false;
        }
        let (w, w_there) = (load(c.zero, p.inverse, at[0]), load(c.zero, p.inverse, at[1]));
        let e = drawn(c, d, d2, limit, w + w_there);
        Three::choose(d2, square, here.plus(e.times(w)), here).store(&p.x, at[0]);
        Three::choose(d2, square, there.minus(e.times(w_there)), there).store(&p.x, at[1]);
        moved
    }
}

/// The links of a family between every second row from `lower` to `end` and the row before it.
///
/// # Safety
/// The rows before `end` are in the sheet.
#[inline(always)]
unsafe fn across<V: Vector, const MASK: bool, const FAMILY: usize>(
    c: &Constants<V>,
    p: &Pointers,
    links: &Across,
    lower: usize,
    end: usize,
) -> bool {
    let (mut lower, mut moved) = (lower, false);
    while lower < end {
        if lower > 0 {
            let pair = if lower == links.last_row { &links.last } else { &links.usual };
            // SAFETY: the caller's promise.
            moved |= unsafe { across_pair::<V, MASK, FAMILY>(c, p, pair, lower - 1) };
        }
        lower += 2;
    }
    moved
}

/// The links of a family between a row and the next one: along v, the diagonals to the lower right, to the lower left.
///
/// # Safety
/// The rows are in the sheet.
#[inline(always)]
unsafe fn across_pair<V: Vector, const MASK: bool, const FAMILY: usize>(
    c: &Constants<V>,
    p: &Pointers,
    (along_v, diagonal): &(f32, Family),
    row: usize,
) -> bool {
    let family = FAMILY;
    let upper = row.wrapping_mul(c.stride);
    let lower = upper.wrapping_add(c.stride);
    // numbers beyond the first and second ends, and beyond the places beside a diagonal
    let (at, to, links) = match family {
        0 => (upper, lower, c.columns),
        1 => (upper, lower.wrapping_add(1), diagonal.links),
        _ => (upper.wrapping_add(1), lower, diagonal.links),
    };
    let mut moved = false;
    let mut column = 0;
    while column < links {
        let ends = [at.wrapping_add(column), to.wrapping_add(column)];
        // SAFETY: the caller's promise. Beyond the columns there are zeros, so that no link along v is long there.
        unsafe {
            let (limit, mut square) = if family == 0 {
                (c.zero.all(*along_v), c.zero.all(*along_v * *along_v))
            } else {
                diagonal.at(c.zero, column)
            };
            if MASK {
                let beside = match family {
                    0 => None,
                    1 => Some([ends[0].wrapping_add(1), ends[1].wrapping_sub(1)]),
                    _ => Some([ends[0].wrapping_sub(1), ends[1].wrapping_add(1)]),
                };
                square = uncut(c.zero, p, square, ends, beside);
            }
            moved |= draw_back(c, p, ends, limit, square);
        }
        column = column.wrapping_add(V::LANES);
    }
    moved
}

/// The links along a row that begin at even columns (`parity` 0) or at odd ones (1).
///
/// # Safety
/// The row is in the sheet.
#[inline(always)]
unsafe fn along_u<V: Vector, const MASK: bool>(
    c: &Constants<V>,
    p: &Pointers,
    family: &Family,
    row: usize,
    parity: usize,
) -> bool {
    let first = row.wrapping_mul(c.stride);
    let mut moved = false;
    let mut column = parity;
    if V::LANES == 1 {
        while column < family.links {
            let at = first.wrapping_add(column);
            let ends = [at, at.wrapping_add(1)];
            // SAFETY: the caller's promise.
            unsafe {
                let (limit, mut square) = family.at(c.zero, column);
                if MASK {
                    square = uncut(c.zero, p, square, ends, None);
                }
                moved |= draw_back(c, p, ends, limit, square);
            }
            column += 2;
        }
        return moved;
    }
    // the links that begin at even columns lie within pairs of vectors; those at odd ones one place on
    while column < family.links {
        // SAFETY: the caller's promise.
        moved |= unsafe { pairs::<V, MASK>(c, p, family, first, column) };
        column = column.wrapping_add(V::LANES.wrapping_mul(2));
    }
    moved
}

/// Every second link along u, from a column on: those within two vectors. Whether any was too long.
///
/// # Safety
/// The planes have the lanes of both vectors.
#[inline(always)]
unsafe fn pairs<V: Vector, const MASK: bool>(
    c: &Constants<V>,
    p: &Pointers,
    family: &Family,
    first: usize,
    column: usize,
) -> bool {
    let at = first.wrapping_add(column);
    let next = at.wrapping_add(V::LANES);
    // SAFETY: the caller's promise.
    unsafe {
        let (here, there) = Three::load(c.zero, &p.x, at).split(Three::load(c.zero, &p.x, next));
        let d = there.minus(here);
        let d2 = d.squared();
        let ((limit, mut square), (limit_next, mut square_next)) =
            (family.at(c.zero, column), family.at(c.zero, column.wrapping_add(V::LANES)));
        if MASK {
            square = uncut(c.zero, p, square, [at, at.wrapping_add(1)], None);
            square_next = uncut(c.zero, p, square_next, [next, next.wrapping_add(1)], None);
        }
        let [limit, _] = limit.split(limit_next);
        let [square, _] = square.split(square_next);
        let moved = d2.any_above(square);
        if V::LANES < ALWAYS && !moved {
            return false;
        }
        let [w, w_there] = load(c.zero, p.inverse, at).split(load(c.zero, p.inverse, next));
        let e = drawn(c, d, d2, limit, w + w_there);
        let here = Three::choose(d2, square, here.plus(e.times(w)), here);
        let there = Three::choose(d2, square, there.minus(e.times(w_there)), there);
        let (here, there) = here.weave(there);
        here.store(&p.x, at);
        there.store(&p.x, next);
        moved
    }
}
