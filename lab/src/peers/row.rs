//! The table.

use serde::Serialize;

use super::run::Fell;

/// The cheapest setting that is good enough.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Reached {
    /// ms of CPU per simulated second.
    pub cpu_ms_per_s: f64,
    /// The setting in words; empty where it is not known.
    pub setting: String,
    /// 99th percentile of the stretch in the last second.
    pub p99_pct: Option<f64>,
    /// Largest of the whole fall.
    pub peak_pct: Option<f64>,
}

/// An engine at a size.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// The engine.
    pub engine: String,
    /// "this run" or where the row is from.
    pub source: String,
    /// Particles along each side.
    pub n: u32,
    /// ns of thread CPU per particle and iteration or substep.
    pub ns_per_particle_iteration: Option<f64>,
    /// The cheapest that keeps the mean stretch of the last second at most 1.5 %.
    pub mean_1_5: Option<Reached>,
    /// At most 0.6 %.
    pub mean_0_6: Option<Reached>,
    /// How many settings were tried; None where the row is from elsewhere.
    pub tried: Option<usize>,
}

/// The row of an engine at a size, from all its falls.
pub fn row(engine: &str, side: u32, falls: &[Fell]) -> Row {
    let finite = || falls.iter().filter(|f| f.finite);
    let reached = |most: f64| {
        let good = finite().filter(|f| f.mean_pct.is_some_and(|m| m <= most));
        let least = good.min_by(|a, b| {
            a.cpu_ms_per_s.unwrap_or(f64::INFINITY).total_cmp(&b.cpu_ms_per_s.unwrap_or(f64::INFINITY))
        })?;
        Some(Reached {
            cpu_ms_per_s: least.cpu_ms_per_s?,
            setting: format!("{} x {}", least.substeps, least.iterations),
            p99_pct: least.p99_pct,
            peak_pct: least.peak_pct,
        })
    };
    let ns = |f: &Fell| {
        let work = f64::from(side).powi(2) * f64::from(crate::fall::RATE_HZ) * f64::from(f.substeps * f.iterations);
        Some(f.cpu_ms_per_s? * 1e6 / work)
    };
    Row {
        engine: engine.into(),
        source: "this run".into(),
        n: side,
        // what is done once a frame or substep weighs least where there are many iterations
        ns_per_particle_iteration: finite().max_by_key(|f| f.substeps * f.iterations).and_then(ns),
        mean_1_5: reached(1.5),
        mean_0_6: reached(0.6),
        tried: Some(falls.len()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fell(substeps: u32, iterations: u32, ms: f64, mean: f64) -> Fell {
        Fell {
            engine: "bullet".into(),
            n: 64,
            substeps,
            iterations,
            finite: true,
            cpu_ms_per_s: Some(ms),
            mean_pct: Some(mean),
            p99_pct: Some(2.0 * mean),
            peak_pct: Some(10.0 * mean),
            height_m: Some(-0.6),
        }
    }

    #[test]
    fn the_cheapest_of_an_engine_is_in_its_row() {
        let blown = Fell { finite: false, cpu_ms_per_s: None, mean_pct: None, ..fell(8, 64, 1.0, 0.0) };
        let falls =
            [fell(1, 8, 20.0, 9.0), fell(1, 32, 80.0, 1.2), fell(2, 16, 70.0, 1.4), fell(4, 16, 150.0, 0.9), blown];
        let row = row("bullet", 64, &falls);
        let good = row.mean_1_5.unwrap();
        assert_eq!((good.cpu_ms_per_s, good.setting.as_str(), good.p99_pct), (70.0, "2 x 16", Some(2.8)));
        assert_eq!(row.mean_0_6, None);
        // 150 ms over 64 * 64 * 60 * 64 particle-iterations
        assert!((row.ns_per_particle_iteration.unwrap() - 150e6 / 15_728_640.0).abs() < 1e-9);
        assert_eq!(row.tried, Some(5));
    }
}
