//! From what the network writes to stiffness at the particles.

use ndarray::{Array3, ArrayView3};
use taut::BEND_SHARE;
use taut::field::{CHANNELS, bilinear};

use crate::Error;
use crate::metadata::Range;
use crate::scene::check_grid;

impl Range {
    /// exp(lerp(ln low, ln high, (t + 1) / 2)) for t in [-1, 1]. In f64 by libm, so that equal
    /// inputs give equal bits on every machine; never outside the range.
    pub(crate) fn decode(self, t: f32) -> f32 {
        let (low, high) = (libm::log(f64::from(self.low)), libm::log(f64::from(self.high)));
        let share = (f64::from(t) + 1.0) * 0.5;
        let value = libm::exp(low + (high - low) * share) as f32;
        value.clamp(self.low, self.high)
    }
}

/// The field `[channel][row][column]` in N/m from the tanh values of the network.
/// `tanh` holds `4 * grid * grid` numbers within [-1, 1], as `grid` x `grid` x 4 shapes.
pub(crate) fn decode(tanh: &ArrayView3<'_, f32>, ranges: &[Range; 4]) -> Array3<f32> {
    Array3::from_shape_fn(tanh.dim(), |(c, i, j)| ranges[c].decode(tanh[[c, i, j]]))
}

/// Moves a field to `rows` x `columns` particles, bilinear with the corners aligned, by the rule of
/// the cloth itself ([`taut::field::bilinear`]): linear fields stay linear, values stay within those
/// around them but for rounding, and the source's own size gives the source back bit by bit.
/// Errors: [`Error::GridSize`] unless all sides have 2 to 4096 particles.
pub fn resample(field: &ArrayView3<'_, f32>, rows: usize, columns: usize) -> Result<Array3<f32>, Error> {
    let (channels, from_rows, from_columns) = field.dim();
    check_grid(from_rows, from_columns)?;
    check_grid(rows, columns)?;
    Ok(Array3::from_shape_fn((channels, rows, columns), |(c, i, j)| {
        let value = |row, column| field[[c, row, column]];
        bilinear((from_rows, from_columns), value, (i, j), (rows, columns))
    }))
}

/// Caps the bend channel at [`BEND_SHARE`] of the mean of warp and weft, at each particle: a free one
/// hangs the load on springs that have no linear bending stiffness, and sticks when folded.
pub(crate) fn cap_bend(field: &mut Array3<f32>) {
    let (channels, rows, columns) = field.dim();
    debug_assert_eq!(channels, CHANNELS.len());
    for i in 0..rows {
        for j in 0..columns {
            let structural = 0.5 * (field[[0, i, j]] + field[[1, i, j]]);
            field[[3, i, j]] = field[[3, i, j]].min(BEND_SHARE * structural);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn noisy(rows: usize, columns: usize) -> Array3<f32> {
        Array3::from_shape_fn((4, rows, columns), |(c, i, j)| {
            1.0 + ((c * 7919 + i * 104_729 + j * 1_299_709) % 1000) as f32
        })
    }

    #[test]
    fn decodes_the_ends_and_the_geometric_middle() {
        let range = Range { low: 5.0, high: 20_000.0 };
        assert_eq!((range.decode(-1.0), range.decode(1.0)), (5.0, 20_000.0));
        assert!((range.decode(0.0) / 100_000f32.sqrt() - 1.0).abs() < 1e-6);
        let mut last = 0.0;
        for i in -100..=100 {
            let value = range.decode(i as f32 / 100.0);
            assert!(value > last, "monotone");
            last = value;
        }
    }

    #[test]
    fn its_own_size_is_the_identity() {
        let field = noisy(32, 32);
        assert_eq!(resample(&field.view(), 32, 32).unwrap(), field);
    }

    #[test]
    fn going_up_and_back_is_the_identity() {
        let field = noisy(32, 32);
        // 63 = 2 * 31 + 1 and 94 = 3 * 31 + 1: every source particle is met exactly
        let up = resample(&field.view(), 63, 94).unwrap();
        assert_eq!(resample(&up.view(), 32, 32).unwrap(), field);
    }

    #[test]
    fn linear_fields_stay_linear_and_corners_stay() {
        let plane = |x: f64, y: f64| (100.0 + 30.0 * x - 7.0 * y) as f32;
        let of = |m: usize, n: usize| {
            Array3::from_shape_fn((4, m, n), |(_, i, j)| plane(i as f64 / (m - 1) as f64, j as f64 / (n - 1) as f64))
        };
        for (m, n) in [(2, 2), (2, 4096), (3, 17), (64, 48), (129, 31), (4096, 3)] {
            let got = resample(&of(32, 32).view(), m, n).unwrap();
            assert_eq!(got.dim(), (4, m, n));
            for (a, b) in got.iter().zip(&of(m, n)) {
                assert!((a - b).abs() <= 2e-5 * b.abs(), "{m} x {n}: {a} {b}");
            }
        }
    }

    #[test]
    fn values_stay_within_the_range() {
        let field = noisy(32, 32);
        let ends = |f: &Array3<f32>, c: usize| {
            let channel = f.index_axis(ndarray::Axis(0), c);
            channel.iter().fold((f32::MAX, f32::MIN), |(l, h), &x| (l.min(x), h.max(x)))
        };
        for (m, n) in [(2, 2), (5, 4096), (33, 31), (200, 300)] {
            let got = resample(&field.view(), m, n).unwrap();
            for c in 0..4 {
                let ((low, high), (got_low, got_high)) = (ends(&field, c), ends(&got, c));
                assert!(low * (1.0 - 1e-6) <= got_low && got_high <= high * (1.0 + 1e-6));
            }
        }
    }

    #[test]
    fn refuses_bad_sizes() {
        let field = noisy(32, 32);
        for (m, n) in [(1, 1), (0, 5), (70_000, 2), (2, 4097)] {
            assert!(matches!(resample(&field.view(), m, n), Err(Error::GridSize { .. })));
        }
    }

    #[test]
    fn bend_is_capped_at_each_particle() {
        let mut field = Array3::from_elem((4, 2, 2), 1.0);
        field[[0, 0, 0]] = 300.0;
        field[[1, 0, 0]] = 100.0;
        field[[3, 0, 0]] = 50.0;
        field[[3, 1, 1]] = 0.001;
        cap_bend(&mut field);
        assert_eq!(field[[3, 0, 0]], 4.0);
        assert_eq!(field[[3, 0, 1]], 0.02);
        assert_eq!(field[[3, 1, 1]], 0.001);
        assert_eq!(field[[2, 0, 0]], 1.0);
    }
}
