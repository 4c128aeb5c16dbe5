//! The strain limit on levels, from coarse to fine.

use crate::force::Substep;
use crate::layout::{Layout, take};
use crate::{Cloth, Error};

/// The memory of the levels.
pub(crate) struct Levels<'a> {
    pub numbers: &'a mut [f32],
}

impl<'a> Levels<'a> {
    /// f32 numbers that they need.
    pub fn numbers(l: &Layout) -> usize {
        if l.levels { 3 * l.plane } else { 0 }
    }

    pub fn new(l: &Layout, block: &mut &'a mut [f32]) -> Result<Self, Error> {
        Ok(Levels { numbers: take(block, Self::numbers(l))? })
    }
}

impl Cloth<'_> {
    /// Called when the pins have changed.
    pub(crate) fn prepare_levels(&mut self) {}

    pub(crate) fn apply_levels(&mut self, _c: &Substep) {}
}
