//! Fig. 7: pictures of the generated cloth against the clean reference, for nets trained with 1 to 6 % of white noise.

use serde::{Deserialize, Serialize};
use taut_lab::plot::{Axis, Chart, Mark};

use super::ladder::{self, noisy};
use super::net::Net;
use super::paper::Paper;
use super::score::SetScores;
use super::table::{number, table};
use super::{Bench, EvaluateError};

/// The noise of the nets in percent of the range.
const PERCENTS: [u32; 6] = [1, 2, 3, 4, 5, 6];

/// A net.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Noise on the pictures in training, percent of the range; none for the file that stands for ours, which had 1 to 5 %
    /// and the whole recipe.
    pub noise_pct: Option<u32>,
    /// Steps of training, of a net that was trained here.
    pub steps: Option<usize>,
    /// Pictures.
    pub pictures: usize,
    /// Of the generated cloth.
    pub generated: SetScores,
    /// Of a cloth as stiff as the step allows, with the same inertia.
    pub uniform: SetScores,
}

/// Trains the nets and scores them. None stands for what another shard has.
pub fn rows(bench: &mut Bench<'_>) -> Result<Vec<Option<Row>>, EvaluateError> {
    let steps = ladder::steps(bench.minutes, bench.quick);
    let percents = if bench.quick { &PERCENTS[..2] } else { &PERCENTS };
    let quick = bench.quick;
    let made_with = (noisy(0, steps, quick), bench.model_digest()?, bench.data_set.is_some());
    let jobs: Vec<Option<u32>> = percents.iter().copied().map(Some).chain([None]).collect();
    bench.rows(
        "7",
        &made_with,
        &jobs,
        |p| p.map_or("ours".into(), |p| format!("{p} %")),
        |bench, percent| {
            let config = noisy(percent.unwrap_or(0), steps, quick);
            let net = match percent {
                Some(percent) => bench.net(&config, &format!("{percent} % noise"))?,
                None => Net::load(&bench.model)?,
            };
            let test = bench.test(&config)?;
            Ok(Row {
                noise_pct: *percent,
                steps: percent.map(|_| steps),
                pictures: test.items.len(),
                generated: SetScores::of(&test.scores(&net, config.inertia)?),
                uniform: SetScores::of(&test.uniform(config.inertia)?),
            })
        },
    )
}

/// The rows as text.
pub fn text(rows: &[&Row]) -> String {
    let line = |r: &&Row| {
        let (g, u) = (r.generated.mean(), r.uniform.mean());
        vec![
            r.noise_pct.map_or("our file".into(), |p| format!("{p} %")),
            number(g.psnr_db, 2),
            number(g.ssim, 4),
            number(g.nmse, 4),
            number(u.psnr_db, 2),
            number(u.ssim, 4),
            number(u.nmse, 4),
        ]
    };
    let header = ["noise", "PSNR dB", "SSIM", "NMSE", "uniform PSNR", "SSIM", "NMSE"];
    table(&header, &rows.iter().map(line).collect::<Vec<_>>())
}

/// PSNR over the noise, beside uniform K and the paper's two lines.
pub fn chart(rows: &[&Row]) -> Chart {
    let points =
        |f: fn(&Row) -> f64| rows.iter().filter_map(|r| Some([f64::from(r.noise_pct?), f(r)])).collect::<Vec<_>>();
    let file = rows.iter().filter(|r| r.noise_pct.is_none()).map(|r| r.generated.psnr_db.mean);
    let file: Vec<[f64; 2]> = file.flat_map(|db| [[1.0, db], [6.0, db]]).collect();
    let paper = Paper::default();
    Chart::new("Fig. 7: pictures under noise in training", Axis::linear("white noise in %"), Axis::linear("PSNR in dB"))
        .with("generated", Mark::Line, points(|r| r.generated.psnr_db.mean))
        .with("our file", Mark::Line, file)
        .with("uniform at the budget", Mark::Line, points(|r| r.uniform.psnr_db.mean))
        .with(
            "paper: above this below 4 %",
            Mark::Line,
            vec![[1.0, paper.psnr_below_4_pct_db], [4.0, paper.psnr_below_4_pct_db]],
        )
        .with(
            "paper: below this above 4 %",
            Mark::Line,
            vec![[4.0, paper.psnr_above_4_pct_db], [6.0, paper.psnr_above_4_pct_db]],
        )
}
