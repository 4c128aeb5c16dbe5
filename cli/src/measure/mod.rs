//! `taut measure`: what a setting costs, how wrong it is, and where it breaks.

use clap::Subcommand;
use taut_lab::fabric::Fabric;
use taut_onnx::Correction;

use crate::failure::Failure;
use crate::report as told;

mod against;
mod atlas;
mod cusick;
mod fall;
mod features;
mod front;
mod invariance;
mod page;
mod peers;
mod report;
mod scenes;
mod step;

/// What to measure.
#[derive(Subcommand, Debug)]
pub enum Measure {
    /// What a step costs in every vector width, beside what the core can do at best.
    Step(step::Args),
    /// What each feature costs in bytes and in time.
    Features(features::Args),
    /// What it costs that a falling sheet stretches no more than so much, and a hundred capes.
    Fall(fall::Args),
    /// Other engines on the falling sheet, one thread: Bullet and rapier3d, if lab/peers was built.
    Peers(peers::Args),
    /// Extremes of step, stiffness, mass, start and pins: where it is stable, bounded or refused.
    Atlas(atlas::Args),
    /// What must not depend on the frame rate, the frame times, the step, the mesh, the precision.
    Invariance(invariance::Args),
    /// Measures what every setting costs and how wrong it is: rows, pictures, a scoreboard of the corrections.
    Front(front::Args),
    /// Measures all of it and writes one page that holds every table and picture.
    Report(report::Args),
    /// Lists the scenes that measurements run.
    Scenes(scenes::Args),
    /// Compares with trajectories of another engine: strains by direction, silhouette, pictures, distance.
    Against(against::Args),
    /// Compares the drape of a disc with pictures of a real fabric: drape coefficient and folds.
    Cusick(cusick::Args),
}

/// Runs a measurement.
pub fn run(what: &Measure) -> Result<(), Failure> {
    match what {
        Measure::Step(args) => step::run(args),
        Measure::Features(args) => features::run(args),
        Measure::Fall(args) => fall::run(args),
        Measure::Peers(args) => peers::run(args),
        Measure::Atlas(args) => atlas::run(args),
        Measure::Invariance(args) => invariance::run(args),
        Measure::Front(args) => front::run(args),
        Measure::Report(args) => report::run(args),
        Measure::Scenes(args) => scenes::run(args),
        Measure::Against(args) => against::run(args),
        Measure::Cusick(args) => cusick::run(args),
    }
}

/// The processor's name as the system tells it; timings mean nothing without it.
fn processor() -> String {
    let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = text.lines().find_map(|line| line.strip_prefix("model name")?.split_once(':').map(|(_, n)| n.trim()));
    name.unwrap_or(std::env::consts::ARCH).to_string()
}

/// The fabric that a description names; where it names none, the generator's own idea of it, without its variation over the
/// cloth.
pub fn fabric_of(c: &Correction) -> Fabric {
    Fabric::named(&c.description).unwrap_or_else(|| Fabric {
        kind: told::NO_KIND,
        stiffness: told::medians(c),
        density_kg_m2: c.density_kg_m2,
        hinge_rigidity_n_m: c.hinge_rigidity_n_m,
        measured: false,
        softness: [1.0; 2],
    })
}
