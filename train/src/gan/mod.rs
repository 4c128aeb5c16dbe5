//! Training of the generator: from words and noise to a stiffness field that makes the cheap cloth hang like the
//! reference (paper, sections V and VI.B), in three stages over one network.
//!
//! 1. **match**: the field itself is regressed on the stiffness that the words mean, with the noise as the difference
//!    between two pieces of the same fabric. Cheap; it teaches the words.
//! 2. **positions**: through the differentiable cloth (budget included), shape and stretch at rest are regressed on those
//!    of the reference.
//! 3. **adversarial**: the paper's game with the discriminator (eq. 15, 16, 18, 20, 21), with the paired picture term and
//!    the prior on the field beside it, each of which a switch of the configuration turns off.
//!
//! Every random choice follows from (seed, step), so that a run that was interrupted goes on as if it had not been.

mod checkpoint;
mod config;
mod data;
mod gradient;
mod head;
mod losses;
mod measure;
mod pins;
mod plot;
mod program;
mod trainer;

pub use checkpoint::Checkpoint;
pub use config::{ONE_MATRIX, Reference, StageSteps, TrainConfig};
pub use data::{Coding, Dataset, Example, corrected_stiffness};
pub(crate) use data::{described, hanging, known, weighted};
pub use losses::{AdversarialLoss, Adversary, Ratings, weight_penalty};
pub use pins::pin_map;
pub use program::{RunArgs, renderer, run, train_in};
pub(crate) use program::{bar, write_whole};
pub use trainer::{Score, Stage, Trainer};

use std::fmt;

/// What can end a training run early.
#[derive(Debug)]
pub enum TrainError {
    /// The configuration is out of range.
    Config(String),
    /// A part of the network or of the cloth refused its input; the text names which.
    Part(String),
    /// A file could not be read or written.
    File {
        /// The path.
        path: std::path::PathBuf,
        /// What the system or the parser answered.
        reason: String,
    },
    /// A loss stopped being a number.
    Diverged {
        /// The step.
        step: usize,
        /// Which loss.
        loss: &'static str,
    },
    /// Interrupted; the folder holds a checkpoint.
    Interrupted {
        /// Steps done.
        step: usize,
    },
}

impl fmt::Display for TrainError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            TrainError::Config(what) => write!(f, "configuration: {what}"),
            TrainError::Part(what) => f.write_str(what),
            TrainError::File { path, reason } => write!(f, "{}: {reason}", path.display()),
            TrainError::Diverged { step, loss } => write!(f, "step {step}: the loss `{loss}` is not a number"),
            TrainError::Interrupted { step } => {
                write!(f, "interrupted after step {step}; the same command goes on from there")
            }
        }
    }
}

impl std::error::Error for TrainError {}

impl TrainError {
    /// An error of a part of the library.
    pub(crate) fn part(e: impl fmt::Display) -> TrainError {
        TrainError::Part(e.to_string())
    }

    /// An error with a file.
    pub(crate) fn file(path: &std::path::Path, e: impl fmt::Display) -> TrainError {
        TrainError::File { path: path.to_path_buf(), reason: e.to_string() }
    }
}
