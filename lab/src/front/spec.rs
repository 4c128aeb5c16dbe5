//! Which rows the front has.

use serde::{Deserialize, Serialize};
use taut::{Families, Features, Solver};

use crate::compare::Limits;
use crate::scene::Scene;

/// The fabrics of the front as words that name their kind: denim, a stiff woven, a jersey.
pub const FABRICS: [&str; 3] = ["denim", "polyester tablecloth", "cotton jersey"];

/// Particles of a side on which the corrections are compared.
pub const SIDE: u32 = 32;

const RATE_HZ: f32 = 60.0;

/// Families without bend springs, and without shear as well.
pub const NO_BEND: Families = Families(Families::STRUCTURAL.0 | Families::SHEAR.0);

/// Where the stiffness comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Correction {
    /// The fabric's own K with as many substeps as it needs: what the others are compared with.
    Reference,
    /// U(0, 1) of the budget at each particle.
    Random,
    /// As stiff as the step allows.
    Uniform,
    /// The fabric's own K, cut by the budget.
    Analytic,
    /// Three numbers fitted by least squares to the strains of the reference ([`super::fit`]).
    DataDriven,
    /// `Uniform` with the 1/r field and its inertia.
    UniformInertia,
    /// `Analytic` with the 1/r field and its inertia.
    AnalyticInertia,
    /// The generator's field, with the inertia field.
    Generated,
}

impl Correction {
    /// Those that compete.
    pub const ALL: [Correction; 7] = [
        Correction::Random,
        Correction::Uniform,
        Correction::Analytic,
        Correction::DataDriven,
        Correction::UniformInertia,
        Correction::AnalyticInertia,
        Correction::Generated,
    ];

    /// The name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Correction::Reference => "reference",
            Correction::Random => "random",
            Correction::Uniform => "uniform",
            Correction::Analytic => "analytic",
            Correction::DataDriven => "data_driven",
            Correction::UniformInertia => "uniform_inertia",
            Correction::AnalyticInertia => "analytic_inertia",
            Correction::Generated => "generated",
        }
    }
}

/// How many rows there are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Set {
    /// A few minutes.
    Quick,
    /// Hours.
    Full,
}

impl Set {
    /// Simulated time of a scene in s.
    pub fn seconds(self, scene: Scene) -> f32 {
        match (self, scene.rests()) {
            (Set::Quick, true) => 5.0,
            (Set::Quick, false) => 4.0,
            (Set::Full, true) => 10.0,
            (Set::Full, false) => 6.0,
        }
    }
}

/// A row that is to be measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spec {
    /// The scene.
    pub scene: Scene,
    /// The fabric in words, of [`FABRICS`].
    pub fabric: &'static str,
    /// Particles of a side.
    pub side: u32,
    /// Frames per second.
    pub rate_hz: f32,
    /// Substeps of a frame; the reference takes what it needs.
    pub substeps: u32,
    /// The solver.
    pub solver: Solver,
    /// Iterations of an implicit solver.
    pub cg_iterations: u32,
    /// Spring families.
    pub families: Families,
    /// Limits.
    pub limits: Limits,
    /// Where the stiffness comes from.
    pub correction: Correction,
}

/// Short name of a solver.
pub(super) fn solver_name(solver: Solver) -> &'static str {
    match solver {
        Solver::SymplecticEuler => "euler",
        Solver::ImplicitEuler => "implicit_euler",
        Solver::Bdf2 => "bdf2",
    }
}

/// Short name of the spring families.
pub(super) fn families_name(families: Families) -> &'static str {
    match (families.contains(Families::SHEAR), families.contains(Families::BEND)) {
        (true, true) => "all",
        (true, false) => "no_bend",
        (false, true) => "no_shear",
        (false, false) => "structural",
    }
}

impl Spec {
    /// A row at 60 Hz x 16, explicit, with all families and no limits.
    pub fn new(scene: Scene, fabric: &'static str, side: u32, correction: Correction) -> Spec {
        Spec {
            scene,
            fabric,
            side,
            rate_hz: RATE_HZ,
            substeps: 16,
            solver: Solver::SymplecticEuler,
            cg_iterations: 10,
            families: Families::ALL,
            limits: Limits::None,
            correction,
        }
    }

    /// The reference of a scene.
    pub fn reference(scene: Scene, fabric: &'static str, side: u32) -> Spec {
        Spec::new(scene, fabric, side, Correction::Reference)
    }

    /// A name that no other row has.
    pub fn key(&self) -> String {
        let solver = match self.solver {
            Solver::SymplecticEuler => "euler".to_string(),
            other => format!("{}-{}", solver_name(other), self.cg_iterations),
        };
        let limits = match self.limits.strain() {
            None => self.limits.name().to_string(),
            Some(strain) => format!("{}-{strain}", self.limits.name()),
        };
        format!(
            "{}/{}/{}/{}x{}/{solver}/{}/{limits}/{}",
            self.scene,
            self.fabric,
            self.side,
            self.rate_hz,
            self.substeps,
            families_name(self.families),
            self.correction.name()
        )
    }

    /// How long it takes, in particle-steps of a plain cloth, roughly: for a progress bar.
    pub fn work(&self, set: Set) -> f64 {
        let substeps = match (self.correction, self.solver) {
            (Correction::Reference, _) => 3.0 * f64::from(self.side),
            (_, Solver::SymplecticEuler) => f64::from(self.substeps),
            (_, _) => f64::from(self.substeps * self.cg_iterations) * 6.0,
        };
        let factor = match self.limits {
            Limits::None => 1.0,
            Limits::Tethers(_) => 4.0,
            Limits::StrainLimit(_) => 5.0,
            Limits::Levels(_) | Limits::WhereCut(_) => 20.0,
            Limits::OneCycle(_) => 8.0,
        };
        let frames = f64::from(set.seconds(self.scene) * self.rate_hz);
        // what a row costs beside its steps: the yardstick, the start, the measures
        factor * frames * (substeps * f64::from(self.side * self.side) + 4096.0)
    }

    /// The rows of some scenes, those of one grid and fabric together.
    pub fn list(set: Set, scenes: &[Scene]) -> Vec<Spec> {
        let mut rows = Vec::new();
        for scene in scenes {
            for (i, fabric) in FABRICS.into_iter().enumerate() {
                match set {
                    // the other fabrics where the drape is exact
                    Set::Quick if i > 0 && *scene != Scene::Hang2 => {}
                    Set::Quick => quick(*scene, fabric, i == 0, &mut rows),
                    Set::Full => [16, 32, 64, 128].into_iter().for_each(|side| full(*scene, fabric, side, &mut rows)),
                }
            }
        }
        rows
    }
}

/// Implicit rows: K as it is.
fn implicit(base: Spec, choices: &[(Solver, u32, u32)], rows: &mut Vec<Spec>) {
    for &(solver, substeps, cg_iterations) in choices {
        rows.push(Spec { solver, substeps, cg_iterations, correction: Correction::Analytic, ..base });
    }
}

fn quick(scene: Scene, fabric: &'static str, first: bool, rows: &mut Vec<Spec>) {
    let new = |side, correction| Spec::new(scene, fabric, side, correction);
    rows.push(new(SIDE, Correction::Reference));
    for correction in Correction::ALL {
        let base = new(SIDE, correction);
        rows.extend([8, 16, 32].map(|substeps| Spec { substeps, ..base }));
        rows.extend([4, 16].map(|substeps| Spec { substeps, limits: Limits::Tethers(0.0), ..base }));
        rows.extend([4, 16].map(|substeps| Spec { substeps, limits: Limits::StrainLimit(0.05), ..base }));
        rows.push(Spec { substeps: 8, limits: Limits::levels(0.05), ..base });
        rows.extend([2, 4].map(|substeps| Spec { substeps, limits: Limits::OneCycle(0.0), ..base }));
    }
    rows.push(Spec { substeps: 2, limits: Limits::levels(0.05), ..new(SIDE, Correction::UniformInertia) });
    implicit(new(SIDE, Correction::Analytic), &[(Solver::Bdf2, 1, 10), (Solver::ImplicitEuler, 1, 10)], rows);
    if first {
        for correction in [Correction::UniformInertia, Correction::AnalyticInertia] {
            rows.push(Spec { families: NO_BEND, ..new(SIDE, correction) });
        }
        rows.push(Spec { families: Families::STRUCTURAL, ..new(SIDE, Correction::UniformInertia) });
        // what needs a reference with colliders or wind at 64 x 64 is for the full set
        let sides = if scene.features() == Features::NONE { [16, 64].as_slice() } else { &[16] };
        for &side in sides {
            rows.push(new(side, Correction::Reference));
            for correction in [
                Correction::Uniform,
                Correction::Analytic,
                Correction::UniformInertia,
                Correction::AnalyticInertia,
                Correction::Generated,
            ] {
                rows.push(new(side, correction));
            }
        }
    }
}

fn full(scene: Scene, fabric: &'static str, side: u32, rows: &mut Vec<Spec>) {
    let new = |correction| Spec::new(scene, fabric, side, correction);
    rows.push(new(Correction::Reference));
    for correction in Correction::ALL {
        let base = new(correction);
        rows.extend([4, 8, 16, 32, 64].map(|substeps| Spec { substeps, ..base }));
        for limits in [Limits::Tethers(0.0), Limits::StrainLimit(0.05)] {
            rows.extend([4, 8, 16, 32].map(|substeps| Spec { substeps, limits, ..base }));
        }
        for limits in [Limits::levels(0.02), Limits::levels(0.05), Limits::levels(0.1)] {
            rows.extend([1, 2, 4, 8, 16].map(|substeps| Spec { substeps, limits, ..base }));
        }
        for limits in [Limits::OneCycle(0.0), Limits::OneCycle(0.02)] {
            rows.extend([1, 2, 3, 4, 8].map(|substeps| Spec { substeps, limits, ..base }));
        }
    }
    let mut choices = Vec::new();
    for solver in [Solver::ImplicitEuler, Solver::Bdf2] {
        for (substeps, cg_iterations) in [(1, 5), (1, 10), (1, 20), (2, 10), (4, 10)] {
            choices.push((solver, substeps, cg_iterations));
        }
    }
    implicit(new(Correction::Analytic), &choices, rows);
    for correction in [Correction::Uniform, Correction::UniformInertia, Correction::AnalyticInertia] {
        for families in [NO_BEND, Families::STRUCTURAL] {
            rows.push(Spec { families, ..new(correction) });
        }
        // the same dt by another rate
        rows.push(Spec { rate_hz: 30.0, substeps: 32, ..new(correction) });
        rows.push(Spec { rate_hz: 120.0, substeps: 8, ..new(correction) });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_row_has_a_name_of_its_own() {
        for set in [Set::Quick, Set::Full] {
            let rows = Spec::list(set, &Scene::ALL);
            let keys: BTreeSet<String> = rows.iter().map(Spec::key).collect();
            assert_eq!(keys.len(), rows.len(), "{set:?}");
        }
    }

    #[test]
    fn every_correction_is_measured_alone_and_with_every_limit() {
        for scene in Scene::ALL {
            let rows = Spec::list(Set::Quick, &[scene]);
            for correction in Correction::ALL {
                for limits in ["none", "tethers", "strain_limit", "levels", "one_cycle"] {
                    let found = rows.iter().filter(|r| r.correction == correction && r.limits.name() == limits);
                    assert!(found.count() >= 1, "{scene}, {correction:?}, {limits}");
                }
            }
            assert!(rows.iter().any(|r| r.solver == Solver::Bdf2) && rows.iter().any(|r| r.families.0 == 1));
        }
    }
}
