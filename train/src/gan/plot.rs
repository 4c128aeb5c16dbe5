//! The losses of a run as a chart.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use taut_lab::plot::{Axis, Chart, Mark};

use super::TrainError;

/// Losses that are drawn, as the log names them, and what the legend says.
const DRAWN: [(&str, &str); 9] = [
    ("generator", "generator, all terms"),
    ("adversarial", "adversarial"),
    ("discriminator", "discriminator"),
    ("weights", "L2"),
    ("picture", "paired pictures"),
    ("field", "field"),
    ("stretch_pct", "stretch in %"),
    ("gradient_norm", "gradient, generator"),
    ("discriminator_gradient_norm", "gradient, discriminator"),
];

/// The chart of a log (`log.jsonl`): every loss that was not 0 over the steps, and the scores of the evaluation set.
///
/// # Errors
/// [`TrainError::File`] for a log that cannot be read.
pub fn losses(log: &Path) -> Result<Chart, TrainError> {
    let text = fs::read_to_string(log).map_err(|e| TrainError::file(log, e))?;
    let mut points: BTreeMap<&str, Vec<[f64; 2]>> = BTreeMap::new();
    let mut scores = Vec::new();
    for line in text.lines() {
        let line: serde_json::Value = serde_json::from_str(line).map_err(|e| TrainError::file(log, e))?;
        let Some(step) = line["step"].as_f64() else { continue };
        for (key, _) in DRAWN {
            if let Some(value) = line["losses"][key].as_f64().filter(|v| *v > 0.0) {
                points.entry(key).or_default().push([step, value]);
            }
        }
        if let Some(score) = line["evaluation_nmse"].as_f64() {
            scores.push([step, score]);
        }
    }
    let mut chart = Chart::new("losses of the run", Axis::linear("step"), Axis::log("loss"));
    for (key, name) in DRAWN {
        if let Some(points) = points.remove(key) {
            chart = chart.with(name, Mark::Points, points);
        }
    }
    // room for the legend
    let last = chart.series.iter().flat_map(|s| &s.points).map(|p| p[0]).fold(1.0, f64::max);
    chart.x.range = Some([0.0, 1.5 * last]);
    if !scores.is_empty() {
        chart = chart.with("NMSE, evaluation set", Mark::Line, scores);
    }
    Ok(chart)
}

#[cfg(test)]
mod tests {
    use super::*;
    use taut_lab::plot::Figure;

    #[test]
    fn every_loss_that_was_there_is_drawn() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("log.jsonl");
        let lines = [
            r#"{"step":1,"losses":{"generator":2.0,"picture":0.0,"gradient_norm":7.5}}"#,
            r#"{"step":2,"losses":{"generator":1.0,"picture":0.0,"gradient_norm":null}}"#,
            r#"{"step":2,"evaluation_nmse":0.5}"#,
        ];
        fs::write(&path, lines.join("\n")).unwrap();
        let chart = losses(&path).unwrap();
        let drawn: Vec<(&str, usize)> = chart.series.iter().map(|s| (s.name.as_str(), s.points.len())).collect();
        assert_eq!(drawn, [("generator, all terms", 2), ("gradient, generator", 1), ("NMSE, evaluation set", 1)]);
        assert!(chart.png().is_ok());
        assert!(losses(&folder.path().join("none")).is_err());
    }
}
