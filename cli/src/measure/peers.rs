//! `taut measure peers`: other engines on the falling sheet.

use std::path::PathBuf;
use std::process::Command;

use serde::{Deserialize, Serialize};
use taut::Width;
use taut_lab::fall::{self, Criterion, Guard, Kind, PASSES, Setting, Trial};
use taut_lab::ledger::Ledger;
use taut_lab::peers::{self, ENGINES, Engine, Fell, HOW_TO_BUILD, Reached, Row};

use crate::failure::{self, Failure};
use crate::output::Folder;
use crate::progress::Work;
use crate::table::aligned;

/// Raised where a row of an older run would mean something else.
const VERSION: u32 = 2;

/// `taut measure peers`.
#[derive(clap::Args, Debug)]
pub struct Args {
    /// The program of the peers.
    #[arg(long, value_name = "FILE", default_value = "lab/peers/target/release/taut-peers")]
    pub program: PathBuf,
    /// Particles along each side, 16 to 256; give it several times for several [default: 32, 64 and 128].
    #[arg(long = "side", value_name = "N", value_parser = clap::value_parser!(u32).range(16..=256))]
    pub sides: Vec<u32>,
    /// Leaves out settings of which a fall takes longer, in s, roughly.
    #[arg(long, value_name = "S", default_value = "60", value_parser = clap::value_parser!(u32).range(1..=3600))]
    pub most: u32,
    /// Folder for peers.json. A run that was interrupted goes on in its folder.
    #[arg(long, value_name = "DIR", default_value = "out/peers")]
    pub out: PathBuf,
    /// Only peers.json on stdout; the table goes to stderr.
    #[arg(long)]
    pub json: bool,
}

#[derive(Serialize)]
struct Header {
    measure: &'static str,
    version: u32,
    processor: String,
}

/// A row of the ledger.
#[derive(Clone, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Entry {
    Fell(Fell),
    Trial(Trial),
}

/// `peers.json`.
#[derive(Serialize)]
struct Report {
    processor: String,
    engines: Vec<String>,
    rows: Vec<Row>,
    falls: Vec<Fell>,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<(), Failure> {
    let sides = if args.sides.is_empty() { vec![32, 64, 128] } else { args.sides.clone() };
    let folder = Folder::open(&args.out, &["peers.json"])?;
    let header = Header { measure: "peers", version: VERSION, processor: super::processor() };
    let mut ledger = Ledger::open(&args.out.join("peers.jsonl"), &header).map_err(Failure::new)?;
    let engines = if args.program.exists() { engines(args)? } else { Vec::new() };
    let has = |e: &&Engine| engines.iter().any(|line| line.split(' ').next() == Some(e.name));
    let (mut rows, mut all) = (Vec::new(), Vec::new());
    let bar = Work::new(1.0);
    for side in &sides {
        for engine in ENGINES.iter().filter(has) {
            let mut falls: Vec<Fell> = Vec::new();
            for [substeps, iterations] in peers::settings(engine, *side, f64::from(args.most)) {
                let key = format!("{} {side} {substeps} x {iterations}", engine.name);
                bar.at(&key);
                let known = ledger.get(&key).cloned();
                let fell = match known {
                    Some(Entry::Fell(fell)) => fell,
                    _ => {
                        let fell = ask(args, engine, [*side, substeps, iterations])?;
                        ledger.add(&key, Entry::Fell(fell.clone())).map_err(Failure::new)?;
                        fell
                    }
                };
                falls.push(fell);
            }
            rows.push(peers::row(engine.name, *side, &falls));
            all.extend(falls);
        }
        for width in Width::ALL.into_iter().filter(|w| w.is_supported()) {
            bar.at(&format!("taut {} {side}", width.name()));
            rows.push(ours(*side, width, &mut ledger)?);
        }
    }
    drop(bar);
    rows.extend(peers::recorded(&sides));
    rows.sort_by_key(|r| r.n);
    let report = Report { processor: header.processor, engines, rows, falls: all };
    let json = serde_json::to_string_pretty(&report).map_err(Failure::new)? + "\n";
    let mut text = text(&report);
    if report.engines.is_empty() {
        text += &format!(
            "\nBullet and rapier3d did not run: there is no {}. To build it:\n{HOW_TO_BUILD}\n",
            args.program.display()
        );
    }
    for path in folder.fill(&[json.as_bytes()])? {
        text.push_str(&format!("Wrote {}\n", path.display()));
    }
    failure::answer(args.json, &text, &json)
}

/// What the program was built with, a line each.
fn engines(args: &Args) -> Result<Vec<String>, Failure> {
    Ok(output(args, &[])?.lines().map(str::to_string).collect())
}

/// One fall in an engine.
fn ask(args: &Args, engine: &Engine, numbers: [u32; 3]) -> Result<Fell, Failure> {
    let numbers = numbers.map(|n| n.to_string());
    let list: Vec<&str> = [engine.name].into_iter().chain(numbers.iter().map(String::as_str)).collect();
    peers::parse(&output(args, &list)?).map_err(Failure::new)
}

fn output(args: &Args, list: &[&str]) -> Result<String, Failure> {
    let name = args.program.display();
    let run = Command::new(&args.program).args(list).output();
    let run = run.map_err(|e| Failure::new(format_args!("cannot run {name}: {e}")))?;
    if !run.status.success() {
        let why = String::from_utf8_lossy(&run.stderr);
        return Err(Failure::new(format_args!("{name} {}: {}", list.join(" "), failure::one_line(&why))));
    }
    String::from_utf8(run.stdout)
        .map_err(|_| Failure::new(format_args!("{name} answers with something else than text")))
}

/// The row of this library: tethers, or one cycle through the levels, under a fast speed limit, with few to many substeps.
fn ours(side: u32, width: Width, ledger: &mut Ledger<Entry>) -> Result<Row, Failure> {
    let mut trials = Vec::new();
    let tethers = [2, 3, 4, 5, 6, 8, 12].map(|substeps| (Kind::Tethers, substeps, PASSES));
    let levels = [1, 2, 3].map(|substeps| (Kind::OneCycle, substeps, 1));
    // the last, of which the price of a substep is told, has tethers
    for (kind, substeps, passes) in levels.into_iter().chain(tethers) {
        let setting = Setting { kind, guard: Guard::Fast, substeps, strain: 0.0, passes };
        let key = format!("taut {} {side} {}", width.name(), setting.key());
        let trial = match ledger.get(&key).cloned() {
            Some(Entry::Trial(trial)) => trial,
            _ => {
                let fall = fall::fall(side, &setting, width, &[]).map_err(Failure::new)?;
                let hash = format!("{:016x}", fall.hash);
                let trial = Trial { setting, quality: fall.quality, ms_per_s: fall.ms_per_s(), hash };
                ledger.add(&key, Entry::Trial(trial.clone())).map_err(Failure::new)?;
                trial
            }
        };
        trials.push(trial);
    }
    let reached = |criterion| {
        let best = fall::cheapest(side, criterion, &trials)?;
        let quality = best.quality?;
        Some(Reached {
            cpu_ms_per_s: best.ms_per_s,
            setting: best.setting.key(),
            p99_pct: Some(quality.p99_pct),
            peak_pct: Some(quality.peak_pct),
        })
    };
    let last = trials.last().map(|t| t.ms_per_s * 1e6 / t.setting.work(side));
    Ok(Row {
        engine: format!("taut, {}", width.name()),
        source: "this run".into(),
        n: side,
        ns_per_particle_iteration: last,
        mean_1_5: reached(Criterion::Mean15),
        mean_0_6: reached(Criterion::Mean06),
        tried: Some(trials.len()),
    })
}

fn text(report: &Report) -> String {
    let number = |x: Option<f64>| x.map_or("-".into(), |x| format!("{x:.1}"));
    let cells = |r: &Option<Reached>| match r {
        Some(r) => [format!("{:.1}", r.cpu_ms_per_s), r.setting.clone(), number(r.p99_pct), number(r.peak_pct)],
        None => ["-", "", "", ""].map(str::to_string),
    };
    let rows: Vec<Vec<String>> = report
        .rows
        .iter()
        .map(|r| {
            let head = [r.engine.clone(), r.n.to_string(), number(r.ns_per_particle_iteration)];
            let tail = [r.source.clone()];
            head.into_iter().chain(cells(&r.mean_1_5)).chain(cells(&r.mean_0_6)).chain(tail).collect()
        })
        .collect();
    let header =
        ["engine", "N", "ns", "ms 1.5 %", "setting", "p99 %", "peak %", "ms 0.6 %", "setting", "p99 %", "peak %", ""];
    format!(
        "{}, one thread, thread CPU time\n{}ns: per particle and iteration (taut: substep); ms: per simulated second, until the \
         mean stretch of the last second is at most 1.5 or 0.6 %\nsetting: substeps x iterations; -: not reached\n",
        report.processor,
        aligned(&header, &rows)
    )
}
