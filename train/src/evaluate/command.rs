//! The command: which figures, where, and what is told of them.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use clap::{Args, ValueEnum};
use serde::Serialize;
use taut_lab::plot::{Chart, Figure as _};

use super::paper::Paper;
use super::{Bench, EvaluateError, discs, losses, noise, rivals, unseen};
use crate::Shard;
use crate::gan::write_whole;
use crate::stop::on_ctrl_c;

/// The paper's figures and ours.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, ValueEnum)]
pub enum Figure {
    /// Pictures under noise
    #[value(name = "7")]
    Seven,
    /// The losses one by one
    #[value(name = "8")]
    Eight,
    /// Ways to choose K side by side
    #[value(name = "9")]
    Nine,
    /// Unseen fabrics
    Unseen,
}

/// The evaluation of the paper's section VI.C, and unseen fabrics.
#[derive(Debug, Args)]
pub struct EvaluateArgs {
    /// Folder for nets, rows, report.json, plots; what is there is not measured again
    #[arg(long)]
    pub out: PathBuf,
    /// A figure; several may be named [default: all]
    #[arg(long, value_name = "FIGURE")]
    pub figure: Vec<Figure>,
    /// Folder of `taut-train data`, whose test split the nets of 7 and 8 are judged by [default: test fabrics with the core's
    /// own reference]
    #[arg(long, value_name = "DIR", conflicts_with = "quick")]
    pub data: Option<PathBuf>,
    /// Training of each net in minutes of one core, as a number of steps that does not depend on the machine: 0.01 to 600
    #[arg(long, value_name = "M", default_value = "2", value_parser = minutes)]
    pub minutes: f64,
    /// A part of the work; run with another folder, its figure-*.jsonl are put beside those of the others
    #[arg(long, value_name = "I/N", default_value = "1/1")]
    pub shard: Shard,
    /// The generator file that stands for ours
    #[arg(long, value_name = "FILE", default_value = "onnx/generator.onnx")]
    pub model: PathBuf,
    /// Everything as small as it can be: whether it runs, in seconds
    #[arg(long)]
    pub quick: bool,
    /// Print the report as JSON instead of tables
    #[arg(long)]
    pub json: bool,
}

fn minutes(text: &str) -> Result<f64, String> {
    let number = text.trim().parse::<f64>().ok().filter(|m| (0.01..=600.0).contains(m));
    number.ok_or("must be 0.01 to 600".into())
}

/// report.json. A figure is there when all of its rows are.
#[derive(Debug, Default, Serialize)]
pub struct Report {
    /// Training of each net in minutes of one core.
    pub minutes: f64,
    /// Whether everything was as small as it can be.
    pub quick: bool,
    /// What the paper says, for comparison.
    pub paper: Paper,
    /// Fig. 7.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub figure_7: Option<Vec<noise::Row>>,
    /// Fig. 8: every net, and the rungs over their seeds.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub figure_8: Option<Losses>,
    /// Fig. 9.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub figure_9: Option<Vec<rivals::Row>>,
    /// Unseen fabrics: every run, and the means.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unseen: Option<Unseen>,
    /// Discs of unseen fabrics.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unseen_discs: Option<Discs>,
}

/// Fig. 8.
#[derive(Debug, Serialize)]
pub struct Losses {
    /// Every net.
    pub nets: Vec<losses::Row>,
    /// The rungs.
    pub rungs: Vec<losses::Summary>,
}

/// Unseen fabrics.
#[derive(Debug, Serialize)]
pub struct Unseen {
    /// Every run.
    pub rows: Vec<unseen::Row>,
    /// Means by place.
    pub means: Vec<Means>,
}

/// Discs of unseen fabrics.
#[derive(Debug, Serialize)]
pub struct Discs {
    /// Every fabric.
    pub rows: Vec<discs::Row>,
    /// Errors of each choice.
    pub means: Vec<discs::Mean>,
}

/// Means at a place.
#[derive(Debug, Serialize)]
pub struct Means {
    /// Which.
    pub place: String,
    /// Of each correction.
    pub corrections: Vec<unseen::Mean>,
}

/// Runs what is asked for and prints it.
///
/// # Errors
/// [`EvaluateError`]; after Ctrl-C the rows that are done are kept.
pub fn run(args: &EvaluateArgs) -> Result<(), EvaluateError> {
    let (report, text) = evaluate(args, &on_ctrl_c())?;
    let json = serde_json::to_string_pretty(&report).map_err(EvaluateError::part)? + "\n";
    write_whole(&args.out.join("report.json"), json.as_bytes())?;
    let shown = if args.json { &json } else { &text };
    // a pipe that was closed is no mistake of ours
    let _ = std::io::Write::write_all(&mut std::io::stdout(), shown.as_bytes());
    Ok(())
}

/// The report and its tables; the plots are in the folder.
pub fn evaluate(args: &EvaluateArgs, stop: &AtomicBool) -> Result<(Report, String), EvaluateError> {
    let mut bench = Bench::new(&args.out, stop)?;
    bench.shard = args.shard;
    bench.minutes = args.minutes;
    bench.quick = args.quick;
    bench.model = args.model.clone();
    bench.data_set = args.data.clone();
    let asked = |f: Figure| args.figure.is_empty() || args.figure.contains(&f);
    let mut report = Report { minutes: args.minutes, quick: args.quick, ..Report::default() };
    let mut text = String::new();
    if asked(Figure::Nine) {
        let rows = rivals::rows(&mut bench)?;
        report.figure_9 = told("Fig. 9: largest / p99 / mean stretch in %; NMSE", rows, rivals::text, &mut text);
    }
    if asked(Figure::Unseen) {
        let rows = unseen::rows(&mut bench)?;
        let title = "Unseen fabrics: relative error of the mean strain away from pins";
        report.unseen = told(title, rows, unseen::text, &mut text).map(|rows| Unseen {
            means: unseen::groups(&rows.iter().collect::<Vec<_>>())
                .into_iter()
                .map(|(place, of)| Means { place, corrections: unseen::means(&of) })
                .collect(),
            rows,
        });
        let rows = discs::rows(&mut bench)?;
        report.unseen_discs = told("Unseen fabrics: drape coefficient of a disc", rows, discs::text, &mut text)
            .map(|rows| Discs { means: discs::means(&rows.iter().collect::<Vec<_>>()), rows });
    }
    if asked(Figure::Seven) {
        let rows = noise::rows(&mut bench)?;
        report.figure_7 = told("Fig. 7: noise in training, pictures of unseen fabrics", rows, noise::text, &mut text);
        if let Some(rows) = &report.figure_7 {
            save(&args.out.join("figure-7.png"), &noise::chart(&rows.iter().collect::<Vec<_>>()))?;
        }
    }
    if asked(Figure::Eight) {
        let rows = losses::rows(&mut bench)?;
        report.figure_8 =
            told("Fig. 8: losses one by one, mean ± deviation of the seeds", rows, losses::text, &mut text)
                .map(|nets| Losses { rungs: losses::summaries(&nets.iter().collect::<Vec<_>>()), nets });
        if let Some(of) = &report.figure_8 {
            save(&args.out.join("figure-8.png"), &losses::chart(&of.nets.iter().collect::<Vec<_>>()))?;
        }
    }
    Ok((report, text))
}

/// The rows of a figure that has them all, with its table added to the text; else how many there are.
fn told<R>(title: &str, rows: Vec<Option<R>>, table: impl Fn(&[&R]) -> String, text: &mut String) -> Option<Vec<R>> {
    let (there, all) = (rows.iter().flatten().count(), rows.len());
    let _ = if there == all {
        write!(text, "{title}\n\n{}\n", table(&rows.iter().flatten().collect::<Vec<_>>()))
    } else {
        write!(text, "{title}: {there} of {all} rows; the others are in ledgers of other shards\n\n")
    };
    rows.into_iter().collect()
}

fn save(path: &Path, chart: &Chart) -> Result<(), EvaluateError> {
    let png = chart.png().map_err(EvaluateError::part)?;
    Ok(write_whole(path, &png)?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::Ordering;

    #[test]
    fn a_quick_evaluation_makes_every_figure_and_measures_nothing_twice() {
        let home = tempfile::tempdir().unwrap();
        let args = EvaluateArgs {
            out: home.path().into(),
            figure: vec![],
            data: None,
            minutes: 2.0,
            shard: Shard::WHOLE,
            model: Path::new(env!("CARGO_MANIFEST_DIR")).join("../onnx/generator.onnx"),
            quick: true,
            json: false,
        };
        let stop = AtomicBool::new(false);
        let (report, text) = evaluate(&args, &stop).unwrap();
        for title in ["Fig. 7", "Fig. 8", "Fig. 9", "Unseen"] {
            assert!(text.contains(title), "{text}");
        }
        assert!(report.figure_7.as_ref().unwrap().iter().all(|r| r.uniform.nmse.mean > 0.0));
        let rungs = &report.figure_8.as_ref().unwrap().rungs;
        assert!(rungs.len() == 3 && rungs.iter().all(|r| r.scores.nmse.mean.is_finite()));
        let choices = &report.figure_9.as_ref().unwrap()[0].choices;
        assert!(choices[0].scores.is_none() && choices[1..].iter().all(|c| c.scores.is_some()), "{choices:?}");
        assert!(report.unseen.as_ref().unwrap().rows.iter().all(|r| r.choices.iter().all(|c| c.finite)));
        let discs = &report.unseen_discs.as_ref().unwrap().rows;
        assert!(
            discs.iter().all(|r| r.choices.iter().all(|c| (0.0..=1.1).contains(&c.drape_coefficient))),
            "{discs:?}"
        );
        for plot in ["figure-7.png", "figure-8.png", rivals::PICTURE] {
            assert!(home.path().join(plot).exists(), "{plot}");
        }
        // again: even when stopped, since nothing is left to do
        stop.store(true, Ordering::SeqCst);
        let (again, same) = evaluate(&args, &stop).unwrap();
        assert_eq!(same, text);
        assert_eq!(again.figure_7.map(|rows| rows.len()), report.figure_7.map(|rows| rows.len()));
        // other minutes are other nets
        let longer = EvaluateArgs { quick: false, figure: vec![Figure::Seven], ..args };
        assert!(evaluate(&longer, &stop).unwrap_err().to_string().contains("another measurement"));
    }

    #[test]
    fn minutes_are_a_few() {
        assert_eq!(minutes("2"), Ok(2.0));
        for bad in ["0", "-1", "1e9", "x", "nan"] {
            assert!(minutes(bad).is_err(), "{bad}");
        }
    }
}
