//! Runs the network of the file through burn, on the file's own inputs, for other runtimes to be compared with.

use burn::Tensor;
use burn::tensor::{Device, TensorData};
use serde::{Deserialize, Serialize};

use super::half_precision::round;
use super::{ExportError, TOKENS, WordTable, round_to_f16};
use crate::nets::{DESCRIPTION, GRID, Generator, NOISE, SHARES_EPSILON};

/// Inputs of the generator file for a batch, each flat and row-major.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ParityInput {
    /// [batch, 16] rows of the word table.
    pub tokens: Vec<i64>,
    /// [batch, 16] shares of the words.
    pub weights: Vec<f32>,
    /// [batch, 128].
    pub noise: Vec<f32>,
    /// [batch, 1, 32, 32].
    pub pin_distance: Vec<f32>,
}

/// Inputs and what burn makes of them; as JSON, one flat object of six arrays.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ParitySample {
    /// What goes in.
    #[serde(flatten)]
    pub input: ParityInput,
    /// [batch, 4, 32, 32] in [-1, 1].
    pub field: Vec<f32>,
    /// [batch, 5] in [-1, 1].
    pub fabric: Vec<f32>,
}

impl ParityInput {
    /// The number of samples in the batch.
    ///
    /// # Errors
    /// [`ExportError::Input`] when the arrays are empty or do not belong to one batch size.
    pub fn batch(&self) -> Result<usize, ExportError> {
        let batch = self.tokens.len() / TOKENS;
        let expected = [batch * TOKENS, batch * TOKENS, batch * NOISE, batch * GRID * GRID];
        let found = [self.tokens.len(), self.weights.len(), self.noise.len(), self.pin_distance.len()];
        if batch == 0 || found != expected {
            return Err(ExportError::Input(format!(
                "tokens, weights, noise and pin_distance have {found:?} numbers, a batch of {batch} has {expected:?}"
            )));
        }
        Ok(batch)
    }
}

/// What the exported file should answer: the generator rounded to f16, in inference, on descriptions that are made of
/// the rounded word table.
///
/// # Errors
/// [`ExportError::Input`] for arrays that do not fit or a token outside the table, [`ExportError::Words`] for a bad
/// table.
pub fn run_rounded(generator: &Generator, words: &WordTable, input: &ParityInput) -> Result<ParitySample, ExportError> {
    super::words::check_words(words)?;
    let batch = input.batch()?;
    let mut descriptions = vec![0.0f32; batch * DESCRIPTION];
    for ((tokens, weights), sum) in input
        .tokens
        .chunks_exact(TOKENS)
        .zip(input.weights.chunks_exact(TOKENS))
        .zip(descriptions.chunks_exact_mut(DESCRIPTION))
    {
        for (token, weight) in tokens.iter().zip(weights) {
            let row = usize::try_from(*token).ok().filter(|t| *t < words.tokens.len()).ok_or_else(|| {
                ExportError::Input(format!("token {token} is not a row of a table of {}", words.tokens.len()))
            })?;
            for (s, x) in sum.iter_mut().zip(round(&words.vectors[row * DESCRIPTION..(row + 1) * DESCRIPTION])) {
                *s += weight * x;
            }
        }
        let share = weights.iter().map(|w| w * w).sum::<f32>() + SHARES_EPSILON;
        sum.iter_mut().for_each(|s| *s /= share);
    }
    let rounded = round_to_f16(generator);
    let device = Device::flex();
    let tensor =
        |values: Vec<f32>, columns: usize| Tensor::<2>::from_data(TensorData::new(values, [batch, columns]), &device);
    let pins = tensor(input.pin_distance.clone(), GRID * GRID).reshape([batch, 1, GRID, GRID]);
    let out = rounded.forward(tensor(descriptions, DESCRIPTION), tensor(input.noise.clone(), NOISE), pins);
    let read = |data: TensorData, name: &str| {
        data.try_into_vec::<f32>().map_err(|_| ExportError::Tensor { tensor: name.into() })
    };
    Ok(ParitySample {
        input: input.clone(),
        field: read(out.field.into_data(), "field")?,
        fabric: read(out.fabric.into_data(), "fabric")?,
    })
}
