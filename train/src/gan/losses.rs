//! The paper's losses.

use burn::Tensor;
use serde::{Deserialize, Serialize};

/// What the discriminator said of real and of generated pictures, each [batch, 1] in 0 to 1.
#[derive(Clone, Debug)]
pub struct Ratings {
    /// Of real pictures.
    pub real: Tensor<2>,
    /// Of generated ones.
    pub generated: Tensor<2>,
}

/// Ratings are cut to this far from 0 and 1 in front of a logarithm.
const LEAST: f64 = 1e-6;

/// How the two sides are told how they do.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum AdversarialLoss {
    /// Eq. 10 and 11; with the codes 1, 0, 1 eq. 15 and 16.
    LeastSquares,
    /// Eq. 6 and 7, as they are printed: the generator's saturates.
    CrossEntropy,
}

/// A loss with its codes (a, b, c): of real pictures, of generated ones, and of what the generator wants.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Adversary {
    /// Which.
    pub loss: AdversarialLoss,
    /// Of least squares only.
    pub labels: [f64; 3],
}

impl Adversary {
    /// A rating between the codes b and a. The discriminator ends in a sigmoid, which could not reach a code of -1.
    fn between(&self, rating: Tensor<2>) -> Tensor<2> {
        let [a, b, _] = self.labels;
        rating * (a - b) + b
    }

    /// Loss of the discriminator: half E[(D(x) - a)^2] + half E[(D(G(z)) - b)^2], or -E[ln D(x)] - E[ln(1 - D(G(z)))].
    pub fn discriminator(&self, ratings: &Ratings) -> Tensor<1> {
        let Ratings { real, generated } = ratings.clone();
        match self.loss {
            AdversarialLoss::LeastSquares => {
                let [a, b, _] = self.labels;
                let (real, generated) = (self.between(real) - a, self.between(generated) - b);
                (real.square().mean() + generated.square().mean()) * 0.5
            }
            AdversarialLoss::CrossEntropy => -(logarithm(real).mean() + logarithm(generated.neg() + 1.0).mean()),
        }
    }

    /// Loss of the generator: half E[(D(G(z)) - c)^2], or E[ln(1 - D(G(z)))].
    pub fn generator(&self, generated: Tensor<2>) -> Tensor<1> {
        match self.loss {
            AdversarialLoss::LeastSquares => (self.between(generated) - self.labels[2]).square().mean() * 0.5,
            AdversarialLoss::CrossEntropy => logarithm(generated.neg() + 1.0).mean(),
        }
    }
}

fn logarithm(share: Tensor<2>) -> Tensor<2> {
    share.clamp(LEAST, 1.0).log()
}

/// L2 loss of the generator (eq. 18): phi / (2 n) times the sum of the squared weights; n is the number of samples.
pub fn weight_penalty(squared_weights: Tensor<1>, phi: f64, samples: usize) -> Tensor<1> {
    squared_weights * (phi / (2.0 * samples as f64))
}

#[cfg(test)]
mod tests {
    use super::*;
    use burn::tensor::{Device, TensorData};

    fn column(values: [f32; 2]) -> Tensor<2> {
        Tensor::from_data(TensorData::new(values.to_vec(), [2, 1]), &Device::flex())
    }

    #[test]
    fn losses_are_those_of_the_equations() {
        let ratings = Ratings { real: column([1.0, 0.5]), generated: column([0.0, 0.4]) };
        let losses = |loss, labels| {
            let adversary = Adversary { loss, labels };
            let d = adversary.discriminator(&ratings).into_scalar::<f32>();
            [d, adversary.generator(ratings.generated.clone()).into_scalar::<f32>()]
        };
        let near = |found: [f32; 2], expected: [f32; 2]| {
            assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-5), "{found:?} {expected:?}");
        };
        let paper = losses(AdversarialLoss::LeastSquares, [1.0, 0.0, 1.0]);
        near(paper, [0.5 * (0.25 / 2.0 + 0.16 / 2.0), 0.5 * (1.0 + 0.36) / 2.0]);
        // ratings 1 and 0 of real pictures, -1 and -0.2 of generated ones
        let chi = losses(AdversarialLoss::LeastSquares, [1.0, -1.0, 0.0]);
        near(chi, [0.5 * (1.0 / 2.0 + 0.64 / 2.0), 0.5 * (1.0 + 0.04) / 2.0]);
        let entropy = losses(AdversarialLoss::CrossEntropy, [1.0, 0.0, 1.0]);
        let half = |a: f32, b: f32| 0.5 * (a.ln() + b.ln());
        near(entropy, [-half(1.0, 0.5) - half(1.0, 0.6), half(1.0, 0.6)]);
        // sure and wrong is dear, not infinite
        let wrong = Ratings { real: column([0.0, 0.0]), generated: column([1.0, 1.0]) };
        let adversary = Adversary { loss: AdversarialLoss::CrossEntropy, labels: [1.0, 0.0, 1.0] };
        assert!((20.0..40.0).contains(&adversary.discriminator(&wrong).into_scalar::<f32>()));
    }

    #[test]
    fn the_weight_penalty_is_that_of_the_equation() {
        let w = weight_penalty(Tensor::from_floats([8.0], &Device::flex()), 1e-3, 4).into_scalar::<f32>();
        assert!((w - 1e-3).abs() < 1e-9, "{w}");
    }
}
