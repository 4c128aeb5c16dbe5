//! `taut measure`: what a setting costs, how wrong it is, and where it breaks.

use clap::Subcommand;

use crate::failure::Failure;

mod atlas;
mod features;
mod front;
mod invariance;
mod scenes;
mod step;

/// What to measure.
#[derive(Subcommand, Debug)]
pub enum Measure {
    /// What a step costs in every vector width, beside what the core can do at best.
    Step(step::Args),
    /// What each feature costs in bytes and in time.
    Features(features::Args),
    /// Extremes of step, stiffness, mass, start and pins: where it is stable, bounded or refused.
    Atlas(atlas::Args),
    /// What must not depend on the frame rate, the frame times, the step, the mesh, the precision.
    Invariance(invariance::Args),
    /// Measures what every setting costs and how wrong it is: rows, pictures, a scoreboard of the corrections.
    Front(front::Args),
    /// Lists the scenes that measurements run.
    Scenes(scenes::Args),
}

/// Runs a measurement.
pub fn run(what: &Measure) -> Result<(), Failure> {
    match what {
        Measure::Step(args) => step::run(args),
        Measure::Features(args) => features::run(args),
        Measure::Atlas(args) => atlas::run(args),
        Measure::Invariance(args) => invariance::run(args),
        Measure::Front(args) => front::run(args),
        Measure::Scenes(args) => scenes::run(args),
    }
}

/// The processor's name as the system tells it; timings mean nothing without it.
fn processor() -> String {
    let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = text.lines().find_map(|line| line.strip_prefix("model name")?.split_once(':').map(|(_, n)| n.trim()));
    name.unwrap_or(std::env::consts::ARCH).to_string()
}
