//! `taut measure cusick`: taut's disc on the pedestal beside pictures of a real fabric.

use std::path::PathBuf;

use serde::Serialize;
use taut_lab::cusick::{self, DISC_M, Disc, Draped, Photos, Silhouette, Statistics};
use taut_lab::fabric::rigidity_at;
use taut_lab::scene::Scene;
use taut_onnx::Request;

use crate::failure::{self, Failure};
use crate::model;
use crate::numbers;
use crate::output;
use crate::progress::Progress;
use crate::table::aligned;

/// Drapes of a measurement while a rigidity is fitted.
const FIT_DRAPES: u64 = 3;
/// Measurements of a fit, and how near it has to come.
const FIT_MOST: usize = 9;
const FIT_TOLERANCE: f64 = 0.01;

/// `taut measure cusick`.
#[derive(clap::Args, Debug)]
pub struct Args {
    /// The fabric in words.
    #[arg(long, value_name = "TEXT")]
    describe: String,
    /// Its mass per area.
    #[arg(long, value_name = "KG_M2", value_parser = numbers::density, allow_hyphen_values = true)]
    density: f32,
    /// A folder of pictures: sample-SS-capture-C.png, 256 x 256, white where the cloth is.
    #[arg(long, value_name = "DIR")]
    silhouettes: PathBuf,
    /// Bending rigidity D [default: what the generator tells, at this mass per area].
    #[arg(long, value_name = "N_M", value_parser = rigidity, allow_hyphen_values = true, conflicts_with = "fit")]
    rigidity: Option<f32>,
    /// Fits D to the first sample and compares with the others.
    #[arg(long)]
    fit: bool,
    /// Particles along the disc's diameter, 17 to 257.
    #[arg(long, value_name = "N", default_value = "49", value_parser = clap::value_parser!(u32).range(17..=257), allow_hyphen_values = true)]
    side: u32,
    /// Drapes, each from another bump.
    #[arg(long, value_name = "N", default_value = "12", value_parser = clap::value_parser!(u64).range(1..=1000), allow_hyphen_values = true)]
    drapes: u64,
    /// Seed of the generator; the bumps have the seeds from it on.
    #[arg(long, value_name = "N", default_value_t = 0, allow_hyphen_values = true)]
    seed: u64,
    /// A generator file instead of the one that is built in.
    #[arg(long, value_name = "FILE.onnx")]
    model: Option<PathBuf>,
    /// Writes all figures to a file.
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

fn rigidity(text: &str) -> Result<f32, String> {
    let number = text.trim().parse::<f32>().ok().filter(|x| (1e-8..=1.0).contains(x));
    number.ok_or("must be 1e-8 to 1 N m".into())
}

#[derive(Serialize)]
struct DrapeCoefficient {
    taut_mean: f64,
    taut_std: f64,
    real_mean: f64,
    real_std: f64,
}

#[derive(Serialize)]
struct Nodes {
    taut_mean: f64,
    real_mean: f64,
}

#[derive(Serialize)]
struct Fit {
    /// The sample that D was fitted to; the others are the real ones above.
    sample: String,
    sample_drape_coefficient: f64,
    reached_drape_coefficient: f64,
}

#[derive(Serialize)]
struct Written<'a> {
    description: &'a str,
    density_kg_m2: f32,
    rigidity_n_m: f32,
    drape_coefficient: DrapeCoefficient,
    nodes: Nodes,
    fit: Option<Fit>,
    particles_along_diameter: u32,
    drapes: usize,
    pictures: usize,
    substeps: u32,
    /// Largest over the drapes.
    stretch_max_pct: f64,
    /// Largest over the drapes.
    rms_speed_m_s: f64,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<(), Failure> {
    let photos = Photos::load(&args.silhouettes).map_err(Failure::new)?;
    let n = args.side as usize;
    let pins: Vec<(usize, usize)> = Scene::Cusick.pins(n, n).into_iter().map(|p| (p / n, p % n)).collect();
    let correction = model::load(args.model.as_deref())?.correct(&Request {
        description: &args.describe,
        seed: args.seed,
        rows: n,
        columns: n,
        width_m: 2.0 * DISC_M,
        height_m: 2.0 * DISC_M,
        pins: &pins,
    })?;
    let told = rigidity_at(correction.hinge_rigidity_n_m, correction.density_kg_m2, args.density);
    let mut disc = Disc {
        side: args.side,
        density_kg_m2: args.density,
        rigidity_n_m: args.rigidity.unwrap_or(told),
        field: correction.field.iter().copied().collect(),
    };
    let drapes = |disc: &Disc, count: u64, told: &'static str| -> Result<Vec<Draped>, Failure> {
        let progress = Progress::new(count as usize);
        let drape = |i: u64| {
            progress.at(i as usize, told, 0.0);
            disc.drape(args.seed.wrapping_add(i + 1)).map_err(|e| {
                Failure::new(format_args!("a disc of rigidity {:.2e} N m cannot drape: {e}", disc.rigidity_n_m))
            })
        };
        (0..count).map(drape).collect()
    };
    let of = |all: &[Draped]| Statistics::of(all.iter().map(|d| &d.silhouette));

    let mut real: Vec<&Silhouette> = photos.all().collect();
    let mut fitted = None;
    if args.fit {
        let Some((sample, pictures)) = photos.samples.first_key_value().filter(|_| photos.samples.len() > 1) else {
            return Err(Failure::new(format_args!(
                "{}: --fit needs two samples or more: one to fit, the others to compare with",
                args.silhouettes.display()
            )));
        };
        let target = Statistics::of(pictures).mean;
        let start = f64::from(disc.rigidity_n_m);
        let (found, reached) = cusick::fit(target, start, FIT_TOLERANCE, FIT_MOST, |d| {
            let disc = Disc { rigidity_n_m: d as f32, ..disc.clone() };
            Ok::<f64, Failure>(of(&drapes(&disc, FIT_DRAPES, "fit")?).mean)
        })?;
        disc.rigidity_n_m = found as f32;
        real = photos.samples.iter().skip(1).flat_map(|s| s.1).collect();
        fitted =
            Some(Fit { sample: sample.clone(), sample_drape_coefficient: target, reached_drape_coefficient: reached });
    }
    let all = drapes(&disc, args.drapes, "drape")?;
    let (taut, real) = (of(&all), Statistics::of(real));
    let most = |f: fn(&Draped) -> f64| all.iter().map(f).fold(0.0, f64::max);
    let written = Written {
        description: &args.describe,
        density_kg_m2: args.density,
        rigidity_n_m: disc.rigidity_n_m,
        drape_coefficient: DrapeCoefficient {
            taut_mean: taut.mean,
            taut_std: taut.std,
            real_mean: real.mean,
            real_std: real.std,
        },
        nodes: Nodes { taut_mean: taut.nodes, real_mean: real.nodes },
        fit: fitted,
        particles_along_diameter: args.side,
        drapes: taut.count,
        pictures: real.count,
        substeps: all.iter().map(|d| d.substeps).max().unwrap_or(0),
        stretch_max_pct: most(|d| d.stretch_max_pct),
        rms_speed_m_s: most(|d| d.rms_speed_m_s),
    };
    if let Some(path) = &args.json {
        let json = serde_json::to_string_pretty(&written).map_err(Failure::new)? + "\n";
        output::write(path, json.as_bytes())?;
    }
    let row = |name: &str, s: &Statistics| {
        vec![
            name.into(),
            s.count.to_string(),
            format!("{:.3}", s.mean),
            format!("{:.3}", s.std),
            format!("{:.1}", s.nodes),
        ]
    };
    let mut text =
        aligned(&["", "drapes", "drape coefficient", "std", "folds"], &[row("taut", &taut), row("real", &real)]);
    text.push_str(&format!(
        "D = {:.2e} N m ({}), {} kg/m^2, largest stretch {:.1} %, {} substeps of 1/60 s\n",
        disc.rigidity_n_m,
        match (&written.fit, args.rigidity) {
            (Some(fit), _) => format!(
                "fitted to {}: {:.3} for {:.3}",
                failure::one_line(&fit.sample),
                fit.reached_drape_coefficient,
                fit.sample_drape_coefficient
            ),
            (None, Some(_)) => "given".into(),
            (None, None) => "from the words".into(),
        },
        args.density,
        written.stretch_max_pct,
        written.substeps,
    ));
    failure::print(&text)
}
