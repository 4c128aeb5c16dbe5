//! `taut measure`: what a setting costs, how wrong it is, and where it breaks.

use clap::Subcommand;
use taut_lab::fabric::Fabric;
use taut_onnx::Correction;

use crate::failure::Failure;
use crate::report;

mod against;
mod cusick;
mod scenes;

/// What to measure.
#[derive(Subcommand, Debug)]
pub enum Measure {
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
        Measure::Scenes(args) => scenes::run(args),
        Measure::Against(args) => against::run(args),
        Measure::Cusick(args) => cusick::run(args),
    }
}

/// The fabric that a description names; where it names none, the generator's own idea of it, without its variation over the
/// cloth.
pub fn fabric_of(c: &Correction) -> Fabric {
    Fabric::named(&c.description).unwrap_or_else(|| Fabric {
        kind: report::NO_KIND,
        stiffness: report::medians(c),
        density_kg_m2: c.density_kg_m2,
        hinge_rigidity_n_m: c.hinge_rigidity_n_m,
        measured: false,
    })
}
