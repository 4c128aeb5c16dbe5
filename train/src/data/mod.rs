//! The pictures to learn from (paper, VI.A): the continuum cloth of [`crate::reference`] with fabrics sampled around the
//! measured ones, in several scenes, with several pins, at several times; 64 x 64, in `[-1, 1]`, without noise.
//!
//! `taut-train data --out DIR` makes them, [`load`] reads them. The splits share no fabric: neither a piece nor what the
//! words that act say of it ([`Split::of`]). See docs/training.md.

mod command;
mod fabric;
mod make;
mod plan;
mod scene;
mod store;
#[cfg(test)]
mod tests;

pub use command::{DataArgs, run};
pub use fabric::{material, piece, sample};
pub use make::settled;
pub use plan::{Plan, Split, Trajectory};
pub use scene::{Scene, View};
pub use store::load;

use std::fmt;
use std::path::{Path, PathBuf};

use taut_lab::fabric::Fabric;

use crate::image::{Channel, PIXELS};
use crate::reference::ReferenceError;

/// Particles along each side of the cloth: the grid that training uses.
pub const GRID: usize = 16;

/// What the pictures show, in this order.
pub const CHANNELS: [Channel; 3] = [Channel::Shading, Channel::Checker, Channel::Silhouette];

/// A picture and everything that is known of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Sample {
    /// What the cloth is made of.
    pub fabric: Fabric,
    /// What it is described as.
    pub words: String,
    /// How it hangs or lies.
    pub scene: Scene,
    /// The pinned particles of the [`GRID`] x [`GRID`] grid, row 0 at the top.
    pub pins: Vec<usize>,
    /// Simulated time in s. A cloth at rest was brought there from the last moment of its motion.
    pub time_s: f64,
    /// Whether it is at rest.
    pub at_rest: bool,
    /// `[GRID * GRID][3]` in m, in the lab's axes.
    pub positions: Vec<f32>,
    /// `[CHANNELS][64][64]` in `[-1, 1]`, in steps of 1/127.5.
    pub image: Vec<f32>,
}

impl Sample {
    /// The picture with these channels alone, in their order.
    pub fn picture(&self, channels: &[Channel]) -> Vec<f32> {
        let plane = |c: &Channel| CHANNELS.iter().position(|k| k == c).unwrap_or(0) * PIXELS;
        channels.iter().flat_map(|c| &self.image[plane(c)..][..PIXELS]).copied().collect()
    }
}

/// Why there are no pictures.
#[derive(Debug)]
pub enum DataError {
    /// A file that cannot be read or written, or is not what it should be.
    File {
        /// The file or folder.
        path: PathBuf,
        /// What is wrong.
        reason: String,
    },
    /// Parts of the set are not there yet.
    Incomplete {
        /// The folder.
        folder: PathBuf,
        /// Parts that are missing.
        missing: usize,
        /// Parts that there should be.
        of: usize,
    },
    /// The cloth.
    Cloth(ReferenceError),
    /// Something that was given.
    Given(String),
    /// Ctrl-C.
    Interrupted,
}

impl DataError {
    pub(crate) fn file(path: &Path, reason: impl fmt::Display) -> DataError {
        DataError::File { path: path.into(), reason: reason.to_string() }
    }
}

impl fmt::Display for DataError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            DataError::File { path, reason } => write!(f, "{}: {reason}", path.display()),
            DataError::Incomplete { folder, missing, of } => {
                let folder = folder.display();
                write!(f, "{folder}: {missing} of {of} parts are missing; `taut-train data --out {folder}` makes them")
            }
            DataError::Cloth(e) => e.fmt(f),
            DataError::Given(what) => f.write_str(what),
            DataError::Interrupted => f.write_str("interrupted; the same command goes on"),
        }
    }
}

impl std::error::Error for DataError {}

impl From<ReferenceError> for DataError {
    fn from(e: ReferenceError) -> DataError {
        DataError::Cloth(e)
    }
}
