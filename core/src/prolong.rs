//! What a coarser level found, handed to a finer sheet: each free particle is moved by the way that is bilinear between the
//! coarser nodes around it.
//!
//! A coarser row is spread along u once, to the columns of the finer sheet, and then mixed with the next one for every row
//! between them.

use crate::layout::{block, copy, read, span, write};
use crate::levels::Level;
use crate::math::{lerp, round16};
use crate::simd::{Pass, Vector};
use crate::tethers::BLOCK;

/// Moves the free particles of a sheet by the ways of the next coarser level.
pub(crate) struct Prolong<'p> {
    pub fine: Level,
    pub coarse: Level,
    /// Ways of the coarser nodes, from place 0 on, [`Level::stride`] a row.
    pub ways: [&'p [f32]; 3],
    /// Positions of the finer sheet, place of its first particle, numbers of a row.
    pub x: [&'p mut [f32]; 3],
    pub first: usize,
    pub stride: usize,
    pub inverse: &'p [f32],
    /// 6 rows of `stride` numbers.
    pub scratch: &'p mut [f32],
}

impl Pass for Prolong<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(mut self, zero: V) {
        let [columns, rows] = self.fine.size;
        let mut held = None;
        for row in 0..rows {
            let (node, share) = self.coarse.before(1, self.fine.particle(1, row));
            if held != Some(node) {
                if node == 0 || held != Some(node - 1) {
                    self.spread(node);
                }
                self.spread(node + 1);
                held = Some(node);
            }
            let (share, width) = (zero.all(share), round16(columns));
            let [top, bottom] = [node, node + 1].map(|node| self.place(node));
            let at = self.first + row * self.stride;
            let (inverse, _) = span(self.inverse, at, width).as_chunks::<BLOCK>();
            for (axis, x) in self.x.iter_mut().enumerate() {
                let (above, _) = span(self.scratch, top + axis * self.stride, width).as_chunks::<BLOCK>();
                let (below, _) = span(self.scratch, bottom + axis * self.stride, width).as_chunks::<BLOCK>();
                let (x, _) = x.get_mut(at..at + width).unwrap_or_default().as_chunks_mut::<BLOCK>();
                for (((x, inverse), above), below) in x.iter_mut().zip(inverse).zip(above).zip(below) {
                    let mut lane = 0;
                    while lane < BLOCK {
                        let here = zero.read(x, lane);
                        let (above, below) = (zero.read(above, lane), zero.read(below, lane));
                        let moved = here + (above + (below - above) * share);
                        zero.read(inverse, lane).above(zero, moved, here).write(x, lane);
                        lane += V::LANES;
                    }
                }
            }
        }
    }
}

impl Prolong<'_> {
    /// Where a row of coarser nodes is in the scratch.
    #[inline(always)]
    fn place(&self, node: usize) -> usize {
        node % 2 * 3 * self.stride
    }

    /// Spreads a row of ways to the finer columns.
    #[inline(always)]
    fn spread(&mut self, node: usize) {
        let ([columns, _], [nodes, _]) = (self.fine.size, self.coarse.size);
        let place = self.place(node);
        for (axis, ways) in self.ways.into_iter().enumerate() {
            // the plane goes on behind the last row by more than a block
            let ways = span(ways, node * self.coarse.stride(), nodes + BLOCK);
            let place = place + axis * self.stride;
            let Some(out) = self.scratch.get_mut(place..place + round16(columns)) else {
                continue;
            };
            if columns == nodes {
                copy(out, span(ways, 0, nodes));
                continue;
            }
            // The last cell may be shorter than the others. What is written beyond the others is overwritten.
            let whole = nodes.saturating_sub(2);
            let (blocks, _) = out.as_chunks_mut::<BLOCK>();
            for (i, out) in blocks.iter_mut().enumerate().take(whole.div_ceil(BLOCK / 2)) {
                let Some(ways) = block::<{ BLOCK / 2 + 1 }>(ways, i * (BLOCK / 2)) else {
                    continue;
                };
                let (pairs, _) = out.as_chunks_mut::<2>();
                for (([even, odd], a), b) in pairs.iter_mut().zip(ways).zip(ways.iter().skip(1)) {
                    (*even, *odd) = (*a, lerp(*a, *b, 0.5));
                }
            }
            for column in 2 * whole..columns {
                let (i, share) = self.coarse.before(0, self.fine.particle(0, column));
                write(out, column, lerp(read(ways, i), read(ways, i + 1), share));
            }
        }
    }
}
