//! The coarse half of the preconditioner: sums over ever coarser grids (Bramble, Pasciak and Xu 1990).
//!
//! A residual travels one particle per iteration of plain conjugate gradients, so a sheet of N x N would need a multiple of
//! N of them. Here it is also gathered on the particles of every second row and column with the weights of bilinear
//! interpolation, on those of every fourth, and so on down to 3, divided there by the diagonal blocks of the operator for
//! these shapes, and spread again. The preconditioner stays a sum of squares: symmetric and positive definite.
//!
//! The blocks of a grid of spacing H (in cells) follow from those of the fine one: a hat of bilinear interpolation weighs
//! the mass by 4/9 of its plain sum, the springs by 2/3 / H^2. A node on a pinned particle is left out.

use super::blocks::inverse;
use crate::layout::{Layout, block, read, write};
use crate::math::round16;
use crate::simd::{self, Pass, Vector};
use crate::width::Supported;

/// One plane: numbers, place of (row 0, column 0), numbers from a row to the next.
#[derive(Clone, Copy)]
struct Shape {
    rows: usize,
    columns: usize,
    first: usize,
    stride: usize,
}

impl Shape {
    fn fine(l: &Layout) -> Shape {
        Shape { rows: l.rows, columns: l.columns, first: l.row(0), stride: l.stride }
    }

    /// The next coarser one: every second row and column; where the last is not met there is one beyond it. None below 4.
    /// One row and column before it and two after it are spare.
    fn coarser(self) -> Option<Shape> {
        let half = |n: usize| n / 2 + 1;
        let stride = half(self.columns) + 3;
        let next = Shape { rows: half(self.rows), columns: half(self.columns), first: stride + 1, stride };
        (self.rows >= 4 && self.columns >= 4).then_some(next)
    }

    fn numbers(self) -> usize {
        // `gather` reads two numbers past the last row
        round16((self.rows + 3) * self.stride + 2)
    }

    fn row(self, row: usize) -> usize {
        self.first + row * self.stride
    }
}

/// Planes of a level: mass, blocks, residual, result.
const PLANES: usize = 13;

/// Numbers of all levels.
pub(super) fn numbers(l: &Layout) -> usize {
    let (mut sum, mut shape) = (0, Shape::fine(l));
    while let Some(next) = shape.coarser() {
        sum += PLANES * next.numbers();
        shape = next;
    }
    sum
}

/// A level: its planes cut from the memory.
struct Level<'a> {
    shape: Shape,
    mass: &'a mut [f32],
    blocks: [&'a mut [f32]; 6],
    residual: [&'a mut [f32]; 3],
    result: [&'a mut [f32]; 3],
}

/// Cuts the coarsest-first part off: this level and what is left for the coarser ones.
fn level(fine: Shape, memory: &mut [f32]) -> Option<(Level<'_>, &mut [f32])> {
    let shape = fine.coarser()?;
    let n = shape.numbers();
    let (mine, rest) = memory.split_at_mut_checked(PLANES * n)?;
    let mut planes = mine.chunks_exact_mut(n.max(1));
    let mut next = || planes.next().unwrap_or(&mut []);
    let mass = next();
    let blocks = core::array::from_fn(|_| next());
    let residual = core::array::from_fn(|_| next());
    let result = core::array::from_fn(|_| next());
    Some((Level { shape, mass, blocks, residual, result }, rest))
}

/// Coarse nodes that are worked on at a time.
const BLOCK: usize = 16;

/// to = sum over the fine nodes with the weights 1, 1/2, 1/4 of the hat around each coarse one.
struct Gather<'p> {
    fine: Shape,
    from: &'p [f32],
    coarse: Shape,
    to: &'p mut [f32],
}

impl Pass for Gather<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self, zero: V) {
        let Gather { fine, from, coarse, to } = self;
        for row in 0..coarse.rows {
            let (here, at) = (fine.row(2 * row) - 1, coarse.row(row));
            let (above, below) = (here - fine.stride, here + fine.stride);
            let to = to.get_mut(at..at + coarse.columns).unwrap_or(&mut []);
            for (to, first) in to.chunks_mut(BLOCK / 2).zip((0..).step_by(BLOCK)) {
                // the hats around all fine nodes of a block, of which every second one is taken
                let mut hats = [0.0; BLOCK];
                let cut = |at: usize| block::<{ BLOCK + 2 }>(from, at + first);
                if let (Some(a), Some(h), Some(b)) = (cut(above), cut(here), cut(below)) {
                    let mut lane = 0;
                    while lane < BLOCK {
                        let (left, right) = (across(zero, a, h, b, lane), across(zero, a, h, b, lane + 2));
                        let hat = across(zero, a, h, b, lane + 1) + zero.all(0.5) * (left + right);
                        hat.write(&mut hats, lane);
                        lane += V::LANES;
                    }
                } else {
                    // near the end of the planes of small levels
                    for (i, hat) in hats.iter_mut().enumerate().take(2 * to.len()) {
                        let t = |i: usize| {
                            let (a, h, b) = (above + i, here + i, below + i);
                            read(from, h) + 0.5 * (read(from, a) + read(from, b))
                        };
                        *hat = t(first + i + 1) + 0.5 * (t(first + i) + t(first + i + 2));
                    }
                }
                for (to, hat) in to.iter_mut().zip(hats.iter().step_by(2)) {
                    *to = *hat;
                }
            }
        }
    }
}

/// The middle of three rows and half of the others.
#[inline(always)]
fn across<V: Vector>(zero: V, a: &[f32; BLOCK + 2], h: &[f32; BLOCK + 2], b: &[f32; BLOCK + 2], lane: usize) -> V {
    zero.read(h, lane) + zero.all(0.5) * (zero.read(a, lane) + zero.read(b, lane))
}

/// to += the bilinear interpolation of the coarse nodes.
struct Spread<'p> {
    coarse: Shape,
    from: &'p [f32],
    fine: Shape,
    to: &'p mut [f32],
}

impl Pass for Spread<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self, zero: V) {
        let Spread { coarse, from, fine, to } = self;
        let half = zero.all(0.5);
        for row in 0..fine.rows {
            let (a, b) = (coarse.row(row / 2), coarse.row(row.div_ceil(2)));
            let at = fine.row(row);
            let to = to.get_mut(at..at + 2 * coarse.columns).unwrap_or(&mut []);
            let (blocks, rest) = to.as_chunks_mut::<{ 2 * BLOCK }>();
            let mut first = 0;
            for to in blocks {
                // those on a coarse node, and those behind each
                let (mut on, mut behind) = ([0.0; BLOCK], [0.0; BLOCK]);
                let mut lane = 0;
                while lane < BLOCK {
                    let i = first + lane;
                    let t = half * (zero.read(from, a + i) + zero.read(from, b + i));
                    let t2 = half * (zero.read(from, a + i + 1) + zero.read(from, b + i + 1));
                    t.write(&mut on, lane);
                    (half * (t + t2)).write(&mut behind, lane);
                    lane += V::LANES;
                }
                let (pairs, _) = to.as_chunks_mut::<2>();
                for (to, (on, behind)) in pairs.iter_mut().zip(on.iter().zip(&behind)) {
                    to[0] += on;
                    to[1] += behind;
                }
                first += BLOCK;
            }
            for (to, i) in rest.as_chunks_mut::<2>().0.iter_mut().zip(first..) {
                let (t, t2) = (
                    0.5 * (read(from, a + i) + read(from, b + i)),
                    0.5 * (read(from, a + i + 1) + read(from, b + i + 1)),
                );
                to[0] += t;
                to[1] += 0.5 * (t + t2);
            }
        }
    }
}

/// to = blocks * from. Plain loops: the compiler makes vectors of the width of them.
struct Multiply<'p, 'a> {
    blocks: &'p [&'a mut [f32]; 6],
    from: &'p [&'a mut [f32]; 3],
    to: &'p mut [&'a mut [f32]; 3],
}

impl Pass for Multiply<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self, _: V) {
        let [rx, ry, rz] = self.from.each_ref().map(|p| p.iter());
        let [xx, yy, zz, xy, xz, yz] = self.blocks.each_ref().map(|p| p.iter());
        let [zx, zy, z_z] = self.to.each_mut().map(|p| p.iter_mut());
        let outs = zx.zip(zy).zip(z_z);
        let r = rx.zip(ry).zip(rz);
        for (((((x, y), z), ((a, b), c)), ((d, e), f)), ((rx, ry), rz)) in
            outs.zip(xx.zip(yy).zip(zz)).zip(xy.zip(xz).zip(yz)).zip(r)
        {
            *x = a * rx + d * ry + e * rz;
            *y = d * rx + b * ry + f * rz;
            *z = e * rx + f * ry + c * rz;
        }
    }
}

/// Computes the inverse blocks of all levels from the mass and the blocks of the fine grid, which are not inverted yet.
pub(super) fn prepare(width: Supported, l: &Layout, mass: &[f32], blocks: [&[f32]; 6], memory: &mut [f32]) {
    prepare_level(width, Shape::fine(l), mass, blocks, 4.0, memory);
}

fn prepare_level(width: Supported, fine: Shape, mass: &[f32], blocks: [&[f32]; 6], h2: f32, memory: &mut [f32]) {
    let Some((level, rest)) = level(fine, memory) else {
        return;
    };
    let Level { shape, mass: sum, blocks: mut sums, .. } = level;
    simd::run(width, Gather { fine, from: mass, coarse: shape, to: sum });
    for (to, from) in sums.iter_mut().zip(blocks) {
        simd::run(width, Gather { fine, from, coarse: shape, to });
    }
    for row in 0..shape.rows {
        for column in 0..shape.columns {
            let inside = 2 * row < fine.rows && 2 * column < fine.columns;
            if inside && read(mass, fine.row(2 * row) + 2 * column) == 0.0 {
                write(sum, shape.row(row) + column, 0.0);
            }
        }
    }
    prepare_level(width, shape, sum, sums.each_ref().map(|p| &**p), 4.0 * h2, rest);
    let springs = 2.0 / 3.0 / h2;
    let inertia = 4.0 / 9.0 - springs;
    for row in 0..shape.rows {
        for column in 0..shape.columns {
            let at = shape.row(row) + column;
            let m = read(sum, at);
            let mut block = sums.each_ref().map(|p| springs * read(p, at));
            for d in block.iter_mut().take(3) {
                *d += inertia * m;
            }
            let done = if m > 0.0 { inverse(block) } else { [0.0; 6] };
            for (plane, x) in sums.iter_mut().zip(done) {
                write(plane, at, x);
            }
        }
    }
}

/// Adds the coarse parts to the preconditioned residual `z`; `r` must be 0 where nothing moves.
pub(super) fn add(width: Supported, l: &Layout, r: [&[f32]; 3], z: [&mut [f32]; 3], memory: &mut [f32]) {
    add_level(width, Shape::fine(l), r, z, memory);
}

fn add_level(width: Supported, fine: Shape, r: [&[f32]; 3], z: [&mut [f32]; 3], memory: &mut [f32]) {
    let Some((level, rest)) = level(fine, memory) else {
        return;
    };
    let Level { shape, blocks, mut residual, mut result, .. } = level;
    for (to, from) in residual.iter_mut().zip(r) {
        simd::run(width, Gather { fine, from, coarse: shape, to });
    }
    simd::run(width, Multiply { blocks: &blocks, from: &residual, to: &mut result });
    let residual = residual.each_ref().map(|p| &**p);
    add_level(width, shape, residual, result.each_mut().map(|p| &mut **p), rest);
    for (to, from) in z.into_iter().zip(&result) {
        simd::run(width, Spread { coarse: shape, from, fine, to });
    }
}
