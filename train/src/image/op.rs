//! The renderer and the augmentations as differentiable burn operations.
//!
//! Both are plain functions on slices, so one burn operation serves both: [`HostOperation`] says what it computes.
//! It runs on the CPU (flex) backend, with or without autodiff; first derivatives only.

use std::fmt::Debug;
use std::sync::Arc;

use burn::backend::autodiff::{
    Autodiff,
    checkpoint::{base::Checkpointer, strategy::CheckpointStrategy},
    grads::Gradients,
    ops::{Backward, Ops, OpsKind},
};
use burn::backend::ops::FloatTensorOps;
use burn::backend::tensor::FloatTensor;
use burn::backend::{Backend, Dispatch, Flex, TensorMetadata, backend_extension};
use burn::tensor::{Tensor, TensorData, read_sync};

use super::{AugmentBatch, ImageError, Renderer, SIDE, available_threads, expect_len};

/// A function of one tensor, on slices, with its vector-Jacobian product. Shapes were checked by who calls it.
pub trait HostOperation: Debug + Send + Sync {
    /// The shape of the answer for a batch of `batch`.
    fn output_shape(&self, batch: usize) -> Vec<usize>;
    /// The answer.
    fn forward(&self, input: &[f32]) -> Vec<f32>;
    /// d loss / d answer to d loss / d input.
    fn vjp(&self, input: &[f32], gradient: &[f32]) -> Vec<f32>;
}

impl HostOperation for Renderer {
    fn output_shape(&self, batch: usize) -> Vec<usize> {
        vec![batch, self.config().channels.len(), SIDE, SIDE]
    }
    fn forward(&self, input: &[f32]) -> Vec<f32> {
        self.render_unchecked(input, available_threads())
    }
    fn vjp(&self, input: &[f32], gradient: &[f32]) -> Vec<f32> {
        self.vjp_unchecked(input, gradient, available_threads())
    }
}

impl HostOperation for AugmentBatch {
    fn output_shape(&self, batch: usize) -> Vec<usize> {
        vec![batch, self.channels().len(), SIDE, SIDE]
    }
    fn forward(&self, input: &[f32]) -> Vec<f32> {
        self.apply_unchecked(input, available_threads())
    }
    fn vjp(&self, input: &[f32], gradient: &[f32]) -> Vec<f32> {
        self.vjp_unchecked(input, gradient, available_threads())
    }
}

/// The values of a tensor, whatever its float type.
fn host<B: Backend>(tensor: FloatTensor<B>) -> Vec<f32> {
    // the flex backend, the only one this operation is for, keeps its values in memory: reading them cannot fail,
    // and after `convert` they are f32
    read_sync(B::float_into_data(tensor))
        .expect("the CPU backend reads its tensors at once")
        .convert::<f32>()
        .try_into_vec::<f32>()
        .expect("converted to f32")
}

/// Backends that can run a [`HostOperation`].
#[backend_extension(Autodiff, Flex)]
pub trait HostBackend: Backend {
    /// Runs `operation` on `input`, whose first dimension is the batch.
    fn host_operation(input: FloatTensor<Self>, operation: Arc<dyn HostOperation>) -> FloatTensor<Self>;
}

impl HostBackend for Flex {
    fn host_operation(input: FloatTensor<Self>, operation: Arc<dyn HostOperation>) -> FloatTensor<Self> {
        let shape = operation.output_shape(input.shape()[0]);
        let device = input.device();
        let output = operation.forward(&host::<Flex>(input));
        Flex::float_from_data(TensorData::new(output, shape), &device)
    }
}

impl<B: HostBackend, C: CheckpointStrategy> HostBackend for Autodiff<B, C> {
    fn host_operation(input: FloatTensor<Self>, operation: Arc<dyn HostOperation>) -> FloatTensor<Self> {
        #[derive(Debug)]
        struct HostBackward;
        impl<B: HostBackend> Backward<B, 1> for HostBackward {
            type State = (FloatTensor<B>, Arc<dyn HostOperation>);
            fn backward(self, ops: Ops<Self::State, 1>, gradients: &mut Gradients, _: &mut Checkpointer) {
                let [parent] = ops.parents;
                let by_output = gradients.consume::<B>(&ops.node);
                let Some(parent) = parent else { return };
                let (input, operation) = ops.state;
                let (shape, device) = (input.shape(), input.device());
                let by_input = operation.vjp(&host::<B>(input), &host::<B>(by_output));
                gradients.register::<B>(parent.id, B::float_from_data(TensorData::new(by_input, shape), &device));
            }
        }
        let (primitive, node) = input.into_parts();
        match HostBackward.prepare::<C>([node]).compute_bound().stateful() {
            OpsKind::Tracked(prepared) => {
                let output = B::host_operation(primitive.clone(), operation.clone());
                prepared.finish((primitive, operation), output)
            }
            OpsKind::UnTracked(prepared) => prepared.finish(B::host_operation(primitive, operation)),
        }
    }
}

/// Pictures of cloths: positions `[batch, rows * columns, 3]` in metres to `[batch, channels, 64, 64]` in `[-1, 1]`.
///
/// Differentiable in the positions when their device is. Points of a cloth whose position is not finite are left out of the
/// picture and get no gradient: look for them before.
///
/// # Errors
/// [`ImageError::Size`] when the positions are not of the grid of `renderer`.
pub fn render_images(renderer: &Arc<Renderer>, positions: Tensor<3>) -> Result<Tensor<4>, ImageError> {
    let [_, particles, axes] = positions.dims();
    expect_len("positions: axes", 3, axes)?;
    expect_len("positions: particles", renderer.positions_len() / 3, particles)?;
    Ok(run(positions, renderer.clone()))
}

/// Augmented pictures `[batch, channels, 64, 64]`, differentiable in the pictures when their device is.
///
/// # Errors
/// [`ImageError::Size`] when the shape is not that of `augmentations`.
pub fn augment_images(augmentations: &Arc<AugmentBatch>, images: Tensor<4>) -> Result<Tensor<4>, ImageError> {
    let [batch, channels, rows, columns] = images.dims();
    expect_len("pictures", augmentations.len(), batch)?;
    expect_len("pictures: channels", augmentations.channels().len(), channels)?;
    expect_len("pictures: rows", SIDE, rows)?;
    expect_len("pictures: columns", SIDE, columns)?;
    Ok(run(images, augmentations.clone()))
}

fn run<const D: usize>(input: Tensor<D>, operation: Arc<dyn HostOperation>) -> Tensor<4> {
    Tensor::from_dispatch(Dispatch::host_operation(input.into_dispatch(), operation))
}
