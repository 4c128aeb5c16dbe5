//! The stiffness field: `[channel][row][column]` in N/m at the particles.

use crate::math::{lerp, min};
use crate::{Error, in_default_environment};

/// Order of the channels.
pub const CHANNELS: [&str; 4] = ["warp", "weft", "shear", "bend"];

/// What a field of a single channel (the m x n matrix of Wang and Wang 2021, IV.B) means for the four families.
pub const SINGLE_RATIOS: [f32; 4] = [1.0, 1.0, 0.3, 0.02];

/// Largest stiffness that a field may hold in N/m; a larger one is scaled down to it, all channels alike.
pub const MAX_STIFFNESS: f32 = 1e9;

/// A borrowed stiffness field of any resolution from 2 x 2 on, `[channel][row][column]`, N/m.
#[derive(Clone, Copy, Debug)]
pub struct FieldView<'a> {
    channels: usize,
    rows: usize,
    columns: usize,
    data: &'a [f32],
    forgiving: bool,
}

impl<'a> FieldView<'a> {
    /// Checks the shape (4 channels, or 1 with [`SINGLE_RATIOS`]) and every number.
    ///
    /// Errors: [`Error::GridSize`], [`Error::Shape`], [`Error::NotFinite`], [`Error::Negative`].
    pub fn new(channels: usize, rows: usize, columns: usize, data: &'a [f32]) -> Result<Self, Error> {
        let field = FieldView::sanitised(channels, rows, columns, data)?;
        in_default_environment(|| {
            if !data.iter().all(|k| k.is_finite()) {
                return Err(Error::NotFinite);
            }
            if data.iter().any(|k| *k < 0.0) {
                return Err(Error::Negative);
            }
            Ok(FieldView { forgiving: false, ..field })
        })
    }

    /// The same for numbers that nobody vouches for, such as those that a network printed: every field of the right shape
    /// is taken. Each number is read by this rule: NaN and what is not above 0 is 0, what is above [`MAX_STIFFNESS`]
    /// (infinity too) is [`MAX_STIFFNESS`]. [`FieldView::repaired`] tells how many are read otherwise than they stand.
    ///
    /// Errors: [`Error::GridSize`], [`Error::Shape`].
    pub fn sanitised(channels: usize, rows: usize, columns: usize, data: &'a [f32]) -> Result<Self, Error> {
        let side = |n: usize| (2..=crate::Grid::MAX_SIDE as usize).contains(&n);
        if !side(rows) || !side(columns) {
            return Err(Error::GridSize);
        }
        if (channels != 1 && channels != 4) || data.len() != channels * rows * columns {
            return Err(Error::Shape);
        }
        Ok(FieldView { channels, rows, columns, data, forgiving: true })
    }

    /// How many numbers the rule of [`FieldView::sanitised`] changes; 0 for a field that [`FieldView::new`] has checked.
    pub fn repaired(&self) -> usize {
        if !self.forgiving {
            return 0;
        }
        in_default_environment(|| self.data.iter().filter(|k| sane(**k) != **k).count())
    }

    /// The four channels at particle (row, column) of an m x n grid, bilinear between the field's own particles with the
    /// corners aligned.
    pub fn sample(&self, row: usize, column: usize, m: usize, n: usize) -> [f32; 4] {
        let value = |c: usize, row: usize, column: usize| {
            let k = self.data.get((c * self.rows + row) * self.columns + column).copied().unwrap_or(0.0);
            if self.forgiving { sane(k) } else { k }
        };
        let at = |c: usize| bilinear((self.rows, self.columns), |r, k| value(c, r, k), (row, column), (m, n));
        if self.channels == 1 { SINGLE_RATIOS.map(|r| r * at(0)) } else { [at(0), at(1), at(2), at(3)] }
    }
}

/// What a number of a field means that nobody vouches for.
fn sane(k: f32) -> f32 {
    // a NaN is not above 0
    if k > 0.0 { min(k, MAX_STIFFNESS) } else { 0.0 }
}

/// The value at place `at` of a grid of the size `to` of something known on a grid of the size `from` (both at least 2
/// each way), bilinear with the corners aligned. On its own grid every value is kept exactly.
pub fn bilinear(
    from: (usize, usize),
    value: impl Fn(usize, usize) -> f32,
    at: (usize, usize),
    to: (usize, usize),
) -> f32 {
    let (r0, r1, fr) = place(at.0, to.0, from.0);
    let (c0, c1, fc) = place(at.1, to.1, from.1);
    let top = lerp(value(r0, c0), value(r0, c1), fc);
    let bottom = lerp(value(r1, c0), value(r1, c1), fc);
    lerp(top, bottom, fr)
}

/// Where place `i` of `n` lies among `size` places with both ends aligned: the two neighbours and the share of the second.
fn place(i: usize, n: usize, size: usize) -> (usize, usize, f32) {
    let (last, steps) = (size - 1, (n - 1).max(1));
    let scaled = i * last;
    let low = scaled / steps;
    let rest = scaled - low * steps;
    (low, (low + 1).min(last), rest as f32 / steps as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sampling_keeps_nodes_and_linear_functions() {
        let mut data = [0.0f32; 4 * 5 * 3];
        for (i, d) in data.iter_mut().enumerate() {
            let (c, r, k) = (i / 15, (i / 3) % 5, i % 3);
            *d = 100.0 * c as f32 + 2.0 * r as f32 + 3.0 * k as f32;
        }
        let f = FieldView::new(4, 5, 3, &data).unwrap();
        assert_eq!(f.sample(3, 1, 5, 3), [9.0, 109.0, 209.0, 309.0]);
        let s = f.sample(8, 8, 17, 17);
        for (c, v) in s.iter().enumerate() {
            assert!((v - (100.0 * c as f32 + 2.0 * 2.0 + 3.0)).abs() < 1e-4, "{v}");
        }
    }

    #[test]
    fn a_sanitised_field_follows_its_rule() {
        let d = [f32::NAN, -1.0, f32::NEG_INFINITY, -0.0, f32::INFINITY, 1e30, 2.5, 1e-40];
        let mut data = [0.0; 16];
        data[..8].copy_from_slice(&d);
        let f = FieldView::sanitised(4, 2, 2, &data).unwrap();
        assert_eq!(f.repaired(), 5);
        let read = |i: usize| f.sample(i / 2 % 2, i % 2, 2, 2)[i / 4];
        let want = [0.0, 0.0, 0.0, 0.0, MAX_STIFFNESS, MAX_STIFFNESS, 2.5, 1e-40];
        for (i, k) in want.into_iter().enumerate() {
            assert_eq!(read(i).to_bits(), f32::to_bits(k), "number {i}");
        }
        assert_eq!(FieldView::sanitised(4, 2, 2, &data[..15]).unwrap_err(), Error::Shape);
        let good = [3.0; 16];
        assert_eq!(FieldView::sanitised(4, 2, 2, &good).unwrap().repaired(), 0);
    }

    #[test]
    fn bad_fields_are_named() {
        let mut d = [1.0f32; 16];
        assert_eq!(FieldView::new(4, 2, 2, &d[..15]).unwrap_err(), Error::Shape);
        assert_eq!(FieldView::new(3, 2, 2, &d[..12]).unwrap_err(), Error::Shape);
        assert_eq!(FieldView::new(4, 1, 4, &d).unwrap_err(), Error::GridSize);
        d[7] = f32::NAN;
        assert_eq!(FieldView::new(4, 2, 2, &d).unwrap_err(), Error::NotFinite);
        d[7] = f32::INFINITY;
        assert_eq!(FieldView::new(4, 2, 2, &d).unwrap_err(), Error::NotFinite);
        d[7] = -1.0;
        assert_eq!(FieldView::new(4, 2, 2, &d).unwrap_err(), Error::Negative);
    }
}
