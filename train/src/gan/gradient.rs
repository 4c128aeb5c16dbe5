//! Length of a gradient.

use burn::Tensor;
use burn::module::{Module, ModuleVisitor, Param};
use burn::optim::GradientsParams;

/// Root of the sum of the squares of a module's gradients.
pub(super) fn gradient_norm<M: Module>(module: &M, gradients: &GradientsParams) -> f64 {
    let mut sum = Squares { gradients, sum: 0.0 };
    module.visit(&mut sum);
    sum.sum.sqrt()
}

struct Squares<'a> {
    gradients: &'a GradientsParams,
    sum: f64,
}

impl ModuleVisitor for Squares<'_> {
    fn visit_float<const D: usize>(&mut self, param: &Param<Tensor<D>>) {
        if let Some(gradient) = self.gradients.get::<D>(param.id) {
            self.sum += f64::from(gradient.square().sum().into_scalar::<f32>());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use burn::nn::LinearConfig;
    use burn::tensor::{Device, TensorData};

    #[test]
    fn the_norm_is_that_of_all_weights_together() {
        let device = Device::flex().autodiff();
        let mut layer = LinearConfig::new(2, 1).init(&device);
        layer.weight = Param::from_data(TensorData::new(vec![0.5f32, -1.0], [2, 1]), &device);
        let x = Tensor::<2>::from_data(TensorData::new(vec![2.0f32, 3.0], [1, 2]), &device);
        // y = w x + b: the gradient is (2, 3, 1)
        let gradients = GradientsParams::from_grads(layer.forward(x).sum().backward(), &layer);
        assert!((gradient_norm(&layer, &gradients) - 14f64.sqrt()).abs() < 1e-6);
    }
}
