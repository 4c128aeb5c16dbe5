//! A sheet at rest under its weight, before it was ever stepped: its springs in the plane of the cloth, solved on grids from
//! coarse to fine by dynamic relaxation with kinetic damping (Cundall 1976: the velocities are set to zero whenever the kinetic
//! energy has passed a peak).
//!
//! In the plane, since that is where the weight acts; out of it the cloth folds, which takes little load (docs/budget.md).
//! In two dimensions a lattice of twice the cell has the same spring constants, so every coarser grid takes them from the
//! finest as they are. It keeps displacements and not positions: a strain of 1e-6 is then as exact as one of 0.1.

use crate::force::Springs;
use crate::layout::{Layout, copy, read, span, write};
use crate::math::{max, sqrt};

/// Most iterations on a grid of n particles a side: so many, and [`PER_SIDE`] n.
const ITERATIONS: usize = 300;
const PER_SIDE: usize = 8;

/// A grid is done where the forces that are left are this share of a particle's weight, as root mean square.
const LEFT: f64 = 0.01;

/// What may be left on the finest grid when the iterations are used up.
const ENOUGH: f64 = 0.05;

/// The mass of a particle in the relaxation as a multiple of the stiffness at it. A step of 1 is stable while omega^2 <= 2 k / M
/// (budget.rs) is below 4; nearer to it the kinetic energy of the fastest modes has peaks of its own.
const MASS: f32 = 1.1;

/// A border of the grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Edge {
    FirstRow,
    LastRow,
    FirstColumn,
    LastColumn,
}

impl Edge {
    pub const ALL: [Edge; 4] = [Edge::FirstRow, Edge::LastRow, Edge::FirstColumn, Edge::LastColumn];

    /// Particles along it.
    pub fn len(self, rows: usize, columns: usize) -> usize {
        if matches!(self, Edge::FirstRow | Edge::LastRow) { columns } else { rows }
    }

    /// Row and column of its particle i.
    pub fn at(self, i: usize, rows: usize, columns: usize) -> (usize, usize) {
        match self {
            Edge::FirstRow => (0, i),
            Edge::LastRow => (rows.saturating_sub(1), i),
            Edge::FirstColumn => (i, 0),
            Edge::LastColumn => (i, columns.saturating_sub(1)),
        }
    }

    /// The direction from it into the sheet, along u and v.
    fn inwards(self) -> [f32; 2] {
        match self {
            Edge::FirstRow => [0.0, 1.0],
            Edge::LastRow => [0.0, -1.0],
            Edge::FirstColumn => [1.0, 0.0],
            Edge::LastColumn => [-1.0, 0.0],
        }
    }
}

/// A sheet that hangs from one of its edges.
pub(crate) struct Sheet<'a, 'b> {
    pub layout: &'a Layout,
    pub springs: &'a Springs<'b>,
    /// Rest lengths along u and v in m.
    pub cell: [f32; 2],
    /// Weight of the whole sheet in N.
    pub weight: f32,
    pub edge: Edge,
    /// Whether the whole edge is pinned, or its two corners.
    pub whole: bool,
}

/// Displacements, velocities and masses along u and v: six planes.
struct State<'a> {
    d: [&'a mut [f32]; 2],
    v: [&'a mut [f32]; 2],
    /// 1 over the mass along u and along v.
    mass: [&'a mut [f32]; 2],
}

/// A grid of the cascade.
#[derive(Clone, Copy)]
struct Level {
    rows: usize,
    columns: usize,
    cell: [f32; 2],
    /// Places of the finest grid in half a cell of this one, down and to the right.
    half: [f32; 2],
    finest: bool,
}

/// A spring: its ends, rest vector from a to b in m, N/m.
struct Spring {
    a: usize,
    b: usize,
    rest: [f32; 2],
    k: f32,
}

impl Sheet<'_, '_> {
    /// The largest strain of a structural spring at rest. None where it was not found, or where the scratch is shorter than six
    /// planes.
    pub fn largest_strain(&self, scratch: &mut [f32]) -> Option<f32> {
        let p = self.layout.plane;
        let (d0, rest) = scratch.split_at_mut_checked(p)?;
        let (d1, rest) = rest.split_at_mut_checked(p)?;
        let (v0, rest) = rest.split_at_mut_checked(p)?;
        let (v1, rest) = rest.split_at_mut_checked(p)?;
        let (m0, rest) = rest.split_at_mut_checked(p)?;
        let m1 = rest.get_mut(..p)?;
        let mut s = State { d: [d0, d1], v: [v0, v1], mass: [m0, m1] };
        for plane in s.d.iter_mut().chain(&mut s.v).chain(&mut s.mass) {
            plane.fill(0.0);
        }
        let mut halvings = 0;
        while self.level(halvings + 1).is_some() {
            halvings += 1;
        }
        let mut level = self.level(halvings)?;
        loop {
            let done = self.relax(&mut s, &level);
            if halvings == 0 {
                return if done { Some(self.largest(&s, &level)) } else { None };
            }
            halvings -= 1;
            let finer = self.level(halvings)?;
            self.prolong(&mut s, &level, &finer);
            level = finer;
        }
    }

    /// The grid after so many halvings, None where a side would have fewer than 4 particles.
    fn level(&self, halvings: u32) -> Option<Level> {
        let l = self.layout;
        let cells = [l.rows, l.columns].map(|n| n.saturating_sub(1).checked_shr(halvings).unwrap_or(0));
        let [rows, columns] = cells.map(|n| n + 1);
        if cells[0] == 0 || cells[1] == 0 || (halvings > 0 && (rows < 4 || columns < 4)) {
            return None;
        }
        let times = [(l.rows - 1) as f32 / cells[0] as f32, (l.columns - 1) as f32 / cells[1] as f32];
        let [u, v] = self.cell;
        Some(Level {
            rows,
            columns,
            cell: [u * times[1], v * times[0]],
            half: times.map(|t| 0.5 * t),
            finest: halvings == 0,
        })
    }

    fn is_pinned(&self, level: &Level, row: usize, column: usize) -> bool {
        let (m, n) = (level.rows, level.columns);
        let (along, last, on) = match self.edge {
            Edge::FirstRow => (column, n, row == 0),
            Edge::LastRow => (column, n, row + 1 == m),
            Edge::FirstColumn => (row, m, column == 0),
            Edge::LastColumn => (row, m, column + 1 == n),
        };
        on && (self.whole || along == 0 || along + 1 == last)
    }

    /// The stiffness of the spring of the finest grid that lies in the middle of one of this grid: `dr` and `dc` are the cells
    /// that it spans.
    #[inline(always)]
    fn k(&self, plane: &[f32], level: &Level, row: usize, column: usize, (dr, dc): (usize, usize)) -> f32 {
        let l = self.layout;
        if level.finest {
            return read(plane, l.at(row, column));
        }
        // the start of a spring of two cells is one before their middle
        let middle = |i: usize, d: usize, half: f32| (((2 * i + d) as f32 * half) as usize).saturating_sub(d / 2);
        let at = l.at(middle(row, dr, level.half[0]), middle(column, dc, level.half[1]));
        read(plane, at)
    }

    /// The springs that start in the cell right below a particle. Apart, so that it is in the program once.
    #[inline(never)]
    fn springs_from(&self, level: &Level, row: usize, column: usize) -> [Option<Spring>; 6] {
        let (l, s) = (self.layout, self.springs);
        let [u, v] = level.cell;
        let a = l.at(row, column);
        let (right, below) = (column + 1 < level.columns, row + 1 < level.rows);
        let (shear, two_right) = (l.shear && right && below, l.bend && column + 2 < level.columns);
        let two_below = l.bend && row + 2 < level.rows;
        let left = s.left.get(1..).unwrap_or(&[]);
        let spring = |on: bool, a: usize, b: usize, rest: [f32; 2], plane: &[f32], cells: (usize, usize)| {
            on.then(|| Spring { a, b, rest, k: self.k(plane, level, row, column, cells) })
        };
        [
            spring(right, a, a + 1, [u, 0.0], s.u, (0, 1)),
            spring(below, a, a + l.stride, [0.0, v], s.v, (1, 0)),
            spring(shear, a, a + l.stride + 1, [u, v], s.right, (1, 1)),
            spring(shear, a + 1, a + l.stride, [-u, v], left, (1, 1)),
            spring(two_right, a, a + 2, [2.0 * u, 0.0], s.bend_u, (0, 2)),
            spring(two_below, a, a + 2 * l.stride, [0.0, 2.0 * v], s.bend_v, (2, 0)),
        ]
    }

    /// Dynamic relaxation with a step of 1. Whether it came to rest.
    fn relax(&self, s: &mut State<'_>, level: &Level) -> bool {
        let (m, n) = (level.rows, level.columns);
        let share = self.weight / (m * n) as f32;
        let weight = self.edge.inwards().map(|e| e * share);
        let weight2 = f64::from(share) * f64::from(share) * (m * n) as f64;
        let mut last2 = f64::INFINITY;
        // a coarse grid is cheap, and what it leaves undone is slow on a fine one
        let most = (ITERATIONS + PER_SIDE * m.max(n)) * if level.finest { 1 } else { 2 };
        // zero when it has just been stopped
        let mut former = 0.0f64;
        for _ in 0..most {
            if former == 0.0 {
                self.weigh(s, level);
            }
            self.accelerate(s, level, weight);
            let (mut energy, force2) = self.energy(s, level);
            if former == 0.0 {
                if force2 <= LEFT * LEFT * weight2 {
                    return true;
                }
                last2 = force2;
                // the first half of a step: a whole one would be a descent, which is stable only below omega^2 = 2
                for v in s.v.iter_mut().flat_map(|v| v.iter_mut()) {
                    *v *= 0.5;
                }
                energy *= 0.25;
            }
            if energy < former {
                s.v[0].fill(0.0);
                s.v[1].fill(0.0);
                former = 0.0;
                continue;
            }
            former = energy;
            for (d, v) in s.d.iter_mut().zip(&s.v) {
                for row in 0..m {
                    let at = self.layout.row(row);
                    let d = d.get_mut(at..at + n).unwrap_or(&mut []);
                    for (d, v) in d.iter_mut().zip(span(v, at, n)) {
                        *d += v;
                    }
                }
            }
        }
        last2 <= ENOUGH * ENOUGH * weight2
    }

    /// The masses of the relaxation along u and v: [`MASS`] of the sum of k (|n_u|^2 + |n_u n_v|), and that of v alike, over
    /// the springs as they lie now, since n n^T is at most that diagonal matrix; a stretched spring also resists across.
    fn weigh(&self, s: &mut State<'_>, level: &Level) {
        for plane in &mut s.mass {
            plane.fill(0.0);
        }
        for row in 0..level.rows {
            for column in 0..level.columns {
                for spring in self.springs_from(level, row, column).into_iter().flatten() {
                    let p = pull(&s.d, &spring);
                    let k = MASS * spring.k;
                    let [u, v] = p.direction.map(f32::abs);
                    let across = max(p.strain, 0.0);
                    for (mass, k) in s.mass.iter_mut().zip([k * (u * u + u * v + across), k * (v * v + u * v + across)])
                    {
                        add(mass, spring.a, k);
                        add(mass, spring.b, k);
                    }
                }
            }
        }
        // nobody moves a pinned particle
        for row in 0..level.rows {
            for column in 0..level.columns {
                let at = self.layout.at(row, column);
                for mass in &mut s.mass {
                    let kg =
                        if self.is_pinned(level, row, column) { f32::INFINITY } else { max(read(mass, at), 1e-30) };
                    write(mass, at, 1.0 / kg);
                }
            }
        }
    }

    /// Adds forces over masses to the velocities.
    fn accelerate(&self, s: &mut State<'_>, level: &Level, weight: [f32; 2]) {
        let State { d, v: [vu, vv], mass: [iu, iv] } = s;
        for row in 0..level.rows {
            for column in 0..level.columns {
                let at = self.layout.at(row, column);
                add(vu, at, weight[0] * read(iu, at));
                add(vv, at, weight[1] * read(iv, at));
                for spring in self.springs_from(level, row, column).into_iter().flatten() {
                    let p = pull(d, &spring);
                    let [u, v] = [p.force * p.direction[0], p.force * p.direction[1]];
                    add(vu, spring.a, u * read(iu, spring.a));
                    add(vu, spring.b, -u * read(iu, spring.b));
                    add(vv, spring.a, v * read(iv, spring.a));
                    add(vv, spring.b, -v * read(iv, spring.b));
                }
            }
        }
    }

    /// Twice the kinetic energy, and the sum of the squared momenta, which are the forces where it starts from rest.
    fn energy(&self, s: &State<'_>, level: &Level) -> (f64, f64) {
        let (mut energy, mut force2) = (0.0f64, 0.0f64);
        for (v, inverse) in s.v.iter().zip(&s.mass) {
            for row in 0..level.rows {
                let at = self.layout.row(row);
                for (v, w) in span(v, at, level.columns).iter().zip(span(inverse, at, level.columns)) {
                    let momentum = if *w > 0.0 { f64::from(*v) / f64::from(*w) } else { 0.0 };
                    energy += momentum * f64::from(*v);
                    force2 += momentum * momentum;
                }
            }
        }
        (energy, force2)
    }

    /// Displacements of the next finer grid, bilinearly. The velocities serve as a buffer and end as zeros.
    fn prolong(&self, s: &mut State<'_>, from: &Level, to: &Level) {
        let l = self.layout;
        let scale = |from: usize, to: usize| (from - 1) as f32 / max((to - 1) as f32, 1.0);
        let (down, across) = (scale(from.rows, to.rows), scale(from.columns, to.columns));
        for (d, v) in s.d.iter_mut().zip(&mut s.v) {
            for row in 0..to.rows {
                for column in 0..to.columns {
                    let (y, x) = (row as f32 * down, column as f32 * across);
                    let (r, c) = ((y as usize).min(from.rows - 2), (x as usize).min(from.columns - 2));
                    let (y, x) = (y - r as f32, x - c as f32);
                    let at = l.at(r, c);
                    let line = |at: usize| read(d, at) * (1.0 - x) + read(d, at + 1) * x;
                    let value = line(at) * (1.0 - y) + line(at + l.stride) * y;
                    write(v, l.at(row, column), value);
                }
            }
            copy(d, v);
        }
        for plane in &mut s.v {
            plane.fill(0.0);
        }
    }

    fn largest(&self, s: &State<'_>, level: &Level) -> f32 {
        let mut largest = 0.0;
        for row in 0..level.rows {
            for column in 0..level.columns {
                // the structural ones come first
                for spring in self.springs_from(level, row, column).into_iter().take(2).flatten() {
                    largest = max(pull(&s.d, &spring).strain, largest);
                }
            }
        }
        largest
    }
}

/// What a spring does.
struct Pull {
    /// Pull on its first end in N, along `direction`; below 0 it pushes.
    force: f32,
    /// From the first end to the other one.
    direction: [f32; 2],
    strain: f32,
}

/// With the rest vector r and the difference of the displacements d a spring is longer by (2 r.d + d.d) / (l + |r|), which
/// loses no digits where d is small. A compressed one pushes with at most k times its length, as in a step.
#[inline(always)]
fn pull(d: &[&mut [f32]; 2], spring: &Spring) -> Pull {
    let Spring { a, b, rest, k, .. } = *spring;
    let [du, dv] = [read(d[0], b) - read(d[0], a), read(d[1], b) - read(d[1], a)];
    let [u, v] = [rest[0] + du, rest[1] + dv];
    let length = sqrt(rest[0] * rest[0] + rest[1] * rest[1]);
    let now = max(sqrt(u * u + v * v), f32::MIN_POSITIVE);
    let longer = (2.0 * (rest[0] * du + rest[1] * dv) + du * du + dv * dv) / (now + length);
    Pull { force: k * max(longer, -now), direction: [u / now, v / now], strain: longer / length }
}

#[inline(always)]
fn add(plane: &mut [f32], at: usize, value: f32) {
    if let Some(p) = plane.get_mut(at) {
        *p += value;
    }
}
