//! What one core can do at best, measured on it: the bound that a step's time is compared with.
//!
//! A spring costs one exact square root, one exact division and a dozen of additions and multiplications; a processor does
//! the first two and the others side by side, so the slower of the two is the bound. Some processors also work on a root and
//! a division at a time, so the two are measured together. Memory is a third bound, which is far
//! below for a cloth that fits into the second cache.

use std::hint::black_box;

use taut::Width;

/// Throughputs of one core in vectors of one width, in ns per number (one lane).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Throughput {
    /// Of the vectors.
    pub width: Width,
    /// ns per correctly rounded square root, many at a time.
    pub sqrt_ns: f64,
    /// ns per correctly rounded division.
    pub div_ns: f64,
    /// ns per square root and division, many of both at a time.
    pub both_ns: f64,
    /// ns per addition or multiplication, half of each.
    pub arithmetic_ns: f64,
    /// ns per byte that is read or written, in 8 MiB.
    pub byte_ns: f64,
}

/// Springs that a particle of a grid of all three families has at both ends, and that start at it.
const GATHERED: f64 = 12.0;
const ONCE: f64 = GATHERED / 2.0;

/// Additions, multiplications and comparisons of a spring: 3 differences, 5 for the squared length, 2 limits, 1 - x, the
/// factor; then 3 products with the difference, and 3 sums at an end.
const SPRING: f64 = 15.0;
const END: f64 = 3.0;

/// The same of a particle: weight, acceleration, velocity 18, the speed limit 6, position 6.
const PARTICLE: f64 = 30.0;

/// Bytes of a particle that a substep reads or writes: positions and velocities twice, 1/M, six stiffnesses.
const BYTES: f64 = 4.0 * (12.0 + 1.0 + 6.0);

impl Throughput {
    /// Measures this core, for about 50 ms. None where the machine lacks the width, or this target has no vectors to
    /// measure with.
    pub fn measure(width: Width) -> Option<Throughput> {
        if !width.is_supported() {
            return None;
        }
        let ns = |work: fn(u64) -> f32, numbers: f64| {
            const ROUNDS: u64 = 2000;
            black_box(work(ROUNDS));
            // the least of many short runs: what disturbs a run only makes it longer
            let least = (0..200).map(|_| nanoseconds(|| black_box(work(ROUNDS)))).fold(f64::INFINITY, f64::min);
            least / (ROUNDS as f64 * numbers)
        };
        let lanes = width.lanes() as f64;
        let [sqrt, div, both, arithmetic] = kernels(width)?;
        let from = vec![1.0f32; 1 << 20];
        let mut to = vec![0.0f32; 1 << 20];
        let byte_ns = (0..20)
            .map(|_| {
                let t = nanoseconds(|| black_box(&mut to).copy_from_slice(black_box(&from)));
                t / 8.0 / f64::from(1 << 20)
            })
            .fold(f64::INFINITY, f64::min);
        Some(Throughput {
            width,
            sqrt_ns: ns(sqrt, OPERATIONS * lanes),
            div_ns: ns(div, OPERATIONS * lanes),
            both_ns: 2.0 * ns(both, OPERATIONS * lanes),
            arithmetic_ns: ns(arithmetic, OPERATIONS * lanes),
            byte_ns,
        })
    }

    /// ns per particle-step below which a gather of all twelve springs cannot come.
    pub fn gather_ns(&self) -> f64 {
        self.bound(GATHERED)
    }

    /// ns per particle-step below which a step with each spring once cannot come.
    pub fn once_ns(&self) -> f64 {
        self.bound(ONCE)
    }

    /// ns per particle-step that memory alone takes, where the cloth fits into no cache.
    pub fn memory_ns(&self) -> f64 {
        BYTES * self.byte_ns
    }

    fn bound(&self, springs: f64) -> f64 {
        let roots = springs * self.both_ns.min(self.sqrt_ns + self.div_ns);
        // whichever way, twelve forces are summed
        let rest = (springs * SPRING + GATHERED * END + PARTICLE) * self.arithmetic_ns;
        roots.max(rest)
    }
}

/// CPU time of this thread.
fn nanoseconds<T>(work: impl FnOnce() -> T) -> f64 {
    let start = cpu_time::ThreadTime::now();
    black_box(work());
    start.elapsed().as_nanos() as f64
}

/// Vector operations of a round of each kernel: twelve chains side by side, so that latency does not count.
const OPERATIONS: f64 = 12.0;

type Kernel = fn(u64) -> f32;

/// Square roots; divisions; both; additions and multiplications.
#[cfg(target_arch = "x86_64")]
fn kernels(width: Width) -> Option<[Kernel; 4]> {
    match width {
        Width::Scalar => Some([x86::scalar::sqrt, x86::scalar::div, x86::scalar::both, x86::scalar::arithmetic]),
        Width::Sse2 => Some([x86::sse2::sqrt, x86::sse2::div, x86::sse2::both, x86::sse2::arithmetic]),
        Width::Avx2 => Some([x86::avx2::sqrt, x86::avx2::div, x86::avx2::both, x86::avx2::arithmetic]),
        Width::Avx512 => Some([x86::avx512::sqrt, x86::avx512::div, x86::avx512::both, x86::avx512::arithmetic]),
        _ => None,
    }
}

#[cfg(not(target_arch = "x86_64"))]
fn kernels(_: Width) -> Option<[Kernel; 4]> {
    None
}

#[cfg(target_arch = "x86_64")]
mod x86 {
    macro_rules! kernels {
        ($name:ident, $features:literal, $type:ty, $all:ident, $add:ident, $mul:ident, $div:ident, $sqrt:ident,
            $first:ident) => {
            /// The kernels of one width. The chains stay near 1, far from denormal numbers.
            pub mod $name {
                use std::arch::x86_64::*;
                use std::hint::black_box;

                macro_rules! kernel {
                    ($kernel:ident, $x:ident, $one:ident, $even:expr, $odd:expr) => {
                        pub fn $kernel(rounds: u64) -> f32 {
                            #[target_feature(enable = $features)]
                            fn inside(rounds: u64) -> f32 {
                                let $one: $type = $all(black_box(1.0000001));
                                let mut chains: [$type; 12] = [$all(black_box(1.5)); 12];
                                for _ in 0..rounds {
                                    for pair in chains.as_chunks_mut::<2>().0 {
                                        let $x = pair[0];
                                        pair[0] = $even;
                                        let $x = pair[1];
                                        pair[1] = $odd;
                                    }
                                }
                                chains.into_iter().map(|c| $first(c)).sum()
                            }
                            // SAFETY: only measured where the processor has the width.
                            unsafe { inside(rounds) }
                        }
                    };
                }
                kernel!(sqrt, x, _one, $sqrt(x), $sqrt(x));
                kernel!(div, x, one, $div(one, x), $div(one, x));
                kernel!(both, x, one, $sqrt(x), $div(one, x));
                kernel!(arithmetic, x, one, $mul(x, one), $add(x, one));
            }
        };
    }
    kernels!(scalar, "sse2", __m128, _mm_set1_ps, _mm_add_ss, _mm_mul_ss, _mm_div_ss, _mm_sqrt_ss, _mm_cvtss_f32);
    kernels!(sse2, "sse2", __m128, _mm_set1_ps, _mm_add_ps, _mm_mul_ps, _mm_div_ps, _mm_sqrt_ps, _mm_cvtss_f32);
    kernels!(
        avx2,
        "avx2",
        __m256,
        _mm256_set1_ps,
        _mm256_add_ps,
        _mm256_mul_ps,
        _mm256_div_ps,
        _mm256_sqrt_ps,
        _mm256_cvtss_f32
    );
    kernels!(
        avx512,
        "avx512f",
        __m512,
        _mm512_set1_ps,
        _mm512_add_ps,
        _mm512_mul_ps,
        _mm512_div_ps,
        _mm512_sqrt_ps,
        _mm512_cvtss_f32
    );
}
