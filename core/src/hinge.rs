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

use crate::layout::{Layout, block, block_mut};
use crate::{Cloth, ClothDef, Grid};

/// Particles of a row that are worked on at a time. Beyond the border the weights are 0.
const LANES: usize = 16;

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

    /// Adds the forces of the hinges in N to the planes of forces.
    pub(crate) fn add_hinges(&mut self) {
        let l = self.layout;
        let all = Rigidity::new(&self.grid, &self.def);
        let kept = f64::from(self.report.hinge_fraction);
        let k = Factors { u: (all.u * kept) as f32, v: (all.v * kept) as f32, twist: (all.twist * kept) as f32 };
        if k.u == 0.0 && k.v == 0.0 && k.twist == 0.0 {
            return;
        }
        let planes = [&*self.x.x, &*self.x.y, &*self.x.z];
        for first in (0..l.columns).step_by(LANES) {
            let columns = Columns::new(&l, first, &k);
            for row in 0..l.rows {
                let (at, rows) = (l.at(row, first), Rows::new(&l, row, &k));
                for (x, force) in planes.into_iter().zip(&mut self.force) {
                    // the planes have room for whole blocks
                    let (Some(x), Some(to)) = (Around::new(x, at, l.stride), block_mut::<LANES>(force, at)) else {
                        continue;
                    };
                    let forces = match Around::new(self.mask, at, l.stride) {
                        Some(mask) => masked(&x, &mask, &k),
                        None => full(&x, &rows, &columns),
                    };
                    for (to, f) in to.iter_mut().zip(&forces) {
                        *to += f;
                    }
                }
            }
        }
    }
}

/// [`Rigidity`] as far as the budget keeps it.
#[derive(Clone, Copy)]
struct Factors {
    u: f32,
    v: f32,
    twist: f32,
}

/// The factors of the ten terms that a particle belongs to, 0 for those that lack a particle: the differences along u around
/// the particles before, here and behind; the same along v; the cells to the lower right, lower left, upper right, upper left.
struct Weights {
    u: [f32; 3],
    v: [f32; 3],
    twist: [f32; 4],
}

impl Weights {
    /// `p` is 1 where there is a particle (rows and columns from here), else 0.
    #[inline(always)]
    fn new(k: &Factors, p: impl Fn(isize, isize) -> f32) -> Weights {
        let along_u = |j: isize| k.u * (p(0, j - 1) * p(0, j) * p(0, j + 1));
        let along_v = |i: isize| k.v * (p(i - 1, 0) * p(i, 0) * p(i + 1, 0));
        let cell = |i: isize, j: isize| k.twist * (p(0, 0) * p(0, j) * (p(i, 0) * p(i, j)));
        Weights {
            u: [along_u(-1), along_u(0), along_u(1)],
            v: [along_v(-1), along_v(0), along_v(1)],
            twist: [cell(1, 1), cell(1, -1), cell(-1, 1), cell(-1, -1)],
        }
    }

    /// The force on a particle by the positions around it (rows and columns from here). Differences of neighbours come first:
    /// they are nearly exact, where a sum of thirteen large positions would not be.
    #[inline(always)]
    fn force(&self, x: impl Fn(isize, isize) -> f32) -> f32 {
        let along_u = |i: isize, j: isize| x(i, j + 1) - x(i, j);
        let along_v = |i: isize| x(i + 1, 0) - x(i, 0);
        let (e0, e1, e2, e3) = (along_u(0, -2), along_u(0, -1), along_u(0, 0), along_u(0, 1));
        let (g0, g1, g2, g3) = (along_v(-2), along_v(-1), along_v(0), along_v(1));
        let [u0, u1, u2] = self.u;
        let [v0, v1, v2] = self.v;
        let [t0, t1, t2, t3] = self.twist;
        let u = 2.0 * u1 * (e2 - e1) - u0 * (e1 - e0) - u2 * (e3 - e2);
        let v = 2.0 * v1 * (g2 - g1) - v0 * (g1 - g0) - v2 * (g3 - g2);
        let below = t1 * (along_u(1, -1) - e1) - t0 * (along_u(1, 0) - e2);
        let above = t2 * (e2 - along_u(-1, 0)) - t3 * (e1 - along_u(-1, -1));
        (u + v) + (below + above)
    }
}

/// The numbers of a plane at [`LANES`] particles of a row and at what their terms reach.
struct Around<'a> {
    here: &'a [f32; LANES + 4],
    above: [&'a [f32; LANES + 2]; 2],
    far: [&'a [f32; LANES]; 2],
}

impl<'a> Around<'a> {
    /// None where the plane ends before.
    #[inline(always)]
    fn new(plane: &'a [f32], at: usize, stride: usize) -> Option<Around<'a>> {
        Some(Around {
            here: block(plane, at.wrapping_sub(2))?,
            above: [block(plane, at.wrapping_sub(stride + 1))?, block(plane, at.wrapping_add(stride - 1))?],
            far: [block(plane, at.wrapping_sub(2 * stride))?, block(plane, at.wrapping_add(2 * stride))?],
        })
    }

    /// The number so many rows and columns from a particle.
    #[inline(always)]
    fn at(&self, particle: usize, i: isize, j: isize) -> f32 {
        let [up, down] = self.above;
        let [far_up, far_down] = self.far;
        match i {
            -2 => far_up[particle],
            -1 => up[particle.wrapping_add_signed(j + 1)],
            0 => self.here[particle.wrapping_add_signed(j + 2)],
            1 => down[particle.wrapping_add_signed(j + 1)],
            _ => far_down[particle],
        }
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

    #[inline(always)]
    fn weights(&self, columns: &Columns, c: usize) -> Weights {
        let [u0, u1, u2] = &columns.u;
        let (right, left) = (columns.right[c], columns.left[c]);
        Weights {
            u: [u0[c], u1[c], u2[c]],
            v: self.v,
            twist: [self.below * right, self.below * left, self.above * right, self.above * left],
        }
    }
}

/// The forces on the particles of a block of a full grid.
#[inline(never)]
fn full(x: &Around<'_>, rows: &Rows, columns: &Columns) -> [f32; LANES] {
    let mut forces = [0.0; LANES];
    for c in 0..LANES {
        forces[c] = rows.weights(columns, c).force(|i, j| x.at(c, i, j));
    }
    forces
}

/// The same where some particles are absent. `mask` is 1 for a particle and 0 elsewhere.
#[inline(never)]
fn masked(x: &Around<'_>, mask: &Around<'_>, k: &Factors) -> [f32; LANES] {
    let mut forces = [0.0; LANES];
    for c in 0..LANES {
        forces[c] = Weights::new(k, |i, j| mask.at(c, i, j)).force(|i, j| x.at(c, i, j));
    }
    forces
}

#[cfg(test)]
mod tests {
    extern crate std;

    use std::vec;
    use std::vec::Vec;

    use super::*;
    use crate::{Features, GridDef, noise};

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

    /// The forces on all particles, by the mask or as a full grid.
    fn forces(l: &Layout, x: &[f32], mask: Option<&[f32]>) -> Vec<f32> {
        let mut force = vec![0.0; l.plane];
        for first in (0..l.columns).step_by(LANES) {
            for row in 0..l.rows {
                let at = l.at(row, first);
                let (x, to) = (Around::new(x, at, l.stride).unwrap(), block_mut::<LANES>(&mut force, at).unwrap());
                *to = match mask {
                    Some(mask) => masked(&x, &Around::new(mask, at, l.stride).unwrap(), &K),
                    None => full(&x, &Rows::new(l, row, &K), &Columns::new(l, first, &K)),
                };
            }
        }
        force
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
