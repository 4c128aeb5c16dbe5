use crate::colliders::{Colliders, MAX_COLLIDERS};
use crate::implicit::Implicit;
use crate::levels::Levels;
use crate::strain_limit::Before;
use crate::targets::Targets;
use crate::tethers::Tethers;
use crate::{ClothDef, Error, Features, Grid, Solver, math::round16};

/// Numbers of a pin: index, from (3), to (3).
pub(crate) const PIN_NUMBERS: usize = 7;

/// Rows that the sweep hands on, whatever families there are.
pub(crate) const CARRY_ROWS: usize = 18;

/// Where things lie in the block. Every per-particle array is a plane of padded rows: `stride` numbers a row, two spare
/// rows above and below, at least 16 spare numbers between rows, so that a vector may read past any border. Spare
/// places hold zeros and have no mass; a spring to a spare place has stiffness 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Layout {
    pub rows: usize,
    pub columns: usize,
    /// Columns rounded up to 16: the numbers of a row that a step touches.
    pub width: usize,
    pub stride: usize,
    pub plane: usize,
    pub shear: bool,
    pub bend: bool,
    pub pull: bool,
    pub air: bool,
    pub hinge: bool,
    pub tethers: bool,
    pub strain_limit: bool,
    pub levels: bool,
    pub targets: bool,
    pub mass: bool,
    pub mask: bool,
    pub implicit: bool,
    pub bdf2: bool,
    pub max_pins: usize,
    pub max_colliders: usize,
}

impl Layout {
    pub fn new(grid: &Grid, def: &ClothDef) -> Layout {
        let (rows, columns) = (grid.rows(), grid.columns());
        let width = round16(columns);
        let stride = width + 16;
        let on = |f: Features| def.features.contains(f);
        Layout {
            rows,
            columns,
            width,
            stride,
            plane: stride * (rows + 4) + 32,
            shear: grid.has_shear(),
            bend: grid.has_bend(),
            pull: on(Features::PULL),
            air: on(Features::AIR),
            hinge: on(Features::HINGE),
            tethers: on(Features::TETHERS),
            strain_limit: on(Features::STRAIN_LIMIT),
            levels: on(Features::LEVELS),
            targets: on(Features::TARGETS),
            mass: on(Features::MASS),
            mask: on(Features::MASK),
            implicit: on(Features::IMPLICIT),
            bdf2: def.solver == Solver::Bdf2,
            // the default asks for more than a small grid has particles
            max_pins: (def.max_pins as usize).min(rows * columns),
            max_colliders: if on(Features::COLLIDERS) { MAX_COLLIDERS } else { 0 },
        }
    }

    /// Channels of the target field and planes of springs: 2 structural of each, then shear 1 and 2, bend 1 and 2.
    pub fn channels(&self) -> usize {
        2 + usize::from(self.shear) + usize::from(self.bend)
    }

    pub fn spring_planes(&self) -> usize {
        2 + 2 * usize::from(self.shear) + 2 * usize::from(self.bend)
    }

    /// Whether there are tethers; the levels need them too.
    pub fn has_tethers(&self) -> bool {
        self.tethers || self.levels
    }

    /// Whether there are forces beside springs, weight and pull.
    pub fn force(&self) -> bool {
        self.air || self.hinge || self.mass
    }

    /// Numbers of the rows of spring forces that the sweep hands on ([`crate::force`]): 3 of the springs along v, 9 of the
    /// diagonals, 6 of the bend springs along v.
    pub fn carry(&self) -> usize {
        self.stride * CARRY_ROWS
    }

    /// f32 numbers of the whole block.
    pub fn numbers(&self) -> usize {
        // positions 3, velocities 3, the last good state 6, 1/M 1
        let when = |on: bool, planes: usize| if on { planes } else { 0 };
        let planes = 13
            + self.channels()
            + self.spring_planes()
            + when(self.pull, 3)
            + when(self.force(), 3)
            + when(self.mass, 1)
            + when(self.mask, 1);
        planes * self.plane
            + round16(PIN_NUMBERS * self.max_pins)
            + Tethers::numbers(if self.has_tethers() { self.plane } else { 0 })
            + Before::numbers(self)
            + Levels::numbers(self)
            + Colliders::numbers(self)
            + Targets::numbers(self)
            + Implicit::numbers(self)
            + self.carry()
    }

    /// Place of column 0 of a row in a plane.
    #[inline(always)]
    pub fn row(&self, row: usize) -> usize {
        16 + (row + 2) * self.stride
    }

    /// The rows of a plane, without what is spare before and behind them.
    pub fn all_rows<'p>(&self, plane: &'p [f32]) -> &'p [f32] {
        plane.get(self.row(0)..self.row(self.rows)).unwrap_or(&[])
    }

    /// [`Layout::all_rows`], to be written.
    pub fn all_rows_mut<'p>(&self, plane: &'p mut [f32]) -> &'p mut [f32] {
        plane.get_mut(self.row(0)..self.row(self.rows)).unwrap_or(&mut [])
    }

    /// Place of a particle in a plane.
    #[inline(always)]
    pub fn at(&self, row: usize, column: usize) -> usize {
        self.row(row) + column
    }

    /// Place of the particle of an index. Error: [`Error::NoSuchParticle`].
    pub fn place(&self, particle: usize) -> Result<usize, Error> {
        if particle >= self.rows * self.columns {
            return Err(Error::NoSuchParticle);
        }
        // max: a grid has columns, but only so does the compiler know that nothing is divided by zero
        let columns = self.columns.max(1);
        Ok(self.at(particle / columns, particle % columns))
    }
}

/// Takes the first `n` numbers off a block.
pub(crate) fn take<'a>(block: &mut &'a mut [f32], n: usize) -> Result<&'a mut [f32], Error> {
    let (head, tail) = core::mem::take(block).split_at_mut_checked(n).ok_or(Error::BlockTooSmall)?;
    *block = tail;
    Ok(head)
}

/// Copies as many numbers as both have.
pub(crate) fn copy(to: &mut [f32], from: &[f32]) {
    for (to, from) in to.iter_mut().zip(from) {
        *to = *from;
    }
}

/// The numbers of a row of a plane, empty where the plane has no such row (a family that is off).
#[inline(always)]
pub(crate) fn span(plane: &[f32], at: usize, len: usize) -> &[f32] {
    plane.get(at..at.wrapping_add(len)).unwrap_or(&[])
}

/// `N` numbers of a plane from a place on.
#[inline(always)]
pub(crate) fn block<const N: usize>(plane: &[f32], at: usize) -> Option<&[f32; N]> {
    plane.get(at..)?.first_chunk()
}

/// The number at a place, 0 outside.
#[inline(always)]
pub(crate) fn read(plane: &[f32], at: usize) -> f32 {
    plane.get(at).copied().unwrap_or(0.0)
}

/// Writes the number at a place; nothing outside.
#[inline(always)]
pub(crate) fn write(plane: &mut [f32], at: usize, value: f32) {
    if let Some(p) = plane.get_mut(at) {
        *p = value;
    }
}
