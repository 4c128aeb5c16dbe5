//! A folder of pictures: `data.json` says what they are of, and each part is `SPLIT-NNN.npz` (uint8 `images` [n, 3, 64, 64], where
//! value = level/127.5 - 1, and float32 `positions` [n, 256, 3] in m) beside `SPLIT-NNN.jsonl` (a line for each picture). A part
//! is there when its lines are: they are written last. So parts that several machines made merge by lying in one folder.

use std::fs;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use taut_lab::fabric::{Fabric, KINDS};
use taut_lab::npz::{self, Npz, Numbers};

use super::make::Frame;
use super::plan::Trajectory;
use super::{CHANNELS, DataError, GRID, Plan, Sample, Scene, Split};
use crate::files::write_whole;
use crate::image::{Channel, PIXELS};

/// Version of the files.
const FORMAT: u32 = 1;

/// Values of a picture and of its cloth.
const IMAGE: usize = CHANNELS.len() * PIXELS;
const POSITIONS: usize = 3 * GRID * GRID;

/// What the pictures of a folder are of.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Header {
    format: u32,
    plan: Plan,
    grid: usize,
    channels: Vec<Channel>,
}

impl Header {
    fn of(plan: Plan) -> Header {
        Header { format: FORMAT, plan, grid: GRID, channels: CHANNELS.to_vec() }
    }
}

/// The line of a picture.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Line {
    trajectory: usize,
    kind: String,
    words: String,
    scene: Scene,
    pins: Vec<usize>,
    time_s: f64,
    at_rest: bool,
    stiffness_n_per_m: [f32; 4],
    density_kg_m2: f32,
    hinge_rigidity_n_m: f32,
    softness: [f32; 2],
}

/// Makes the folder, or checks that it is for the same set.
pub(super) fn open(folder: &Path, plan: Plan) -> Result<(), DataError> {
    fs::create_dir_all(folder).map_err(|e| DataError::file(folder, e))?;
    let path = folder.join("data.json");
    if path.exists() {
        let found = header(folder)?;
        if found != Header::of(plan) {
            return Err(DataError::file(folder, "holds another set (data.json); choose another folder"));
        }
        return Ok(());
    }
    let text = serde_json::to_string_pretty(&Header::of(plan)).map_err(|e| DataError::file(&path, e))?;
    write_whole(&path, text.as_bytes()).map_err(|e| DataError::file(&path, e))
}

fn header(folder: &Path) -> Result<Header, DataError> {
    let path = folder.join("data.json");
    let text = fs::read_to_string(&path).map_err(|e| DataError::file(&path, e))?;
    serde_json::from_str(&text).map_err(|e| DataError::file(&path, e))
}

fn paths(folder: &Path, split: Split, part: usize) -> [PathBuf; 2] {
    ["npz", "jsonl"].map(|kind| folder.join(format!("{}-{part:03}.{kind}", split.name())))
}

/// Whether a part is there.
pub(super) fn has(folder: &Path, split: Split, part: usize) -> bool {
    paths(folder, split, part).iter().all(|p| p.exists())
}

/// The frames of a trajectory with their pictures.
pub(super) type Pictures<'a> = (&'a Trajectory, Vec<(Frame, Vec<f32>)>);

/// Writes a part: frames of its trajectories with their pictures.
pub(super) fn write(folder: &Path, split: Split, part: usize, all: &[Pictures<'_>]) -> Result<(), DataError> {
    let [npz_path, lines_path] = paths(folder, split, part);
    let (mut images, mut positions, mut lines) = (Vec::new(), Vec::new(), String::new());
    for (t, frames) in all {
        for (frame, image) in frames {
            images.extend(image.iter().map(|v| ((v + 1.0) * 127.5).round() as u8));
            positions.extend_from_slice(&frame.positions);
            let line = Line {
                trajectory: t.number,
                kind: t.fabric.kind.into(),
                words: t.words.clone(),
                scene: t.scene,
                pins: t.pins(),
                time_s: frame.time_s,
                at_rest: frame.at_rest,
                stiffness_n_per_m: t.fabric.stiffness,
                density_kg_m2: t.fabric.density_kg_m2,
                hinge_rigidity_n_m: t.fabric.hinge_rigidity_n_m,
                softness: t.fabric.softness,
            };
            lines += &serde_json::to_string(&line).map_err(|e| DataError::file(&lines_path, e))?;
            lines.push('\n');
        }
    }
    let n = images.len() / IMAGE;
    let new = npz_path.with_extension("npz.new");
    let side = crate::image::SIDE;
    npz::write(
        &new,
        &[
            ("images", &[n, CHANNELS.len(), side, side], Numbers::Levels(&images)),
            ("positions", &[n, GRID * GRID, 3], Numbers::Floats(&positions)),
        ],
    )
    .map_err(|e| DataError::file(&new, e))?;
    fs::rename(&new, &npz_path).map_err(|e| DataError::file(&npz_path, e))?;
    write_whole(&lines_path, lines.as_bytes()).map_err(|e| DataError::file(&lines_path, e))
}

/// Reads the pictures of a split, in order.
///
/// # Errors
/// [`DataError::Incomplete`] where parts are missing; [`DataError::File`] names the file that is cut off or not what it says.
pub fn load(folder: &Path, split: Split) -> Result<Vec<Sample>, DataError> {
    let found = header(folder)?;
    if found != Header::of(found.plan) {
        return Err(DataError::file(&folder.join("data.json"), "is of another version of this program"));
    }
    let parts = found.plan.parts(split);
    let missing = (0..parts.len()).filter(|i| !has(folder, split, *i)).count();
    if missing > 0 {
        return Err(DataError::Incomplete { folder: folder.into(), missing, of: parts.len() });
    }
    let mut all = Vec::with_capacity(found.plan.images(split));
    for (i, part) in parts.iter().enumerate() {
        all.extend(read(folder, split, i, part)?);
    }
    Ok(all)
}

fn read(folder: &Path, split: Split, part: usize, plan: &[Trajectory]) -> Result<Vec<Sample>, DataError> {
    let [npz_path, lines_path] = paths(folder, split, part);
    let text = fs::read_to_string(&lines_path).map_err(|e| DataError::file(&lines_path, e))?;
    let planned: Vec<&Trajectory> = plan.iter().flat_map(|t| std::iter::repeat_n(t, t.frames)).collect();
    let n = planned.len();
    let mut lines = Vec::with_capacity(n);
    for (i, line) in text.lines().enumerate() {
        let wrong = |reason: String| DataError::file(&lines_path, format!("line {}: {reason}", i + 1));
        let line: Line = serde_json::from_str(line).map_err(|e| wrong(e.to_string()))?;
        let t = planned.get(i).ok_or_else(|| wrong(format!("there should be {n} lines")))?;
        if (line.trajectory, line.scene, &line.pins, &line.words) != (t.number, t.scene, &t.pins(), &t.words) {
            return Err(wrong("is not the picture that the plan has here".into()));
        }
        let numbers = line.stiffness_n_per_m.iter().chain([&line.density_kg_m2, &line.hinge_rigidity_n_m]);
        if !numbers.chain(&line.softness).all(|k| k.is_finite() && *k > 0.0) || !(0.0..1e3).contains(&line.time_s) {
            return Err(wrong("a number is out of range".into()));
        }
        lines.push(line);
    }
    if lines.len() != n {
        return Err(DataError::file(&lines_path, format!("is cut off: {} of {n} lines", lines.len())));
    }
    let mut npz = Npz::open(&npz_path).map_err(|e| DataError::file(&npz_path, e.reason))?;
    let shape = |what: &str, found: &[usize], expected: &[usize]| match found == expected {
        true => Ok(()),
        false => {
            Err(DataError::file(&npz_path, format!("array `{what}` has the shape {found:?}, expected {expected:?}")))
        }
    };
    let array =
        |e: npz::NpzError| DataError::file(&npz_path, format!("array `{}`: {}", e.array.unwrap_or_default(), e.reason));
    let images = npz.levels("images").map_err(array)?;
    let side = crate::image::SIDE;
    shape("images", &images.shape, &[n, CHANNELS.len(), side, side])?;
    let positions = npz.floats("positions").map_err(array)?;
    shape("positions", &positions.shape, &[n, GRID * GRID, 3])?;
    let pictures = images.values.chunks_exact(IMAGE).zip(positions.values.chunks_exact(POSITIONS));
    (lines.into_iter().zip(pictures))
        .map(|(line, (image, x))| {
            let kind = KINDS.iter().find(|k| k.name == line.kind);
            let kind = kind.ok_or_else(|| DataError::file(&lines_path, format!("no kind is named `{}`", line.kind)))?;
            Ok(Sample {
                fabric: Fabric {
                    stiffness: line.stiffness_n_per_m,
                    density_kg_m2: line.density_kg_m2,
                    hinge_rigidity_n_m: line.hinge_rigidity_n_m,
                    softness: line.softness,
                    ..kind.fabric()
                },
                words: line.words,
                scene: line.scene,
                pins: line.pins,
                time_s: line.time_s,
                at_rest: line.at_rest,
                positions: x.to_vec(),
                image: image.iter().map(|l| f32::from(*l) / 127.5 - 1.0).collect(),
            })
        })
        .collect()
}
