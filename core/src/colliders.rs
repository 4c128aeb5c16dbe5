//! Colliders: sphere, capsule, plane, box.

use crate::force::Substep;
use crate::layout::{Layout, take};
use crate::math::round16;
use crate::{Cloth, Error};

/// Most colliders of a cloth.
pub const MAX_COLLIDERS: usize = 32;

/// f32 numbers of a collider.
pub(crate) const COLLIDER_NUMBERS: usize = 32;

/// The colliders of a cloth. All their numbers are state.
pub(crate) struct Colliders<'a> {
    pub numbers: &'a mut [f32],
}

impl<'a> Colliders<'a> {
    /// f32 numbers that they need.
    pub fn numbers(l: &Layout) -> usize {
        round16(COLLIDER_NUMBERS * l.max_colliders)
    }

    pub fn new(l: &Layout, block: &mut &'a mut [f32]) -> Result<Self, Error> {
        Ok(Colliders { numbers: take(block, Self::numbers(l))? })
    }
}

impl Cloth<'_> {
    /// Moves the particles out of the colliders as they are at `share` (0 to 1) of the frame.
    pub(crate) fn apply_colliders(&mut self, _c: &Substep, _share: f32) {}

    /// The next frame starts where this one ended; after a frame that was taken back (`finite` false), where it began.
    pub(crate) fn finish_colliders(&mut self, _finite: bool) {}
}
