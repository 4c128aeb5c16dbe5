//! `taut measure step`: what a step costs in every vector width, beside what the core can do at best.

use std::time::Duration;

use serde::Serialize;
use taut::Width;
use taut_lab::bound::Throughput;
use taut_lab::cost::{self, Law, StepRow};
use taut_lab::plot::{Axis, Chart, Figure, Mark};

use crate::failure::{self, Failure};
use crate::output::Folder;
use crate::progress::Progress;
use crate::table::aligned;

/// Sizes of the table.
const SIDES: [u32; 6] = [16, 32, 64, 128, 256, 512];

/// `taut measure step`.
#[derive(clap::Args, Debug)]
pub struct Args {
    /// CPU time of a cell in ms.
    #[arg(long, value_name = "MS", default_value = "200", value_parser = clap::value_parser!(u32).range(1..=60_000))]
    pub time: u32,
    /// Writes step.json and step.png into this folder.
    #[arg(long, value_name = "DIR")]
    pub out: Option<std::path::PathBuf>,
    /// The rows as JSON on stdout; the table goes to stderr.
    #[arg(long)]
    pub json: bool,
}

#[derive(Serialize)]
struct Report {
    processor: String,
    rows: Vec<StepRow>,
    laws: Vec<WidthLaw>,
}

#[derive(Serialize)]
struct WidthLaw {
    width: &'static str,
    #[serde(flatten)]
    law: Law,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<(), Failure> {
    let folder = args.out.as_ref().map(|out| Folder::open(out, &["step.json", "step.png"])).transpose()?;
    let cells = cost::step_cells(&SIDES);
    let bounds: Vec<(Width, Option<Throughput>)> =
        Width::ALL.into_iter().filter(|w| w.is_supported()).map(|w| (w, Throughput::measure(w))).collect();
    let progress = Progress::new(cells.len());
    let mut rows = Vec::with_capacity(cells.len());
    for (i, cell) in cells.iter().enumerate() {
        progress.at(i, cell.0.name(), 0.0);
        let bound = bounds.iter().find(|(w, _)| *w == cell.0).and_then(|(_, b)| b.as_ref());
        rows.push(cost::step(*cell, bound, Duration::from_millis(args.time.into())).map_err(Failure::new)?);
    }
    drop(progress);
    let laws = bounds.iter().filter_map(|(w, _)| Some(WidthLaw { width: w.name(), law: cost::law(&rows, w.name())? }));
    let report = Report { processor: super::processor(), laws: laws.collect(), rows };
    let json = serde_json::to_string_pretty(&report).map_err(Failure::new)? + "\n";
    let mut text = text(&report);
    if let Some(folder) = folder {
        let png = chart(&report).png().map_err(Failure::new)?;
        for path in folder.fill(&[json.as_bytes(), &png])? {
            text.push_str(&format!("Wrote {}\n", path.display()));
        }
    }
    failure::answer(args.json, &text, &json)
}

fn text(report: &Report) -> String {
    let number = |x: Option<f64>| x.map_or("-".into(), |x| format!("{x:.2}"));
    let rows: Vec<Vec<String>> = report
        .rows
        .iter()
        .map(|r| {
            vec![
                r.width.into(),
                if r.features.is_empty() { "plain".into() } else { r.features.join(" ") },
                r.n.to_string(),
                format!("{:.2}", r.ns_per_particle_step),
                format!("{:.2}-{:.2}", r.quartiles_ns[0], r.quartiles_ns[1]),
                format!("{:.0}", r.springs_per_s / 1e6),
                number(r.bound_gather_ns),
                number(r.bound_once_ns),
                r.share_of_bound.map_or("-".into(), |s| format!("{:.0} %", 100.0 * s)),
            ]
        })
        .collect();
    let header = ["width", "with", "N", "ns", "quartiles", "springs 1e6/s", "gather", "once", "share"];
    let mut text = format!("{}\n", report.processor) + &aligned(&header, &rows);
    text.push_str(
        "ns: thread CPU time per particle and substep, median; gather, once: what this core needs at least for the square roots,\n\
         divisions and sums if every spring is worked out at both ends or once; share: of the latter bound\n",
    );
    for l in &report.laws {
        let at_512 = l.law.at_512.map_or(String::new(), |x| format!(", at 512 x 512 {x:.2} times the law"));
        text.push_str(&format!(
            "{}: a substep takes {:.0} ns and {:.2} ns a padded particle, within {:.0} % up to 256 x 256{at_512}\n",
            l.width,
            l.law.c0_ns,
            l.law.c1_ns,
            100.0 * l.law.largest_off
        ));
    }
    text
}

fn chart(report: &Report) -> Chart {
    let mut chart = Chart::new(
        &format!("A substep on {}", report.processor),
        Axis::log("particles along each side"),
        Axis::log("ns per particle and substep"),
    );
    for width in Width::ALL.into_iter().filter(|w| w.is_supported()) {
        for (load, name) in [(None, "plain"), (Some("levels"), "levels")] {
            let points: Vec<[f64; 2]> = report
                .rows
                .iter()
                .filter(|r| {
                    r.width == width.name() && r.solver == "symplectic_euler" && r.features.first().copied() == load
                })
                .map(|r| [f64::from(r.n), r.ns_per_particle_step])
                .collect();
            chart = chart.with(&format!("{} {name}", width.name()), Mark::Line, points);
        }
    }
    chart
}
