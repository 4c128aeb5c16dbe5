//! `taut measure report`: runs every command whose result is worth a look, and binds the tables and pictures to one page.
//!
//! Each part is the command that its section names, run as a process of its own: what the page shows is what a user gets.

use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use clap::ValueEnum;
use serde::Serialize;

use super::page::{self, Picture, Section};
use crate::failure::{self, Failure, complain};
use crate::output::{self, Folder};

/// What a part printed, behind the command and the digest of the program that printed it. It stands only beside a part that
/// is whole.
const SUMMARY: &str = "summary.txt";

/// `taut measure report`.
#[derive(clap::Args, Debug)]
pub struct Args {
    /// The full sets of front, fall and atlas, hours; without it their quick ones, all parts in about five minutes.
    #[arg(long)]
    pub full: bool,
    /// A part; give it several times for several [default: all].
    #[arg(long = "only", value_name = "PART", value_enum)]
    pub only: Vec<Part>,
    /// Folder for report.html and a folder of each part. Parts that this program has finished there are not run again.
    #[arg(long, value_name = "DIR", default_value = "out/report")]
    pub out: PathBuf,
    /// Tells what was written as JSON on stdout.
    #[arg(long)]
    pub json: bool,
}

/// A part of the report.
#[derive(ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// One scene with seven corrections.
    Drape,
    /// Fabrics by their words.
    Gallery,
    /// A sheet that swings.
    Swing,
    /// A curtain that is driven.
    Curtain,
    /// Cost and error of every setting.
    Front,
    /// Cost of a step.
    Step,
    /// Cost of each feature.
    Features,
    /// A falling sheet.
    Fall,
    /// What must not matter.
    Invariance,
    /// Extremes.
    Atlas,
}

/// What a part is, beside its name.
struct Told {
    title: &'static str,
    /// How to read it.
    about: &'static str,
    /// The command, without its folder.
    command: &'static [&'static str],
    /// Whether the command has a quick set.
    has_quick: bool,
}

/// Of both films.
const FILM: &str = "The same motion four times: the fabric's own stiffness with as many substeps as it needs, the stiffest \
     field that the step carries, the generated field, and the generated field with levels that allow no more \
     than 5 %.";

impl Part {
    /// The name of its folder, and the link to it.
    fn name(self) -> String {
        // clap's name, which is what `--only` takes
        self.to_possible_value().map_or_else(String::new, |value| value.get_name().to_string())
    }

    fn told(self) -> Told {
        let (title, about, command, has_quick): (_, _, &[&str], _) = match self {
            Part::Drape => (
                "One sheet, seven corrections",
                "The same sheet hangs from two corners until it rests. Bright edges are stretched by more than \
                 2 %. The reference has the fabric's own stiffness and as many substeps as that needs; all \
                 others have the substeps of a game.",
                &["drape", "heavy blue denim"],
                false,
            ),
            Part::Gallery => (
                "Fabrics by their words",
                "Stiffness, density and bending rigidity come from the words alone, through the built-in \
                 generator.",
                &["gallery"],
                false,
            ),
            Part::Swing => {
                ("In motion: a sheet swings down", FILM, &["film", "heavy blue denim", "--scene", "swing"], false)
            }
            Part::Curtain => (
                "In motion: a curtain whose hooks are driven",
                FILM,
                &["film", "light red silk", "--scene", "curtain", "--seconds", "3"],
                false,
            ),
            Part::Front => (
                "What a setting costs, and how wrong it is",
                "Each point is one setting: CPU time beside the plain cloth at 60 Hz x 16 against the error of \
                 its strains. Lower left is better; the steps join the settings that no other betters. The \
                 tables compare the corrections at equal cost, also where the learned field loses.",
                &["measure", "front"],
                true,
            ),
            Part::Step => (
                "What a step costs",
                "Thread CPU time per particle and substep, by vector width and size, beside the least that this \
                 core needs for the square roots, divisions and sums.",
                &["measure", "step"],
                false,
            ),
            Part::Features => (
                "What each feature costs",
                "Bytes and time that a feature adds. What is off takes neither.",
                &["measure", "features"],
                false,
            ),
            Part::Fall => (
                "What it costs that a falling sheet does not stretch",
                "The cheapest setting, by vector width, that keeps a falling sheet from stretching more than so \
                 much, and a hundred capes on characters that walk.",
                &["measure", "fall"],
                true,
            ),
            Part::Invariance => (
                "What must not matter, and does not",
                "Frame rates, uneven frame times, the order of each solver when the step is halved, the mesh \
                 against the continuum, single against double precision.",
                &["measure", "invariance"],
                false,
            ),
            Part::Atlas => (
                "Where it breaks: the atlas of extremes",
                "Each cell is a run at an extreme. Green rests, yellow and orange stay bounded, grey is refused \
                 with a code; black would be broken.",
                &["measure", "atlas"],
                true,
            ),
        };
        Told { title, about, command, has_quick }
    }

    /// The command, without its folder.
    fn command(self, full: bool) -> Vec<&'static str> {
        let told = self.told();
        let quick = (told.has_quick && !full).then_some("--quick");
        told.command.iter().copied().chain(quick).collect()
    }
}

/// The command as one would type it.
fn typed(command: &[&str]) -> String {
    let quoted = command.iter().map(|w| if w.contains(' ') { format!("\"{w}\"") } else { (*w).to_string() });
    ["taut".to_string()].into_iter().chain(quoted).collect::<Vec<_>>().join(" ")
}

/// For `--json`.
#[derive(Serialize)]
struct Written {
    page: String,
    page_bytes: usize,
    parts: Vec<WrittenPart>,
}

/// A part of [`Written`].
#[derive(Serialize)]
struct WrittenPart {
    part: String,
    command: String,
    folder: String,
    pictures: usize,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<(), Failure> {
    let parts: Vec<Part> =
        Part::value_variants().iter().copied().filter(|p| args.only.is_empty() || args.only.contains(p)).collect();
    let folder = Folder::open(&args.out, &["report.html"])?;
    let program = Program::this()?;
    let (mut sections, mut written) = (Vec::new(), Vec::new());
    for (i, part) in parts.iter().enumerate() {
        let (name, told, command) = (part.name(), part.told(), part.command(args.full));
        let home = args.out.join(&name);
        let line = typed(&command);
        let text = match program.summary(&home, &line) {
            Some(text) => text,
            None => {
                complain(&format!("{} of {}: {line}", i + 1, parts.len()));
                program.measure(&home, &command, &line)?
            }
        };
        let pictures = pictures(&home, told.title)?;
        written.push(WrittenPart {
            part: name.clone(),
            command: line.clone(),
            folder: home.display().to_string(),
            pictures: pictures.len(),
        });
        sections.push(Section {
            id: name,
            title: told.title,
            about: told.about,
            command: line,
            pictures,
            text: tables(&text),
        });
    }
    let html = page::html(&super::processor(), &sections);
    let paths = folder.fill(&[html.as_bytes()])?;
    let page = paths.first().map_or(String::new(), |p| p.display().to_string());
    if args.json {
        let written = Written { page, page_bytes: html.len(), parts: written };
        return failure::print(&(serde_json::to_string_pretty(&written).map_err(Failure::new)? + "\n"));
    }
    failure::print(&format!("Wrote {page} ({:.1} MB)\n", html.len() as f64 / 1e6))
}

/// The program that measures: a part of another one, or of another built-in generator, is not what it would find.
struct Program {
    path: PathBuf,
    /// Of the bytes of the file.
    digest: String,
}

impl Program {
    /// The one that runs.
    fn this() -> Result<Program, Failure> {
        let path = std::env::current_exe().map_err(|e| Failure::new(format_args!("cannot find this program: {e}")))?;
        let bytes = fs::read(&path).map_err(|e| unreadable(&path, e))?;
        let mut hash = taut::Hash64::new();
        hash.bulk(&bytes);
        Ok(Program { path, digest: format!("{:016x}", hash.finish()) })
    }

    /// What a summary begins with.
    fn head(&self, line: &str) -> String {
        format!("{line}\nprogram {}\n", self.digest)
    }

    /// What an earlier run of the same command printed, if the part is whole.
    fn summary(&self, home: &Path, line: &str) -> Option<String> {
        let text = fs::read_to_string(home.join(SUMMARY)).ok()?;
        text.strip_prefix(&self.head(line)).map(str::to_string)
    }

    /// Runs a part into its folder and keeps what it printed. What lies there of a part that was interrupted, or made by
    /// another program, is for the command to take up or to refuse.
    fn measure(&self, home: &Path, command: &[&str], line: &str) -> Result<String, Failure> {
        let arguments = command.iter().map(OsString::from).chain([OsString::from("--out"), home.into()]);
        let done = Command::new(&self.path).args(arguments).stdin(Stdio::null()).stderr(Stdio::inherit()).output();
        let done = done.map_err(|e| Failure::new(format_args!("cannot run `{line}`: {e}")))?;
        if !done.status.success() {
            return Err(Failure::new(format_args!("`{line}` ended with {}: the page is not written", done.status)));
        }
        let text =
            String::from_utf8(done.stdout).map_err(|_| Failure::new(format_args!("`{line}` printed no text")))?;
        output::write(&home.join(SUMMARY), (self.head(line) + &text).as_bytes())?;
        Ok(text)
    }
}

/// The table without what was written where.
fn tables(text: &str) -> String {
    let lines = text.lines().filter(|l| !l.starts_with("Wrote ") && !l.starts_with("wrote "));
    lines.collect::<Vec<_>>().join("\n").trim_end().to_string()
}

fn unreadable(path: &Path, e: std::io::Error) -> Failure {
    Failure::new(format_args!("cannot read {}: {e}", path.display()))
}

/// The pictures of a folder, in the order of their names.
fn pictures(home: &Path, title: &str) -> Result<Vec<Picture>, Failure> {
    let mut paths = Vec::new();
    for entry in fs::read_dir(home).map_err(|e| unreadable(home, e))? {
        let path = entry.map_err(|e| unreadable(home, e))?.path();
        let hidden = path.file_name().is_none_or(|n| n.to_string_lossy().starts_with('.'));
        if !hidden && path.extension().is_some_and(|e| e == "png" || e == "gif") {
            paths.push(path);
        }
    }
    paths.sort();
    paths
        .into_iter()
        .map(|path| {
            let bytes = fs::read(&path).map_err(|e| unreadable(&path, e))?;
            let name = path.file_stem().map_or(String::new(), |n| n.to_string_lossy().into_owned());
            let kind = if path.extension().is_some_and(|e| e == "gif") { "gif" } else { "png" };
            Ok(Picture { alt: format!("{title}: {name}"), kind, bytes })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_is_whole_only_with_the_summary_of_its_own_command_and_program() {
        let home = tempfile::tempdir().expect("a folder");
        let program = |digest: &str| Program { path: PathBuf::new(), digest: digest.to_string() };
        let new = program("12");
        assert_eq!(new.summary(home.path(), "taut gallery"), None);
        fs::write(home.path().join(SUMMARY), "taut gallery --seed 3\nprogram 12\na table\n").expect("written");
        assert_eq!(new.summary(home.path(), "taut gallery"), None, "another command");
        assert_eq!(new.summary(home.path(), "taut gallery --seed 3").as_deref(), Some("a table\n"));
        assert_eq!(program("13").summary(home.path(), "taut gallery --seed 3"), None, "another program");
    }

    #[test]
    fn commands_are_shown_as_they_are_typed() {
        assert_eq!(typed(&Part::Drape.command(false)), "taut drape \"heavy blue denim\"");
        assert_eq!(typed(&Part::Atlas.command(true)), "taut measure atlas");
        assert_eq!(tables("a  b\n1  2\nWrote x\n"), "a  b\n1  2");
    }
}
