//! The strain limit (Provot 1995).

use crate::Cloth;
use crate::force::Substep;

impl Cloth<'_> {
    pub(crate) fn apply_strain_limit(&mut self, _c: &Substep) {}
}
