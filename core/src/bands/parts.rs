//! The optional parts of a substep on the rows of a band, with the bits of those on all rows ([`crate::passes`]).
#![allow(unsafe_code)] // pointers to planes that bands share: the phases of `crate::bands` see to who reads and writes what

use core::slice::{from_raw_parts, from_raw_parts_mut};

use super::Plan;
use crate::force::View;
use crate::layout::Layout;
use crate::passes::{Held, Holders, Loads, Outer};
use crate::tethers::{self, Pull, TETHERS, Tethers};
use crate::{Cloth, simd};

/// A plane or a list of the cloth that is only read while bands run.
#[derive(Clone, Copy)]
struct Lent {
    numbers: *const f32,
    len: usize,
}

impl Lent {
    fn new(numbers: &[f32]) -> Lent {
        Lent { numbers: numbers.as_ptr(), len: numbers.len() }
    }

    /// # Safety
    /// The cloth is borrowed for as long, and nobody writes the numbers meanwhile.
    unsafe fn get<'p>(self) -> &'p [f32] {
        // SAFETY: the caller's promise.
        unsafe { from_raw_parts(self.numbers, self.len) }
    }
}

/// What the parts need beside positions and velocities. A plane that the cloth does not have is empty.
#[derive(Clone, Copy)]
pub(super) struct Parts {
    outer: Outer,
    /// Planes of forces, from their beginnings on.
    force: [*mut f32; 3],
    pull: Option<[Lent; 3]>,
    inverse: Lent,
    mask: Lent,
    masses: Lent,
    targets: Lent,
    colliders: Lent,
    /// Smallest rest length in m.
    spacing: f32,
    tethers: [[*mut f32; TETHERS]; 3],
}

impl Parts {
    pub fn new(cloth: &mut Cloth<'_>) -> Parts {
        let t = &mut cloth.tethers;
        let tethers = [&mut t.pin, &mut t.length, &mut t.common].map(|pair| {
            let [first, second] = pair;
            [first.as_mut_ptr(), second.as_mut_ptr()]
        });
        let [x, y, z] = &cloth.pull;
        Parts {
            outer: cloth.outer(),
            pull: cloth.has_pull.then(|| [x, y, z].map(|plane| Lent::new(plane))),
            inverse: Lent::new(cloth.inverse),
            mask: Lent::new(cloth.mask),
            masses: Lent::new(cloth.masses),
            targets: Lent::new(cloth.targets.planes),
            colliders: Lent::new(cloth.colliders.numbers),
            spacing: cloth.grid.least_rest(),
            force: cloth.force.each_mut().map(|plane| plane.as_mut_ptr()),
            tethers,
        }
    }

    /// Column 0 of row 0 of the planes of forces, for the sweep to read.
    pub fn forces(&self, l: &Layout) -> [*const f32; 3] {
        self.force.map(|plane| plane.wrapping_add(l.row(0)).cast_const())
    }
}

/// The numbers of some rows of a plane, from its beginning on.
///
/// # Safety
/// The rows are in the plane, and nobody else uses them meanwhile.
unsafe fn rows_of<'p>(plane: *mut f32, l: &Layout, [first, end]: [usize; 2]) -> &'p mut [f32] {
    // SAFETY: the caller's promise.
    unsafe { from_raw_parts_mut(plane.wrapping_add(l.row(first)), (end - first) * l.stride) }
}

impl Plan {
    /// The beginnings of planes of which the pointers of the sweep name column 0 of row 0.
    fn planes(&self, of: [*mut f32; 3]) -> [*mut f32; 3] {
        of.map(|plane| plane.wrapping_sub(self.layout.row(0)))
    }

    /// The forces beside the springs on the band's particles.
    pub(super) fn outer_forces(&self, band: usize, substep: u32) {
        let (l, p, rows) = (&self.layout, &self.parts, self.rows(band));
        // SAFETY: in this phase nobody writes positions and velocities, and only this band uses the forces on its rows.
        unsafe {
            let view = |of: [*mut f32; 3]| {
                let [x, y, z] = self.planes(of).map(|plane| from_raw_parts(plane.cast_const(), l.plane));
                View { x, y, z }
            };
            let loads = Loads {
                layout: l,
                rows,
                x: view(self.pointers.x),
                v: view(self.pointers.v),
                inverse: p.inverse.get(),
                mask: p.mask.get(),
                masses: p.masses.get(),
                pull: p.pull.map(|pull| pull.map(|plane| plane.get())),
                force: p.force.map(|plane| rows_of(plane, l, rows)),
            };
            p.outer.sum(self.width, substep, loads);
        }
    }

    /// The tethers of the band's particles.
    pub(super) fn tether(&self, band: usize) {
        let (l, rows) = (&self.layout, self.rows(band));
        let [first, end] = rows;
        let [pin, length, common] = self.parts.tethers;
        // SAFETY: the numbers of the band's own rows, which no other band uses in this phase; a row begins at a multiple of
        // 16, as do the blocks of the tethers. The anchors are only read in this phase.
        unsafe {
            let blocks = |plane: *mut f32| {
                let first = plane.wrapping_add(l.row(first) / tethers::BLOCK);
                from_raw_parts_mut(first, (end - rows[0]) * l.stride / tethers::BLOCK)
            };
            let tethers = Tethers {
                pin: pin.map(|plane| rows_of(plane, l, rows)),
                length: length.map(|plane| rows_of(plane, l, rows)),
                common: common.map(blocks),
            };
            let anchors = self.anchors.map(|plane| from_raw_parts(plane.cast_const(), l.plane));
            let pull = Pull {
                rows: end - first,
                columns: l.columns,
                stride: l.stride,
                first: 0,
                x: self.planes(self.pointers.x).map(|plane| rows_of(plane, l, rows)),
                anchors: Some(anchors),
                tethers: &tethers,
                velocity: Some((
                    self.planes(self.pointers.v).map(|plane| rows_of(plane, l, rows)),
                    1.0 / self.constants.dt,
                )),
                look: false,
            };
            simd::run(self.width, pull);
        }
    }

    /// What targets and colliders hold of the band's particles, `share` (0 to 1) of the frame done.
    pub(super) fn hold(&self, band: usize, share: f32) {
        let (l, p, rows) = (&self.layout, &self.parts, self.rows(band));
        if !l.targets && l.max_colliders == 0 {
            return;
        }
        // SAFETY: positions and velocities of the band's own rows, which no other band uses in this phase.
        unsafe {
            let holders = Holders {
                layout: l,
                targets: p.targets.get(),
                colliders: p.colliders.get(),
                rate_hz: self.rate_hz,
                substeps: self.substeps,
                spacing: p.spacing,
            };
            let [first, end] = rows;
            let held = Held {
                rows,
                x: self.planes(self.pointers.x).map(|plane| rows_of(plane, l, rows)),
                v: self.planes(self.pointers.v).map(|plane| rows_of(plane, l, rows)),
                inverse: p.inverse.get().get(l.row(first)..l.row(end)).unwrap_or(&[]),
            };
            holders.hold(self.width, &self.constants, share, held);
        }
    }
}
