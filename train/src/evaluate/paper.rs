//! What the paper says, for comparison.

use serde::Serialize;

/// The paper's figures, of its own data.
#[derive(Debug, Serialize)]
pub struct Paper {
    /// Fig. 7: PSNR in dB is above this below 4 % of noise.
    pub psnr_below_4_pct_db: f64,
    /// Fig. 7: and below this above 4 %.
    pub psnr_above_4_pct_db: f64,
    /// Fig. 7: SSIM at 6 %.
    pub ssim_at_6_pct: f64,
    /// Fig. 8: SSIM with one loss.
    pub ssim_with_one_loss: f64,
    /// Fig. 8: what all losses add to the PSNR in dB.
    pub psnr_gain_db: f64,
    /// Fig. 8: and take from the NMSE.
    pub nmse_gain: f64,
}

impl Default for Paper {
    fn default() -> Paper {
        Paper {
            psnr_below_4_pct_db: 33.5,
            psnr_above_4_pct_db: 31.4,
            ssim_at_6_pct: 0.922,
            ssim_with_one_loss: 0.952,
            psnr_gain_db: 2.66,
            nmse_gain: 0.032,
        }
    }
}
