//! First weights from a seed.
//!
//! Uniform in +-1/sqrt(fan in) for kernels, matrices and biases (the rule that burn itself uses by default), drawn from
//! SplitMix64. Drawing here, in the order in which the layers are built, makes a network a function of its
//! configuration and seed alone; the backend's generator is global to the process and its tensors are drawn lazily.

use burn::module::Param;
use burn::nn::conv::{Conv2d, Conv2dConfig, ConvTranspose2d, ConvTranspose2dConfig};
use burn::nn::{BatchNorm, BatchNormConfig, Linear, LinearConfig, PaddingConfig2d};
use burn::tensor::{Device, TensorData};

/// SplitMix64 (Steele, Lea, Flood 2014): one 64-bit word of state, every seed is a good one.
#[derive(Debug, Clone)]
pub struct SplitMix64(u64);

impl SplitMix64 {
    /// A stream that begins at `seed`.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// The next 64 bits.
    pub fn next_u64(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// Uniform in [-1, 1), a multiple of 2^-23, so that it is exact in f32.
    pub fn uniform(&mut self) -> f32 {
        (self.next_u64() >> 40) as f32 * (1.0 / 8_388_608.0) - 1.0
    }
}

/// Builds layers whose weights come from one stream.
#[derive(Debug)]
pub struct LayerBuilder<'a> {
    stream: SplitMix64,
    device: &'a Device,
}

impl<'a> LayerBuilder<'a> {
    /// Layers on `device`, weights from `seed`.
    pub fn new(seed: u64, device: &'a Device) -> Self {
        Self { stream: SplitMix64::new(seed), device }
    }

    fn tensor<const D: usize>(&mut self, shape: [usize; D], fan_in: usize) -> Param<burn::Tensor<D>> {
        let bound = 1.0 / (fan_in.max(1) as f32).sqrt();
        let values: Vec<f32> = (0..shape.iter().product()).map(|_| self.stream.uniform() * bound).collect();
        Param::from_data(TensorData::new(values, shape), self.device)
    }

    /// A transposed convolution with padding 1 and output padding `stride` - 1: a 3 x 3 kernel multiplies the side by
    /// `stride`, a 5 x 5 kernel of stride 2 makes 4 x 4 of 1 x 1. `taps` is how many taps of the kernel meet an input
    /// at one output pixel (rounded up), which the fan in, channels x taps, counts.
    pub fn deconvolution(
        &mut self,
        channels: [usize; 2],
        kernel: usize,
        stride: usize,
        taps: usize,
    ) -> ConvTranspose2d {
        let mut layer = ConvTranspose2dConfig::new(channels, [kernel, kernel])
            .with_stride([stride, stride])
            .with_padding([1, 1])
            .with_padding_out([stride - 1, stride - 1])
            .init(self.device);
        let fan_in = channels[0] * taps;
        layer.weight = self.tensor([channels[0], channels[1], kernel, kernel], fan_in);
        layer.bias = Some(self.tensor([channels[1]], fan_in));
        layer
    }

    /// A convolution with padding k/2: the side is divided by `stride`, rounded up.
    pub fn convolution(&mut self, channels: [usize; 2], kernel: usize, stride: usize) -> Conv2d {
        let p = kernel / 2;
        let mut layer = Conv2dConfig::new(channels, [kernel, kernel])
            .with_stride([stride, stride])
            .with_padding(PaddingConfig2d::Explicit(p, p, p, p))
            .init(self.device);
        let fan_in = channels[0] * kernel * kernel;
        layer.weight = self.tensor([channels[1], channels[0], kernel, kernel], fan_in);
        layer.bias = Some(self.tensor([channels[1]], fan_in));
        layer
    }

    /// A dense layer; the weight has shape [inputs, outputs].
    pub fn linear(&mut self, inputs: usize, outputs: usize) -> Linear {
        let mut layer = LinearConfig::new(inputs, outputs).init(self.device);
        layer.weight = self.tensor([inputs, outputs], inputs);
        layer.bias = Some(self.tensor([outputs], inputs));
        layer
    }

    /// Batch normalisation with scale 1, shift 0, epsilon 1e-5 and momentum 0.1.
    pub fn batch_norm(&mut self, channels: usize) -> BatchNorm {
        BatchNormConfig::new(channels).init(self.device)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_stream_is_splitmix64_and_stays_in_its_range() {
        // First outputs for seed 1234567 in the reference implementation.
        let mut s = SplitMix64::new(1_234_567);
        assert_eq!([s.next_u64(), s.next_u64()], [6_457_827_717_110_365_317, 3_203_168_211_198_807_973]);
        let mut s = SplitMix64::new(9);
        let v: Vec<f32> = (0..20_000).map(|_| s.uniform()).collect();
        assert!(v.iter().all(|x| (-1.0..1.0).contains(x)));
        let mean = v.iter().sum::<f32>() / v.len() as f32;
        assert!(mean.abs() < 0.02, "mean {mean}");
    }
}
