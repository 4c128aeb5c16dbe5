//! `taut measure`: what a setting costs, how wrong it is, and where it breaks.

use clap::Subcommand;

use crate::failure::Failure;

mod front;
mod scenes;

/// What to measure.
#[derive(Subcommand, Debug)]
pub enum Measure {
    /// Measures what every setting costs and how wrong it is: rows, pictures, a scoreboard of the corrections.
    Front(front::Args),
    /// Lists the scenes that measurements run.
    Scenes(scenes::Args),
}

/// Runs a measurement.
pub fn run(what: &Measure) -> Result<(), Failure> {
    match what {
        Measure::Front(args) => front::run(args),
        Measure::Scenes(args) => scenes::run(args),
    }
}
