//! `taut measure against`: taut's cloth beside trajectories of another engine.

mod batch;
mod table;

use std::collections::{BTreeMap, HashMap};
use std::path::PathBuf;

use serde::Serialize;
use taut::{Budget, ClothDef};
use taut_lab::against::{Comparison, Mesh, Reference, Stage};
use taut_lab::compare::{self, Case, Model, Outcome, Setting};
use taut_lab::fabric::rigidity_at;
use taut_onnx::{Generator, Request};

use crate::failure::{self, Failure};
use crate::measure::fabric_of;
use crate::model;
use crate::numbers::{self, GridSize};
use crate::output;
use crate::progress::Progress;

/// `taut measure against`.
#[derive(clap::Args, Debug)]
pub struct Args {
    /// A trajectory: `x_final` [n, 3] or `x` [frames, n, 3] in m, z up.
    #[arg(long, value_name = "FILE.npz", required_unless_present = "folder", conflicts_with = "folder",
          requires_all = ["mesh", "scene", "describe", "density"])]
    reference: Option<PathBuf>,
    /// A folder of them: SCENE/FABRIC[_VARIANT].npz, with mesh.npz and materials.json (descriptions and densities).
    #[arg(long, value_name = "DIR", conflicts_with_all = ["mesh", "scene", "describe", "density"])]
    folder: Option<PathBuf>,
    /// Its mesh: `uv` [n, 2] in m and `tris` [t, 3].
    #[arg(long, value_name = "FILE.npz")]
    mesh: Option<PathBuf>,
    /// Its scene: hang2, hang1, edge, drape or hang2_res.
    #[arg(long, value_parser = |s: &str| Stage::named(s).map(|_| s.to_string()))]
    scene: Option<String>,
    /// Its fabric in words.
    #[arg(long, value_name = "TEXT")]
    describe: Option<String>,
    /// Its mass per area.
    #[arg(long, value_name = "KG_M2", value_parser = numbers::density, allow_hyphen_values = true)]
    density: Option<f32>,
    /// taut's particles; the trajectories have 33x33.
    #[arg(long, value_name = "ROWSxCOLUMNS", default_value = "33x33", value_parser = numbers::grid, allow_hyphen_values = true)]
    grid: GridSize,
    /// Frames per second, 1 to 10000.
    #[arg(long, value_name = "HZ", default_value = "60", value_parser = numbers::rate, allow_hyphen_values = true)]
    rate: f32,
    /// Substeps of a frame, 1 to 1024.
    #[arg(long, value_name = "N", default_value = "16", value_parser = numbers::substeps, allow_hyphen_values = true)]
    substeps: u32,
    /// Simulated time in s [default: that of the trajectory's scene, in a folder that of its json].
    #[arg(long, value_name = "S", value_parser = numbers::seconds, allow_hyphen_values = true)]
    seconds: Option<f32>,
    /// The one stretch limit that the analytic settings with limits have for every fabric, 0.05 is 5 %.
    #[arg(long, value_name = "STRAIN", default_value = "0.05", value_parser = strain, allow_hyphen_values = true)]
    slack: f32,
    /// Seed of the generator and of the random stiffness.
    #[arg(long, value_name = "N", default_value_t = 0, allow_hyphen_values = true)]
    seed: u64,
    /// A generator file instead of the one that is built in.
    #[arg(long, value_name = "FILE.onnx")]
    model: Option<PathBuf>,
    /// Writes all figures to a file; in a folder the runs so far are kept beside it, as FILE.jsonl.
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

fn strain(text: &str) -> Result<f32, String> {
    let number = text.trim().parse::<f32>().ok().filter(|x| (0.0..=10.0).contains(x));
    number.ok_or("must be 0 to 10".into())
}

/// A cloth to run: what the trajectories of one scene and fabric are compared with.
#[derive(Clone, Debug, PartialEq)]
struct Job {
    scene: String,
    description: String,
    density_kg_m2: f32,
    seconds: f32,
}

/// One trajectory beside all settings.
#[derive(Serialize)]
struct Single<'a> {
    scene: &'a str,
    description: &'a str,
    density_kg_m2: f32,
    /// Rows, columns.
    grid: [u32; 2],
    rate_hz: f32,
    substeps: u32,
    seconds: f32,
    seed: u64,
    analytic_slack: f32,
    generated_limits: [f32; 3],
    settings: BTreeMap<&'static str, Comparison>,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<(), Failure> {
    let generator = model::load(args.model.as_deref())?;
    if let Some(folder) = &args.folder {
        return batch::run(args, folder, &generator);
    }
    let (Some(reference), Some(mesh), Some(scene), Some(describe), Some(density_kg_m2)) =
        (&args.reference, &args.mesh, &args.scene, &args.describe, args.density)
    else {
        return Err(Failure::new("give --reference with --mesh, --scene, --describe and --density, or --folder"));
    };
    let stage = Stage::named(scene).map_err(Failure::new)?;
    let mesh = Mesh::load(mesh).map_err(Failure::new)?;
    let reference = Reference::load(reference, &mesh, stage).map_err(Failure::new)?;
    let seconds = args.seconds.unwrap_or(stage.seconds);
    let job = Job { scene: scene.clone(), description: describe.clone(), density_kg_m2, seconds };
    let ran = simulate(args, &generator, &job)?;
    let settings = compare(args, &reference, &ran.outcomes);
    if let Some(path) = &args.json {
        let single = Single {
            scene,
            description: describe,
            density_kg_m2,
            grid: [args.grid.rows, args.grid.columns],
            rate_hz: args.rate,
            substeps: args.substeps,
            seconds,
            seed: args.seed,
            analytic_slack: args.slack,
            generated_limits: ran.limits,
            settings: settings.iter().copied().collect(),
        };
        let json = serde_json::to_string_pretty(&single).map_err(Failure::new)? + "\n";
        output::write(path, json.as_bytes())?;
    }
    failure::print(&table::single(&settings))
}

/// All settings of a job.
struct Ran {
    outcomes: Vec<Outcome>,
    limits: [f32; 3],
}

fn simulate(args: &Args, generator: &Generator, job: &Job) -> Result<Ran, Failure> {
    let scene = Stage::named(&job.scene).map_err(Failure::new)?.scene;
    let (rows, columns) = (args.grid.rows, args.grid.columns);
    let pins = scene.pins(rows as usize, columns as usize);
    let pins: Vec<(usize, usize)> = pins.into_iter().map(|p| (p / columns as usize, p % columns as usize)).collect();
    let correction = generator.correct(&Request {
        description: &job.description,
        seed: args.seed,
        rows: rows as usize,
        columns: columns as usize,
        width_m: 1.0,
        height_m: 1.0,
        pins: &pins,
    })?;
    let fabric = fabric_of(&correction);
    let case = Case {
        scene,
        rows,
        columns,
        size_m: [1.0, 1.0],
        rate_hz: args.rate,
        substeps: args.substeps,
        budget: Budget::Tuned,
        density_kg_m2: job.density_kg_m2,
        seconds: job.seconds,
        hinge_rigidity_n_m: rigidity_at(correction.hinge_rigidity_n_m, correction.density_kg_m2, job.density_kg_m2),
        seed: args.seed,
    };
    let step = ClothDef { rate_hz: args.rate, substeps: args.substeps, ..ClothDef::default() };
    step.check().map_err(|e| Failure::new(format_args!("{} Hz x {} substeps: {e}", args.rate, args.substeps)))?;
    let field: Vec<f32> = correction.field.iter().copied().collect();
    let limits = correction.stretch_limits;
    let one = [args.slack; 3];
    let models = [
        Model::from(Setting::Random),
        Setting::Uniform.into(),
        Setting::Analytic(fabric.clone()).into(),
        Setting::UniformInertia.into(),
        Setting::AnalyticInertia(fabric.clone()).into(),
        Setting::RatiosInertia.into(),
        Setting::Generated(field.clone()).into(),
        Model::limited(Setting::UniformInertia, one),
        Model::limited(Setting::AnalyticInertia(fabric), one),
        Model::limited(Setting::RatiosInertia, one),
        Model::limited(Setting::Generated(field.clone()), limits),
        Model::limited_where_cut(Setting::Generated(field), limits),
    ];
    let progress = Progress::new(models.len());
    let mut outcomes = Vec::with_capacity(models.len());
    for (i, model) in models.iter().enumerate() {
        let name = model.name();
        let outcome = compare::run_model(&case, model, |_, frame| progress.at(i, name, frame.done()))
            .map_err(|e| Failure::new(format_args!("the setting {name} cannot run: {e}")))?;
        outcomes.push(outcome);
    }
    Ok(Ran { outcomes, limits })
}

fn compare(args: &Args, reference: &Reference, outcomes: &[Outcome]) -> Vec<(&'static str, Comparison)> {
    let (rows, columns) = (args.grid.rows as usize, args.grid.columns as usize);
    outcomes.iter().map(|o| (o.name, reference.compare(&o.positions, rows, columns, o.finite))).collect()
}

/// Jobs that were run, by what they were.
type Done = HashMap<String, Ran>;
