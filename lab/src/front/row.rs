//! A row of the front and its line in the CSV file.

use serde::{Deserialize, Serialize};

use super::Correction;

/// What one setting costs and how wrong it is. What is not finite or has no meaning is None. Only the times differ between
/// two runs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// The scene.
    pub scene: String,
    /// The fabric in words.
    pub fabric: String,
    /// Particles of a side.
    pub side: u32,
    /// Frames per second.
    pub rate_hz: f32,
    /// Substeps of a frame, as used.
    pub substeps: u32,
    /// euler, implicit_euler or bdf2.
    pub solver: String,
    /// Iterations of an implicit solver in each of its two linearisations; None for the explicit one.
    pub cg_iterations: Option<u32>,
    /// all, no_bend or structural.
    pub families: String,
    /// none, tethers, strain_limit, levels or one_cycle.
    pub limits: String,
    /// The slack of the tethers, or the strain of the limit.
    pub limit_pct: Option<f64>,
    /// Where the stiffness comes from.
    pub correction: Correction,

    /// Thread CPU time per particle and substep, of the median frame.
    pub ns_per_particle_step: f64,
    /// The same in plain steps of this machine at that time ([`super::plain_ns`]).
    pub cost_in_plain_steps: f64,
    /// Thread CPU time of a simulated second, of the median frame.
    pub cpu_ms_per_simulated_s: f64,
    /// Thread CPU time of the frame that 5 % exceed.
    pub frame_us_p95: f64,
    /// `cost_in_plain_steps` times the substeps of a second over those of 60 Hz x 16: what it costs beside the plain cloth
    /// of the same size.
    pub relative_cost: f64,
    /// Memory of the cloth.
    pub memory_bytes: u64,

    /// Largest structural stretch late in the run: at its end where the scene rests, else the mean of ten frames' largest.
    pub stretch_max_pct: Option<f64>,
    /// Its 99th percentile.
    pub stretch_p99_pct: Option<f64>,
    /// Its mean; what is compressed counts below 0.
    pub stretch_mean_pct: Option<f64>,
    /// Largest over all frames.
    pub peak_stretch_pct: Option<f64>,
    /// Against the fabric's reference: rms difference of the sorted strains.
    pub strain_error_points: Option<f64>,
    /// Rms distance of the particles to the reference at the end, as a share of the side; only in hang2 and edge, where
    /// folds do not bifurcate.
    pub distance_pct: Option<f64>,
    /// Rms error of the centre of mass over the run.
    pub centre_error_mm: Option<f64>,
    /// Error of the mean kinetic energy over the run, in the scenes that do not come to rest; above 0 it moves more than the
    /// reference.
    pub kinetic_energy_error_pct: Option<f64>,
    /// Error of the period; only in swing.
    pub period_error_pct: Option<f64>,
    /// Whether K is that of the reference: the errors are then those of the step alone.
    pub same_stiffness: bool,
    /// Share of K that the budget took.
    pub cut_fraction: f64,
    /// Inertia added, as a share of the free mass.
    pub inertia_added: f64,
    /// Root mean square speed at the end: 0 is at rest.
    pub rms_speed_m_s: Option<f64>,
    /// Whether every frame was finite.
    pub finite: bool,
    /// Hash of the state at the end.
    pub state_hash: String,
}

/// The number where it is finite.
pub(super) fn finite(x: f64) -> Option<f64> {
    x.is_finite().then_some(x)
}

/// All rows as CSV, with the keys of the JSON rows as its first line. What is missing is empty.
///
/// Error: the text of serde_json, which no row gives.
pub fn csv(rows: &[impl Serialize]) -> Result<String, String> {
    let mut text = String::new();
    for (i, row) in rows.iter().enumerate() {
        let value = serde_json::to_value(row).map_err(|e| e.to_string())?;
        let Some(fields) = value.as_object() else { continue };
        if i == 0 {
            text += &(fields.keys().map(String::as_str).collect::<Vec<_>>().join(",") + "\n");
        }
        let cells = fields.values().map(|v| match v {
            serde_json::Value::Null => String::new(),
            serde_json::Value::String(s) if s.contains([',', '"', '\n']) => format!("\"{}\"", s.replace('"', "\"\"")),
            serde_json::Value::String(s) => s.clone(),
            other => other.to_string(),
        });
        text += &(cells.collect::<Vec<_>>().join(",") + "\n");
    }
    Ok(text)
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// A row of hang2 with a cost and errors.
    pub fn row(correction: Correction, limits: &str, cost: f64, stretch: f64, error: f64) -> Row {
        Row {
            scene: "hang2".into(),
            fabric: "denim".into(),
            side: 32,
            rate_hz: 60.0,
            substeps: 16,
            solver: "euler".into(),
            cg_iterations: None,
            families: "all".into(),
            limits: limits.into(),
            limit_pct: None,
            correction,
            ns_per_particle_step: 10.0 * cost,
            cost_in_plain_steps: cost,
            cpu_ms_per_simulated_s: 10.0 * cost,
            frame_us_p95: 1.0,
            relative_cost: cost,
            memory_bytes: 1,
            stretch_max_pct: finite(stretch),
            stretch_p99_pct: None,
            stretch_mean_pct: None,
            peak_stretch_pct: None,
            strain_error_points: finite(error),
            distance_pct: None,
            centre_error_mm: None,
            kinetic_energy_error_pct: None,
            period_error_pct: None,
            same_stiffness: false,
            cut_fraction: 0.0,
            inertia_added: 0.0,
            rms_speed_m_s: None,
            finite: stretch.is_finite(),
            state_hash: "0".into(),
        }
    }

    #[test]
    fn a_csv_line_has_as_many_cells_as_the_first() {
        let mut rows = vec![row(Correction::Uniform, "none", 1.0, 15.0, 2.0)];
        rows.push(row(Correction::Generated, "levels", 2.0, f64::NAN, f64::NAN));
        rows[1].fabric = "denim, \"blue\"".into();
        let text = csv(&rows).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        assert!(lines[0].contains("scene") && lines[0].contains("stretch_max_pct"), "{}", lines[0]);
        assert_eq!(lines[0].split(',').count(), lines[1].split(',').count());
        assert!(lines[2].contains("\"denim, \"\"blue\"\"\"") && lines[2].contains(",,"), "{}", lines[2]);
        // a ledger gives back what it took
        let json = serde_json::to_string(&rows[1]).unwrap();
        assert_eq!(serde_json::from_str::<Row>(&json).unwrap(), rows[1]);
    }
}
