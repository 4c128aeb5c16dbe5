//! `taut measure`: what a setting costs, how wrong it is, and where it breaks.

use clap::Subcommand;

use crate::failure::Failure;

mod features;
mod scenes;
mod step;

/// What to measure.
#[derive(Subcommand, Debug)]
pub enum Measure {
    /// What a step costs in every vector width, beside what the core can do at best.
    Step(step::Args),
    /// What each feature costs in bytes and in time.
    Features(features::Args),
    /// Lists the scenes that measurements run.
    Scenes(scenes::Args),
}

/// Runs a measurement.
pub fn run(what: &Measure) -> Result<(), Failure> {
    match what {
        Measure::Step(args) => step::run(args),
        Measure::Features(args) => features::run(args),
        Measure::Scenes(args) => scenes::run(args),
    }
}

/// The processor's name as the system tells it; timings mean nothing without it.
fn processor() -> String {
    let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = text.lines().find_map(|line| line.strip_prefix("model name")?.split_once(':').map(|(_, n)| n.trim()));
    name.unwrap_or(std::env::consts::ARCH).to_string()
}
