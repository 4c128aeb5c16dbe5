//! Augmentations of pictures: the six of the paper (section VI.A: flipping left and right, local distortion, rotation,
//! displacement, scaling, brightness) and white Gaussian noise.
//!
//! The five of geometry are one bilinear resampling, so that a picture is blurred once, and what comes in from outside is
//! background. With the brightness it is linear up to the clamp to `[-1, 1]`: generated pictures can be augmented within the
//! graph as well ([`super::augment_images`]).

use super::random::Stream;
use super::{Channel, ImageError, PIXELS, SIDE, expect_len};

/// How strongly pictures are augmented. Zero switches an augmentation off.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AugmentConfig {
    /// Probability of a flip left to right, 0 to 1.
    pub flip_probability: f64,
    /// Largest local distortion, pixels, 0 to 8: a random displacement of the knots of a 5 x 5 grid, linear between.
    pub distortion_px: f64,
    /// Largest rotation about the centre, either way, degrees, 0 to 180.
    pub rotation_deg: f64,
    /// Largest displacement along either axis, pixels, 0 to 32.
    pub displacement_px: f64,
    /// Largest enlargement minus one, 0 to 1: factors are drawn from `1 / (1 + s)` to `1 + s`, evenly in their logarithm.
    pub scaling: f64,
    /// Largest relative change of brightness, 0 to 1. Black stays black; silhouettes are left as they are.
    pub brightness: f64,
    /// Smallest and largest standard deviation of the noise as a share of the range of values (2), 0 to 0.5.
    pub noise: [f64; 2],
}

impl Default for AugmentConfig {
    /// Half flipped, 1.5 px, 5 degrees, 3 px, 8 %, 15 %, noise 1 to 5 % (the paper says 1 to 6 % in section VI.A, but
    /// calls 6 % "not included in the training data" in section VI.C).
    fn default() -> Self {
        Self {
            flip_probability: 0.5,
            distortion_px: 1.5,
            rotation_deg: 5.0,
            displacement_px: 3.0,
            scaling: 0.08,
            brightness: 0.15,
            noise: [0.01, 0.05],
        }
    }
}

impl AugmentConfig {
    /// No augmentation at all.
    pub fn none() -> Self {
        Self {
            flip_probability: 0.0,
            distortion_px: 0.0,
            rotation_deg: 0.0,
            displacement_px: 0.0,
            scaling: 0.0,
            brightness: 0.0,
            noise: [0.0; 2],
        }
    }

    /// # Errors
    /// [`ImageError::Setting`] names the setting that is out of range.
    pub fn check(&self) -> Result<(), ImageError> {
        let [low, high] = self.noise;
        let rules: [(bool, &str, &str); 7] = [
            ((0.0..=1.0).contains(&self.flip_probability), "flip_probability", "0 to 1"),
            ((0.0..=8.0).contains(&self.distortion_px), "distortion_px", "0 to 8"),
            ((0.0..=180.0).contains(&self.rotation_deg), "rotation_deg", "0 to 180"),
            ((0.0..=32.0).contains(&self.displacement_px), "displacement_px", "0 to 32"),
            ((0.0..=1.0).contains(&self.scaling), "scaling", "0 to 1"),
            ((0.0..=1.0).contains(&self.brightness), "brightness", "0 to 1"),
            (low >= 0.0 && low <= high && high <= 0.5, "noise", "two shares in order, 0 to 0.5"),
        ];
        match rules.into_iter().find(|(good, ..)| !good) {
            Some((_, name, allowed)) => Err(ImageError::Setting { name, allowed }),
            None => Ok(()),
        }
    }
}

/// Knots of the local distortion along each side.
const KNOTS: usize = 5;

/// One drawn augmentation: the same for all channels of a picture but for the noise, which is drawn for every value.
#[derive(Clone, Debug)]
pub struct Augmentation {
    flip: bool,
    /// Displacement of the knots, pixels, `[row][column]`, x and y.
    distortion: [[f64; 2]; KNOTS * KNOTS],
    rotation: f64,
    displacement: [f64; 2],
    scale: f64,
    gain: f64,
    /// Standard deviation, in units of the values.
    noise: f64,
    /// The noise begins here.
    stream: Stream,
}

impl Augmentation {
    /// Augmentation number `index` of `seed`. The same arguments give the same augmentation; switching one kind off or
    /// changing its strength leaves the others as they were.
    ///
    /// # Errors
    /// As [`AugmentConfig::check`].
    pub fn draw(config: &AugmentConfig, seed: u64, index: u64) -> Result<Self, ImageError> {
        config.check()?;
        let mut stream = Stream::new(seed, index);
        let mut within = |strength: f64| strength * stream.range(-1.0, 1.0);
        let distortion = std::array::from_fn(|_| [within(config.distortion_px), within(config.distortion_px)]);
        let rotation = within(config.rotation_deg.to_radians());
        let displacement = [within(config.displacement_px), within(config.displacement_px)];
        let scale = within((1.0 + config.scaling).ln()).exp();
        let gain = 1.0 + within(config.brightness);
        let flip = stream.unit() < config.flip_probability;
        let noise = 2.0 * stream.range(config.noise[0], config.noise[1]);
        Ok(Self { flip, distortion, rotation, displacement, scale, gain, noise, stream })
    }

    /// Where in the picture the pixel at `row`, `column` is taken from: x (column) and y (row), in pixels.
    fn source(&self, row: usize, column: usize, sin: f64, cos: f64) -> [f64; 2] {
        let centre = (SIDE - 1) as f64 / 2.0;
        let knot = |i: usize| {
            let s = i as f64 / (SIDE - 1) as f64 * (KNOTS - 1) as f64;
            let k = (s as usize).min(KNOTS - 2);
            (k, s - k as f64)
        };
        let ((kr, fr), (kc, fc)) = (knot(row), knot(column));
        let local = |axis: usize| {
            let at = |r: usize, c: usize| self.distortion[(kr + r) * KNOTS + kc + c][axis];
            (1.0 - fr) * ((1.0 - fc) * at(0, 0) + fc * at(0, 1)) + fr * ((1.0 - fc) * at(1, 0) + fc * at(1, 1))
        };
        let x = (column as f64 - centre - self.displacement[0]) / self.scale;
        let y = (row as f64 - centre - self.displacement[1]) / self.scale;
        let x_turned = cos * x - sin * y + local(0);
        let y_turned = sin * x + cos * y + local(1);
        [centre + if self.flip { -x_turned } else { x_turned }, centre + y_turned]
    }

    /// For every pixel of the answer, the up to four pixels it is made of, with their weights (0 for those outside).
    fn resampling(&self) -> Vec<[(usize, f64); 4]> {
        let (sin, cos) = self.rotation.sin_cos();
        let mut taps = Vec::with_capacity(PIXELS);
        for row in 0..SIDE {
            for column in 0..SIDE {
                let [x, y] = self.source(row, column, sin, cos);
                let (x0, y0) = (x.floor(), y.floor());
                let (fx, fy) = (x - x0, y - y0);
                let tap = |dx: f64, dy: f64, weight: f64| {
                    let inside = 0.0..SIDE as f64;
                    if inside.contains(&(x0 + dx)) && inside.contains(&(y0 + dy)) {
                        ((y0 + dy) as usize * SIDE + (x0 + dx) as usize, weight)
                    } else {
                        (0, 0.0)
                    }
                };
                taps.push([
                    tap(0.0, 0.0, (1.0 - fx) * (1.0 - fy)),
                    tap(1.0, 0.0, fx * (1.0 - fy)),
                    tap(0.0, 1.0, (1.0 - fx) * fy),
                    tap(1.0, 1.0, fx * fy),
                ]);
            }
        }
        taps
    }

    /// The values before the clamp, given to `each` with their index.
    fn before_clamp(
        &self,
        channels: &[Channel],
        image: &[f32],
        taps: &[[(usize, f64); 4]],
        mut each: impl FnMut(usize, f64),
    ) {
        let mut stream = self.stream.clone();
        let mut pair = None;
        for (k, (channel, plane)) in channels.iter().zip(image.chunks_exact(PIXELS)).enumerate() {
            let gain = self.gain_of(*channel);
            for (i, taps) in taps.iter().enumerate() {
                // + 1: the background counts as nothing
                let light: f64 = taps.iter().map(|(at, weight)| weight * (f64::from(plane[*at]) + 1.0)).sum();
                let noise = pair.take().unwrap_or_else(|| {
                    let [now, next] = stream.gaussians();
                    pair = Some(next);
                    now
                });
                each(k * PIXELS + i, gain * light - 1.0 + self.noise * noise);
            }
        }
    }

    fn gain_of(&self, channel: Channel) -> f64 {
        match channel {
            Channel::Silhouette => 1.0,
            Channel::Shading | Channel::Checker => self.gain,
        }
    }

    /// The augmented picture, in `[-1, 1]`.
    ///
    /// # Errors
    /// [`ImageError::Size`] when `image` is not `channels.len()` planes.
    pub fn apply(&self, channels: &[Channel], image: &[f32]) -> Result<Vec<f32>, ImageError> {
        expect_len("picture", channels.len() * PIXELS, image.len())?;
        let mut out = vec![0.0; image.len()];
        self.apply_unchecked(channels, image, &mut out);
        Ok(out)
    }

    fn apply_unchecked(&self, channels: &[Channel], image: &[f32], out: &mut [f32]) {
        self.before_clamp(channels, image, &self.resampling(), |i, value| out[i] = value.clamp(-1.0, 1.0) as f32);
    }

    /// The vector-Jacobian product of [`Augmentation::apply`]: d loss / d augmented picture to d loss / d picture.
    /// Values that were clamped pass nothing on.
    ///
    /// # Errors
    /// As [`Augmentation::apply`], for both slices.
    pub fn vjp(&self, channels: &[Channel], image: &[f32], gradient: &[f32]) -> Result<Vec<f32>, ImageError> {
        expect_len("picture", channels.len() * PIXELS, image.len())?;
        expect_len("gradient", image.len(), gradient.len())?;
        let mut out = vec![0.0; image.len()];
        self.vjp_unchecked(channels, image, gradient, &mut out);
        Ok(out)
    }

    fn vjp_unchecked(&self, channels: &[Channel], image: &[f32], gradient: &[f32], out: &mut [f32]) {
        let taps = self.resampling();
        let mut sums = vec![0.0f64; image.len()];
        self.before_clamp(channels, image, &taps, |i, value| {
            if value.abs() <= 1.0 {
                let g = f64::from(gradient[i]) * self.gain_of(channels[i / PIXELS]);
                let plane = i - i % PIXELS;
                for (at, weight) in taps[i % PIXELS] {
                    sums[plane + at] += weight * g;
                }
            }
        });
        for (out, sum) in out.iter_mut().zip(sums) {
            *out = sum as f32;
        }
    }
}

/// One augmentation for each picture of a batch.
#[derive(Clone, Debug)]
pub struct AugmentBatch {
    channels: Vec<Channel>,
    each: Vec<Augmentation>,
}

impl AugmentBatch {
    /// Augmentations number `first .. first + count` of `seed`.
    ///
    /// # Errors
    /// As [`AugmentConfig::check`].
    pub fn draw(
        config: &AugmentConfig,
        channels: &[Channel],
        seed: u64,
        first: u64,
        count: usize,
    ) -> Result<Self, ImageError> {
        let each = (0..count as u64)
            .map(|i| Augmentation::draw(config, seed, first.wrapping_add(i)))
            .collect::<Result<_, _>>()?;
        Ok(Self { channels: channels.to_vec(), each })
    }

    /// Pictures it is for.
    pub fn len(&self) -> usize {
        self.each.len()
    }

    /// Whether it is for no picture.
    pub fn is_empty(&self) -> bool {
        self.each.is_empty()
    }

    /// The channels of the pictures it is for.
    pub fn channels(&self) -> &[Channel] {
        &self.channels
    }

    /// Values of one picture.
    pub(super) fn image_len(&self) -> usize {
        self.channels.len() * PIXELS
    }

    /// The augmented pictures.
    ///
    /// # Errors
    /// [`ImageError::Size`] when `images` is not `len()` pictures.
    pub fn apply(&self, images: &[f32], threads: std::num::NonZero<usize>) -> Result<Vec<f32>, ImageError> {
        expect_len("pictures", self.len() * self.image_len(), images.len())?;
        Ok(self.apply_unchecked(images, threads))
    }

    pub(super) fn apply_unchecked(&self, images: &[f32], threads: std::num::NonZero<usize>) -> Vec<f32> {
        let n = self.image_len();
        let mut out = vec![0.0f32; images.len()];
        let work = |_: &mut (), i: usize, out: &mut [f32]| {
            self.each[i].apply_unchecked(&self.channels, &images[i * n..(i + 1) * n], out);
        };
        super::parallel::for_each_chunk(&mut out, n, threads, || (), work);
        out
    }

    pub(super) fn vjp_unchecked(
        &self,
        images: &[f32],
        gradient: &[f32],
        threads: std::num::NonZero<usize>,
    ) -> Vec<f32> {
        let n = self.image_len();
        let mut out = vec![0.0f32; images.len()];
        let work = |_: &mut (), i: usize, out: &mut [f32]| {
            let range = i * n..(i + 1) * n;
            self.each[i].vjp_unchecked(&self.channels, &images[range.clone()], &gradient[range], out);
        };
        super::parallel::for_each_chunk(&mut out, n, threads, || (), work);
        out
    }
}
