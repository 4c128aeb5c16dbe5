//! `taut-train evaluate`: the paper's section VI.C, and what it does not ask.
//!
//! * [`noise`]: Fig. 7, pictures of the generated cloth for nets that were trained with 1 to 6 % of noise.
//! * [`losses`]: Fig. 8, the terms of the loss added one by one, and cross entropy against least squares.
//! * [`rivals`]: Fig. 9, the generated cloth beside K from data, from formulas and beside what a game has.
//! * [`unseen`], [`discs`]: fabrics that no net has seen, with their own words and with those of another fabric, hung and draped.
//!
//! Every figure is a list of jobs whose rows stand in a ledger of the folder, so a run can be interrupted and spread over
//! machines; nets are trained once, in folders of their own. docs/evaluation.md says what came out.

pub mod command;
pub mod discs;
pub mod held;
pub mod ladder;
pub mod losses;
pub mod net;
pub mod noise;
pub mod paper;
pub mod rivals;
pub mod score;
pub mod shuffle;
pub mod unseen;

mod bench;
mod table;

pub use bench::Bench;
pub use command::{EvaluateArgs, Figure, run};

use std::fmt;

use crate::gan::TrainError;

/// Why an evaluation stopped.
#[derive(Debug)]
pub enum EvaluateError {
    /// Something that was given, a file, a cloth.
    Part(String),
    /// Ctrl-C.
    Interrupted,
}

impl EvaluateError {
    /// Of another part of the program.
    pub fn part(e: impl fmt::Display) -> EvaluateError {
        EvaluateError::Part(e.to_string())
    }
}

impl fmt::Display for EvaluateError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            EvaluateError::Part(what) => f.write_str(what),
            EvaluateError::Interrupted => f.write_str("interrupted; the same command goes on"),
        }
    }
}

impl std::error::Error for EvaluateError {}

impl From<TrainError> for EvaluateError {
    fn from(e: TrainError) -> EvaluateError {
        match e {
            TrainError::Interrupted { .. } => EvaluateError::Interrupted,
            other => EvaluateError::part(other),
        }
    }
}
