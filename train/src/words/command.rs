//! The commands about words: train a table, look at one.

use std::path::PathBuf;

use clap::{Args, Subcommand};
use indicatif::{ProgressBar, ProgressStyle};

use super::neighbours::{FABRIC_WORDS, markdown};
use super::{WordTable, WordsConfig, WordsError, train_words};

/// What to do with words.
#[derive(Debug, Subcommand)]
pub enum WordsCommand {
    /// Train word vectors on a corpus and write the table
    Train(TrainArgs),
    /// Print the nearest words of some words, as a Markdown table
    Neighbours(NeighboursArgs),
}

/// Arguments of training.
#[derive(Debug, Args)]
pub struct TrainArgs {
    /// A text file, or a folder with WordNet's data files or .txt and .md files
    #[arg(long)]
    pub corpus: PathBuf,
    /// The table to write
    #[arg(long)]
    pub out: PathBuf,
    /// Seed of every random choice
    #[arg(long, default_value_t = WordsConfig::default().seed)]
    pub seed: u64,
    /// Passes over the text
    #[arg(long, default_value_t = WordsConfig::default().epochs)]
    pub epochs: usize,
    /// Length of a vector, a multiple of 16
    #[arg(long, default_value_t = WordsConfig::default().dimensions)]
    pub dimensions: usize,
    /// Learning rate at the start
    #[arg(long, default_value_t = WordsConfig::default().learning_rate)]
    pub learning_rate: f32,
    /// Number of generated sentences about fabrics
    #[arg(long, default_value_t = WordsConfig::default().fabric_sentences)]
    pub fabric_sentences: usize,
}

/// Arguments of looking.
#[derive(Debug, Args)]
pub struct NeighboursArgs {
    /// The words; thirty fabric words where none is named
    pub words: Vec<String>,
    /// A table other than the one that ships
    #[arg(long)]
    pub table: Option<PathBuf>,
}

/// Runs a command; results go to stdout, the progress bar to stderr.
///
/// # Errors
/// [`WordsError`] from training, reading or writing.
pub fn run(command: &WordsCommand) -> Result<(), WordsError> {
    match command {
        WordsCommand::Train(args) => train(args),
        WordsCommand::Neighbours(args) => {
            let table = match &args.table {
                Some(path) => WordTable::load(path)?,
                None => WordTable::committed()?,
            };
            let named: Vec<&str> = args.words.iter().map(String::as_str).collect();
            print!("{}", markdown(&table, if named.is_empty() { &FABRIC_WORDS } else { &named })?);
            Ok(())
        }
    }
}

/// Trains and writes a table.
fn train(args: &TrainArgs) -> Result<(), WordsError> {
    let config = WordsConfig {
        seed: args.seed,
        epochs: args.epochs,
        dimensions: args.dimensions,
        learning_rate: args.learning_rate,
        fabric_sentences: args.fabric_sentences,
        ..WordsConfig::default()
    };
    let bar = ProgressBar::new(1000);
    if let Ok(style) = ProgressStyle::with_template("words {bar:40} {percent}% {elapsed_precise} left {eta_precise}") {
        bar.set_style(style);
    }
    let table = train_words(&args.corpus, &config, &mut |fraction| bar.set_position((fraction * 1000.0) as u64))?;
    bar.finish();
    table.save(&args.out, &origin(args, &config))?;
    println!("{} words of {} dimensions written to {}", table.tokens.len() - 1, table.dimensions(), args.out.display());
    Ok(())
}

/// The line that tells how a table was made; of the corpus only the last name, so that no machine's paths are kept.
fn origin(args: &TrainArgs, config: &WordsConfig) -> String {
    let corpus = args.corpus.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    format!(
        "corpus {corpus}; seed {} window {} negatives {} epochs {} rate {} subsample {} contexts {} sentences {} repeat {}",
        config.seed,
        config.window,
        config.negatives,
        config.epochs,
        config.learning_rate,
        config.subsample,
        config.context_vocabulary,
        config.fabric_sentences,
        config.textile_repeat
    )
}
