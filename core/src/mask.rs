//! Absent particles: a disc, a hole, a torn edge.
//!
//! An absent particle has no mass and no springs, like a spare place of the layout: the kernels need not know of it, and a
//! cloth without the feature pays nothing. A spring needs both its ends; a bend spring also the particle in its middle, and a
//! diagonal at least one of the two other corners of its cell: else it would reach across a gap. A cell with three corners is
//! a triangle, which is how a torn edge looks.

use crate::layout::{read, span, write};
use crate::{Cloth, Error, Hash64};

/// Whether a particle is absent; `mask` is empty without the feature.
#[inline(always)]
pub(crate) fn is_absent(mask: &[f32], at: usize) -> bool {
    !mask.is_empty() && read(mask, at) == 0.0
}

/// Whether a spring is cut by absent particles. `plane` as in the budget's `each_spring`: along u, along v, to the lower
/// right, to the lower left, bend along u, bend along v; `stride` is the way to the row below.
pub(crate) fn cuts(mask: &[f32], stride: usize, at: usize, other: usize, plane: usize) -> bool {
    if mask.is_empty() {
        return false;
    }
    let absent = |at: usize| read(mask, at) == 0.0;
    let between = match plane {
        2 => absent(at + 1) && absent(at + stride),
        3 => absent(at - 1) && absent(at + stride),
        4 => absent(at + 1),
        5 => absent(at + stride),
        _ => false,
    };
    absent(at) || absent(other) || between
}

impl Cloth<'_> {
    /// Chooses which particles exist, a number for each: 0 is absent, everything else is present. At first all are present.
    /// May be called at any time, so a cloth can tear.
    ///
    /// An absent particle has no springs, no weight and no pin, and is left out of strain and energy; its position can
    /// be read and stays where it last was. One that comes back is there at rest, so put it in its place first
    /// ([`Cloth::set_position`]). The present ones keep their share of the sheet's mass. The mask is a parameter as the
    /// stiffness is: [`Cloth::reset`] keeps it and a snapshot does not hold it, but a snapshot that was taken under
    /// another mask is [`Error::Foreign`].
    ///
    /// Errors: [`Error::FeatureOff`] without [`crate::Features::MASK`], [`Error::Shape`] (not one number a particle).
    pub fn set_mask(&mut self, present: &[u8]) -> Result<(), Error> {
        let l = self.layout;
        if !l.mask {
            return Err(Error::FeatureOff);
        }
        if present.len() != self.grid.particles() {
            return Err(Error::Shape);
        }
        let mut changed = false;
        for (particle, there) in present.iter().enumerate() {
            let at = l.place(particle)?;
            let value = if *there == 0 { 0.0 } else { 1.0 };
            if read(self.mask, at) != value {
                changed = true;
                write(self.mask, at, value);
                self.set_velocity_at(at, [0.0; 3]);
                for pull in &mut self.pull {
                    write(pull, at, 0.0);
                }
            }
        }
        if changed {
            let mask = &*self.mask;
            self.pins.keep(|particle| l.place(particle).is_ok_and(|at| !is_absent(mask, at)));
            self.stale = true;
            self.matter = self.digest_of_matter();
            self.wake();
        }
        Ok(())
    }

    /// Whether a particle exists. Error: [`Error::NoSuchParticle`].
    pub fn is_present(&self, particle: usize) -> Result<bool, Error> {
        Ok(!is_absent(self.mask, self.layout.place(particle)?))
    }

    /// Place of a particle that exists. Errors: [`Error::NoSuchParticle`], [`Error::Absent`].
    pub(crate) fn present_place(&self, particle: usize) -> Result<usize, Error> {
        let at = self.layout.place(particle)?;
        if is_absent(self.mask, at) { Err(Error::Absent) } else { Ok(at) }
    }

    /// Digest of mask and masses, 0 where both features are off.
    pub(crate) fn digest_of_matter(&self) -> u64 {
        let l = self.layout;
        if !l.mask && !l.mass {
            return 0;
        }
        let mut h = Hash64::new();
        for plane in [&*self.mask, &*self.masses] {
            for row in 0..l.rows {
                h.floats(span(plane, l.row(row), l.columns));
            }
        }
        h.finish()
    }
}
