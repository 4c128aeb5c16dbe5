//! Word vectors: a skip-gram with negative sampling (Mikolov et al. 2013) over real text and over generated sentences
//! about fabrics. They are the `v_text` of the paper's Fig. 3 (section IV.B): 1024 numbers a word.
//!
//! The way from text to table:
//! [`corpus`] reads sentences, [`sentences`] adds our own, made from the [`catalogue`] of fabrics and the [`scales`] of
//! their qualities; [`vocabulary`] chooses the words that get a vector; [`skipgram`] trains; [`table`] stores the result
//! as f16; [`neighbours`] looks at it. The trained table is committed, so nothing but training needs a corpus.

pub mod catalogue;
pub mod command;
pub mod corpus;
mod lanes;
pub mod neighbours;
mod random;
pub mod scales;
pub mod sentences;
pub mod skipgram;
pub mod table;
pub mod tokens;
pub mod vocabulary;

use std::fmt;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

pub use table::WordTable;

/// The index of the padding row, which is all zeros.
pub const PAD: usize = 0;
/// The token of the padding row.
pub const PAD_TOKEN: &str = "<pad>";

/// What a training run of the word vectors depends on, besides the corpus.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct WordsConfig {
    /// Seed of every random choice: sentences, order, windows, negatives, first values.
    pub seed: u64,
    /// Length of a vector; a multiple of 16, at most 4096. The paper's is 1024.
    pub dimensions: usize,
    /// Largest distance of a context word, in words; each centre draws its own from 1 to this.
    pub window: usize,
    /// Noise words drawn for each true pair, 1 to 64.
    pub negatives: usize,
    /// Passes over the corpus and the generated sentences.
    pub epochs: usize,
    /// Learning rate at the start; it falls linearly to 1e-4 of itself.
    pub learning_rate: f32,
    /// Threshold t of the subsampling of frequent words: a word of frequency f is kept with sqrt(t/f) + t/f.
    pub subsample: f64,
    /// Rows of the table at most, the padding row included.
    pub vocabulary: usize,
    /// Words that may stand as context at most: the vocabulary and the next frequent words.
    pub context_vocabulary: usize,
    /// Number of generated sentences about fabrics.
    pub fabric_sentences: usize,
    /// How often a sentence of the corpus about textiles is read in each pass; the others are read once.
    pub textile_repeat: usize,
}

impl Default for WordsConfig {
    fn default() -> Self {
        Self {
            seed: 1,
            dimensions: 1024,
            window: 5,
            negatives: 5,
            epochs: 3,
            learning_rate: 0.05,
            subsample: 3e-4,
            vocabulary: 3000,
            context_vocabulary: 6000,
            fabric_sentences: 60_000,
            textile_repeat: 3,
        }
    }
}

impl WordsConfig {
    /// Says what is wrong with the values, if anything is.
    ///
    /// # Errors
    /// [`WordsError::Config`] with the field and its allowed range.
    pub fn check(&self) -> Result<(), WordsError> {
        let within = |name: &str, value: usize, low: usize, high: usize| {
            if (low..=high).contains(&value) {
                Ok(())
            } else {
                Err(WordsError::Config(format!("{name} is {value}, but must be {low} to {high}")))
            }
        };
        within("dimensions", self.dimensions, 16, 4096)?;
        if !self.dimensions.is_multiple_of(lanes::LANES) {
            return Err(WordsError::Config(format!(
                "dimensions is {}, but must be a multiple of {}",
                self.dimensions,
                lanes::LANES
            )));
        }
        within("window", self.window, 1, 64)?;
        within("negatives", self.negatives, 1, 64)?;
        within("epochs", self.epochs, 1, 1000)?;
        within("vocabulary", self.vocabulary, 2, 65_536)?;
        within("context_vocabulary", self.context_vocabulary, self.vocabulary, 1_000_000)?;
        within("fabric_sentences", self.fabric_sentences, 0, 10_000_000)?;
        within("textile_repeat", self.textile_repeat, 1, 100)?;
        if !(self.learning_rate > 0.0 && self.learning_rate <= 1.0) {
            return Err(WordsError::Config(format!(
                "learning_rate is {}, but must be above 0 and at most 1",
                self.learning_rate
            )));
        }
        if !(self.subsample > 0.0 && self.subsample <= 1.0) {
            return Err(WordsError::Config(format!(
                "subsample is {}, but must be above 0 and at most 1",
                self.subsample
            )));
        }
        Ok(())
    }
}

/// What can go wrong with words.
#[derive(Debug)]
pub enum WordsError {
    /// A file or folder could not be read or written.
    Io {
        /// The file or folder.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// A file of the corpus is not UTF-8 text.
    NotText {
        /// The file.
        path: PathBuf,
    },
    /// The corpus holds no sentence.
    EmptyCorpus {
        /// The file or folder.
        path: PathBuf,
    },
    /// A value of the configuration is out of range.
    Config(String),
    /// A file or a set of vectors is not a word table.
    Table(String),
    /// Training left vectors that are not finite.
    Diverged,
    /// A word that was asked for is not in the table.
    Unknown(String),
}

impl fmt::Display for WordsError {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Io { path, source } => write!(out, "{}: {source}", path.display()),
            Self::NotText { path } => write!(out, "{}: not UTF-8 text", path.display()),
            Self::EmptyCorpus { path } => write!(
                out,
                "{}: no sentence found (expected a text file, or a folder of data.*, .txt or .md files)",
                path.display()
            ),
            Self::Config(what) => write!(out, "word training: {what}"),
            Self::Table(what) => write!(out, "word table: {what}"),
            Self::Diverged => write!(out, "word training: the vectors are no longer finite; lower the learning rate"),
            Self::Unknown(word) => write!(out, "the word table does not know '{word}'"),
        }
    }
}

impl std::error::Error for WordsError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Io { source, .. } => Some(source),
            _ => None,
        }
    }
}

/// Trains the word table: from text to unit vectors.
///
/// `corpus` is a text file or a folder ([`corpus::Corpus::read`]); `progress` hears the fraction done, 0 to 1, never
/// falling, about a hundred times. The same corpus, configuration and program give the same bytes: one thread, seeded.
///
/// # Errors
/// [`WordsError`]: the configuration, reading, an empty corpus, or vectors that are not finite.
pub fn train_words(
    corpus: &Path,
    config: &WordsConfig,
    progress: &mut dyn FnMut(f32),
) -> Result<WordTable, WordsError> {
    config.check()?;
    let text = corpus::Corpus::read(corpus)?;
    let fabrics = sentences::fabric_sentences(config.fabric_sentences, config.seed);
    let chosen = vocabulary::Vocabulary::choose(&text, &fabrics, config.vocabulary, config.context_vocabulary);
    let stream = vocabulary::encode(&text, &fabrics, &chosen, config.textile_repeat);
    skipgram::train(&chosen, &stream, config, progress)
}
