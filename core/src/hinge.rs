//! Hinge bending.

use crate::Cloth;

impl Cloth<'_> {
    /// Adds the forces of the hinges in N to the planes of forces.
    pub(crate) fn add_hinges(&mut self) {}
}
