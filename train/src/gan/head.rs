//! First weights of what is linear in the words: the numbers of the fabric, the levels of the field.
//!
//! Their best weights can be computed: ridge regression on what
//! the sampled descriptions mean. Descent alone would not get there in the steps of a run, since the vectors of words
//! that stand together are much alike.

use burn::module::Param;
use burn::nn::Linear;
use burn::tensor::{Device, TensorData};
use faer::Mat;
use faer::linalg::solvers::Solve;

use super::{Dataset, TrainError};
use crate::nets::{CHANNELS, FABRIC, HEAD_INPUT};

/// Descriptions of the regression: every name with every modifier comes several times.
const SAMPLES: usize = 4096;
/// Weight of the squares of the head's weights against the sum of the squared errors. Ten times less fits the samples
/// better by a third, but then words that stand in no sample say too much.
const RIDGE: f64 = 0.02;

/// A linear layer over what a head hears of a description: weights [inputs][outputs] and biases.
pub(super) struct Head {
    weights: Vec<f32>,
    biases: Vec<f32>,
}

impl Head {
    /// Puts it in the place of a layer's weights.
    pub fn set(&self, layer: &mut Linear, device: &Device) {
        let outputs = self.biases.len();
        let shape = [self.weights.len() / outputs, outputs];
        layer.weight = Param::from_data(TensorData::new(self.weights.clone(), shape), device);
        layer.bias = Some(Param::from_data(TensorData::new(self.biases.clone(), [outputs]), device));
    }
}

/// The heads of the fabric's numbers and of the field's levels, by regression on the first descriptions of the stream.
pub(super) fn fit(data: &Dataset) -> Result<[Head; 2], TrainError> {
    // what tanh makes the number of; the ends of the range are far, so they are cut to what tanh still resolves
    let before_tanh = |t: f64| t.clamp(-0.98, 0.98).atanh();
    let (mut inputs, mut numbers, mut levels) = (Vec::new(), Vec::new(), Vec::new());
    for i in 0..SAMPLES {
        let (fabric, words) = data.streamed(i as u32);
        let sum: Vec<f64> = data.describe(&words).into_iter().map(f64::from).collect();
        let length = sum.iter().map(|x| x * x).sum::<f64>().sqrt().max(1e-9);
        // as `nets::head_input` has it
        inputs.extend(sum.iter().map(|x| x / length));
        inputs.extend(sum);
        numbers.extend(data.numbers(&fabric).map(before_tanh));
        levels.extend(data.levels(&fabric).map(before_tanh));
    }
    let fit = |outputs, n| {
        ridge(inputs.clone(), outputs, [HEAD_INPUT, n], RIDGE).map(|(weights, biases)| Head { weights, biases })
    };
    Ok([fit(numbers, FABRIC)?, fit(levels, CHANNELS)?])
}

/// Minimises the sum of |x W + b - y|^2 and `weight` |W|^2 over rows x of `inputs` and y of `outputs`. W comes row-major.
fn ridge(
    mut inputs: Vec<f64>,
    mut outputs: Vec<f64>,
    [n, m]: [usize; 2],
    weight: f64,
) -> Result<(Vec<f32>, Vec<f32>), TrainError> {
    // about the means there is no bias to solve for
    let (input_means, output_means) = (centre(&mut inputs, n), centre(&mut outputs, m));
    let rows = inputs.len() / n;
    let x = Mat::from_fn(rows, n, |i, j| inputs[i * n + j]);
    let y = Mat::from_fn(rows, m, |i, j| outputs[i * m + j]);
    let mut square = x.transpose() * &x;
    for i in 0..n {
        square[(i, i)] += weight;
    }
    let solver = square.llt(faer::Side::Lower).map_err(|e| TrainError::Part(format!("the fabric head: {e:?}")))?;
    let solution = solver.solve(x.transpose() * &y);
    let weights = (0..n).flat_map(|i| (0..m).map(move |j| (i, j))).map(|at| solution[at] as f32).collect();
    let bias = (0..m).map(|j| output_means[j] - (0..n).map(|i| input_means[i] * solution[(i, j)]).sum::<f64>());
    Ok((weights, bias.map(|b| b as f32).collect()))
}

/// Subtracts from each column its mean; the means.
fn centre(values: &mut [f64], columns: usize) -> Vec<f64> {
    let rows = values.len() / columns;
    let mut means = vec![0.0; columns];
    for row in values.chunks_exact(columns) {
        means.iter_mut().zip(row).for_each(|(m, v)| *m += v / rows as f64);
    }
    for row in values.chunks_exact_mut(columns) {
        row.iter_mut().zip(&means).for_each(|(v, m)| *v -= m);
    }
    means
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regression_finds_a_plane_and_the_ridge_shrinks_it() {
        let inputs: Vec<f64> = (0..40).map(|i| (1.7 * f64::from(i)).sin()).collect();
        let plane = |x: &[f64]| [2.0 * x[0] - x[1] + 0.5, 3.0 * x[1] - 1.0];
        let outputs: Vec<f64> = inputs.chunks_exact(2).flat_map(plane).collect();
        let (w, b) = ridge(inputs.clone(), outputs.clone(), [2, 2], 1e-9).expect("definite");
        for (found, expected) in w.iter().chain(&b).zip([2.0, 0.0, -1.0, 3.0, 0.5, -1.0]) {
            assert!((found - expected).abs() < 1e-6, "{w:?} {b:?}");
        }
        let (small, _) = ridge(inputs, outputs, [2, 2], 1e3).expect("definite");
        assert!(small.iter().map(|x| x * x).sum::<f32>() < 0.01 * w.iter().map(|x| x * x).sum::<f32>());
    }
}
