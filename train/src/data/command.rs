//! `taut-train data`.

use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};

use super::plan::Trajectory;
use super::{CHANNELS, DataError, GRID, Plan, Sample, Split, load, make, store};
use crate::Shard;
use crate::image::{RenderConfig, Renderer, SheetLayout, available_threads, write_sheet};
use crate::stop::on_ctrl_c;

/// Pictures of cloth to learn from and to judge by.
#[derive(Debug, Args)]
pub struct DataArgs {
    /// Folder of the pictures; what is there is not made again
    #[arg(long)]
    pub out: PathBuf,
    /// Seed of every choice
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Make the i-th of n shares, i from 1; shares merge by lying in one folder
    #[arg(long, value_name = "i/n")]
    pub shard: Option<Shard>,
    /// A set of 63 pictures of short motions instead of 7338
    #[arg(long)]
    pub quick: bool,
    /// Threads [default: one for each core]
    #[arg(long)]
    pub threads: Option<usize>,
}

/// Makes what is missing of a set.
///
/// # Errors
/// [`DataError`]; after Ctrl-C the parts that are done are kept.
pub fn run(args: &DataArgs) -> Result<(), DataError> {
    run_until(args, &on_ctrl_c())
}

/// [`run`], until `stop` is set.
pub(super) fn run_until(args: &DataArgs, stop: &AtomicBool) -> Result<(), DataError> {
    let plan = Plan { seed: args.seed, quick: args.quick };
    let shard = args.shard.unwrap_or(Shard::WHOLE);
    let threads = args.threads.unwrap_or(available_threads().get());
    if !(1..=1024).contains(&threads) {
        return Err(DataError::Given("--threads must be 1 to 1024".into()));
    }
    store::open(&args.out, plan)?;
    let all = Split::ALL.into_iter().flat_map(|split| {
        let parts = plan.parts(split).into_iter().enumerate();
        parts.map(move |(i, part)| (split, i, part))
    });
    let mine: Vec<(Split, usize, Vec<Trajectory>)> =
        all.enumerate().filter(|(i, _)| shard.has(*i)).map(|(_, part)| part).collect();
    let todo: Vec<_> = mine.iter().filter(|(split, i, _)| !store::has(&args.out, *split, *i)).collect();
    if todo.is_empty() {
        eprintln!("{}: all there", args.out.display());
    }

    let pictures = |t: &Trajectory| t.frames as u64;
    let bar = ProgressBar::new(todo.iter().flat_map(|(_, _, part)| part).map(pictures).sum());
    if let Ok(style) = ProgressStyle::with_template("pictures [{bar:30}] {pos}/{len} {elapsed}, {eta} left {msg}") {
        bar.set_style(style.progress_chars("=> "));
    }
    let renderer = renderer()?;
    let next = AtomicUsize::new(0);
    let failed = Mutex::new(None);
    std::thread::scope(|scope| {
        for _ in 0..threads.min(todo.len()) {
            scope.spawn(|| {
                while let Some((split, i, part)) = todo.get(next.fetch_add(1, Ordering::SeqCst)) {
                    if let Err(e) = make_part(&args.out, *split, *i, part, &renderer, &bar, stop) {
                        stop.store(true, Ordering::SeqCst);
                        if let Ok(mut first) = failed.lock() {
                            first.get_or_insert(e);
                        }
                        return;
                    }
                }
            });
        }
    });
    if let Ok(Some(e)) = failed.into_inner() {
        bar.abandon();
        return Err(e);
    }
    bar.finish_and_clear();
    let complete = |split: Split| (0..plan.parts(split).len()).all(|i| store::has(&args.out, split, i));
    for split in Split::ALL.into_iter().filter(|s| complete(*s)) {
        let path = args.out.join(format!("{}.png", split.name()));
        if !path.exists() || !todo.is_empty() {
            contact_sheet(&path, &load(&args.out, split)?)?;
        }
    }
    for split in Split::ALL {
        let state = if complete(split) { "complete" } else { "not complete: parts of other shares are missing" };
        println!("{:<11} {:>5} pictures, {state}", split.name(), plan.images(split));
    }
    Ok(())
}

fn renderer() -> Result<Renderer, DataError> {
    let config = RenderConfig { channels: CHANNELS.to_vec(), ..RenderConfig::default() };
    Renderer::new(config, GRID, GRID).map_err(|e| DataError::Given(e.to_string()))
}

fn make_part(
    folder: &Path,
    split: Split,
    number: usize,
    part: &[Trajectory],
    renderer: &Renderer,
    bar: &ProgressBar,
    stop: &AtomicBool,
) -> Result<(), DataError> {
    let mut all = Vec::with_capacity(part.len());
    for t in part {
        if stop.load(Ordering::SeqCst) {
            return Err(DataError::Interrupted);
        }
        let mut pictures = Vec::with_capacity(t.frames);
        for frame in make::frames(t)? {
            let image = renderer.render(&t.scene.view().of(&frame.positions));
            pictures.push((frame, image.map_err(|e| DataError::Given(e.to_string()))?));
        }
        bar.inc(t.frames as u64);
        all.push((t, pictures));
    }
    store::write(folder, split, number, &all)
}

/// Five scenes of up to six fabrics: a moment of the motion, right of it the cloth at rest.
fn contact_sheet(path: &Path, samples: &[Sample]) -> Result<(), DataError> {
    const FABRICS: usize = 6;
    const SCENES: usize = super::Scene::ALL.len();
    let trajectories: Vec<&[Sample]> = samples.chunk_by(|a, b| a.scene == b.scene && a.fabric == b.fabric).collect();
    let fabrics = trajectories.len() / SCENES;
    let shown = fabrics.clamp(1, FABRICS);
    let chosen = (0..shown).flat_map(|i| trajectories.iter().skip(i * fabrics / shown * SCENES).take(SCENES));
    let (mut moving, mut resting) = (Vec::new(), Vec::new());
    for trajectory in chosen {
        let (Some(last), Some(middle)) = (trajectory.last(), trajectory.get(trajectory.len() / 3)) else { continue };
        moving.extend_from_slice(&middle.image);
        resting.extend_from_slice(&last.image);
    }
    let layout = SheetLayout { channels: CHANNELS.len(), pairs_per_row: SCENES, zoom: 1 };
    write_sheet(path, &moving, &resting, layout).map_err(|e| DataError::file(path, e))
}
