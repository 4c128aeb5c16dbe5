//! Tests of the renderer and the augmentations as a whole.

mod augmentation;
mod gradient;
mod operation;
mod picture;

use super::{Camera, Channel, RenderConfig, Renderer};

/// A cloth `[rows * columns * 3]` by a function of u and v in `[0, 1]`.
fn cloth(rows: usize, columns: usize, position: impl Fn(f64, f64) -> [f64; 3]) -> Vec<f64> {
    (0..rows * columns)
        .flat_map(|i| position((i % columns) as f64 / (columns - 1) as f64, (i / columns) as f64 / (rows - 1) as f64))
        .collect()
}

/// A flat 1 m cloth, top left particle at the origin.
fn flat(u: f64, v: f64) -> [f64; 3] {
    [u, -v, 0.0]
}

/// A cloth with folds in two directions that overhang each other here and there.
fn folded(u: f64, v: f64) -> [f64; 3] {
    let wave = (9.0 * u + 2.0 * v).sin();
    [
        u + 0.09 * v * (18.0 * u + 1.0).sin(),
        -v - 0.05 * (7.0 * u + 3.0 * v).cos(),
        0.12 * wave * (0.3 + v) + 0.04 * (13.0 * v).sin(),
    ]
}

/// A cloth that hangs from its two upper corners, not from a simulation.
fn sagging(u: f64, v: f64) -> [f64; 3] {
    let s = 2.0 * u - 1.0;
    let sag = 0.35 * (1.0 - s * s) * (1.0 - v) * (1.0 - 0.6 * v);
    [0.5 + 0.5 * s * (1.0 - 0.18 * v), -1.08 * v - sag, 0.05 * (6.0 * s).cos() * v + 0.03 * (14.0 * s).sin() * v]
}

fn narrow(values: &[f64]) -> Vec<f32> {
    values.iter().map(|x| *x as f32).collect()
}

fn renderer(channels: &[Channel], rows: usize, columns: usize) -> Renderer {
    Renderer::new(RenderConfig { channels: channels.to_vec(), ..RenderConfig::default() }, rows, columns).unwrap()
}

const ALL: [Channel; 3] = [Channel::Shading, Channel::Checker, Channel::Silhouette];

/// Area of the cloth in a silhouette, m^2.
fn area(camera: &Camera, silhouette: &[f32]) -> f64 {
    let pixel = (camera.right - camera.left) * (camera.top - camera.bottom) / super::PIXELS as f64;
    silhouette.iter().map(|v| 0.5 * (f64::from(*v) + 1.0)).sum::<f64>() * pixel
}
