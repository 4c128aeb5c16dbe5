//! A small stream of random numbers for the augmentations: SplitMix64 (Steele, Lea and Flood 2014), seeded by two numbers.

/// The stream. The same seeds give the same numbers.
#[derive(Clone, Debug)]
pub(super) struct Stream {
    state: u64,
}

impl Stream {
    /// Stream number `index` of `seed`.
    pub fn new(seed: u64, index: u64) -> Self {
        let mut stream = Self { state: seed };
        stream.state = stream.bits() ^ index.wrapping_mul(0xD134_2543_DE82_EF95);
        stream.bits();
        stream
    }

    /// 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.state ^ (self.state >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// Uniform in `[0, 1)`.
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Uniform in `[low, high)`.
    pub fn range(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Two independent standard normal numbers (Box and Muller 1958).
    pub fn gaussians(&mut self) -> [f64; 2] {
        // 1 - unit lies in (0, 1], where the logarithm is finite
        let radius = (-2.0 * (1.0 - self.unit()).ln()).sqrt();
        let (sin, cos) = (std::f64::consts::TAU * self.unit()).sin_cos();
        [radius * cos, radius * sin]
    }
}
