//! The operator applied: what the conjugate gradients spend their time in.
#![allow(unsafe_code)] // pointers into planes whose lengths are checked once a row: see `Row::new`

use super::operator::Linear;
use crate::force::{Carried, Planes, View};
use crate::layout::{CARRY_ROWS, Layout};
use crate::simd::{Three, Vector, load};

/// Where the numbers of a row lie: those of its first particle. With a check of every load a frame took 1.4 times as many
/// instructions in SSE2 (64 x 64).
struct Row {
    x: [*const f32; 3],
    search: [*const f32; 3],
    image: [*mut f32; 3],
    mass: *const f32,
    free: *const f32,
    /// Null where the family is off.
    alpha: [*const f32; 6],
    gamma: [*const f32; 6],
    carry: *mut f32,
}

impl Row {
    /// None where a plane is too short.
    #[inline(always)]
    fn new(
        l: &Layout,
        row: usize,
        x: View<'_>,
        linear: &Linear<'_>,
        search: View<'_>,
        image: &mut Planes<'_>,
        carry: &mut [f32],
    ) -> Option<Row> {
        let (first, end) = (l.row(row), l.row(row) + l.width);
        // springs reach two rows down or two places on
        let far = |plane: &[f32]| plane.get(first..end + 2 * l.stride + 2).map(|p| p.as_ptr());
        let here = |plane: &[f32]| plane.get(first..end).map(|p| p.as_ptr());
        let here_mut = |plane: &mut [f32]| plane.get_mut(first..end).map(|p| p.as_mut_ptr());
        let six = |planes: &[&mut [f32]; 6]| {
            let [u, v, right, left, bend_u, bend_v] = planes;
            let family = |on: bool, plane: &[f32]| if on { here(plane) } else { Some(core::ptr::null()) };
            Some([
                here(u)?,
                here(v)?,
                family(l.shear, right)?,
                family(l.shear, left)?,
                family(l.bend, bend_u)?,
                family(l.bend, bend_v)?,
            ])
        };
        if carry.len() < CARRY_ROWS * l.stride || l.width + 16 > l.stride {
            return None;
        }
        Some(Row {
            x: [far(x.x)?, far(x.y)?, far(x.z)?],
            search: [far(search.x)?, far(search.y)?, far(search.z)?],
            image: [here_mut(image.x)?, here_mut(image.y)?, here_mut(image.z)?],
            mass: here(linear.mass)?,
            free: here(linear.free)?,
            alpha: six(&linear.alpha)?,
            gamma: six(&linear.gamma)?,
            carry: carry.as_mut_ptr(),
        })
    }
}

/// One row of image = A search. Every spring is worked out once, where it starts: what its other end has of it is exactly
/// the opposite, and is taken off in the order in which a gather would add it (compare [`crate::force`]).
///
/// `carry` hands the springs to the rows below: [`crate::layout::CARRY_ROWS`] rows of zeros before the first row.
#[inline(always)]
#[allow(clippy::too_many_arguments)]
pub(super) fn apply_row<V: Vector>(
    zero: V,
    l: &Layout,
    row: usize,
    x: View<'_>,
    linear: &Linear<'_>,
    search: View<'_>,
    image: &mut Planes<'_>,
    carry: &mut [f32],
) {
    let Some(p) = Row::new(l, row, x, linear, search, image, carry) else {
        return;
    };
    let s = l.stride;
    let Carried { below, lower_left, lower_right, upper_left, two_below, .. } = Carried::new(p.carry, row, s);
    let none = Three([zero; 3]);
    let (mut before, mut bend_before, mut bend_before2) = (none, none, none);
    let mut at = 0;
    while at < l.width {
        // SAFETY: `Row::new` has checked the lengths: places are below the width, the other ends of springs at most two rows
        // and two places farther; the carry has 18 rows of which 17 + 1 are used, the first place of each being its 16th.
        unsafe {
            let (x0, p0) = (load3(zero, &p.x, at), load3(zero, &p.search, at));
            let mut sum = p0.times(load(zero, p.mass, at));
            // the part of the spring of a family that starts at each particle
            macro_rules! start {
                ($family:literal, $to:expr) => {{
                    let to = at.wrapping_add($to);
                    let (d, e) = (x0.minus(load3(zero, &p.x, to)), p0.minus(load3(zero, &p.search, to)));
                    let along = load(zero, p.gamma[$family], at) * d.dot(e);
                    e.times(load(zero, p.alpha[$family], at)).plus(d.times(along))
                }};
            }
            // and what ends there, handed on from rows above
            macro_rules! hand_on {
                ($e:expr, $from:expr, $shift:expr, $to:expr) => {{
                    let e = $e;
                    sum = sum.plus(e).minus(Three::load(zero, &$from, at.wrapping_add_signed($shift)));
                    e.store(&$to, at);
                }};
            }
            let e = start!(0, 1);
            sum = sum.plus(e).minus(e.next1(before));
            before = e;
            hand_on!(start!(1, s), below, 0, below);
            if l.shear {
                hand_on!(start!(2, s + 1), upper_left, -1, lower_right);
                hand_on!(start!(3, s - 1), lower_left, 1, lower_left);
            }
            if l.bend {
                let e = start!(4, 2);
                sum = sum.plus(e).minus(e.next2(bend_before, bend_before2));
                bend_before2 = bend_before;
                bend_before = e;
                hand_on!(start!(5, 2 * s), two_below, 0, two_below);
            }
            sum.times(load(zero, p.free, at)).store(&p.image, at);
        }
        at = at.wrapping_add(V::LANES);
    }
}

/// # Safety
/// Each plane has the lanes from `at` on.
#[inline(always)]
unsafe fn load3<V: Vector>(zero: V, planes: &[*const f32; 3], at: usize) -> Three<V> {
    let [x, y, z] = *planes;
    // SAFETY: the caller's promise.
    unsafe { Three([load(zero, x, at), load(zero, y, at), load(zero, z, at)]) }
}
