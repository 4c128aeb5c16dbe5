//! Scores of pictures, and what many numbers are together.

use serde::{Deserialize, Serialize};

use crate::image::{SIDE, nmse, psnr, ssim};

use super::EvaluateError;

/// The three scores of the paper's section VI.C.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Scores {
    /// Peak signal-to-noise ratio in dB.
    pub psnr_db: f64,
    /// Structural similarity.
    pub ssim: f64,
    /// Normalised mean square error.
    pub nmse: f64,
}

impl Scores {
    /// Of a picture against the clean reference.
    pub fn of(reference: &[f32], picture: &[f32]) -> Result<Scores, EvaluateError> {
        let part = EvaluateError::part;
        Ok(Scores {
            psnr_db: psnr(reference, picture).map_err(part)?,
            ssim: ssim(reference, picture, SIDE, SIDE).map_err(part)?,
            nmse: nmse(reference, picture).map_err(part)?,
        })
    }
}

/// Mean and standard deviation of some numbers.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Spread {
    /// Mean.
    pub mean: f64,
    /// Standard deviation of a sample (n - 1); 0 of one number.
    pub deviation: f64,
}

impl Spread {
    /// Of some numbers; not a number for none.
    pub fn of(values: impl IntoIterator<Item = f64>) -> Spread {
        let values: Vec<f64> = values.into_iter().collect();
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let squares = values.iter().map(|x| (x - mean).powi(2)).sum::<f64>();
        Spread { mean, deviation: (squares / (n - 1.0).max(1.0)).sqrt() }
    }
}

/// Scores of a set of pictures.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SetScores {
    /// Peak signal-to-noise ratio in dB.
    pub psnr_db: Spread,
    /// Structural similarity.
    pub ssim: Spread,
    /// Normalised mean square error.
    pub nmse: Spread,
}

impl SetScores {
    /// Of the scores of each.
    pub fn of(scores: &[Scores]) -> SetScores {
        let spread = |f: fn(&Scores) -> f64| Spread::of(scores.iter().map(f));
        SetScores { psnr_db: spread(|s| s.psnr_db), ssim: spread(|s| s.ssim), nmse: spread(|s| s.nmse) }
    }

    /// The means alone.
    pub fn mean(&self) -> Scores {
        Scores { psnr_db: self.psnr_db.mean, ssim: self.ssim.mean, nmse: self.nmse.mean }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spreads_are_those_of_the_textbook() {
        // 2, 4, 9: mean 5, squares 9 + 1 + 16 over 2
        let s = Spread::of([2.0, 4.0, 9.0]);
        assert_eq!((s.mean, s.deviation), (5.0, 13f64.sqrt()));
        assert_eq!(Spread::of([3.0]), Spread { mean: 3.0, deviation: 0.0 });
        assert!(Spread::of([]).mean.is_nan());
    }

    #[test]
    fn scores_of_a_set_are_those_of_its_pictures() {
        // intensities 0.5 against 0.5 and 0.75
        let (a, b) = (vec![0.0f32; 2 * SIDE * SIDE], vec![0.5f32; 2 * SIDE * SIDE]);
        let [same, other] = [&a, &b].map(|p| Scores::of(&a, p).unwrap());
        assert_eq!((same.nmse, same.psnr_db), (0.0, f64::INFINITY));
        assert!((other.nmse - 0.25).abs() < 1e-9 && (other.psnr_db - 20.0 * 4f64.log10()).abs() < 1e-6);
        let set = SetScores::of(&[other, Scores { nmse: 0.75, ..other }]);
        assert!((set.nmse.mean - 0.5).abs() < 1e-9 && (set.nmse.deviation - 0.125f64.sqrt()).abs() < 1e-9);
        assert_eq!(set.mean().ssim, other.ssim);
        assert!(Scores::of(&a, &b[1..]).is_err());
    }
}
