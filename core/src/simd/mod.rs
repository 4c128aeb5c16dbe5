//! Vectors of f32 in every width that a processor has, with the bits of the scalar operations.
//!
//! A pass over the particles is written once, over any [`Vector`], and [`run`] compiles it once per [`Width`] and calls
//! the one that was asked for:
//!
//! ```ignore
//! struct Damp<'a> { v: &'a mut [f32], factor: f32 }
//!
//! impl Pass for Damp<'_> {
//!     type Output = ();
//!     #[inline(always)] // or the pass is compiled without the instructions of the width
//!     fn run<V: Vector>(self, zero: V) {
//!         let factor = zero.all(self.factor);
//!         for at in (0..self.v.len()).step_by(V::LANES) {
//!             (zero.read(self.v, at) * factor).write(self.v, at);
//!         }
//!     }
//! }
//! simd::run(cloth.width, Damp { v, factor });
//! ```
//!
//! Rules that keep the bits: only these operations, each of which IEEE 754 rounds in one way; no fused multiply-add; the
//! sums of a particle in one order at every width. `max` and `min` answer with the second operand where two numbers do not
//! compare or are equal (zeros of both signs), as the SSE instructions do. Rows are padded to 16 lanes and the places
//! beyond the last column have no mass, so a pass may run over them.
//!
//! Why this is sound: an instruction that the processor lacks must never run. A value of a vector type exists only where
//! the processor has its instructions: its field is private, [`Vector::zero`], from which all others come, is unsafe, and
//! only [`run`] calls it, with a [`Supported`], which exists only where [`Width::is_supported`] held.
#![allow(unsafe_code)] // see the last paragraph

mod scalar;
#[cfg(test)]
mod tests;
mod three;

#[cfg(target_arch = "aarch64")]
mod neon;
#[cfg(target_arch = "x86_64")]
mod x86;

use core::ops::{Add, Div, Mul, Sub};

use crate::width::{Supported, Width};

pub(crate) use three::{Three, load};

/// The numbers of the lanes of the widest vector.
pub(crate) const NUMBERS: [f32; 16] =
    [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0, 11.0, 12.0, 13.0, 14.0, 15.0];

/// Some f32 that are worked on at once; each operation is that of the single number in each lane.
pub(crate) trait Vector:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    /// Numbers of a vector: 1, 4, 8 or 16.
    const LANES: usize;

    /// Zeros.
    ///
    /// # Safety
    /// The processor has the instructions of this width.
    unsafe fn zero() -> Self;

    /// The same number in each lane; of the value only the existence is used.
    fn all(self, x: f32) -> Self;

    /// Numbers that need no alignment; of the value only the existence is used.
    ///
    /// # Safety
    /// `LANES` numbers may be read at `from`.
    unsafe fn load(self, from: *const f32) -> Self;

    /// # Safety
    /// `LANES` numbers may be written at `to`.
    unsafe fn store(self, to: *mut f32);

    /// Correctly rounded.
    fn sqrt(self) -> Self;

    /// The larger, `other` where they do not compare or are equal: [`crate::math::max`].
    fn max(self, other: Self) -> Self;

    /// The smaller, `other` where they do not compare or are equal: [`crate::math::min`].
    fn min(self, other: Self) -> Self;

    /// Whether in any lane the number is above that of `other`.
    fn any_above(self, other: Self) -> bool;

    /// In each lane `then` where the number is above that of `other`, else `otherwise`, also where they do not compare.
    fn above(self, other: Self, then: Self, otherwise: Self) -> Self;

    /// 1 in each lane where the number is above that of `other`, else 0.
    #[inline(always)]
    fn one_above(self, other: Self) -> Self {
        self.above(other, self.all(1.0), self.all(0.0))
    }

    /// 0 in each lane where the number is above that of `other`, else 1.
    #[inline(always)]
    fn one_unless_above(self, other: Self) -> Self {
        self.above(other, self.all(0.0), self.all(1.0))
    }

    /// Where this one is 1 `then`, where it is 0 `otherwise`.
    #[inline(always)]
    fn pick(self, then: Self, otherwise: Self) -> Self {
        self.above(self.all(0.5), then, otherwise)
    }

    /// Whether any lane is 1, of lanes that are 1 or 0.
    #[inline(always)]
    fn any(self) -> bool {
        self.any_above(self.all(0.5))
    }

    /// Without the sign.
    #[inline(always)]
    fn abs(self) -> Self {
        self.max(self.all(0.0) - self)
    }

    /// The lanes one place on in a row of vectors: the last of `before`, then all but the last of this one.
    fn next1(self, before: Self) -> Self;

    /// The lanes two places on. `before2` is the vector before `before`; only a single lane needs it.
    fn next2(self, before: Self, before2: Self) -> Self;

    /// The even lanes of this one and of the vector after it, in whatever order suits the processor, then the odd lanes of
    /// both in the same order. Not for a single lane.
    fn split(self, after: Self) -> [Self; 2];

    /// The two vectors that were [`Vector::split`].
    fn weave(self, odd: Self) -> [Self; 2];

    /// The numbers of a plane from a place on, zeros where they are not all inside.
    #[inline(always)]
    fn read(self, plane: &[f32], at: usize) -> Self {
        match plane.get(at..at.wrapping_add(Self::LANES)) {
            // SAFETY: the slice has LANES numbers.
            Some(numbers) => unsafe { self.load(numbers.as_ptr()) },
            None => self.all(0.0),
        }
    }

    /// Writes to a plane from a place on; nothing where they would not all be inside.
    #[inline(always)]
    fn write(self, plane: &mut [f32], at: usize) {
        if let Some(numbers) = plane.get_mut(at..at.wrapping_add(Self::LANES)) {
            // SAFETY: the slice has LANES numbers.
            unsafe { self.store(numbers.as_mut_ptr()) }
        }
    }
}

/// Work that is compiled once for each width.
pub(crate) trait Pass {
    type Output;

    /// Whether it is compiled for single numbers too where a processor always has vectors. The sweep is, as the reference
    /// that a caller can choose; for all else that would be a quarter of the library's code for nothing, since the bits are
    /// the same. Builds with debug assertions, and so the tests, have all of them.
    const SINGLE: bool = cfg!(any(debug_assertions, not(any(target_arch = "x86_64", target_arch = "aarch64"))));

    /// Must be `#[inline(always)]`, and so must be what it calls with vectors.
    fn run<V: Vector>(self, zero: V) -> Self::Output;
}

/// Runs a pass in vectors of a width.
#[inline]
pub(crate) fn run<P: Pass>(width: Supported, pass: P) -> P::Output {
    match width.get() {
        #[cfg(target_arch = "x86_64")]
        Width::Sse2 => x86::sse2(pass),
        // SAFETY: a Supported is made only where the processor has the width.
        #[cfg(all(target_arch = "x86_64", feature = "avx2"))]
        Width::Avx2 => unsafe { x86::avx2(pass) },
        // SAFETY: as above.
        #[cfg(all(target_arch = "x86_64", feature = "avx512"))]
        Width::Avx512 => unsafe { x86::avx512(pass) },
        #[cfg(target_arch = "aarch64")]
        Width::Neon => neon::neon(pass),
        _ if P::SINGLE => scalar::scalar(pass),
        #[cfg(target_arch = "x86_64")]
        _ => x86::sse2(pass),
        #[cfg(target_arch = "aarch64")]
        _ => neon::neon(pass),
        #[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
        _ => scalar::scalar(pass),
    }
}

/// Whether this processor, under this operating system, has a width, and the library its code.
pub(crate) fn has(width: Width) -> bool {
    match width {
        Width::Scalar => true,
        #[cfg(target_arch = "x86_64")]
        Width::Sse2 => true,
        #[cfg(all(target_arch = "x86_64", feature = "avx2"))]
        Width::Avx2 => x86::has_avx2(),
        #[cfg(all(target_arch = "x86_64", feature = "avx512"))]
        Width::Avx512 => x86::has_avx512(),
        #[cfg(target_arch = "aarch64")]
        Width::Neon => true,
        #[allow(unreachable_patterns)] // where every width has its own arm
        _ => false,
    }
}

/// A pointer as a reference to its lanes. Unlike `&*from` it is not checked for null and alignment in builds with debug
/// assertions, where that would cost more than the arithmetic.
///
/// # Safety
/// `from` points to a T that lives long enough, and nobody writes it meanwhile.
#[inline(always)]
#[allow(clippy::transmute_ptr_to_ref)]
unsafe fn lanes<'a, T>(from: *const f32) -> &'a T {
    // SAFETY: the caller's promise.
    unsafe { core::mem::transmute::<*const f32, &'a T>(from) }
}

/// The same for writing.
///
/// # Safety
/// `to` points to a T that lives long enough, and nobody else uses it meanwhile.
#[inline(always)]
#[allow(clippy::transmute_ptr_to_ref)]
unsafe fn lanes_mut<'a, T>(to: *mut f32) -> &'a mut T {
    // SAFETY: the caller's promise.
    unsafe { core::mem::transmute::<*mut f32, &'a mut T>(to) }
}
