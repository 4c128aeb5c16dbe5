//! One fall: how long, how far off, how costly.

use std::time::Duration;

use cpu_time::ThreadTime;
use serde::{Deserialize, Serialize};
use taut::field::FieldView;
use taut::{Cloth, Error, StepFlags, Width};

use super::setting::{RATE_HZ, Setting};
use crate::block::Block;
use crate::metrics::percentile;

/// Simulated time in s. What is asked of the sheet at rest is asked of the last second.
pub const SECONDS: u32 = 5;

const FRAMES: usize = (SECONDS * RATE_HZ as u32) as usize;
const LAST_SECOND: usize = FRAMES - RATE_HZ as usize;

/// How the sheet fell, in every width the same.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Quality {
    /// Mean stretch of the structural springs in the last second; a compressed spring counts as 0, so that no fold pays for
    /// a stretch.
    pub mean_pct: f64,
    /// 99th percentile of the stretch, mean over the last second.
    pub p99_pct: f64,
    /// Largest stretch of any frame.
    pub peak_pct: f64,
    /// Root mean square error of the centre of mass over the whole fall, against the finely stepped run.
    pub com_error_mm: f64,
}

/// What a fall shows.
#[derive(Clone, Debug, PartialEq)]
pub struct Fall {
    /// How it fell; None where it blew up.
    pub quality: Option<Quality>,
    /// Thread CPU time of each frame's step.
    pub frames: Vec<Duration>,
    /// Centre of mass after each frame in m.
    pub com_m: Vec<[f64; 3]>,
    /// Hash of the state at the end.
    pub hash: u64,
}

impl Fall {
    /// ms of CPU per simulated second.
    pub fn ms_per_s(&self) -> f64 {
        self.frames.iter().sum::<Duration>().as_secs_f64() * 1e3 / (self.frames.len() as f64 / f64::from(RATE_HZ))
    }

    /// Keeps the shorter time of each frame: other programs only make one longer.
    pub fn keep_least(&mut self, other: &Fall) {
        for (a, b) in self.frames.iter_mut().zip(&other.frames) {
            *a = (*a).min(*b);
        }
    }
}

/// Lets a sheet of N x N fall. `com_m` is the centre of mass after each frame of the finely stepped run; empty: none.
pub fn fall(side: u32, setting: &Setting, width: Width, com_m: &[[f64; 3]]) -> Result<Fall, Error> {
    let (grid, def) = (Setting::grid(side)?, setting.def());
    let numbers = Cloth::memory(&grid, &def)?;
    let mut block = Block::new(numbers);
    let mut cloth = Cloth::create(&grid, &def, block.numbers_mut())?;
    cloth.set_width(width)?;
    let n = side as usize;
    let field = Setting::field(side);
    cloth.set_stiffness_field(&FieldView::new(4, n, n, &field)?);
    cloth.pin(0)?;
    cloth.pin(n - 1)?;
    let mut fall =
        Fall { quality: None, frames: Vec::with_capacity(FRAMES), com_m: Vec::with_capacity(FRAMES), hash: 0 };
    let (mut means, mut p99s, mut peak) = (0.0, 0.0, 0.0f64);
    for frame in 0..FRAMES {
        let clock = ThreadTime::now();
        let flags = cloth.step()?;
        fall.frames.push(clock.elapsed());
        if flags.contains(StepFlags::NON_FINITE) {
            return Ok(fall);
        }
        fall.com_m.push(centre(&cloth)?);
        if frame < LAST_SECOND {
            peak = peak.max(100.0 * f64::from(cloth.strain().largest));
            continue;
        }
        let mut strains = Vec::with_capacity(2 * n * n);
        cloth.each_structural_strain(|_, _, e| strains.push(100.0 * f64::from(e)));
        strains.sort_by(f64::total_cmp);
        let share = 1.0 / (FRAMES - LAST_SECOND) as f64;
        means += share * strains.iter().map(|e| e.max(0.0)).sum::<f64>() / strains.len() as f64;
        p99s += share * percentile(&strains, 0.99);
        peak = peak.max(strains[strains.len() - 1]);
    }
    let squared = |(a, b): (&[f64; 3], &[f64; 3])| a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>();
    let sum: f64 = fall.com_m.iter().zip(com_m).map(squared).sum();
    let com_error_mm = 1e3 * (sum / com_m.len().max(1) as f64).sqrt();
    fall.hash = cloth.state_hash();
    fall.quality = Some(Quality { mean_pct: means, p99_pct: p99s, peak_pct: peak, com_error_mm });
    Ok(fall)
}

/// Middle of the particles, which all have the same mass.
fn centre(cloth: &Cloth<'_>) -> Result<[f64; 3], Error> {
    let n = cloth.grid().particles();
    let mut sum = [0.0; 3];
    for i in 0..n {
        let p = cloth.position(i)?;
        for (sum, x) in sum.iter_mut().zip(p.iter()) {
            *sum += f64::from(*x) / n as f64;
        }
    }
    Ok(sum)
}
