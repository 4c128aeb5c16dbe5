//! Where links of a sheet are too long: what lets the limits leave a cloth, or most of its rows, alone.
#![allow(unsafe_code)] // pointers into planes whose lengths are checked once: see `Sheet::pointers`

use crate::limit::{Family, Pointers, Sheet, uncut};
use crate::simd::{Pass, Three, Vector};

/// The first and the last row with a structural link, or a diagonal where they count, that is too long.
pub(crate) struct LongRows<'s> {
    pub sheet: Sheet<'s>,
    pub diagonals: bool,
    /// Whether one is enough.
    pub any: bool,
}

impl Pass for LongRows<'_> {
    type Output = Option<(usize, usize)>;

    #[inline(always)]
    fn run<V: Vector>(self, zero: V) -> Option<(usize, usize)> {
        match (self.diagonals, self.sheet.mask.is_empty()) {
            (false, true) => self.all::<V, false, false>(zero),
            (false, false) => self.all::<V, false, true>(zero),
            (true, true) => self.all::<V, true, false>(zero),
            (true, false) => self.all::<V, true, true>(zero),
        }
    }
}

impl LongRows<'_> {
    #[inline(always)]
    fn all<V: Vector, const DIAGONALS: bool, const MASK: bool>(mut self, zero: V) -> Option<(usize, usize)> {
        let p = self.sheet.pointers()?;
        let s = &self.sheet;
        let along = s.reach.along(s.columns);
        let across = [s.reach.across(s.columns, false), s.reach.across(s.columns, true)];
        let (mut found, mut row) = (None, 0);
        while row < s.rows {
            let pair = if row + 2 == s.rows { &across[1] } else { &across[0] };
            // SAFETY: `pointers` has checked the lengths: whole vectors of a row, and one place more in it and in the next.
            let long = unsafe {
                let first = row.wrapping_mul(s.stride);
                if row + 1 < s.rows {
                    any_long::<V, true, DIAGONALS, MASK>(zero, &p, &along, pair, first, s.columns, s.stride)
                } else {
                    any_long::<V, false, DIAGONALS, MASK>(zero, &p, &along, pair, first, s.columns, s.stride)
                }
            };
            if long {
                found = Some((found.map_or(row, |(first, _)| first), row));
                if self.any {
                    break;
                }
            }
            row += 1;
        }
        found
    }
}

/// Whether a link of a row is too long or, where there is a next row (`PAIR`), one to that.
///
/// # Safety
/// The planes have the lanes of the row and of the next one, and one place more.
#[inline(always)]
unsafe fn any_long<V: Vector, const PAIR: bool, const DIAGONALS: bool, const MASK: bool>(
    zero: V,
    p: &Pointers,
    along: &Family,
    (along_v, diagonal): &(f32, Family),
    first: usize,
    columns: usize,
    stride: usize,
) -> bool {
    // lengths beyond the limits; where numbers are not finite none
    let mut excess = zero;
    let mut column = 0;
    while column < columns {
        let at = first.wrapping_add(column);
        let (right, below) = (at.wrapping_add(1), at.wrapping_add(stride));
        let below_right = below.wrapping_add(1);
        // SAFETY: the caller's promise.
        unsafe {
            let here = Three::load(zero, &p.x, at);
            let beside = Three::load(zero, &p.x, right);
            let (_, mut square) = along.at(zero, column);
            if MASK {
                square = uncut(zero, p, square, [at, right], None);
            }
            excess = (beside.minus(here).squared() - square).max(excess);
            if PAIR {
                let lower = Three::load(zero, &p.x, below);
                let mut square = zero.all(*along_v * *along_v);
                if MASK {
                    square = uncut(zero, p, square, [at, below], None);
                }
                excess = (lower.minus(here).squared() - square).max(excess);
                if DIAGONALS {
                    let (_, square) = diagonal.at(zero, column);
                    let (mut to_right, mut to_left) = (square, square);
                    if MASK {
                        to_right = uncut(zero, p, square, [at, below_right], Some([right, below]));
                        to_left = uncut(zero, p, square, [right, below], Some([at, below_right]));
                    }
                    let lower_right = Three::load(zero, &p.x, below_right);
                    excess = (lower_right.minus(here).squared() - to_right).max(excess);
                    excess = (lower.minus(beside).squared() - to_left).max(excess);
                }
            }
        }
        column = column.wrapping_add(V::LANES);
    }
    excess.any_above(zero)
}
