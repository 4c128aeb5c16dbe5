//! The skip-gram with negative sampling (Mikolov, Sutskever, Chen, Corrado, Dean 2013, "Distributed Representations of
//! Words and Phrases and their Compositionality", eq. 4), one thread and seeded: the same input gives the same bytes.
//!
//! For a centre word w and a word o in its window it climbs
//! `log s(u_o . v_w) + sum over k noise words n of log s(-u_n . v_w)`, s the logistic function, by plain gradient steps
//! with a rate that falls linearly. Noise words are drawn by frequency to the power 3/4, frequent words are left out at
//! random (the paper's subsampling), and the window is drawn anew for each centre.
//!
//! At the end the mean vector is taken from all vectors and each is scaled to length 1. All vectors share a large
//! common part, which would make every description look alike (Mu, Viswanath 2018, "All-but-the-Top").

use super::lanes::{add, dot, exchange, normalise};
use super::random::Random;
use super::table::WordTable;
use super::vocabulary::{Stream, Vocabulary};
use super::{PAD, WordsConfig, WordsError};

/// Length of the table from which noise words are drawn.
const NOISE_SLOTS: usize = 1 << 20;
/// The logistic function is tabulated on [-REACH, REACH] and constant beyond.
const REACH: f32 = 8.0;
/// Entries of the logistic table.
const LOGISTIC_SLOTS: usize = 4096;
/// The learning rate never falls below this share of its start.
const LEAST_RATE: f32 = 1e-4;

/// Trains the vectors of a vocabulary on a stream of text.
///
/// `progress` hears the fraction done, from 0 to 1, after about each hundredth.
///
/// # Errors
/// [`WordsError::Config`] from [`WordsConfig::check`], [`WordsError::Diverged`] when a vector is not finite.
pub fn train(
    vocabulary: &Vocabulary,
    stream: &Stream,
    config: &WordsConfig,
    progress: &mut dyn FnMut(f32),
) -> Result<WordTable, WordsError> {
    config.check()?;
    let counts = counts(vocabulary, stream);
    let keep = keep_probabilities(&counts, config.subsample);
    let noise = noise_table(&counts);
    let mut model = Model::new(vocabulary, config);
    let mut random = Random::new(config.seed, 2);
    let mut order: Vec<usize> = (0..stream.ends.len()).collect();
    let total = (order.len() * config.epochs).max(1);
    let mut done = 0usize;
    let mut sentence: Vec<usize> = Vec::new();
    progress(0.0);
    for _ in 0..config.epochs {
        random.shuffle(&mut order);
        for index in &order {
            let start = if *index == 0 { 0 } else { stream.ends[*index - 1] };
            sentence.clear();
            for id in &stream.ids[start..stream.ends[*index]] {
                if random.unit() < keep[*id as usize] {
                    sentence.push(*id as usize);
                }
            }
            let rate = config.learning_rate * (1.0 - done as f32 / total as f32).max(LEAST_RATE);
            model.sentence(&sentence, rate, config, &noise, &mut random);
            done += 1;
            if done * 100 / total != (done - 1) * 100 / total {
                progress(done as f32 / total as f32);
            }
        }
    }
    model.finish(vocabulary)
}

/// How often each number stands in the stream.
fn counts(vocabulary: &Vocabulary, stream: &Stream) -> Vec<u64> {
    let mut counts = vec![0u64; vocabulary.contexts()];
    for id in &stream.ids {
        counts[*id as usize] += 1;
    }
    counts
}

/// The probability with which each word is kept: sqrt(t/f) + t/f for a relative frequency f (word2vec's own formula).
fn keep_probabilities(counts: &[u64], threshold: f64) -> Vec<f32> {
    let total = counts.iter().sum::<u64>().max(1) as f64;
    counts
        .iter()
        .map(|count| {
            let ratio = threshold / (*count as f64 / total);
            if ratio.is_finite() { (ratio.sqrt() + ratio).min(1.0) as f32 } else { 1.0 }
        })
        .collect()
}

/// A table in which each word stands in proportion to its count to the power 3/4.
fn noise_table(counts: &[u64]) -> Vec<u32> {
    let powers: Vec<f64> = counts.iter().map(|count| (*count as f64).powf(0.75)).collect();
    let total: f64 = powers.iter().sum();
    let mut table = Vec::with_capacity(NOISE_SLOTS);
    let mut upto = 0.0;
    for (id, power) in powers.iter().enumerate() {
        upto += power;
        let end = (upto / total.max(f64::MIN_POSITIVE) * NOISE_SLOTS as f64).round() as usize;
        while table.len() < end.min(NOISE_SLOTS) {
            table.push(id as u32);
        }
    }
    table
}

/// The two matrices and what a step needs.
struct Model {
    dimensions: usize,
    rows: usize,
    /// Vectors of the words as centres, [rows][dimensions].
    centres: Vec<f32>,
    /// Vectors of the words as context, [contexts][dimensions].
    contexts: Vec<f32>,
    gradient: Vec<f32>,
    logistic: Vec<f32>,
}

impl Model {
    fn new(vocabulary: &Vocabulary, config: &WordsConfig) -> Self {
        let dimensions = config.dimensions;
        let mut random = Random::new(config.seed, 3);
        let centres = (0..vocabulary.rows() * dimensions).map(|_| (random.unit() - 0.5) / dimensions as f32).collect();
        let logistic = (0..LOGISTIC_SLOTS)
            .map(|slot| {
                let x = (slot as f64 + 0.5) / LOGISTIC_SLOTS as f64 * 2.0 * f64::from(REACH) - f64::from(REACH);
                (1.0 / (1.0 + (-x).exp())) as f32
            })
            .collect();
        Self {
            dimensions,
            rows: vocabulary.rows(),
            centres,
            contexts: vec![0.0; vocabulary.contexts() * dimensions],
            gradient: vec![0.0; dimensions],
            logistic,
        }
    }

    /// All pairs of a sentence. Words that are only context have no vector and are no centres.
    fn sentence(&mut self, ids: &[usize], rate: f32, config: &WordsConfig, noise: &[u32], random: &mut Random) {
        for (at, centre) in ids.iter().enumerate() {
            let reach = 1 + random.below(config.window);
            if *centre >= self.rows {
                continue;
            }
            let low = at.saturating_sub(reach);
            let high = (at + reach + 1).min(ids.len());
            for (other, context) in ids.iter().enumerate().take(high).skip(low) {
                if other != at && context != centre {
                    self.pair(*centre, *context, rate, config.negatives, noise, random);
                }
            }
        }
    }

    /// One pair and its noise words.
    fn pair(&mut self, centre: usize, context: usize, rate: f32, negatives: usize, noise: &[u32], random: &mut Random) {
        self.gradient.fill(0.0);
        let width = self.dimensions;
        let input = &mut self.centres[centre * width..(centre + 1) * width];
        for draw in 0..=negatives {
            let (target, label) = if draw == 0 {
                (context, 1.0)
            } else {
                let target = random.pick(noise).map_or(context, |id| *id as usize);
                if target == context {
                    continue;
                }
                (target, 0.0)
            };
            let output = &mut self.contexts[target * width..(target + 1) * width];
            let score = dot(input, output);
            let slot =
                ((score + REACH) * (LOGISTIC_SLOTS as f32 / (2.0 * REACH))).clamp(0.0, (LOGISTIC_SLOTS - 1) as f32);
            let step = rate * (label - self.logistic[slot as usize]);
            exchange(step, input, output, &mut self.gradient);
        }
        add(input, &self.gradient);
    }

    /// The table: the mean taken away, every vector of length 1, the padding zero.
    fn finish(mut self, vocabulary: &Vocabulary) -> Result<WordTable, WordsError> {
        let width = self.dimensions;
        let words = (self.rows - 1).max(1) as f64;
        let mut mean = vec![0.0f64; width];
        for row in self.centres.chunks_exact(width).skip(PAD + 1) {
            for (sum, x) in mean.iter_mut().zip(row) {
                *sum += f64::from(*x) / words;
            }
        }
        if mean.iter().any(|x| !x.is_finite()) {
            return Err(WordsError::Diverged);
        }
        for (index, row) in self.centres.chunks_exact_mut(width).enumerate() {
            if index == PAD {
                row.fill(0.0);
                continue;
            }
            for (x, shared) in row.iter_mut().zip(&mean) {
                *x -= *shared as f32;
            }
            normalise(row);
        }
        Ok(WordTable { tokens: vocabulary.tokens().to_vec(), vectors: self.centres })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::words::corpus::Corpus;
    use crate::words::neighbours::similarity;
    use crate::words::vocabulary::encode;

    fn small() -> WordsConfig {
        WordsConfig {
            dimensions: 32,
            epochs: 30,
            subsample: 1.0,
            vocabulary: 40,
            context_vocabulary: 40,
            ..WordsConfig::default()
        }
    }

    fn trained(config: &WordsConfig) -> (WordTable, Vec<f32>) {
        let mut corpus = Corpus::default();
        for _ in 0..40 {
            corpus.add_text(
                "heavy thick denim coat. thick heavy canvas coat. light thin silk scarf. thin light chiffon scarf.",
            );
        }
        let vocabulary = Vocabulary::choose(&corpus, &[], config.vocabulary, config.context_vocabulary);
        let stream = encode(&corpus, &[], &vocabulary, 1);
        let mut heard = Vec::new();
        let table = train(&vocabulary, &stream, config, &mut |fraction| heard.push(fraction)).expect("trained");
        (table, heard)
    }

    #[test]
    fn words_of_one_company_come_together() {
        let (table, heard) = trained(&small());
        let of = |a: &str, b: &str| similarity(&table, a, b).expect("known");
        assert!(of("denim", "canvas") > of("denim", "silk") + 0.3);
        assert!(of("silk", "chiffon") > of("silk", "canvas") + 0.3);
        assert!(of("heavy", "thick") > of("heavy", "thin") + 0.3);
        assert!(heard.len() > 90 && heard.windows(2).all(|pair| pair[0] <= pair[1]));
        assert_eq!((heard.first(), heard.last()), (Some(&0.0), Some(&1.0)));
        table.check().expect("a sound table");
    }

    #[test]
    fn the_same_seed_gives_the_same_bits() {
        let first = trained(&small()).0;
        assert_eq!(first, trained(&small()).0);
        assert_ne!(first, trained(&WordsConfig { seed: 2, ..small() }).0);
    }

    #[test]
    fn frequent_words_are_thinned_and_noise_follows_the_power() {
        let keep = keep_probabilities(&[9_900, 99, 1, 0], 1e-3);
        assert!(keep[0] < 0.04 && keep[1] < 0.5 && keep[2] == 1.0 && keep[3] == 1.0);
        let table = noise_table(&[0, 16, 1]);
        let share = |id: u32| table.iter().filter(|x| **x == id).count() as f64 / table.len() as f64;
        assert!(share(0) == 0.0 && (share(1) - 8.0 / 9.0).abs() < 1e-5);
        assert!(noise_table(&[0, 0]).len() <= NOISE_SLOTS);
    }

    #[test]
    fn wrong_settings_are_named() {
        for (config, word) in [
            (WordsConfig { dimensions: 1000, ..small() }, "dimensions"),
            (WordsConfig { negatives: 0, ..small() }, "negatives"),
            (WordsConfig { learning_rate: f32::NAN, ..small() }, "learning_rate"),
            (WordsConfig { subsample: 0.0, ..small() }, "subsample"),
            (WordsConfig { context_vocabulary: 3, ..small() }, "context_vocabulary"),
        ] {
            let error = config.check().expect_err("refused").to_string();
            assert!(error.contains(word), "{error}");
        }
    }
}
