use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use taut_lab::plot::Figure;

use super::{Checkpoint, Dataset, TrainConfig, TrainError, Trainer, plot};
use crate::export;
use crate::files;
use crate::image::{RenderConfig, Renderer};
use crate::stop::on_ctrl_c;
use crate::words::{WordTable, WordsConfig, train_words};

/// From nothing to a generator file.
#[derive(Debug, Args)]
pub struct RunArgs {
    /// Folder of the run: configuration, checkpoint, log, picture sheets, generator.onnx
    #[arg(long)]
    pub out: PathBuf,
    /// Text to train the word vectors on (a file or a folder); without it the table that ships is used
    #[arg(long)]
    pub corpus: Option<PathBuf>,
    /// A configuration as JSON; what it leaves out has its default
    #[arg(long)]
    pub config: Option<PathBuf>,
    /// The paper's own recipe instead of ours
    #[arg(long, conflicts_with = "config")]
    pub paper: bool,
    /// A tiny run through every stage
    #[arg(long, conflicts_with_all = ["config", "paper"])]
    pub quick: bool,
    /// Seed, in place of that of the configuration
    #[arg(long)]
    pub seed: Option<u64>,
}

/// Runs, or goes on with, a training run. Ctrl-C writes a checkpoint and ends it.
pub fn run(args: &RunArgs) -> Result<(), TrainError> {
    let config = configuration(args)?;
    config.check()?;
    let out = args.out.as_path();
    fs::create_dir_all(out).map_err(|e| TrainError::file(out, e))?;

    let stop = on_ctrl_c();

    let words = word_table(args, out)?;
    let meta = config.meta()?;
    let renderer = Arc::new(renderer(&config)?);
    let bar = bar("reference cloths", 1000);
    let data = Dataset::new(&config, words, &meta, &renderer, |share| bar.set_position((1000.0 * share) as u64))?;
    bar.finish_and_clear();
    let (trainer, best) = train_in(out, &config, data, renderer, "training", &stop)?;

    let bytes = export::export(trainer.generator(), trainer.data().words(), &meta).map_err(TrainError::part)?;
    let path = out.join("generator.onnx");
    write_whole(&path, &bytes)?;
    // what burn answers on the file's own numbers, for other runtimes to be compared with
    let words = trainer.data().words();
    let input = export::fixture::input(2, words.tokens.len(), config.seed);
    let sample = export::run_rounded(trainer.generator(), words, &input).map_err(TrainError::part)?;
    write_whole(&out.join("parity.json"), &serde_json::to_vec(&sample).map_err(TrainError::part)?)?;
    let chart = plot::losses(&out.join("log.jsonl"))?;
    write_whole(&out.join("losses.png"), &chart.png().map_err(TrainError::part)?)?;
    println!("{}: {} bytes, weights of step {}", path.display(), bytes.len(), best);
    Ok(())
}

/// The renderer of a configuration.
pub fn renderer(config: &TrainConfig) -> Result<Renderer, TrainError> {
    let render = RenderConfig { channels: config.picture.clone(), ..RenderConfig::default() };
    Renderer::new(render, config.grid, config.grid).map_err(TrainError::part)
}

/// Trains in a folder, which must exist, or goes on where it ended there. The trainer comes back with the weights that the
/// evaluation set chose, beside the step that they are of. `name` stands on the progress bar.
///
/// # Errors
/// [`TrainError::Interrupted`] when `stop` was set; the same call goes on from there.
pub fn train_in(
    out: &Path,
    config: &TrainConfig,
    data: Dataset,
    renderer: Arc<Renderer>,
    name: &str,
    stop: &AtomicBool,
) -> Result<(Trainer, usize), TrainError> {
    let state = Checkpoint::read(out)?;
    let text = serde_json::to_string_pretty(config).map_err(TrainError::part)?;
    write_whole(&out.join("config.json"), text.as_bytes())?;
    let mut trainer = Trainer::new(config, data, renderer)?;
    let mut best = None;
    if let Some(state) = state {
        trainer.resume(out, &state)?;
        best = state.best;
        eprintln!("{name}: going on from step {}", trainer.step);
    }
    train(config, &mut trainer, &mut best, out, name, stop)?;
    let chosen = out.join("best.bpk");
    if chosen.exists() {
        trainer.load_generator(&chosen)?;
    }
    let step = best.map_or(trainer.step, |b| b.1);
    Ok((trainer, step))
}

fn train(
    config: &TrainConfig,
    trainer: &mut Trainer,
    best: &mut Option<(f64, usize)>,
    out: &Path,
    name: &str,
    stop: &AtomicBool,
) -> Result<(), TrainError> {
    let total = config.steps.total();
    let mut log = Log::open(&out.join("log.jsonl"), trainer.step)?;
    let bar = bar(name, total as u64);
    bar.set_position(trainer.step as u64);
    while trainer.step < total {
        let stage = trainer.stage();
        let rate = trainer.rate();
        let losses = trainer.advance()?;
        log.line(&serde_json::json!({ "step": trainer.step, "stage": stage, "rate": rate, "losses": losses }))?;
        bar.set_position(trainer.step as u64);
        bar.set_message(format!("{stage:?} loss {:.4}", losses.generator));
        let report = trainer.step.is_multiple_of(config.report_every) || trainer.step == total;
        if report {
            let sheet = out.join(format!("sheet-{:06}.png", trainer.step));
            // where later stages follow, the weights are no candidates: the score sees one drape per fabric on a coarse
            // grid without noise, and not how smooth a field is
            let candidate = stage == config.steps.last() || trainer.step == total;
            if candidate {
                trainer.calibrate();
            }
            let score = trainer.evaluate(Some(&sheet))?;
            let field = trainer.field_error()?;
            log.line(&serde_json::json!({ "step": trainer.step, "evaluation_nmse": score.nmse, "evaluation_nmse_by_scene": score.by_scene, "evaluation_ln_k": field }))?;
            if candidate && best.is_none_or(|(b, _)| score.nmse < b) {
                *best = Some((score.nmse, trainer.step));
                trainer.save_generator(&out.join("best.bpk"))?;
            }
        }
        let stopped = stop.load(Ordering::SeqCst);
        if report || stopped {
            trainer.save(out, *best)?;
        }
        if stopped && trainer.step < total {
            bar.abandon();
            return Err(TrainError::Interrupted { step: trainer.step });
        }
    }
    bar.finish_and_clear();
    Ok(())
}

fn configuration(args: &RunArgs) -> Result<TrainConfig, TrainError> {
    let mut config = match &args.config {
        Some(path) => {
            let text = fs::read_to_string(path).map_err(|e| TrainError::file(path, e))?;
            serde_json::from_str(&text).map_err(|e| TrainError::file(path, e))?
        }
        None if args.paper => TrainConfig::paper(),
        None if args.quick => TrainConfig::quick(),
        None => TrainConfig::default(),
    };
    if let Some(seed) = args.seed {
        config.seed = seed;
    }
    Ok(config)
}

/// The word table: trained on the corpus (once a run), or the one that ships.
fn word_table(args: &RunArgs, out: &Path) -> Result<WordTable, TrainError> {
    let Some(corpus) = &args.corpus else {
        return WordTable::committed().map_err(TrainError::part);
    };
    let path = out.join("words.f16");
    if path.exists() {
        return WordTable::load(&path).map_err(TrainError::part);
    }
    let bar = bar("word vectors", 1000);
    let config = WordsConfig::default();
    let table = train_words(corpus, &config, &mut |share| bar.set_position((1000.0 * share) as u64));
    bar.finish_and_clear();
    let table = table.map_err(TrainError::part)?;
    table.save(&path, "trained by a run").map_err(TrainError::part)?;
    // what the file holds is rounded; a resumed run reads the file, so this one does too
    WordTable::load(&path).map_err(TrainError::part)
}

/// The log of a run: one JSON object a line; lines after the step that is gone on from are dropped.
struct Log {
    path: PathBuf,
    file: fs::File,
}

impl Log {
    fn open(path: &Path, step: usize) -> Result<Log, TrainError> {
        let text = fs::read_to_string(path).unwrap_or_default();
        let kept: String = text
            .lines()
            .filter(|line| {
                let value: Option<serde_json::Value> = serde_json::from_str(line).ok();
                value.and_then(|v| v["step"].as_u64()).is_some_and(|s| s as usize <= step)
            })
            .flat_map(|line| [line, "\n"])
            .collect();
        write_whole(path, kept.as_bytes())?;
        let file = fs::OpenOptions::new().append(true).open(path).map_err(|e| TrainError::file(path, e))?;
        Ok(Log { path: path.to_path_buf(), file })
    }

    fn line(&mut self, value: &serde_json::Value) -> Result<(), TrainError> {
        writeln!(self.file, "{value}").map_err(|e| TrainError::file(&self.path, e))
    }
}

pub(crate) fn bar(what: &str, length: u64) -> ProgressBar {
    let bar = ProgressBar::new(length);
    if let Ok(style) = ProgressStyle::with_template("{prefix} [{bar:30}] {pos}/{len} {eta} {msg}") {
        bar.set_style(style.progress_chars("=> "));
    }
    bar.set_prefix(what.to_string());
    bar
}

/// Writes a file whole or not at all.
pub(crate) fn write_whole(path: &Path, bytes: &[u8]) -> Result<(), TrainError> {
    files::write_whole(path, bytes).map_err(|e| TrainError::file(path, e))
}
