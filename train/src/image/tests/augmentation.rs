//! The augmentations.

use std::num::NonZero;

use super::super::random::Stream;
use super::super::{AugmentBatch, AugmentConfig, Augmentation, ImageError, PIXELS, SIDE};
use super::*;

fn picture() -> Vec<f32> {
    renderer(&ALL, 16, 16).render(&narrow(&cloth(16, 16, sagging))).unwrap()
}

fn apply(config: &AugmentConfig, seed: u64, index: u64, image: &[f32]) -> Vec<f32> {
    Augmentation::draw(config, seed, index).unwrap().apply(&ALL, image).unwrap()
}

fn rms(a: &[f32], b: &[f32]) -> f64 {
    (a.iter().zip(b).map(|(a, b)| f64::from(a - b).powi(2)).sum::<f64>() / a.len() as f64).sqrt()
}

/// Centre of the light of the silhouette, column and row.
fn centre(image: &[f32]) -> [f64; 2] {
    let (mut sum, mut at) = (0.0, [0.0; 2]);
    for (i, v) in image[2 * PIXELS..].iter().enumerate() {
        let light = f64::from(*v) + 1.0;
        sum += light;
        at[0] += light * (i % SIDE) as f64;
        at[1] += light * (i / SIDE) as f64;
    }
    at.map(|x| x / sum)
}

#[test]
fn no_augmentation_changes_nothing() {
    assert!(apply(&AugmentConfig::none(), 5, 6, &picture()) == picture());
}

#[test]
fn seeds_and_indices_fix_the_result() {
    let (config, image) = (AugmentConfig::default(), picture());
    let first = apply(&config, 1, 0, &image);
    assert!(first == apply(&config, 1, 0, &image));
    for other in [apply(&config, 2, 0, &image), apply(&config, 1, 1, &image)] {
        assert!(rms(&first, &other) > 0.01);
    }
    assert!(first.iter().all(|v| (-1.0..=1.0).contains(v)));
    let batch: Vec<f32> = std::iter::repeat_n(image, 5).flatten().collect();
    let augmentations = AugmentBatch::draw(&config, &ALL, 1, 0, 5).unwrap();
    let one = augmentations.apply(&batch, NonZero::<usize>::MIN).unwrap();
    assert!(one[..first.len()] == first);
    assert!(one == augmentations.apply(&batch, NonZero::new(3).unwrap()).unwrap());
}

#[test]
fn a_flip_mirrors_the_columns() {
    let config = AugmentConfig { flip_probability: 1.0, ..AugmentConfig::none() };
    let image = picture();
    let flipped = apply(&config, 0, 0, &image);
    for (a, b) in image.chunks_exact(SIDE).zip(flipped.chunks_exact(SIDE)) {
        assert!(a.iter().eq(b.iter().rev()));
    }
    let config = AugmentConfig { flip_probability: 0.5, ..AugmentConfig::none() };
    let flips = (0..300).filter(|i| apply(&config, 0, *i, &image) != image).count();
    assert!((120..180).contains(&flips), "{flips}");
}

#[test]
fn each_kind_does_what_it_says_and_no_more() {
    let image = picture();
    let area = |image: &[f32]| image[2 * PIXELS..].iter().map(|v| f64::from(*v) + 1.0).sum::<f64>();
    let none = AugmentConfig::none();
    let (mut far, mut turned, mut smallest, mut largest) = (0.0f64, 0.0f64, f64::INFINITY, 0.0f64);
    for index in 0..40 {
        let moved = apply(&AugmentConfig { displacement_px: 4.0, ..none.clone() }, 9, index, &image);
        let (a, b) = (centre(&image), centre(&moved));
        assert!((a[0] - b[0]).abs() < 4.01 && (a[1] - b[1]).abs() < 4.01);
        far = far.max((a[0] - b[0]).abs());

        let scaled = apply(&AugmentConfig { scaling: 0.1, ..none.clone() }, 9, index, &image);
        let factor = (area(&scaled) / area(&image)).sqrt();
        (smallest, largest) = (smallest.min(factor), largest.max(factor));

        let rotated = apply(&AugmentConfig { rotation_deg: 10.0, ..none.clone() }, 9, index, &image);
        assert!((area(&rotated) / area(&image) - 1.0).abs() < 0.01);
        turned = turned.max(rms(&rotated, &image));

        let distorted = apply(&AugmentConfig { distortion_px: 2.0, ..none.clone() }, 9, index, &image);
        assert!((area(&distorted) / area(&image) - 1.0).abs() < 0.15);
        assert!(rms(&distorted, &image) > 0.01);

        let bright = apply(&AugmentConfig { brightness: 0.2, ..none.clone() }, 9, index, &image);
        assert!(bright[2 * PIXELS..] == image[2 * PIXELS..]);
        let gain = (f64::from(bright[30 * SIDE + 32]) + 1.0) / (f64::from(image[30 * SIDE + 32]) + 1.0);
        assert!((0.8..=1.2).contains(&gain));
        assert_eq!(bright[0], -1.0);
    }
    assert!(far > 3.0 && turned > 0.05);
    assert!((0.9..0.93).contains(&smallest) && (1.07..1.11).contains(&largest), "{smallest} {largest}");
}

#[test]
fn the_noise_is_white_and_as_strong_as_asked() {
    let config = AugmentConfig { noise: [0.03, 0.03], ..AugmentConfig::none() };
    let grey = vec![0.0f32; 3 * PIXELS];
    let noisy = apply(&config, 4, 2, &grey);
    let mean = noisy.iter().map(|v| f64::from(*v)).sum::<f64>() / noisy.len() as f64;
    // 3 % of the range 2
    assert!((rms(&noisy, &grey) - 0.06).abs() < 0.002 && mean.abs() < 0.002);
    let neighbours: f64 = noisy.windows(2).map(|w| f64::from(w[0]) * f64::from(w[1])).sum();
    assert!((neighbours / noisy.len() as f64 / 0.0036).abs() < 0.03);
    // PSNR of 3 % noise: -20 log10(0.03) = 30.5 dB
    assert!((super::super::psnr(&grey, &noisy).unwrap() - 30.46).abs() < 0.3);
    for index in 0..50 {
        let config = AugmentConfig { noise: [0.01, 0.05], ..AugmentConfig::none() };
        let strength = rms(&apply(&config, 4, index, &grey), &grey) / 2.0;
        assert!((0.0095..0.0525).contains(&strength), "{strength}");
    }
}

#[test]
fn the_vjp_is_the_derivative() {
    let augmentation = Augmentation::draw(&AugmentConfig::default(), 12, 34).unwrap();
    let mut stream = Stream::new(1, 2);
    let image = picture();
    let mut random = |n: usize| -> Vec<f32> { (0..n).map(|_| stream.range(-1.0, 1.0) as f32).collect() };
    let (direction, gradient) = (random(image.len()), random(image.len()));
    let step = 1e-3f32;
    let moved = |sign: f32| -> Vec<f32> {
        let moved: Vec<f32> = image.iter().zip(&direction).map(|(v, d)| v + sign * step * d).collect();
        augmentation.apply(&ALL, &moved).unwrap()
    };
    // values that the clamp lets go on one side only are left out of the comparison
    let (up, down, middle) = (moved(1.0), moved(-1.0), augmentation.apply(&ALL, &image).unwrap());
    let free: Vec<bool> = (0..image.len()).map(|i| [up[i], down[i], middle[i]].iter().all(|v| v.abs() < 1.0)).collect();
    let difference: f64 = (0..image.len())
        .filter(|i| free[*i])
        .map(|i| f64::from(gradient[i]) * f64::from(up[i] - down[i]) / f64::from(2.0 * step))
        .sum();
    let gradient: Vec<f32> = gradient.iter().zip(&free).map(|(g, free)| if *free { *g } else { 0.0 }).collect();
    let found: f64 = augmentation
        .vjp(&ALL, &image, &gradient)
        .unwrap()
        .iter()
        .zip(&direction)
        .map(|(g, d)| f64::from(*g) * f64::from(*d))
        .sum();
    assert!((found - difference).abs() < 1e-3 * difference.abs().max(1.0), "{found} {difference}");
}

#[test]
fn mistakes_are_named() {
    let name = |change: fn(&mut AugmentConfig)| {
        let mut config = AugmentConfig::default();
        change(&mut config);
        match Augmentation::draw(&config, 0, 0) {
            Err(ImageError::Setting { name, .. }) => name,
            other => panic!("{other:?}"),
        }
    };
    assert_eq!(name(|c| c.flip_probability = 1.5), "flip_probability");
    assert_eq!(name(|c| c.noise = [0.05, 0.01]), "noise");
    assert_eq!(name(|c| c.rotation_deg = f64::NAN), "rotation_deg");
    assert_eq!(name(|c| c.scaling = -0.1), "scaling");
    let augmentation = Augmentation::draw(&AugmentConfig::default(), 0, 0).unwrap();
    assert!(matches!(augmentation.apply(&ALL, &[0.0; PIXELS]), Err(ImageError::Size { .. })));
    assert!(matches!(augmentation.vjp(&ALL, &picture(), &[0.0; 3]), Err(ImageError::Size { .. })));
}
