//! A level sheet that falls on two pinned corners: `taut measure fall` has the same.

use cpu_time::ThreadTime;

/// Length of a side in m.
pub const SIDE_M: f64 = 1.0;
/// Mass of the sheet in kg.
pub const MASS_KG: f64 = 0.2;
/// Damping in 1/s.
pub const DAMPING_PER_S: f64 = 2.0;
/// Frames per second.
pub const RATE_HZ: f64 = 60.0;

const FRAMES: usize = 300;
const LAST_SECOND: usize = 240;

/// An engine with the sheet in it, N x N particles, row by row from the pinned corners on.
pub trait Engine {
    /// One frame.
    fn step(&mut self);
    /// Where the particles are.
    fn positions(&self, to: &mut Vec<[f32; 3]>);
}

/// How the sheet fell and what it cost.
#[derive(Debug)]
pub struct Result {
    /// ms of thread CPU per simulated second: the steps alone.
    pub cpu_ms_per_s: f64,
    /// Mean stretch of the structural links in the last second, a compressed one counted as 0.
    pub mean_pct: f64,
    /// 99th percentile, mean over the last second.
    pub p99_pct: f64,
    /// Largest stretch of any frame.
    pub peak_pct: f64,
    /// Mean height in m at the end; the pins are at 0.
    pub height_m: f64,
}

/// Lets it fall. None where a position is not finite or the sheet is longer than a house.
pub fn fall(engine: &mut dyn Engine, side: usize) -> Option<Result> {
    let rest = SIDE_M / (side - 1) as f64;
    let (mut cpu, mut mean, mut p99, mut peak, mut height) = (0.0, 0.0, 0.0, f64::NEG_INFINITY, 0.0);
    let mut x = Vec::new();
    for frame in 0..FRAMES {
        let clock = ThreadTime::now();
        engine.step();
        cpu += clock.elapsed().as_secs_f64();
        engine.positions(&mut x);
        let length = |a: usize, b: usize| {
            let squared = |axis: usize| (f64::from(x[a][axis]) - f64::from(x[b][axis])).powi(2);
            (squared(0) + squared(1) + squared(2)).sqrt()
        };
        let mut strains = Vec::with_capacity(2 * side * side);
        for i in 0..side * side {
            if i % side + 1 < side {
                strains.push(100.0 * (length(i, i + 1) / rest - 1.0));
            }
            if i + side < side * side {
                strains.push(100.0 * (length(i, i + side) / rest - 1.0));
            }
        }
        strains.sort_by(f64::total_cmp);
        let largest = strains[strains.len() - 1];
        if !largest.is_finite() || largest > 1e5 {
            return None;
        }
        peak = peak.max(largest);
        if frame >= LAST_SECOND {
            let share = 1.0 / (FRAMES - LAST_SECOND) as f64;
            mean += share * strains.iter().map(|e| e.max(0.0)).sum::<f64>() / strains.len() as f64;
            p99 += share * percentile(&strains, 0.99);
        }
        height = x.iter().map(|p| f64::from(p[1])).sum::<f64>() / x.len() as f64;
    }
    let cpu_ms_per_s = 1e3 * cpu / (FRAMES as f64 / RATE_HZ);
    Some(Result { cpu_ms_per_s, mean_pct: mean, p99_pct: p99, peak_pct: peak, height_m: height })
}

fn percentile(sorted: &[f64], share: f64) -> f64 {
    let at = share * (sorted.len() - 1) as f64;
    let low = at.floor() as usize;
    let high = (low + 1).min(sorted.len() - 1);
    sorted[low] + (sorted[high] - sorted[low]) * (at - low as f64)
}
