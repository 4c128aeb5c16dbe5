//! What is searched: how the sheet is stepped.

use serde::{Deserialize, Serialize};
use taut::{Budget, ClothDef, Features, Grid, GridDef};

use super::search::Criterion;
use crate::compare::{BEYOND, INERTIA_MAX, INERTIA_RADIUS, Limits, RATIOS};

/// Frames per second.
pub const RATE_HZ: f32 = 60.0;

/// Length of a side in m.
pub const SIDE_M: f32 = 1.0;

/// Damping in 1/s.
pub const DAMPING_PER_S: f32 = 2.0;

/// Sweeps, unless others are named.
pub const PASSES: u32 = 2;

/// What keeps lengths beside the springs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// Springs alone.
    Plain,
    /// The inertia field.
    Inertia,
    /// Tethers without slack.
    Tethers,
    /// Both.
    TethersInertia,
    /// Tethers without slack and two passes of the strain limit.
    TethersLimit,
    /// Levels with tethers on each of them, as many cycles as keep the limit.
    Levels,
    /// One cycle through the levels in each substep.
    OneCycle,
}

impl Kind {
    /// All of them.
    pub const ALL: [Kind; 7] = [
        Kind::Plain,
        Kind::Inertia,
        Kind::Tethers,
        Kind::TethersInertia,
        Kind::TethersLimit,
        Kind::Levels,
        Kind::OneCycle,
    ];

    /// The name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Kind::Plain => "plain",
            Kind::Inertia => "inertia",
            Kind::Tethers => "tethers",
            Kind::TethersInertia => "tethers_inertia",
            Kind::TethersLimit => "tethers_limit",
            Kind::Levels => "levels",
            Kind::OneCycle => "one_cycle",
        }
    }
}

/// How much of the stability budget is used and what guards it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Guard {
    /// The tuned budget under the default speed limit, a quarter of a spacing a substep. With few substeps that is slower
    /// than the sheet falls.
    Tuned,
    /// The tuned budget under a speed limit of eight spacings a substep.
    Fast,
    /// The certified budget without a speed limit.
    Certified,
}

impl Guard {
    /// The name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Guard::Tuned => "tuned",
            Guard::Fast => "tuned_fast",
            Guard::Certified => "certified",
        }
    }
}

/// A way to step the sheet.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Setting {
    /// What keeps lengths.
    pub kind: Kind,
    /// Stability budget and speed limit.
    pub guard: Guard,
    /// Substeps of a frame.
    pub substeps: u32,
    /// The strain limit or the limit of the levels; 0 without.
    pub strain: f32,
    /// Sweeps of the strain limit, and of the levels over the cloth itself.
    pub passes: u32,
}

impl Setting {
    /// A name that no other setting has.
    pub fn key(&self) -> String {
        let percent = (1000.0 * f64::from(self.strain)).round() / 10.0;
        let strain = if percent > 0.0 { format!(" {percent}%") } else { String::new() };
        let passes = if self.passes == PASSES { String::new() } else { format!(" p{}", self.passes) };
        format!("{}{strain}{passes} {} x{}", self.kind.name(), self.guard.name(), self.substeps)
    }

    /// The grid of N x N particles.
    pub fn grid(side: u32) -> Result<Grid, taut::Error> {
        Grid::new(&GridDef { rows: side, columns: side, width_m: SIDE_M, height_m: SIDE_M, ..GridDef::default() })
    }

    /// The definition: level in the plane y = 0.
    pub fn def(&self) -> ClothDef {
        let (budget, speed_limit) = match self.guard {
            Guard::Tuned => (Budget::Tuned, 0.25),
            Guard::Fast => (Budget::Tuned, 8.0),
            Guard::Certified => (Budget::Certified, 0.0),
        };
        let limits = match self.kind {
            Kind::Plain | Kind::Inertia => Limits::None,
            Kind::Tethers | Kind::TethersInertia | Kind::TethersLimit => Limits::Tethers(0.0),
            Kind::Levels | Kind::OneCycle => Limits::levels(self.strain),
        };
        let inertia = matches!(self.kind, Kind::Inertia | Kind::TethersInertia);
        let limited = self.kind == Kind::TethersLimit;
        let def = limits.fit(&ClothDef {
            rate_hz: RATE_HZ,
            substeps: self.substeps,
            density_kg_m2: 0.2,
            damping_per_s: DAMPING_PER_S,
            budget,
            speed_limit,
            inertia_radius_m: if inertia { INERTIA_RADIUS * SIDE_M } else { 0.0 },
            inertia_max: INERTIA_MAX,
            level_cycles: u32::from(self.kind == Kind::OneCycle),
            strain_passes: self.passes,
            max_pins: 2,
            features: Features::NONE,
            u_axis: [1.0, 0.0, 0.0],
            v_axis: [0.0, 0.0, 1.0],
            ..ClothDef::default()
        });
        if !limited {
            return def;
        }
        let features = Features(def.features.0 | Features::STRAIN_LIMIT.0);
        ClothDef { features, strain_limit: [self.strain; 3], ..def }
    }

    /// Four channels of stiffness at each particle in N/m, in the ratios [`RATIOS`] and beyond what the budget allows.
    pub fn field(side: u32) -> Vec<f32> {
        let n = (side * side) as usize;
        RATIOS.into_iter().flat_map(|r| std::iter::repeat_n(r * BEYOND, n)).collect()
    }

    /// Particle-substeps of a simulated second.
    pub fn work(&self, side: u32) -> f64 {
        f64::from(side).powi(2) * f64::from(RATE_HZ) * f64::from(self.substeps)
    }
}

/// Settings that differ in their substeps alone, which ascend.
#[derive(Clone, Debug, PartialEq)]
pub struct Family {
    /// One of them, without substeps.
    pub of: Setting,
    /// Substeps to try.
    pub substeps: Vec<u32>,
}

/// What is tried at a size; `quick` leaves out most of it.
pub fn families(side: u32, quick: bool) -> Vec<Family> {
    let mut all = Vec::new();
    use Guard::{Certified, Fast, Tuned};
    // a fixed price a substep, so the aim is no strain at all; first, since what is dearer than these is left out
    let some: &[u32] = if quick { &[3] } else { &[1, 2, 3, 4, 5, 6, 8] };
    for passes in [1, PASSES] {
        for guard in if quick { &[Fast][..] } else { &[Fast, Certified] } {
            let of = Setting { kind: Kind::OneCycle, guard: *guard, strain: 0.0, substeps: 0, passes };
            all.push(Family { of, substeps: some.into() });
        }
    }
    let mut add = |kind, guards: &[Guard], strains: &[f32], substeps: &[u32]| {
        for guard in guards {
            for strain in strains {
                let of = Setting { kind, guard: *guard, strain: *strain, substeps: 0, passes: PASSES };
                all.push(Family { of, substeps: substeps.into() });
            }
        }
    };
    let few: &[u32] = if quick { &[4, 8, 16, 24] } else { &[2, 3, 4, 5, 6, 8, 10, 12, 16, 20, 24, 32, 48, 64] };
    add(Kind::Tethers, if quick { &[Fast] } else { &[Tuned, Fast, Certified] }, &[0.0], few);
    add(Kind::TethersInertia, if quick { &[Fast] } else { &[Tuned, Fast] }, &[0.0], few);
    // limits as they are asked for, and tighter ones
    let strain = (Criterion::most_peak_pct(side) / 100.0) as f32;
    let some: &[u32] = if quick { &[16] } else { &[6, 8, 10, 12, 16, 20, 24, 32] };
    add(Kind::TethersLimit, if quick { &[Fast] } else { &[Tuned, Fast] }, &[0.6 * strain, strain], some);
    let some: &[u32] = if quick { &[2] } else { &[1, 2, 3, 4, 6] };
    add(Kind::Levels, if quick { &[Fast] } else { &[Fast, Certified] }, &[0.02, 0.05], some);
    // an explicit step needs about as many substeps as a side has particles, and more
    let many: Vec<u32> = [2, 3, 4, 6, 8, 12, 16].iter().map(|f| f * side / 4).filter(|s| *s <= 512).collect();
    let many = if quick { &many[..1] } else { &many };
    add(Kind::Plain, &[Tuned], &[0.0], many);
    add(Kind::Inertia, &[Tuned], &[0.0], many);
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_unique_and_definitions_are_sound() {
        for (side, quick) in [(128, true), (128, false), (256, false)] {
            let mut keys = std::collections::BTreeSet::new();
            for family in families(side, quick) {
                assert!(family.substeps.is_sorted() && !family.substeps.is_empty());
                for substeps in family.substeps {
                    let setting = Setting { substeps, ..family.of };
                    assert_eq!(setting.def().check(), Ok(()));
                    assert!(keys.insert(setting.key()), "{}", setting.key());
                }
            }
        }
        for kind in Kind::ALL {
            assert!(families(64, true).iter().any(|f| f.of.kind == kind), "{kind:?}");
        }
    }
}
