//! One substep of the rows of a band, with the bits of the sweep over all rows ([`crate::force`]).
//!
//! The sweep hands the forces of the springs that cross from a row to the next ones on, and moves positions at once. So at a
//! border between two bands the forces of the springs that cross it (from the last row above to the first below, and the
//! bend springs from the last two above to the first two below) are worked out first, while no position moves, by the same
//! operations, and kept twice: in the carry of the band below, where its sweep finds them as if it had come from above, and
//! in the border, where the band above finds them instead of looking across. After that a band reads and writes positions
//! and velocities of its own rows alone.
#![allow(unsafe_code)] // pointers into planes that bands share: the caller's promises, see `crate::bands`

use crate::force::{Carried, Constants, Pointers, Springs6, Substep, begin, sweep_row, three_rows};
use crate::simd::{Pass, Three, Vector, load};

/// Rows of numbers of a border: springs along v, the two diagonals, the bend springs from the last row but one above and
/// from the last one, 3 each.
pub(crate) const BORDER_ROWS: usize = 15;

/// What a band works on.
#[derive(Clone, Copy)]
pub(crate) struct Rows {
    /// With the carry of the band.
    pub pointers: Pointers,
    pub constants: Substep,
    pub shear: bool,
    pub bend: bool,
    pub columns: usize,
    pub stride: usize,
    /// Its rows; the last is not among them.
    pub first: usize,
    pub end: usize,
    /// The border with the band above; null at the first band.
    pub above: *mut f32,
    /// The border with the band below; null at the last band.
    pub below: *mut f32,
}

/// Works out what crosses the border above.
///
/// Safety, as this is no unsafe function: only [`crate::bands`] makes one, where nobody writes the positions of the two rows
/// on either side meanwhile, nor uses this band's carry and the border.
pub(crate) struct Cross(pub Rows);

impl Pass for Cross {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self, zero: V) {
        let Rows { pointers: p, stride, first, above, .. } = self.0;
        if above.is_null() || first < 2 {
            return;
        }
        let k = Constants::new(zero, &self.0.constants);
        let n = self.0.columns.div_ceil(V::LANES) * V::LANES;
        let carried = Carried::new(p.carry, first, stride);
        let (last, last_but_one) = ((first - 1).wrapping_mul(stride), (first - 2).wrapping_mul(stride));
        let mut column = 0;
        while column < n {
            let at = last.wrapping_add(column);
            // SAFETY: rows first - 2 to first + 1 are in the planes, as are those of carry and border.
            unsafe {
                let here = Three::load(zero, &p.x, at);
                let down = at.wrapping_add(stride);
                let e = begin(&k, &p, here, down, k.rest_v).force(&k, load(zero, p.v_down, at));
                e.store(&carried.below, column);
                e.store(&three_rows(above, 0, stride), column);
                if self.0.shear {
                    let e =
                        begin(&k, &p, here, down.wrapping_sub(1), k.rest_diagonal).force(&k, load(zero, p.left, at));
                    e.store(&carried.lower_left, column);
                    e.store(&three_rows(above, 3, stride), column);
                    let e =
                        begin(&k, &p, here, down.wrapping_add(1), k.rest_diagonal).force(&k, load(zero, p.right, at));
                    e.store(&carried.upper_left, column);
                    e.store(&three_rows(above, 6, stride), column);
                }
                if self.0.bend {
                    let up = last_but_one.wrapping_add(column);
                    let from = Three::load(zero, &p.x, up);
                    let e = begin(&k, &p, from, down, k.bend_v).force(&k, load(zero, p.bend_v, up));
                    e.store(&carried.two_below, column);
                    e.store(&three_rows(above, 9, stride), column);
                    let e =
                        begin(&k, &p, here, down.wrapping_add(stride), k.bend_v).force(&k, load(zero, p.bend_v, at));
                    e.store(&carried.two_below_next, column);
                    e.store(&three_rows(above, 12, stride), column);
                }
            }
            column = column.wrapping_add(V::LANES);
        }
    }
}

/// Moves the particles of the band.
///
/// Safety: [`crate::bands`] makes one, where nobody else uses positions, velocities and carry of this band, and nobody
/// writes the borders; and [`crate::force::Sweep::run`], of all rows, which it has borrowed.
pub(crate) struct Move(pub Rows);

impl Pass for Move {
    type Output = ();
    const SINGLE: bool = true;

    #[inline(always)]
    fn run<V: Vector>(self, zero: V) {
        match (self.0.shear, self.0.bend) {
            (false, false) => self.families::<V, false, false>(zero),
            (false, true) => self.families::<V, false, true>(zero),
            (true, false) => self.families::<V, true, false>(zero),
            (true, true) => self.families::<V, true, true>(zero),
        }
    }
}

impl Move {
    #[inline(always)]
    fn families<V: Vector, const SHEAR: bool, const BEND: bool>(self, zero: V) {
        let Rows { pointers: p, stride, first, end, below, .. } = self.0;
        let k = Constants::new(zero, &self.0.constants);
        let n = self.0.columns.div_ceil(V::LANES) * V::LANES;
        // where there is a border below, its last two rows have springs that cross it
        let inner = if below.is_null() { end } else { end.saturating_sub(2) };
        // SAFETY: rows first to end - 1 are in the planes, and so are the two after them where there is no border: the spare
        // rows, as in the sweep over all rows. Elsewhere no row beyond end - 1 is read: the springs of the inner rows end
        // there at the latest, and after the last of them its first vector is begun once more, for nobody.
        unsafe {
            if first < inner {
                let mut s = Springs6::new::<SHEAR, BEND>(zero, &p, &k, first.wrapping_mul(stride), stride);
                let mut row = first;
                while row < inner {
                    let next = if row + 1 < inner { row + 1 } else { row };
                    sweep_row::<V, SHEAR, BEND>(zero, &p, &k, &mut s, row, next, stride, n);
                    row += 1;
                }
            }
            if !below.is_null() {
                edge_row::<V, SHEAR, BEND, false>(zero, &p, &k, below, inner, stride, n);
                edge_row::<V, SHEAR, BEND, true>(zero, &p, &k, below, inner + 1, stride, n);
            }
        }
    }
}

/// The last row of a band (`LAST`) or the one before it: as [`sweep_row`], but the forces across the border are read.
///
/// # Safety
/// Row, carry and border are as [`Move`] has them.
#[inline(always)]
unsafe fn edge_row<V: Vector, const SHEAR: bool, const BEND: bool, const LAST: bool>(
    zero: V,
    p: &Pointers,
    k: &Constants<V>,
    border: *mut f32,
    row: usize,
    stride: usize,
    n: usize,
) {
    let first = row.wrapping_mul(stride);
    let Carried { below, lower_left, lower_right, upper_left, two_below, .. } = Carried::new(p.carry, row, stride);
    let none = Three([zero; 3]);
    let (mut before, mut bend_before, mut bend_before2) = (none, none, none);
    let mut column = 0;
    while column < n {
        let at = first.wrapping_add(column);
        let down = at.wrapping_add(stride);
        // SAFETY: the caller's promise.
        unsafe {
            let here = Three::load(zero, &p.x, at);
            let mut f = none;

            let e = begin(k, p, here, at.wrapping_add(1), k.rest_u).force(k, load(zero, p.u, at));
            f = f.plus(e).minus(e.next1(before));
            before = e;

            let e = if LAST {
                Three::load(zero, &three_rows(border, 0, stride), column)
            } else {
                begin(k, p, here, down, k.rest_v).force(k, load(zero, p.v_down, at))
            };
            f = f.plus(e).minus(Three::load(zero, &below, column));
            e.store(&below, column);

            if SHEAR {
                let e = if LAST {
                    Three::load(zero, &three_rows(border, 6, stride), column)
                } else {
                    begin(k, p, here, down.wrapping_add(1), k.rest_diagonal).force(k, load(zero, p.right, at))
                };
                f = f.plus(e).minus(Three::load(zero, &upper_left, column.wrapping_sub(1)));
                e.store(&lower_right, column);

                let e = if LAST {
                    Three::load(zero, &three_rows(border, 3, stride), column)
                } else {
                    begin(k, p, here, down.wrapping_sub(1), k.rest_diagonal).force(k, load(zero, p.left, at))
                };
                f = f.plus(e).minus(Three::load(zero, &lower_left, column.wrapping_add(1)));
                e.store(&lower_left, column);
            }
            if BEND {
                let e = begin(k, p, here, at.wrapping_add(2), k.bend_u).force(k, load(zero, p.bend_u, at));
                f = f.plus(e).minus(e.next2(bend_before, bend_before2));
                bend_before2 = bend_before;
                bend_before = e;

                let e = Three::load(zero, &three_rows(border, if LAST { 12 } else { 9 }, stride), column);
                f = f.plus(e).minus(Three::load(zero, &two_below, column));
                e.store(&two_below, column);
            }
            k.advance(zero, p, at, f);
        }
        column = column.wrapping_add(V::LANES);
    }
}
