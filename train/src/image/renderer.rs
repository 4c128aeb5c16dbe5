//! The renderer: its settings, and rendering and differentiating one cloth or a batch.

use std::num::NonZero;

use super::parallel::for_each_chunk;
use super::splat::Scratch;
use super::upsample::Axis;
use super::vjp::GradientScratch;
use super::{Channel, ImageError, PIXELS, SIDE, expect_len};

/// The part of the plane z = 0 that the picture shows, in metres. The camera is orthographic, looks along -z, and has x to
/// the right and y up.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Camera {
    /// x of the left border of the picture, m.
    pub left: f64,
    /// x of the right border, m; more than `left`.
    pub right: f64,
    /// y of the lower border, m.
    pub bottom: f64,
    /// y of the upper border, m; more than `bottom`.
    pub top: f64,
}

impl Default for Camera {
    /// For a 1 m x 1 m cloth whose top left particle hangs at the origin, gravity along -y, with room for 20 % of stretch.
    fn default() -> Self {
        Self { left: -0.25, right: 1.25, bottom: -1.35, top: 0.15 }
    }
}

/// Settings of the [`Renderer`].
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RenderConfig {
    /// What the camera sees.
    pub camera: Camera,
    /// The channels of a picture, in this order; at least one, none twice.
    pub channels: Vec<Channel>,
    /// Points per side at which the surface is sampled, 8 to 512. About 1.3 per pixel that the cloth spans is enough.
    pub samples: usize,
    /// Checks along each side of the cloth (half of them light), above 0 and at most 64.
    pub checks: f64,
    /// Depth over which a point fades behind another, m, 0.001 to 1.
    pub depth_softness_m: f64,
    /// Direction to the light; its length does not matter.
    pub light: [f64; 3],
    /// Share of the light that is there whatever the direction, 0 to 1.
    pub ambient: f64,
}

impl Default for RenderConfig {
    /// All three channels, 80 samples, 8 checks, 2 cm of softness, light from the upper right front.
    fn default() -> Self {
        Self {
            camera: Camera::default(),
            channels: vec![Channel::Shading, Channel::Checker, Channel::Silhouette],
            samples: 80,
            checks: 8.0,
            depth_softness_m: 0.02,
            light: [0.5, 0.4, 0.77],
            ambient: 0.25,
        }
    }
}

impl RenderConfig {
    fn check(&self) -> Result<(), ImageError> {
        let Camera { left, right, bottom, top } = self.camera;
        let light = self.light.iter().map(|x| x * x).sum::<f64>();
        let twice = self.channels.iter().enumerate().any(|(i, c)| self.channels[..i].contains(c));
        let rules: [(bool, &str, &str); 7] = [
            (
                [left, right, bottom, top].iter().all(|x| x.abs() < 1e6) && right - left > 1e-3 && top - bottom > 1e-3,
                "camera",
                "finite, with right > left and top > bottom",
            ),
            (!self.channels.is_empty() && !twice, "channels", "one or more, none twice"),
            ((8..=512).contains(&self.samples), "samples", "8 to 512"),
            (self.checks > 0.0 && self.checks <= 64.0, "checks", "above 0 and at most 64"),
            ((0.001..=1.0).contains(&self.depth_softness_m), "depth_softness_m", "0.001 to 1"),
            (light > 1e-12 && light < 1e12, "light", "a finite direction, not zero"),
            ((0.0..=1.0).contains(&self.ambient), "ambient", "0 to 1"),
        ];
        match rules.into_iter().find(|(good, ..)| !good) {
            Some((_, name, allowed)) => Err(ImageError::Setting { name, allowed }),
            None => Ok(()),
        }
    }
}

/// Renders cloths of one grid size. Immutable; share it by reference or `Arc`.
///
/// Positions are `[rows * columns * 3]` in metres, particle `row * columns + column`, row 0 at the top.
/// Sums are f64 inside, in a fixed order: the same positions give the same bytes whatever the number of threads.
#[derive(Debug)]
pub struct Renderer {
    pub(super) config: RenderConfig,
    rows: usize,
    columns: usize,
    /// Samples along u (columns) and v (rows).
    pub(super) axis_u: Axis,
    pub(super) axis_v: Axis,
    /// Unit vector to the light.
    pub(super) light: [f64; 3],
    /// Brightness of the checker at the samples, `[samples][samples]`, in `[0.1, 1]`.
    pub(super) checker: Vec<f64>,
    /// Pixels per metre, along x and y.
    pub(super) scale: [f64; 2],
}

impl Renderer {
    /// A renderer for cloths of `rows` x `columns` particles (2 to 4096 each).
    ///
    /// # Errors
    /// [`ImageError::Setting`] names the setting that is out of range.
    pub fn new(config: RenderConfig, rows: usize, columns: usize) -> Result<Self, ImageError> {
        config.check()?;
        for (name, n) in [("rows", rows), ("columns", columns)] {
            if !(2..=4096).contains(&n) {
                return Err(ImageError::Setting { name, allowed: "2 to 4096" });
            }
        }
        let length = config.light.iter().map(|x| x * x).sum::<f64>().sqrt();
        let wave: Vec<f64> = (0..config.samples)
            .map(|i| (std::f64::consts::PI * config.checks * (i as f64 + 0.5) / config.samples as f64).sin())
            .collect();
        // tanh keeps the borders between the checks soft enough to be sampled
        let checker = wave.iter().flat_map(|v| wave.iter().map(move |u| 0.55 + 0.45 * (4.0 * u * v).tanh())).collect();
        let camera = &config.camera;
        Ok(Self {
            axis_u: Axis::new(columns, config.samples),
            axis_v: Axis::new(rows, config.samples),
            light: config.light.map(|x| x / length),
            checker,
            scale: [SIDE as f64 / (camera.right - camera.left), SIDE as f64 / (camera.top - camera.bottom)],
            rows,
            columns,
            config,
        })
    }

    /// The settings it was made with.
    pub fn config(&self) -> &RenderConfig {
        &self.config
    }

    /// Rows and columns of the grid.
    pub fn grid(&self) -> (usize, usize) {
        (self.rows, self.columns)
    }

    /// Values of one cloth: `rows * columns * 3`.
    pub fn positions_len(&self) -> usize {
        self.rows * self.columns * 3
    }

    /// Values of one picture: `channels * SIDE * SIDE`.
    pub fn image_len(&self) -> usize {
        self.config.channels.len() * PIXELS
    }

    /// The picture of one cloth.
    ///
    /// # Errors
    /// [`ImageError::Size`], or [`ImageError::NotFinite`] with the index of the first bad value.
    pub fn render(&self, positions: &[f32]) -> Result<Vec<f32>, ImageError> {
        expect_len("positions", self.positions_len(), positions.len())?;
        self.render_batch(positions, NonZero::<usize>::MIN)
    }

    /// The pictures of `positions.len() / positions_len()` cloths, on at most `threads` threads.
    ///
    /// # Errors
    /// As [`Renderer::render`].
    pub fn render_batch(&self, positions: &[f32], threads: NonZero<usize>) -> Result<Vec<f32>, ImageError> {
        self.check_positions(positions)?;
        if let Some(index) = positions.iter().position(|x| !x.is_finite()) {
            return Err(ImageError::NotFinite { name: "positions", index });
        }
        Ok(self.render_unchecked(positions, threads))
    }

    /// The vector-Jacobian product: `gradient` is d loss / d picture of the batch, the answer d loss / d positions.
    ///
    /// # Errors
    /// As [`Renderer::render`]; the gradient need not be finite.
    pub fn vjp_batch(
        &self,
        positions: &[f32],
        gradient: &[f32],
        threads: NonZero<usize>,
    ) -> Result<Vec<f32>, ImageError> {
        self.check_positions(positions)?;
        expect_len("gradient", positions.len() / self.positions_len() * self.image_len(), gradient.len())?;
        if let Some(index) = positions.iter().position(|x| !x.is_finite()) {
            return Err(ImageError::NotFinite { name: "positions", index });
        }
        Ok(self.vjp_unchecked(positions, gradient, threads))
    }

    /// Whether the length is a whole number of cloths.
    fn check_positions(&self, positions: &[f32]) -> Result<(), ImageError> {
        let cloths = positions.len().div_ceil(self.positions_len()).max(1);
        expect_len("positions", cloths * self.positions_len(), positions.len())
    }

    /// [`Renderer::render_batch`] without checks; a sample with a value that is not finite is left out.
    pub(super) fn render_unchecked(&self, positions: &[f32], threads: NonZero<usize>) -> Vec<f32> {
        let n = self.positions_len();
        let mut images = vec![0.0f32; positions.len() / n * self.image_len()];
        for_each_chunk(
            &mut images,
            self.image_len(),
            threads,
            || (Scratch::default(), vec![0.0; n], vec![0.0; self.image_len()]),
            |(scratch, cloth, image), i, out| {
                widen(&positions[i * n..(i + 1) * n], cloth);
                self.splat(cloth, scratch);
                self.compose(scratch, image);
                narrow(image, out);
            },
        );
        images
    }

    /// [`Renderer::vjp_batch`] without checks.
    pub(super) fn vjp_unchecked(&self, positions: &[f32], gradient: &[f32], threads: NonZero<usize>) -> Vec<f32> {
        let (n, m) = (self.positions_len(), self.image_len());
        let mut answer = vec![0.0f32; positions.len()];
        for_each_chunk(
            &mut answer,
            n,
            threads,
            || (GradientScratch::default(), vec![0.0; n], vec![0.0; m], vec![0.0; n]),
            |(scratch, cloth, by_image, by_position), i, out| {
                widen(&positions[i * n..(i + 1) * n], cloth);
                widen(&gradient[i * m..(i + 1) * m], by_image);
                self.vjp(cloth, by_image, scratch, by_position);
                narrow(by_position, out);
            },
        );
        answer
    }
}

fn widen(from: &[f32], to: &mut [f64]) {
    for (to, from) in to.iter_mut().zip(from) {
        *to = f64::from(*from);
    }
}

fn narrow(from: &[f64], to: &mut [f32]) {
    for (to, from) in to.iter_mut().zip(from) {
        *to = *from as f32;
    }
}
