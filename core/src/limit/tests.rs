extern crate std;

use std::vec;
use std::vec::Vec;

use super::{Reach, Sheet, Sweeps};
use crate::force::TINY;
use crate::math::sqrt;
use crate::noise::uniform;
use crate::width::Supported;
use crate::{Width, simd};

/// A crumpled sheet of nodes, stretched here and there.
struct Plain {
    rows: usize,
    columns: usize,
    stride: usize,
    x: [Vec<f32>; 3],
    inverse: Vec<f32>,
    mask: Vec<f32>,
    reach: Reach,
}

impl Plain {
    fn new(rows: usize, columns: usize, seed: u64, masked: bool) -> Plain {
        let stride = columns.div_ceil(16) * 16;
        let numbers = rows * stride + 32;
        let mut plain = Plain {
            rows,
            columns,
            stride,
            x: [vec![0.0; numbers], vec![0.0; numbers], vec![0.0; numbers]],
            inverse: vec![0.0; numbers],
            mask: if masked { vec![0.0; numbers] } else { vec![] },
            reach: Reach {
                u: 0.0505,
                v: 0.041,
                diagonal: 1.015,
                rest_u: 0.05,
                rest_v: 0.04,
                span: [2, 2],
                last_span: [1, 2],
            },
        };
        let mut count = 0;
        let mut random = || {
            count += 1;
            uniform(seed, count)
        };
        for row in 0..rows {
            for column in 0..columns {
                let at = row * stride + column;
                let place = [0.1 * column as f32, 0.08 * row as f32, 0.0];
                for (x, place) in plain.x.iter_mut().zip(place) {
                    x[at] = place + 0.02 * (random() - 0.5);
                }
                plain.inverse[at] = if random() < 0.1 { 0.0 } else { 1.0 + random() };
                if masked {
                    plain.mask[at] = f32::from(u8::from(random() > 0.15));
                }
            }
        }
        plain
    }

    fn is_there(&self, at: usize) -> bool {
        self.mask.is_empty() || self.mask[at] == 1.0
    }

    /// One link, if it is too long. Whether it was.
    fn draw(&mut self, a: usize, b: usize, limit: f32) -> bool {
        let d = [0, 1, 2].map(|axis| self.x[axis][b] - self.x[axis][a]);
        let d2 = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
        if !self.is_there(a) || !self.is_there(b) || d2 <= limit * limit {
            return false;
        }
        let (l, w, w_there) = (sqrt(d2), self.inverse[a], self.inverse[b]);
        let factor = (l - limit) / (l * (w + w_there).max(TINY));
        for axis in 0..3 {
            self.x[axis][a] += d[axis] * factor * w;
            self.x[axis][b] -= d[axis] * factor * w_there;
        }
        true
    }

    /// All links along u that begin at even or odd columns.
    fn along(&mut self, parity: usize) -> bool {
        let mut moved = false;
        for row in 0..self.rows {
            for column in (parity..self.columns - 1).step_by(2) {
                let span = if column + 2 == self.columns { self.reach.last_span } else { self.reach.span };
                let at = row * self.stride + column;
                moved |= self.draw(at, at + 1, self.reach.u * span[0] as f32);
            }
        }
        moved
    }

    /// All links of a family between the pairs of rows that begin at even or odd ones.
    fn across(&mut self, parity: usize, family: usize) -> bool {
        let mut moved = false;
        for row in (parity..self.rows - 1).step_by(2) {
            let span_v = if row + 2 == self.rows { self.reach.last_span } else { self.reach.span }[1];
            for column in 0..self.columns - usize::from(family > 0) {
                let (upper, lower) = (row * self.stride + column, (row + 1) * self.stride + column);
                let span_u = if column + 2 == self.columns { self.reach.last_span } else { self.reach.span }[0];
                let (u, v) = (self.reach.rest_u * span_u as f32, self.reach.rest_v * span_v as f32);
                let (a, b, limit) = match family {
                    0 => (upper, lower, self.reach.v * span_v as f32),
                    1 => (upper, lower + 1, self.reach.diagonal * sqrt(u * u + v * v)),
                    _ => (upper + 1, lower, self.reach.diagonal * sqrt(u * u + v * v)),
                };
                let beside = [upper, upper + 1, lower, lower + 1].into_iter().filter(|at| *at != a && *at != b);
                if family > 0 && !beside.into_iter().any(|at| self.is_there(at)) {
                    continue;
                }
                moved |= self.draw(a, b, limit);
            }
        }
        moved
    }

    /// The order that the module tells, the whole sheet one kind of link after the other.
    fn sweep(&mut self, sweeps: u32) -> bool {
        let mut any = false;
        for sweep in 0..sweeps {
            let mut moved = false;
            if sweep % 2 == 0 {
                moved |= self.along(0) | self.along(1);
                for (parity, family) in [(0, 0), (0, 1), (0, 2), (1, 0), (1, 1), (1, 2)] {
                    moved |= self.across(parity, family);
                }
            } else {
                for (parity, family) in [(1, 2), (1, 1), (1, 0), (0, 2), (0, 1), (0, 0)] {
                    moved |= self.across(parity, family);
                }
                moved |= self.along(0) | self.along(1);
            }
            if !moved {
                break;
            }
            any = true;
        }
        any
    }
}

/// Whatever rows are worked on at once, in every width: each link once a sweep, in the order that is told.
#[test]
fn sweeps_are_those_of_the_whole_sheet() {
    let mut seed = 0;
    for (rows, columns) in [(2, 2), (2, 40), (3, 3), (5, 300), (17, 31), (33, 16), (34, 64), (40, 2), (65, 5)] {
        for masked in [false, true] {
            for sweeps in [1, 2, 5] {
                seed += 1;
                let mut wanted = Plain::new(rows, columns, seed, masked);
                assert!(wanted.sweep(sweeps), "nothing was too long");
                for width in Width::ALL.into_iter().filter_map(Supported::new) {
                    let mut now = Plain::new(rows, columns, seed, masked);
                    let sheet = Sheet {
                        rows,
                        columns,
                        stride: now.stride,
                        first: 0,
                        x: now.x.each_mut().map(|p| &mut p[..]),
                        inverse: &now.inverse,
                        mask: &now.mask,
                        reach: now.reach,
                    };
                    assert!(simd::run(width, Sweeps { sheet, sweeps }));
                    for (now, wanted) in now.x.iter().zip(&wanted.x) {
                        let same = now.iter().zip(wanted).all(|(a, b)| a.to_bits() == b.to_bits());
                        assert!(same, "{rows} x {columns}, mask {masked}, {sweeps} sweeps, {width:?}");
                    }
                }
            }
        }
    }
}
