//! Each operation of each width has the bits of the scalar one, for ordinary numbers and for every special one.

extern crate std;

use std::println;
use std::vec::Vec;

use super::{Pass, Vector, run};
use crate::width::{Supported, Width};
use crate::{math, noise};

/// Zeros, denormal numbers, the ends of the range, infinities and NaN, of both signs, and what lies around 1.
fn specials() -> Vec<f32> {
    let tiny = f32::from_bits(1);
    let denormal = f32::MIN_POSITIVE / 3.0;
    let some = [0.0, tiny, denormal, f32::MIN_POSITIVE, 1e-30, 1e-15, 0.1, 1.0, 1.0 + f32::EPSILON, 3.0, 1e19, 1e38];
    let ends = [f32::MAX, f32::INFINITY, f32::NAN];
    some.into_iter().chain(ends).flat_map(|x| [x, -x]).collect()
}

/// Every pair of special numbers, and random ones of all sizes.
fn pairs() -> Vec<(f32, f32)> {
    let special = specials();
    let mut all: Vec<(f32, f32)> = special.iter().flat_map(|a| special.iter().map(|b| (*a, *b))).collect();
    let random = |i: u32| {
        let exponent = 80.0 * noise::uniform(7, 2 * i) - 40.0;
        noise::gaussian(8, i) * libm::exp2f(exponent)
    };
    all.extend((0..4000).map(|i| (random(2 * i), random(2 * i + 1))));
    all.resize(all.len().next_multiple_of(16), (1.0, 2.0));
    all
}

/// What is chosen where the first number is not above the second.
const CHOSEN: f32 = -0.0;

/// What the operations answer, one operation after the other.
struct Operations<'a> {
    a: &'a [f32],
    b: &'a [f32],
}

impl Pass for Operations<'_> {
    type Output = Vec<Vec<f32>>;

    #[inline(always)]
    fn run<V: Vector>(self, zero: V) -> Vec<Vec<f32>> {
        let mut results: Vec<Vec<f32>> = Vec::new();
        let n = self.a.len();
        for operation in 0..10 {
            let mut out = std::vec![0.0; n];
            for at in (0..n).step_by(V::LANES) {
                let (a, b) = (zero.read(self.a, at), zero.read(self.b, at));
                let result = match operation {
                    0 => a + b,
                    1 => a - b,
                    2 => a * b,
                    3 => a / b,
                    4 => a.sqrt(),
                    5 => a.max(b),
                    6 => a.min(b),
                    7 => zero.all(self.a[at]),
                    8 => a.above(b, a, zero.all(CHOSEN)),
                    _ => a,
                };
                result.write(&mut out, at);
            }
            results.push(out);
        }
        results
    }
}

fn same(a: f32, b: f32) -> bool {
    // which NaN it is, IEEE 754 leaves open
    a.to_bits() == b.to_bits() || a.is_nan() && b.is_nan()
}

/// The widths that the machine has; it says which ones it lacks.
fn widths() -> Vec<Supported> {
    let has = |w: Width| {
        let found = Supported::new(w);
        if found.is_none() {
            println!("SKIPPED: this machine has no {}", w.name());
        }
        found
    };
    Width::ALL.into_iter().filter_map(has).collect()
}

#[test]
fn each_operation_has_the_bits_of_the_scalar_one() {
    let (a, b): (Vec<f32>, Vec<f32>) = pairs().into_iter().unzip();
    let scalar: [fn(f32, f32) -> f32; 7] = [
        |a, b| a + b,
        |a, b| a - b,
        |a, b| a * b,
        |a, b| a / b,
        |a, _| libm::sqrtf(a),
        |a, b| if a > b { a } else { b },
        |a, b| if a < b { a } else { b },
    ];
    for width in widths() {
        let results = run(width, Operations { a: &a, b: &b });
        for (operation, f) in scalar.iter().enumerate() {
            for i in 0..a.len() {
                let (is, should) = (results[operation][i], f(a[i], b[i]));
                assert!(
                    same(is, should),
                    "{:?} {operation}: {:e} {:e}: {is:e}, not {should:e}",
                    width.get(),
                    a[i],
                    b[i]
                );
            }
        }
        let lanes = width.get().lanes();
        for i in 0..a.len() {
            assert!(same(results[7][i], a[i / lanes * lanes]), "one number in all lanes");
            let chosen = if a[i] > b[i] { a[i] } else { CHOSEN };
            assert_eq!(results[8][i].to_bits(), chosen.to_bits(), "{:e} above {:e}", a[i], b[i]);
            assert_eq!(results[9][i].to_bits(), a[i].to_bits(), "read and written as it is");
        }
    }
}

/// `max` and `min` of the crate and of the vectors follow one rule, also for zeros of both signs.
#[test]
fn the_rule_of_max_is_that_of_math() {
    for (a, b) in pairs() {
        assert!(same(math::max(a, b), if a > b { a } else { b }));
        assert!(same(math::min(a, b), if a < b { a } else { b }));
    }
    assert!(math::max(-0.0, 0.0).is_sign_positive() && math::max(0.0, -0.0).is_sign_negative());
    assert!(!math::max(f32::NAN, 1.0).is_nan() && math::max(1.0, f32::NAN).is_nan());
}

/// Numbers that tell their place, shifted by one and by two, and compared.
struct Lanes<'a> {
    numbers: &'a [f32],
    /// At each place, whether any lane of its vector is above.
    level: f32,
}

impl Pass for Lanes<'_> {
    /// Shifted by one and by two, and which vectors reach above the level.
    type Output = [Vec<f32>; 3];

    #[inline(always)]
    fn run<V: Vector>(self, zero: V) -> [Vec<f32>; 3] {
        let n = self.numbers.len();
        let [mut one, mut two, mut above] = [(); 3].map(|()| std::vec![0.0; n]);
        let (mut before, mut before2) = (zero, zero);
        for at in (0..n).step_by(V::LANES) {
            let here = zero.read(self.numbers, at);
            here.next1(before).write(&mut one, at);
            here.next2(before, before2).write(&mut two, at);
            above[at..at + V::LANES].fill(f32::from(here.any_above(zero.all(self.level))));
            (before, before2) = (here, before);
        }
        [one, two, above]
    }
}

#[test]
fn lanes_go_on_to_the_next_places() {
    let mut numbers: Vec<f32> = (1u16..=64).map(f32::from).collect();
    numbers[40] = f32::NAN;
    for width in widths() {
        for level in [0.0, 4.0, 23.5, 60.0, 64.0, f32::INFINITY] {
            let [one, two, above] = run(width, Lanes { numbers: &numbers, level });
            let lanes = width.get().lanes();
            for i in 0..64 {
                let earlier = |by: usize| if i < by { 0.0 } else { numbers[i - by] };
                assert!(same(one[i], earlier(1)) && same(two[i], earlier(2)), "{width:?} at {i}");
                let first = i / lanes * lanes;
                let any = numbers[first..first + lanes].iter().any(|x| *x > level);
                assert_eq!(above[i] == 1.0, any, "{width:?} above {level} at {i}");
            }
        }
    }
}

/// Outside a plane there are zeros, and nothing is written.
struct Outside<'a>(&'a mut [f32]);

impl Pass for Outside<'_> {
    type Output = bool;

    #[inline(always)]
    fn run<V: Vector>(self, zero: V) -> bool {
        let n = self.0.len();
        let mut nothing = true;
        for at in [n - V::LANES + 1, n, n + 1, usize::MAX, usize::MAX - V::LANES + 1] {
            zero.all(9.0).write(self.0, at);
            nothing &= !zero.read(self.0, at).any_above(zero);
        }
        nothing
    }
}

#[test]
fn outside_a_plane_nothing_is_read_or_written() {
    for width in widths() {
        let mut plane = [5.0; 32];
        assert!(run(width, Outside(&mut plane)), "{width:?}");
        assert_eq!(plane, [5.0; 32], "{width:?}");
    }
}

/// What the processor tells is what the standard library finds, and the best width is the widest one.
#[test]
fn the_processor_is_read_rightly() {
    #[cfg(target_arch = "x86_64")]
    {
        assert!(Width::Sse2.is_supported() && !Width::Neon.is_supported());
        assert_eq!(Width::Avx2.is_supported(), std::is_x86_feature_detected!("avx2"));
        assert_eq!(Width::Avx512.is_supported(), std::is_x86_feature_detected!("avx512f"));
    }
    #[cfg(target_arch = "aarch64")]
    assert!(Width::Neon.is_supported() && !Width::Sse2.is_supported());
    assert!(Width::Scalar.is_supported());
    let widest = widths().into_iter().map(|w| w.get().lanes()).max();
    assert_eq!(Some(Width::best().lanes()), widest);
}
