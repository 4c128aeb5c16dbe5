//! The substep (eq. 17): spring forces (eq. 1), velocities and positions in one pass over the rows, each spring once.
//!
//! The twelve springs of a particle are summed in one fixed order, so that no sum depends on how the work is split: right,
//! left, below, above, the diagonals (lower right, upper left, lower left, upper right), two to the right, left, below,
//! above, from +0 on. Six of them start at the particle. The forces of the others were computed at their other ends, and
//! are taken off instead of added, from the vector before or from the rows that the row above handed on (`carry`).
//!
//! Those are the bits of a gather that computes all twelve: x_a - x_b is exactly -(x_b - x_a) or both are +0, the squares
//! and so the factor are the same, and a - f is a + (-f). Where a force is a zero its sign may differ; but a sum that
//! starts at +0 is never -0 (only -0 + -0 is), so adding a zero of any sign changes nothing. Beyond the border no force
//! was computed and 0 is taken off, where the gather adds a spring of stiffness 0. That holds for finite numbers; others
//! stay what they are until the end of the frame, which is then taken back whole.
//!
//! A particle's position is moved at once: the springs that start later in the pass end at particles that come later.
#![allow(unsafe_code)] // pointers into planes whose lengths are checked once a sweep: see `Sweep::run`

use crate::bands::rows::{Move, Rows};
use crate::layout::{CARRY_ROWS, Layout, span};
use crate::simd::{self, Pass, Three, Vector, load};
use crate::width::Supported;

/// Below this squared length in m^2 a spring has no direction and gives no force.
pub(crate) const TINY: f32 = 1e-30;

/// The springs that start at each particle, in N/m, after the budget.
pub(crate) struct Springs<'a> {
    /// To the right neighbour (weft), and to the one below (warp).
    pub u: &'a mut [f32],
    pub v: &'a mut [f32],
    /// To the lower right, and to the lower left. Empty where shear is off.
    pub right: &'a mut [f32],
    pub left: &'a mut [f32],
    /// Two columns on, and two rows on. Empty where bend is off.
    pub bend_u: &'a mut [f32],
    pub bend_v: &'a mut [f32],
}

/// The constants of a substep.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Substep {
    pub dt: f32,
    pub damping: f32,
    /// Weight of a particle, m g.
    pub weight: [f32; 3],
    pub rest_u: f32,
    pub rest_v: f32,
    pub rest_diagonal: f32,
    /// Smallest value of 1 - L0/l: -1, or minus infinity without the limit.
    pub floor: f32,
    /// Speed limit in m/s, infinity without one.
    pub speed: f32,
}

/// Positions or velocities, as three planes.
pub(crate) struct Planes<'a> {
    pub x: &'a mut [f32],
    pub y: &'a mut [f32],
    pub z: &'a mut [f32],
}

/// The reading half of [`Planes`].
#[derive(Clone, Copy)]
pub(crate) struct View<'a> {
    pub x: &'a [f32],
    pub y: &'a [f32],
    pub z: &'a [f32],
}

impl Planes<'_> {
    pub fn view(&self) -> View<'_> {
        View { x: self.x, y: self.y, z: self.z }
    }
}

/// One substep over all particles.
pub(crate) struct Sweep<'a, 'b> {
    pub layout: Layout,
    pub constants: &'a Substep,
    pub x: &'a mut Planes<'b>,
    pub v: &'a mut Planes<'b>,
    pub springs: &'a Springs<'b>,
    /// 1/M, 0 for pinned particles and spare places.
    pub inverse: &'a [f32],
    /// Forces on the particles.
    pub pull: Option<[&'a [f32]; 3]>,
    /// Scratch, [`Layout::carry`].
    pub carry: &'a mut [f32],
}

/// Where the numbers of a sweep lie, column 0 of row 0 of each plane.
#[derive(Clone, Copy)]
pub(crate) struct Pointers {
    pub x: [*mut f32; 3],
    pub v: [*mut f32; 3],
    pub u: *const f32,
    pub v_down: *const f32,
    pub right: *const f32,
    pub left: *const f32,
    pub bend_u: *const f32,
    pub bend_v: *const f32,
    pub inverse: *const f32,
    pub pull: Option<[*const f32; 3]>,
    pub carry: *mut f32,
}

/// Column 0 of what rows hand on to those below them: forces of the springs along v, to the lower left, to the lower right, and
/// two rows on. What is handed on from a row and taken by the next one at another column, or by the row after the next,
/// stands twice, for even and odd rows.
pub(crate) struct Carried {
    pub below: [*mut f32; 3],
    pub lower_left: [*mut f32; 3],
    /// Of this row, for the next one.
    pub lower_right: [*mut f32; 3],
    /// Of the row above, for this one.
    pub upper_left: [*mut f32; 3],
    /// Of the row two above, for this one, which leaves its own there.
    pub two_below: [*mut f32; 3],
    /// Of the row above, for the next one.
    pub two_below_next: [*mut f32; 3],
}

/// Column 0 of three rows of carry, or of a border between bands, from one on.
#[inline(always)]
pub(crate) fn three_rows(from: *mut f32, row: usize, stride: usize) -> [*mut f32; 3] {
    let first = from.wrapping_add(row.wrapping_mul(stride).wrapping_add(16));
    [first, first.wrapping_add(stride), first.wrapping_add(stride.wrapping_mul(2))]
}

impl Carried {
    /// What a row takes and hands on: places in [`crate::layout::CARRY_ROWS`] rows of carry.
    #[inline(always)]
    pub fn new(carry: *mut f32, row: usize, stride: usize) -> Carried {
        let plane = |first: usize| three_rows(carry, first, stride);
        let (this, other) = (row % 2 * 3, 3 - row % 2 * 3);
        Carried {
            below: plane(0),
            lower_left: plane(3),
            lower_right: plane(6 + this),
            upper_left: plane(6 + other),
            two_below: plane(12 + this),
            two_below_next: plane(12 + other),
        }
    }
}

impl Sweep<'_, '_> {
    /// None where a plane is too short. A plane holds `row(rows + 2)` numbers and 16 more than a row: see [`Layout`].
    pub fn pointers(&mut self) -> Option<Pointers> {
        let l = &self.layout;
        let first = l.row(0);
        let read = |plane: &[f32], on: bool| match plane.get(first..l.plane) {
            Some(from) => Some(from.as_ptr()),
            None if on => None,
            None => Some(core::ptr::null()),
        };
        let write = |plane: &mut [f32]| plane.get_mut(first..l.plane).map(|from| from.as_mut_ptr());
        let k = self.springs;
        let fits = first.checked_add((l.rows + 2) * l.stride)? <= l.plane && l.width + 16 <= l.stride;
        if !fits || self.carry.len() < CARRY_ROWS * l.stride {
            return None;
        }
        Some(Pointers {
            x: [write(self.x.x)?, write(self.x.y)?, write(self.x.z)?],
            v: [write(self.v.x)?, write(self.v.y)?, write(self.v.z)?],
            u: read(k.u, true)?,
            v_down: read(k.v, true)?,
            right: read(k.right, l.shear)?,
            left: read(k.left, l.shear)?,
            bend_u: read(k.bend_u, l.bend)?,
            bend_v: read(k.bend_v, l.bend)?,
            inverse: read(self.inverse, true)?,
            pull: match self.pull {
                Some([x, y, z]) => Some([read(x, true)?, read(y, true)?, read(z, true)?]),
                None => None,
            },
            carry: self.carry.as_mut_ptr(),
        })
    }

    /// The substep: all rows as one band without borders, so that there is one copy of the code.
    ///
    /// What [`Move`] asks for: [`Sweep::pointers`] has checked the lengths, and the planes are borrowed. Rows 0 to rows - 1
    /// are begun and swept: the largest place that is read is that of the bend springs along v, as many numbers as whole
    /// vectors hold (at most the padded width) from row(row + 2) on, or two numbers beyond them in the rows row and row + 1; the
    /// least is row(1) - 1. The rows of carry are read one number before and beyond, which is in their spare 16.
    pub fn run(mut self, width: Supported) {
        self.carry.fill(0.0);
        let Some(pointers) = self.pointers() else {
            return;
        };
        let l = self.layout;
        simd::run(
            width,
            Move(Rows {
                pointers,
                constants: *self.constants,
                shear: l.shear,
                bend: l.bend,
                columns: l.columns,
                stride: l.stride,
                first: 0,
                end: l.rows,
                above: core::ptr::null_mut(),
                below: core::ptr::null_mut(),
            }),
        );
    }
}

/// [`Substep`] in every lane.
pub(crate) struct Constants<V> {
    pub rest_u: V,
    pub rest_v: V,
    pub rest_diagonal: V,
    pub bend_u: V,
    pub bend_v: V,
    floor: V,
    tiny: V,
    one: V,
    damping: V,
    dt: V,
    weight: Three<V>,
    limited: bool,
    speed: V,
    speed2: V,
}

impl<V: Vector> Constants<V> {
    #[inline(always)]
    pub fn new(zero: V, c: &Substep) -> Constants<V> {
        Constants {
            rest_u: zero.all(c.rest_u),
            rest_v: zero.all(c.rest_v),
            rest_diagonal: zero.all(c.rest_diagonal),
            bend_u: zero.all(2.0 * c.rest_u),
            bend_v: zero.all(2.0 * c.rest_v),
            floor: zero.all(c.floor),
            tiny: zero.all(TINY),
            one: zero.all(1.0),
            damping: zero.all(c.damping),
            dt: zero.all(c.dt),
            weight: Three([zero.all(c.weight[0]), zero.all(c.weight[1]), zero.all(c.weight[2])]),
            limited: c.speed < f32::INFINITY,
            speed: zero.all(c.speed),
            speed2: zero.all(c.speed * c.speed),
        }
    }

    /// The end of the substep of a vector of particles: v += a dt with a = f / M - c v, then the speed limit, then
    /// x += v dt. `f` are the forces of the springs.
    ///
    /// # Safety
    /// The planes have the lanes from the place on, and nobody else uses them.
    #[inline(always)]
    pub unsafe fn advance(&self, zero: V, p: &Pointers, at: usize, f: Three<V>) {
        // SAFETY: the caller's promise.
        unsafe {
            let mut f = f.plus(self.weight);
            if let Some([x, y, z]) = p.pull {
                f = f.plus(Three([load(zero, x, at), load(zero, y, at), load(zero, z, at)]));
            }
            let w = load(zero, p.inverse, at);
            let v = Three::load(zero, &p.v, at);
            let mut v = v.plus(f.times(w).minus(v.times(self.damping)).times(self.dt));
            if self.limited {
                let squared = v.squared();
                // Below the limit the factor is 1: sqrt(a^2) is a where a^2 is a normal number, as a limit's always is.
                if squared.any_above(self.speed2) {
                    v = v.times(self.speed / squared.max(self.speed2).sqrt());
                }
            }
            v.store(&p.v, at);
            Three::load(zero, &p.x, at).plus(v.times(self.dt)).store(&p.x, at);
        }
    }
}

/// A spring of each lane on its way: the difference of its ends and L0/l.
///
/// Square root and division take tens of cycles, in which a processor can work on others only if few instructions wait for
/// them. So these two are begun a vector of particles ahead, and nothing after them waits in the processor's queues.
#[derive(Clone, Copy)]
pub(crate) struct Begun<V> {
    d: Three<V>,
    ratio: V,
}

impl<V: Vector> Begun<V> {
    #[inline(always)]
    fn new(c: &Constants<V>, here: Three<V>, there: Three<V>, rest: V) -> Begun<V> {
        let d = there.minus(here);
        Begun { d, ratio: rest / d.squared().max(c.tiny).sqrt() }
    }

    /// The force on the end that the spring starts at (eq. 1): k (1 - L0/l) d.
    #[inline(always)]
    pub fn force(self, c: &Constants<V>, k: V) -> Three<V> {
        self.d.times(k * (c.one - self.ratio).max(c.floor))
    }
}

/// The springs that start at each particle of a vector. Those of a family that is off hold nothing of use.
#[derive(Clone, Copy)]
pub(crate) struct Springs6<V> {
    right: Begun<V>,
    below: Begun<V>,
    lower_right: Begun<V>,
    lower_left: Begun<V>,
    two_right: Begun<V>,
    two_below: Begun<V>,
}

impl<V: Vector> Springs6<V> {
    /// The springs of the first vector of a row, begun; `first` is the place of its column 0.
    ///
    /// # Safety
    /// As [`sweep_row`].
    #[inline(always)]
    pub unsafe fn new<const SHEAR: bool, const BEND: bool>(
        zero: V,
        p: &Pointers,
        k: &Constants<V>,
        first: usize,
        stride: usize,
    ) -> Springs6<V> {
        let nothing = Begun { d: Three([zero; 3]), ratio: zero };
        let [down, two_down] = [first.wrapping_add(stride), first.wrapping_add(stride.wrapping_mul(2))];
        // SAFETY: the caller's promise.
        unsafe {
            let here = Three::load(zero, &p.x, first);
            Springs6 {
                right: begin(k, p, here, first.wrapping_add(1), k.rest_u),
                below: begin(k, p, here, down, k.rest_v),
                lower_right: if SHEAR { begin(k, p, here, down.wrapping_add(1), k.rest_diagonal) } else { nothing },
                lower_left: if SHEAR { begin(k, p, here, down.wrapping_sub(1), k.rest_diagonal) } else { nothing },
                two_right: if BEND { begin(k, p, here, first.wrapping_add(2), k.bend_u) } else { nothing },
                two_below: if BEND { begin(k, p, here, two_down, k.bend_v) } else { nothing },
            }
        }
    }
}

/// Begins the springs of one direction, from particles `here` to those from the place `there` on.
///
/// # Safety
/// The places that [`Sweep::run`] names are inside the planes.
#[inline(always)]
pub(crate) unsafe fn begin<V: Vector>(
    c: &Constants<V>,
    p: &Pointers,
    here: Three<V>,
    there: usize,
    rest: V,
) -> Begun<V> {
    // SAFETY: the caller's promise.
    Begun::new(c, here, unsafe { Three::load(c.one, &p.x, there) }, rest)
}

/// One row of a substep: `n` places, a multiple of the lanes. `s` holds the springs of the row's first vector, begun, and
/// then those of the row's at `next`.
///
/// # Safety
/// The places that [`Sweep::run`] names are inside the planes.
#[inline(always)]
#[allow(clippy::too_many_arguments)]
pub(crate) unsafe fn sweep_row<V: Vector, const SHEAR: bool, const BEND: bool>(
    zero: V,
    p: &Pointers,
    c: &Constants<V>,
    s: &mut Springs6<V>,
    row: usize,
    next_row: usize,
    stride: usize,
    n: usize,
) {
    let first = row.wrapping_mul(stride);
    let next_first = next_row.wrapping_mul(stride);
    let Carried { below, lower_left, lower_right, upper_left, two_below, .. } = Carried::new(p.carry, row, stride);
    let none = Three([zero; 3]);
    let (mut before, mut bend_before, mut bend_before2) = (none, none, none);
    let mut column = 0;
    while column < n {
        let at = first.wrapping_add(column);
        let ahead = column.wrapping_add(V::LANES);
        let next = if ahead < n { first.wrapping_add(ahead) } else { next_first };
        // SAFETY: the caller's promise; what is stored is inside the row or in carry's row.
        unsafe {
            let here = Three::load(zero, &p.x, next);
            let mut f = none;

            let e = s.right.force(c, load(zero, p.u, at));
            s.right = begin(c, p, here, next.wrapping_add(1), c.rest_u);
            f = f.plus(e).minus(e.next1(before));
            before = e;

            let e = s.below.force(c, load(zero, p.v_down, at));
            s.below = begin(c, p, here, next.wrapping_add(stride), c.rest_v);
            f = f.plus(e).minus(Three::load(zero, &below, column));
            e.store(&below, column);

            if SHEAR {
                let e = s.lower_right.force(c, load(zero, p.right, at));
                s.lower_right = begin(c, p, here, next.wrapping_add(stride.wrapping_add(1)), c.rest_diagonal);
                f = f.plus(e).minus(Three::load(zero, &upper_left, column.wrapping_sub(1)));
                e.store(&lower_right, column);

                let e = s.lower_left.force(c, load(zero, p.left, at));
                s.lower_left = begin(c, p, here, next.wrapping_add(stride.wrapping_sub(1)), c.rest_diagonal);
                f = f.plus(e).minus(Three::load(zero, &lower_left, column.wrapping_add(1)));
                e.store(&lower_left, column);
            }
            if BEND {
                let e = s.two_right.force(c, load(zero, p.bend_u, at));
                s.two_right = begin(c, p, here, next.wrapping_add(2), c.bend_u);
                f = f.plus(e).minus(e.next2(bend_before, bend_before2));
                bend_before2 = bend_before;
                bend_before = e;

                let e = s.two_below.force(c, load(zero, p.bend_v, at));
                s.two_below = begin(c, p, here, next.wrapping_add(stride.wrapping_mul(2)), c.bend_v);
                f = f.plus(e).minus(Three::load(zero, &two_below, column));
                e.store(&two_below, column);
            }
            c.advance(zero, p, at, f);
        }
        column = ahead;
    }
}

/// Whether every number of the rows of some planes is finite: x * 0 is 0 for finite x and NaN otherwise.
pub(crate) struct Finite<'a> {
    pub layout: Layout,
    pub planes: [&'a [f32]; 6],
}

impl Pass for Finite<'_> {
    type Output = bool;

    #[inline(always)]
    fn run<V: Vector>(self, zero: V) -> bool {
        let l = self.layout;
        let mut sum = zero;
        for row in 0..l.rows {
            for plane in self.planes {
                // the spare places are zeros
                for block in span(plane, l.row(row), l.width).as_chunks::<16>().0 {
                    for at in (0..16).step_by(V::LANES) {
                        sum = sum + zero.read(block, at) * zero;
                    }
                }
            }
        }
        let mut lanes = [0.0f32; 16];
        sum.write(&mut lanes, 0);
        lanes.iter().all(|x| *x == 0.0)
    }
}
