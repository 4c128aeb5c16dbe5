use crate::levels::MOST_CYCLES;
use crate::{Error, Hash64};

/// How the stiffness field is projected to what the step can carry. See [`crate::BudgetReport`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum Budget {
    /// 0.25 of the limit of the flat sheet, so at most half of it in any other shape: it never grows exponentially, from any
    /// start, and with damping of 1/s it comes to rest without any limit on speed or compression. 0.31 of the stiffness of
    /// `Tuned`.
    Certified = 0,
    /// 0.8 of the limit of the flat sheet. Needs the speed limit and some damping; the default.
    Tuned = 1,
}

/// Optional parts of a cloth, as bits. What is not asked for costs no memory and no time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Features(pub u32);

impl Features {
    /// Nothing optional.
    pub const NONE: Features = Features(0);
    /// Forces on single particles ([`crate::Cloth::add_force`]).
    pub const PULL: Features = Features(1);
    /// Air: drag, lift and wind ([`crate::Cloth::set_air`]).
    pub const AIR: Features = Features(2);
    /// Hinge bending of the rigidity [`ClothDef::hinge_rigidity_n_m`].
    pub const HINGE: Features = Features(4);
    /// Tethers to the nearest pins, with the slack [`ClothDef::tether_slack`].
    pub const TETHERS: Features = Features(8);
    /// Strain limit of [`ClothDef::strain_limit`] (Provot 1995).
    pub const STRAIN_LIMIT: Features = Features(16);
    /// Strain limit of [`ClothDef::strain_limit`] on levels, from coarse to fine.
    pub const LEVELS: Features = Features(32);
    /// Colliders, up to [`crate::MAX_COLLIDERS`].
    pub const COLLIDERS: Features = Features(64);
    /// A skinned target of each particle with a largest distance and a backstop.
    pub const TARGETS: Features = Features(128);
    /// A mass of its own for each particle ([`crate::Cloth::set_masses`]).
    pub const MASS: Features = Features(256);
    /// Absent particles ([`crate::Cloth::set_mask`]).
    pub const MASK: Features = Features(512);
    /// Working memory of an implicit solver; [`ClothDef::solver`] chooses it.
    pub const IMPLICIT: Features = Features(1024);
    /// Every feature.
    pub const ALL: Features = Features(2047);

    /// Whether every feature of `other` is on.
    pub const fn contains(self, other: Features) -> bool {
        self.0 & other.0 == other.0
    }
}

/// How a frame is solved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum Solver {
    /// Symplectic Euler (eq. 17): explicit, cheapest; the stiffness is cut to the budget.
    SymplecticEuler = 0,
    /// Implicit Euler with conjugate gradients: the stiffness as it is, at any step; damps motion.
    ImplicitEuler = 1,
    /// The second-order backward difference formula with conjugate gradients: as `ImplicitEuler`, with less damping.
    Bdf2 = 2,
}

/// What a cloth is made of beside its grid. SI units; no axis is "up".
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClothDef {
    /// Frames per second, 1 to 10,000. One [`crate::Cloth::step`] is one frame. Fixed for the life of the cloth. Default 60.
    pub rate_hz: f32,
    /// Equal substeps of a frame, 1 to 1,024. dt = 1 / (rate_hz * substeps). Default 16.
    pub substeps: u32,
    /// Mass per area in kg/m^2, 1e-6 to 1e6. Each particle has the same share of the sheet's mass. Default 0.2.
    pub density_kg_m2: f32,
    /// Gravity in m/s^2, at most 1e4 in size. Default (0, -9.81, 0).
    pub gravity_m_s2: [f32; 3],
    /// Damping c in 1/s: F_damping = -c M v. At least 0, and c dt below 1. Default 2.
    pub damping_per_s: f32,
    /// Speed limit as a fraction of the smallest rest length per substep, 1e-6 to 1e6; 0 = none. Default 0.25. The
    /// implicit solvers need none and do not know it.
    pub speed_limit: f32,
    /// Whether a compressed spring may push with at most k times its length, which keeps crumpled cloth from exploding:
    /// the factor 1 - L0/l of eq. 1 is kept at -1 or above. Default true.
    pub compression_limit: bool,
    /// The stability budget. Default `Tuned`.
    pub budget: Budget,
    /// Radius of the inertia field in m; 0 = none. Particle i has the inertial mass q_i m with
    /// q_i = clip(radius / distance to the nearest pin, 1, inertia_max), its weight unchanged: the cloth is stiff at the
    /// pins, where it stretches most, at no cost in dt. Default 0.
    pub inertia_radius_m: f32,
    /// Largest q of the inertia field, 1 to 1e4. Default 32.
    pub inertia_max: f32,
    /// Most pins at a time, 28 bytes each; more than there are particles means all of them. Default 256.
    pub max_pins: u32,
    /// The solver; the implicit ones need [`Features::IMPLICIT`]. Default `SymplecticEuler`.
    pub solver: Solver,
    /// Iterations of the conjugate gradients of an implicit solver in each of the two linearisations of a substep, 1 to 1,000.
    /// Default 10.
    pub cg_iterations: u32,
    /// How much longer than the way through the resting cloth a tether may get: warp, weft, diagonal, each 0 to 10 (0.05 is
    /// 5 %). Default 0.
    pub tether_slack: [f32; 3],
    /// Largest strain that the strain limit and the levels aim at; the levels keep it along warp and weft (see
    /// [`ClothDef::level_cycles`]): warp, weft, diagonal, each 0 to 10. Default 0.05.
    pub strain_limit: [f32; 3],
    /// Passes of the strain limit in each substep, and of the levels over the cloth itself in each cycle, 1 to 64. Default 2.
    pub strain_passes: u32,
    /// Cycles through the levels in each substep, 1 to 32: at most so many are paid, and `strain_limit` is what they aim at,
    /// nothing that they promise. 0: as many as it takes that no structural spring is beyond `strain_limit`, at most 32. Only
    /// with [`Features::LEVELS`]. Default 0.
    pub level_cycles: u32,
    /// Bending rigidity D of the hinges in N m, 0 to 1e6; see [`crate::BudgetReport::hinge_fraction`]. Default 1e-5.
    pub hinge_rigidity_n_m: f32,
    /// A cloth whose particles are all slower than this for half a second sleeps until something wakes it, in m/s, 0 to 1e3;
    /// 0 = never. Default 0.
    pub sleep_speed_m_s: f32,
    /// Optional parts. Default none.
    pub features: Features,
    /// World position of the local frame in m. Default 0.
    pub origin_m: [f64; 3],
    /// Direction of u (along a row) at the start, any length above 0. Default (1, 0, 0).
    pub u_axis: [f32; 3],
    /// Direction of v (along a column, from row 0 on) at the start, any length above 0. Default (0, -1, 0).
    pub v_axis: [f32; 3],
}

impl Default for ClothDef {
    fn default() -> Self {
        ClothDef {
            rate_hz: 60.0,
            substeps: 16,
            density_kg_m2: 0.2,
            gravity_m_s2: [0.0, -9.81, 0.0],
            damping_per_s: 2.0,
            speed_limit: 0.25,
            compression_limit: true,
            budget: Budget::Tuned,
            inertia_radius_m: 0.0,
            inertia_max: 32.0,
            max_pins: 256,
            solver: Solver::SymplecticEuler,
            cg_iterations: 10,
            tether_slack: [0.0; 3],
            strain_limit: [0.05; 3],
            strain_passes: 2,
            level_cycles: 0,
            hinge_rigidity_n_m: 1e-5,
            sleep_speed_m_s: 0.0,
            features: Features::NONE,
            origin_m: [0.0; 3],
            u_axis: [1.0, 0.0, 0.0],
            v_axis: [0.0, -1.0, 0.0],
        }
    }
}

impl ClothDef {
    /// Length of a substep in s.
    pub fn dt_s(&self) -> f32 {
        1.0 / (self.rate_hz * self.substeps as f32)
    }

    /// Whether an inertia field is asked for.
    pub fn has_inertia(&self) -> bool {
        self.inertia_radius_m > 0.0 && self.inertia_max > 1.0
    }

    /// Checks every field. Errors: [`Error::NotFinite`], [`Error::Negative`], [`Error::StepSize`], [`Error::Damping`],
    /// [`Error::FeatureOff`] (an implicit solver without its memory), [`Error::OutOfRange`].
    pub fn check(&self) -> Result<(), Error> {
        let scalars = [
            self.rate_hz,
            self.density_kg_m2,
            self.damping_per_s,
            self.speed_limit,
            self.inertia_radius_m,
            self.inertia_max,
            self.hinge_rigidity_n_m,
            self.sleep_speed_m_s,
        ];
        let vectors = [self.gravity_m_s2, self.u_axis, self.v_axis, self.tether_slack, self.strain_limit];
        if !scalars.iter().chain(vectors.as_flattened()).all(|x| x.is_finite())
            || !self.origin_m.iter().all(|x| x.is_finite())
        {
            return Err(Error::NotFinite);
        }
        if !(1.0..=10_000.0).contains(&self.rate_hz) || !(1..=1024).contains(&self.substeps) {
            return Err(Error::StepSize);
        }
        let scalars = [
            self.damping_per_s,
            self.speed_limit,
            self.inertia_radius_m,
            self.hinge_rigidity_n_m,
            self.sleep_speed_m_s,
        ];
        let limits = [self.tether_slack, self.strain_limit];
        if scalars.iter().chain(limits.as_flattened()).any(|x| *x < 0.0) {
            return Err(Error::Negative);
        }
        if self.damping_per_s * self.dt_s() >= 1.0 {
            return Err(Error::Damping);
        }
        if self.solver != Solver::SymplecticEuler && !self.features.contains(Features::IMPLICIT) {
            return Err(Error::FeatureOff);
        }
        let axis = |a: &[f32; 3]| (1e-3..=1e3).contains(&length(a));
        if !(1e-6..=1e6).contains(&self.density_kg_m2)
            || !(1.0..=1e4).contains(&self.inertia_max)
            || self.inertia_radius_m > 1e4
            || self.speed_limit > 1e6
            || (self.speed_limit > 0.0 && self.speed_limit < 1e-6)
            || length(&self.gravity_m_s2) > 1e4
            || self.features.0 > Features::ALL.0
            || limits.as_flattened().iter().any(|x| *x > 10.0)
            || !(1..=1000).contains(&self.cg_iterations)
            || !(1..=64).contains(&self.strain_passes)
            || self.level_cycles > MOST_CYCLES
            || self.hinge_rigidity_n_m > 1e6
            || self.sleep_speed_m_s > 1e3
            || !axis(&self.u_axis)
            || !axis(&self.v_axis)
            || self.origin_m.iter().any(|x| x.abs() > 1e12)
        {
            return Err(Error::OutOfRange);
        }
        Ok(())
    }

    /// Digest of what a snapshot depends on.
    pub(crate) fn digest(&self, h: &mut Hash64) {
        let f = |x: f32| x.to_bits();
        h.words(&[f(self.rate_hz), self.substeps, f(self.density_kg_m2), f(self.damping_per_s), f(self.speed_limit)]);
        h.words(&self.gravity_m_s2.map(f));
        h.words(&[self.compression_limit as u32, self.budget as u32, f(self.inertia_radius_m), f(self.inertia_max)]);
        h.words(&[self.features.0, self.max_pins]);
        h.words(&[self.solver as u32, self.cg_iterations, self.strain_passes, self.level_cycles]);
        h.words(&[f(self.hinge_rigidity_n_m), f(self.sleep_speed_m_s)]);
        h.words(&self.tether_slack.map(f));
        h.words(&self.strain_limit.map(f));
    }
}

fn length(a: &[f32; 3]) -> f32 {
    crate::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn refuses_bad_definitions() {
        let d = ClothDef::default();
        assert_eq!(d.check(), Ok(()));
        let err = |d: ClothDef| d.check().unwrap_err();
        assert_eq!(err(ClothDef { rate_hz: 0.0, ..d }), Error::StepSize);
        assert_eq!(err(ClothDef { substeps: 0, ..d }), Error::StepSize);
        assert_eq!(err(ClothDef { rate_hz: f32::NAN, ..d }), Error::NotFinite);
        assert_eq!(err(ClothDef { rate_hz: f32::INFINITY, ..d }), Error::NotFinite);
        assert_eq!(err(ClothDef { density_kg_m2: 0.0, ..d }), Error::OutOfRange);
        assert_eq!(err(ClothDef { damping_per_s: -1.0, ..d }), Error::Negative);
        assert_eq!(err(ClothDef { damping_per_s: 960.0, ..d }), Error::Damping);
        assert_eq!(err(ClothDef { gravity_m_s2: [0.0, f32::NAN, 0.0], ..d }), Error::NotFinite);
        assert_eq!(err(ClothDef { u_axis: [0.0; 3], ..d }), Error::OutOfRange);
        assert_eq!(err(ClothDef { origin_m: [f64::NAN, 0.0, 0.0], ..d }), Error::NotFinite);
        assert_eq!(err(ClothDef { features: Features(2048), ..d }), Error::OutOfRange);
        assert_eq!(err(ClothDef { strain_passes: 65, ..d }), Error::OutOfRange);
        assert_eq!(err(ClothDef { level_cycles: 33, ..d }), Error::OutOfRange);
        assert_eq!(err(ClothDef { solver: Solver::Bdf2, ..d }), Error::FeatureOff);
    }
}
