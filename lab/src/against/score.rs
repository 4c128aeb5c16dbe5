//! How like two pictures are (the paper's section VI.C). Numbers are intensities: 0 is black, 1 is white.

/// Side of the Gaussian window of SSIM in pixels, and its standard deviation.
const WINDOW: usize = 11;
const SIGMA: f64 = 1.5;
/// (K1 L)^2 and (K2 L)^2 with K1 = 0.01, K2 = 0.03 and the range L = 1.
const C1: f64 = 0.01 * 0.01;
const C2: f64 = 0.03 * 0.03;

fn squared_error(reference: &[f64], image: &[f64]) -> f64 {
    reference.iter().zip(image).map(|(a, b)| (a - b).powi(2)).sum()
}

/// Peak signal-to-noise ratio in dB, 10 log10(1 / mean squared error). Infinite for equal pictures.
pub fn psnr(reference: &[f64], image: &[f64]) -> f64 {
    -10.0 * (squared_error(reference, image) / reference.len() as f64).log10()
}

/// Squared error over the squared intensity of the reference. NaN where that is black.
pub fn nmse(reference: &[f64], image: &[f64]) -> f64 {
    let energy: f64 = reference.iter().map(|a| a * a).sum();
    if energy > 0.0 { squared_error(reference, image) / energy } else { f64::NAN }
}

/// Structural similarity, at most 1 (Wang, Bovik, Sheikh, Simoncelli 2004): the mean over all windows that fit. The
/// pictures have `columns` columns; both sides are at least 11 pixels.
pub fn ssim(reference: &[f64], image: &[f64], columns: usize) -> f64 {
    let weights: [f64; WINDOW] =
        std::array::from_fn(|i| (-0.5 * ((i as f64 - (WINDOW / 2) as f64) / SIGMA).powi(2)).exp());
    let all: f64 = weights.iter().sum();
    let weights = weights.map(|w| w / all);
    let moment = |f: fn(f64, f64) -> f64| {
        let products: Vec<f64> = reference.iter().zip(image).map(|(a, b)| f(*a, *b)).collect();
        blur(&products, columns, &weights)
    };
    let (mean_a, mean_b) = (moment(|a, _| a), moment(|_, b| b));
    let (square_a, square_b, product) = (moment(|a, _| a * a), moment(|_, b| b * b), moment(|a, b| a * b));
    let windows = mean_a.len();
    let at = |i: usize| {
        let (a, b) = (mean_a[i], mean_b[i]);
        let (var_a, var_b, covariance) = (square_a[i] - a * a, square_b[i] - b * b, product[i] - a * b);
        (2.0 * a * b + C1) * (2.0 * covariance + C2) / ((a * a + b * b + C1) * (var_a + var_b + C2))
    };
    (0..windows).map(at).sum::<f64>() / windows as f64
}

/// A picture under the window at every place where that fits.
fn blur(plane: &[f64], columns: usize, weights: &[f64; WINDOW]) -> Vec<f64> {
    let sum = |values: &mut dyn Iterator<Item = f64>| values.zip(weights).map(|(x, w)| x * w).sum::<f64>();
    let rows: Vec<Vec<f64>> = plane
        .chunks_exact(columns)
        .map(|row| row.windows(WINDOW).map(|w| sum(&mut w.iter().copied())).collect())
        .collect();
    let places = columns + 1 - WINDOW;
    rows.windows(WINDOW).flat_map(|rows| (0..places).map(move |c| sum(&mut rows.iter().map(|row| row[c])))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_that_are_known() {
        assert!((psnr(&[0.55; 50], &[0.65; 50]) - 20.0).abs() < 1e-9);
        assert_eq!(psnr(&[0.5; 4], &[0.5; 4]), f64::INFINITY);
        assert!((nmse(&[1.0, 0.5, 0.0], &[1.0, 0.25, 0.0]) - 0.05).abs() < 1e-12);
        assert!(nmse(&[0.0; 3], &[1.0; 3]).is_nan());
    }

    #[test]
    fn ssim_of_one_window_is_that_of_the_formula() {
        let a: Vec<f64> = (0..121).map(|i| 0.5 + 0.3 * f64::from(i / 11).sin() * f64::from(i % 11).cos()).collect();
        let b: Vec<f64> = a.iter().map(|x| 0.5 * x + 0.1).collect();
        let weight = |i: usize| (-(((i / 11) as f64 - 5.0).powi(2) + ((i % 11) as f64 - 5.0).powi(2)) / 4.5).exp();
        let norm: f64 = (0..121).map(weight).sum();
        let mean = |x: &[f64]| x.iter().enumerate().map(|(i, x)| weight(i) * x).sum::<f64>() / norm;
        let spread = |x: &[f64], y: &[f64]| {
            let (mx, my) = (mean(x), mean(y));
            mean(&x.iter().zip(y).map(|(x, y)| (x - mx) * (y - my)).collect::<Vec<f64>>())
        };
        let (ma, mb) = (mean(&a), mean(&b));
        let luminance = (2.0 * ma * mb + 0.0001) / (ma * ma + mb * mb + 0.0001);
        let structure = (2.0 * spread(&a, &b) + 0.0009) / (spread(&a, &a) + spread(&b, &b) + 0.0009);
        assert!((ssim(&a, &b, 11) - luminance * structure).abs() < 1e-9);
        assert!((ssim(&a, &a, 11) - 1.0).abs() < 1e-12);
        assert!((ssim(&[0.5; 400], &[0.75; 400], 20) - 0.7501 / 0.8126).abs() < 1e-9);
    }
}
