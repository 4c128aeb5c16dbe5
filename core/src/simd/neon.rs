//! NEON of aarch64, which every processor of that kind has.
#![allow(unsafe_code, unused_unsafe)] // NEON is on for the whole crate, so its intrinsics are safe to call

use core::arch::aarch64::*;
use core::ops::{Add, Div, Mul, Sub};

use super::{Pass, Vector};

/// 4 numbers.
#[derive(Clone, Copy)]
pub(crate) struct F32x4(float32x4_t);

macro_rules! operator {
    ($name:ident, $call:ident, $intrinsic:ident) => {
        impl $name for F32x4 {
            type Output = F32x4;
            #[inline(always)]
            fn $call(self, other: F32x4) -> F32x4 {
                // SAFETY: part of aarch64.
                F32x4(unsafe { $intrinsic(self.0, other.0) })
            }
        }
    };
}
operator!(Add, add, vaddq_f32);
operator!(Sub, sub, vsubq_f32);
operator!(Mul, mul, vmulq_f32);
operator!(Div, div, vdivq_f32);

impl Vector for F32x4 {
    const LANES: usize = 4;

    #[inline(always)]
    unsafe fn zero() -> F32x4 {
        // SAFETY: part of aarch64.
        F32x4(unsafe { vdupq_n_f32(0.0) })
    }

    #[inline(always)]
    fn all(self, x: f32) -> F32x4 {
        // SAFETY: as above.
        F32x4(unsafe { vdupq_n_f32(x) })
    }

    #[inline(always)]
    unsafe fn load(self, from: *const f32) -> F32x4 {
        // SAFETY: the caller's promise; both types are 4 numbers, and all bits are valid.
        unsafe { F32x4(core::mem::transmute::<[f32; 4], float32x4_t>(*super::lanes(from))) }
    }

    #[inline(always)]
    unsafe fn store(self, to: *mut f32) {
        // SAFETY: as above.
        unsafe { *super::lanes_mut(to) = core::mem::transmute::<float32x4_t, [f32; 4]>(self.0) }
    }

    #[inline(always)]
    fn sqrt(self) -> F32x4 {
        // SAFETY: as above.
        F32x4(unsafe { vsqrtq_f32(self.0) })
    }

    /// Not `vmaxq_f32`, which answers with NaN where one is NaN.
    #[inline(always)]
    fn max(self, other: F32x4) -> F32x4 {
        // SAFETY: as above.
        F32x4(unsafe { vbslq_f32(vcgtq_f32(self.0, other.0), self.0, other.0) })
    }

    #[inline(always)]
    fn min(self, other: F32x4) -> F32x4 {
        // SAFETY: as above.
        F32x4(unsafe { vbslq_f32(vcltq_f32(self.0, other.0), self.0, other.0) })
    }

    #[inline(always)]
    fn any_above(self, other: F32x4) -> bool {
        // SAFETY: as above.
        unsafe { vmaxvq_u32(vcgtq_f32(self.0, other.0)) != 0 }
    }

    #[inline(always)]
    fn above(self, other: F32x4, then: F32x4, otherwise: F32x4) -> F32x4 {
        // SAFETY: as above.
        F32x4(unsafe { vbslq_f32(vcgtq_f32(self.0, other.0), then.0, otherwise.0) })
    }

    #[inline(always)]
    fn next1(self, before: F32x4) -> F32x4 {
        // SAFETY: as above.
        F32x4(unsafe { vextq_f32::<3>(before.0, self.0) })
    }

    #[inline(always)]
    fn split(self, after: F32x4) -> [F32x4; 2] {
        // SAFETY: as above.
        unsafe { [F32x4(vuzp1q_f32(self.0, after.0)), F32x4(vuzp2q_f32(self.0, after.0))] }
    }

    #[inline(always)]
    fn weave(self, odd: F32x4) -> [F32x4; 2] {
        // SAFETY: as above.
        unsafe { [F32x4(vzip1q_f32(self.0, odd.0)), F32x4(vzip2q_f32(self.0, odd.0))] }
    }

    #[inline(always)]
    fn next2(self, before: F32x4, _: F32x4) -> F32x4 {
        // SAFETY: as above.
        F32x4(unsafe { vextq_f32::<2>(before.0, self.0) })
    }
}

/// Runs a pass with NEON.
#[inline(never)]
pub(super) fn neon<P: Pass>(pass: P) -> P::Output {
    // SAFETY: part of aarch64.
    pass.run(unsafe { F32x4::zero() })
}
