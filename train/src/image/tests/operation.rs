//! The burn operations: values, gradients, shapes.

use std::num::NonZero;
use std::sync::Arc;

use burn::tensor::{Device, Tensor, TensorData};

use super::super::{AugmentBatch, AugmentConfig, ImageError, PIXELS, augment_images, render_images};
use super::*;

fn values<const D: usize>(tensor: Tensor<D>) -> Vec<f32> {
    tensor.into_data().try_into_vec::<f32>().unwrap()
}

fn batch() -> Vec<f32> {
    [narrow(&cloth(6, 7, folded)), narrow(&cloth(6, 7, sagging))].concat()
}

#[test]
fn the_operation_renders_and_its_gradient_is_the_vjp() {
    let renderer = Arc::new(renderer(&ALL, 6, 7));
    let device = Device::flex().autodiff();
    let positions = Tensor::<3>::from_data(TensorData::new(batch(), [2, 42, 3]), &device).require_grad();
    let images = render_images(&renderer, positions.clone()).unwrap();
    assert_eq!(images.dims(), [2, 3, 64, 64]);
    let expected = renderer.render_batch(&batch(), NonZero::<usize>::MIN).unwrap();
    assert!(values(images.clone()) == expected);
    // loss = sum of squares: d loss / d picture = 2 picture
    let gradients = images.square().sum().backward();
    let found = values(positions.grad(&gradients).unwrap());
    let twice: Vec<f32> = expected.iter().map(|v| 2.0 * v).collect();
    let wanted = renderer.vjp_batch(&batch(), &twice, NonZero::<usize>::MIN).unwrap();
    assert!(found == wanted);
}

#[test]
fn operations_before_and_after_chain_up() {
    // one number moves both cloths down; the silhouette's centre follows; checked by differences
    let renderer = Arc::new(renderer(&[Channel::Silhouette, Channel::Shading], 6, 7));
    let augmentations =
        Arc::new(AugmentBatch::draw(&AugmentConfig::default(), &renderer.config().channels, 3, 0, 2).unwrap());
    let device = Device::flex().autodiff();
    let base = Tensor::<3>::from_data(TensorData::new(batch(), [2, 42, 3]), &device);
    let down = Tensor::<3>::from_data(TensorData::new(vec![0.1f32, -1.0, 0.05], [1, 1, 3]), &device);
    let ramp: Vec<f32> = (0..PIXELS).map(|i| (i / 64) as f32 * 0.01 + ((i % 64) as f32 * 0.2).sin()).collect();
    let ramp = Tensor::<4>::from_data(TensorData::new(ramp, [1, 1, 64, 64]), &device);
    let loss = |shift: Tensor<1>| {
        let positions = base.clone() + down.clone() * shift.reshape([1, 1, 1]);
        let images = render_images(&renderer, positions).unwrap();
        (augment_images(&augmentations, images).unwrap() * ramp.clone()).sum()
    };
    let at = |x: f32| Tensor::<1>::from_data(TensorData::new(vec![x], [1]), &device);
    let shift = at(0.03).require_grad();
    let found = values(shift.grad(&loss(shift.clone()).backward()).unwrap())[0];
    let step = 2e-3;
    let difference = (values(loss(at(0.03 + step)))[0] - values(loss(at(0.03 - step)))[0]) / (2.0 * step);
    assert!((found - difference).abs() < 0.02 * difference.abs(), "{found} {difference}");
}

#[test]
fn without_autodiff_the_values_are_the_same() {
    let renderer = Arc::new(renderer(&ALL, 6, 7));
    let positions = Tensor::<3>::from_data(TensorData::new(batch(), [2, 42, 3]), &Device::flex());
    let images = render_images(&renderer, positions).unwrap();
    assert!(values(images) == renderer.render_batch(&batch(), NonZero::<usize>::MIN).unwrap());
}

#[test]
fn wrong_shapes_are_named_and_bad_positions_are_left_out() {
    let renderer = Arc::new(renderer(&ALL, 6, 7));
    let device = Device::flex().autodiff();
    let wrong = Tensor::<3>::zeros([2, 41, 3], &device);
    assert!(matches!(render_images(&renderer, wrong), Err(ImageError::Size { expected: 42, found: 41, .. })));
    let augmentations = Arc::new(AugmentBatch::draw(&AugmentConfig::default(), &ALL, 0, 0, 2).unwrap());
    let wrong = Tensor::<4>::zeros([2, 3, 64, 32], &device);
    assert!(matches!(augment_images(&augmentations, wrong), Err(ImageError::Size { found: 32, .. })));

    let mut blown = batch();
    blown[3] = f32::NAN;
    blown[130] = f32::INFINITY;
    let positions = Tensor::<3>::from_data(TensorData::new(blown, [2, 42, 3]), &device).require_grad();
    let images = render_images(&renderer, positions.clone()).unwrap();
    assert!(values(images.clone()).iter().all(|v| (-1.0..=1.0).contains(v)));
    let gradient = values(positions.grad(&images.sum().backward()).unwrap());
    assert!(gradient.iter().all(|g| g.is_finite()));
}
