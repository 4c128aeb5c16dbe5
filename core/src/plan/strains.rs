//! The largest strain of a cloth that is as stiff as its step carries, between measured ones.

use super::table::CELLS;
use crate::math::{max, min, sqrt};

/// What was measured of a method: ln of the largest strain of a sheet of 1 m at 60 Hz under 9.81 m/s^2. Never less on a
/// finer grid; where it blew up ln 2.
#[derive(Clone, Copy, Debug)]
pub(super) struct Strains {
    /// Substeps that were measured, upwards; empty where the method makes no sense.
    pub substeps: &'static [f32],
    /// By [`CELLS`], then by `substeps`.
    pub ln_strain: [&'static [f32]; CELLS.len()],
    /// What is added to ln of the strain, for what lies between: half of what one measured row in ten lay above its neighbours'
    /// line.
    pub margin: f32,
}

/// Slopes of ln(strain) over ln(substeps) and ln(cells) beyond what was measured: a stiffness goes with 1/dt^2, a force that
/// is handed on along more particles with their number.
const STEP_SLOPES: [f32; 2] = [-2.0, -0.5];
const CELL_SLOPES: [f32; 2] = [0.0, 3.0];

impl Strains {
    /// The strain to expect on a grid of so many cells; a strain depends on g dt^2 / L alone, so other rates, sides and
    /// gravities count as more or fewer substeps.
    pub fn at(&self, cells: f32, rate_hz: f32, substeps: f32, side_m: f32, gravity_m_s2: f32) -> f32 {
        let as_measured = substeps * rate_hz / 60.0 * sqrt(9.81 / gravity_m_s2 * side_m);
        let x = libm::logf(as_measured);
        let over_steps = |row: &[f32]| line(self.substeps, row, x, STEP_SLOPES);
        let by_cells = self.ln_strain.map(over_steps);
        libm::expf(line(&CELLS, &by_cells, libm::logf(cells), CELL_SLOPES) + self.margin)
    }
}

/// A value between those at `at`, in a line over ln; beyond the ends the nearest line goes on with a slope in `slopes`.
fn line(at: &[f32], values: &[f32], x: f32, slopes: [f32; 2]) -> f32 {
    let mut found = 0.0;
    let mut pairs = at.windows(2).zip(values.windows(2)).peekable();
    let mut is_first = true;
    while let Some((ends, values)) = pairs.next() {
        let (&[from, to], &[a, b]) = (ends, values) else { continue };
        let (from, to) = (libm::logf(from), libm::logf(to));
        let slope = (b - a) / (to - from);
        let beyond = min(max(slope, slopes[0]), slopes[1]);
        if x < from && is_first {
            return a + (x - from) * beyond;
        }
        found = if x <= to { a + (x - from) * slope } else { b + (x - to) * beyond };
        if x <= to || pairs.peek().is_none() {
            return found;
        }
        is_first = false;
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_go_through_their_points_and_on() {
        let (at, values) = ([1.0, 2.0, 4.0], [1.0, 0.0, -3.0]);
        let y = |x: f32| line(&at, &values, libm::logf(x), [-2.0, -0.5]);
        for (x, expected) in at.iter().zip(values) {
            assert!((y(*x) - expected).abs() < 1e-5, "{x}: {}", y(*x));
        }
        assert!((y(2.0f32.sqrt()) - 0.5).abs() < 1e-5);
        let ln2 = 2.0f32.ln();
        assert!((y(0.5) - (1.0 + 1.0)).abs() < 1e-4, "the first slope, {}", y(0.5));
        assert!((y(8.0) - (-3.0 - 2.0 * ln2)).abs() < 1e-4, "held to -2, {}", y(8.0));
    }

    #[test]
    fn scale_is_g_dt2_over_l() {
        let rows: [&[f32]; 7] =
            [&[-3.0, -4.0], &[-2.5, -3.5], &[-2.0, -3.0], &[-1.5, -2.5], &[-1.0, -2.0], &[-0.5, -1.5], &[0.0, -1.0]];
        let s = Strains { substeps: &[4.0, 16.0], ln_strain: rows, margin: 0.0 };
        let base = s.at(31.0, 60.0, 8.0, 1.0, 9.81);
        assert!((base.ln() + 2.5).abs() < 1e-4);
        for other in [
            s.at(31.0, 120.0, 4.0, 1.0, 9.81),
            s.at(31.0, 60.0, 16.0, 1.0, 4.0 * 9.81),
            s.at(31.0, 60.0, 4.0, 4.0, 9.81),
        ] {
            assert!((other / base - 1.0).abs() < 1e-4);
        }
    }
}
