use crate::force::{Substep, position_row, velocity_row};
use crate::layout::{copy, span};
use crate::math::min;
use crate::{Cloth, Error, Solver};

/// What happened in a step, as bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct StepFlags(pub u32);

impl StepFlags {
    /// The frame would have ended with a number that is not finite. It was taken back whole: positions, velocities, pins
    /// and step index are those before the call; pin targets and forces of the frame are dropped.
    pub const NON_FINITE: StepFlags = StepFlags(1);

    /// Whether every flag of `other` is set.
    pub const fn contains(self, other: StepFlags) -> bool {
        self.0 & other.0 == other.0
    }
}

impl Cloth<'_> {
    /// One frame: `substeps` substeps of symplectic Euler (eq. 17). The pins move to their targets.
    ///
    /// Error: [`Error::NoStiffness`].
    pub fn step(&mut self) -> Result<StepFlags, Error> {
        if !self.has_stiffness {
            return Err(Error::NoStiffness);
        }
        self.refresh(true);
        self.keep_good();
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
        let finite = self.is_finite();
        if finite {
            self.finish_pins();
            self.step_index += 1;
        } else {
            self.back_to_good();
            self.implicit.reset();
            for i in 0..self.pins.count {
                let pin = self.pins.get(i);
                self.pins.set(i, crate::pins::Pin { to: pin.from, ..pin });
            }
        }
        if self.layout.max_colliders > 0 {
            self.finish_colliders(finite);
        }
        if self.layout.targets {
            self.finish_targets(finite);
        }
        if self.has_pull {
            for p in &mut self.pull {
                p.fill(0.0);
            }
            self.has_pull = false;
        }
        Ok(if finite { StepFlags(0) } else { StepFlags::NON_FINITE })
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
            speed: if d.speed_limit > 0.0 { d.speed_limit * min(g.rest_u(), g.rest_v()) / dt } else { f32::INFINITY },
        }
    }

    fn substep(&mut self, c: &Substep) {
        match (self.layout.shear, self.layout.bend, self.has_pull || self.layout.force()) {
            (false, false, false) => self.sweep::<false, false, false>(c),
            (false, false, true) => self.sweep::<false, false, true>(c),
            (false, true, false) => self.sweep::<false, true, false>(c),
            (false, true, true) => self.sweep::<false, true, true>(c),
            (true, false, false) => self.sweep::<true, false, false>(c),
            (true, false, true) => self.sweep::<true, false, true>(c),
            (true, true, false) => self.sweep::<true, true, false>(c),
            (true, true, true) => self.sweep::<true, true, true>(c),
        }
    }

    /// One pass over memory: the positions of a row are moved two rows behind the velocities, when no force needs them as
    /// they were.
    fn sweep<const SHEAR: bool, const BEND: bool, const PULL: bool>(&mut self, c: &Substep) {
        let l = self.layout;
        let forces = if l.force() { &self.force } else { &self.pull };
        let pull = [&*forces[0], &*forces[1], &*forces[2]];
        for row in 0..l.rows + 2 {
            if row < l.rows {
                velocity_row::<SHEAR, BEND, PULL>(
                    &l,
                    row,
                    c,
                    self.x.view(),
                    &self.springs,
                    self.inverse,
                    pull,
                    self.v.x,
                    self.v.y,
                    self.v.z,
                );
            }
            if row >= 2 {
                position_row(&l, row - 2, c.dt, self.x.x, self.v.x);
                position_row(&l, row - 2, c.dt, self.x.y, self.v.y);
                position_row(&l, row - 2, c.dt, self.x.z, self.v.z);
            }
        }
    }

    fn keep_good(&mut self) {
        let planes = [&*self.x.x, &*self.x.y, &*self.x.z, &*self.v.x, &*self.v.y, &*self.v.z];
        let size = self.layout.plane.max(1);
        for (good, plane) in self.good.chunks_exact_mut(size).zip(planes) {
            copy(good, plane);
        }
    }

    fn back_to_good(&mut self) {
        let planes = [&mut *self.x.x, &mut *self.x.y, &mut *self.x.z, &mut *self.v.x, &mut *self.v.y, &mut *self.v.z];
        let size = self.layout.plane.max(1);
        for (good, plane) in self.good.chunks_exact(size).zip(planes) {
            copy(plane, good);
        }
    }

    /// Whether every position and velocity is finite: x * 0 is 0 for finite x and NaN otherwise.
    pub(crate) fn is_finite(&self) -> bool {
        let l = self.layout;
        let mut lanes = [0.0f32; 16];
        for row in 0..l.rows {
            for plane in [&self.x.x, &self.x.y, &self.x.z, &self.v.x, &self.v.y, &self.v.z] {
                for block in span(plane, l.row(row), l.width).as_chunks::<16>().0 {
                    for (lane, x) in lanes.iter_mut().zip(block) {
                        *lane += x * 0.0;
                    }
                }
            }
        }
        lanes.iter().all(|s| *s == 0.0)
    }
}
