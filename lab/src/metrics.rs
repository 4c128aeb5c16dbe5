//! What is measured of a cloth.

use serde::Serialize;
use taut::Cloth;

/// Radius around a pin that `ex_pin` leaves out, in m: a point load on a grid depends on the grid.
pub const PIN_RADIUS_M: f32 = 0.1;

/// Structural stretch in percent of the rest length.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct StretchPct {
    /// Largest over all structural springs.
    pub max: f64,
    /// 99th percentile.
    pub p99: f64,
    /// Mean; compressed springs count with their sign.
    pub mean: f64,
    /// Largest over the springs whose ends both lie more than 0.1 m (in the rest grid) from any pin.
    pub ex_pin_max: f64,
}

/// Measures the structural stretch. Numbers that are not finite come out as NaN.
pub fn stretch(cloth: &Cloth<'_>) -> StretchPct {
    let g = cloth.grid();
    let n = g.columns();
    let pins: Vec<usize> = cloth.pinned().collect();
    let far: Vec<bool> = (0..g.particles())
        .map(|i| {
            pins.iter().all(|p| {
                let du = ((i % n) as f32 - (p % n) as f32) * g.rest_u();
                let dv = ((i / n) as f32 - (p / n) as f32) * g.rest_v();
                (du * du + dv * dv).sqrt() > PIN_RADIUS_M
            })
        })
        .collect();
    let mut all = Vec::with_capacity(2 * g.particles());
    let mut ex_pin = f64::NEG_INFINITY;
    cloth.each_structural_strain(|a, b, e| {
        let e = 100.0 * f64::from(e);
        all.push(e);
        if far[a] && far[b] {
            ex_pin = ex_pin.max(e);
        }
    });
    let nan = all.iter().any(|e| !e.is_finite());
    if nan || all.is_empty() {
        return StretchPct { max: f64::NAN, p99: f64::NAN, mean: f64::NAN, ex_pin_max: f64::NAN };
    }
    all.sort_by(f64::total_cmp);
    StretchPct {
        max: all[all.len() - 1],
        p99: percentile(&all, 0.99),
        mean: all.iter().sum::<f64>() / all.len() as f64,
        ex_pin_max: if ex_pin.is_finite() { ex_pin } else { f64::NAN },
    }
}

/// A percentile (share 0 to 1) of ascending numbers, linear in between.
pub fn percentile(sorted: &[f64], share: f64) -> f64 {
    let at = share * (sorted.len() - 1) as f64;
    let low = at.floor() as usize;
    let high = (low + 1).min(sorted.len() - 1);
    sorted[low] + (sorted[high] - sorted[low]) * (at - low as f64)
}

/// The middle of some numbers (the mean of the two middle ones where there are two). NaN for none.
pub fn median(values: &[f32]) -> f32 {
    let mut v = values.to_vec();
    v.sort_by(f32::total_cmp);
    match v.len() {
        0 => f32::NAN,
        n if n % 2 == 1 => v[n / 2],
        n => 0.5 * (v[n / 2 - 1] + v[n / 2]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percentiles_and_medians() {
        let v: Vec<f64> = (0..101).map(f64::from).collect();
        assert_eq!(percentile(&v, 0.99), 99.0);
        assert_eq!(percentile(&[1.0, 2.0], 0.5), 1.5);
        assert_eq!(median(&[3.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(&[3.0, 1.0, 2.0, 10.0]), 2.5);
        assert!(median(&[]).is_nan());
    }
}
