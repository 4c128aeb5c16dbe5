//! What `taut drape` found, as `report.json`: snake_case keys that carry their unit. Numbers that are not finite are null.

use serde::Serialize;
use taut::Budget;
use taut::field::CHANNELS;
use taut_lab::compare::{Case, Outcome};
use taut_lab::fabric::{Fabric, KINDS};
use taut_lab::metrics::{StretchPct, median};
use taut_onnx::{Correction, Info};

/// Kind of the reference where the description names no fabric.
pub const NO_KIND: &str = "none named: the generator's own medians";

/// Stiffness of the four families in N/m.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Stiffness {
    pub warp: f32,
    pub weft: f32,
    pub shear: f32,
    pub bend: f32,
}

impl From<[f32; 4]> for Stiffness {
    fn from([warp, weft, shear, bend]: [f32; 4]) -> Stiffness {
        Stiffness { warp, weft, shear, bend }
    }
}

/// The median of each channel of a generated field in N/m.
pub fn medians(c: &Correction) -> [f32; 4] {
    let mut out = [0.0; CHANNELS.len()];
    for (channel, k) in c.field.outer_iter().zip(&mut out) {
        *k = median(&channel.iter().copied().collect::<Vec<f32>>());
    }
    out
}

/// How far the fabric stretches by itself, as fractions of the rest length.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct StretchLimits {
    pub warp: f32,
    pub weft: f32,
    pub diagonal: f32,
}

impl From<[f32; 3]> for StretchLimits {
    fn from([warp, weft, diagonal]: [f32; 3]) -> StretchLimits {
        StretchLimits { warp, weft, diagonal }
    }
}

/// The cloth that the others are compared with.
#[derive(Clone, Debug, Serialize)]
pub struct Reference {
    /// The fabric that the description names, or [`NO_KIND`].
    pub kind: String,
    /// Whether its constants were measured; else they are an estimate, or the generator's.
    pub measured: bool,
    /// Whether words such as "heavy" have changed the constants of the kind, by factors that are estimates.
    pub changed_by_words: bool,
    /// Physical stiffness, the modifying words counted in.
    pub stiffness_n_per_m: Stiffness,
}

/// What the generator told, beside the field.
#[derive(Clone, Debug, Serialize)]
pub struct Generated {
    pub model_name: String,
    pub training_digest: String,
    pub density_kg_m2: f32,
    pub hinge_rigidity_n_m: f32,
    pub stretch_limits: StretchLimits,
    /// Medians of the field before the budget.
    pub median_stiffness_n_per_m: Stiffness,
}

impl Generated {
    pub fn new(info: &Info, c: &Correction) -> Generated {
        Generated {
            model_name: info.model_name.clone(),
            training_digest: info.training_digest.clone(),
            density_kg_m2: c.density_kg_m2,
            hinge_rigidity_n_m: c.hinge_rigidity_n_m,
            stretch_limits: c.stretch_limits.into(),
            median_stiffness_n_per_m: medians(c).into(),
        }
    }
}

/// One setting.
#[derive(Clone, Debug, Serialize)]
pub struct Setting {
    pub name: &'static str,
    /// Structural stretch at the end.
    pub stretch_pct: StretchPct,
    /// Share of the stiffness that the budget cut, 0 to 1.
    pub cut_fraction: f64,
    /// Thread CPU time.
    pub ns_per_particle_step: f64,
    pub finite: bool,
    /// 16 hexadecimal digits.
    pub state_hash: String,
    pub substeps: u32,
    /// Largest over the whole run, the fall included.
    pub peak_stretch_pct: f64,
    /// Inertia that the inertia field adds, as a share of the free mass.
    pub inertia_added: f64,
    /// 0 is at rest.
    pub rms_speed_m_s: f64,
}

impl From<&Outcome> for Setting {
    fn from(o: &Outcome) -> Setting {
        Setting {
            name: o.name,
            stretch_pct: o.stretch_pct,
            cut_fraction: o.cut_fraction,
            ns_per_particle_step: o.ns_per_particle_step,
            finite: o.finite,
            state_hash: o.state_hash.clone(),
            substeps: o.substeps,
            peak_stretch_pct: o.peak_stretch_pct,
            inertia_added: o.inertia_added,
            rms_speed_m_s: o.rms_speed_m_s,
        }
    }
}

/// The generated cloth minus another, in points of stretch: below 0 it stretches less.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Difference {
    pub max_points: f64,
    pub ex_pin_max_points: f64,
}

/// What the net adds to what the inertia field does for any stiffness, and what is left to the reference.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct NetShare {
    pub uniform_inertia: Difference,
    pub analytic_inertia: Difference,
    pub reference: Difference,
}

/// `report.json`.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    pub scene: &'static str,
    pub description: String,
    pub seed: u64,
    /// Rows, columns.
    pub grid: [u32; 2],
    pub rate_hz: f32,
    pub substeps: u32,
    pub budget: &'static str,
    pub density_kg_m2: f32,
    pub settings: Vec<Setting>,
    /// Missing where a setting that it compares was not run.
    pub net_share: Option<NetShare>,
    pub seconds: f32,
    /// Width (along u), height (along v).
    pub size_m: [f32; 2],
    pub reference_fabric: Reference,
    pub reference_substeps: Option<u32>,
    pub generator: Generated,
    pub known_words: Vec<String>,
    pub unknown_words: Vec<String>,
    pub dropped_words: Vec<String>,
}

/// A budget's name on the command line and in reports.
pub fn budget_name(budget: Budget) -> &'static str {
    match budget {
        Budget::Tuned => "tuned",
        Budget::Certified => "certified",
    }
}

impl Report {
    /// The report of a comparison.
    pub fn new(case: &Case, reference: &Fabric, info: &Info, c: &Correction, outcomes: &[Outcome]) -> Report {
        let settings: Vec<Setting> = outcomes.iter().map(Setting::from).collect();
        let reference_substeps = settings.iter().find(|s| s.name == "reference").map(|s| s.substeps);
        Report {
            scene: case.scene.name(),
            description: c.description.clone(),
            seed: c.seed,
            grid: [case.rows, case.columns],
            rate_hz: case.rate_hz,
            substeps: case.substeps,
            budget: budget_name(case.budget),
            density_kg_m2: case.density_kg_m2,
            net_share: net_share(&settings),
            settings,
            seconds: case.seconds,
            size_m: case.size_m,
            reference_fabric: Reference {
                kind: reference.kind.into(),
                measured: reference.measured,
                changed_by_words: changed_by_words(reference),
                stiffness_n_per_m: reference.stiffness.into(),
            },
            reference_substeps,
            generator: Generated::new(info, c),
            known_words: c.tokens.clone(),
            unknown_words: c.unknown_words.clone(),
            dropped_words: c.dropped_words.clone(),
        }
    }
}

fn changed_by_words(f: &Fabric) -> bool {
    let plain = KINDS.iter().find(|k| k.name == f.kind);
    plain.is_some_and(|k| k.fabric().stiffness != f.stiffness)
}

fn net_share(settings: &[Setting]) -> Option<NetShare> {
    let stretch = |name| settings.iter().find(|s| s.name == name).map(|s| s.stretch_pct);
    let generated = stretch("generated")?;
    let minus = |other: StretchPct| Difference {
        max_points: generated.max - other.max,
        ex_pin_max_points: generated.ex_pin_max - other.ex_pin_max,
    };
    Some(NetShare {
        uniform_inertia: minus(stretch("uniform_inertia")?),
        analytic_inertia: minus(stretch("analytic_inertia")?),
        reference: minus(stretch("reference")?),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn setting(name: &'static str, max: f64, ex_pin_max: f64) -> Setting {
        Setting {
            name,
            stretch_pct: StretchPct { max, p99: 0.0, mean: 0.0, ex_pin_max },
            cut_fraction: 0.0,
            ns_per_particle_step: 0.0,
            finite: true,
            state_hash: String::new(),
            substeps: 16,
            peak_stretch_pct: f64::NAN,
            inertia_added: 0.0,
            rms_speed_m_s: 0.0,
        }
    }

    #[test]
    fn the_share_of_the_net_is_the_difference() {
        let mut settings = vec![setting("uniform_inertia", 3.0, 2.0), setting("generated", 2.5, 2.25)];
        assert_eq!(net_share(&settings), None);
        settings.push(setting("analytic_inertia", 2.0, 2.0));
        settings.push(setting("reference", 1.5, 0.25));
        let share = net_share(&settings).expect("all three");
        assert_eq!(share.uniform_inertia.max_points, -0.5);
        assert_eq!(share.uniform_inertia.ex_pin_max_points, 0.25);
        assert_eq!(share.analytic_inertia.max_points, 0.5);
        assert_eq!(share.reference.ex_pin_max_points, 2.0);
    }

    #[test]
    fn words_that_change_a_fabric_are_told() {
        let changed = |d: &str| changed_by_words(&Fabric::named(d).expect(d));
        assert!(!changed("blue denim") && changed("heavy blue denim"));
    }

    #[test]
    fn numbers_that_are_not_finite_are_null() {
        let json = serde_json::to_string(&setting("random", f64::INFINITY, 1.0)).expect("serialised");
        assert!(json.contains("\"max\":null") && json.contains("\"peak_stretch_pct\":null"), "{json}");
    }
}
