//! Which nodes of a coarse level stand for cloth where particles are absent.
//!
//! A link between two nodes limits their chord, so it may be swept only where the cloth goes straight from one to the other.
//! And what a node found is handed down to the particles around it, so none of them may be cut off from it: the sides of a
//! tear must not move each other. Both hold if on no straight way from the node to one of its 8 neighbours a particle
//! lies behind a gap; a way may end before the neighbour, as at a rim. The other nodes take no part in their level.

use crate::layout::{Layout, write};
use crate::levels::Level;
use crate::mask::{cuts, is_absent};

/// Writes 1 for each node of a level that takes part and 0 for all else. Without masks the plane of the nodes is empty.
pub(crate) fn write_nodes(l: &Layout, level: &Level, mask: &[f32], nodes: &mut [f32]) {
    nodes.fill(0.0);
    let [columns, rows] = if nodes.is_empty() { [0, 0] } else { level.size };
    let particle = |row: usize, column: usize| [level.particle(1, row), level.particle(0, column)];
    for row in 0..rows {
        for column in 0..columns {
            let node = particle(row, column);
            // at the border of the sheet some of the 8 are the same one, or the node itself
            let is_whole = (0..9).all(|i| {
                let next = |node: usize, step: usize, nodes: usize| {
                    (node + step).saturating_sub(1).min(nodes.saturating_sub(1))
                };
                is_whole(l, mask, node, particle(next(row, i / 3, rows), next(column, i % 3, columns)))
            });
            let [at_row, at_column] = node;
            if is_whole && !is_absent(mask, l.at(at_row, at_column)) {
                write(nodes, row * level.stride() + column, 1.0);
            }
        }
    }
}

/// Whether no particle on a straight way is behind a gap. Of a way that is neither a row, a column nor a diagonal those
/// count that are nearest to it.
fn is_whole(l: &Layout, mask: &[f32], from: [usize; 2], to: [usize; 2]) -> bool {
    let ([row, column], [to_row, to_column]) = (from, to);
    let links = row.abs_diff(to_row).max(column.abs_diff(to_column));
    let along = |from: usize, to: usize, i: usize| {
        let gone = (2 * from.abs_diff(to) * i + links) / (2 * links).max(1);
        if to > from { from + gone } else { from - gone }
    };
    let (mut at, mut gap) = (l.at(row, column), false);
    for i in 1..=links {
        let next = l.at(along(row, to_row, i), along(column, to_column, i));
        gap = gap || cuts_link(l, mask, at, next);
        if gap && !is_absent(mask, next) {
            return false;
        }
        at = next;
    }
    true
}

/// Whether absent particles cut the link between the places of two neighbours.
fn cuts_link(l: &Layout, mask: &[f32], a: usize, b: usize) -> bool {
    let (first, second) = (a.min(b), a.max(b));
    let plane = match second - first {
        1 => 0,
        way if way == l.stride => 1,
        way if way > l.stride => 2,
        _ => 3,
    };
    cuts(mask, l.stride, first, second, plane)
}

#[cfg(test)]
mod tests;
