//! The discriminator (paper, section V.B.1 and Fig. 5): a picture of 64 x 64 in, the probability that it is real out.
//!
//! Seven modules of convolution and batch normalisation with LeakyReLU (0.2) between them; kernels 5 x 5 in the first
//! two and 3 x 3 in the rest; stride 2 in the first six and 1 in the last; a fully connected layer and a sigmoid. With
//! base width w the channels are w, 2w, 4w, 8w, 8w, 8w, 8w and the sides 32, 16, 8, 4, 2, 1, 1.
//!
//! **The residual** "between three consecutive convolutional layers" spans the last three, the only run of three with
//! equal channels. Two of them have stride 2, so what is added is the 4 x 4 mean of the fourth module's output.
//!
//! **Conditional** (off in the paper's recipe): a linear projection of the description is concatenated to the features
//! in front of the fully connected layer. One fully connected layer to one number would only add a score of the words
//! to a score of the picture, and could never say whether the two match; so in this mode a hidden layer of 8w with
//! LeakyReLU stands between.

use burn::Tensor;
use burn::module::Module;
use burn::nn::conv::Conv2d;
use burn::nn::{BatchNorm, Linear};
use burn::tensor::Device;
use burn::tensor::activation::{leaky_relu, sigmoid};
use serde::{Deserialize, Serialize};

use super::init::LayerBuilder;
use super::{DESCRIPTION, MAX_WIDTH, NetError, normalise};

/// Slope of LeakyReLU for negative numbers; the paper gives none, 0.2 is DCGAN's.
const LEAK: f64 = 0.2;
/// Modules that the residual spans, at the end.
const RESIDUAL: usize = 3;

/// What a discriminator is built from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct DiscriminatorConfig {
    /// Base width w, 1 to [`MAX_WIDTH`]; default 16.
    pub width: usize,
    /// Channels of the pictures, 1 to 4; default 1 (grey).
    pub picture_channels: usize,
    /// Whether the description has a say; default false, as in the paper.
    pub conditional: bool,
    /// Numbers that the description is projected to when `conditional`, 1 to 1024; default 64.
    pub projection: usize,
}

impl Default for DiscriminatorConfig {
    fn default() -> Self {
        Self { width: 16, picture_channels: 1, conditional: false, projection: 64 }
    }
}

impl DiscriminatorConfig {
    /// A discriminator with first weights from `seed`; on an autodiff device it is ready to train.
    ///
    /// # Errors
    /// [`NetError`] names the field that is out of range.
    pub fn init(&self, seed: u64, device: &Device) -> Result<Discriminator, NetError> {
        let w = self.width;
        if w == 0 || w > MAX_WIDTH {
            return Err(NetError::Width(w));
        }
        if !(1..=4).contains(&self.picture_channels) {
            return Err(NetError::PictureChannels(self.picture_channels));
        }
        if self.conditional && !(1..=DESCRIPTION).contains(&self.projection) {
            return Err(NetError::Projection(self.projection));
        }
        let mut b = LayerBuilder::new(seed, device);
        let channels = [self.picture_channels, w, 2 * w, 4 * w, 8 * w, 8 * w, 8 * w, 8 * w];
        let modules = (0..7)
            .map(|i| {
                let (kernel, stride) = (if i < 2 { 5 } else { 3 }, if i < 6 { 2 } else { 1 });
                ConvolutionModule {
                    convolution: b.convolution([channels[i], channels[i + 1]], kernel, stride),
                    norm: b.batch_norm(channels[i + 1]),
                }
            })
            .collect();
        let condition = self.conditional.then(|| Condition {
            projection: b.linear(DESCRIPTION, self.projection),
            hidden: b.linear(8 * w + self.projection, 8 * w),
        });
        Ok(Discriminator { modules, condition, connected: b.linear(8 * w, 1) })
    }
}

/// A convolution and the batch normalisation of its output.
#[derive(Module, Debug)]
pub struct ConvolutionModule {
    /// 5 x 5 or 3 x 3.
    pub convolution: Conv2d,
    /// Over its output channels.
    pub norm: BatchNorm,
}

impl ConvolutionModule {
    fn forward(&self, x: Tensor<4>) -> Tensor<4> {
        self.norm.forward(self.convolution.forward(x))
    }
}

/// How the description joins.
#[derive(Module, Debug)]
pub struct Condition {
    /// 1024 to a few numbers.
    pub projection: Linear,
    /// Features and projection to 8w.
    pub hidden: Linear,
}

/// The discriminator of Fig. 5.
#[derive(Module, Debug)]
pub struct Discriminator {
    /// The seven convolution modules, in order.
    pub modules: Vec<ConvolutionModule>,
    /// Present in a conditional discriminator only.
    pub condition: Option<Condition>,
    /// 8w to one number.
    pub connected: Linear,
}

impl Discriminator {
    /// The probability, [batch, 1] in (0, 1), that `pictures` [batch, channels, 64, 64] in [-1, 1] are real.
    /// `descriptions` [batch, 1024] matter to a conditional discriminator only. On an autodiff device the batch's own
    /// statistics normalise: feed real and generated pictures as separate batches of two at least.
    pub fn forward(&self, pictures: Tensor<4>, descriptions: Tensor<2>) -> Tensor<2> {
        let split = self.modules.len() - RESIDUAL;
        let mut x = pictures;
        for module in &self.modules[..split] {
            x = leaky_relu(module.forward(x), LEAK);
        }
        let shortcut = x.clone().mean_dims(&[2, 3]);
        for (i, module) in self.modules[split..].iter().enumerate() {
            let y = module.forward(x);
            let y = if i + 1 == RESIDUAL { y + shortcut.clone() } else { y };
            x = leaky_relu(y, LEAK);
        }
        let features: Tensor<2> = x.flatten(1, 3);
        let features = match &self.condition {
            None => features,
            Some(c) => {
                let told = c.projection.forward(normalise(descriptions));
                leaky_relu(c.hidden.forward(Tensor::cat(vec![features, told], 1)), LEAK)
            }
        };
        sigmoid(self.connected.forward(features))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bad_configurations_are_named() {
        let d = Device::flex();
        let ok = DiscriminatorConfig::default();
        let e = |c: DiscriminatorConfig| c.init(0, &d).expect_err("out of range");
        assert_eq!(e(DiscriminatorConfig { width: 257, ..ok }), NetError::Width(257));
        assert_eq!(e(DiscriminatorConfig { picture_channels: 0, ..ok }), NetError::PictureChannels(0));
        assert_eq!(e(DiscriminatorConfig { conditional: true, projection: 0, ..ok }), NetError::Projection(0));
    }
}
