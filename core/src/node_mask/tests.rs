extern crate std;

use std::vec;
use std::vec::Vec;

use super::write_nodes;
use crate::layout::{Layout, write};
use crate::levels::Level;
use crate::{ClothDef, Features, Grid, GridDef};

/// The nodes (row, column) of a level that take part, of those whose particle is present, and the others of these.
fn nodes(rows: u32, columns: u32, k: u32, present: impl Fn(usize, usize) -> bool) -> [Vec<[usize; 2]>; 2] {
    let grid = Grid::new(&GridDef { rows, columns, ..GridDef::default() }).unwrap();
    let features = Features(Features::LEVELS.0 | Features::MASK.0);
    let l = Layout::new(&grid, &ClothDef { features, ..ClothDef::default() });
    let mut mask = vec![0.0; l.plane];
    for row in 0..l.rows {
        for column in 0..l.columns {
            write(&mut mask, l.at(row, column), f32::from(u8::from(present(row, column))));
        }
    }
    let level = Level::new(&l, k);
    let [node_columns, node_rows] = level.size;
    let mut plane = vec![7.0; level.stride() * node_rows + 32];
    write_nodes(&l, &level, &mask, &mut plane);
    let mut found = [vec![], vec![]];
    for row in 0..node_rows {
        for column in 0..node_columns {
            let value = plane[row * level.stride() + column];
            let there = present(level.particle(1, row), level.particle(0, column));
            assert!(value == 0.0 || value == 1.0 && there, "{row}, {column}: {value}");
            if there {
                found[usize::from(value == 0.0)].push([row, column]);
            }
        }
    }
    let ones = plane.iter().filter(|v| **v != 0.0).count();
    assert_eq!(ones, found[0].len(), "beside the nodes there must be zeros");
    found
}

/// Every node of a whole sheet takes part, whatever its size.
#[test]
fn a_whole_sheet_has_all_its_nodes() {
    for (rows, columns) in [(2, 2), (9, 9), (17, 31), (33, 33), (66, 47), (3, 97)] {
        for k in 1..5 {
            let [with, without] = nodes(rows, columns, k, |_, _| true);
            assert!(with.len() >= 4 && without.is_empty(), "{rows} x {columns}, level {k}: {without:?}");
        }
    }
}

/// The rim of a disc and that of a hole wider than a link cut nothing off: all nodes on cloth take part.
#[test]
fn rims_leave_nodes_alone() {
    let d2 = |row: usize, column: usize| row.abs_diff(32).pow(2) + column.abs_diff(32).pow(2);
    for k in 1..4 {
        let [with, without] = nodes(65, 65, k, |row, column| d2(row, column) <= 32 * 32);
        assert!(with.len() > 12 && without.is_empty(), "disc, level {k}: {without:?}");
        let [with, without] = nodes(65, 65, k, |row, column| d2(row, column) > 12 * 12);
        assert!(with.len() > 20 && without.is_empty(), "hole, level {k}: {without:?}");
    }
}

/// Beside a tear between two rows of nodes both rows are out; beside one on a row of nodes none is.
#[test]
fn a_tear_cuts_off_what_is_beside_it() {
    // level 2: a node at every fourth particle, so rows 3 and 4 of nodes are at 12 and 16
    for torn in [13, 14, 15] {
        let [_, without] = nodes(33, 33, 2, |row, _| row != torn);
        assert_eq!(without, (3..5).flat_map(|row| (0..9).map(move |column| [row, column])).collect::<Vec<_>>());
        let [_, without] = nodes(33, 33, 2, |_, column| column != torn);
        assert_eq!(without, (0..9).flat_map(|row| [[row, 3], [row, 4]]).collect::<Vec<_>>());
    }
    let [with, without] = nodes(33, 33, 2, |row, _| row != 16);
    assert_eq!((with.len(), without.len()), (72, 0));
    // along a diagonal of absent particles: what lies on the other side of its corners
    for (shift, beside) in [(0, [-1, 1].as_slice()), (2, &[-1, 0, 1, 2])] {
        let [_, without] = nodes(33, 33, 2, |row, column| row + shift != column);
        let wanted = (0..9i32).flat_map(|row| (0..9).map(move |column| [row, column]));
        let wanted = wanted.filter(|[row, column]| beside.contains(&(column - row)));
        assert_eq!(without, wanted.map(|node| node.map(|i| i as usize)).collect::<Vec<_>>(), "{shift}");
    }
}

/// A single hole cuts the ways that pass through it and no others; a thin piece between a tear and a hole is behind a gap too.
#[test]
fn what_is_behind_a_gap_counts_before_the_neighbour_is_reached() {
    let [_, without] = nodes(33, 33, 2, |row, column| (row, column) != (14, 16));
    assert_eq!(without, [[3, 4], [4, 4]]);
    let [_, without] = nodes(33, 33, 2, |row, column| (row, column) != (14, 14));
    assert_eq!(without, [[3, 3], [3, 4], [4, 3], [4, 4]]);
    // rows 14 and 15 hold together, between two gaps; the node at 16 is absent, that at 12 must not move them
    let [_, without] = nodes(33, 33, 2, |row, _| row != 13 && row != 16);
    assert_eq!(without, (0..9).map(|column| [3, column]).collect::<Vec<_>>());
}
