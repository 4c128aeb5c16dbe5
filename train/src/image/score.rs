//! How like two pictures are: the scores of the paper's section VI.C.
//!
//! All three compare intensities `(value + 1) / 2` in `[0, 1]`, so that the background is black and carries no energy.
//! Slices hold one or more channels; PSNR and NMSE take them together, SSIM is the mean of its channels.

use super::{ImageError, expect_len};

/// Side of the Gaussian window of SSIM, pixels.
const WINDOW: usize = 11;
/// Its standard deviation, pixels.
const WINDOW_SIGMA: f64 = 1.5;
/// Stabilisers of SSIM for intensities in `[0, 1]`: (K1 L)^2 and (K2 L)^2, K1 = 0.01, K2 = 0.03, L = 1.
const C1: f64 = 0.01 * 0.01;
const C2: f64 = 0.03 * 0.03;

fn intensity(value: f32) -> f64 {
    0.5 * (f64::from(value) + 1.0)
}

fn check(reference: &[f32], image: &[f32]) -> Result<(), ImageError> {
    expect_len("picture", reference.len().max(1), image.len())?;
    for (name, values) in [("reference", reference), ("picture", image)] {
        if let Some(index) = values.iter().position(|x| !x.is_finite()) {
            return Err(ImageError::NotFinite { name, index });
        }
    }
    Ok(())
}

fn squared_error(reference: &[f32], image: &[f32]) -> f64 {
    reference.iter().zip(image).map(|(a, b)| (intensity(*a) - intensity(*b)).powi(2)).sum()
}

/// Peak signal-to-noise ratio, dB: `10 log10(1 / mean squared error)`; infinite for equal pictures.
///
/// # Errors
/// [`ImageError::Size`] when the sizes differ or are 0, [`ImageError::NotFinite`].
pub fn psnr(reference: &[f32], image: &[f32]) -> Result<f64, ImageError> {
    check(reference, image)?;
    Ok(-10.0 * (squared_error(reference, image) / reference.len() as f64).log10())
}

/// Normalised mean square error: squared error over the squared intensity of the reference; 0 for equal pictures.
///
/// # Errors
/// As [`psnr`], and [`ImageError::BlackReference`].
pub fn nmse(reference: &[f32], image: &[f32]) -> Result<f64, ImageError> {
    check(reference, image)?;
    let energy: f64 = reference.iter().map(|a| intensity(*a).powi(2)).sum();
    if energy > 0.0 { Ok(squared_error(reference, image) / energy) } else { Err(ImageError::BlackReference) }
}

/// Structural similarity, at most 1 (Wang, Bovik, Sheikh and Simoncelli, IEEE TIP 13(4), 2004): Gaussian window of
/// 11 x 11 pixels and 1.5 pixels of standard deviation, K1 = 0.01, K2 = 0.03, mean over the windows that fit.
/// `rows` and `columns` are those of a channel, 11 or more.
///
/// # Errors
/// As [`psnr`]; [`ImageError::Setting`] for channels that are too small.
pub fn ssim(reference: &[f32], image: &[f32], rows: usize, columns: usize) -> Result<f64, ImageError> {
    check(reference, image)?;
    for (name, n) in [("rows", rows), ("columns", columns)] {
        if !(WINDOW..=1 << 15).contains(&n) {
            return Err(ImageError::Setting { name, allowed: "11 to 32768" });
        }
    }
    let pixels = rows * columns;
    let planes = reference.len().div_ceil(pixels);
    expect_len("picture", planes * pixels, reference.len())?;
    let weights = window();
    let mut sum = 0.0;
    for (a, b) in reference.chunks_exact(pixels).zip(image.chunks_exact(pixels)) {
        let moment = |f: &dyn Fn(f64, f64) -> f64| {
            let products: Vec<f64> = a.iter().zip(b).map(|(a, b)| f(intensity(*a), intensity(*b))).collect();
            blur(&products, columns, &weights)
        };
        let mean_a = moment(&|a, _| a);
        let mean_b = moment(&|_, b| b);
        let square_a = moment(&|a, _| a * a);
        let square_b = moment(&|_, b| b * b);
        let product = moment(&|a, b| a * b);
        let mut plane = 0.0;
        for i in 0..mean_a.len() {
            let (ma, mb) = (mean_a[i], mean_b[i]);
            let (va, vb, cov) = (square_a[i] - ma * ma, square_b[i] - mb * mb, product[i] - ma * mb);
            plane += (2.0 * ma * mb + C1) * (2.0 * cov + C2) / ((ma * ma + mb * mb + C1) * (va + vb + C2));
        }
        sum += plane / mean_a.len() as f64;
    }
    Ok(sum / planes as f64)
}

/// The weights of the window along one axis; they sum to 1.
fn window() -> [f64; WINDOW] {
    let middle = (WINDOW / 2) as f64;
    let raw: [f64; WINDOW] = std::array::from_fn(|i| (-0.5 * ((i as f64 - middle) / WINDOW_SIGMA).powi(2)).exp());
    let sum: f64 = raw.iter().sum();
    raw.map(|w| w / sum)
}

/// The plane under the window at every place where it fits.
fn blur(plane: &[f64], columns: usize, weights: &[f64; WINDOW]) -> Vec<f64> {
    let rows: Vec<Vec<f64>> = plane
        .chunks_exact(columns)
        .map(|row| row.windows(WINDOW).map(|w| w.iter().zip(weights).map(|(x, w)| x * w).sum()).collect())
        .collect();
    rows.windows(WINDOW)
        .flat_map(|rows| {
            (0..columns + 1 - WINDOW).map(move |c| rows.iter().zip(weights).map(|(row, w)| row[c] * w).sum::<f64>())
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn psnr_of_a_known_error() {
        // values differ by 0.2, intensities by 0.1: mean squared error 0.01, 20 dB
        let (a, b) = (vec![0.1f32; 50], vec![0.3f32; 50]);
        assert!((psnr(&a, &b).unwrap() - 20.0).abs() < 1e-5);
        // one of four differs by the whole range: mean squared error 1/4, 6.0206 dB
        let found = psnr(&[-1.0, 1.0, 0.0, 0.5], &[1.0, 1.0, 0.0, 0.5]).unwrap();
        assert!((found - 6.020_599_913).abs() < 1e-6);
        assert_eq!(psnr(&a, &a).unwrap(), f64::INFINITY);
    }

    #[test]
    fn nmse_of_a_known_error() {
        // intensities 1, 0.5, 0 against 1, 0.25, 0: 0.0625 / 1.25 = 0.05
        assert!((nmse(&[1.0, 0.0, -1.0], &[1.0, -0.5, -1.0]).unwrap() - 0.05).abs() < 1e-12);
        assert_eq!(nmse(&[0.5; 9], &[0.5; 9]).unwrap(), 0.0);
        assert_eq!(nmse(&[-1.0; 9], &[0.5; 9]), Err(ImageError::BlackReference));
    }

    #[test]
    fn ssim_of_flat_pictures_is_the_luminance_term() {
        // intensities 0.5 and 0.75: (2 * 0.375 + 1e-4) / (0.25 + 0.5625 + 1e-4) = 0.7501 / 0.8126 = 0.923086...
        let (a, b) = (vec![0.0f32; 400], vec![0.5f32; 400]);
        assert!((ssim(&a, &b, 20, 20).unwrap() - 0.7501 / 0.8126).abs() < 1e-9);
        assert!((ssim(&a, &a, 20, 20).unwrap() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn ssim_of_one_window_is_that_of_the_formula() {
        // one 11 x 11 window: sums over it, not separated, in the plainest way
        let wave = |i: usize| 0.5 * ((i / 11) as f32 * 0.9).sin() + 0.3 * ((i % 11) as f32 * 0.7).cos();
        let a: Vec<f32> = (0..121).map(wave).collect();
        let b: Vec<f32> = a.iter().map(|x| 0.5 * x - 0.1).collect();
        let mut norm = 0.0;
        let (mut ma, mut mb) = (0.0, 0.0);
        let weight = |i: usize| {
            let (r, c) = ((i / 11) as f64 - 5.0, (i % 11) as f64 - 5.0);
            (-(r * r + c * c) / 4.5).exp()
        };
        for i in 0..121 {
            norm += weight(i);
            ma += weight(i) * intensity(a[i]);
            mb += weight(i) * intensity(b[i]);
        }
        (ma, mb) = (ma / norm, mb / norm);
        let (mut va, mut vb, mut cov) = (0.0, 0.0, 0.0);
        for i in 0..121 {
            let (da, db) = (intensity(a[i]) - ma, intensity(b[i]) - mb);
            va += weight(i) / norm * da * da;
            vb += weight(i) / norm * db * db;
            cov += weight(i) / norm * da * db;
        }
        let luminance = (2.0 * ma * mb + 0.0001) / (ma * ma + mb * mb + 0.0001);
        let structure = (2.0 * cov + 0.0009) / (va + vb + 0.0009);
        let found = ssim(&a, &b, 11, 11).unwrap();
        assert!((found - luminance * structure).abs() < 1e-9, "{found} {}", luminance * structure);
        // structure: vb = va / 4 and cov = va / 2, so that the term is about 2 * 0.5 / 1.25 = 0.8
        assert!((structure - 0.8).abs() < 0.02);
    }

    #[test]
    fn inverted_structure_scores_below_zero() {
        let a: Vec<f32> = (0..256).map(|i| if (i / 16 + i % 16) % 2 == 0 { 0.5 } else { -0.5 }).collect();
        let b: Vec<f32> = a.iter().map(|x| -x).collect();
        assert!(ssim(&a, &b, 16, 16).unwrap() < -0.9);
    }

    #[test]
    fn channels_are_averaged_and_bad_sizes_named() {
        let flat = |v: f32| vec![v; 121];
        let two = |a: f32, b: f32| [flat(a), flat(b)].concat();
        let both = ssim(&two(0.0, 0.2), &two(0.5, 0.2), 11, 11).unwrap();
        assert!((both - 0.5 * (1.0 + 0.7501 / 0.8126)).abs() < 1e-9);
        assert!(matches!(ssim(&flat(0.0), &flat(0.0), 10, 12), Err(ImageError::Setting { name: "rows", .. })));
        assert!(matches!(psnr(&[0.0; 3], &[0.0; 4]), Err(ImageError::Size { expected: 3, found: 4, .. })));
        assert!(matches!(psnr(&[], &[]), Err(ImageError::Size { .. })));
        assert!(matches!(psnr(&[0.0; 2], &[0.0, f32::NAN]), Err(ImageError::NotFinite { index: 1, .. })));
    }
}
