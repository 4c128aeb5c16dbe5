//! The description vector, the sum of the word vectors, and what the networks make of it: field and pictures take it
//! scaled to one length, whatever the number of words; the numbers of the fabric take the sum, since there each word
//! is a factor (of the density and so on) and their logarithms add up.

use burn::Tensor;

use super::DESCRIPTION;

/// Added to the mean square of a description in front of the root, so that no words give zero and not 0/0. A word vector
/// has length 1, so a mean square of 1/1024, of which this is 1e-5.
pub const DESCRIPTION_EPSILON: f32 = 1e-8;

/// Added to the sum of the squares of the words' shares, which is 1/n for n words: mean / sum is the sum of the vectors,
/// and no words give zero and not 0/0. It is below the last digit of 1/16.
pub const SHARES_EPSILON: f32 = 1e-9;

/// Scales descriptions [batch, 1024] so that their numbers have the mean square 1, as the noise beside them has (the length
/// is 32); zero stays zero. Otherwise the length would tell how many words there were, louder than what they say.
pub fn normalise(description: Tensor<2>) -> Tensor<2> {
    let mean_square = description.clone().square().sum_dim(1) / DESCRIPTION as f32;
    description / (mean_square + DESCRIPTION_EPSILON).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use burn::tensor::{Device, TensorData};

    #[test]
    fn length_does_not_count_and_zero_stays_zero() {
        let one: Vec<f32> = (0..DESCRIPTION).map(|i| ((i as f32 * 0.7).sin() + 0.1) / 32.0).collect();
        let half = one.iter().map(|x| 0.5 * x);
        let all: Vec<f32> = one.iter().copied().chain(half).chain([0.0; DESCRIPTION]).collect();
        let all =
            Tensor::<2>::from_data(TensorData::new(all, [3, DESCRIPTION]), &Device::flex().autodiff()).require_grad();
        let out = normalise(all.clone());
        let gradient = all.grad(&out.clone().sum().backward()).expect("a gradient");
        let out: Vec<f32> = out.into_data().try_into_vec().expect("f32");
        let (first, rest) = out.split_at(DESCRIPTION);
        let (second, zero) = rest.split_at(DESCRIPTION);
        let mean_square = |x: &[f32]| x.iter().map(|x| x * x).sum::<f32>() / DESCRIPTION as f32;
        // 1 but for what is added in front of the root
        let expected = mean_square(&one) / (mean_square(&one) + DESCRIPTION_EPSILON);
        assert!((mean_square(first) - expected).abs() < 1e-5, "{} of {expected}", mean_square(first));
        assert!(first.iter().zip(second).all(|(a, b)| (a - b).abs() < 1e-4));
        assert!(zero.iter().all(|x| *x == 0.0));
        assert!(gradient.into_data().try_into_vec::<f32>().expect("f32").iter().all(|g| g.is_finite()));
    }
}
