//! Vectors of points: three coordinates in each lane, in three planes.
#![allow(unsafe_code)] // pointers of the caller

use super::Vector;
use crate::Vector3;

/// Three coordinates. Plain functions instead of closures and `map`: only what is always inlined is compiled with the
/// instructions of the width.
#[derive(Clone, Copy)]
pub(crate) struct Three<V>(pub [V; 3]);

impl<V: Vector> Three<V> {
    /// # Safety
    /// Each plane has the lanes from `at` on.
    #[inline(always)]
    pub unsafe fn load(zero: V, from: &[*mut f32; 3], at: usize) -> Three<V> {
        let [x, y, z] = *from;
        // SAFETY: the caller's promise.
        unsafe { Three([load(zero, x, at), load(zero, y, at), load(zero, z, at)]) }
    }

    /// # Safety
    /// Each plane has the lanes from `at` on.
    #[inline(always)]
    pub unsafe fn store(self, to: &[*mut f32; 3], at: usize) {
        let (Three([x, y, z]), to) = (self, *to);
        // SAFETY: the caller's promise.
        unsafe {
            x.store(to[0].wrapping_add(at));
            y.store(to[1].wrapping_add(at));
            z.store(to[2].wrapping_add(at));
        }
    }

    /// The same point in each lane; of `zero` only the existence is used.
    #[inline(always)]
    pub fn all(zero: V, a: Vector3<f32>) -> Three<V> {
        Three([zero.all(a.x), zero.all(a.y), zero.all(a.z)])
    }

    /// [`Vector::read`] of each.
    #[inline(always)]
    pub fn read(zero: V, from: [&[f32]; 3], at: usize) -> Three<V> {
        let [x, y, z] = from;
        Three([zero.read(x, at), zero.read(y, at), zero.read(z, at)])
    }

    /// [`Vector::write`] of each.
    #[inline(always)]
    pub fn write(self, to: [&mut [f32]; 3], at: usize) {
        let (Three([x, y, z]), [to_x, to_y, to_z]) = (self, to);
        x.write(to_x, at);
        y.write(to_y, at);
        z.write(to_z, at);
    }

    #[inline(always)]
    pub fn plus(self, other: Three<V>) -> Three<V> {
        let (a, b) = (self.0, other.0);
        Three([a[0] + b[0], a[1] + b[1], a[2] + b[2]])
    }

    #[inline(always)]
    pub fn minus(self, other: Three<V>) -> Three<V> {
        let (a, b) = (self.0, other.0);
        Three([a[0] - b[0], a[1] - b[1], a[2] - b[2]])
    }

    #[inline(always)]
    pub fn times(self, factor: V) -> Three<V> {
        let a = self.0;
        Three([a[0] * factor, a[1] * factor, a[2] * factor])
    }

    #[inline(always)]
    pub fn squared(self) -> V {
        let [x, y, z] = self.0;
        x * x + y * y + z * z
    }

    #[inline(always)]
    pub fn over(self, divisor: V) -> Three<V> {
        let a = self.0;
        Three([a[0] / divisor, a[1] / divisor, a[2] / divisor])
    }

    #[inline(always)]
    pub fn dot(self, other: Three<V>) -> V {
        let (a, b) = (self.0, other.0);
        a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
    }

    #[inline(always)]
    pub fn cross(self, other: Three<V>) -> Three<V> {
        let (a, b) = (self.0, other.0);
        Three([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])
    }

    #[inline(always)]
    pub fn length(self) -> V {
        self.squared().sqrt()
    }

    /// [`Vector::abs`] of each.
    #[inline(always)]
    pub fn abs(self) -> Three<V> {
        let [x, y, z] = self.0;
        Three([x.abs(), y.abs(), z.abs()])
    }

    /// [`Vector::min`] of each.
    #[inline(always)]
    pub fn min(self, other: Three<V>) -> Three<V> {
        let (a, b) = (self.0, other.0);
        Three([a[0].min(b[0]), a[1].min(b[1]), a[2].min(b[2])])
    }

    /// [`Vector::max`] of each.
    #[inline(always)]
    pub fn max(self, other: Three<V>) -> Three<V> {
        let (a, b) = (self.0, other.0);
        Three([a[0].max(b[0]), a[1].max(b[1]), a[2].max(b[2])])
    }

    /// [`Vector::pick`] of each.
    #[inline(always)]
    pub fn pick(mask: V, then: Three<V>, otherwise: Three<V>) -> Three<V> {
        Three::choose(mask, mask.all(0.5), then, otherwise)
    }

    /// [`Vector::next1`] of each.
    #[inline(always)]
    pub fn next1(self, before: Three<V>) -> Three<V> {
        let (a, b) = (self.0, before.0);
        Three([a[0].next1(b[0]), a[1].next1(b[1]), a[2].next1(b[2])])
    }

    /// [`Vector::split`] of each.
    #[inline(always)]
    pub fn split(self, after: Three<V>) -> (Three<V>, Three<V>) {
        let (a, b) = (self.0, after.0);
        let ([x, next_x], [y, next_y], [z, next_z]) = (a[0].split(b[0]), a[1].split(b[1]), a[2].split(b[2]));
        (Three([x, y, z]), Three([next_x, next_y, next_z]))
    }

    /// [`Vector::weave`] of each.
    #[inline(always)]
    pub fn weave(self, odd: Three<V>) -> (Three<V>, Three<V>) {
        let (a, b) = (self.0, odd.0);
        let ([x, next_x], [y, next_y], [z, next_z]) = (a[0].weave(b[0]), a[1].weave(b[1]), a[2].weave(b[2]));
        (Three([x, y, z]), Three([next_x, next_y, next_z]))
    }

    /// [`Vector::next2`] of each.
    #[inline(always)]
    pub fn next2(self, before: Three<V>, before2: Three<V>) -> Three<V> {
        let (a, b, c) = (self.0, before.0, before2.0);
        Three([a[0].next2(b[0], c[0]), a[1].next2(b[1], c[1]), a[2].next2(b[2], c[2])])
    }

    /// [`Vector::above`] of each.
    #[inline(always)]
    pub fn choose(test: V, than: V, then: Three<V>, otherwise: Three<V>) -> Three<V> {
        let (a, b) = (then.0, otherwise.0);
        Three([test.above(than, a[0], b[0]), test.above(than, a[1], b[1]), test.above(than, a[2], b[2])])
    }
}

/// # Safety
/// There are the lanes from `at` on.
#[inline(always)]
pub(crate) unsafe fn load<V: Vector>(zero: V, from: *const f32, at: usize) -> V {
    // SAFETY: the caller's promise.
    unsafe { zero.load(from.wrapping_add(at)) }
}
