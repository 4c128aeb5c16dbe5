//! `taut measure`: what a setting costs, how wrong it is, and where it breaks.

use clap::Subcommand;

use crate::failure::Failure;

mod atlas;
mod invariance;
mod scenes;

/// What to measure.
#[derive(Subcommand, Debug)]
pub enum Measure {
    /// Extremes of step, stiffness, mass, start and pins: where it is stable, bounded or refused.
    Atlas(atlas::Args),
    /// What must not depend on the frame rate, the frame times, the step, the mesh, the precision.
    Invariance(invariance::Args),
    /// Lists the scenes that measurements run.
    Scenes(scenes::Args),
}

/// Runs a measurement.
pub fn run(what: &Measure) -> Result<(), Failure> {
    match what {
        Measure::Atlas(args) => atlas::run(args),
        Measure::Invariance(args) => invariance::run(args),
        Measure::Scenes(args) => scenes::run(args),
    }
}
