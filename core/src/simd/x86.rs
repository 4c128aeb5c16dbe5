//! SSE2, AVX2 and AVX-512F.
//!
//! The intrinsics want their instructions to be there: they are wherever a value exists (see the module above). They are
//! compiled in line into [`sse2`], [`avx2`] or [`avx512`], which switch the instructions on for the compiler.
#![allow(unsafe_code, unused_unsafe)] // SSE2 is on for the whole crate, so its intrinsics are safe to call
#![cfg_attr(not(all(feature = "avx2", feature = "avx512")), allow(dead_code))] // what is left out is not used

use core::arch::x86_64::*;
use core::ops::{Add, Div, Mul, Sub};

use super::{Pass, Vector};

macro_rules! vector {
    ($(#[$about:meta])* $name:ident, $lanes:literal, $type:ty, $zero:ident, $all:ident, $add:ident, $sub:ident, $mul:ident,
        $div:ident, $sqrt:ident, $max:ident, $min:ident, $shuffle:ident, $low:ident, $high:ident) => {
        $(#[$about])*
        #[derive(Clone, Copy)]
        pub(crate) struct $name($type);

        vector!(operator $name, Add, add, $add);
        vector!(operator $name, Sub, sub, $sub);
        vector!(operator $name, Mul, mul, $mul);
        vector!(operator $name, Div, div, $div);

        impl Vector for $name {
            const LANES: usize = $lanes;

            #[inline(always)]
            unsafe fn zero() -> $name {
                // SAFETY: the caller's promise.
                $name(unsafe { $zero() })
            }

            #[inline(always)]
            fn all(self, x: f32) -> $name {
                // SAFETY: a value exists, so the instructions do.
                $name(unsafe { $all(x) })
            }

            #[inline(always)]
            unsafe fn load(self, from: *const f32) -> $name {
                // SAFETY: the caller's promise; both types are $lanes numbers, and all bits are valid.
                unsafe { $name(core::mem::transmute::<[f32; $lanes], $type>(*super::lanes(from))) }
            }

            #[inline(always)]
            unsafe fn store(self, to: *mut f32) {
                // SAFETY: as above.
                unsafe { *super::lanes_mut(to) = core::mem::transmute::<$type, [f32; $lanes]>(self.0) }
            }

            #[inline(always)]
            fn sqrt(self) -> $name {
                // SAFETY: as above.
                $name(unsafe { $sqrt(self.0) })
            }

            #[inline(always)]
            fn max(self, other: $name) -> $name {
                // SAFETY: as above.
                $name(unsafe { $max(self.0, other.0) })
            }

            #[inline(always)]
            fn min(self, other: $name) -> $name {
                // SAFETY: as above.
                $name(unsafe { $min(self.0, other.0) })
            }

            #[inline(always)]
            fn any_above(self, other: $name) -> bool {
                self.is_above(other)
            }

            #[inline(always)]
            fn above(self, other: $name, then: $name, otherwise: $name) -> $name {
                self.choose(other, then, otherwise)
            }

            #[inline(always)]
            fn next1(self, before: $name) -> $name {
                self.after1(before)
            }

            /// Within each 128 bits: in F32x8 0 2 8 10 4 6 12 14.
            #[inline(always)]
            fn split(self, after: $name) -> [$name; 2] {
                // SAFETY: as above.
                unsafe {
                    [
                        $name($shuffle::<0b10_00_10_00>(self.0, after.0)),
                        $name($shuffle::<0b11_01_11_01>(self.0, after.0)),
                    ]
                }
            }

            #[inline(always)]
            fn weave(self, odd: $name) -> [$name; 2] {
                // SAFETY: as above.
                unsafe { [$name($low(self.0, odd.0)), $name($high(self.0, odd.0))] }
            }

            #[inline(always)]
            fn next2(self, before: $name, _: $name) -> $name {
                self.after2(before)
            }
        }
    };
    (operator $name:ident, $trait:ident, $call:ident, $intrinsic:ident) => {
        impl $trait for $name {
            type Output = $name;
            #[inline(always)]
            fn $call(self, other: $name) -> $name {
                // SAFETY: a value exists, so the instructions do.
                $name(unsafe { $intrinsic(self.0, other.0) })
            }
        }
    };
}

vector! {
    /// 4 numbers, SSE2.
    F32x4, 4, __m128, _mm_setzero_ps, _mm_set1_ps, _mm_add_ps, _mm_sub_ps, _mm_mul_ps, _mm_div_ps, _mm_sqrt_ps, _mm_max_ps,
    _mm_min_ps, _mm_shuffle_ps, _mm_unpacklo_ps, _mm_unpackhi_ps
}

vector! {
    /// 8 numbers, AVX2.
    F32x8, 8, __m256, _mm256_setzero_ps, _mm256_set1_ps, _mm256_add_ps, _mm256_sub_ps, _mm256_mul_ps, _mm256_div_ps,
    _mm256_sqrt_ps, _mm256_max_ps, _mm256_min_ps, _mm256_shuffle_ps, _mm256_unpacklo_ps, _mm256_unpackhi_ps
}

vector! {
    /// 16 numbers, AVX-512F.
    F32x16, 16, __m512, _mm512_setzero_ps, _mm512_set1_ps, _mm512_add_ps, _mm512_sub_ps, _mm512_mul_ps, _mm512_div_ps,
    _mm512_sqrt_ps, _mm512_max_ps, _mm512_min_ps, _mm512_shuffle_ps, _mm512_unpacklo_ps, _mm512_unpackhi_ps
}

impl F32x4 {
    #[inline(always)]
    fn is_above(self, other: F32x4) -> bool {
        // SAFETY: a value exists, so the instructions do.
        unsafe { _mm_movemask_ps(_mm_cmpgt_ps(self.0, other.0)) != 0 }
    }

    #[inline(always)]
    fn choose(self, other: F32x4, then: F32x4, otherwise: F32x4) -> F32x4 {
        // SAFETY: as above.
        unsafe {
            let above = _mm_cmpgt_ps(self.0, other.0);
            F32x4(_mm_or_ps(_mm_and_ps(above, then.0), _mm_andnot_ps(above, otherwise.0)))
        }
    }

    #[inline(always)]
    fn after1(self, before: F32x4) -> F32x4 {
        // SAFETY: as above.
        unsafe {
            // b3 b3 s0 s0, of which b3 s0 and then s1 s2
            let middle = _mm_shuffle_ps::<0b00_00_11_11>(before.0, self.0);
            F32x4(_mm_shuffle_ps::<0b10_01_10_00>(middle, self.0))
        }
    }

    #[inline(always)]
    fn after2(self, before: F32x4) -> F32x4 {
        // SAFETY: as above.
        unsafe { F32x4(_mm_shuffle_ps::<0b01_00_11_10>(before.0, self.0)) }
    }
}

impl F32x8 {
    #[inline(always)]
    fn is_above(self, other: F32x8) -> bool {
        // SAFETY: a value exists, so the instructions do.
        unsafe { _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_GT_OQ>(self.0, other.0)) != 0 }
    }

    /// The upper half of `before`, then the lower half of this one.
    #[inline(always)]
    fn choose(self, other: F32x8, then: F32x8, otherwise: F32x8) -> F32x8 {
        // SAFETY: as above.
        unsafe {
            let above = _mm256_cmp_ps::<_CMP_GT_OQ>(self.0, other.0);
            F32x8(_mm256_blendv_ps(otherwise.0, then.0, above))
        }
    }

    #[inline(always)]
    fn halves(self, before: F32x8) -> __m256 {
        // SAFETY: as above.
        unsafe { _mm256_permute2f128_ps::<0x21>(before.0, self.0) }
    }

    #[inline(always)]
    fn after1(self, before: F32x8) -> F32x8 {
        let middle = self.halves(before);
        // SAFETY: as above.
        unsafe {
            let bytes = _mm256_alignr_epi8::<12>(_mm256_castps_si256(self.0), _mm256_castps_si256(middle));
            F32x8(_mm256_castsi256_ps(bytes))
        }
    }

    #[inline(always)]
    fn after2(self, before: F32x8) -> F32x8 {
        // SAFETY: as above.
        unsafe { F32x8(_mm256_shuffle_ps::<0b01_00_11_10>(self.halves(before), self.0)) }
    }
}

impl F32x16 {
    #[inline(always)]
    fn is_above(self, other: F32x16) -> bool {
        // SAFETY: a value exists, so the instructions do.
        unsafe { _mm512_cmp_ps_mask::<_CMP_GT_OQ>(self.0, other.0) != 0 }
    }

    #[inline(always)]
    fn choose(self, other: F32x16, then: F32x16, otherwise: F32x16) -> F32x16 {
        // SAFETY: as above.
        unsafe {
            let above = _mm512_cmp_ps_mask::<_CMP_GT_OQ>(self.0, other.0);
            F32x16(_mm512_mask_blend_ps(above, otherwise.0, then.0))
        }
    }

    #[inline(always)]
    fn after1(self, before: F32x16) -> F32x16 {
        // SAFETY: as above.
        unsafe {
            let numbers = _mm512_alignr_epi32::<15>(_mm512_castps_si512(self.0), _mm512_castps_si512(before.0));
            F32x16(_mm512_castsi512_ps(numbers))
        }
    }

    #[inline(always)]
    fn after2(self, before: F32x16) -> F32x16 {
        // SAFETY: as above.
        unsafe {
            let numbers = _mm512_alignr_epi32::<14>(_mm512_castps_si512(self.0), _mm512_castps_si512(before.0));
            F32x16(_mm512_castsi512_ps(numbers))
        }
    }
}

/// Runs a pass with SSE2, which every x86_64 has.
#[inline(never)]
pub(super) fn sse2<P: Pass>(pass: P) -> P::Output {
    // SAFETY: part of x86_64.
    pass.run(unsafe { F32x4::zero() })
}

/// Runs a pass with AVX2.
///
/// # Safety
/// [`has_avx2`].
#[target_feature(enable = "avx2")]
pub(super) unsafe fn avx2<P: Pass>(pass: P) -> P::Output {
    // SAFETY: the caller's promise.
    pass.run(unsafe { F32x8::zero() })
}

/// Runs a pass with AVX-512F.
///
/// # Safety
/// [`has_avx512`].
#[target_feature(enable = "avx512f")]
pub(super) unsafe fn avx512<P: Pass>(pass: P) -> P::Output {
    // SAFETY: the caller's promise.
    pass.run(unsafe { F32x16::zero() })
}

/// Features of the processor (Intel SDM volume 2, CPUID) and the registers that the operating system keeps (volume 1,
/// 13.3): leaf 7 EBX, and XCR0, which is 0 where it cannot be read.
fn features() -> (u32, u64) {
    const OSXSAVE_AND_AVX: u32 = 3 << 27;
    if __cpuid(0).eax < 7 || __cpuid(1).ecx & OSXSAVE_AND_AVX != OSXSAVE_AND_AVX {
        return (0, 0);
    }
    // SAFETY: OSXSAVE says that the instruction may be used.
    (__cpuid_count(7, 0).ebx, unsafe { kept_registers() })
}

/// # Safety
/// CPUID.1:ECX.OSXSAVE is set.
#[target_feature(enable = "xsave")]
unsafe fn kept_registers() -> u64 {
    // SAFETY: the caller's promise.
    unsafe { _xgetbv(_XCR_XFEATURE_ENABLED_MASK) }
}

/// AVX2, with the registers xmm and ymm kept.
pub(super) fn has_avx2() -> bool {
    let (features, kept) = features();
    features & 1 << 5 != 0 && kept & 0b110 == 0b110
}

/// AVX-512F, with the mask registers, the upper halves of zmm0 to 15, and zmm16 to 31 kept too. AVX2 is demanded as well:
/// the compiler takes it for granted.
pub(super) fn has_avx512() -> bool {
    let (features, kept) = features();
    features & 1 << 16 != 0 && kept & 0b1110_0110 == 0b1110_0110 && has_avx2()
}
