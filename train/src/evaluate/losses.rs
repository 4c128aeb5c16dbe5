//! Fig. 8: the terms of the loss added one by one, and cross entropy against least squares, on unseen fabrics.

use serde::{Deserialize, Serialize};
use taut_lab::plot::{Axis, Chart, Mark};

use super::ladder::{self, rungs};
use super::score::{Scores, SetScores, Spread};
use super::table::{number, table};
use super::{Bench, EvaluateError};
use crate::gan::TrainConfig;

/// Seeds of each rung.
const SEEDS: u64 = 3;

/// A net.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// The rung.
    pub rung: String,
    /// The seed.
    pub seed: u64,
    /// Steps of training.
    pub steps: usize,
    /// Of its pictures.
    pub scores: SetScores,
    /// Of a cloth as stiff as the step allows.
    pub uniform: SetScores,
}

/// A rung over its seeds.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Summary {
    /// The rung.
    pub rung: String,
    /// Seeds.
    pub seeds: usize,
    /// Mean and deviation over the seeds of the mean over the pictures.
    pub scores: SetScores,
    /// Deviation over the pictures of a net, mean over the seeds.
    pub nmse_deviation_of_pictures: f64,
}

/// Trains the nets and scores them. None stands for what another shard has.
pub fn rows(bench: &mut Bench<'_>) -> Result<Vec<Option<Row>>, EvaluateError> {
    let quick = bench.quick;
    let steps = ladder::steps(bench.minutes, quick);
    let rungs = rungs(steps, quick);
    // the other rungs follow from their names
    let made_with = (rungs[0].config.clone(), bench.data_set.is_some());
    // the nets of a seed together: they share a training set
    let all: Vec<usize> = if quick { vec![0, 1, rungs.len() - 1] } else { (0..rungs.len()).collect() };
    let seeds = if quick { 1 } else { SEEDS };
    let jobs: Vec<(u64, usize)> = (1..=seeds).flat_map(|seed| all.iter().map(move |r| (seed, *r))).collect();
    bench.rows(
        "8",
        &made_with,
        &jobs,
        |(seed, r)| format!("{}, seed {seed}", rungs[*r].name),
        |bench, (seed, r)| {
            let config = TrainConfig { seed: *seed, ..rungs[*r].config.clone() };
            let net = bench.net(&config, &format!("{}, seed {seed}", rungs[*r].name))?;
            let test = bench.test(&config)?;
            Ok(Row {
                rung: rungs[*r].name.into(),
                seed: *seed,
                steps,
                scores: SetScores::of(&test.scores(&net, config.inertia)?),
                uniform: SetScores::of(&test.uniform(config.inertia)?),
            })
        },
    )
}

/// The rungs in their order.
pub fn summaries(rows: &[&Row]) -> Vec<Summary> {
    let mut names: Vec<&str> = Vec::new();
    for row in rows {
        if !names.contains(&row.rung.as_str()) {
            names.push(&row.rung);
        }
    }
    let summary = |name: &&str| {
        let of: Vec<&&Row> = rows.iter().filter(|r| r.rung == *name).collect();
        let means: Vec<Scores> = of.iter().map(|r| r.scores.mean()).collect();
        Summary {
            rung: name.to_string(),
            seeds: of.len(),
            scores: SetScores::of(&means),
            nmse_deviation_of_pictures: Spread::of(of.iter().map(|r| r.scores.nmse.deviation)).mean,
        }
    };
    names.iter().map(summary).collect()
}

/// The rungs as text, uniform K last.
pub fn text(rows: &[&Row]) -> String {
    let spread = |s: Spread, digits| format!("{} ± {}", number(s.mean, digits), number(s.deviation, digits));
    let line = |name: &str, s: &SetScores, pictures: f64| {
        let cells = [spread(s.nmse, 4), number(pictures, 4), spread(s.ssim, 4), spread(s.psnr_db, 2)];
        [vec![name.to_string()], cells.to_vec()].concat()
    };
    let mut lines: Vec<Vec<String>> =
        summaries(rows).iter().map(|s| line(&s.rung, &s.scores, s.nmse_deviation_of_pictures)).collect();
    if let Some(row) = rows.first() {
        let (u, pictures) = (row.uniform.mean(), row.uniform.nmse.deviation);
        let cells = [number(u.nmse, 4), number(pictures, 4), number(u.ssim, 4), number(u.psnr_db, 2)];
        lines.push([vec!["uniform at the budget".to_string()], cells.to_vec()].concat());
    }
    table(&["losses", "NMSE", "of pictures", "SSIM", "PSNR dB"], &lines)
}

/// NMSE over the rungs, the seeds as points.
pub fn chart(rows: &[&Row]) -> Chart {
    let summaries = summaries(rows);
    let names: Vec<String> = summaries.iter().enumerate().map(|(i, s)| format!("{} {}", i + 1, s.rung)).collect();
    let means = summaries.iter().enumerate().map(|(i, s)| [i as f64 + 1.0, s.scores.nmse.mean]).collect();
    let place = |r: &&&Row| summaries.iter().position(|s| s.rung == r.rung).map_or(f64::NAN, |i| i as f64 + 1.0);
    let seeds = rows.iter().map(|r| [place(&r), r.scores.nmse.mean]).collect();
    let mut chart = Chart::new("Fig. 8: losses added one by one", Axis::linear(&names.join("   ")), Axis::log("NMSE"))
        .with("mean of the seeds", Mark::Line, means)
        .with("seeds", Mark::Points, seeds);
    if let Some(row) = rows.first() {
        let height = row.uniform.nmse.mean;
        chart = chart.with("uniform at the budget", Mark::Line, vec![[1.0, height], [summaries.len() as f64, height]]);
    }
    chart.size = (1100, 600);
    chart
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rung_is_the_mean_of_its_seeds() {
        let set = |nmse: f64| {
            let s = |mean| Spread { mean, deviation: 0.1 };
            SetScores { psnr_db: s(20.0), ssim: s(0.9), nmse: s(nmse) }
        };
        let row =
            |rung: &str, seed, nmse| Row { rung: rung.into(), seed, steps: 1, scores: set(nmse), uniform: set(0.3) };
        let rows = [row("a", 1, 0.2), row("b", 1, 0.1), row("a", 2, 0.4), row("b", 2, 0.1)];
        let rows: Vec<&Row> = rows.iter().collect();
        let s = summaries(&rows);
        assert_eq!(s.iter().map(|s| (s.rung.as_str(), s.seeds)).collect::<Vec<_>>(), [("a", 2), ("b", 2)]);
        assert!(
            (s[0].scores.nmse.mean - 0.3).abs() < 1e-12 && (s[0].scores.nmse.deviation - 0.02f64.sqrt()).abs() < 1e-12
        );
        assert!((s[1].scores.nmse.deviation, s[1].nmse_deviation_of_pictures) == (0.0, 0.1));
        assert!(text(&rows).contains("0.3000 ± 0.1414") && text(&rows).contains("uniform at the budget"));
    }
}
