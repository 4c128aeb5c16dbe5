//! What the pictures show.

use std::num::NonZero;

use super::super::{ImageError, PIXELS, SIDE};
use super::*;

fn silhouette_area(rows: usize, columns: usize, position: impl Fn(f64, f64) -> [f64; 3]) -> f64 {
    let renderer = renderer(&[Channel::Silhouette], rows, columns);
    let image = renderer.render(&narrow(&cloth(rows, columns, position))).unwrap();
    area(&renderer.config().camera, &image)
}

#[test]
fn the_silhouette_of_a_flat_sheet_has_its_area() {
    let cases: [(f64, f64); 5] = [(1.0, 1.0), (1.2, 1.15), (0.5, 1.0), (1.03, 0.7), (0.31, 0.42)];
    for (width, height) in cases {
        for n in [2, 16, 32] {
            let found = silhouette_area(n, n, |u, v| [width * u, -height * v, 0.0]);
            let error = found / (width * height) - 1.0;
            println!("{width} x {height} m, {n} x {n}: {found:.4} m^2, {:+.2} %", 100.0 * error);
            assert!(error.abs() < 0.02, "{width} x {height}: {found}");
        }
    }
}

#[test]
fn a_sheet_turned_away_or_off_the_pixels_shows_its_projected_area() {
    for degrees in [30.0f64, 60.0, 75.0] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let found = silhouette_area(16, 16, |u, v| [0.5 + (u - 0.5) * cos, -v, (u - 0.5) * sin]);
        assert!((found / cos - 1.0).abs() < 0.02, "{degrees}: {found}");
    }
    let (sin, cos) = 0.5f64.sin_cos();
    let turn = |u: f64, v: f64| {
        [0.5 + 0.9 * (cos * (u - 0.5) - sin * (v - 0.5)), -0.6 - 0.9 * (sin * (u - 0.5) + cos * (v - 0.5)), 0.0]
    };
    let found = silhouette_area(16, 16, turn);
    assert!((found / 0.81 - 1.0).abs() < 0.02, "{found}");
}

#[test]
fn a_cloth_folded_in_two_has_no_hole_and_half_the_area() {
    // folded at u = 1/2, the right half behind the left
    let found =
        silhouette_area(32, 33, |u, v| [0.2 + if u < 0.5 { u } else { 1.0 - u }, -v, if u < 0.5 { 0.0 } else { -0.1 }]);
    assert!((found / 0.5 - 1.0).abs() < 0.06, "{found}");
}

#[test]
fn rows_go_down_and_columns_to_the_right() {
    let renderer = renderer(&[Channel::Silhouette], 4, 4);
    // the upper left quarter of the cloth's place
    let image = renderer.render(&narrow(&cloth(4, 4, |u, v| [0.4 * u, -0.4 * v, 0.0]))).unwrap();
    let at = |x: f64, y: f64| {
        let camera = &renderer.config().camera;
        let column = (x - camera.left) / (camera.right - camera.left) * SIDE as f64;
        let row = (camera.top - y) / (camera.top - camera.bottom) * SIDE as f64;
        image[row as usize * SIDE + column as usize]
    };
    assert_eq!(
        [at(0.2, -0.2), at(0.8, -0.2), at(0.2, -0.8), at(-0.2, -0.2), at(0.2, 0.1)],
        [1.0, -1.0, -1.0, -1.0, -1.0]
    );
}

#[test]
fn values_lie_in_their_range_and_the_background_is_black() {
    let renderer = renderer(&ALL, 12, 12);
    let wild = |u: f64, v: f64| [3.0 * (40.0 * u).sin(), 2.0 * (31.0 * v + u).cos(), 5.0 * (17.0 * u * v).sin()];
    for positions in [cloth(12, 12, flat), cloth(12, 12, folded), cloth(12, 12, sagging), cloth(12, 12, wild)] {
        let image = renderer.render(&narrow(&positions)).unwrap();
        assert!(image.iter().all(|v| (-1.0..=1.0).contains(v)));
    }
    let image = renderer.render(&narrow(&cloth(12, 12, sagging))).unwrap();
    for channel in image.chunks_exact(PIXELS) {
        assert_eq!([channel[0], channel[SIDE - 1], channel[PIXELS - 1]], [-1.0; 3]);
    }
}

#[test]
fn light_follows_the_wrapped_cosine_and_both_sides_are_lit_alike() {
    let renderer = renderer(&[Channel::Shading], 8, 8);
    let middle = |positions: Vec<f64>| renderer.render(&narrow(&positions)).unwrap()[30 * SIDE + 32];
    let light = [0.5f64, 0.4, 0.77];
    let length = light.iter().map(|x| x * x).sum::<f64>().sqrt();
    // the flat sheet faces the camera: cosine = light_z
    let half = 0.5 * (1.0 + light[2] / length);
    let expected = 2.0 * (0.25 + 0.75 * half * half) - 1.0;
    assert!((f64::from(middle(cloth(8, 8, flat))) - expected).abs() < 2e-3);
    // turned round, its back is seen
    assert!((f64::from(middle(cloth(8, 8, |u, v| [1.0 - u, -v, 0.0]))) - expected).abs() < 2e-3);
    // turned to the light it is brighter, away darker
    let tilt = |slope: f64| middle(cloth(8, 8, move |u, v| [u, -v, slope * u]));
    assert!(tilt(-0.5) > tilt(0.0) && tilt(0.0) > tilt(0.5));
}

#[test]
fn the_nearest_layer_is_seen() {
    // two layers 10 cm apart, the checker of the nearer one shifted by its folding
    let renderer = renderer(&[Channel::Checker], 9, 17);
    let near =
        cloth(9, 17, |u, v| [if u < 0.5 { 2.0 * u } else { 2.0 - 2.0 * u }, -v, if u < 0.5 { 0.1 } else { 0.0 }]);
    let far =
        cloth(9, 17, |u, v| [if u < 0.5 { 2.0 * u } else { 2.0 - 2.0 * u }, -v, if u < 0.5 { 0.1 } else { -2.0 }]);
    let (a, b) = (renderer.render(&narrow(&near)).unwrap(), renderer.render(&narrow(&far)).unwrap());
    for row in 20..40 {
        for column in 15..40 {
            assert!((a[row * SIDE + column] - b[row * SIDE + column]).abs() < 0.02);
        }
    }
}

#[test]
fn the_bytes_do_not_depend_on_the_number_of_threads() {
    let renderer = renderer(&ALL, 10, 11);
    let batch: Vec<f32> =
        (0..7).flat_map(|k| narrow(&cloth(10, 11, |u, v| folded(u + 0.03 * f64::from(k), v)))).collect();
    let gradient: Vec<f32> = (0..7 * renderer.image_len()).map(|i| ((i * 7919) % 101) as f32 * 0.01 - 0.5).collect();
    let threads = |n| NonZero::new(n).unwrap();
    let image = renderer.render_batch(&batch, threads(1)).unwrap();
    let by_position = renderer.vjp_batch(&batch, &gradient, threads(1)).unwrap();
    for n in [2, 3, 4, 7, 16] {
        assert!(image == renderer.render_batch(&batch, threads(n)).unwrap());
        assert!(by_position == renderer.vjp_batch(&batch, &gradient, threads(n)).unwrap());
    }
    let alone = renderer.render(&batch[3 * renderer.positions_len()..4 * renderer.positions_len()]).unwrap();
    assert!(alone == image[3 * renderer.image_len()..4 * renderer.image_len()]);
}

#[test]
fn mistakes_are_named() {
    let renderer = renderer(&ALL, 4, 5);
    assert!(matches!(renderer.render(&[0.0; 59]), Err(ImageError::Size { expected: 60, found: 59, .. })));
    assert!(matches!(renderer.render_batch(&[], NonZero::<usize>::MIN), Err(ImageError::Size { .. })));
    let mut bad = [0.0f32; 60];
    bad[17] = f32::INFINITY;
    assert_eq!(renderer.render(&bad), Err(ImageError::NotFinite { name: "positions", index: 17 }));
    let name = |change: fn(&mut RenderConfig)| {
        let mut config = RenderConfig::default();
        change(&mut config);
        match Renderer::new(config, 4, 4) {
            Err(ImageError::Setting { name, .. }) => name,
            other => panic!("{other:?}"),
        }
    };
    assert_eq!(name(|c| c.channels.clear()), "channels");
    assert_eq!(name(|c| c.channels = vec![Channel::Shading; 2]), "channels");
    assert_eq!(name(|c| c.camera.right = f64::NAN), "camera");
    assert_eq!(name(|c| c.camera.top = -2.0), "camera");
    assert_eq!(name(|c| c.samples = 0), "samples");
    assert_eq!(name(|c| c.depth_softness_m = 0.0), "depth_softness_m");
    assert_eq!(name(|c| c.light = [0.0; 3]), "light");
    assert_eq!(name(|c| c.ambient = f64::NAN), "ambient");
    assert_eq!(name(|c| c.checks = 0.0), "checks");
    assert!(matches!(Renderer::new(RenderConfig::default(), 1, 4), Err(ImageError::Setting { name: "rows", .. })));
}
