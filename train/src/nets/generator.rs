//! The generator (paper, section V.A.1 and Fig. 4): a description, noise and the scene's pins in, a stiffness field out.
//!
//! With base width w (default 16), every deconvolution followed by ReLU but the last, which ends in tanh:
//!
//! | layer | input | output |
//! | --- | --- | --- |
//! | first | description 1024 + noise 128 as 1152 channels of 1 x 1 | 8w, 4 x 4 (5 x 5 kernel, stride 2) |
//! | second | BN(first) | 4w, 8 x 8 (3 x 3, stride 2) |
//! | third | BN(second ++ skip x2) | 2w, 16 x 16 |
//! | fourth | BN(third ++ skip x4) | w, 32 x 32 |
//! | fifth | BN(fourth ++ skip x8) ++ pins | w, 32 x 32 (stride 1), the fourth added to it before ReLU |
//! | sixth | BN(fifth) ++ pins | 4 channels, 32 x 32 (stride 1), plus the levels, tanh |
//!
//! The fifth and sixth are the "two layers more" than DCGAN, and the sum with the fourth is the residual. **Stitching**:
//! the paper says that the outputs of the activation layers of the first and of the second to the fourth deconvolution
//! are stitched together as inputs of the batch normalisation (section VI.B.1). Here the activation of the first layer
//! goes through one 1 x 1 convolution (8w to w channels, called skip), is repeated to the size at hand (nearest
//! neighbour) and concatenated to the activation of the second, third and fourth, in front of the normalisation that
//! each next layer begins with. So the description reaches every scale directly.
//!
//! `pins`, the distance to the nearest pin, joins behind the normalisation: it is in [0, 1] already, and the statistics
//! of one scene must not shift what another scene shows.
//!
//! The description is scaled to one length first ([`super::description`]): one word says as much as three.
//!
//! **Levels**: the stiffness of each family as a whole, added to the sixth layer in front of tanh, comes from a linear
//! layer over the words, twice: scaled to one length, where "jersey" and "jersey t-shirt" say the same, and as their sum,
//! where "heavy" is a factor (the field is logarithmic). The paper has none: there the convolutions alone must make the
//! level of warp and weft out of the words, and get it wrong by half (`docs/training.md`); without
//! [`GeneratorConfig::levels`] it is the paper's.
//!
//! **One matrix**: the paper's generator writes one m x n matrix, which stands for all families in fixed ratios. With
//! [`GeneratorConfig::one_matrix`] the sixth layer has one channel, which the output repeats; the ratios are those of the
//! channels' ranges. Without [`GeneratorConfig::pins`] the fifth and sixth do not hear the pins. [`Generator::whole`] is the
//! same function in the shapes of the file.
//!
//! Beside the field stands a second linear head over the words alone, which tells what belongs to the fabric as a whole.
//! Noise does not reach it: another seed is another piece of the same fabric.

use burn::Tensor;
use burn::module::{Module, Param};
use burn::nn::conv::{Conv2d, ConvTranspose2d};
use burn::nn::{BatchNorm, Linear};
use burn::tensor::Device;
use burn::tensor::activation::{relu, tanh};
use serde::{Deserialize, Serialize};

use super::init::LayerBuilder;
use super::{CHANNELS, DESCRIPTION, FABRIC, MAX_WIDTH, NOISE, NetError, normalise};

/// What a generator is built from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct GeneratorConfig {
    /// Base width w: channels of the last 32 x 32 layers; 1 to [`MAX_WIDTH`], default 16.
    pub width: usize,
    /// Whether the words set the level of each channel directly; the paper's generator has no such layer.
    pub levels: bool,
    /// Whether one matrix stands for all channels, as in the paper. Goes without `levels`, which tell each channel its own.
    pub one_matrix: bool,
    /// Whether the distance to the pins is heard; the paper's generator knows none.
    pub pins: bool,
}

impl Default for GeneratorConfig {
    fn default() -> Self {
        Self { width: 16, levels: true, one_matrix: false, pins: true }
    }
}

impl GeneratorConfig {
    /// A generator with first weights from `seed`; on an autodiff device it is ready to train.
    ///
    /// # Errors
    /// [`NetError::Width`], [`NetError::OneMatrix`].
    pub fn init(&self, seed: u64, device: &Device) -> Result<Generator, NetError> {
        let w = self.width;
        if w == 0 || w > MAX_WIDTH {
            return Err(NetError::Width(w));
        }
        if self.one_matrix && self.levels {
            return Err(NetError::OneMatrix);
        }
        let (raw, channels) = (usize::from(self.pins), if self.one_matrix { 1 } else { CHANNELS });
        let mut b = LayerBuilder::new(seed, device);
        Ok(Generator {
            first: b.deconvolution([DESCRIPTION + NOISE, 8 * w], 5, 2, 1),
            skip: b.convolution([8 * w, w], 1, 1),
            second: Deconvolution::new(&mut b, 8 * w, 0, 4 * w, 2),
            third: Deconvolution::new(&mut b, 5 * w, 0, 2 * w, 2),
            fourth: Deconvolution::new(&mut b, 3 * w, 0, w, 2),
            fifth: Deconvolution::new(&mut b, 2 * w, raw, w, 1),
            sixth: Deconvolution::new(&mut b, w, raw, channels, 1),
            fabric: b.linear(HEAD_INPUT, FABRIC),
            level: self.levels.then(|| b.linear(HEAD_INPUT, CHANNELS)),
        })
    }
}

/// Batch normalisation and the 3 x 3 deconvolution behind it.
#[derive(Module, Debug)]
pub struct Deconvolution {
    /// Over the stitched channels, without the pins.
    pub norm: BatchNorm,
    /// 3 x 3, padding 1.
    pub deconvolution: ConvTranspose2d,
}

impl Deconvolution {
    fn new(b: &mut LayerBuilder<'_>, channels: usize, raw: usize, out: usize, stride: usize) -> Self {
        let taps = 9usize.div_ceil(stride * stride);
        Self { norm: b.batch_norm(channels), deconvolution: b.deconvolution([channels + raw, out], 3, stride, taps) }
    }

    fn forward(&self, x: Tensor<4>) -> Tensor<4> {
        self.deconvolution.forward(self.norm.forward(x))
    }

    /// With raw channels behind the normalised ones, where the layer has room for them.
    fn forward_with(&self, x: Tensor<4>, raw: Tensor<4>) -> Tensor<4> {
        let hears = self.deconvolution.weight.dims()[0] > x.dims()[1];
        let x = self.norm.forward(x);
        self.deconvolution.forward(if hears { Tensor::cat(vec![x, raw], 1) } else { x })
    }

    /// The same layer with room for one raw channel, which it does not hear where it had none, and `out` channels, equal
    /// ones where it had one.
    fn whole(mut self, out: usize) -> Self {
        let [inputs, had, m, n] = self.deconvolution.weight.dims();
        let mut weight = self.deconvolution.weight.val();
        if inputs == self.norm.gamma.dims()[0] {
            let deaf = Tensor::zeros([1, had, m, n], &weight.device());
            weight = Tensor::cat(vec![weight, deaf], 0);
        }
        let mut bias = self.deconvolution.bias.as_ref().map(|b| b.val());
        if had < out {
            weight = weight.repeat_dim(1, out);
            bias = bias.map(|b| b.repeat_dim(0, out));
        }
        self.deconvolution.weight = Param::from_tensor(weight);
        self.deconvolution.bias = bias.map(Param::from_tensor);
        self.deconvolution.channels = [self.deconvolution.weight.dims()[0], self.deconvolution.weight.dims()[1]];
        self
    }
}

/// The generator of Fig. 4. Fields are named after the place of a layer; see the table of this module.
#[derive(Module, Debug)]
pub struct Generator {
    /// 1152 to 8w, 5 x 5.
    pub first: ConvTranspose2d,
    /// 1 x 1 convolution of the first activation, stitched to the later ones.
    pub skip: Conv2d,
    /// 8w to 4w.
    pub second: Deconvolution,
    /// 4w + w to 2w.
    pub third: Deconvolution,
    /// 2w + w to w.
    pub fourth: Deconvolution,
    /// w + w + pins to w, with the residual.
    pub fifth: Deconvolution,
    /// w + pins to the four channels.
    pub sixth: Deconvolution,
    /// 2048 ([`head_input`]) to the five numbers of the fabric.
    pub fabric: Linear,
    /// 2048 ([`head_input`]) to the level of each channel.
    pub level: Option<Linear>,
}

/// What the generator tells, before decoding: everything in [-1, 1].
#[derive(Debug, Clone)]
pub struct GeneratorOutput {
    /// [batch, 4, 32, 32]: channels warp, weft, shear, bend; row 0 is the top row.
    pub field: Tensor<4>,
    /// [batch, 5]: density, hinge rigidity, stretch limits of warp, weft, diagonal.
    pub fabric: Tensor<2>,
}

impl Generator {
    /// Runs the network: description [batch, 1024] (the sum of the word vectors), noise [batch, 128], distance to the nearest pin
    /// [batch, 1, 32, 32] in [0, 1]. On an autodiff device the batch's own statistics normalise (and the running
    /// statistics follow them), which needs a batch of two at least to mean anything; `valid()` uses the running ones.
    pub fn forward(&self, description: Tensor<2>, noise: Tensor<2>, pin_distance: Tensor<4>) -> GeneratorOutput {
        let scaled = normalise(description.clone());
        let heard = head_input(scaled.clone(), description);
        let fabric = tanh(self.fabric.forward(heard.clone()));
        let level = self.level.as_ref().map(|l| l.forward(heard));
        let v = Tensor::cat(vec![scaled, noise], 1);
        let [batch, n] = v.dims();
        let a1 = relu(self.first.forward(v.reshape([batch, n, 1, 1])));
        let skip = self.skip.forward(a1.clone());
        let stitch = |a: Tensor<4>, times| Tensor::cat(vec![a, repeat(skip.clone(), times)], 1);
        let a2 = relu(self.second.forward(a1));
        let a3 = relu(self.third.forward(stitch(a2, 2)));
        let a4 = relu(self.fourth.forward(stitch(a3, 4)));
        let a5 = self.fifth.forward_with(stitch(a4.clone(), 8), pin_distance.clone());
        let a5 = relu(a5 + a4);
        let pattern = self.sixth.forward_with(a5, pin_distance);
        let pattern = match level {
            Some(level) => pattern + level.reshape([batch, CHANNELS, 1, 1]),
            None => pattern,
        };
        // one matrix stands for all
        let [_, _, m, n] = pattern.dims();
        GeneratorOutput { field: tanh(pattern).expand([batch, CHANNELS, m, n]), fabric }
    }

    /// The copy for inference in the shapes of the generator file: with the pins, deaf to them where it was built without,
    /// and four channels, equal ones where it was built with one. It answers what this one answers.
    pub fn whole(&self) -> Generator {
        let mut g = self.valid();
        let width = g.fifth.deconvolution.weight.dims()[1];
        g.fifth = g.fifth.whole(width);
        g.sixth = g.sixth.whole(CHANNELS);
        g
    }

    /// Sum of the squares of all kernels and matrices, the sum of eq. 18 (biases and normalisation have no part in
    /// it), as a tensor of one number that gradients flow through.
    pub fn squared_weights(&self) -> Tensor<1> {
        let ct = |c: &ConvTranspose2d| c.weight.val().square().sum();
        ct(&self.first)
            + self.skip.weight.val().square().sum()
            + ct(&self.second.deconvolution)
            + ct(&self.third.deconvolution)
            + ct(&self.fourth.deconvolution)
            + ct(&self.fifth.deconvolution)
            + ct(&self.sixth.deconvolution)
            + self.fabric.weight.val().square().sum()
            + self.level.as_ref().map_or(self.fabric.weight.val().zeros_like().sum(), |l| l.weight.val().square().sum())
    }
}

/// Numbers that the linear heads hear.
pub const HEAD_INPUT: usize = 2 * DESCRIPTION;

/// Share of the scaled description in [`head_input`]: it makes its length 1, that of a word.
pub const HEAD_SCALE: f32 = 1.0 / 32.0;

/// What the linear heads hear: the description at length 1, then the sum of the words, [batch, 2048].
pub fn head_input(scaled: Tensor<2>, sum: Tensor<2>) -> Tensor<2> {
    Tensor::cat(vec![scaled * HEAD_SCALE, sum], 1)
}

/// Each pixel becomes a block of `times` x `times` equal ones.
fn repeat(x: Tensor<4>, times: usize) -> Tensor<4> {
    let [b, c, h, w] = x.dims();
    x.reshape([b, c, h, 1, w, 1]).expand([b, c, h, times, w, times]).reshape([b, c, h * times, w * times])
}

#[cfg(test)]
mod tests {
    use super::*;
    use burn::tensor::TensorData;

    #[test]
    fn repeat_makes_blocks() {
        let x = Tensor::<4>::from_data(TensorData::new(vec![1.0f32, 2.0, 3.0, 4.0], [1, 1, 2, 2]), &Device::flex());
        let y: Vec<f32> = repeat(x, 2).into_data().try_into_vec().expect("f32");
        assert_eq!(y, [1., 1., 2., 2., 1., 1., 2., 2., 3., 3., 4., 4., 3., 3., 4., 4.]);
    }

    #[test]
    fn a_width_of_zero_is_an_error() {
        let error = |c: GeneratorConfig| c.init(1, &Device::flex()).expect_err("refused");
        let e = error(GeneratorConfig { width: 0, ..GeneratorConfig::default() });
        assert_eq!(e, NetError::Width(0));
        assert!(e.to_string().contains('0'));
        let both = GeneratorConfig { one_matrix: true, ..GeneratorConfig::default() };
        assert_eq!(error(both), NetError::OneMatrix);
    }
}
