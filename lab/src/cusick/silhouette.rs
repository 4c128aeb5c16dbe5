//! What the camera over a drape test sees, and what is measured of it.
//!
//! The camera looks down on the middle of the pedestal's top from 0.7 m above it, in perspective, with a full field of view
//! of 0.5 rad, on 256 x 256 pixels. Areas are taken in pixels of the plane of the pedestal's top: what hangs below it looks
//! a little smaller than its vertical projection (6 cm below by 8 % along each side), in real pictures and in those of taut
//! alike.

use std::f64::consts::{PI, TAU};
use std::fmt;
use std::path::{Path, PathBuf};

use image::{ImageReader, Limits};

use super::{DISC_M, PEDESTAL_M};
use crate::picture::{Raster, Vertex};

/// Pixels along each side.
pub const SIDE: usize = 256;

const CAMERA_M: f32 = 0.7;
const FIELD_OF_VIEW: f32 = 0.5;

/// Angles at which the outline is sampled; the width of the Gaussian that smooths it (one standard deviation) in degrees,
/// and the share of the mean radius by which a fold must stand out on both sides.
const ANGLES: usize = 360;
const SMOOTH_DEG: f64 = 4.0;
const STANDS_OUT: f64 = 0.02;

/// Rings and spokes that the disc is drawn with.
const RINGS: usize = 40;
const SPOKES: usize = 240;

/// A picture of which each pixel shows cloth or does not.
#[derive(Clone, Debug, PartialEq)]
pub struct Silhouette {
    cloth: Vec<bool>,
}

/// Why a picture cannot be used.
#[derive(Debug)]
pub struct SilhouetteError {
    /// The file or folder.
    pub path: PathBuf,
    /// What is wrong.
    pub reason: String,
}

impl fmt::Display for SilhouetteError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.path.display(), self.reason)
    }
}

impl std::error::Error for SilhouetteError {}

/// Pixels per metre in the plane of the pedestal's top.
fn scale() -> f32 {
    0.5 * SIDE as f32 / (CAMERA_M * (0.5 * FIELD_OF_VIEW).tan())
}

impl Silhouette {
    /// Reads a PNG of 256 x 256 pixels; what is brighter than half is cloth. Errors: no such picture, another size, nothing
    /// or everything is cloth.
    pub fn load(path: &Path) -> Result<Silhouette, SilhouetteError> {
        let wrong = |reason: String| SilhouetteError { path: path.into(), reason };
        let open = ImageReader::open(path).and_then(ImageReader::with_guessed_format);
        let mut reader = open.map_err(|e| wrong(format!("cannot be read: {e}")))?;
        let mut limits = Limits::default();
        (limits.max_image_width, limits.max_image_height) = (Some(4096), Some(4096));
        reader.limits(limits);
        let image = reader.decode().map_err(|e| wrong(format!("is no picture: {e}")))?.into_luma8();
        let side = SIDE as u32;
        if image.dimensions() != (side, side) {
            let (width, height) = image.dimensions();
            return Err(wrong(format!("has {width} x {height} pixels, not {SIDE} x {SIDE}")));
        }
        let cloth: Vec<bool> = image.into_raw().iter().map(|p| *p > 127).collect();
        match cloth.iter().filter(|c| **c).count() {
            0 => Err(wrong("shows no cloth".into())),
            n if n == SIDE * SIDE => Err(wrong("is cloth all over".into())),
            _ => Ok(Silhouette { cloth }),
        }
    }

    /// The picture of a draped disc. `at` gives the place in m (y up, 0 at the pedestal's top and in its middle) of the
    /// point of the disc at (x, z) in m, up to its radius.
    pub fn of_disc(at: impl Fn(f32, f32) -> [f32; 3]) -> Silhouette {
        let middle = 0.5 * SIDE as f32;
        let seen = |ring: usize, spoke: usize| {
            let (sin, cos) = (std::f32::consts::TAU * (spoke % SPOKES) as f32 / SPOKES as f32).sin_cos();
            let radius = DISC_M * ring as f32 / RINGS as f32;
            let [x, y, z] = at(radius * cos, radius * sin);
            let nearer = scale() * CAMERA_M / (CAMERA_M - y).max(1e-3);
            Vertex { screen: [middle + x * nearer, middle + z * nearer, y], values: [0.0] }
        };
        let mut raster = Raster::new(SIDE, SIDE);
        for ring in 0..RINGS {
            for spoke in 0..SPOKES {
                let [a, b] = [seen(ring, spoke), seen(ring, spoke + 1)];
                let [c, d] = [seen(ring + 1, spoke), seen(ring + 1, spoke + 1)];
                raster.triangle([&a, &c, &d], |_| [1.0; 3]);
                raster.triangle([&a, &d, &b], |_| [1.0; 3]);
            }
        }
        Silhouette { cloth: (0..SIDE * SIDE).map(|i| raster.pixel(i % SIDE, i / SIDE).1 >= 0.5).collect() }
    }

    /// The share of the ring between pedestal and flat disc that cloth covers: 1 does not bend, 0 hangs straight down.
    pub fn drape_coefficient(&self) -> f64 {
        let area = |radius: f32| PI * f64::from(radius * scale()).powi(2);
        let cloth = self.cloth.iter().filter(|c| **c).count() as f64;
        (cloth - area(PEDESTAL_M)) / (area(DISC_M) - area(PEDESTAL_M))
    }

    /// Folds of the outline: maxima of its distance from the middle of the cloth over the angle. The outline is sampled at
    /// every degree and smoothed by a Gaussian of 4 degrees; a fold stands out by 2 % of the mean radius on both sides.
    pub fn nodes(&self) -> usize {
        let radius = self.outline();
        let mean = radius.iter().sum::<f64>() / radius.len() as f64;
        let least = (0..ANGLES).min_by(|a, b| radius[*a].total_cmp(&radius[*b])).unwrap_or(0);
        let threshold = STANDS_OUT * mean;
        let (mut nodes, mut rising, mut extreme) = (0, true, radius[least]);
        for i in 1..=ANGLES {
            let r = radius[(least + i) % ANGLES];
            if rising {
                extreme = f64::min(extreme, r);
                if r > extreme + threshold {
                    (rising, extreme) = (false, r);
                }
            } else {
                extreme = extreme.max(r);
                if r < extreme - threshold {
                    nodes += 1;
                    (rising, extreme) = (true, r);
                }
            }
        }
        nodes
    }

    /// Distance of the outermost cloth from the middle of the cloth at every degree, smoothed.
    fn outline(&self) -> Vec<f64> {
        let places = || (0..SIDE * SIDE).filter(|i| self.cloth[*i]).map(|i| (i % SIDE, i / SIDE));
        let count = places().count().max(1) as f64;
        let [x, y] = [places().map(|p| p.0).sum::<usize>(), places().map(|p| p.1).sum()].map(|s| s as f64 / count);
        let covered = |radius: f64, angle: f64| {
            let (sin, cos) = angle.sin_cos();
            let [column, row] = [x + radius * cos, y + radius * sin].map(|c| c.round());
            let inside = 0.0..SIDE as f64;
            inside.contains(&column) && inside.contains(&row) && self.cloth[row as usize * SIDE + column as usize]
        };
        let raw: Vec<f64> = (0..ANGLES)
            .map(|i| {
                let angle = TAU * i as f64 / ANGLES as f64;
                let outward = (0..2 * SIDE).rev().map(|q| 0.5 * q as f64);
                outward.into_iter().find(|r| covered(*r, angle)).unwrap_or(0.0)
            })
            .collect();
        let reach = (4.0 * SMOOTH_DEG) as i64;
        let weight = |d: i64| (-0.5 * (d as f64 / SMOOTH_DEG).powi(2)).exp();
        let all: f64 = (-reach..=reach).map(weight).sum();
        let near = |i: usize, d: i64| raw[(i as i64 + d).rem_euclid(ANGLES as i64) as usize];
        (0..ANGLES).map(|i| (-reach..=reach).map(|d| weight(d) / all * near(i, d)).sum()).collect()
    }

    /// As a PNG file would have it: 0 or 255, row by row.
    #[cfg(test)]
    fn pixels(&self) -> Vec<u8> {
        self.cloth.iter().map(|c| if *c { 255 } else { 0 }).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flat_discs_and_cylinders_have_their_coefficients() {
        let flat = Silhouette::of_disc(|x, z| [x, 0.0, z]);
        assert!((flat.drape_coefficient() - 1.0).abs() < 0.01, "{}", flat.drape_coefficient());
        assert_eq!(flat.nodes(), 0);
        // all beyond the pedestal hangs straight down
        let hung = Silhouette::of_disc(|x, z| {
            let r = x.hypot(z);
            let kept = (PEDESTAL_M / r.max(1e-6)).min(1.0);
            [x * kept, (PEDESTAL_M - r).min(0.0), z * kept]
        });
        assert!(hung.drape_coefficient().abs() < 0.01, "{}", hung.drape_coefficient());
    }

    #[test]
    fn what_hangs_lower_looks_smaller() {
        let low = Silhouette::of_disc(|x, z| [x, -0.1, z]);
        let area = (0.15f64 * 0.7 / 0.8).powi(2);
        let meant = (area - 0.09 * 0.09) / (0.15 * 0.15 - 0.09 * 0.09);
        assert!((low.drape_coefficient() - meant).abs() < 0.01, "{} {meant}", low.drape_coefficient());
    }

    #[test]
    fn folds_are_counted() {
        for folds in [3usize, 5, 7, 9] {
            let wavy = |depth: f32| {
                Silhouette::of_disc(move |x, z| {
                    let s = 0.8 + depth * (folds as f32 * z.atan2(x) + 0.3).cos();
                    // not in the middle of the picture
                    [x * s + 0.01, 0.0, z * s - 0.005]
                })
            };
            assert_eq!(wavy(0.08).nodes(), folds);
            assert_eq!(wavy(0.004).nodes(), 0, "less than 2 % is no fold");
        }
    }

    #[test]
    fn pictures_come_back_and_bad_ones_are_named() {
        let home = tempfile::tempdir().unwrap();
        let path = home.path().join("s.png");
        let flat = Silhouette::of_disc(|x, z| [x, 0.0, z]);
        let save =
            |pixels: Vec<u8>, side: u32| image::save_buffer(&path, &pixels, side, side, image::ColorType::L8).unwrap();
        save(flat.pixels(), 256);
        assert_eq!(Silhouette::load(&path).unwrap(), flat);
        let whole = std::fs::read(&path).unwrap();
        let fails = |named: &str| {
            let e = Silhouette::load(&path).unwrap_err().to_string();
            assert!(e.contains("s.png") && e.contains(named), "{e}");
        };
        save(vec![0; 65536], 256);
        fails("no cloth");
        save(vec![255; 65536], 256);
        fails("all over");
        save(vec![255; 64 * 64], 64);
        fails("64 x 64 pixels");
        std::fs::write(&path, &whole[..whole.len() / 2]).unwrap();
        fails("no picture");
        std::fs::remove_file(&path).unwrap();
        fails("cannot be read");
    }
}
