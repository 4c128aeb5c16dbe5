//! The two inner loops of the skip-gram, over 16 lanes so that they vectorise and always add in the same order.

/// Numbers that are worked on side by side; vector lengths are multiples of it.
pub(super) const LANES: usize = 16;

/// The dot product of two vectors of one length, a multiple of [`LANES`] (a rest would be left out).
pub(super) fn dot(a: &[f32], b: &[f32]) -> f32 {
    let mut sums = [0.0f32; LANES];
    for (x, y) in a.as_chunks::<LANES>().0.iter().zip(b.as_chunks::<LANES>().0) {
        for lane in 0..LANES {
            sums[lane] += x[lane] * y[lane];
        }
    }
    let mut width = LANES / 2;
    while width > 0 {
        for lane in 0..width {
            sums[lane] += sums[lane + width];
        }
        width /= 2;
    }
    sums[0]
}

/// `gradient += scale * output` and then `output += scale * input`: one target of one pair, both ways at once.
pub(super) fn exchange(scale: f32, input: &[f32], output: &mut [f32], gradient: &mut [f32]) {
    let chunks = input.as_chunks::<LANES>().0.iter();
    let chunks = chunks.zip(output.as_chunks_mut::<LANES>().0).zip(gradient.as_chunks_mut::<LANES>().0);
    for ((x, y), g) in chunks {
        for lane in 0..LANES {
            g[lane] += scale * y[lane];
            y[lane] += scale * x[lane];
        }
    }
}

/// `to += from`.
pub(super) fn add(to: &mut [f32], from: &[f32]) {
    for (x, y) in to.iter_mut().zip(from) {
        *x += y;
    }
}

/// Scales a vector to length 1; a zero vector stays as it is.
pub(super) fn normalise(vector: &mut [f32]) {
    let length = vector.iter().map(|x| f64::from(*x) * f64::from(*x)).sum::<f64>().sqrt();
    if length > 0.0 {
        for x in vector {
            *x = (f64::from(*x) / length) as f32;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn loops_agree_with_plain_sums() {
        let a: Vec<f32> = (0..64).map(|i| (i as f32 * 0.37).sin()).collect();
        let b: Vec<f32> = (0..64).map(|i| (i as f32 * 0.91).cos()).collect();
        let plain: f32 = a.iter().zip(&b).map(|(x, y)| x * y).sum();
        assert!((dot(&a, &b) - plain).abs() < 1e-5);
        let mut output = b.clone();
        let mut gradient = vec![1.0; 64];
        exchange(0.5, &a, &mut output, &mut gradient);
        for i in 0..64 {
            assert_eq!(gradient[i], 1.0 + 0.5 * b[i]);
            assert_eq!(output[i], b[i] + 0.5 * a[i]);
        }
        normalise(&mut output);
        assert!((dot(&output, &output) - 1.0).abs() < 1e-5);
    }
}
