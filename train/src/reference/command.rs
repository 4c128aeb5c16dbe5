//! `taut-train reference`: the fabrics in the scenes, beside the data where there are some.

use std::fmt;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;

use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use serde::Serialize;
use taut_lab::against::Mesh;
use taut_lab::ledger::Ledger;
use taut_lab::scene::Scene;

use super::run::{Job, Row};
use super::{MEASURED, Measured, ReferenceError, pictures};
use crate::stop::on_ctrl_c;

/// What counts as the same strain: a tenth of it or a tenth of a point; and as the same silhouette.
const SAME_SHARE: f64 = 0.1;
const SAME_POINTS: f64 = 0.1;
const SAME_IOU: f64 = 0.9;

/// The continuum cloth with the measured fabrics, beside another engine's runs where a folder of them is named.
#[derive(Debug, Args)]
pub struct ReferenceArgs {
    /// Folder for trajectories (.npz), pictures, report.json; a run that was interrupted goes on
    #[arg(long)]
    pub out: PathBuf,
    /// Folder of ARCSim's runs: mesh.npz, SCENE/FABRIC.npz
    #[arg(long)]
    pub data: Option<PathBuf>,
    /// Scene: hang2, edge, drape, hang1 or cusick; several may be named [default: hang2, edge, drape]
    #[arg(long)]
    pub scene: Vec<Scene>,
    /// Name of a measured fabric; several may be named [default: all seven]
    #[arg(long)]
    pub fabric: Vec<String>,
    /// Vertices along a side
    #[arg(long, default_value_t = 33)]
    pub side: usize,
    /// Seed of the first bump; with data the cloth starts where theirs starts
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Print the report as JSON instead of tables
    #[arg(long)]
    pub json: bool,
}

/// Why the command stopped.
#[derive(Debug)]
pub enum CommandError {
    /// The cloth.
    Cloth(ReferenceError),
    /// Something that was given or a file.
    Part(String),
    /// Ctrl-C.
    Interrupted,
}

impl CommandError {
    /// Of another part of the program.
    pub fn part(e: impl fmt::Display) -> CommandError {
        CommandError::Part(e.to_string())
    }
}

impl fmt::Display for CommandError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            CommandError::Cloth(e) => e.fmt(f),
            CommandError::Part(e) => f.write_str(e),
            CommandError::Interrupted => f.write_str("interrupted; the same command goes on"),
        }
    }
}

impl std::error::Error for CommandError {}

impl From<ReferenceError> for CommandError {
    fn from(e: ReferenceError) -> CommandError {
        CommandError::Cloth(e)
    }
}

/// What the rows of a folder were made with.
#[derive(Serialize)]
struct Header {
    reference: u32,
    side: usize,
    seed: u64,
    data: bool,
}

#[derive(Serialize)]
struct Report<'a> {
    side: usize,
    seed: u64,
    /// What counts as the same.
    same: Same,
    runs: Vec<Judged<'a>>,
}

#[derive(Serialize)]
struct Same {
    strain_share: f64,
    strain_points: f64,
    silhouette_iou: f64,
}

#[derive(Serialize)]
struct Judged<'a> {
    #[serde(flatten)]
    row: &'a Row,
    strains_agree: Option<bool>,
    silhouettes_agree: Option<bool>,
}

/// Runs what is asked for. Rows that stand in the folder's ledger are not run again.
///
/// # Errors
/// [`CommandError`]; after Ctrl-C the rows that are done are kept.
pub fn run(args: &ReferenceArgs) -> Result<(), CommandError> {
    let scenes = if args.scene.is_empty() { vec![Scene::Hang2, Scene::Edge, Scene::Drape] } else { args.scene.clone() };
    let known = [Scene::Hang2, Scene::Edge, Scene::Drape, Scene::Hang1, Scene::Cusick];
    if let Some(other) = scenes.iter().find(|s| !known.contains(s)) {
        return Err(CommandError::Part(format!(
            "the reference cloth has no scene `{other}`: choose hang2, edge, drape, hang1 or cusick"
        )));
    }
    let fabrics: Vec<&Measured> = match &args.fabric[..] {
        [] => MEASURED.iter().collect(),
        names => names.iter().map(|n| Measured::named(n)).collect::<Result<_, _>>()?,
    };
    let mesh = args.data.as_ref().map(|d| Mesh::load(&d.join("mesh.npz"))).transpose().map_err(CommandError::part)?;
    if mesh.as_ref().is_some_and(|m| m.uv.len() != args.side * args.side) {
        return Err(CommandError::Part(format!(
            "the mesh of the data does not have {} vertices along a side",
            args.side
        )));
    }
    fs::create_dir_all(&args.out).map_err(|e| cannot(&args.out, &e))?;
    let data = args.data.as_deref().zip(mesh.as_ref());
    let header = Header { reference: 1, side: args.side, seed: args.seed, data: data.is_some() };
    let mut ledger: Ledger<Row> = Ledger::open(&args.out.join("rows.jsonl"), &header).map_err(CommandError::part)?;

    let stop = on_ctrl_c();

    let jobs: Vec<Job<'_>> = (scenes.iter())
        .flat_map(|&scene| fabrics.iter().map(move |&fabric| (scene, fabric)))
        .map(|(scene, fabric)| Job { scene, fabric, side: args.side, seed: args.seed, data, out: &args.out })
        .collect();
    let bar = ProgressBar::new(1000 * jobs.len() as u64);
    if let Ok(style) = ProgressStyle::with_template("[{bar:30}] {percent:>3} % {elapsed}, {eta} left {msg}") {
        bar.set_style(style.progress_chars("=> "));
    }
    for (i, job) in jobs.iter().enumerate() {
        let name = job.name();
        bar.set_message(name.clone());
        if ledger.get(&name).is_none() {
            let at = 1000 * i as u64;
            let row = job.run(|share| {
                bar.set_position(at + (1000.0 * share) as u64);
                !stop.load(Ordering::SeqCst)
            })?;
            let Some(row) = row else {
                bar.abandon();
                return Err(CommandError::Interrupted);
            };
            ledger.add(&name, row).map_err(CommandError::part)?;
        }
        bar.set_position(1000 * (i as u64 + 1));
    }
    bar.finish_and_clear();

    let rows: Vec<Row> = jobs.iter().filter_map(|j| ledger.get(&j.name()).cloned()).collect();
    let judged = rows.iter().map(|row| Judged {
        row,
        strains_agree: strains_agree(row),
        silhouettes_agree: row.beside.map(|b| b.silhouette_iou >= SAME_IOU),
    });
    let same = Same { strain_share: SAME_SHARE, strain_points: SAME_POINTS, silhouette_iou: SAME_IOU };
    let report = Report { side: args.side, seed: args.seed, same, runs: judged.collect() };
    let text = serde_json::to_string_pretty(&report).map_err(CommandError::part)?;
    let path = args.out.join("report.json");
    fs::write(&path, &text).map_err(|e| cannot(&path, &e))?;
    for scene in &scenes {
        let of: Vec<(&Job<'_>, &Row)> = jobs.iter().zip(&rows).filter(|(j, _)| j.scene == *scene).collect();
        pictures::draw(&of)?;
    }
    if args.json {
        println!("{text}");
    } else {
        print!("{}", tables(&rows));
    }
    Ok(())
}

fn cannot(path: &Path, e: &std::io::Error) -> CommandError {
    CommandError::Part(format!("cannot write {}: {e}", path.display()))
}

/// Whether every strain of a run is that of the data, where there are some.
fn strains_agree(row: &Row) -> Option<bool> {
    let (mine, theirs) = (row.ex_pin_pct?.numbers(), row.beside?.arcsim_ex_pin_pct.numbers());
    let same = |(a, b): (&f64, &f64)| (a - b).abs() <= (SAME_SHARE * b.abs()).max(SAME_POINTS);
    Some(mine.iter().zip(&theirs).all(same))
}

/// The tables, in Markdown.
fn tables(rows: &[Row]) -> String {
    let mut text = String::new();
    let mut scene = "";
    for row in rows {
        if row.scene != scene {
            scene = &row.scene;
            let columns = match (row.drape_coefficient, row.beside) {
                (Some(_), _) => vec!["drape coefficient", "nodes"],
                (None, None) => vec!["u mean / p99", "v mean / p99", "diagonal mean / p99"],
                (None, Some(_)) => {
                    vec!["u mean / p99", "v mean / p99", "diagonal mean / p99", "IoU", "distance %", "agrees"]
                }
            };
            let _ = writeln!(text, "\n| {scene} | {} |\n|{}", columns.join(" | "), " --- |".repeat(columns.len() + 1));
        }
        let _ = write!(text, "| {} |", row.fabric);
        if let (Some(coefficient), Some(nodes)) = (row.drape_coefficient, row.nodes) {
            let _ = write!(text, " {coefficient:.3} | {nodes} |");
        }
        let theirs = row.beside.map(|b| b.arcsim_ex_pin_pct.numbers());
        for i in 0..3 {
            let pair = |n: [f64; 6]| format!("{:.2} / {:.2}", n[2 * i], n[2 * i + 1]);
            let Some(mine) = row.ex_pin_pct else { break };
            let theirs = theirs.map_or(String::new(), |t| format!(" ({})", pair(t)));
            let _ = write!(text, " {}{theirs} |", pair(mine.numbers()));
        }
        if let Some(b) = row.beside {
            let distance = b.distance_pct.map_or("-".into(), |d| format!("{d:.2}"));
            let agrees = strains_agree(row).is_some_and(|a| a) && b.silhouette_iou >= SAME_IOU;
            let _ = write!(text, " {:.3} | {distance} | {} |", b.silhouette_iou, if agrees { "yes" } else { "no" });
        }
        text.push('\n');
    }
    text.trim_start().to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_run_is_kept_and_another_engines_run_is_set_beside_it() {
        let home = tempfile::tempdir().unwrap();
        let args = |data: Option<PathBuf>, out: &str| ReferenceArgs {
            out: home.path().join(out),
            data,
            scene: vec![Scene::Edge],
            fabric: vec!["11oz-black-denim".into()],
            side: 12,
            seed: 3,
            json: false,
        };
        run(&args(None, "first")).unwrap();
        let first = home.path().join("first");
        let report: serde_json::Value = serde_json::from_slice(&fs::read(first.join("report.json")).unwrap()).unwrap();
        let v = report["runs"][0]["ex_pin_pct"]["v"]["mean"].as_f64().unwrap();
        // rho g (1 - y)/k_vv on average over what lies 0.1 m from the pins
        let expected = 100.0 * 0.324 * 9.8 / 2033.5 * 0.45;
        assert!((v / expected - 1.0).abs() < 0.1, "{v} {expected}");
        assert!(first.join("edge.png").exists() && report["runs"][0]["strains_agree"].is_null());
        // its own trajectory as the data: the same start gives the same cloth
        let data = home.path().join("data");
        fs::create_dir_all(data.join("edge")).unwrap();
        fs::copy(first.join("edge-11oz-black-denim.npz"), data.join("edge/11oz-black-denim.npz")).unwrap();
        let square = Mesh::square(12);
        let tris: Vec<i32> = square.triangles.iter().flatten().map(|i| *i as i32).collect();
        use taut_lab::npz::{Numbers, write};
        let arrays: [(&str, &[usize], Numbers<'_>); 2] = [
            ("uv", &[144, 2], Numbers::Floats(square.uv.as_flattened())),
            ("tris", &[square.triangles.len(), 3], Numbers::Indices(&tris)),
        ];
        write(&data.join("mesh.npz"), &arrays).unwrap();
        run(&args(Some(data.clone()), "second")).unwrap();
        let text = fs::read(home.path().join("second/report.json")).unwrap();
        let report: serde_json::Value = serde_json::from_slice(&text).unwrap();
        let row = &report["runs"][0];
        assert!(row["strains_agree"] == true && row["silhouettes_agree"] == true, "{row}");
        assert!(row["beside"]["distance_pct"].as_f64().unwrap() < 0.1, "{row}");
        // a second call runs nothing again, another start is another measurement
        run(&args(Some(data), "second")).unwrap();
        assert!(run(&ReferenceArgs { seed: 4, ..args(None, "first") }).is_err());
        assert!(run(&ReferenceArgs { scene: vec![Scene::Flag], ..args(None, "third") }).is_err());
    }
}
