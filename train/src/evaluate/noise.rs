//! Fig. 7: pictures of the generated cloth against the clean reference, for nets trained with 1 to 6 % of white noise.

use serde::{Deserialize, Serialize};
use taut_lab::plot::{Axis, Chart, Mark};

use super::ladder::{self, noisy};
use super::score::SetScores;
use super::table::{number, table};
use super::{Bench, EvaluateError};

/// The noise of the nets in percent of the range.
const PERCENTS: [u32; 6] = [1, 2, 3, 4, 5, 6];

/// Steps of such a net in a minute of one core, so that the figure does not depend on the machine.
const STEPS_PER_MINUTE: f64 = 60.0;

/// Fabrics of the test pictures, each in two scenes: 32 pictures.
const FABRICS: usize = 16;

/// A net.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Noise on the pictures in training, percent of the range.
    pub noise_pct: u32,
    /// Steps of training.
    pub steps: usize,
    /// Pictures.
    pub pictures: usize,
    /// Of the generated cloth.
    pub generated: SetScores,
    /// Of a cloth as stiff as the step allows, with the same inertia.
    pub uniform: SetScores,
}

/// Trains the nets and scores them. None stands for what another shard has.
pub fn rows(bench: &mut Bench<'_>) -> Result<Vec<Option<Row>>, EvaluateError> {
    let steps = ladder::steps(bench.minutes, STEPS_PER_MINUTE, bench.quick);
    let percents = if bench.quick { &PERCENTS[..2] } else { &PERCENTS };
    let quick = bench.quick;
    let base = noisy(0, steps, quick);
    bench.rows(
        "7",
        &base,
        percents,
        |p| format!("{p} %"),
        |bench, percent| {
            let config = noisy(*percent, steps, quick);
            let net = bench.net(&config, &format!("{percent} % noise"))?;
            let test = bench.test(&config, if quick { 1 } else { FABRICS })?;
            Ok(Row {
                noise_pct: *percent,
                steps,
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
            format!("{} %", r.noise_pct),
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
    let points = |f: fn(&Row) -> f64| rows.iter().map(|r| [f64::from(r.noise_pct), f(r)]).collect::<Vec<_>>();
    Chart::new("Fig. 7: pictures under noise in training", Axis::linear("white noise in %"), Axis::linear("PSNR in dB"))
        .with("generated", Mark::Line, points(|r| r.generated.psnr_db.mean))
        .with("uniform at the budget", Mark::Line, points(|r| r.uniform.psnr_db.mean))
        .with("paper: above this below 4 %", Mark::Line, vec![[1.0, 33.5], [4.0, 33.5]])
        .with("paper: below this above 4 %", Mark::Line, vec![[4.0, 31.4], [6.0, 31.4]])
}
