//! A vector of lanes in plain Rust, which the compiler turns into SIMD with the bits of the scalar operations.

use core::ops::{Add, Mul, Sub};

use crate::math;

/// Number of lanes: the vector of the x86_64 baseline.
pub(crate) const LANES: usize = 4;

/// Four numbers that are worked on at once; each operation is that of the single number in each lane.
#[derive(Clone, Copy)]
pub(crate) struct Lanes(pub [f32; LANES]);

impl Lanes {
    #[inline(always)]
    pub fn all(x: f32) -> Lanes {
        Lanes([x; LANES])
    }

    #[inline(always)]
    fn zip(self, other: Lanes, f: impl Fn(f32, f32) -> f32) -> Lanes {
        let (a, b) = (self.0, other.0);
        Lanes([f(a[0], b[0]), f(a[1], b[1]), f(a[2], b[2]), f(a[3], b[3])])
    }

    /// The larger, `other` where they do not compare.
    #[inline(always)]
    pub fn max(self, other: Lanes) -> Lanes {
        self.zip(other, math::max)
    }

    /// The smaller, `other` where they do not compare.
    #[inline(always)]
    pub fn min(self, other: Lanes) -> Lanes {
        self.zip(other, math::min)
    }

    /// Without the sign.
    #[inline(always)]
    pub fn abs(self) -> Lanes {
        self.zip(self, |a, _| a.abs())
    }
}

impl Add for Lanes {
    type Output = Lanes;
    #[inline(always)]
    fn add(self, other: Lanes) -> Lanes {
        self.zip(other, |a, b| a + b)
    }
}

impl Sub for Lanes {
    type Output = Lanes;
    #[inline(always)]
    fn sub(self, other: Lanes) -> Lanes {
        self.zip(other, |a, b| a - b)
    }
}

impl Mul for Lanes {
    type Output = Lanes;
    #[inline(always)]
    fn mul(self, other: Lanes) -> Lanes {
        self.zip(other, |a, b| a * b)
    }
}
