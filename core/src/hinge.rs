//! Hinge bending: the energy of a thin plate of rigidity D and Poisson ratio 0,
//! 1/2 D times the integral of |x_uu|^2 + |x_vv|^2 + 2 |x_uv|^2, on the grid.
//!
//! The vectors of second differences stand for the curvature (the quadratic bending model: Bergou, Wardetzky, Harmon,
//! Zorin, Grinspun 2006): for a sheet that does not stretch, |x_uu| is the curvature itself, at any deflection. So the
//! energy is a quadratic form of the positions with constant factors. It is 0 for every affine image of the flat sheet: the
//! hinges resist neither motion nor uniform stretch. They are forces of a potential that turning does not change, so they
//! keep momentum and angular momentum.
//!
//! | term | difference | factor in N/m |
//! |---|---|---|
//! | line along u | x(j-1) - 2 x(j) + x(j+1) | u = D (height / rows) / rest_u^3 |
//! | line along v | x(i-1) - 2 x(i) + x(i+1) | v = D (width / columns) / rest_v^3 |
//! | cell | x(i,j) - x(i,j+1) - x(i+1,j) + x(i+1,j+1) | twist = 2 D / (rest_u rest_v) |
//!
//! Each line has the same share of the sheet, as each particle has the same share of its mass. A term needs all of its
//! particles, which leaves the borders free.
//!
//! Stability: (a - 2 b + c)^2 <= 4 (a^2 + 2 b^2 + c^2) and (a - b - c + d)^2 <= 4 (a^2 + b^2 + c^2 + d^2), so the hinges add
//! at most 16 (u + v + twist) to what the springs put on a particle, in any shape and with any pins.

use crate::around::{Around, LANES};
use crate::layout::Layout;
use crate::simd::{Pass, Vector};
use crate::{Cloth, ClothDef, Grid};

/// Factors of the terms in N/m. In f64, where those of the smallest cells are finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rigidity {
    u: f64,
    v: f64,
    twist: f64,
}

impl Rigidity {
    pub fn new(grid: &Grid, def: &ClothDef) -> Rigidity {
        let d = f64::from(def.hinge_rigidity_n_m);
        let (u, v) = (f64::from(grid.rest_u()), f64::from(grid.rest_v()));
        let (width, height) = (f64::from(grid.def().width_m), f64::from(grid.def().height_m));
        Rigidity {
            u: d * (height / grid.rows() as f64) / (u * u * u),
            v: d * (width / grid.columns() as f64) / (v * v * v),
            twist: 2.0 * d / (u * v),
        }
    }

    /// What the hinges add to the stiffness on a particle at most, in N/m.
    pub fn bound(&self) -> f64 {
        16.0 * (self.u + self.v + self.twist)
    }
}

impl Cloth<'_> {
    /// What the hinges add to the stiffness on a particle at most, in N/m; 0 without them.
    pub(crate) fn hinge_bound(&self) -> f64 {
        if self.layout.hinge { Rigidity::new(&self.grid, &self.def).bound() } else { 0.0 }
    }

    /// The factors of the hinges as far as the budget keeps them; none where they give no force.
    pub(crate) fn hinge_factors(&self) -> Option<Factors> {
        if !self.layout.hinge {
            return None;
        }
        let all = Rigidity::new(&self.grid, &self.def);
        let kept = f64::from(self.report.hinge_fraction);
        let k = Factors { u: (all.u * kept) as f32, v: (all.v * kept) as f32, twist: (all.twist * kept) as f32 };
        (k.u != 0.0 || k.v != 0.0 || k.twist != 0.0).then_some(k)
    }
}

/// [`Rigidity`] as far as the budget keeps it.
#[derive(Clone, Copy)]
pub(crate) struct Factors {
    u: f32,
    v: f32,
    twist: f32,
}

/// The factors of the ten terms that a particle belongs to, 0 for those that lack a particle: the differences along u around
/// the particles before, here and behind; the same along v; the cells to the lower right, lower left, upper right, upper left.
#[derive(Clone, Copy)]
struct Weights<V> {
    u: [V; 3],
    v: [V; 3],
    twist: [V; 4],
}

impl<V: Vector> Weights<V> {
    /// Of the particles from a lane on, by where there are particles.
    #[inline(always)]
    fn masked(zero: V, k: &Factors, mask: &Around<'_>, lane: usize) -> Weights<V> {
        let (u, v, twist) = (zero.all(k.u), zero.all(k.v), zero.all(k.twist));
        let [l2, l1, here, r1, r2] = mask.row(zero, lane);
        let [u1, d1] = mask.beside(zero, lane, 0);
        let [u2, d2] = mask.two_on(zero, lane);
        let ([ul, dl], [ur, dr]) = (mask.beside(zero, lane, -1), mask.beside(zero, lane, 1));
        Weights {
            u: [u * (l2 * l1 * here), u * (l1 * here * r1), u * (here * r1 * r2)],
            v: [v * (u2 * u1 * here), v * (u1 * here * d1), v * (here * d1 * d2)],
            twist: [
                twist * (here * r1 * (d1 * dr)),
                twist * (here * l1 * (d1 * dl)),
                twist * (here * r1 * (u1 * ur)),
                twist * (here * l1 * (u1 * ul)),
            ],
        }
    }

    /// Of the particles of a full grid.
    #[inline(always)]
    fn full(zero: V, rows: &Rows, columns: &Columns, lane: usize) -> Weights<V> {
        let ([u0, u1, u2], [v0, v1, v2]) = (&columns.u, rows.v);
        let (right, left) = (zero.read(&columns.right, lane), zero.read(&columns.left, lane));
        let (below, above) = (zero.all(rows.below), zero.all(rows.above));
        Weights {
            u: [zero.read(u0, lane), zero.read(u1, lane), zero.read(u2, lane)],
            v: [zero.all(v0), zero.all(v1), zero.all(v2)],
            twist: [below * right, below * left, above * right, above * left],
        }
    }

    /// The forces on the particles from a lane on along one axis, by the positions around them. Differences of neighbours
    /// come first: they are nearly exact, where a sum of thirteen large positions would not be.
    #[inline(always)]
    fn force(&self, zero: V, x: &Around<'_>, lane: usize) -> V {
        let two = zero.all(2.0);
        let [l2, l1, here, r1, r2] = x.row(zero, lane);
        let [u1, d1] = x.beside(zero, lane, 0);
        let [u2, d2] = x.two_on(zero, lane);
        let ([ul, dl], [ur, dr]) = (x.beside(zero, lane, -1), x.beside(zero, lane, 1));
        let (e0, e1, e2, e3) = (l1 - l2, here - l1, r1 - here, r2 - r1);
        let (g0, g1, g2, g3) = (u1 - u2, here - u1, d1 - here, d2 - d1);
        let ([uw0, uw1, uw2], [vw0, vw1, vw2], [t0, t1, t2, t3]) = (self.u, self.v, self.twist);
        let u = two * uw1 * (e2 - e1) - uw0 * (e1 - e0) - uw2 * (e3 - e2);
        let v = two * vw1 * (g2 - g1) - vw0 * (g1 - g0) - vw2 * (g3 - g2);
        let below = t1 * ((d1 - dl) - e1) - t0 * ((dr - d1) - e2);
        let above = t2 * (e2 - (ur - u1)) - t3 * (e1 - (u1 - ul));
        (u + v) + (below + above)
    }
}

/// 1 for a row or column of the grid, else 0.
#[inline(always)]
fn inside(at: usize, by: isize, count: usize) -> f32 {
    if at.wrapping_add_signed(by) < count { 1.0 } else { 0.0 }
}

/// What the weights of a full grid owe to the column: the factors of the lines along u, and whether there is a cell to the
/// right and to the left.
struct Columns {
    u: [[f32; LANES]; 3],
    right: [f32; LANES],
    left: [f32; LANES],
}

impl Columns {
    fn new(l: &Layout, first: usize, k: &Factors) -> Columns {
        let mut all = Columns { u: [[0.0; LANES]; 3], right: [0.0; LANES], left: [0.0; LANES] };
        for c in 0..LANES {
            let p = |j: isize| inside(first + c, j, l.columns);
            for (u, j) in all.u.iter_mut().zip(-1..) {
                u[c] = k.u * (p(j - 1) * p(j) * p(j + 1) * p(0));
            }
            all.right[c] = p(0) * p(1);
            all.left[c] = p(-1) * p(0);
        }
        all
    }
}

/// What the weights of a full grid owe to the row: the factors of the lines along v and of the cells below and above.
struct Rows {
    v: [f32; 3],
    below: f32,
    above: f32,
}

impl Rows {
    fn new(l: &Layout, row: usize, k: &Factors) -> Rows {
        let p = |i: isize| inside(row, i, l.rows);
        let v = |i: isize| k.v * (p(i - 1) * p(i) * p(i + 1));
        Rows { v: [v(-1), v(0), v(1)], below: k.twist * p(1), above: k.twist * p(-1) }
    }
}

/// Adds the forces of the hinges in N to those on the particles of some rows.
pub(crate) struct Bend<'p> {
    pub layout: &'p Layout,
    pub factors: Factors,
    /// The rows, from and to.
    pub rows: [usize; 2],
    pub x: [&'p [f32]; 3],
    pub mask: &'p [f32],
    /// The forces of these rows.
    pub force: [&'p mut [f32]; 3],
}

impl Pass for Bend<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(mut self, zero: V) {
        let (l, k) = (self.layout, self.factors);
        let blocks = l.width / LANES;
        // the first block, one between, the last but one and the last: all that differ
        let last = l.width.saturating_sub(LANES);
        let columns = [0, LANES, last.saturating_sub(LANES), last].map(|first| Columns::new(l, first, &k));
        let [first, between, last_but_one, last] = &columns;
        let [from, to] = self.rows;
        let begin = l.row(from);
        for row in from..to {
            let rows = Rows::new(l, row, &k);
            for block in 0..blocks {
                let columns = match blocks - block {
                    _ if block == 0 => first,
                    1 => last,
                    2 => last_but_one,
                    _ => between,
                };
                self.block(zero, l.at(row, block * LANES), begin, &rows, columns);
            }
        }
    }
}

impl Bend<'_> {
    /// The particles of a block; `begin` is the place of the first force.
    #[inline(always)]
    fn block<V: Vector>(&mut self, zero: V, at: usize, begin: usize, rows: &Rows, columns: &Columns) {
        let stride = self.layout.stride;
        let mask = Around::new(self.mask, at, stride);
        let mut lane = 0;
        while lane < LANES {
            let weights = match &mask {
                Some(mask) => Weights::masked(zero, &self.factors, mask, lane),
                None => Weights::full(zero, rows, columns, lane),
            };
            for (x, force) in self.x.into_iter().zip(&mut self.force) {
                // the planes have room for whole blocks
                if let Some(x) = Around::new(x, at, stride) {
                    let at = at.wrapping_add(lane).wrapping_sub(begin);
                    (zero.read(force, at) + weights.force(zero, &x, lane)).write(force, at);
                }
            }
            lane += V::LANES;
        }
    }
}

#[cfg(test)]
mod tests {
    extern crate std;

    use std::vec::Vec;
    use std::{println, vec};

    use super::*;
    use crate::width::Supported;
    use crate::{Features, GridDef, Width, noise, simd};

    const K: Factors = Factors { u: 3.0, v: 2.0, twist: 5.0 };

    fn layout(rows: u32, columns: u32) -> Layout {
        let grid = Grid::new(&GridDef { rows, columns, ..GridDef::default() }).unwrap();
        Layout::new(&grid, &ClothDef { features: Features::MASK, ..ClothDef::default() })
    }

    /// Something at the particles of a block of rows x columns of the grid, 0 elsewhere.
    fn plane(l: &Layout, rows: usize, columns: usize, f: impl Fn(u32) -> f32) -> Vec<f32> {
        let mut plane = vec![0.0; l.plane];
        for row in 0..rows {
            for column in 0..columns {
                plane[l.at(row, column)] = f((100 * row + column) as u32);
            }
        }
        plane
    }

    /// The forces on all particles along one axis, by the mask or as a full grid; the same in every width.
    fn forces(l: &Layout, x: &[f32], mask: Option<&[f32]>) -> Vec<f32> {
        let in_width = |width: Width| {
            let (mut force, mut y, mut z) = (vec![0.0; l.plane], vec![0.0; l.plane], vec![0.0; l.plane]);
            let mask = mask.unwrap_or(&[]);
            let begin = l.row(0);
            let force_of = [&mut force[begin..], &mut y[begin..], &mut z[begin..]];
            let bend = Bend { layout: l, factors: K, rows: [0, l.rows], x: [x; 3], mask, force: force_of };
            Supported::new(width).map(|width| simd::run(width, bend)).map(|()| force)
        };
        let single = in_width(Width::Scalar).unwrap();
        for width in Width::ALL {
            match in_width(width) {
                Some(force) => {
                    let bits = |f: &[f32]| f.iter().map(|f| f.to_bits()).collect::<Vec<_>>();
                    assert_eq!(bits(&force), bits(&single), "{width:?}");
                }
                None => println!("SKIPPED: this machine has no {}", width.name()),
            }
        }
        single
    }

    /// A grid of which only a block is present bends as a grid of that size: no term reaches an absent particle, wherever it is.
    #[test]
    fn a_masked_block_is_a_smaller_grid() {
        let large = layout(12, 37);
        let somewhere = |i: u32| noise::gaussian(1, i);
        for (rows, columns) in [(2, 2), (3, 5), (5, 3), (9, 20), (12, 37)] {
            let mask = plane(&large, rows, columns, |_| 1.0);
            let found = forces(&large, &plane(&large, 12, 37, somewhere), Some(&mask));
            let small = layout(rows as u32, columns as u32);
            let expected = forces(&small, &plane(&small, rows, columns, somewhere), None);
            for row in 0..12 {
                for column in 0..37 {
                    let inside = row < rows && column < columns;
                    let f = if inside { expected[small.at(row, column)] } else { 0.0 };
                    assert_eq!(found[large.at(row, column)], f, "{rows} x {columns}: {row}, {column}");
                }
            }
        }
    }

    /// A hole in the middle: nothing pulls at it, and what is left still keeps its momentum.
    #[test]
    fn a_hole_is_left_alone() {
        let l = layout(9, 11);
        let mut x = plane(&l, 9, 11, |i| noise::gaussian(2, i));
        let mut mask = plane(&l, 9, 11, |_| 1.0);
        mask[l.at(4, 5)] = 0.0;
        let before = forces(&l, &x, Some(&mask));
        assert_eq!(before[l.at(4, 5)], 0.0);
        let (sum, size) = before.iter().fold((0.0, 0.0), |(s, a), f| (s + f, a + f.abs()));
        assert!(sum.abs() < 1e-5 * size, "{sum} of {size}");
        // what the particle does is not felt
        x[l.at(4, 5)] = 100.0;
        assert_eq!(forces(&l, &x, Some(&mask)), before);
    }
}
