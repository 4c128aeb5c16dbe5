//! What the program of the peers is asked for and what it answers.

use serde::{Deserialize, Serialize};

/// An engine of that program.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Engine {
    /// Its name there.
    pub name: &'static str,
    /// ns of a particle and iteration, roughly: how long a run will take.
    pub rough_ns: f64,
    substeps: &'static [u32],
    iterations: &'static [u32],
}

/// The engines that the program may have.
pub const ENGINES: [Engine; 2] = [
    Engine { name: "bullet", rough_ns: 150.0, substeps: &[1, 2, 4, 8], iterations: &[4, 8, 16, 32, 64, 128] },
    Engine { name: "rapier3d", rough_ns: 300.0, substeps: &[4, 8, 16, 32, 64], iterations: &[1, 2, 4, 8] },
];

/// Substeps and iterations to try, the cheap ones first; none that takes more than `most_s` seconds, roughly.
pub fn settings(engine: &Engine, side: u32, most_s: f64) -> Vec<[u32; 2]> {
    let frames = f64::from(crate::fall::SECONDS) * f64::from(crate::fall::RATE_HZ);
    let seconds =
        |[s, i]: [u32; 2]| f64::from(side).powi(2) * frames * f64::from(s) * f64::from(i) * engine.rough_ns * 1e-9;
    let mut all: Vec<[u32; 2]> =
        engine.substeps.iter().flat_map(|s| engine.iterations.iter().map(move |i| [*s, *i])).collect();
    all.retain(|s| seconds(*s) <= most_s);
    all.sort_by_key(|[s, i]| (s * i, *s));
    all
}

/// How the sheet fell in an engine.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Fell {
    /// The engine.
    pub engine: String,
    /// Particles along each side.
    pub n: u32,
    /// Substeps of a frame.
    pub substeps: u32,
    /// Iterations of a substep.
    pub iterations: u32,
    /// Whether it stayed finite; the other numbers are missing where it did not.
    pub finite: bool,
    /// ms of thread CPU per simulated second.
    pub cpu_ms_per_s: Option<f64>,
    /// Mean stretch in the last second.
    pub mean_pct: Option<f64>,
    /// 99th percentile.
    pub p99_pct: Option<f64>,
    /// Largest of the whole fall.
    pub peak_pct: Option<f64>,
    /// Mean height at the end in m.
    pub height_m: Option<f64>,
}

/// Reads the line that the program prints. Error: what is wrong with it.
pub fn parse(line: &str) -> Result<Fell, String> {
    let fell: Fell = serde_json::from_str(line.trim()).map_err(|e| format!("not a result of taut-peers: {e}"))?;
    let numbers = [fell.cpu_ms_per_s, fell.mean_pct, fell.p99_pct, fell.peak_pct];
    if fell.finite && numbers.iter().any(|x| !x.is_some_and(f64::is_finite)) {
        return Err("not a result of taut-peers: a number is missing".into());
    }
    Ok(fell)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_read_or_refused() {
        let line = r#"{"engine":"bullet","n":32,"substeps":1,"iterations":8,"finite":true,"cpu_ms_per_s":12.5,
            "mean_pct":3.25,"p99_pct":9,"peak_pct":40.5,"height_m":-0.6}"#;
        let fell = parse(line).unwrap();
        assert_eq!((fell.n, fell.cpu_ms_per_s, fell.p99_pct), (32, Some(12.5), Some(9.0)));
        let blown = r#"{"engine":"bullet","n":32,"substeps":1,"iterations":8,"finite":false}"#;
        assert!(!parse(blown).unwrap().finite);
        for bad in ["", "{}", "bullet 3.24", &line.replace("12.5", "null"), &blown.replace("false", "true")] {
            assert!(parse(bad).unwrap_err().contains("taut-peers"), "{bad}");
        }
    }

    #[test]
    fn cheap_settings_come_first_and_dear_ones_never() {
        for engine in &ENGINES {
            let some = settings(engine, 64, 20.0);
            assert!(some.is_sorted_by_key(|[s, i]| s * i) && !some.is_empty());
            assert!(some.len() < settings(engine, 32, 1e9).len());
            assert!(settings(engine, 512, 1e-3).is_empty());
        }
    }
}
