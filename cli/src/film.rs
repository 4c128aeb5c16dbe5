//! `taut film`: a scene in motion with four choices of stiffness, side by side in one animated picture.

use serde::Serialize;
use taut_lab::compare::{self, Case, Model, Outcome, Setting};
use taut_lab::picture::{Panel, Sheet, encode_gif};

use crate::failure::{self, Failure, one_line};
use crate::measure::fabric_of;
use crate::notes::{heading, number};
use crate::output::Folder;
use crate::progress::Progress;
use crate::table::aligned;
use crate::{args, colour, drape, model, picture};

/// Pictures a second: a GIF counts in hundredths of a second, and 20 is smooth enough at half the size of 50.
const PICTURES_PER_S: f32 = 20.0;

/// Width of a panel in pixels.
const PANEL: u32 = 272;

/// The largest strain that the levels of the last panel allow.
const LIMIT: f32 = 0.05;

/// A cloth at a moment.
struct Moment {
    positions: Vec<[f32; 3]>,
    stretch_pct: f64,
    peak_pct: f64,
}

/// `film.json`.
#[derive(Serialize)]
struct Report<'a> {
    description: &'a str,
    scene: &'static str,
    seed: u64,
    grid: [u32; 2],
    rate_hz: f32,
    substeps: u32,
    seconds: f32,
    pictures: usize,
    pictures_per_s: f32,
    limit_pct: f32,
    settings: &'a [Outcome],
}

/// Runs the command.
pub fn run(args: &args::Film) -> Result<(), Failure> {
    let (_, correction) = model::correct(&args.cloth)?;
    let case = drape::case(&args.cloth, &args.step, args.seconds, &correction)?;
    let folder = Folder::open(&args.out, &["film.gif", "film.json"])?;
    let every = (case.rate_hz / PICTURES_PER_S).round().max(1.0) as u32;
    let generated = Setting::Generated(correction.field.iter().copied().collect());
    let models = [
        Model::from(Setting::Reference(fabric_of(&correction))),
        Setting::Uniform.into(),
        generated.clone().into(),
        Model::limited(generated, [LIMIT; 3]),
    ];

    let progress = Progress::new(models.len());
    let (mut outcomes, mut films) = (Vec::new(), Vec::new());
    for (i, model) in models.iter().enumerate() {
        let name = model.name();
        let mut film = Vec::new();
        let mut peak = 0.0f64;
        let outcome = compare::run_model(&case, model, |cloth, frame| {
            let now = 100.0 * f64::from(cloth.strain().largest);
            peak = peak.max(now);
            if frame.index % every == 0 {
                let at = |i| cloth.position(i).map_or([f32::NAN; 3], |p| [p.x, p.y, p.z]);
                let positions = (0..cloth.grid().particles()).map(at).collect();
                film.push(Moment { positions, stretch_pct: now, peak_pct: peak });
            }
            progress.at(i, name, frame.done());
        })
        .map_err(|e| Failure::new(format_args!("the setting {name} cannot run: {e}")))?;
        outcomes.push(outcome);
        films.push(film);
    }
    drop(progress);

    let pictures_per_s = (case.rate_hz / every as f32).clamp(1.0, 50.0);
    let gif = gif(&args.cloth.description, &case, every, &outcomes, &films, pictures_per_s)?;
    let report = Report {
        description: &args.cloth.description,
        scene: case.scene.name(),
        seed: case.seed,
        grid: [case.rows, case.columns],
        rate_hz: case.rate_hz,
        substeps: case.substeps,
        seconds: case.seconds,
        pictures: films.first().map_or(0, Vec::len),
        pictures_per_s,
        limit_pct: 100.0 * LIMIT,
        settings: &outcomes,
    };
    let json = serde_json::to_string_pretty(&report).map_err(Failure::new)? + "\n";
    let paths = folder.fill(&[&gif, json.as_bytes()])?;

    let rows: Vec<Vec<String>> = outcomes
        .iter()
        .map(|o| {
            let ns = format!("{:.1}", o.ns_per_particle_step);
            vec![title(o.name), o.substeps.to_string(), number(o.peak_stretch_pct), number(o.stretch_pct.max), ns]
        })
        .collect();
    let mut text = aligned(&["setting", "substeps", "peak %", "last max %", "ns"], &rows);
    for path in paths {
        text += &format!("Wrote {}\n", path.display());
    }
    failure::answer(args.json, &text, &json)
}

fn title(name: &str) -> String {
    heading(name).replace("_limits", ", levels 5 %")
}

fn gif(
    description: &str,
    case: &Case,
    every: u32,
    outcomes: &[Outcome],
    films: &[Vec<Moment>],
    pictures_per_s: f32,
) -> Result<Vec<u8>, Failure> {
    let count = films.iter().map(Vec::len).min().unwrap_or(0);
    let shape = [case.rows as usize, case.columns as usize];
    let mut sheets = Vec::with_capacity(count);
    for index in 0..count {
        let time_s = (index as u32 * every + 1) as f32 / case.rate_hz;
        let mut sheet = Sheet::new(one_line(description))
            .subtitle(format!(
                "{}, {} x {} particles, {} Hz x {}, {time_s:5.2} s",
                model::scene_text(case.scene),
                case.rows,
                case.columns,
                case.rate_hz,
                case.substeps
            ))
            .style(colour::style(description))
            .card_width(PANEL);
        if case.scene.solid(case.size_m[0], case.size_m[1]).is_some() {
            sheet = sheet.seen_from(picture::FROM_ABOVE);
        }
        for (outcome, film) in outcomes.iter().zip(films) {
            let moment = &film[index];
            let grid = picture::grid(case.scene, &moment.positions, shape, case.size_m)?;
            sheet = sheet.panel(
                Panel::new(title(outcome.name), grid)
                    .line(format!("stretch {} %", number(moment.stretch_pct)))
                    .line(format!("peak {} %", number(moment.peak_pct)))
                    .line(format!("{} substeps", outcome.substeps)),
            );
        }
        sheets.push(sheet);
    }
    Ok(encode_gif(&Sheet::render_film(&sheets)?, pictures_per_s)?)
}
