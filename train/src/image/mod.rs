//! Pictures of the cloth: what the discriminator sees, and what is measured on them.
//!
//! * [`Renderer`]: positions of a cloth to a picture, differentiable; the same code makes the real and the generated
//!   pictures, so that the discriminator cannot tell them apart by the way they were drawn.
//! * [`render_images`]: the same as one burn operation with a hand-written vector-Jacobian product.
//! * [`Augmentation`]: the six augmentations of the paper (section VI.A) and white Gaussian noise.
//! * [`psnr`], [`ssim`], [`nmse`]: the scores of section VI.C.
//! * [`write_sheet`]: real and generated pictures side by side in a PNG.
//!
//! A picture is a slice of f32 in `[-1, 1]`, laid out `[channel][row][column]`, [`SIDE`] rows and columns, row 0 at the
//! top, -1 = background. A batch is `[picture][channel][row][column]`.

mod augment;
mod op;
mod parallel;
mod random;
mod renderer;
mod score;
mod sheet;
mod splat;
mod upsample;
mod vjp;

#[cfg(test)]
mod tests;

pub use augment::{AugmentBatch, AugmentConfig, Augmentation};
pub use op::{augment_images, render_images};
pub use parallel::available_threads;
pub use renderer::{Camera, RenderConfig, Renderer};
pub use score::{nmse, psnr, ssim};
pub use sheet::{SheetLayout, write_sheet};

use std::fmt;

/// Rows and columns of every picture (the paper's data set is 64 x 64).
pub const SIDE: usize = 64;
/// Pixels of one channel.
pub const PIXELS: usize = SIDE * SIDE;

/// What one channel of a picture shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Channel {
    /// Light on the cloth, without any pattern: shows folds.
    Shading,
    /// The same light on a checker woven into the cloth: shows where the material went.
    Checker,
    /// Whether there is cloth: shows the outline. The most sensitive to stretch.
    Silhouette,
}

/// Why a picture could not be made, measured or written.
#[derive(Clone, Debug, PartialEq)]
pub enum ImageError {
    /// A setting lies outside its range.
    Setting {
        /// The name of the setting.
        name: &'static str,
        /// What is allowed.
        allowed: &'static str,
    },
    /// A slice or tensor has another size than it must have.
    Size {
        /// What has the wrong size.
        name: &'static str,
        /// The size it must have.
        expected: usize,
        /// The size it has.
        found: usize,
    },
    /// A value is infinite or not a number.
    NotFinite {
        /// What holds the value.
        name: &'static str,
        /// Its place in the slice.
        index: usize,
    },
    /// The reference picture is black everywhere, so that no error can be given relative to it.
    BlackReference,
    /// A file could not be written.
    File {
        /// The path, as given.
        path: String,
        /// What the system answered.
        reason: String,
    },
}

impl fmt::Display for ImageError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Setting { name, allowed } => {
                write!(f, "picture setting '{name}' must be {allowed}")
            }
            Self::Size { name, expected, found } => write!(f, "{name}: expected {expected} values, found {found}"),
            Self::NotFinite { name, index } => write!(f, "{name}: value {index} is not finite"),
            Self::BlackReference => write!(f, "the reference picture is black everywhere"),
            Self::File { path, reason } => write!(f, "cannot write {path}: {reason}"),
        }
    }
}

impl std::error::Error for ImageError {}

/// Checks the length of a slice.
fn expect_len(name: &'static str, expected: usize, found: usize) -> Result<(), ImageError> {
    if expected == found { Ok(()) } else { Err(ImageError::Size { name, expected, found }) }
}
