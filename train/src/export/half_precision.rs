//! Rounding a network to the f16 numbers that its file holds.

use burn::Tensor;
use burn::module::{Module, ModuleMapper, Param};
use burn::tensor::TensorData;
use half::f16;

use crate::nets::Generator;

/// The inference copy of a generator with every number (kernels, biases, normalisation and its running statistics)
/// rounded to the nearest f16, ties to even: exactly what [`export`](super::export) writes. Numbers beyond the range
/// of f16 become infinite here; `export` refuses them. The generator that was handed in keeps its numbers.
pub fn round_to_f16(generator: &Generator) -> Generator {
    // `valid` comes first: clones share their running statistics, only `valid` makes new ones, and mapping a clone in
    // place would round those of the original.
    generator.valid().map(&mut Rounder)
}

/// Each number to the nearest f16 and back.
pub(super) fn round(values: &[f32]) -> Vec<f32> {
    values.iter().map(|x| f16::from_f32(*x).to_f32()).collect()
}

struct Rounder;

impl ModuleMapper for Rounder {
    fn map_float<const D: usize>(&mut self, param: Param<Tensor<D>>) -> Param<Tensor<D>> {
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
