//! What a coarser level found, handed to a finer sheet: each free particle is moved by the way that is bilinear between the
//! coarser nodes around it.
//!
//! A coarser row is spread along u once, to the columns of the finer sheet, and then mixed with the next one for every row
//! between them. With a mask, the way is the mean of those coarser nodes around it that exist, weighted as before: their ways
//! and the weights themselves are spread alike.

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
    /// 1 for the coarser nodes that exist, 0 for the others, whose ways are 0; empty where all do.
    pub mask: &'p [f32],
    /// Positions of the finer sheet, place of its first particle, numbers of a row.
    pub x: [&'p mut [f32]; 3],
    pub first: usize,
    pub stride: usize,
    pub inverse: &'p [f32],
    /// Where the positions before are kept, if they are: planes as those of the finer sheet.
    pub keep: Option<[&'p mut [f32]; 3]>,
    /// 6 rows of `stride` numbers, 8 with a mask.
    pub scratch: &'p mut [f32],
}

impl Pass for Prolong<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self, zero: V) {
        if self.mask.is_empty() { self.all::<V, false>(zero) } else { self.all::<V, true>(zero) }
    }
}

impl Prolong<'_> {
    #[inline(always)]
    fn all<V: Vector, const MASK: bool>(mut self, zero: V) {
        let [columns, rows] = self.fine.size;
        let mut held = None;
        for row in 0..rows {
            let (node, share) = self.coarse.before(1, self.fine.particle(1, row));
            if held != Some(node) {
                if node == 0 || held != Some(node - 1) {
                    self.spread::<MASK>(node);
                }
                self.spread::<MASK>(node + 1);
                held = Some(node);
            }
            let (share, width) = (zero.all(share), round16(columns));
            let [top, bottom] = [node, node + 1].map(|node| self.place::<MASK>(node));
            let at = self.first + row * self.stride;
            let (inverse, _) = span(self.inverse, at, width).as_chunks::<BLOCK>();
            for (axis, x) in self.x.iter_mut().enumerate() {
                let kept = self.keep.as_mut().and_then(|planes| planes.get_mut(axis)?.get_mut(at..at + width));
                copy(kept.unwrap_or_default(), span(x, at, width));
                let (above, _) = span(self.scratch, top + axis * self.stride, width).as_chunks::<BLOCK>();
                let (below, _) = span(self.scratch, bottom + axis * self.stride, width).as_chunks::<BLOCK>();
                let (x, _) = x.get_mut(at..at + width).unwrap_or_default().as_chunks_mut::<BLOCK>();
                for (i, (((x, inverse), above), below)) in x.iter_mut().zip(inverse).zip(above).zip(below).enumerate() {
                    let mut lane = 0;
                    while lane < BLOCK {
                        let here = zero.read(x, lane);
                        let (above, below) = (zero.read(above, lane), zero.read(below, lane));
                        let mut way = above + (below - above) * share;
                        if MASK {
                            let at = 3 * self.stride + BLOCK * i + lane;
                            let (above, below) =
                                (zero.read(self.scratch, top + at), zero.read(self.scratch, bottom + at));
                            let weight = above + (below - above) * share;
                            way = weight.above(zero, way / weight, zero);
                        }
                        let moved = here + way;
                        zero.read(inverse, lane).above(zero, moved, here).write(x, lane);
                        lane += V::LANES;
                    }
                }
            }
        }
    }

    /// Where a row of coarser nodes is in the scratch.
    #[inline(always)]
    fn place<const MASK: bool>(&self, node: usize) -> usize {
        node % 2 * (3 + usize::from(MASK)) * self.stride
    }

    /// Spreads a row of ways, and of the mask, to the finer columns.
    #[inline(always)]
    fn spread<const MASK: bool>(&mut self, node: usize) {
        let ([columns, _], [nodes, _]) = (self.fine.size, self.coarse.size);
        let place = self.place::<MASK>(node);
        let [x, y, z] = self.ways;
        for (axis, ways) in [x, y, z, self.mask].into_iter().enumerate().take(3 + usize::from(MASK)) {
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
