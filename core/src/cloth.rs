use crate::aim::Aim;
use crate::ambient::Ambient;
use crate::budget::{self, BudgetReport};
use crate::colliders::Colliders;
use crate::field::{self, FieldView};
use crate::force::{Planes, Springs};
use crate::frame::Frame;
use crate::implicit::Implicit;
use crate::layout::{Layout, PIN_NUMBERS, copy, read, take, write};
use crate::levels::Levels;
use crate::masses::Body;
use crate::math::round16;
use crate::pins::Pins;
use crate::sleep::Sleep;
use crate::strain_limit::Before;
use crate::targets::Targets;
use crate::tethers::Tethers;
use crate::width::Supported;
use crate::{ClothDef, Error, Grid, Vector3, in_default_environment, inertia};

/// Farthest that a position may be from the cloth's origin, in m.
pub(crate) const REACH_M: f64 = 1e6;

/// A cloth: the state of a grid of particles in a block of memory that the caller handed in.
pub struct Cloth<'a> {
    pub(crate) grid: Grid,
    pub(crate) def: ClothDef,
    pub(crate) layout: Layout,
    pub(crate) mass: f32,
    /// Positions in the local frame in m, velocities in m/s.
    pub(crate) x: Planes<'a>,
    pub(crate) v: Planes<'a>,
    /// The last good state, six planes; between steps it is scratch.
    pub(crate) good: &'a mut [f32],
    /// 1/M in 1/kg.
    pub(crate) inverse: &'a mut [f32],
    /// The stiffness field that was asked for, at the particles; a channel whose family is off is empty.
    pub(crate) target: [&'a mut [f32]; 4],
    /// The springs that are stepped, after the budget.
    pub(crate) springs: Springs<'a>,
    /// Forces on particles for the next frame in N; empty without the feature.
    pub(crate) pull: [&'a mut [f32]; 3],
    /// All forces beside springs and weight, for one substep; empty where the pull is all there is.
    pub(crate) force: [&'a mut [f32]; 3],
    /// Mass of each particle in kg; empty without the feature.
    pub(crate) masses: &'a mut [f32],
    /// 1 for a particle, 0 for an absent one; empty without the feature.
    pub(crate) mask: &'a mut [f32],
    pub(crate) pins: Pins<'a>,
    pub(crate) tethers: Tethers<'a>,
    pub(crate) before: Before<'a>,
    pub(crate) levels: Levels<'a>,
    pub(crate) colliders: Colliders<'a>,
    pub(crate) targets: Targets<'a>,
    pub(crate) implicit: Implicit<'a>,
    pub(crate) ambient: Ambient,
    pub(crate) sleep: Sleep,
    pub(crate) aim: Aim,
    /// Where the local frame is in the world.
    pub(crate) frame: Frame,
    /// Digest of masses and mask.
    pub(crate) matter: u64,
    pub(crate) step_index: u64,
    pub(crate) report: BudgetReport,
    pub(crate) has_stiffness: bool,
    pub(crate) has_pull: bool,
    /// Whether inertia and springs must be computed anew.
    pub(crate) stale: bool,
    /// What the sweep hands on from row to row: [`Layout::carry`].
    pub(crate) carry: &'a mut [f32],
    pub(crate) width: Supported,
}

/// The positions of a cloth without a copy: particle (row, column) is number `row * row_stride + column` of each of the
/// three arrays, in m in the local frame (add `origin_m`). Valid until the next call that changes the cloth.
#[derive(Clone, Copy, Debug)]
pub struct PositionView<'a> {
    /// x, y and z in m.
    pub xyz: [&'a [f32]; 3],
    /// Numbers from a row to the next.
    pub row_stride: usize,
    /// World position of the local frame in m.
    pub origin_m: [f64; 3],
}

impl<'a> Cloth<'a> {
    /// Numbers (f32) of memory that a cloth needs. Errors: those of [`ClothDef::check`].
    pub fn memory(grid: &Grid, def: &ClothDef) -> Result<usize, Error> {
        in_default_environment(|| def.check())?;
        Ok(Layout::new(grid, def).numbers())
    }

    /// Makes a cloth in the caller's block, flat and at rest. The block's content is overwritten.
    ///
    /// Errors: those of [`ClothDef::check`], [`Error::BlockTooSmall`].
    pub fn create(grid: &Grid, def: &ClothDef, block: &'a mut [f32]) -> Result<Cloth<'a>, Error> {
        in_default_environment(|| Cloth::lay_out(grid, def, block))
    }

    fn lay_out(grid: &Grid, def: &ClothDef, block: &'a mut [f32]) -> Result<Cloth<'a>, Error> {
        def.check()?;
        let layout = Layout::new(grid, def);
        let mut rest = block.get_mut(..layout.numbers()).ok_or(Error::BlockTooSmall)?;
        rest.fill(0.0);
        let p = layout.plane;
        let when = |on: bool| if on { p } else { 0 };
        let b = &mut rest;
        let mut cloth = Cloth {
            grid: *grid,
            def: *def,
            layout,
            mass: budget::particle_mass(grid, def),
            x: Planes { x: take(b, p)?, y: take(b, p)?, z: take(b, p)? },
            v: Planes { x: take(b, p)?, y: take(b, p)?, z: take(b, p)? },
            good: take(b, 6 * p)?,
            inverse: take(b, p)?,
            target: [take(b, p)?, take(b, p)?, take(b, when(layout.shear))?, take(b, when(layout.bend))?],
            springs: Springs {
                u: take(b, p)?,
                v: take(b, p)?,
                right: take(b, when(layout.shear))?,
                left: take(b, when(layout.shear))?,
                bend_u: take(b, when(layout.bend))?,
                bend_v: take(b, when(layout.bend))?,
            },
            pull: [take(b, when(layout.pull))?, take(b, when(layout.pull))?, take(b, when(layout.pull))?],
            force: [take(b, when(layout.force()))?, take(b, when(layout.force()))?, take(b, when(layout.force()))?],
            masses: take(b, when(layout.mass))?,
            mask: take(b, when(layout.mask))?,
            pins: Pins {
                numbers: take(b, round16(PIN_NUMBERS * layout.max_pins))?,
                count: 0,
                capacity: layout.max_pins,
            },
            tethers: Tethers::new(if layout.has_tethers() { p } else { 0 }, b)?,
            before: Before::new(&layout, b)?,
            levels: Levels::new(&layout, b)?,
            colliders: Colliders::new(&layout, b)?,
            targets: Targets::new(&layout, b)?,
            implicit: Implicit::new(&layout, b)?,
            ambient: Ambient::new(def),
            sleep: Sleep::new(def),
            aim: Aim::new(def),
            frame: Frame::new(def),
            matter: 0,
            step_index: 0,
            report: BudgetReport::default(),
            has_stiffness: false,
            has_pull: false,
            stale: true,
            carry: take(b, layout.carry())?,
            width: Supported::best(),
        };
        for row in 0..layout.rows {
            let at = layout.row(row);
            for (plane, value) in [(&mut cloth.masses, cloth.mass), (&mut cloth.mask, 1.0)] {
                if let Some(row) = plane.get_mut(at..at + layout.columns) {
                    row.fill(value);
                }
            }
        }
        cloth.matter = cloth.digest_of_matter();
        cloth.start_again();
        Ok(cloth)
    }

    /// Back to the start: flat, at rest, nothing pinned, no collider, step 0, gravity, damping, air, targets, frame and rest
    /// lengths as they were made. Stiffness, masses and mask stay.
    pub fn reset(&mut self) {
        in_default_environment(|| self.start_again());
    }

    fn start_again(&mut self) {
        let unit = |a: [f32; 3]| Vector3::from(a).normalize();
        let (u, v) = (unit(self.def.u_axis), unit(self.def.v_axis));
        let (rest_u, rest_v) = (self.grid.rest_u(), self.grid.rest_v());
        for row in 0..self.layout.rows {
            for column in 0..self.layout.columns {
                let at = self.layout.at(row, column);
                let p = u * (column as f32 * rest_u) + v * (row as f32 * rest_v);
                self.set_position_at(at, [p.x, p.y, p.z]);
                self.set_velocity_at(at, [0.0; 3]);
            }
        }
        for p in &mut self.pull {
            p.fill(0.0);
        }
        self.has_pull = false;
        self.pins.count = 0;
        self.ambient = Ambient::new(&self.def);
        self.colliders.numbers.fill(0.0);
        self.reset_targets();
        self.implicit.reset();
        self.aim = Aim::new(&self.def);
        self.frame = Frame::new(&self.def);
        self.step_index = 0;
        self.stale = true;
        self.wake();
    }

    /// The grid.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// The definition.
    pub fn def(&self) -> &ClothDef {
        &self.def
    }

    /// Frames stepped so far.
    pub fn step_index(&self) -> u64 {
        self.step_index
    }

    /// Whether the stiffness was ever set: without it a cloth does not step.
    pub fn has_stiffness(&self) -> bool {
        self.has_stiffness
    }

    /// A particle's share of the sheet's mass in kg, which is its mass where it has none of its own.
    pub fn particle_mass_kg(&self) -> f32 {
        self.mass
    }

    /// Sets one stiffness for the whole cloth: warp, weft, shear, bend in N/m. What the step cannot carry is cut by the
    /// budget, with the ratios kept.
    ///
    /// Errors: [`Error::NotFinite`], [`Error::Negative`]; then the former stiffness stays.
    pub fn set_stiffness_uniform(&mut self, k_n_per_m: [f32; 4]) -> Result<(), Error> {
        let mut field = [0.0; 16];
        for (i, f) in field.iter_mut().enumerate() {
            *f = k_n_per_m[i / 4];
        }
        self.set_stiffness_field(&FieldView::new(4, 2, 2, &field)?);
        Ok(())
    }

    /// Sets the stiffness field, resampled bilinearly where it has another resolution than the grid. A channel whose
    /// family is off is not used.
    pub fn set_stiffness_field(&mut self, field: &FieldView<'_>) {
        let (m, n) = (self.layout.rows, self.layout.columns);
        in_default_environment(|| self.set_target(|row, column| field.sample(row, column, m, n)));
    }

    /// The same from a function (channel, row, column) on another grid of rows x columns.
    pub(crate) fn set_stiffness_by(&mut self, rows: usize, columns: usize, k: impl Fn(usize, usize, usize) -> f32) {
        let to = (self.layout.rows, self.layout.columns);
        in_default_environment(|| {
            self.set_target(|row, column| {
                [0, 1, 2, 3].map(|c| field::bilinear((rows, columns), |r, i| k(c, r, i), (row, column), to))
            });
        });
    }

    fn set_target(&mut self, k: impl Fn(usize, usize) -> [f32; 4]) {
        let l = self.layout;
        for row in 0..l.rows {
            for column in 0..l.columns {
                for (plane, k) in self.target.iter_mut().zip(k(row, column)) {
                    write(plane, l.at(row, column), k);
                }
            }
        }
        self.has_stiffness = true;
        self.stale = true;
        self.wake();
    }

    /// What the budget makes of the stiffness with the pins as they are, and the bound of the stretch: O(particles + pins^2).
    /// [`Cloth::predict_stretch`] tells the stretch to expect.
    ///
    /// Error: [`Error::NoStiffness`].
    pub fn budget(&mut self) -> Result<BudgetReport, Error> {
        if !self.has_stiffness {
            return Err(Error::NoStiffness);
        }
        self.refresh(true);
        let report = self.report;
        Ok(in_default_environment(|| self.predict(report, false)))
    }

    /// Computes inertia and springs anew where pins or stiffness have changed. The inertia field follows the pins; a
    /// particle whose inertia changes keeps its momentum if asked.
    pub(crate) fn refresh(&mut self, keep_momentum: bool) {
        if self.stale {
            in_default_environment(|| self.compute_springs(keep_momentum));
        }
    }

    fn compute_springs(&mut self, keep_momentum: bool) {
        let l = self.layout;
        // the damping may have been changed while running, and the air damps too
        let def = ClothDef { damping_per_s: self.ambient.damping() + self.drag_per_s(), ..self.def };
        let hinges = self.hinge_bound();
        let (former, rest) = self.good.split_at_mut(l.plane.min(self.good.len()));
        let scratch = rest.get_mut(..l.plane).unwrap_or(&mut []);
        copy(former, self.inverse);
        let (pins, layout) = (&self.pins, &self.layout);
        let pinned = pins.iter().filter_map(|p| layout.place(p.particle).ok());
        let body = Body {
            grid: &self.grid,
            def: &def,
            layout,
            mass: self.mass,
            masses: self.masses,
            mask: self.mask,
            rest_scale: self.ambient.rest_scale(),
        };
        inertia::inverse_masses(&body, pinned, self.inverse, scratch);
        if keep_momentum {
            for row in 0..l.rows {
                for column in 0..l.columns {
                    let at = l.at(row, column);
                    let (old, new) = (read(former, at), read(self.inverse, at));
                    if old > 0.0 && new > 0.0 && old != new {
                        for v in [&mut *self.v.x, &mut *self.v.y, &mut *self.v.z] {
                            let kept = read(v, at) * (new / old);
                            write(v, at, kept);
                        }
                    }
                }
            }
        }
        self.report = budget::project(&body, &self.target, self.inverse, hinges, &mut self.springs, scratch);
        if l.has_tethers() {
            self.attach_tethers();
        }
        self.stale = false;
    }

    /// The positions without a copy.
    pub fn positions(&self) -> PositionView<'_> {
        let from = self.layout.row(0);
        PositionView {
            xyz: [&*self.x.x, &*self.x.y, &*self.x.z].map(|p| p.get(from..).unwrap_or(&[])),
            row_stride: self.layout.stride,
            origin_m: self.frame.position,
        }
    }

    /// Position of a particle in the local frame in m. Error: [`Error::NoSuchParticle`].
    pub fn position(&self, particle: usize) -> Result<Vector3<f32>, Error> {
        Ok(self.local(self.layout.place(particle)?).into())
    }

    /// Velocity of a particle in m/s. Error: [`Error::NoSuchParticle`].
    pub fn velocity(&self, particle: usize) -> Result<Vector3<f32>, Error> {
        let at = self.layout.place(particle)?;
        Ok([read(self.v.x, at), read(self.v.y, at), read(self.v.z, at)].into())
    }

    /// Position of a particle in the world in m. Error: [`Error::NoSuchParticle`].
    pub fn world_position(&self, particle: usize) -> Result<Vector3<f64>, Error> {
        let local = self.position(particle)?;
        Ok(in_default_environment(|| local.cast::<f64>() + Vector3::from(self.frame.position)))
    }

    /// Puts a particle somewhere, in the local frame in m, at rest; a pinned one with its pin.
    ///
    /// Errors: [`Error::NoSuchParticle`], [`Error::NotFinite`], [`Error::OutOfRange`] (more than 1e6 m from the origin).
    pub fn set_position(&mut self, particle: usize, local_m: Vector3<f32>) -> Result<(), Error> {
        let at = self.layout.place(particle)?;
        check_reach(local_m.cast())?;
        let p = [local_m.x, local_m.y, local_m.z];
        self.set_position_at(at, p);
        self.set_velocity_at(at, [0.0; 3]);
        if let Ok(place) = self.pins.find(particle) {
            self.pins.set(place, crate::pins::Pin { particle, from: p, to: p });
        }
        self.wake();
        Ok(())
    }

    /// Sets the velocity of a particle in m/s; a pinned one keeps that of its pin. A change of pins before it is settled
    /// first, so that it does not rescale this velocity.
    ///
    /// Errors: [`Error::NoSuchParticle`], [`Error::Absent`], [`Error::NotFinite`], [`Error::OutOfRange`] (above 1e6 m/s).
    pub fn set_velocity(&mut self, particle: usize, v_m_s: Vector3<f32>) -> Result<(), Error> {
        let at = self.present_place(particle)?;
        check_reach(v_m_s.cast())?;
        if self.pins.find(particle).is_err() {
            self.refresh(true);
            self.set_velocity_at(at, [v_m_s.x, v_m_s.y, v_m_s.z]);
            self.wake();
        }
        Ok(())
    }

    /// Adds a force on a particle in N, which acts during the next frame (F_pull of eq. 2).
    ///
    /// Errors: [`Error::FeatureOff`] without [`crate::Features::PULL`], [`Error::NoSuchParticle`], [`Error::Absent`],
    /// [`Error::NotFinite`], [`Error::OutOfRange`] (above 1e9 N).
    pub fn add_force(&mut self, particle: usize, force_n: Vector3<f32>) -> Result<(), Error> {
        if !self.layout.pull {
            return Err(Error::FeatureOff);
        }
        let at = self.present_place(particle)?;
        if !force_n.iter().all(|f| f.is_finite()) {
            return Err(Error::NotFinite);
        }
        if force_n.iter().any(|f| f.abs() > 1e9) {
            return Err(Error::OutOfRange);
        }
        in_default_environment(|| {
            for (plane, f) in self.pull.iter_mut().zip(force_n.iter()) {
                let sum = read(plane, at) + f;
                write(plane, at, sum);
            }
        });
        self.has_pull = true;
        self.wake();
        Ok(())
    }

    /// Kinetic energy in J: half M v^2, with the inertial mass. O(particles).
    pub fn kinetic_energy_j(&self) -> f64 {
        in_default_environment(|| self.sum_energy())
    }

    fn sum_energy(&self) -> f64 {
        let l = self.layout;
        let mut sum = 0.0f64;
        for row in 0..l.rows {
            for column in 0..l.columns {
                let at = l.at(row, column);
                let w = read(self.inverse, at);
                if w > 0.0 {
                    let v = [&*self.v.x, &*self.v.y, &*self.v.z].map(|p| f64::from(read(p, at)));
                    sum += 0.5 / f64::from(w) * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
                }
            }
        }
        sum
    }

    pub(crate) fn local(&self, at: usize) -> [f32; 3] {
        [read(self.x.x, at), read(self.x.y, at), read(self.x.z, at)]
    }

    pub(crate) fn set_position_at(&mut self, at: usize, p: [f32; 3]) {
        write(self.x.x, at, p[0]);
        write(self.x.y, at, p[1]);
        write(self.x.z, at, p[2]);
    }

    pub(crate) fn set_velocity_at(&mut self, at: usize, v: [f32; 3]) {
        write(self.v.x, at, v[0]);
        write(self.v.y, at, v[1]);
        write(self.v.z, at, v[2]);
    }

    /// World to local, refused where f32 could not hold it well.
    pub(crate) fn to_local(&self, world_m: Vector3<f64>) -> Result<[f32; 3], Error> {
        in_default_environment(|| {
            let d = world_m - Vector3::from(self.frame.position);
            check_reach(d)?;
            Ok([d.x as f32, d.y as f32, d.z as f32])
        })
    }
}

fn check_reach(p: Vector3<f64>) -> Result<(), Error> {
    if !p.iter().all(|x| x.is_finite()) {
        return Err(Error::NotFinite);
    }
    if p.iter().any(|x| x.abs() > REACH_M) {
        return Err(Error::OutOfRange);
    }
    Ok(())
}
