//! The checked graph as a plan of the inference engine.

use std::sync::Arc;

use tract_onnx::pb::ModelProto;
use tract_onnx::prelude::*;

use crate::graph::{input_shapes, output_shapes};
use crate::guard::guarded;
use crate::{Error, Info};

/// A graph, optimised for one description at a time.
pub(crate) struct Plan {
    runnable: Arc<TypedRunnableModel>,
    inputs: [Vec<usize>; 4],
    outputs: [Vec<usize>; 2],
}

/// What the network takes. The sizes are those of the metadata.
pub(crate) struct Feed<'a> {
    pub tokens: &'a [i64],
    pub weights: &'a [f32],
    pub noise: &'a [f32],
    pub pin_distance: &'a [f32],
}

impl Plan {
    /// Builds the plan of a graph that `graph::check` has passed. Errors: [`Error::Inference`].
    pub fn build(model: &ModelProto, info: &Info) -> Result<Plan, Error> {
        let runnable = guarded("optimise", || -> TractResult<_> {
            let model = tract_onnx::onnx().model_for_proto_model(model)?;
            model.into_optimized()?.into_runnable()
        })?;
        let inputs = input_shapes(info).map(|(_, dims)| dims);
        Ok(Plan { runnable, inputs, outputs: output_shapes(info) })
    }

    /// Runs the network. The result is `field` and `fabric` as they stand in the file's contract,
    /// row by row, every number within -1 and 1. Errors: [`Error::Inference`], [`Error::Output`].
    pub fn run(&self, feed: &Feed<'_>) -> Result<[Vec<f32>; 2], Error> {
        let outputs = guarded("run", || -> TractResult<_> {
            let inputs = tvec!(
                Tensor::from_shape(&self.inputs[0], feed.tokens)?.into_tvalue(),
                Tensor::from_shape(&self.inputs[1], feed.weights)?.into_tvalue(),
                Tensor::from_shape(&self.inputs[2], feed.noise)?.into_tvalue(),
                Tensor::from_shape(&self.inputs[3], feed.pin_distance)?.into_tvalue(),
            );
            let read = |t: &TValue| -> TractResult<(Vec<usize>, Vec<f32>)> {
                let view = t.to_plain_array_view::<f32>()?;
                Ok((view.shape().to_vec(), view.iter().copied().collect()))
            };
            self.runnable.run(inputs)?.iter().map(read).collect::<TractResult<Vec<_>>>()
        })?;
        let Ok([field, fabric]) = <[_; 2]>::try_from(outputs) else {
            return Err(Error::Inference { stage: "run", reason: "another number of outputs".into() });
        };
        let field = checked(field, "field", &self.outputs[0])?;
        let fabric = checked(fabric, "fabric", &self.outputs[1])?;
        Ok([field, fabric])
    }
}

/// Checks the shape and the numbers of an output. Some kernels round tanh to a hair above 1; that is
/// put back to 1, anything else outside is an error.
fn checked(
    (dims, mut numbers): (Vec<usize>, Vec<f32>),
    output: &'static str,
    expected: &[usize],
) -> Result<Vec<f32>, Error> {
    if dims != expected {
        return Err(Error::TensorShape {
            tensor: output.into(),
            expected: format!("{expected:?} by the metadata"),
            found: dims,
        });
    }
    for x in &mut numbers {
        // false for NaN
        let written_by_tanh = x.abs() <= 1.0 + 1e-4;
        if !written_by_tanh {
            return Err(Error::Output { output, value: *x });
        }
        *x = x.clamp(-1.0, 1.0);
    }
    Ok(numbers)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_tanh_can_write_passes() {
        let check = |x: f32| checked((vec![1, 2], vec![0.5, x]), "field", &[1, 2]);
        assert_eq!(check(-1.0), Ok(vec![0.5, -1.0]));
        assert_eq!(check(1.000_001), Ok(vec![0.5, 1.0]));
        for x in [1.1, -3.0, f32::INFINITY] {
            assert_eq!(check(x), Err(Error::Output { output: "field", value: x }));
        }
        assert!(matches!(check(f32::NAN), Err(Error::Output { .. })));
        let other = checked((vec![2], vec![0.0; 2]), "field", &[1, 2]);
        assert!(matches!(other, Err(Error::TensorShape { .. })));
    }
}
