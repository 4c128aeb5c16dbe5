//! Which nodes of a coarse level stand for cloth, where particles are absent.
//!
//! A link between two nodes limits their chord, so it may be swept only where the cloth goes straight from one to the other.
//! And what a node found is handed down to the particles around it, so none of them may be cut off from it: two sides of a
//! tear must not move each other. Both hold if on no straight way from the node to one of its 8 neighbours any particle
//! lies behind a gap. Such a way may end before the neighbour, as at the rim of a disc. The other nodes take no part in their level.

use crate::layout::{Layout, write};
use crate::levels::Level;
use crate::mask::{cuts, is_absent};

/// Writes 1 for each node of a level that takes part, 0 for all else. Of a cloth without a mask the plane is empty.
pub(crate) fn write_nodes(l: &Layout, level: &Level, mask: &[f32], nodes: &mut [f32]) {
    nodes.fill(0.0);
    if nodes.is_empty() {
        return;
    }
    let [columns, rows] = level.size;
    let particle = |row: usize, column: usize| [level.particle(1, row), level.particle(0, column)];
    for row in 0..rows {
        for column in 0..columns {
            let node = particle(row, column);
            let mut around = (row.saturating_sub(1)..(row + 2).min(rows))
                .map(|row| (row, column.saturating_sub(1)))
                .flat_map(|(row, first)| (first..(column + 2).min(columns)).map(move |column| particle(row, column)));
            let [at_row, at_column] = node;
            let there = !is_absent(mask, l.at(at_row, at_column));
            if there && around.all(|to| is_whole(l, mask, node, to)) {
                write(nodes, row * level.stride() + column, 1.0);
            }
        }
    }
}

/// Whether no particle on a straight way is behind a gap. On a way along neither rows, columns nor diagonals its particles are
/// the nearest to the line.
fn is_whole(l: &Layout, mask: &[f32], from: [usize; 2], to: [usize; 2]) -> bool {
    let ways = [0, 1].map(|d| from[d].abs_diff(to[d]));
    let links = ways[0].max(ways[1]).max(1);
    let on = |i: usize| {
        let [row, column] = [0, 1].map(|d| {
            let gone = (2 * ways[d] * i + links) / (2 * links);
            if to[d] > from[d] { from[d] + gone } else { from[d] - gone }
        });
        l.at(row, column)
    };
    let (mut at, mut gap) = (on(0), false);
    for i in 1..=links {
        let next = on(i);
        gap = gap || cut_between(l, mask, at, next);
        if gap && !is_absent(mask, next) {
            return false;
        }
        at = next;
    }
    true
}

/// Whether absent particles cut the link between two neighbours.
fn cut_between(l: &Layout, mask: &[f32], a: usize, b: usize) -> bool {
    let (first, second) = (a.min(b), a.max(b));
    let plane = match second - first {
        1 => 0,
        way if way == l.stride => 1,
        way if way > l.stride => 2,
        _ => 3,
    };
    cuts(mask, l.stride, first, second, plane)
}
