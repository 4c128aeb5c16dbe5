//! One number as a vector: the reference, and what targets without vectors run.

use core::ops::{Add, Div, Mul, Sub};

use super::{Pass, Vector};
use crate::math;

/// One number.
#[derive(Clone, Copy)]
pub(crate) struct Scalar(f32);

macro_rules! operator {
    ($name:ident, $call:ident, $sign:tt) => {
        impl $name for Scalar {
            type Output = Scalar;
            #[inline(always)]
            fn $call(self, other: Scalar) -> Scalar {
                Scalar(self.0 $sign other.0)
            }
        }
    };
}
operator!(Add, add, +);
operator!(Sub, sub, -);
operator!(Mul, mul, *);
operator!(Div, div, /);

#[allow(unsafe_code)] // pointers of the caller
impl Vector for Scalar {
    const LANES: usize = 1;

    #[inline(always)]
    unsafe fn zero() -> Scalar {
        Scalar(0.0)
    }

    #[inline(always)]
    fn all(self, x: f32) -> Scalar {
        Scalar(x)
    }

    #[inline(always)]
    unsafe fn load(self, from: *const f32) -> Scalar {
        // SAFETY: the caller's promise.
        Scalar(unsafe { *super::lanes(from) })
    }

    #[inline(always)]
    unsafe fn store(self, to: *mut f32) {
        // SAFETY: the caller's promise.
        unsafe { *super::lanes_mut(to) = self.0 }
    }

    #[inline(always)]
    fn sqrt(self) -> Scalar {
        Scalar(math::sqrt(self.0))
    }

    #[inline(always)]
    fn max(self, other: Scalar) -> Scalar {
        Scalar(math::max(self.0, other.0))
    }

    #[inline(always)]
    fn min(self, other: Scalar) -> Scalar {
        Scalar(math::min(self.0, other.0))
    }

    #[inline(always)]
    fn any_above(self, other: Scalar) -> bool {
        self.0 > other.0
    }

    #[inline(always)]
    fn above(self, other: Scalar, then: Scalar, otherwise: Scalar) -> Scalar {
        if self.0 > other.0 { then } else { otherwise }
    }

    #[inline(always)]
    fn next1(self, before: Scalar) -> Scalar {
        before
    }

    #[inline(always)]
    fn split(self, after: Scalar) -> [Scalar; 2] {
        [self, after]
    }

    #[inline(always)]
    fn weave(self, odd: Scalar) -> [Scalar; 2] {
        [self, odd]
    }

    #[inline(always)]
    fn next2(self, _: Scalar, before2: Scalar) -> Scalar {
        before2
    }
}

/// Runs a pass number by number.
#[allow(unsafe_code)]
pub(super) fn scalar<P: Pass>(pass: P) -> P::Output {
    // SAFETY: every processor has plain numbers.
    pass.run(unsafe { Scalar::zero() })
}
