//! Counter-based random numbers: the same on every target, with no state. A seed means the same everywhere.

/// A well-mixed 64-bit number for (seed, index): the finaliser of SplitMix64 (Steele, Lea, Flood 2014), twice.
pub fn bits(seed: u64, index: u32) -> u64 {
    mix(mix(seed).wrapping_add((u64::from(index) + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15)))
}

fn mix(mut z: u64) -> u64 {
    z = z.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// A number in [0, 1) of 24 bits, exact in f32.
pub fn uniform(seed: u64, index: u32) -> f32 {
    (bits(seed, index) >> 40) as f32 * (1.0 / 16_777_216.0)
}

/// A Gaussian number of mean 0 and deviation 1 (Box and Muller 1958), at most 8.1 in size.
pub fn gaussian(seed: u64, index: u32) -> f32 {
    let b = bits(seed, index);
    // 2^-48 to 1, so that the logarithm is finite
    let u = ((b >> 16) + 1) as f64 * (1.0 / 281_474_976_710_656.0);
    let angle = (bits(seed ^ 0x5851_f42d_4c95_7f2d, index) >> 40) as f64 * (core::f64::consts::TAU / 16_777_216.0);
    (libm::sqrt(-2.0 * libm::log(u)) * libm::cos(angle)) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moments_are_right() {
        let n = 200_000u32;
        let (mut s1, mut s2, mut s4, mut u1) = (0.0f64, 0.0, 0.0, 0.0);
        for i in 0..n {
            let g = f64::from(gaussian(7, i));
            s1 += g;
            s2 += g * g;
            s4 += g * g * g * g;
            u1 += f64::from(uniform(7, i));
        }
        let n = f64::from(n);
        assert!((s1 / n).abs() < 0.01, "mean {}", s1 / n);
        assert!((s2 / n - 1.0).abs() < 0.02, "variance {}", s2 / n);
        assert!((s4 / n - 3.0).abs() < 0.12, "fourth moment {}", s4 / n);
        assert!((u1 / n - 0.5).abs() < 0.005, "mean of uniform {}", u1 / n);
    }

    #[test]
    fn a_seed_means_the_same_everywhere() {
        assert_eq!(bits(1, 0), bits(1, 0));
        assert_ne!(bits(1, 0), bits(2, 0));
        assert_ne!(bits(1, 0), bits(1, 1));
        let golden: [u32; 4] = core::array::from_fn(|i| gaussian(42, i as u32).to_bits());
        assert_eq!(golden, GOLDEN);
    }

    /// Printed once on x86_64; the emulated targets must give the same.
    const GOLDEN: [u32; 4] = [1049849902, 1063252983, 1068445893, 3205439162];
}
