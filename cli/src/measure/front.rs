//! `taut measure front`: what every setting costs and how wrong it is.

use std::collections::HashMap;
use std::path::PathBuf;

use serde::Serialize;
use taut_lab::front::{self, Bench, Correction, FABRICS, Row, Scoreboard, Set, Spec};
use taut_lab::ledger::Ledger;
use taut_lab::plot::Figure;
use taut_lab::scene::Scene;
use taut_onnx::{Generator, Request};

use crate::failure::{self, Failure};
use crate::output::Folder;
use crate::progress::Work;
use crate::table::aligned;
use crate::{model, notes};

/// Raised where a row of an older run would mean something else.
const VERSION: u32 = 1;

/// Costs of the scoreboards, in plain cloths at 60 Hz x 16.
const COSTS: [f64; 2] = [1.0, 4.0];

/// The rows as they come.
const LEDGER: &str = "front.jsonl";

/// `taut measure front`.
#[derive(clap::Args, Debug)]
pub struct Args {
    /// The small set, a few minutes; without it all rows, hours.
    #[arg(long)]
    pub quick: bool,
    /// A scene; give it several times for several [default: all].
    #[arg(long = "scene", value_name = "SCENE")]
    pub scenes: Vec<Scene>,
    /// A generator file instead of the one that is built in.
    #[arg(long, value_name = "FILE.onnx")]
    pub model: Option<PathBuf>,
    /// Folder for front.csv, front.json and a picture of each scene. A run that was interrupted goes on in its folder.
    #[arg(long, value_name = "DIR", default_value = "out/front")]
    pub out: PathBuf,
    /// Only front.json on stdout; the tables go to stderr.
    #[arg(long)]
    pub json: bool,
}

/// What the rows of a ledger have in common.
#[derive(Serialize)]
struct Header<'a> {
    measure: &'static str,
    version: u32,
    quick: bool,
    generator: &'a str,
}

/// `front.json`.
#[derive(Serialize)]
struct Report<'a> {
    quick: bool,
    generator: &'a str,
    scenes: Vec<&'static str>,
    scoreboards: Vec<Scoreboard>,
    rows: Vec<Row>,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<(), Failure> {
    let set = if args.quick { Set::Quick } else { Set::Full };
    let scenes: Vec<Scene> =
        Scene::ALL.into_iter().filter(|s| args.scenes.is_empty() || args.scenes.contains(s)).collect();
    let generator = model::load(args.model.as_deref())?;
    let pictures = scenes.iter().map(|s| format!("{s}.png"));
    let names: Vec<String> = ["front.csv".into(), "front.json".into()].into_iter().chain(pictures).collect();
    let folder = Folder::open(&args.out, &names)?;
    let digest = generator.info().training_digest.clone();
    let header = Header { measure: "front", version: VERSION, quick: args.quick, generator: &digest };
    let mut ledger = Ledger::open(&args.out.join(LEDGER), &header).map_err(Failure::new)?;

    let list = Spec::list(set, &scenes);
    let rows = measure(set, &list, &generator, &mut ledger)?;
    let mut boards = Vec::new();
    for fabric in FABRICS {
        boards.extend(COSTS.map(|cost| Scoreboard::new(&rows, fabric, cost)));
    }

    let mut files = vec![front::csv(&rows).map_err(Failure::new)?.into_bytes()];
    let names = scenes.iter().map(|s| s.name()).collect();
    let report = Report { quick: args.quick, generator: &digest, scenes: names, scoreboards: boards, rows };
    let json = serde_json::to_string_pretty(&report).map_err(Failure::new)? + "\n";
    files.push(json.clone().into_bytes());
    for scene in &scenes {
        let chart = front::chart(&report.rows, scene.name(), FABRICS[0])
            .ok_or_else(|| Failure::new(format_args!("{scene}: every row blew up, there is nothing to draw")))?;
        files.push(chart.png().map_err(Failure::new)?);
    }
    let paths = folder.fill(&files.iter().map(Vec::as_slice).collect::<Vec<_>>())?;

    let mut text = String::new();
    for board in report.scoreboards.iter().filter(|b| b.scenes > 0) {
        text += &board_text(board);
    }
    for verdict in report.scoreboards.iter().flat_map(Scoreboard::verdicts) {
        text += &format!("{verdict}.\n");
    }
    let blown = report.rows.iter().filter(|r| !r.finite).count();
    text += &format!("\n{} rows, {blown} of them blew up\n", report.rows.len());
    for path in paths {
        text += &format!("Wrote {}\n", path.display());
    }
    failure::answer(args.json, &text, &json)
}

/// All rows of a list: those of the ledger, and the others measured.
fn measure(set: Set, list: &[Spec], generator: &Generator, ledger: &mut Ledger<Row>) -> Result<Vec<Row>, Failure> {
    let mut known: HashMap<(String, Scene, u32), Vec<f32>> = HashMap::new();
    let mut generate = |words: &str, scene: Scene, side: u32| -> Result<Vec<f32>, String> {
        if let Some(field) = known.get(&(words.to_string(), scene, side)) {
            return Ok(field.clone());
        }
        let n = side as usize;
        let pins: Vec<(usize, usize)> = scene.pins(n, n).into_iter().map(|p| (p / n, p % n)).collect();
        let request = Request { rows: n, columns: n, pins: &pins, ..Request::new(words) };
        let correction = generator.correct(&request).map_err(|e| e.to_string())?;
        let field: Vec<f32> = correction.field.iter().copied().collect();
        known.insert((words.to_string(), scene, side), field.clone());
        Ok(field)
    };
    let mut bench = Bench::new(set, &mut generate);
    let missing: Vec<&Spec> = list.iter().filter(|s| ledger.get(&s.key()).is_none()).collect();
    let bar = Work::new(missing.iter().map(|s| s.work(set)).sum());
    for spec in missing {
        let key = spec.key();
        bar.at(&key);
        let row = bench.measure(spec).map_err(Failure::new)?;
        ledger.add(&key, row).map_err(Failure::new)?;
        bar.done(spec.work(set));
    }
    drop(bar);
    Ok(list.iter().filter_map(|s| ledger.get(&s.key()).cloned()).collect())
}

/// A scoreboard as a table: error and largest stretch under each limit.
fn board_text(board: &Scoreboard) -> String {
    const LIMITS: [(&str, &str); 5] = [
        ("none", "alone"),
        ("tethers", "tethers"),
        ("strain_limit", "strain limit"),
        ("levels", "levels"),
        ("one_cycle", "one cycle"),
    ];
    let header: Vec<&str> = ["correction"].into_iter().chain(LIMITS.map(|l| l.1)).collect();
    let rows: Vec<Vec<String>> = Correction::ALL
        .iter()
        .map(|correction| {
            let cells = LIMITS.map(|(limits, _)| match board.cell(*correction, limits) {
                Some(c) if c.scenes > 0 => {
                    let number = |x: Option<f64>| notes::number(x.unwrap_or(f64::NAN));
                    let some = if c.scenes < board.scenes { format!(" ({})", c.scenes) } else { String::new() };
                    format!("{} / {}{some}", number(c.strain_error_points), number(c.stretch_max_pct))
                }
                _ => "-".into(),
            });
            [notes::heading(correction.name()).replace('_', " ")].into_iter().chain(cells).collect()
        })
        .collect();
    format!(
        "{}, {} scenes, at the cost of {} plain cloth{} of 60 Hz x 16 with the same particles: strain error against the \
         fabric in points / largest stretch in %\n{}medians over the scenes; (n): only n scenes have a row that cheap; -: \
         none has, or it blew up\n\n",
        board.fabric,
        board.scenes,
        board.cost,
        if board.cost == 1.0 { "" } else { "s" },
        aligned(&header, &rows)
    )
}
