//! A mass of its own for each particle.
//!
//! The mass m_i is in the weight m_i g, in the inertial mass M_i = q_i m_i (so in the kinetic energy and in the budget:
//! omega^2 <= sum of k / M_i) and nowhere else: a stiff spring at a light particle is cut for the light one, whatever the
//! other end weighs.

use crate::layout::{Layout, read, span, write};
use crate::{Cloth, ClothDef, Error, Grid};

/// What the inertia and the budget are made from.
pub(crate) struct Body<'a> {
    pub grid: &'a Grid,
    pub def: &'a ClothDef,
    pub layout: &'a Layout,
    /// Mass of each particle in kg, where they have none of their own.
    pub mass: f32,
    /// Masses in kg, or empty.
    pub masses: &'a [f32],
    /// 0 for absent particles, or empty.
    pub mask: &'a [f32],
    /// Factors of the rest lengths along u, along v, along the diagonals.
    pub rest_scale: [f32; 3],
}

impl Body<'_> {
    /// Mass of the particle at a place in kg.
    pub fn mass_at(&self, at: usize) -> f32 {
        if self.masses.is_empty() { self.mass } else { read(self.masses, at) }
    }
}

impl Cloth<'_> {
    /// Sets the mass of each particle in kg, 1e-6 to 1e6 times its share of the sheet's ([`Cloth::particle_mass_kg`]), which
    /// is what each has at first. Velocities stay as they are. All or nothing.
    ///
    /// The masses are a parameter as the stiffness is: [`Cloth::reset`] keeps them and a snapshot does not hold them,
    /// but a snapshot that was taken with other masses is [`Error::Foreign`].
    ///
    /// Errors: [`Error::FeatureOff`] without [`crate::Features::MASS`], [`Error::Shape`] (not one number a particle),
    /// [`Error::NotFinite`], [`Error::Negative`], [`Error::OutOfRange`].
    pub fn set_masses(&mut self, kg: &[f32]) -> Result<(), Error> {
        let l = self.layout;
        if !l.mass {
            return Err(Error::FeatureOff);
        }
        if kg.len() != self.grid.particles() {
            return Err(Error::Shape);
        }
        if !kg.iter().all(|m| m.is_finite()) {
            return Err(Error::NotFinite);
        }
        if kg.iter().any(|m| *m < 0.0) {
            return Err(Error::Negative);
        }
        if !kg.iter().all(|m| (1e-6 * self.mass..=1e6 * self.mass).contains(m)) {
            return Err(Error::OutOfRange);
        }
        // a change of pins keeps momentum, and must not see the new masses
        self.refresh(true);
        let mut changed = false;
        for (particle, m) in kg.iter().enumerate() {
            let at = l.place(particle)?;
            changed |= read(self.masses, at) != *m;
            write(self.masses, at, *m);
        }
        if changed {
            self.matter = self.digest_of_matter();
            self.stale = true;
            self.refresh(false);
            self.wake();
        }
        Ok(())
    }

    /// Mass of a particle in kg, without what the inertia field adds; 0 for an absent one. Error:
    /// [`Error::NoSuchParticle`].
    pub fn mass_kg(&self, particle: usize) -> Result<f32, Error> {
        let at = self.layout.place(particle)?;
        if crate::mask::is_absent(self.mask, at) {
            return Ok(0.0);
        }
        Ok(if self.layout.mass { read(self.masses, at) } else { self.mass })
    }
}

/// Adds the weight of each particle in N to the forces of some rows, from and to.
pub(crate) fn add_weight(l: &Layout, rows: [usize; 2], masses: &[f32], gravity: [f32; 3], force: &mut [&mut [f32]; 3]) {
    let [from, to] = rows;
    for (force, g) in force.iter_mut().zip(gravity) {
        for row in from..to {
            let force = force.get_mut((row - from) * l.stride..).unwrap_or(&mut []);
            for (f, m) in force.iter_mut().zip(span(masses, l.row(row), l.columns)) {
                *f += m * g;
            }
        }
    }
}
