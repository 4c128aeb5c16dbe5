//! What the search found, beside the bound of the core and what was aimed at.

use serde::{Deserialize, Serialize};
use taut::Width;

use super::Kind;
use super::search::{Criterion, Trial};
use crate::bound::Throughput;
use crate::plot::{Axis, Chart, Mark};

/// A cell of the table: the cheapest setting of a size in a width that is good enough.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Particles along each side.
    pub n: u32,
    /// mean_1.5, mean_0.6 or peak: see [`Criterion`].
    pub criterion: String,
    /// scalar, sse2, avx2, avx512 or neon.
    pub width: String,
    /// The setting in words.
    pub setting: String,
    /// Substeps of a frame.
    pub substeps: u32,
    /// ms of thread CPU per simulated second.
    pub cpu_ms_per_s: f64,
    /// ns per particle and substep.
    pub ns_per_particle_step: f64,
    /// What the springs of these substeps take at least on this core, every spring once: [`Throughput::once_ns`].
    pub bound_ms_per_s: Option<f64>,
    /// That bound over the time.
    pub share_of_bound: Option<f64>,
    /// What was aimed at on a Zen 5 in ms per simulated second.
    pub target_zen5_ms_per_s: Option<f64>,
    /// The same, times the ratio of this core's bound to that of the Zen 5.
    pub target_here_ms_per_s: Option<f64>,
    /// Mean stretch in the last second in percent.
    pub mean_pct: f64,
    /// 99th percentile in the last second.
    pub p99_pct: f64,
    /// Largest stretch of the whole fall.
    pub peak_pct: f64,
    /// Root mean square error of the centre of mass.
    pub com_error_mm: f64,
}

impl Row {
    /// A row. None where the sheet blew up.
    pub fn new(
        side: u32,
        criterion: Criterion,
        width: Width,
        trial: &Trial,
        ms_per_s: f64,
        bound: Option<&Throughput>,
    ) -> Option<Row> {
        let quality = trial.quality?;
        let work = trial.setting.work(side);
        let bound_ms = bound.map(|b| b.once_ns() * work * 1e-6);
        let target = target_ms(side, criterion, width);
        let scale = bound.zip(zen5_once_ns(width)).map(|(here, there)| here.once_ns() / there);
        Some(Row {
            n: side,
            criterion: criterion.name().into(),
            width: width.name().into(),
            setting: trial.setting.key(),
            substeps: trial.setting.substeps,
            cpu_ms_per_s: ms_per_s,
            ns_per_particle_step: ms_per_s * 1e6 / work,
            bound_ms_per_s: bound_ms,
            share_of_bound: bound_ms.map(|b| b / ms_per_s),
            target_zen5_ms_per_s: target,
            target_here_ms_per_s: target.zip(scale).map(|(t, s)| t * s),
            mean_pct: quality.mean_pct,
            p99_pct: quality.p99_pct,
            peak_pct: quality.peak_pct,
            com_error_mm: quality.com_error_mm,
        })
    }
}

/// Every spring once on one core of a Zen 5, in ns per particle-step: measured by other runs on that machine, with the FMA
/// contraction that taut does without.
pub fn zen5_once_ns(width: Width) -> Option<f64> {
    match width {
        Width::Sse2 => Some(2.5),
        Width::Avx2 => Some(1.26),
        Width::Avx512 => Some(0.64),
        _ => None,
    }
}

/// What was aimed at on that machine, in ms per simulated second.
pub fn target_ms(side: u32, criterion: Criterion, width: Width) -> Option<f64> {
    let [avx2, avx512] = match (criterion, side) {
        (Criterion::Mean15, 64) => [7.0, 3.3],
        (Criterion::Mean15, 128) => [45.0, 22.0],
        (Criterion::Mean15, 256) => [180.0, 90.0],
        (Criterion::Peak, 64) => [13.0, 7.0],
        (Criterion::Peak, 128) => [50.0, 26.0],
        (Criterion::Peak, 256) => [200.0, 110.0],
        _ => return None,
    };
    match width {
        Width::Avx2 => Some(avx2),
        Width::Avx512 => Some(avx512),
        _ => None,
    }
}

/// Cost over size: lines of each width for the loosest and the strictest criterion. None without rows.
pub fn cost_chart(rows: &[Row], processor: &str) -> Option<Chart> {
    if rows.is_empty() {
        return None;
    }
    let (low, high) =
        rows.iter().fold((f64::INFINITY, 0.0f64), |(l, h), r| (l.min(r.cpu_ms_per_s), h.max(r.cpu_ms_per_s)));
    let sides = rows.iter().map(|r| f64::from(r.n));
    let (least, most) = (sides.clone().fold(f64::INFINITY, f64::min), sides.fold(0.0, f64::max));
    // an axis of a single size has no numbers
    let along = if least == most { format!(": {least}") } else { String::new() };
    let along = format!("particles along each side{along}");
    let mut chart = Chart::new(
        &format!("A falling sheet on {processor}"),
        Axis::log(&along),
        // room for the legend above the lines
        Axis { range: Some([low / 1.5, 50.0 * high]), ..Axis::log("ms of CPU per simulated second") },
    );
    for (criterion, name) in [(Criterion::Mean15, "mean 1.5 %"), (Criterion::Peak, "peak")] {
        for width in Width::ALL {
            let of = |r: &&Row| r.width == width.name() && r.criterion == criterion.name();
            let points: Vec<[f64; 2]> = rows.iter().filter(of).map(|r| [f64::from(r.n), r.cpu_ms_per_s]).collect();
            if !points.is_empty() {
                chart = chart.with(&format!("{} {name}", width.name()), Mark::Line, points);
            }
        }
    }
    Some(chart)
}

/// Peak over cost: what each kind of a size reaches. None where nothing stayed finite.
pub fn peak_chart(side: u32, trials: &[Trial]) -> Option<Chart> {
    let mut chart = Chart::new(
        &format!("{side} x {side}: largest stretch of the fall"),
        Axis::log("ms of CPU per simulated second"),
        Axis::log("peak in %"),
    );
    let mut any = false;
    for kind in Kind::ALL {
        let of = |t: &&Trial| t.setting.kind == kind;
        let points: Vec<[f64; 2]> = trials
            .iter()
            .filter(of)
            .filter_map(|t| Some([t.ms_per_s, t.quality?.peak_pct]))
            .filter(|p| p[1] < 1000.0)
            .collect();
        any |= !points.is_empty();
        let name = match kind {
            Kind::OneCycle => "levels, one cycle".into(),
            _ => kind.name().replace('_', " + "),
        };
        chart = chart.with(&name, Mark::Points, points);
    }
    any.then_some(chart)
}

#[cfg(test)]
mod tests {
    use super::super::{Guard, PASSES, Quality, Setting};
    use super::*;
    use crate::plot::Figure;

    fn trial() -> Trial {
        let setting = Setting { kind: Kind::Tethers, guard: Guard::Fast, substeps: 10, strain: 0.0, passes: PASSES };
        let quality = Quality { mean_pct: 0.1, p99_pct: 0.2, peak_pct: 4.0, com_error_mm: 9.0 };
        Trial { setting, quality: Some(quality), ms_per_s: 24.0, hash: String::new() }
    }

    #[test]
    fn a_row_knows_its_bound_and_its_target() {
        let bound = Throughput {
            width: Width::Avx2,
            sqrt_ns: 0.1,
            div_ns: 0.11,
            both_ns: 0.21,
            arithmetic_ns: 1e-6,
            byte_ns: 0.0,
        };
        assert!((bound.once_ns() - 1.26).abs() < 1e-12);
        let row = Row::new(64, Criterion::Peak, Width::Avx2, &trial(), 24.0, Some(&bound)).unwrap();
        // 64 * 64 * 60 * 10 particle-steps a second
        assert!((row.ns_per_particle_step - 24.0e6 / 2_457_600.0).abs() < 1e-9);
        assert!((row.bound_ms_per_s.unwrap() - 1.26 * 2.4576).abs() < 1e-9);
        assert!((row.share_of_bound.unwrap() - 1.26 * 2.4576 / 24.0).abs() < 1e-9);
        assert_eq!(row.target_zen5_ms_per_s, Some(13.0));
        assert!((row.target_here_ms_per_s.unwrap() - 13.0).abs() < 1e-9, "this core is as fast as that");
        let blown = Trial { quality: None, ..trial() };
        assert_eq!(Row::new(64, Criterion::Peak, Width::Avx2, &blown, 24.0, None), None);
        assert_eq!(target_ms(64, Criterion::Mean06, Width::Avx2), None);
        assert_eq!(target_ms(64, Criterion::Peak, Width::Sse2), None);
    }

    #[test]
    fn charts_are_drawn() {
        let row = Row::new(64, Criterion::Peak, Width::Avx2, &trial(), 24.0, None).unwrap();
        let row2 = Row { n: 128, cpu_ms_per_s: 100.0, ..row.clone() };
        assert_eq!(cost_chart(&[row, row2], "a core").unwrap().png().unwrap()[..4], *b"\x89PNG");
        assert!(cost_chart(&[], "a core").is_none());
        assert!(peak_chart(64, &[trial()]).unwrap().png().is_ok());
        assert!(peak_chart(64, &[Trial { quality: None, ..trial() }]).is_none());
    }
}
