//! The strain limit on levels: on every 2^k-th particle first, then on ever finer sheets, each starting from what the
//! coarser one found. Distances then settle in a number of sweeps that does not grow with the grid (multigrid; for position
//! based dynamics Mueller 2008).
//!
//! After each substep, from the coarsest level to the finest: tethers to the two nearest pins, then sweeps of one-sided
//! limits on the structural and diagonal links of that level; the displacement is handed down bilinearly. A limit holds for
//! the chord between two particles, so that folds are free.

use crate::aim::KEPT_WELL;
use crate::force::Substep;
use crate::layout::{Layout, copy, read, span, take, write};
use crate::limit::{Reach, Sheet, Sweeps};
use crate::mask::is_absent;
use crate::math::round16;
use crate::prolong::Prolong;
use crate::simd::{Pass, Vector};
use crate::strain_limit::TARGET;
use crate::tethers::{Pull, Tethers};
use crate::{Cloth, Error, node_mask, simd};

/// Sweeps of a coarse level: where cycles are repeated until the limit is kept, and where their number is given.
const COARSE_SWEEPS: u32 = 4;
const COARSE_SWEEPS_GIVEN: u32 = 3;

/// Most cycles of a substep. More than a few are needed only where pins move by several cells in a substep.
pub(crate) const MOST_CYCLES: u32 = 32;

/// Rounds, sweeps of each and rows around for what a cycle leaves.
const LOCAL_ROUNDS: u32 = 2;
const LOCAL_SWEEPS: u32 = 4;
const MARGIN: usize = 6;

/// Most levels, the finest included.
const MOST_LEVELS: usize = 13;

/// Every `span`-th particle along u and v, and the last one of each row and column; the one before the last is left out where
/// less than half a span would stay between the two: what so short a cell needs is no coarse matter, and handed down along
/// the long one beside it, it keeps a sheet from ever resting.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Level {
    /// Particles of the cloth along u and v, less one.
    last: [usize; 2],
    pub span: [usize; 2],
    /// Nodes along u and v.
    pub size: [usize; 2],
}

impl Level {
    /// The level `k` of a cloth; level 0 is the cloth itself. Each direction is coarsened as long as 4 links remain.
    pub fn new(l: &Layout, k: u32) -> Level {
        let last = [l.columns.saturating_sub(1), l.rows.saturating_sub(1)];
        let span = last.map(|n| {
            let mut span = 1usize;
            for _ in 0..k {
                if n >= 8 * span {
                    span *= 2;
                }
            }
            span
        });
        let nodes = |d: usize| {
            let (n, s) = (last.get(d).copied().unwrap_or(1), span.get(d).copied().unwrap_or(1).max(1));
            // to the nearest number of spans
            (n + s / 2) / s + 1
        };
        Level { last, span, size: [nodes(0), nodes(1)] }
    }

    /// All levels and how many they are, the finest first.
    fn all(l: &Layout) -> ([Level; MOST_LEVELS], usize) {
        let mut levels = [Level::default(); MOST_LEVELS];
        let (mut count, mut former) = (0, Level::default());
        for (k, level) in levels.iter_mut().enumerate() {
            *level = Level::new(l, k as u32);
            if *level == former {
                break;
            }
            (count, former) = (count + 1, *level);
        }
        (levels, count)
    }

    /// Numbers of a row of nodes in memory: whole vectors.
    pub fn stride(&self) -> usize {
        let [u, _] = self.size;
        round16(u)
    }

    /// Numbers of a plane of nodes, with the places beyond the last row that vectors touch.
    fn plane(&self) -> usize {
        let [_, v] = self.size;
        self.stride() * v + 32
    }

    /// Particle of a node along u (`d` 0) or v (1).
    pub fn particle(&self, d: usize, node: usize) -> usize {
        let (s, n) = (self.span.get(d).copied().unwrap_or(1), self.last.get(d).copied().unwrap_or(0));
        if node + 1 >= self.size.get(d).copied().unwrap_or(2) { n } else { node * s }
    }

    /// The node before a particle and the share of the next one.
    pub fn before(&self, d: usize, particle: usize) -> (usize, f32) {
        let (s, size) = (self.span.get(d).copied().unwrap_or(1).max(1), self.size.get(d).copied().unwrap_or(2));
        // a span is a power of two, and a division would cost more than all else here
        let node = (particle >> s.trailing_zeros()).min(size.saturating_sub(2));
        let (a, b) = (self.particle(d, node), self.particle(d, node + 1));
        (node, particle.saturating_sub(a) as f32 / b.saturating_sub(a).max(1) as f32)
    }

    fn last_span(&self) -> [usize; 2] {
        [0, 1].map(|d| {
            let size = self.size.get(d).copied().unwrap_or(2);
            self.particle(d, size - 1) - self.particle(d, size.saturating_sub(2))
        })
    }
}

/// The memory of the coarse levels, the finest of them first.
pub(crate) struct Levels<'a> {
    pub numbers: &'a mut [f32],
}

impl<'a> Levels<'a> {
    /// f32 numbers that they need.
    pub fn numbers(l: &Layout) -> usize {
        let (levels, count) = Level::all(l);
        let coarse = levels.iter().take(count).skip(1);
        if l.levels { coarse.map(|level| Nodes::numbers(level.plane(), l.mask)).sum() } else { 0 }
    }

    pub fn new(l: &Layout, block: &mut &'a mut [f32]) -> Result<Self, Error> {
        Ok(Levels { numbers: take(block, Self::numbers(l))? })
    }
}

/// The planes of a coarse level.
struct Nodes<'n> {
    /// Where the particles of the nodes are.
    from: [&'n mut [f32]; 3],
    /// Positions, and once the level is settled the ways from `from` to there.
    x: [&'n mut [f32]; 3],
    inverse: &'n mut [f32],
    tethers: Tethers<'n>,
    /// 1 for the nodes that take part, 0 for the others ([`node_mask`]); empty without masks.
    mask: &'n mut [f32],
}

impl<'n> Nodes<'n> {
    fn numbers(plane: usize, mask: bool) -> usize {
        7 * plane + Tethers::numbers(plane) + if mask { plane } else { 0 }
    }

    /// Takes the planes of a level off the memory of the levels.
    fn take(rest: &mut &'n mut [f32], plane: usize, mask: bool) -> Result<Self, Error> {
        Ok(Nodes {
            from: [take(rest, plane)?, take(rest, plane)?, take(rest, plane)?],
            x: [take(rest, plane)?, take(rest, plane)?, take(rest, plane)?],
            inverse: take(rest, plane)?,
            tethers: Tethers::new(plane, rest)?,
            mask: take(rest, if mask { plane } else { 0 })?,
        })
    }

    /// The nodes of all coarse levels; the first place, that of the cloth itself, stays empty.
    fn all(numbers: &'n mut [f32], levels: &[Level], mask: bool) -> [Option<Nodes<'n>>; MOST_LEVELS] {
        let (mut nodes, mut rest) = ([const { None }; MOST_LEVELS], numbers);
        for (nodes, level) in nodes.iter_mut().zip(levels).skip(1) {
            *nodes = Nodes::take(&mut rest, level.plane(), mask).ok();
        }
        nodes
    }
}

/// Copies of a plane what a coarser level has of it: every number of every row or every second one, and the last.
fn thin(from: &[f32], first: usize, stride: usize, fine: &Level, to: &mut [f32], coarse: &Level) {
    let ([columns, rows], [nodes, node_rows]) = (fine.size, coarse.size);
    let step = if columns == nodes { 1 } else { 2 };
    for (row, to) in to.chunks_exact_mut(coarse.stride().max(1)).enumerate().take(node_rows) {
        let last = row + 1 == node_rows;
        let row = if last {
            rows.saturating_sub(1)
        } else if rows == node_rows {
            row
        } else {
            2 * row
        };
        let from = span(from, first + row * stride, columns);
        if step == 1 {
            copy(to, from);
        } else {
            let ((pairs, rest), (ends, _)) = (from.as_chunks::<16>(), to.as_chunks_mut::<8>());
            for (to, from) in ends.iter_mut().zip(pairs) {
                let (from, _) = from.as_chunks::<2>();
                for (to, [from, _]) in to.iter_mut().zip(from) {
                    *to = *from;
                }
            }
            for (to, from) in to.iter_mut().skip(pairs.len() * 8).zip(rest.iter().step_by(2)) {
                *to = *from;
            }
        }
        if let Some(last) = from.last() {
            write(to, nodes.saturating_sub(1), *last);
            // a node more than there are may have been written
            write(to, nodes, 0.0);
        }
    }
}

/// Takes the numbers of some planes off those of others.
struct TakeOff<'t> {
    from: [&'t mut [f32]; 3],
    other: [&'t [f32]; 3],
}

impl Pass for TakeOff<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self, zero: V) {
        for (from, other) in self.from.into_iter().zip(self.other) {
            let mut at = 0;
            while at < from.len() {
                (zero.read(from, at) - zero.read(other, at)).write(from, at);
                at += V::LANES;
            }
        }
    }
}

impl Cloth<'_> {
    /// Gives the nodes of the coarse levels the masses and tethers of their particles; called when pins or mask have changed.
    pub(crate) fn attach_nodes(&mut self) {
        let l = self.layout;
        if !l.levels {
            return;
        }
        let (levels, count) = Level::all(&l);
        let levels = levels.get(..count).unwrap_or(&[]);
        for (nodes, level) in Nodes::all(self.levels.numbers, levels, l.mask).into_iter().zip(levels) {
            let Some(mut nodes) = nodes else {
                continue;
            };
            let [columns, rows] = level.size;
            for length in &mut nodes.tethers.length {
                length.fill(f32::INFINITY);
            }
            node_mask::write_nodes(&l, level, self.mask, nodes.mask);
            for row in 0..rows {
                for column in 0..columns {
                    let at = l.at(level.particle(1, row), level.particle(0, column));
                    let node = row * level.stride() + column;
                    if is_absent(nodes.mask, node) {
                        write(nodes.inverse, node, 0.0);
                        continue;
                    }
                    write(nodes.inverse, node, read(self.inverse, at));
                    let pins = nodes.tethers.pin.iter_mut().zip(&self.tethers.pin);
                    let lengths = nodes.tethers.length.iter_mut().zip(&self.tethers.length);
                    for (to, from) in pins.chain(lengths) {
                        write(to, node, read(from, at));
                    }
                }
            }
            nodes.tethers.find_common();
        }
    }

    /// Cycles from coarse to fine: as many as the definition gives, or until no structural link is longer than its limit, at
    /// most [`MOST_CYCLES`].
    pub(crate) fn apply_levels(&mut self, c: &Substep) {
        let aim = self.aim.share();
        // only where a cycle would move nothing it is left out: a threshold above that would kick
        if self.is_within(c, aim, true) && self.tethers_are_slack() {
            self.aim.learn(0, || true, c.dt);
            return;
        }
        let (levels, count) = Level::all(&self.layout);
        let levels = levels.get(..count).unwrap_or(&[]);
        if count < 2 {
            self.begin_limits();
        }
        let numbers = core::mem::take(&mut self.levels.numbers);
        let mut nodes = Nodes::all(numbers, levels, self.layout.mask);
        let (given, mut cycles) = (self.def.level_cycles, 0);
        while cycles < if given > 0 { given } else { MOST_CYCLES } {
            // what the first cycle cannot settle is aimed at from farther below, where the limit is to be kept
            let target = if given > 0 || cycles == 0 { aim } else { 0.5 * TARGET };
            self.cycle(c, target, levels, &mut nodes, cycles == 0);
            cycles += 1;
            if given == 0 && self.sweep_what_is_left(c, target) {
                break;
            }
        }
        self.levels.numbers = numbers;
        let mut aim = self.aim;
        aim.learn(cycles, || self.is_within(c, KEPT_WELL, false), c.dt);
        self.aim = aim;
        self.finish_limits(c);
    }

    /// Sweeps over the rows around those with a structural link beyond its limit, since what a cycle leaves is near the
    /// pins. Whether none is left.
    fn sweep_what_is_left(&mut self, c: &Substep, target: f32) -> bool {
        let (_, end) = self.rows();
        let mut long = self.long_rows(c, self.rows());
        for _ in 0..LOCAL_ROUNDS {
            let Some((first, last)) = long else {
                break;
            };
            // an even row, so that the pairs are those of the whole cloth
            let first = first.saturating_sub(MARGIN) & !1;
            let last = (last + 1 + MARGIN).min(end);
            self.sweep_rows(c, target, (first, last), LOCAL_SWEEPS);
            // those below the last row may have been moved away from
            long = self.long_rows(c, (first.saturating_sub(1), (last + 1).min(end)));
        }
        long.is_none()
    }

    /// All levels once, the coarsest first. `first`: the positions before are kept, where there are coarse levels, on the
    /// way: a pass over memory less.
    fn cycle(
        &mut self,
        c: &Substep,
        target: f32,
        levels: &[Level],
        nodes: &mut [Option<Nodes<'_>>; MOST_LEVELS],
        first: bool,
    ) {
        self.gather_nodes(levels, nodes);
        for k in (1..levels.len()).rev() {
            let Some((nodes, coarser)) = nodes.split_at_mut_checked(k + 1) else {
                continue;
            };
            let (Some(level), Some(Some(nodes))) = (levels.get(k), nodes.last_mut()) else {
                continue;
            };
            for (x, from) in nodes.x.iter_mut().zip(&nodes.from) {
                copy(x, from);
            }
            if let (Some(coarse), Some(Some(above))) = (levels.get(k + 1), coarser.first()) {
                let prolong = Prolong {
                    fine: *level,
                    coarse: *coarse,
                    ways: above.x.each_ref().map(|p| &**p),
                    mask: above.mask,
                    x: nodes.x.each_mut().map(|p| &mut **p),
                    first: 0,
                    stride: level.stride(),
                    inverse: nodes.inverse,
                    keep: None,
                    scratch: self.carry,
                };
                simd::run(self.width, prolong);
            }
            let reach = self.reach(c, target, level.span, level.last_span());
            self.settle_nodes(level, nodes, reach);
        }
        if let (Some(fine), Some(coarse), Some(Some(nodes))) = (levels.first(), levels.get(1), nodes.get(1)) {
            let prolong = Prolong {
                fine: *fine,
                coarse: *coarse,
                ways: nodes.x.each_ref().map(|p| &**p),
                mask: nodes.mask,
                x: [&mut *self.x.x, &mut *self.x.y, &mut *self.x.z],
                first: self.layout.row(0),
                stride: self.layout.stride,
                inverse: self.inverse,
                keep: first.then(|| self.before.planes.each_mut().map(|p| &mut **p)),
                scratch: self.carry,
            };
            simd::run(self.width, prolong);
        }
        self.tether_particles();
        self.sweep_finest(c, target);
    }

    /// Fills the nodes of all levels with where their particles are, each level from the one below.
    fn gather_nodes(&self, levels: &[Level], nodes: &mut [Option<Nodes<'_>>; MOST_LEVELS]) {
        for k in 1..levels.len() {
            let Some((finer, nodes)) = nodes.split_at_mut_checked(k) else {
                continue;
            };
            let (Some(fine), Some(level), Some(Some(nodes))) = (levels.get(k - 1), levels.get(k), nodes.first_mut())
            else {
                continue;
            };
            let (x, first, stride) = match finer.last() {
                Some(Some(finer)) => (finer.from.each_ref().map(|p| &**p), 0, fine.stride()),
                _ => ([&*self.x.x, &*self.x.y, &*self.x.z], self.layout.row(0), self.layout.stride),
            };
            for (to, from) in nodes.from.iter_mut().zip(x) {
                thin(from, first, stride, fine, to, level);
            }
        }
    }

    /// Tethers and sweeps of a coarse level; then its positions are made to ways.
    fn settle_nodes(&self, level: &Level, nodes: &mut Nodes<'_>, reach: Reach) {
        let [columns, rows] = level.size;
        let stride = level.stride();
        if self.pins.count > 0 {
            let pull = Pull {
                rows,
                columns,
                stride,
                first: 0,
                x: nodes.x.each_mut().map(|p| &mut **p),
                anchors: Some([&*self.x.x, &*self.x.y, &*self.x.z]),
                tethers: &nodes.tethers,
                velocity: None,
                look: false,
            };
            simd::run(self.width, pull);
        }
        let sheet = Sheet {
            rows,
            columns,
            stride,
            first: 0,
            x: nodes.x.each_mut().map(|p| &mut **p),
            inverse: nodes.inverse,
            mask: nodes.mask,
            reach,
        };
        let sweeps = if self.def.level_cycles == 0 { COARSE_SWEEPS } else { COARSE_SWEEPS_GIVEN };
        simd::run(self.width, Sweeps { sheet, sweeps });
        let from = nodes.x.each_mut().map(|p| &mut **p);
        simd::run(self.width, TakeOff { from, other: nodes.from.each_ref().map(|p| &**p) });
    }
}

#[cfg(test)]
mod tests {
    extern crate std;

    use super::*;
    use crate::{ClothDef, Grid, GridDef};
    use std::vec::Vec;

    /// The nodes of a level are some of those of the next finer one, no cell at the end is shorter than half a span, and each
    /// particle is between the two nodes that it is told to be between.
    #[test]
    fn levels_are_nested_and_have_no_short_cells() {
        for columns in (2..=70).chain([89, 90, 97, 99, 100, 129, 255, 1000, 4096]) {
            let grid = Grid::new(&GridDef { rows: 2, columns, ..GridDef::default() }).unwrap();
            let l = Layout::new(&grid, &ClothDef::default());
            let (levels, count) = Level::all(&l);
            let nodes = |level: &Level| (0..level.size[0]).map(|i| level.particle(0, i)).collect::<Vec<_>>();
            let mut finer: Vec<usize> = (0..columns as usize).collect();
            for level in levels.iter().take(count) {
                let found = nodes(level);
                assert!(found.iter().all(|p| finer.contains(p)), "{columns}: {found:?} of {finer:?}");
                assert_eq!((found[0], *found.last().unwrap()), (0, columns as usize - 1));
                let ([last, _], [span, _]) = (level.last_span(), level.span);
                assert!(2 * last >= span && 2 * last < 3 * span.max(2), "{columns}: {found:?}");
                for particle in 0..columns as usize {
                    let (node, share) = level.before(0, particle);
                    let (from, to) = (found[node], found[node + 1]);
                    assert!(from <= particle && particle <= to);
                    assert_eq!(share, (particle - from) as f32 / (to - from) as f32);
                }
                finer = found;
            }
        }
    }
}
