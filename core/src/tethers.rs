//! Tethers (long-range attachments) to the nearest pins.

use crate::force::Substep;
use crate::layout::{Layout, take};
use crate::{Cloth, Error};

/// The tethers of a cloth.
pub(crate) struct Tethers<'a> {
    pub planes: &'a mut [f32],
}

impl<'a> Tethers<'a> {
    /// f32 numbers that they need.
    pub fn numbers(l: &Layout) -> usize {
        if l.tethers { 4 * l.plane } else { 0 }
    }

    pub fn new(l: &Layout, block: &mut &'a mut [f32]) -> Result<Self, Error> {
        Ok(Tethers { planes: take(block, Self::numbers(l))? })
    }
}

impl Cloth<'_> {
    /// Finds the tethers anew; called when the pins have changed.
    pub(crate) fn attach_tethers(&mut self) {}

    pub(crate) fn apply_tethers(&mut self, _c: &Substep) {}
}
