//! The miniature computed by plain loops.

use crate::miniature::{CHANNELS, NOISE, WIDTH, WORDS, Weights};

/// tanh values of `field` [4][32][32] and `fabric` [5] for words (by name), noise and pin distances.
pub fn run(w: &Weights, words: &[&str], noise: &[f32], pins: &[f32]) -> (Vec<f32>, Vec<f32>) {
    let mut text = [0.0f64; WIDTH];
    for word in words {
        let row = 1 + WORDS.iter().position(|w| w == word).unwrap();
        for (t, x) in text.iter_mut().zip(&w.words[row * WIDTH..][..WIDTH]) {
            *t += f64::from(*x) / words.len() as f64;
        }
    }
    let column = |k: usize| (0..WIDTH).map(|i| text[i] * f64::from(w.head[i * 5 + k])).sum::<f64>();
    let fabric = (0..5).map(|k| column(k).tanh() as f32).collect();

    let z: Vec<f64> = text.iter().copied().chain(noise.iter().map(|&x| f64::from(x))).collect();
    assert_eq!(z.len(), WIDTH + NOISE);
    let x4 = transposed(&z, 1, &w.first, CHANNELS, 5, 2, 4);
    let [scale, bias, mean, variance] = &w.normal;
    let y4 = |c: usize, at: usize| {
        let deviation = (f64::from(variance[c]) + 1e-5).sqrt();
        let x = (x4[c * 16 + at] - f64::from(mean[c])) / deviation;
        (x * f64::from(scale[c]) + f64::from(bias[c])).max(0.0)
    };
    let mut y32: Vec<f64> = Vec::new();
    for c in 0..CHANNELS {
        y32.extend((0..1024).map(|at| y4(c, at / 256 * 4 + at % 32 / 8)));
    }
    y32.extend(pins.iter().map(|&d| f64::from(d)));
    let t = transposed(&y32, 32, &w.last, 4, 3, 1, 32);
    let field = (0..4096).map(|i| (t[i] + f64::from(w.bias[i / 1024])).tanh() as f32).collect();
    (field, fabric)
}

/// Transposed convolution with a padding of 1: each number of the source is spread by the kernel.
/// `x` [channels][side][side], `w` [channels][outputs][k][k] -> [outputs][out][out].
fn transposed(x: &[f64], side: usize, w: &[f32], outputs: usize, k: usize, stride: usize, out: usize) -> Vec<f64> {
    let mut y = vec![0.0; outputs * out * out];
    for c in 0..x.len() / (side * side) {
        for (i, j) in (0..side * side).map(|at| (at / side, at % side)) {
            for o in 0..outputs {
                for (a, b) in (0..k * k).map(|at| (at / k, at % k)) {
                    let (r, s) = ((i * stride + a).wrapping_sub(1), (j * stride + b).wrapping_sub(1));
                    if r < out && s < out {
                        let weight = f64::from(w[((c * outputs + o) * k + a) * k + b]);
                        y[(o * out + r) * out + s] += x[(c * side + i) * side + j] * weight;
                    }
                }
            }
        }
    }
    y
}
