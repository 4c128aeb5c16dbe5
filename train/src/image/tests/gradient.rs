//! The vector-Jacobian product against central differences of the forward pass, in f64.

use super::super::random::Stream;
use super::super::splat::Scratch;
use super::super::vjp::GradientScratch;
use super::*;

/// A random linear functional of the picture.
fn loss(renderer: &Renderer, positions: &[f64], weights: &[f64]) -> f64 {
    let (mut scratch, mut image) = (Scratch::default(), vec![0.0; renderer.image_len()]);
    renderer.splat(positions, &mut scratch);
    renderer.compose(&scratch, &mut image);
    image.iter().zip(weights).map(|(v, w)| v * w).sum()
}

/// The largest difference, relative to the larger of the two and to 1e-3 of the largest gradient.
fn worst(renderer: &Renderer, positions: &[f64], seed: u64) -> f64 {
    let mut stream = Stream::new(seed, 0);
    let weights: Vec<f64> = (0..renderer.image_len()).map(|_| stream.range(-1.0, 1.0)).collect();
    let mut gradient = vec![f64::NAN; positions.len()];
    renderer.vjp(positions, &weights, &mut GradientScratch::default(), &mut gradient);
    let largest = gradient.iter().fold(0.0f64, |a, g| a.max(g.abs()));
    assert!(largest > 1e-3);
    let step = 1e-6;
    let mut worst = 0.0f64;
    for i in 0..positions.len() {
        let mut moved = positions.to_vec();
        moved[i] = positions[i] + step;
        let up = loss(renderer, &moved, &weights);
        moved[i] = positions[i] - step;
        let down = loss(renderer, &moved, &weights);
        let difference = (up - down) / (2.0 * step);
        worst =
            worst.max((difference - gradient[i]).abs() / difference.abs().max(gradient[i].abs()).max(1e-3 * largest));
    }
    worst
}

#[test]
fn the_gradient_is_that_of_central_differences_for_every_channel() {
    for (channel, seed) in ALL.into_iter().zip(1..) {
        let worst = worst(&renderer(&[channel], 7, 6), &cloth(7, 6, folded), seed);
        println!("{channel:?}: {worst:.1e}");
        assert!(worst < 1e-4, "{channel:?}: {worst:e}");
    }
}

#[test]
fn the_gradient_is_that_of_central_differences_for_small_grids_and_any_order_of_channels() {
    let order = [Channel::Silhouette, Channel::Checker, Channel::Shading];
    for (rows, columns, seed) in [(2, 2, 4), (3, 5, 5), (9, 4, 6)] {
        let worst = worst(&renderer(&order, rows, columns), &cloth(rows, columns, sagging), seed);
        assert!(worst < 1e-4, "{rows} x {columns}: {worst:e}");
    }
}

#[test]
fn the_gradient_holds_for_a_cloth_that_leaves_the_picture_and_one_far_behind_itself() {
    let leaves = cloth(6, 6, |u, v| [1.7 * u - 0.6, -1.9 * v + 0.4, 0.2 * (5.0 * u * v).sin()]);
    let worst_leaving = worst(&renderer(&ALL, 6, 6), &leaves, 7);
    assert!(worst_leaving < 1e-4, "{worst_leaving:e}");
    // 8 m deep: 400 times the softness
    let deep = cloth(6, 6, |u, v| [u, -v, -8.0 * v + 0.1 * (4.0 * u).sin()]);
    let worst_deep = worst(&renderer(&ALL, 6, 6), &deep, 8);
    assert!(worst_deep < 1e-4, "{worst_deep:e}");
}

#[test]
fn the_gradient_of_a_point_like_cloth_is_finite() {
    let renderer = renderer(&ALL, 4, 4);
    for position in [[0.5, -0.5, 0.0], [1e30, 0.0, 0.0], [0.0, 0.0, 1e30]] {
        let mut gradient = vec![f64::NAN; 48];
        let point = cloth(4, 4, |_, _| position);
        renderer.vjp(&point, &vec![1.0; renderer.image_len()], &mut GradientScratch::default(), &mut gradient);
        assert!(gradient.iter().all(|g| g.is_finite()), "{position:?}");
    }
}
