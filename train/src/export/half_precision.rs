//! Rounding a network to the f16 numbers that its file holds.

use burn::Tensor;
use burn::module::{Module, ModuleMapper, Param};
use burn::tensor::TensorData;
use half::f16;

use crate::nets::Generator;

/// The inference copy of a generator with every kernel, matrix and bias rounded to the nearest f16, ties to even, and
/// the normalisation left as it is: exactly what [`export`](super::export) writes. Numbers beyond the range of f16
/// become infinite here; `export` refuses them. The generator that was handed in keeps its numbers.
pub fn round_to_f16(generator: &Generator) -> Generator {
    // `valid` comes first: it brings the running statistics up to the last training step, and clones share theirs, so
    // that mapping a clone would reach into the original.
    generator.valid().map(&mut Rounder::default())
}

/// Each number to the nearest f16 and back.
pub(super) fn round(values: &[f32]) -> Vec<f32> {
    values.iter().map(|x| f16::from_f32(*x).to_f32()).collect()
}

/// Knows the kinds of the modules that it stands in, outermost first.
#[derive(Default)]
struct Rounder {
    inside: Vec<String>,
}

impl ModuleMapper for Rounder {
    fn enter_module(&mut self, _name: &str, container_type: &str) {
        self.inside.push(container_type.into());
    }

    fn exit_module(&mut self, _name: &str, _container_type: &str) {
        self.inside.pop();
    }

    fn map_float<const D: usize>(&mut self, param: Param<Tensor<D>>) -> Param<Tensor<D>> {
        if self.inside.last().is_some_and(|kind| kind == "Struct:BatchNorm") {
            return param;
        }
        param.map(|tensor| {
            let (device, shape) = (tensor.device(), tensor.dims());
            // An f32 tensor of the CPU backend always reads back as f32; should it not, it stays as it is.
            match tensor.to_data().try_into_vec::<f32>() {
                Ok(values) => Tensor::from_data(TensorData::new(round(&values), shape), &device),
                Err(_) => tensor,
            }
        })
    }
}
