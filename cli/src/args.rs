//! The command line.

use std::path::PathBuf;

use clap::error::ErrorKind;
use clap::{Args, Parser, Subcommand};
use taut::Budget;
use taut_lab::scene::Scene;

use crate::failure::{self, Failure};
use crate::measure::Measure;
use crate::numbers::{self, GridSize, Sides};

const EXAMPLES: &str = "Examples:
  taut drape \"heavy blue denim\"                     picture, table and report in out/drape
  taut drape \"light silk\" --scene edge --json       the report alone on stdout
  taut film denim --scene curtain                   the same in motion, four choices, out/film/film.gif
  taut gallery \"grey felt\" \"pink silk\"             fabrics of your own words, hung and draped
  taut correct \"heavy blue denim\" --out denim.tautfield
                                                    a stiffness field for taut_cloth_load_stiffness
  taut plan denim --scene edge --tolerance 2        the cheapest settings that stretch by 2 % at most
  taut info                                         the generator that is built in";

/// Cloth for games that does not stretch like rubber: the fabric in words, the stiffness from a generator.
#[derive(Parser, Debug)]
#[command(name = "taut", version, after_help = EXAMPLES, disable_help_subcommand = true)]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// What to do.
#[derive(Subcommand, Debug)]
pub enum Command {
    /// Simulates a scene with seven choices of stiffness: a picture, a table, a report.
    Drape(Drape),
    /// The same scene in motion with four choices of stiffness: an animated picture.
    Film(Film),
    /// Fabrics by their words, hung and draped: a picture of each scene.
    Gallery(Gallery),
    /// Writes the stiffness field of a fabric to a small file that the C library loads.
    Correct(Correct),
    /// Tells the cheapest settings that a scene requires, and why.
    Plan(Plan),
    /// Tells what a generator file is.
    Info(Info),
    /// Measures cost and error; `taut measure --help` lists what.
    #[command(subcommand)]
    Measure(Measure),
}

/// The cloth and where its stiffness comes from.
#[derive(Args, Debug)]
pub struct Cloth {
    /// The fabric in words, for example "heavy blue denim".
    pub description: String,
    /// hang2 (two top corners pinned), edge (top row pinned), hang1 (one corner pinned), swing, curtain, drape (on a
    /// sphere), flag or cusick (a disc on a pedestal).
    #[arg(long, default_value = "hang2")]
    pub scene: Scene,
    /// Particles, each side 2 to 4096.
    #[arg(long, value_name = "ROWSxCOLUMNS", default_value = "32x32", value_parser = numbers::grid, allow_hyphen_values = true)]
    pub grid: GridSize,
    /// Side lengths of the sheet in m.
    #[arg(long, value_name = "WIDTHxHEIGHT", default_value = "1x1", value_parser = numbers::sides, allow_hyphen_values = true)]
    pub size: Sides,
    /// Another seed gives another field of the same fabric.
    #[arg(long, value_name = "N", default_value_t = 0, allow_hyphen_values = true)]
    pub seed: u64,
    /// A generator file instead of the one that is built in.
    #[arg(long, value_name = "FILE.onnx")]
    pub model: Option<PathBuf>,
}

/// The sheet where no size is said.
pub const SQUARE_METRE: Sides = Sides { width_m: 1.0, height_m: 1.0 };

/// How the cloth is stepped.
#[derive(Args, Debug)]
pub struct Step {
    /// Frames per second, 1 to 10000.
    #[arg(long, value_name = "HZ", default_value = "60", value_parser = numbers::rate, allow_hyphen_values = true)]
    pub rate: f32,
    /// Substeps of a frame, 1 to 1024. The reference takes as many as it needs.
    #[arg(long, value_name = "N", default_value = "16", value_parser = numbers::substeps, allow_hyphen_values = true)]
    pub substeps: u32,
    /// tuned (80 % of the flat sheet's limit) or certified (stable from any start, half as stiff).
    #[arg(long, default_value = "tuned", value_parser = numbers::budget)]
    pub budget: Budget,
    /// Mass per area, for all settings [default: what the generator tells].
    #[arg(long, value_name = "KG_M2", value_parser = numbers::density, allow_hyphen_values = true)]
    pub density: Option<f32>,
}

/// `taut drape`.
#[derive(Args, Debug)]
pub struct Drape {
    #[command(flatten)]
    pub cloth: Cloth,
    #[command(flatten)]
    pub step: Step,
    /// Simulated time in s, at most 3600.
    #[arg(long, value_name = "S", default_value = "10", value_parser = numbers::seconds, allow_hyphen_values = true)]
    pub seconds: f32,
    /// Folder for drape.png and report.json; made if it is not there.
    #[arg(long, value_name = "DIR", default_value = "out/drape")]
    pub out: PathBuf,
    /// Only the report on stdout; the table goes to stderr.
    #[arg(long)]
    pub json: bool,
}

/// `taut film`.
#[derive(Args, Debug)]
pub struct Film {
    #[command(flatten)]
    pub cloth: Cloth,
    #[command(flatten)]
    pub step: Step,
    /// Simulated time in s, at most 30.
    #[arg(long, value_name = "S", default_value = "4", value_parser = numbers::short_seconds, allow_hyphen_values = true)]
    pub seconds: f32,
    /// Folder for film.gif and film.json; made if it is not there.
    #[arg(long, value_name = "DIR", default_value = "out/film")]
    pub out: PathBuf,
    /// Only film.json on stdout; the table goes to stderr.
    #[arg(long)]
    pub json: bool,
}

/// `taut gallery`.
#[derive(Args, Debug)]
pub struct Gallery {
    /// Fabrics in words, at most 12 [default: eight from chiffon to canvas].
    #[arg(value_name = "DESCRIPTION")]
    pub descriptions: Vec<String>,
    /// A scene; give it several times for several [default: hang2, drape and cusick].
    #[arg(long = "scene", value_name = "SCENE")]
    pub scenes: Vec<Scene>,
    /// Particles, each side 2 to 4096.
    #[arg(long, value_name = "ROWSxCOLUMNS", default_value = "32x32", value_parser = numbers::grid, allow_hyphen_values = true)]
    pub grid: GridSize,
    /// Substeps of a frame at 60 Hz, 1 to 1024.
    #[arg(long, value_name = "N", default_value = "32", value_parser = numbers::substeps, allow_hyphen_values = true)]
    pub substeps: u32,
    /// Simulated time in s, at most 3600.
    #[arg(long, value_name = "S", default_value = "6", value_parser = numbers::seconds, allow_hyphen_values = true)]
    pub seconds: f32,
    /// Another seed gives other fields of the same fabrics.
    #[arg(long, value_name = "N", default_value_t = 0, allow_hyphen_values = true)]
    pub seed: u64,
    /// A generator file instead of the one that is built in.
    #[arg(long, value_name = "FILE.onnx")]
    pub model: Option<PathBuf>,
    /// Folder for a picture of each scene and gallery.json; made if it is not there.
    #[arg(long, value_name = "DIR", default_value = "out/gallery")]
    pub out: PathBuf,
    /// Only gallery.json on stdout; the table goes to stderr.
    #[arg(long)]
    pub json: bool,
}

/// `taut correct`.
#[derive(Args, Debug)]
pub struct Correct {
    #[command(flatten)]
    pub cloth: Cloth,
    /// The file to write.
    #[arg(long, value_name = "FILE")]
    pub out: PathBuf,
    /// Tells what was written as JSON on stdout.
    #[arg(long)]
    pub json: bool,
}

/// `taut plan`.
#[derive(Args, Debug)]
pub struct Plan {
    /// The fabric in words, for example "denim".
    pub description: String,
    /// How the sheet is held: hang2, edge, hang1, swing, curtain, drape, flag or cusick.
    #[arg(long, default_value = "hang2")]
    pub scene: Scene,
    /// Particles, each side 2 to 4096.
    #[arg(long, value_name = "ROWSxCOLUMNS", default_value = "32x32", value_parser = numbers::grid, allow_hyphen_values = true)]
    pub grid: GridSize,
    /// Side lengths of the sheet in m.
    #[arg(long, value_name = "WIDTHxHEIGHT", default_value = "1x1", value_parser = numbers::sides, allow_hyphen_values = true)]
    pub size: Sides,
    /// Frames per second, 1 to 10000.
    #[arg(long, value_name = "HZ", default_value = "60", value_parser = numbers::rate, allow_hyphen_values = true)]
    pub rate: f32,
    /// Largest stretch at rest in percent, above 0, at most 100.
    #[arg(long, value_name = "PERCENT", default_value = "5", value_parser = numbers::percent, allow_hyphen_values = true)]
    pub tolerance: f32,
    /// CPU time of a frame [default: any].
    #[arg(long, value_name = "MICROSECONDS", value_parser = numbers::positive, allow_hyphen_values = true)]
    pub budget_us: Option<f32>,
    /// CPU time of a plain particle-step on your machine in ns.
    #[arg(long, value_name = "NS", default_value = "7", value_parser = numbers::positive, allow_hyphen_values = true)]
    pub plain_ns: f32,
    /// As JSON.
    #[arg(long)]
    pub json: bool,
}

/// `taut info`.
#[derive(Args, Debug)]
pub struct Info {
    /// The generator file [default: the one that is built in].
    #[arg(value_name = "FILE.onnx")]
    pub file: Option<PathBuf>,
    /// As JSON.
    #[arg(long)]
    pub json: bool,
}

/// What to do where the arguments did not parse: help and version go to stdout, all else is a failure in one line.
pub fn answer(e: &clap::Error) -> Result<(), Failure> {
    match e.kind() {
        ErrorKind::DisplayHelp | ErrorKind::DisplayVersion => failure::print(&e.render().to_string()),
        ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand | ErrorKind::MissingSubcommand => Err(Failure::new(
            "no command: give drape, film, gallery, correct, plan, info or measure (taut --help tells more)",
        )),
        _ => Err(Failure::new(short(&e.render().to_string()))),
    }
}

/// The text of an argument error as one line: what is wrong and the tip, without the usage.
fn short(text: &str) -> String {
    let lines = text.lines().map(str::trim);
    let telling = lines.take_while(|l| !l.starts_with("Usage:") && !l.starts_with("For more"));
    let mut line = String::new();
    for part in telling.filter(|l| !l.is_empty()) {
        if part.starts_with("tip:") || part.starts_with('[') {
            line.push_str("; ");
        } else if !line.is_empty() {
            line.push(' ');
        }
        line.push_str(part);
    }
    line.trim_start_matches("error: ").into()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(line: &str) -> Result<Cli, String> {
        let words = line.split(' ').map(|w| w.replace('_', " "));
        Cli::try_parse_from(words).map_err(|e| match answer(&e) {
            Err(Failure::User(text)) => text,
            other => panic!("{line}: {other:?}"),
        })
    }

    fn drape(line: &str) -> Drape {
        match parse(line).expect(line).command {
            Command::Drape(d) => d,
            other => panic!("{line}: {other:?}"),
        }
    }

    #[test]
    fn defaults_are_those_of_a_game() {
        let d = drape("taut drape heavy_blue_denim");
        assert_eq!(d.cloth.description, "heavy blue denim");
        assert_eq!(d.cloth.scene, Scene::Hang2);
        assert_eq!((d.cloth.grid.rows, d.cloth.grid.columns), (32, 32));
        assert_eq!((d.cloth.size.width_m, d.cloth.size.height_m), (1.0, 1.0));
        assert_eq!((d.step.rate, d.step.substeps, d.seconds), (60.0, 16, 10.0));
        assert_eq!((d.step.budget, d.step.density, d.cloth.seed), (Budget::Tuned, None, 0));
        assert_eq!(d.out, PathBuf::from("out/drape"));
        assert!(!d.json && d.cloth.model.is_none());
    }

    #[test]
    fn every_option_arrives() {
        let d = drape(
            "taut drape silk --scene hang1 --grid 16x24 --size 1.5x2 --rate 30 --substeps 8 --budget certified \
             --density 0.2 --seed 18446744073709551615 --seconds 1.5 --out a/b --json --model m.onnx",
        );
        assert_eq!((d.cloth.grid.rows, d.cloth.grid.columns), (16, 24));
        assert_eq!((d.cloth.size.width_m, d.cloth.size.height_m), (1.5, 2.0));
        assert_eq!((d.step.rate, d.step.substeps, d.seconds), (30.0, 8, 1.5));
        assert_eq!((d.step.budget, d.step.density), (Budget::Certified, Some(0.2)));
        assert_eq!((d.cloth.seed, d.cloth.scene), (u64::MAX, Scene::Hang1));
        assert!(d.json && d.cloth.model == Some("m.onnx".into()));
    }

    #[test]
    fn wrong_lines_are_answered_in_one_line_that_names_the_option() {
        for (line, named) in [
            ("taut", "no command"),
            ("taut drape", "<DESCRIPTION>"),
            ("taut nonsense", "nonsense"),
            ("taut drape silk wool", "wool"),
            ("taut drape silk --grid 1x1", "--grid"),
            ("taut drape silk --grid -1x5", "--grid"),
            ("taut drape silk --grid", "--grid"),
            ("taut drape silk --girth 3", "--girth"),
            ("taut drape silk --substeps 0", "--substeps"),
            ("taut drape silk --rate 0", "--rate"),
            ("taut drape silk --seconds -1", "--seconds"),
            ("taut drape silk --seconds NaN", "--seconds"),
            ("taut drape silk --density -0.1", "--density"),
            ("taut drape silk --seed -1", "--seed"),
            ("taut drape silk --seed 1.5", "--seed"),
            ("taut drape silk --scene moon", "flag or cusick"),
            ("taut drape silk --budget big", "tuned or certified"),
            ("taut correct silk", "--out"),
            ("taut plan silk --tolerance 0", "--tolerance"),
            ("taut plan silk --budget-us -3", "--budget-us"),
        ] {
            let text = parse(line).err().unwrap_or_else(|| panic!("{line} parsed"));
            assert!(text.contains(named), "{line}: {text}");
            assert!(!text.contains('\n') && !text.contains("\\n") && !text.contains("Usage"), "{text}");
        }
    }

    #[test]
    fn the_command_line_is_well_formed() {
        use clap::CommandFactory;
        Cli::command().debug_assert();
    }
}
