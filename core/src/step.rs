use crate::force::{Finite, Substep, Sweep};
use crate::layout::copy;
use crate::{Cloth, Error, Solver, in_default_environment, simd};

/// What happened in a step, as bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct StepFlags(pub u32);

impl StepFlags {
    /// The frame would have ended with a number that is not finite. It was taken back whole: positions, velocities, pins
    /// and step index are those before the call; pin targets, forces and the ways of colliders and targets of the frame are
    /// dropped. One of the flags `NON_FINITE_*` names the cause beside it.
    pub const NON_FINITE: StepFlags = StepFlags(1);
    /// The cloth slept through the frame: only the step index has changed ([`crate::ClothDef::sleep_speed_m_s`]).
    pub const ASLEEP: StepFlags = StepFlags(2);
    /// A pin is not finite, or without the ways of the pins the frame would have stayed finite.
    pub const NON_FINITE_PIN: StepFlags = StepFlags(4);
    /// The air is not finite, or in still air the frame would have stayed finite.
    pub const NON_FINITE_AIR: StepFlags = StepFlags(8);
    /// A force is not finite, or without the forces of [`Cloth::add_force`] the frame would have stayed finite.
    pub const NON_FINITE_FORCE: StepFlags = StepFlags(16);
    /// A collider is not finite, or without the ways of the colliders the frame would have stayed finite.
    pub const NON_FINITE_COLLIDER: StepFlags = StepFlags(32);
    /// A skinned target is not finite, or without the ways of the targets the frame would have stayed finite.
    pub const NON_FINITE_TARGET: StepFlags = StepFlags(64);
    /// None of these: positions, velocities or springs themselves run away.
    pub const NON_FINITE_STATE: StepFlags = StepFlags(128);

    /// Whether every flag of `other` is set.
    pub const fn contains(self, other: StepFlags) -> bool {
        self.0 & other.0 == other.0
    }
}

impl Cloth<'_> {
    /// One frame: `substeps` substeps of the solver, by default symplectic Euler (eq. 17). The pins move to their targets.
    ///
    /// The same bits whatever floating-point modes the caller has set.
    ///
    /// Error: [`Error::NoStiffness`].
    pub fn step(&mut self) -> Result<StepFlags, Error> {
        in_default_environment(|| self.step_frame())
    }

    fn step_frame(&mut self) -> Result<StepFlags, Error> {
        if !self.has_stiffness {
            return Err(Error::NoStiffness);
        }
        if self.is_asleep() {
            return Ok(self.sleep_through());
        }
        self.refresh(true);
        self.keep_good();
        let bad = self.broken_inputs();
        let finite = bad.0 == 0 && self.advance();
        Ok(self.end_frame(bad, finite))
    }

    /// A frame in which nothing happens.
    pub(crate) fn sleep_through(&mut self) -> StepFlags {
        self.step_index += 1;
        StepFlags::ASLEEP
    }

    /// What comes after the substeps of a frame; `bad` is what was found wrong before them.
    pub(crate) fn end_frame(&mut self, bad: StepFlags, finite: bool) -> StepFlags {
        let flags = if finite {
            self.finish_pins();
            self.step_index += 1;
            StepFlags(0)
        } else {
            let cause = if bad.0 == 0 { self.find_cause() } else { bad };
            self.back_to_good();
            self.implicit.reset();
            self.drop_pin_ways();
            StepFlags(StepFlags::NON_FINITE.0 | cause.0)
        };
        if self.layout.max_colliders > 0 {
            self.finish_colliders(finite);
        }
        if self.layout.targets {
            self.finish_targets(finite);
        }
        self.drop_forces();
        self.settle(finite);
        flags
    }

    /// The substeps of a frame. Whether everything stayed finite.
    pub(crate) fn advance(&mut self) -> bool {
        let c = self.constants();
        let substeps = self.def.substeps;
        for s in 1..=substeps {
            let share = s as f32 / substeps as f32;
            if self.def.solver == Solver::SymplecticEuler {
                if self.layout.force() {
                    self.outer_forces(s - 1);
                }
                self.substep(&c);
            } else {
                self.implicit_substep(&c, s - 1, share);
            }
            self.place_pins(share);
            self.constrain(&c, share);
        }
        self.is_finite()
    }

    /// The forces on single particles act in one frame only.
    pub(crate) fn drop_forces(&mut self) {
        if self.has_pull {
            for p in &mut self.pull {
                p.fill(0.0);
            }
            self.has_pull = false;
        }
    }

    pub(crate) fn constants(&self) -> Substep {
        let (d, g) = (&self.def, &self.grid);
        let dt = d.dt_s();
        let [scale_u, scale_v, scale_diagonal] = self.ambient.rest_scale();
        Substep {
            dt,
            damping: self.ambient.damping(),
            // particles with masses of their own have their weight among the forces
            weight: if self.layout.mass { [0.0; 3] } else { self.ambient.gravity().map(|g| self.mass * g) },
            rest_u: g.rest_u() * scale_u,
            rest_v: g.rest_v() * scale_v,
            rest_diagonal: g.rest_diagonal() * scale_diagonal,
            floor: if d.compression_limit { -1.0 } else { f32::NEG_INFINITY },
            speed: if d.speed_limit > 0.0 { d.speed_limit * g.least_rest() / dt } else { f32::INFINITY },
        }
    }

    fn substep(&mut self, c: &Substep) {
        let forces = if self.layout.force() { &self.force } else { &self.pull };
        let pull = (self.has_pull || self.layout.force()).then_some([&*forces[0], &*forces[1], &*forces[2]]);
        let sweep = Sweep {
            layout: self.layout,
            constants: c,
            x: &mut self.x,
            v: &mut self.v,
            springs: &self.springs,
            inverse: self.inverse,
            pull,
            carry: self.carry,
        };
        sweep.run(self.width);
    }

    pub(crate) fn keep_good(&mut self) {
        self.aim.keep_good();
        let planes = [&*self.x.x, &*self.x.y, &*self.x.z, &*self.v.x, &*self.v.y, &*self.v.z];
        let size = self.layout.plane.max(1);
        for (good, plane) in self.good.chunks_exact_mut(size).zip(planes) {
            copy(good, plane);
        }
    }

    pub(crate) fn back_to_good(&mut self) {
        self.aim.back_to_good();
        let planes = [&mut *self.x.x, &mut *self.x.y, &mut *self.x.z, &mut *self.v.x, &mut *self.v.y, &mut *self.v.z];
        let size = self.layout.plane.max(1);
        for (good, plane) in self.good.chunks_exact(size).zip(planes) {
            copy(plane, good);
        }
    }

    /// Whether every position and velocity is finite.
    pub(crate) fn is_finite(&self) -> bool {
        let planes = [&*self.x.x, &*self.x.y, &*self.x.z, &*self.v.x, &*self.v.y, &*self.v.z];
        simd::run(self.width, Finite { layout: self.layout, planes })
    }
}
