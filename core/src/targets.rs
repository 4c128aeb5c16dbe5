//! Largest distance and backstop to skinned targets of the particles.

use crate::force::Substep;
use crate::layout::{Layout, take};
use crate::{Cloth, Error};

/// The targets of a cloth. All their numbers are state.
pub(crate) struct Targets<'a> {
    pub planes: &'a mut [f32],
}

impl<'a> Targets<'a> {
    /// f32 numbers that they need.
    pub fn numbers(l: &Layout) -> usize {
        if l.targets { 12 * l.plane } else { 0 }
    }

    pub fn new(l: &Layout, block: &mut &'a mut [f32]) -> Result<Self, Error> {
        Ok(Targets { planes: take(block, Self::numbers(l))? })
    }
}

impl Cloth<'_> {
    /// Keeps the particles within their distance of the targets as they are at `share` (0 to 1) of the frame.
    pub(crate) fn apply_targets(&mut self, _c: &Substep, _share: f32) {}

    /// The next frame starts where this one ended; after a frame that was taken back (`finite` false), where it began.
    pub(crate) fn finish_targets(&mut self, _finite: bool) {}
}
