//! Correctly rounded operations: the same bits on every target.

/// Square root, correctly rounded.
///
/// On x86_64 this is the SSE2 instruction, written so that LLVM can vectorise it (a call into libm cannot be);
/// elsewhere libm, which is correctly rounded too.
#[inline(always)]
#[allow(unsafe_code)]
pub fn sqrt(x: f32) -> f32 {
    #[cfg(target_arch = "x86_64")]
    {
        use core::arch::x86_64::{_mm_cvtss_f32, _mm_set_ss, _mm_sqrt_ss};
        // SAFETY: the intrinsics need SSE, which every x86_64 processor has, and touch no memory.
        unsafe { _mm_cvtss_f32(_mm_sqrt_ss(_mm_set_ss(x))) }
    }
    #[cfg(not(target_arch = "x86_64"))]
    {
        libm::sqrtf(x)
    }
}

/// From `a` to `b` by a share: a constant stays that constant to the bit, and the largest f32 does not overflow.
#[inline(always)]
pub(crate) fn lerp(a: f32, b: f32, share: f32) -> f32 {
    a + (b - a) * share
}

/// The larger of two numbers, `b` where they do not compare: the rule of the SSE instruction, spelled out so that every
/// target follows it (`f32::max` leaves the sign of zero open).
#[inline(always)]
pub(crate) fn max(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// The smaller of two numbers, `b` where they do not compare.
#[inline(always)]
pub(crate) fn min(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// Round up to the next multiple of 16, the number of lanes of the widest vector.
pub(crate) const fn round16(n: usize) -> usize {
    n.div_ceil(16) * 16
}

#[cfg(test)]
mod tests {
    #[test]
    fn sqrt_agrees_with_libm_bit_for_bit() {
        for i in 0..200_000u32 {
            let x = f32::from_bits(i.wrapping_mul(21_347) & 0x7f7f_ffff);
            assert_eq!(super::sqrt(x).to_bits(), libm::sqrtf(x).to_bits(), "{x:e}");
        }
    }
}
