//! The strain limit on levels: on every 2^k-th particle first, then on ever finer sheets, each starting from what the
//! coarser one found. Distances then settle in a number of sweeps that does not grow with the grid (multigrid; for position
//! based dynamics Mueller 2008).
//!
//! After each substep, from the coarsest level to the finest: tethers to the two nearest pins, then sweeps of one-sided
//! limits on the structural and diagonal links of that level; the displacement is handed down bilinearly. A limit holds for
//! the chord between two particles, so that folds are free.

use crate::force::Substep;
use crate::layout::{Layout, read, take, write};
use crate::limit::Sheet;
use crate::math::lerp;
use crate::strain_limit::TARGET;
use crate::{Cloth, Error};

/// Sweeps of a coarse level.
const COARSE_SWEEPS: u32 = 4;

/// Most cycles of a substep. More than one is needed only where pins move by several cells in a substep.
const MOST_CYCLES: u32 = 32;
/// Cycles that aim at the usual share of the limit.
const GENTLE_CYCLES: u32 = 3;

/// Planes of a coarse level: positions and inverse masses. All coarse levels together have at most as many nodes as the
/// cloth has particles, since each halves at least one side.
const PLANES: usize = 4;

/// Every `span`-th particle along u and v, and the last one of each row and column.
#[derive(Clone, Copy, Debug, PartialEq)]
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
            n.div_ceil(s) + 1
        };
        Level { last, span, size: [nodes(0), nodes(1)] }
    }

    /// Number of levels, the finest included.
    pub fn count(l: &Layout) -> u32 {
        let mut k = 0;
        while k < 12 && Level::new(l, k + 1) != Level::new(l, k) {
            k += 1;
        }
        k + 1
    }

    pub fn nodes(&self) -> usize {
        let [u, v] = self.size;
        u * v
    }

    /// Particle of a node along u (`d` 0) or v (1).
    fn particle(&self, d: usize, node: usize) -> usize {
        let (s, n) = (self.span.get(d).copied().unwrap_or(1), self.last.get(d).copied().unwrap_or(0));
        (node * s).min(n)
    }

    /// The node before a particle and the share of the next one.
    fn before(&self, d: usize, particle: usize) -> (usize, f32) {
        let (s, size) = (self.span.get(d).copied().unwrap_or(1).max(1), self.size.get(d).copied().unwrap_or(2));
        let node = (particle / s).min(size.saturating_sub(2));
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
        if l.levels { PLANES * l.plane } else { 0 }
    }

    pub fn new(l: &Layout, block: &mut &'a mut [f32]) -> Result<Self, Error> {
        Ok(Levels { numbers: take(block, Self::numbers(l))? })
    }
}

/// The planes of a coarse level: positions, and once it is settled the ways from where its particles are to there.
struct Nodes<'n> {
    x: [&'n mut [f32]; 3],
    inverse: &'n mut [f32],
}

impl<'n> Nodes<'n> {
    /// Takes the planes of a level off the memory of the levels.
    fn take(rest: &mut &'n mut [f32], nodes: usize) -> Result<Self, Error> {
        Ok(Nodes { x: [take(rest, nodes)?, take(rest, nodes)?, take(rest, nodes)?], inverse: take(rest, nodes)? })
    }

    /// The way at a particle, bilinearly between the nodes around it.
    fn way(&self, level: &Level, row: usize, column: usize) -> [f32; 3] {
        let [columns, _] = level.size;
        let ((u, share_u), (v, share_v)) = (level.before(0, column), level.before(1, row));
        let node = v * columns + u;
        self.x.each_ref().map(|plane| {
            let top = lerp(read(plane, node), read(plane, node + 1), share_u);
            let bottom = lerp(read(plane, node + columns), read(plane, node + columns + 1), share_u);
            lerp(top, bottom, share_v)
        })
    }
}

impl Cloth<'_> {
    /// Cycles from coarse to fine until no structural link is longer than its limit, at most [`MOST_CYCLES`].
    pub(crate) fn apply_levels(&mut self, c: &Substep) {
        // only where a cycle would move nothing it is left out: a threshold above that would kick
        if self.within_limits(c, TARGET) && self.diagonals_within(c) && self.tethers_are_slack() {
            return;
        }
        self.begin_limits();
        for i in 0..MOST_CYCLES {
            // what the first cycles cannot settle is aimed at from farther below
            let target = if i < GENTLE_CYCLES { TARGET } else { 0.5 * TARGET };
            self.cycle(c, target);
            if self.within_limits(c, 1.0) {
                break;
            }
        }
        self.finish_limits(c);
    }

    /// All levels once, the coarsest first.
    fn cycle(&mut self, c: &Substep, target: f32) {
        // a chord across a hole says nothing about the cloth around it
        let count = if self.layout.mask { 1 } else { Level::count(&self.layout) };
        let numbers = core::mem::take(&mut self.levels.numbers);
        for k in (1..count).rev() {
            let (level, coarser) = (Level::new(&self.layout, k), Level::new(&self.layout, k + 1));
            let finer: usize = (1..k).map(|k| PLANES * Level::new(&self.layout, k).nodes()).sum();
            let mut rest = numbers.get_mut(finer..).unwrap_or(&mut []);
            let Ok(mut nodes) = Nodes::take(&mut rest, level.nodes()) else {
                break;
            };
            let above = if k + 1 < count { Nodes::take(&mut rest, coarser.nodes()).ok() } else { None };
            self.gather_nodes(&level, &mut nodes, above.as_ref().map(|n| (n, &coarser)));
            self.tether_nodes(&level, &mut nodes);
            let [columns, rows] = level.size;
            let mut sheet = Sheet {
                rows,
                columns,
                stride: columns,
                first: 0,
                x: nodes.x.each_mut().map(|p| &mut **p),
                inverse: nodes.inverse,
                mask: &[],
                reach: self.reach(c, target, level.span, level.last_span()),
            };
            sheet.sweep(COARSE_SWEEPS);
            self.leave_the_ways(&level, &mut nodes);
            if k == 1 {
                self.hand_down(&level, &nodes);
            }
        }
        self.levels.numbers = numbers;
        self.tether_particles();
        self.sweep_finest(c, target, self.def.strain_passes);
    }

    /// Fills the nodes of a level: where their particles are, moved by what the coarser level found.
    fn gather_nodes(&self, level: &Level, nodes: &mut Nodes<'_>, above: Option<(&Nodes<'_>, &Level)>) {
        let [columns, rows] = level.size;
        for node_row in 0..rows {
            let row = level.particle(1, node_row);
            for node_column in 0..columns {
                let column = level.particle(0, node_column);
                let (at, node) = (self.layout.at(row, column), node_row * columns + node_column);
                let inverse = read(self.inverse, at);
                let [x, y, z] = self.local(at);
                let mut moved = [x, y, z];
                if let Some((above, coarser)) = above
                    && inverse > 0.0
                {
                    let d = above.way(coarser, row, column);
                    moved = [x + d[0], y + d[1], z + d[2]];
                }
                for (x, m) in nodes.x.iter_mut().zip(moved) {
                    write(x, node, m);
                }
                write(nodes.inverse, node, inverse);
            }
        }
    }

    fn tether_nodes(&self, level: &Level, nodes: &mut Nodes<'_>) {
        if self.pins.count == 0 {
            return;
        }
        let [columns, rows] = level.size;
        for node_row in 0..rows {
            let row = level.particle(1, node_row);
            for node_column in 0..columns {
                let (at, node) =
                    (self.layout.at(row, level.particle(0, node_column)), node_row * columns + node_column);
                if read(nodes.inverse, node) > 0.0 {
                    let [x, y, z] = &nodes.x;
                    let moved = self.tethered(at, [read(x, node), read(y, node), read(z, node)]);
                    for (x, m) in nodes.x.iter_mut().zip(moved) {
                        write(x, node, m);
                    }
                }
            }
        }
    }

    /// Takes off the nodes where their particles are.
    fn leave_the_ways(&self, level: &Level, nodes: &mut Nodes<'_>) {
        let [columns, rows] = level.size;
        for v in 0..rows {
            for u in 0..columns {
                let here = self.local(self.layout.at(level.particle(1, v), level.particle(0, u)));
                for (plane, here) in nodes.x.iter_mut().zip(here) {
                    let node = v * columns + u;
                    let way = read(plane, node) - here;
                    write(plane, node, way);
                }
            }
        }
    }

    /// Moves all particles by the ways of the first coarse level.
    fn hand_down(&mut self, level: &Level, nodes: &Nodes<'_>) {
        let l = self.layout;
        for row in 0..l.rows {
            for column in 0..l.columns {
                let at = l.at(row, column);
                if read(self.inverse, at) > 0.0 {
                    let ([x, y, z], [dx, dy, dz]) = (self.local(at), nodes.way(level, row, column));
                    self.set_position_at(at, [x + dx, y + dy, z + dz]);
                }
            }
        }
    }
}
