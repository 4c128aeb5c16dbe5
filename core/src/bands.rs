//! A frame in bands of rows, which the threads of a job system may step side by side: the bits of [`Cloth::step`], for any
//! number of bands and threads. The core itself starts no threads.
//!
//! A substep has two phases, or three with tethers: what crosses the borders between the bands, and the forces of air, hinges
//! and weights; the rows themselves with their pins; the tethers. Targets and colliders end the last of them. In each phase a
//! band writes only what is its own, and reads beyond it only what nobody writes in that phase ([`rows`]). So nothing depends
//! on who comes first, as long as no band begins a phase before all bands have ended the one before. That is kept by a counter for each band: [`Bands::run`] looks at all of them before it begins, and
//! refuses what comes too early. So a wrong order is an error, never a race, and a job system needs no locks but its own.
//!
//! Why this is sound: [`Cloth::bands`] borrows the cloth for as long as the bands live and takes the pointers to its planes
//! once. Who calls [`Bands::run`] with a band and its next phase claims it by an atomic exchange, so one thread at a time
//! works on a band. It begins only when all counters have come to the end of the phase before (read with acquire, written
//! with release), and while it runs no other band can come to the next phase, since its own counter does not move. So all
//! that runs at a time is of one phase:
//! - crossing reads positions and velocities and writes the carry of the band, the border above it and the forces on its own
//!   rows;
//! - moving reads borders, the carry and the forces of the band and writes positions, velocities and anchors of its own rows;
//! - the tethers read anchors, and read and write positions and velocities of the band's own rows;
//! - targets and colliders do the same in the last of these phases, without anchors.
//!
//! Stiffness, masses, mask, pins, tethers, targets and colliders are only read. No reference to a whole plane that is written
//! exists meanwhile.
#![allow(unsafe_code)] // pointers to planes that bands share: see the last paragraphs

mod parts;
pub(crate) mod rows;
#[cfg(test)]
mod tests;

use core::marker::PhantomData;
use core::ptr;
use core::sync::atomic::{AtomicU32, Ordering};

use crate::force::{Pointers, Substep, Sweep};
use crate::layout::{CARRY_ROWS, Layout, PIN_NUMBERS, take};
use crate::math::round16;
use crate::pins::{Pin, pin_of};
use crate::width::Supported;
use crate::{Cloth, Error, Features, Solver, StepFlags, in_default_environment, simd};
use parts::Parts;
use rows::{BORDER_ROWS, Cross, Move, Rows};

/// Fewest rows of a band. The last one may have up to twice as many as the others, less one.
pub const LEAST_BAND_ROWS: usize = 8;

/// What bands cannot step: what looks at all rows before it goes on.
const REFUSED: u32 = Features::STRAIN_LIMIT.0 | Features::LEVELS.0;

/// A frame of a cloth that is being stepped in bands. Any number of threads may use it at a time.
///
/// A value that is dropped before its end takes the frame back.
pub struct Bands<'s> {
    /// The cloth, which is used again only when no band runs.
    cloth: *mut Cloth<'static>,
    plan: Plan,
    /// What was found wrong before the frame began.
    bad: StepFlags,
    asleep: bool,
    ended: bool,
    owner: PhantomData<&'s mut Cloth<'s>>,
}

// SAFETY: all that `run` writes is claimed by an atomic exchange: see the top of this file. What takes `&mut self` or `self`
// has no other user.
unsafe impl Send for Bands<'_> {}
// SAFETY: as above.
unsafe impl Sync for Bands<'_> {}

/// What every band needs to know; nothing of it changes while they run.
#[derive(Clone, Copy)]
struct Plan {
    layout: Layout,
    constants: Substep,
    width: Supported,
    rate_hz: f32,
    substeps: u32,
    /// Phases of the frame, 0 where there is nothing to step.
    phases: u32,
    rows_per_band: usize,
    count: usize,
    pointers: Pointers,
    pins: *const f32,
    pin_count: usize,
    parts: Parts,
    /// Where the pins are, at their places of three planes; null without tethers.
    anchors: [*mut f32; 3],
    carry: *mut f32,
    borders: *mut f32,
    /// Twice the phases that a band has ended, and 1 while it runs.
    counters: *mut u32,
}

impl Cloth<'_> {
    /// How many bands there are of so many rows.
    fn band_count(&self, rows_per_band: usize) -> Result<usize, Error> {
        let d = &self.def;
        if rows_per_band < LEAST_BAND_ROWS || d.solver != Solver::SymplecticEuler || d.features.0 & REFUSED != 0 {
            return Err(Error::OutOfRange);
        }
        Ok((self.layout.rows / rows_per_band.max(1)).max(1))
    }

    /// f32 numbers of memory that bands of so many rows need beside the cloth.
    ///
    /// Error: [`Error::OutOfRange`] (fewer rows than [`LEAST_BAND_ROWS`], an implicit solver, or a feature that cannot be
    /// stepped in bands: [`Features::STRAIN_LIMIT`] and [`Features::LEVELS`]).
    pub fn bands_memory(&self, rows_per_band: usize) -> Result<usize, Error> {
        let count = self.band_count(rows_per_band)?;
        let l = &self.layout;
        let anchors = if l.has_tethers() { 3 * l.plane } else { 0 };
        Ok(count * (CARRY_ROWS + BORDER_ROWS) * l.stride + anchors + round16(count))
    }

    /// Begins a frame that is stepped in bands of so many rows: then [`Bands::run`] for every phase and band, and
    /// [`Bands::end`]. The cloth is as it is after [`Cloth::step`], with the same bits.
    ///
    /// Errors: [`Error::NoStiffness`], [`Error::BlockTooSmall`], those of [`Cloth::bands_memory`].
    pub fn bands<'s>(&'s mut self, rows_per_band: usize, memory: &'s mut [f32]) -> Result<Bands<'s>, Error> {
        in_default_environment(|| self.begin_bands(rows_per_band, memory))
    }

    fn begin_bands<'s>(&'s mut self, rows_per_band: usize, memory: &'s mut [f32]) -> Result<Bands<'s>, Error> {
        let count = self.band_count(rows_per_band)?;
        let needed = self.bands_memory(rows_per_band)?;
        let mut rest = memory.get_mut(..needed).ok_or(Error::BlockTooSmall)?;
        if !self.has_stiffness {
            return Err(Error::NoStiffness);
        }
        rest.fill(0.0);
        let asleep = self.is_asleep();
        let mut bad = StepFlags(0);
        if !asleep {
            self.refresh(true);
            self.keep_good();
            bad = self.broken_inputs();
        }
        let (l, constants) = (self.layout, self.constants());
        let per_substep = if l.has_tethers() && self.pins.count > 0 { 3 } else { 2 };
        let phases = if asleep || bad.0 != 0 { 0 } else { self.def.substeps * per_substep };
        let carry = take(&mut rest, count * CARRY_ROWS * l.stride)?.as_mut_ptr();
        let borders = take(&mut rest, count * BORDER_ROWS * l.stride)?.as_mut_ptr();
        let mut anchors = [ptr::null_mut(); 3];
        if l.has_tethers() {
            for plane in &mut anchors {
                *plane = take(&mut rest, l.plane)?.as_mut_ptr();
            }
        }
        let counters = take(&mut rest, round16(count))?.as_mut_ptr().cast();
        let pull = self.has_pull.then_some([&*self.pull[0], &*self.pull[1], &*self.pull[2]]);
        let mut sweep = Sweep {
            layout: l,
            constants: &constants,
            x: &mut self.x,
            v: &mut self.v,
            springs: &self.springs,
            inverse: self.inverse,
            pull,
            carry: self.carry,
        };
        let mut pointers = sweep.pointers().ok_or(Error::BlockTooSmall)?;
        let parts = Parts::new(self);
        if l.force() {
            pointers.pull = Some(parts.forces(&l));
        }
        let plan = Plan {
            layout: l,
            constants,
            width: self.width,
            rate_hz: self.def.rate_hz,
            substeps: self.def.substeps,
            phases,
            rows_per_band,
            count,
            pointers,
            pins: self.pins.numbers.as_ptr(),
            pin_count: self.pins.count,
            parts,
            anchors,
            carry,
            borders,
            counters,
        };
        let cloth = ptr::from_mut(self).cast();
        Ok(Bands { cloth, plan, bad, asleep, ended: false, owner: PhantomData })
    }
}

impl Bands<'_> {
    /// How many bands there are.
    pub fn count(&self) -> u32 {
        self.plan.count as u32
    }

    /// Phases of the frame; 0 where there is nothing to step (a cloth that sleeps, or something that is not finite).
    pub fn phases(&self) -> u32 {
        self.plan.phases
    }

    /// Steps a band through a phase. Bands of one phase may run at the same time on any threads, in any order.
    ///
    /// Error: [`Error::OutOfRange`] (there is no such band; the phase is not the band's next one; another band has yet to end
    /// the phase before). Then nothing was done.
    pub fn run(&self, phase: u32, band: u32) -> Result<(), Error> {
        let p = &self.plan;
        let (at, ready) = (band as usize, phase.wrapping_mul(2));
        if phase >= p.phases || at >= p.count {
            return Err(Error::OutOfRange);
        }
        // all have ended the phase before: this phase's own marks are above
        if (0..p.count).any(|other| p.counter(other).load(Ordering::Acquire) < ready) {
            return Err(Error::OutOfRange);
        }
        let claim = p.counter(at).compare_exchange(ready, ready | 1, Ordering::Acquire, Ordering::Relaxed);
        if claim.is_err() {
            return Err(Error::OutOfRange);
        }
        in_default_environment(|| p.run(phase, at));
        p.counter(at).store(ready.wrapping_add(2), Ordering::Release);
        Ok(())
    }

    /// Ends the frame: what [`Cloth::step`] does after its substeps.
    ///
    /// Error: [`Error::OutOfRange`] (a band has phases to go). Then the frame is taken back as a whole, and the pins have not
    /// moved.
    pub fn end(mut self) -> Result<StepFlags, Error> {
        in_default_environment(|| self.end_frame())
    }

    fn end_frame(&mut self) -> Result<StepFlags, Error> {
        let all = (0..self.plan.count).all(|band| {
            // no other thread is left, so all counters are the last ones
            self.plan.counter(band).load(Ordering::Acquire) == self.plan.phases.wrapping_mul(2)
        });
        if !all {
            // dropped in the middle of the frame
            return Err(Error::OutOfRange);
        }
        self.ended = true;
        // SAFETY: the cloth is borrowed for the life of this value, and no band runs: that needs a `&self`.
        let cloth = unsafe { &mut *self.cloth };
        if self.asleep {
            return Ok(cloth.sleep_through());
        }
        let finite = self.bad.0 == 0 && cloth.is_finite();
        Ok(cloth.end_frame(self.bad, finite))
    }
}

impl Drop for Bands<'_> {
    fn drop(&mut self) {
        if !self.ended && self.plan.phases > 0 {
            // SAFETY: as in `end_frame`.
            unsafe { &mut *self.cloth }.back_to_good();
        }
    }
}

impl Plan {
    fn counter(&self, band: usize) -> &AtomicU32 {
        // SAFETY: there is one of each band in the memory that is borrowed with the cloth, and it is only used as an atomic.
        unsafe { AtomicU32::from_ptr(self.counters.wrapping_add(band)) }
    }

    /// Rows of a band, from and to.
    fn rows(&self, band: usize) -> [usize; 2] {
        let first = band * self.rows_per_band;
        [first, if band + 1 == self.count { self.layout.rows } else { first + self.rows_per_band }]
    }

    fn band(&self, band: usize) -> Rows {
        let l = &self.layout;
        let [first, end] = self.rows(band);
        let border = |band: usize| self.borders.wrapping_add(band * BORDER_ROWS * l.stride);
        let carry = self.carry.wrapping_add(band * CARRY_ROWS * l.stride);
        Rows {
            pointers: Pointers { carry, ..self.pointers },
            constants: self.constants,
            shear: l.shear,
            bend: l.bend,
            columns: l.columns,
            stride: l.stride,
            first,
            end,
            above: if band > 0 { border(band) } else { ptr::null_mut() },
            below: if band + 1 < self.count { border(band + 1) } else { ptr::null_mut() },
        }
    }

    fn run(&self, phase: u32, band: usize) {
        let per_substep = (self.phases / self.substeps.max(1)).max(1);
        let substep = phase / per_substep;
        let share = (substep + 1) as f32 / self.substeps as f32;
        match phase % per_substep {
            0 => {
                simd::run(self.width, Cross(self.band(band)));
                if self.layout.force() {
                    self.outer_forces(band, substep);
                }
            }
            1 => {
                let rows = self.band(band);
                if rows.above.is_null() {
                    // SAFETY: the carry of this band, which only it uses.
                    unsafe { ptr::write_bytes(rows.pointers.carry, 0, CARRY_ROWS * rows.stride) };
                }
                simd::run(self.width, Move(rows));
                self.place_pins(band, share);
            }
            _ => self.tether(band),
        }
        if phase % per_substep + 1 == per_substep {
            self.hold(band, share);
        }
    }

    /// The pins of the band's rows, as [`Cloth::place_pins`] does it.
    fn place_pins(&self, band: usize, share: f32) {
        let l = &self.layout;
        let [first, end] = self.rows(band);
        // SAFETY: the pins are borrowed with the cloth, and nobody writes them.
        let numbers = unsafe { core::slice::from_raw_parts(self.pins, self.pin_count * PIN_NUMBERS) };
        for i in 0..self.pin_count {
            let pin: Pin = pin_of(numbers, i);
            let row = pin.particle / l.columns.max(1);
            if !(first..end).contains(&row) {
                continue;
            }
            let at = row * l.stride + pin.particle % l.columns.max(1);
            let (here, velocity) = pin.at(share, self.rate_hz);
            for axis in 0..3 {
                // SAFETY: a place of the band's own rows; anchors are planes that begin at the plane's own beginning.
                unsafe {
                    *self.pointers.x[axis].wrapping_add(at) = here[axis];
                    *self.pointers.v[axis].wrapping_add(at) = velocity[axis];
                    if !self.anchors[axis].is_null() {
                        *self.anchors[axis].wrapping_add(l.row(0) + at) = here[axis];
                    }
                }
            }
        }
    }
}
