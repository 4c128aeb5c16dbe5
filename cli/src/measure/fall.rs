//! `taut measure fall`: what it costs that a falling sheet stretches no more than so much.

use std::collections::BTreeMap;
use std::path::PathBuf;

use serde::{Deserialize, Serialize};
use taut::Width;
use taut_lab::bound::Throughput;
use taut_lab::fall::{self, Capes, Criterion, Guard, Kind, PASSES, Row, Setting, Trial};
use taut_lab::front;
use taut_lab::ledger::Ledger;
use taut_lab::plot::Figure;

use crate::failure::{self, Failure};
use crate::output::Folder;
use crate::progress::Work;
use crate::table::aligned;

/// Raised where a row of an older run would mean something else.
const VERSION: u32 = 2;

/// The rows as they come.
const LEDGER: &str = "fall.jsonl";

/// How many of the cheapest settings are timed in every width: each width has other costs.
const CANDIDATES: usize = 3;

/// `taut measure fall`.
#[derive(clap::Args, Debug)]
pub struct Args {
    /// Few settings of the smallest size alone, about a minute.
    #[arg(long)]
    pub quick: bool,
    /// Particles along each side, 16 to 512; give it several times for several [default: 64, 128 and 256].
    #[arg(long = "side", value_name = "N", value_parser = clap::value_parser!(u32).range(16..=512))]
    pub sides: Vec<u32>,
    /// Folder for fall.csv, fall.json, fall.png and fall_peaks.png. A run that was interrupted goes on in its folder.
    #[arg(long, value_name = "DIR", default_value = "out/fall")]
    pub out: PathBuf,
    /// Only fall.json on stdout; the tables go to stderr.
    #[arg(long)]
    pub json: bool,
}

/// What the rows of a ledger have in common.
#[derive(Serialize)]
struct Header {
    measure: &'static str,
    version: u32,
    quick: bool,
    processor: String,
}

/// A row of the ledger.
#[derive(Clone, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Entry {
    /// Centre of mass after each frame of the finely stepped run, and how that one fell.
    Reference(Vec<[f64; 3]>),
    Trial(Trial),
    /// ms of CPU per simulated second.
    Time(f64),
    Capes(Capes),
}

/// A trial in the report.
#[derive(Serialize)]
struct TrialRow<'a> {
    n: u32,
    width: &'static str,
    setting: String,
    #[serde(flatten)]
    trial: &'a Trial,
}

#[derive(Serialize)]
struct CapesRow {
    width: &'static str,
    #[serde(flatten)]
    capes: Capes,
}

/// `fall.json`.
#[derive(Serialize)]
struct Report<'a> {
    processor: String,
    quick: bool,
    seconds: u32,
    damping_per_s: f32,
    most_com_error_mm: f64,
    bounds_once_ns: BTreeMap<&'static str, f64>,
    rows: Vec<Row>,
    capes: Vec<CapesRow>,
    trials: Vec<TrialRow<'a>>,
}

struct Bench {
    ledger: Ledger<Entry>,
    bar: Work,
    quick: bool,
}

impl Bench {
    fn add(&mut self, key: &str, entry: Entry) -> Result<(), Failure> {
        self.ledger.add(key, entry).map_err(Failure::new)
    }

    /// The centre of mass of the finely stepped run.
    fn reference(&mut self, side: u32) -> Result<Vec<[f64; 3]>, Failure> {
        let finest = finest(side);
        let key = format!("{side} reference x{}", finest.substeps);
        if let Some(Entry::Reference(com)) = self.ledger.get(&key) {
            return Ok(com.clone());
        }
        self.bar.at(&key);
        let fall = fall::fall(side, &finest, Width::best(), &[]).map_err(Failure::new)?;
        if fall.quality.is_none() {
            return Err(Failure::new(format_args!("{side} x {side}: the finely stepped run blew up")));
        }
        self.bar.done(finest.work(side));
        self.add(&key, Entry::Reference(fall.com_m.clone()))?;
        Ok(fall.com_m)
    }

    /// Every setting that the search tries, in the widest vectors.
    fn trials(&mut self, side: u32) -> Result<Vec<Trial>, Failure> {
        let com = self.reference(side)?;
        fall::search(side, &fall::families(side, self.quick), |setting| {
            let key = format!("{side} {}", setting.key());
            if let Some(Entry::Trial(trial)) = self.ledger.get(&key) {
                return Ok(trial.clone());
            }
            self.bar.at(&key);
            let fall = fall::fall(side, setting, Width::best(), &com).map_err(Failure::new)?;
            let trial = Trial {
                setting: *setting,
                quality: fall.quality,
                ms_per_s: fall.ms_per_s(),
                hash: format!("{:016x}", fall.hash),
            };
            self.bar.done(setting.work(side));
            self.add(&key, Entry::Trial(trial.clone()))?;
            Ok(trial)
        })
    }

    /// ms per simulated second in a width: the least of each frame over a few falls.
    fn time(&mut self, side: u32, width: Width, trial: &Trial) -> Result<f64, Failure> {
        let key = format!("{side} {} {}", width.name(), trial.setting.key());
        if let Some(Entry::Time(ms)) = self.ledger.get(&key) {
            return Ok(*ms);
        }
        self.bar.at(&key);
        let once = || fall::fall(side, &trial.setting, width, &[]).map_err(Failure::new);
        let mut least = once()?;
        if format!("{:016x}", least.hash) != trial.hash {
            return Err(Failure::new(format_args!("{key}: not the bits of {}", Width::best().name())));
        }
        let rounds = if self.quick || width == Width::Scalar { 1 } else { (128 / side).clamp(1, 2) + 1 };
        for _ in 1..rounds {
            least.keep_least(&once()?);
        }
        self.bar.done(f64::from(rounds) * trial.setting.work(side));
        self.add(&key, Entry::Time(least.ms_per_s()))?;
        Ok(least.ms_per_s())
    }

    fn capes(&mut self, width: Width) -> Result<Capes, Failure> {
        let key = format!("capes {}", width.name());
        if let Some(Entry::Capes(capes)) = self.ledger.get(&key) {
            return Ok(*capes);
        }
        self.bar.at(&key);
        let capes = fall::capes(width, if self.quick { 20 } else { 240 }).map_err(Failure::new)?;
        self.add(&key, Entry::Capes(capes))?;
        Ok(capes)
    }
}

/// The run that the centre of mass is compared with.
fn finest(side: u32) -> Setting {
    let substeps = if side <= 64 { 512 } else { 1024 };
    Setting { kind: Kind::Plain, guard: Guard::Tuned, substeps, strain: 0.0, passes: PASSES }
}

/// Runs the command.
pub fn run(args: &Args) -> Result<(), Failure> {
    let sides: Vec<u32> = match (args.sides.is_empty(), args.quick) {
        (false, _) => args.sides.clone(),
        (true, true) => vec![64],
        (true, false) => vec![64, 128, 256],
    };
    let folder = Folder::open(&args.out, &["fall.csv", "fall.json", "fall.png", "fall_peaks.png"])?;
    let processor = super::processor();
    let header = Header { measure: "fall", version: VERSION, quick: args.quick, processor: processor.clone() };
    let ledger = Ledger::open(&args.out.join(LEDGER), &header).map_err(Failure::new)?;
    let widths: Vec<(Width, Option<Throughput>)> =
        Width::ALL.into_iter().filter(|w| w.is_supported()).map(|w| (w, Throughput::measure(w))).collect();
    // an estimate: the search ends before it has tried everything
    let all: f64 = sides
        .iter()
        .map(|s| {
            let families = fall::families(*s, args.quick);
            let tried = families.iter().flat_map(|f| f.substeps.iter().map(|n| Setting { substeps: *n, ..f.of }));
            finest(*s).work(*s) + 0.7 * tried.map(|t| t.work(*s)).sum::<f64>()
        })
        .sum();
    let mut bench = Bench { ledger, bar: Work::new(all), quick: args.quick };

    let capes = widths.iter().map(|(w, _)| Ok(CapesRow { width: w.name(), capes: bench.capes(*w)? }));
    let capes = capes.collect::<Result<Vec<_>, Failure>>()?;
    let (mut rows, mut tried) = (Vec::new(), Vec::new());
    for side in &sides {
        let trials = bench.trials(*side)?;
        for criterion in Criterion::ALL {
            for (width, bound) in &widths {
                let mut best: Option<Row> = None;
                for trial in fall::candidates(*side, criterion, &trials, CANDIDATES) {
                    let ms = bench.time(*side, *width, trial)?;
                    if best.as_ref().is_none_or(|b| ms < b.cpu_ms_per_s) {
                        best = Row::new(*side, criterion, *width, trial, ms, bound.as_ref());
                    }
                }
                rows.extend(best);
            }
        }
        tried.push((*side, trials));
    }
    drop(bench);

    let trial_rows = tried.iter().flat_map(|(side, trials)| {
        let width = Width::best().name();
        trials.iter().map(move |t| TrialRow { n: *side, width, setting: t.setting.key(), trial: t })
    });
    let once = widths.iter().filter_map(|(w, b)| Some((w.name(), b.as_ref()?.once_ns())));
    let report = Report {
        processor,
        quick: args.quick,
        seconds: fall::SECONDS,
        damping_per_s: fall::DAMPING_PER_S,
        most_com_error_mm: fall::MOST_COM_ERROR_MM,
        bounds_once_ns: once.collect(),
        rows,
        capes,
        trials: trial_rows.collect(),
    };
    let json = serde_json::to_string_pretty(&report).map_err(Failure::new)? + "\n";
    let csv = front::csv(&report.rows).map_err(Failure::new)?;
    let nothing = || Failure::new("no setting was good enough: there is nothing to draw");
    let cost = fall::cost_chart(&report.rows, &report.processor).ok_or_else(nothing)?;
    let shown = tried.iter().find(|(side, _)| *side == 128).or(tried.last()).ok_or_else(nothing)?;
    let peaks = fall::peak_chart(shown.0, &shown.1).ok_or_else(nothing)?;
    let pngs = [cost.png().map_err(Failure::new)?, peaks.png().map_err(Failure::new)?];
    let mut text = text(&report);
    for path in folder.fill(&[csv.as_bytes(), json.as_bytes(), &pngs[0], &pngs[1]])? {
        text.push_str(&format!("Wrote {}\n", path.display()));
    }
    failure::answer(args.json, &text, &json)
}

fn text(report: &Report<'_>) -> String {
    let number = |x: Option<f64>| x.map_or("-".into(), |x| format!("{x:.1}"));
    let rows: Vec<Vec<String>> = report
        .rows
        .iter()
        .map(|r| {
            vec![
                r.width.clone(),
                r.n.to_string(),
                r.criterion.clone(),
                r.setting.clone(),
                format!("{:.1}", r.cpu_ms_per_s),
                number(r.target_here_ms_per_s),
                number(r.target_zen5_ms_per_s),
                format!("{:.2}", r.ns_per_particle_step),
                r.share_of_bound.map_or("-".into(), |s| format!("{:.0} %", 100.0 * s)),
                format!("{:.3}", r.mean_pct),
                format!("{:.3}", r.p99_pct),
                format!("{:.1}", r.peak_pct),
                format!("{:.0}", r.com_error_mm),
            ]
        })
        .collect();
    let header =
        ["width", "N", "asked", "setting", "ms/s", "aim", "zen5", "ns", "bound", "mean %", "p99 %", "peak %", "com mm"];
    let capes: Vec<Vec<String>> = report
        .capes
        .iter()
        .map(|c| {
            vec![
                c.width.into(),
                format!("{:.2}", c.capes.ms_per_frame),
                format!("{:.2}-{:.2}", c.capes.quartiles_ms[0], c.capes.quartiles_ms[1]),
                format!("{:.1}", c.capes.ns_per_particle_step),
                format!("{:.1}", c.capes.stretch_max_pct),
            ]
        })
        .collect();
    format!(
        "{}, the cheapest settings that are good enough\n{}\
         ms/s: thread CPU per simulated second; aim: what was aimed at on a Zen 5 (zen5) times the ratio of the bounds; \
         bound: share of the bound\nof every spring once; mean, p99: stretch in the last of {} s; peak: of the whole fall; \
         com: rms error of the centre of mass, at most {} mm\n\n{} capes of 16 x 24, 8 substeps, tethers, two capsules each\n{}",
        report.processor,
        aligned(&header, &rows),
        report.seconds,
        report.most_com_error_mm,
        fall::CAPES,
        aligned(&["width", "ms/frame", "quartiles", "ns", "max %"], &capes)
    )
}
