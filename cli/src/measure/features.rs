//! `taut measure features`: what each feature costs in bytes and in time.

use std::time::Duration;

use serde::Serialize;
use taut_lab::cost::{self, FeatureRow};

use crate::failure::{self, Failure};
use crate::output::Folder;
use crate::progress::Progress;
use crate::table::aligned;

/// `taut measure features`.
#[derive(clap::Args, Debug)]
pub struct Args {
    /// Particles along each side, 2 to 512.
    #[arg(long, value_name = "N", default_value = "64", value_parser = clap::value_parser!(u32).range(2..=512))]
    pub side: u32,
    /// CPU time of a feature in ms.
    #[arg(long, value_name = "MS", default_value = "500", value_parser = clap::value_parser!(u32).range(1..=60_000))]
    pub time: u32,
    /// Writes features.json into this folder.
    #[arg(long, value_name = "DIR")]
    pub out: Option<std::path::PathBuf>,
    /// The rows as JSON on stdout; the table goes to stderr.
    #[arg(long)]
    pub json: bool,
}

#[derive(Serialize)]
struct Report {
    processor: String,
    width: &'static str,
    side: u32,
    rows: Vec<FeatureRow>,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<(), Failure> {
    let folder = args.out.as_ref().map(|out| Folder::open(out, &["features.json"])).transpose()?;
    let progress = Progress::new(1);
    let rows = cost::features(args.side, Duration::from_millis(args.time.into()), |share| {
        progress.at(0, "features", share);
    })
    .map_err(Failure::new)?;
    drop(progress);
    let report = Report { processor: super::processor(), width: taut::Width::best().name(), side: args.side, rows };
    let json = serde_json::to_string_pretty(&report).map_err(Failure::new)? + "\n";
    let rows: Vec<Vec<String>> = report
        .rows
        .iter()
        .map(|r| {
            vec![
                r.feature.into(),
                format!("{:.1}", r.bytes_per_particle),
                format!("{:+.1}", r.bytes_added_per_particle),
                format!("{:.2}", r.ns_per_particle_step),
                format!("{:+.2}", r.ns_added),
                format!("{:.2}", r.ratio),
                r.beside.into(),
            ]
        })
        .collect();
    let header = ["with", "bytes", "added", "ns", "added", "ratio", "beside"];
    let n = report.side;
    let title =
        format!("{}, {}, {n} x {n}, per particle (ns: per particle and substep)\n", report.processor, report.width);
    let mut text = title + &aligned(&header, &rows);
    if let Some(folder) = folder {
        for path in folder.fill(&[json.as_bytes()])? {
            text.push_str(&format!("Wrote {}\n", path.display()));
        }
    }
    failure::answer(args.json, &text, &json)
}
