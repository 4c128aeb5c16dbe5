//! What a coarser level found, handed to a finer sheet: each free particle is moved by the way that is bilinear between the
//! coarser nodes around it.
//!
//! A coarser row is spread along u once, to the columns of the finer sheet, and then mixed with the next one for every row
//! between them.

use crate::layout::{copy, read, span, write};
use crate::levels::Level;
use crate::math::lerp;
use crate::simd::{Pass, Vector};

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
            let (share, first) = (zero.all(share), self.first + row * self.stride);
            let ([top, bottom], x) = ([node, node + 1].map(|node| self.place(node)), &mut self.x);
            for (axis, x) in x.iter_mut().enumerate() {
                let (top, bottom) = (top + axis * self.stride, bottom + axis * self.stride);
                let mut column = 0;
                while column < columns {
                    let at = first + column;
                    let here = zero.read(x, at);
                    let above = zero.read(self.scratch, top + column);
                    let below = zero.read(self.scratch, bottom + column);
                    let moved = here + (above + (below - above) * share);
                    zero.read(self.inverse, at).above(zero, moved, here).write(x, at);
                    column += V::LANES;
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
            let ways = span(ways, node * self.coarse.stride(), nodes);
            let place = place + axis * self.stride;
            let Some(out) = self.scratch.get_mut(place..place + columns) else {
                continue;
            };
            if columns == nodes {
                copy(out, ways);
                continue;
            }
            // the last cell may be shorter than the others
            let whole = nodes.saturating_sub(2);
            let (pairs, _) = out.as_chunks_mut::<2>();
            for (([even, odd], a), b) in pairs.iter_mut().zip(ways).zip(ways.iter().skip(1)).take(whole) {
                (*even, *odd) = (*a, lerp(*a, *b, 0.5));
            }
            for column in 2 * whole..columns {
                let (i, share) = self.coarse.before(0, self.fine.particle(0, column));
                write(out, column, lerp(read(ways, i), read(ways, i + 1), share));
            }
        }
    }
}
