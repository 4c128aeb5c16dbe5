//! Made-up parts for checking the export without a training: a network that has seen a few batches, a word table,
//! inputs. All of it follows from seeds.

use burn::Tensor;
use burn::tensor::{Device, TensorData};

use super::words::PADDING;
use super::{ParityInput, TOKENS, WordTable};
use crate::nets::init::SplitMix64;
use crate::nets::{DESCRIPTION, GRID, Generator, GeneratorConfig, NOISE, NetError};

/// A word table of `words` rows: padding, then `w1`, `w2`, ..., with entries uniform in +-sqrt(3) (variance 1).
pub fn word_table(words: usize, seed: u64) -> WordTable {
    let mut s = SplitMix64::new(seed);
    let mut vectors = vec![0.0; DESCRIPTION];
    vectors.extend(uniform(&mut s, words.saturating_sub(1) * DESCRIPTION));
    let tokens = (0..words).map(|i| if i == 0 { PADDING.into() } else { format!("w{i}") }).collect();
    WordTable { tokens, vectors }
}

/// A generator on the autodiff device whose running statistics have followed `batches` random batches of 8, so that
/// its normalisation does something.
///
/// # Errors
/// [`NetError::Width`].
pub fn seasoned_generator(width: usize, seed: u64, batches: usize) -> Result<Generator, NetError> {
    let device = Device::flex().autodiff();
    let generator = GeneratorConfig { width, ..GeneratorConfig::default() }.init(seed, &device)?;
    let mut s = SplitMix64::new(!seed);
    for _ in 0..batches {
        let tensor = |values: Vec<f32>, columns| Tensor::<2>::from_data(TensorData::new(values, [8, columns]), &device);
        let description = tensor(uniform(&mut s, 8 * DESCRIPTION), DESCRIPTION);
        let noise = tensor(uniform(&mut s, 8 * NOISE), NOISE);
        let pins: Vec<f32> = (0..8).flat_map(|_| pin_distance(&mut s)).collect();
        let pins = tensor(pins, GRID * GRID).reshape([8, 1, GRID, GRID]);
        generator.forward(description, noise, pins);
    }
    Ok(generator)
}

/// Inputs for a batch over a table of `words` rows: 1 to 16 words each, noise of variance 1, the distance to one pin.
pub fn input(batch: usize, words: usize, seed: u64) -> ParityInput {
    let mut s = SplitMix64::new(seed);
    let mut input = ParityInput { tokens: vec![], weights: vec![], noise: vec![], pin_distance: vec![] };
    for _ in 0..batch {
        let known = 1 + (s.next_u64() % TOKENS as u64) as usize;
        for i in 0..TOKENS {
            let token = 1 + (s.next_u64() % (words.max(2) - 1) as u64) as i64;
            input.tokens.push(if i < known { token } else { 0 });
            input.weights.push(if i < known { 1.0 / known as f32 } else { 0.0 });
        }
        input.noise.extend(uniform(&mut s, NOISE));
        input.pin_distance.extend(pin_distance(&mut s));
    }
    input
}

/// Variance 1.
fn uniform(s: &mut SplitMix64, n: usize) -> Vec<f32> {
    (0..n).map(|_| s.uniform() * 3.0f32.sqrt()).collect()
}

/// The map of the distance to one particle of the unit square, clipped to 1.
fn pin_distance(s: &mut SplitMix64) -> Vec<f32> {
    let side = (GRID - 1) as f32;
    let mut at = || (s.next_u64() % GRID as u64) as f32 / side;
    let (row, column) = (at(), at());
    (0..GRID * GRID)
        .map(|i| {
            let (dy, dx) = ((i / GRID) as f32 / side - row, (i % GRID) as f32 / side - column);
            (dy * dy + dx * dx).sqrt().min(1.0)
        })
        .collect()
}
