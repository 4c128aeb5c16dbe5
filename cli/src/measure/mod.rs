//! `taut measure`: what a setting costs, how wrong it is, and where it breaks.

use clap::Subcommand;

use crate::failure::Failure;

mod scenes;

/// What to measure.
#[derive(Subcommand, Debug)]
pub enum Measure {
    /// Lists the scenes that measurements run.
    Scenes(scenes::Args),
}

/// Runs a measurement.
pub fn run(what: &Measure) -> Result<(), Failure> {
    match what {
        Measure::Scenes(args) => scenes::run(args),
    }
}
