//! Which setting is the cheapest that is good enough.

use serde::{Deserialize, Serialize};

use super::run::Quality;
use super::setting::{Family, Setting};

/// A setting whose centre of mass is farther off, root mean square over the fall, does not count: a sheet that is held up in
/// the air stretches little.
pub const MOST_COM_ERROR_MM: f64 = 30.0;

/// What the 99th percentile of the stretch at rest has to be below, in percent.
pub const REST_P99_PCT: f64 = 0.3;

/// What is asked of a fall, beside [`MOST_COM_ERROR_MM`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Criterion {
    /// Mean stretch in the last second at most 1.5 %, and [`REST_P99_PCT`] at rest.
    #[serde(rename = "mean_1.5")]
    Mean15,
    /// At most 0.6 %, and the same.
    #[serde(rename = "mean_0.6")]
    Mean06,
    /// The largest stretch of the whole fall under 5 % for up to 64 particles a side, 8 % for up to 128, 14 % above, and
    /// [`REST_P99_PCT`] at rest.
    Peak,
}

impl Criterion {
    /// All of them.
    pub const ALL: [Criterion; 3] = [Criterion::Mean15, Criterion::Mean06, Criterion::Peak];

    /// The name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Criterion::Mean15 => "mean_1.5",
            Criterion::Mean06 => "mean_0.6",
            Criterion::Peak => "peak",
        }
    }

    /// Largest peak in percent that [`Criterion::Peak`] allows.
    pub fn most_peak_pct(side: u32) -> f64 {
        match side {
            ..=64 => 5.0,
            65..=128 => 8.0,
            _ => 14.0,
        }
    }

    /// Whether a fall is good enough.
    pub fn met(self, side: u32, q: &Quality) -> bool {
        q.com_error_mm <= MOST_COM_ERROR_MM
            && q.p99_pct < REST_P99_PCT
            && match self {
                Criterion::Mean15 => q.mean_pct <= 1.5,
                Criterion::Mean06 => q.mean_pct <= 0.6,
                Criterion::Peak => q.peak_pct < Criterion::most_peak_pct(side),
            }
    }
}

/// A setting that was tried once.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Trial {
    /// The setting.
    pub setting: Setting,
    /// How the sheet fell; None where it blew up.
    pub quality: Option<Quality>,
    /// Thread CPU time per simulated second in ms.
    pub ms_per_s: f64,
    /// Hash of the state at the end, 16 hexadecimal digits.
    pub hash: String,
}

impl Trial {
    fn meets(&self, side: u32, criterion: Criterion) -> bool {
        self.quality.is_some_and(|q| criterion.met(side, &q))
    }
}

/// Tries the families one after the other, each with more and more substeps until every criterion is met, or until one more
/// try would cost more than any criterion has to.
pub fn search<E>(
    side: u32,
    families: &[Family],
    mut measure: impl FnMut(&Setting) -> Result<Trial, E>,
) -> Result<Vec<Trial>, E> {
    /// How far a time may be off by what else runs on the machine.
    const NOISE: f64 = 1.5;
    let mut all: Vec<Trial> = Vec::new();
    for family in families {
        for substeps in &family.substeps {
            let trial = measure(&Setting { substeps: *substeps, ..family.of })?;
            let done = Criterion::ALL.iter().all(|c| trial.meets(side, *c));
            let cost = trial.ms_per_s;
            all.push(trial);
            let dearest = Criterion::ALL
                .iter()
                .map(|c| cheapest(side, *c, &all).map_or(f64::INFINITY, |t| t.ms_per_s))
                .fold(0.0, f64::max);
            if done || cost > NOISE * dearest {
                break;
            }
        }
    }
    Ok(all)
}

/// The cheapest trial that is good enough.
pub fn cheapest(side: u32, criterion: Criterion, trials: &[Trial]) -> Option<&Trial> {
    candidates(side, criterion, trials, 1).first().copied()
}

/// The cheapest few, since another width has other costs.
pub fn candidates(side: u32, criterion: Criterion, trials: &[Trial], most: usize) -> Vec<&Trial> {
    let mut good: Vec<&Trial> = trials.iter().filter(|t| t.meets(side, criterion)).collect();
    good.sort_by(|a, b| a.ms_per_s.total_cmp(&b.ms_per_s));
    good.truncate(most);
    good
}

#[cfg(test)]
mod tests {
    use super::super::setting::{Guard, Kind, PASSES};
    use super::*;

    /// Costs 1 ms a substep, stretches by 6 % / substeps.
    fn made(setting: &Setting, share: f64, com_error_mm: f64) -> Trial {
        let mean = 6.0 / f64::from(setting.substeps) * share;
        let quality = Quality { mean_pct: mean, p99_pct: 0.1, peak_pct: 10.0 * mean, com_error_mm };
        Trial {
            setting: *setting,
            quality: (setting.substeps > 1).then_some(quality),
            ms_per_s: f64::from(setting.substeps),
            hash: String::new(),
        }
    }

    fn family(kind: Kind) -> Family {
        let of = Setting { kind, guard: Guard::Tuned, substeps: 0, strain: 0.0, passes: PASSES };
        Family { of, substeps: vec![1, 2, 4, 8, 16, 32, 64, 128] }
    }

    #[test]
    fn the_cheapest_that_is_good_enough_is_found() {
        let families = [family(Kind::Plain), family(Kind::Tethers), family(Kind::Levels)];
        let mut tried = Vec::new();
        let trials = search(64, &families, |s| {
            tried.push((s.kind, s.substeps));
            Ok::<_, ()>(match s.kind {
                Kind::Plain => made(s, 1.0, 10.0),
                Kind::Tethers => made(s, 0.5, 10.0),
                // hangs in the air
                _ => made(s, 0.01, MOST_COM_ERROR_MM + 1.0),
            })
        })
        .unwrap();
        let best = |c| cheapest(64, c, &trials).map(|t| (t.setting.kind, t.setting.substeps));
        assert_eq!(best(Criterion::Mean15), Some((Kind::Tethers, 2)));
        assert_eq!(best(Criterion::Mean06), Some((Kind::Tethers, 8)));
        // 60 % / substeps is under 5 % from 16 on; with tethers from 8 on
        assert_eq!(best(Criterion::Peak), Some((Kind::Tethers, 8)));
        // plain ends where everything is met, the levels where they cost more than the tethers
        let last = |kind| tried.iter().rfind(|t| t.0 == kind).unwrap().1;
        assert_eq!((last(Kind::Plain), last(Kind::Tethers), last(Kind::Levels)), (16, 8, 16));
        let few = candidates(64, Criterion::Mean15, &trials, 3);
        assert_eq!(few.iter().map(|t| t.ms_per_s).collect::<Vec<_>>(), [2.0, 4.0, 4.0]);
    }

    #[test]
    fn criteria_are_those_of_the_size() {
        let q = Quality { mean_pct: 0.1, p99_pct: 0.29, peak_pct: 7.9, com_error_mm: 5.0 };
        assert!(!Criterion::Peak.met(64, &q) && Criterion::Peak.met(128, &q) && Criterion::Peak.met(256, &q));
        assert!(!Criterion::Peak.met(128, &Quality { p99_pct: 0.3, ..q }));
        assert!(!Criterion::Mean15.met(64, &Quality { mean_pct: 1.51, ..q }));
        assert!(!Criterion::Mean06.met(64, &Quality { com_error_mm: 30.1, ..q }));
        assert!(!Criterion::Mean06.met(64, &Quality { mean_pct: f64::NAN, ..q }));
    }
}
