//! The paper's losses.

use burn::Tensor;

/// What the discriminator said of real and of generated pictures, each [batch, 1] in 0 to 1.
#[derive(Clone, Debug)]
pub struct Ratings {
    /// Of real pictures.
    pub real: Tensor<2>,
    /// Of generated ones.
    pub generated: Tensor<2>,
}

/// Least-squares loss of the discriminator (eq. 15): half E[(D(x) - 1)^2] + half E[D(G(z))^2].
pub fn discriminator_loss(ratings: &Ratings) -> Tensor<1> {
    let real = (ratings.real.clone() - 1.0).square().mean();
    let generated = ratings.generated.clone().square().mean();
    (real + generated) * 0.5
}

/// Adversarial loss of the generator (eq. 16 and 20): half E[(D(G(z)) - 1)^2].
pub fn generator_loss(generated: Tensor<2>) -> Tensor<1> {
    (generated - 1.0).square().mean() * 0.5
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
        let d = discriminator_loss(&ratings).into_scalar::<f32>();
        assert!((d - 0.5 * (0.25 / 2.0 + 0.16 / 2.0)).abs() < 1e-6, "{d}");
        let g = generator_loss(ratings.generated).into_scalar::<f32>();
        assert!((g - 0.5 * (1.0 + 0.36) / 2.0).abs() < 1e-6, "{g}");
        let w = weight_penalty(Tensor::from_floats([8.0], &Device::flex()), 1e-3, 4).into_scalar::<f32>();
        assert!((w - 1e-3).abs() < 1e-9, "{w}");
    }
}
