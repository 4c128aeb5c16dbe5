//! `taut gallery`: fabrics by their words, hung and draped, each with the generator's field, density and rigidity.

use serde::Serialize;
use taut_lab::compare::{self, Case, Outcome, Setting};
use taut_lab::picture::{MAX_PANELS, Panel, Sheet, encode_png};
use taut_lab::scene::Scene;
use taut_onnx::{Correction, Generator};

use crate::args::{self, Cloth, Step};
use crate::failure::{self, Failure, one_line};
use crate::notes::number;
use crate::output::Folder;
use crate::progress::Progress;
use crate::report::Generated;
use crate::table::aligned;
use crate::{colour, drape, model, picture};

/// Fabrics from sheer to stout, where none are named.
const FABRICS: [&str; 8] = [
    "white chiffon",
    "light red silk",
    "grey cotton jersey",
    "cream linen",
    "heavy blue denim",
    "purple velvet",
    "thick green wool felt",
    "brown canvas",
];

/// Scenes where none are named.
const SCENES: [Scene; 3] = [Scene::Hang2, Scene::Drape, Scene::Cusick];

/// `gallery.json`.
#[derive(Serialize)]
struct Report<'a> {
    grid: [u32; 2],
    substeps: u32,
    seconds: f32,
    seed: u64,
    rows: &'a [Row],
}

/// A fabric in a scene.
#[derive(Serialize)]
struct Row {
    description: String,
    scene: &'static str,
    generator: Generated,
    unknown_words: Vec<String>,
    outcome: Outcome,
}

/// Runs the command.
pub fn run(args: &args::Gallery) -> Result<(), Failure> {
    let descriptions: Vec<String> = match args.descriptions.as_slice() {
        [] => FABRICS.map(str::to_string).to_vec(),
        given => given.to_vec(),
    };
    if descriptions.len() > MAX_PANELS {
        return Err(Failure::new(format_args!("{} fabrics: at most {MAX_PANELS} fit a picture", descriptions.len())));
    }
    let scenes: Vec<Scene> = match args.scenes.as_slice() {
        [] => SCENES.to_vec(),
        given => Scene::ALL.into_iter().filter(|s| given.contains(s)).collect(),
    };
    let names: Vec<String> = scenes.iter().map(|s| format!("{s}.png")).chain(["gallery.json".into()]).collect();
    let generator = model::load(args.model.as_deref())?;
    // what is wrong with any fabric is said before the work
    let mut jobs = Vec::new();
    for scene in &scenes {
        for description in &descriptions {
            jobs.push(job(args, &generator, *scene, description)?);
        }
    }
    let folder = Folder::open(&args.out, &names)?;

    let progress = Progress::new(jobs.len());
    let mut rows = Vec::new();
    for (i, (cloth, case, correction)) in jobs.into_iter().enumerate() {
        let setting = Setting::Generated(correction.field.iter().copied().collect());
        let outcome = compare::run(&case, &setting, |share| progress.at(i, case.scene.name(), share))
            .map_err(|e| Failure::new(format_args!("`{}` cannot run: {e}", one_line(&cloth.description))))?;
        rows.push(Row {
            generator: Generated::new(generator.info(), &correction),
            unknown_words: correction.unknown_words,
            description: cloth.description,
            scene: case.scene.name(),
            outcome,
        });
    }
    drop(progress);

    let report = Report {
        grid: [args.grid.rows, args.grid.columns],
        substeps: args.substeps,
        seconds: args.seconds,
        seed: args.seed,
        rows: &rows,
    };
    let json = serde_json::to_string_pretty(&report).map_err(Failure::new)? + "\n";
    let mut files = Vec::new();
    for scene in &scenes {
        let shown: Vec<&Row> = rows.iter().filter(|r| r.scene == scene.name()).collect();
        files.push(sheet(args, *scene, &shown)?);
    }
    files.push(json.clone().into_bytes());
    let paths = folder.fill(&files.iter().map(Vec::as_slice).collect::<Vec<_>>())?;

    let table: Vec<Vec<String>> = rows.iter().map(line).collect();
    let header = ["fabric", "scene", "g/m2", "warp N/m", "weft N/m", "D uN m", "max %", "p99 %"];
    let mut text = aligned(&header, &table);
    for path in paths {
        text += &format!("Wrote {}\n", path.display());
    }
    failure::answer(args.json, &text, &json)
}

/// What a fabric in a scene needs, or why it cannot be.
fn job(
    args: &args::Gallery,
    generator: &Generator,
    scene: Scene,
    description: &str,
) -> Result<(Cloth, Case, Correction), Failure> {
    let cloth = Cloth {
        description: description.to_string(),
        scene,
        grid: args.grid,
        size: args::SQUARE_METRE,
        seed: args.seed,
        model: None,
    };
    let step = Step { rate: 60.0, substeps: args.substeps, budget: taut::Budget::Tuned, density: None };
    let correction = model::correct_with(generator, &cloth)?;
    let case = drape::case(&cloth, &step, args.seconds, &correction)?;
    Ok((cloth, case, correction))
}

fn line(r: &Row) -> Vec<String> {
    let k = r.generator.median_stiffness_n_per_m;
    vec![
        one_line(&r.description),
        r.scene.into(),
        format!("{:.0}", 1e3 * r.generator.density_kg_m2),
        format!("{:.0}", k.warp),
        format!("{:.0}", k.weft),
        format!("{:.1}", 1e6 * r.generator.hinge_rigidity_n_m),
        number(r.outcome.stretch_pct.max),
        number(r.outcome.stretch_pct.p99),
    ]
}

/// The picture of a scene.
fn sheet(args: &args::Gallery, scene: Scene, rows: &[&Row]) -> Result<Vec<u8>, Failure> {
    let shape = [args.grid.rows as usize, args.grid.columns as usize];
    let size = [args::SQUARE_METRE.width_m, args::SQUARE_METRE.height_m];
    let mut sheet = Sheet::new("Fabrics by their words").subtitle(format!(
        "{}, {} x {} particles, 60 Hz x {}, after {} s; stiffness, density and rigidity from the words",
        model::scene_text(scene),
        shape[0],
        shape[1],
        args.substeps,
        args.seconds
    ));
    if scene.solid(size[0], size[1]).is_some() {
        sheet = sheet.seen_from(picture::FROM_ABOVE);
    }
    for row in rows {
        let k = row.generator.median_stiffness_n_per_m;
        let panel = Panel::new(one_line(&row.description), picture::grid(scene, &row.outcome.positions, shape, size)?)
            .line(format!("{:.0} g/m2, warp {:.0} N/m", 1e3 * row.generator.density_kg_m2, k.warp))
            .line(format!(
                "max {} %  p99 {} %",
                number(row.outcome.stretch_pct.max),
                number(row.outcome.stretch_pct.p99)
            ))
            .style(colour::style(&row.description));
        sheet = sheet.panel(panel);
    }
    Ok(encode_png(&sheet.render()?)?)
}
