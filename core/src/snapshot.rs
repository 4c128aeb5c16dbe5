//! Snapshots: the state of a cloth as bytes, little-endian, the same on every target.
//!
//! | bytes | content |
//! |---|---|
//! | 0..8 | `TAUTSNAP` |
//! | 8..12, 12..16 | version 3, number of bytes |
//! | 16..24 | digest of grid, definition, masses and mask |
//! | 24..32 | step index |
//! | 32..36, 36..40 | number of pins, bits: 1 if forces are pending, 2 if the surroundings (gravity, damping, air, rest lengths) were changed, 4 if the frame was moved |
//! | then | the frame, if it was moved: position and rotation (x, y, z, w), seven f64 |
//! | then | x, y, z, vx, vy, vz: f32 `[rows][columns]` each |
//! | then | the pending forces, three times f32 `[rows][columns]`, if any |
//! | then | the state of the optional parts: surroundings if they were changed, colliders, targets, memory of BDF2, frames of quiet if the cloth may sleep, aim of the levels where they keep a limit |
//! | then | each pin: particle as f32, from x y z, to x y z |
//! | last 8 | [`Hash64::bulk`](crate::Hash64::bulk) of all bytes before |
//!
//! Left out, since they do not change by stepping: stiffness, inertia (it follows from the pins), masses and mask.
//!
//! The frame is in a snapshot (without it the next one would be a leap), but not in the hash: two machines that shift their
//! worlds differently agree on the local state.

use crate::aim::Aim;
use crate::ambient::Ambient;
use crate::frame::Frame;
use crate::layout::{PIN_NUMBERS, read};
use crate::mask::is_absent;
use crate::{Cloth, Error, Hash64, in_default_environment};

const MAGIC: &[u8; 8] = b"TAUTSNAP";
const VERSION: u32 = 3;
const HEADER: usize = 40;
/// Bits of the flags.
const PULL: u32 = 1;
const AMBIENT: u32 = 2;
const FRAME: u32 = 4;
/// Bytes of the frame.
const FRAME_BYTES: usize = 56;

impl Cloth<'_> {
    /// Bytes of a snapshot of the cloth as it is now.
    pub fn snapshot_size(&self) -> usize {
        self.size_of_snapshot(self.pins.count, self.flags())
    }

    /// Bytes that every snapshot of this cloth fits in.
    pub fn snapshot_size_max(&self) -> usize {
        self.size_of_snapshot(self.pins.capacity, FRAME | AMBIENT | if self.layout.pull { PULL } else { 0 })
    }

    fn flags(&self) -> u32 {
        (if self.has_pull { PULL } else { 0 })
            | (if self.ambient.changed { AMBIENT } else { 0 })
            | (if self.frame != Frame::new(&self.def) { FRAME } else { 0 })
    }

    fn size_of_snapshot(&self, pins: usize, flags: u32) -> usize {
        let planes = if flags & PULL != 0 { 9 } else { 6 };
        let ambient = if flags & AMBIENT != 0 { self.ambient.numbers.len() } else { 0 };
        let parts: usize = self.parts().iter().map(|p| p.len()).sum();
        let frame = if flags & FRAME != 0 { FRAME_BYTES } else { 0 };
        HEADER + frame + 4 * (planes * self.grid.particles() + ambient + parts + PIN_NUMBERS * pins) + 8
    }

    /// The state of the optional parts, empty where they are off.
    fn parts(&self) -> [&[f32]; 5] {
        [self.colliders.numbers, self.targets.planes, self.implicit.state(), self.sleep.state(), self.aim.state()]
    }

    fn digest(&self) -> u64 {
        let mut h = Hash64::new();
        let g = self.grid.digest();
        h.words(&[g as u32, (g >> 32) as u32]);
        self.def.digest(&mut h);
        if self.layout.mass || self.layout.mask {
            h.words(&[self.matter as u32, (self.matter >> 32) as u32]);
        }
        h.finish()
    }

    /// 64-bit hash of the state: step index, positions, velocities, pending forces, pins.
    ///
    /// Like a snapshot it first settles what a change of pins does to inertia and velocities, which is why it is `mut`.
    pub fn state_hash(&mut self) -> u64 {
        self.refresh(true);
        let mut h = Hash64::new();
        h.words(&[self.step_index as u32, (self.step_index >> 32) as u32, self.pins.count as u32]);
        self.each_row(|row| h.floats(row));
        if self.ambient.changed {
            h.floats(&self.ambient.numbers);
        }
        let [parts @ .., _] = self.parts();
        for part in parts.into_iter().chain([self.aim.lowered()]) {
            if !part.is_empty() {
                h.floats(part);
            }
        }
        h.floats(self.pins.numbers.get(..PIN_NUMBERS * self.pins.count).unwrap_or(&[]));
        h.finish()
    }

    /// The rows of the planes that are state, in the order of the snapshot.
    fn each_row(&self, mut visit: impl FnMut(&[f32])) {
        let l = self.layout;
        let state = [&*self.x.x, &*self.x.y, &*self.x.z, &*self.v.x, &*self.v.y, &*self.v.z];
        let pull = if self.has_pull { self.pull.as_slice() } else { &[] };
        for plane in state.into_iter().chain(pull.iter().map(|p| &**p)) {
            for row in 0..l.rows {
                visit(crate::layout::span(plane, l.row(row), l.columns));
            }
        }
    }

    /// Writes the state. Returns the number of bytes written, [`Cloth::snapshot_size`].
    ///
    /// Error: [`Error::BlockTooSmall`]; then nothing is written.
    pub fn snapshot(&mut self, out: &mut [u8]) -> Result<usize, Error> {
        self.refresh(true);
        let size = self.snapshot_size();
        let out = out.get_mut(..size).ok_or(Error::BlockTooSmall)?;
        let (body, mut tail) = out.split_at_mut_checked(size - 8).ok_or(Error::BlockTooSmall)?;
        let mut rest = &mut *body;
        put(&mut rest, MAGIC);
        put(&mut rest, &VERSION.to_le_bytes());
        put(&mut rest, &(size as u32).to_le_bytes());
        put(&mut rest, &self.digest().to_le_bytes());
        put(&mut rest, &self.step_index.to_le_bytes());
        put(&mut rest, &(self.pins.count as u32).to_le_bytes());
        put(&mut rest, &self.flags().to_le_bytes());
        if self.flags() & FRAME != 0 {
            for number in self.frame.numbers() {
                put(&mut rest, &number.to_le_bytes());
            }
        }
        self.each_row(|row| put_floats(&mut rest, row));
        if self.ambient.changed {
            put_floats(&mut rest, &self.ambient.numbers);
        }
        for part in self.parts() {
            put_floats(&mut rest, part);
        }
        put_floats(&mut rest, self.pins.numbers.get(..PIN_NUMBERS * self.pins.count).unwrap_or(&[]));
        let mut h = Hash64::new();
        h.bulk(body);
        put(&mut tail, &h.finish().to_le_bytes());
        Ok(size)
    }

    /// Reads a state back. The whole snapshot is checked before anything is changed.
    ///
    /// Errors: [`Error::Truncated`], [`Error::WrongKind`], [`Error::UnsupportedVersion`], [`Error::Foreign`] (another
    /// grid or definition, other masses, another mask), [`Error::Checksum`], [`Error::Shape`]; for bytes that no cloth wrote
    /// [`Error::NotFinite`], [`Error::OutOfRange`], [`Error::Negative`], [`Error::Damping`], [`Error::NoSuchParticle`],
    /// [`Error::Absent`].
    pub fn restore(&mut self, bytes: &[u8]) -> Result<(), Error> {
        in_default_environment(|| self.take_over(bytes))
    }

    fn take_over(&mut self, bytes: &[u8]) -> Result<(), Error> {
        let (header, _) = bytes.split_at_checked(HEADER).ok_or(Error::Truncated)?;
        if !header.starts_with(MAGIC) {
            return Err(Error::WrongKind);
        }
        if u32_at(header, 8) != VERSION {
            return Err(Error::UnsupportedVersion);
        }
        let size = u32_at(header, 12) as usize;
        let bytes = bytes.get(..size).ok_or(Error::Truncated)?;
        let (pins, flags) = (u32_at(header, 32) as usize, u32_at(header, 36));
        let pull = flags & PULL != 0;
        if u64_at(header, 16) != self.digest() {
            return Err(Error::Foreign);
        }
        if pins > self.pins.capacity
            || flags > PULL | AMBIENT | FRAME
            || (pull && !self.layout.pull)
            || size != self.size_of_snapshot(pins, flags)
        {
            return Err(Error::Shape);
        }
        let (body, tail) = bytes.split_at_checked(size - 8).ok_or(Error::Truncated)?;
        let mut h = Hash64::new();
        h.bulk(body);
        if u64_at(tail, 0) != h.finish() {
            return Err(Error::Checksum);
        }
        let mut from = HEADER;
        let mut frame = Frame::new(&self.def);
        if flags & FRAME != 0 {
            let number = |i: usize| f64::from_bits(u64_at(body, HEADER + 8 * i));
            frame = Frame::from_numbers([number(0), number(1), number(2), number(3), number(4), number(5), number(6)])
                .checked()?;
            from += FRAME_BYTES;
        }
        let (numbers, _) = body.get(from..).unwrap_or(&[]).as_chunks::<4>();
        let number = |i: usize| numbers.get(i).map_or(0.0, |b| f32::from_le_bytes(*b));
        if !all_finite(numbers) {
            return Err(Error::NotFinite);
        }
        self.check_numbers(&number, numbers.len(), pins)?;
        // where the parts begin
        let mut parts_at = self.grid.particles() * if pull { 9 } else { 6 };
        let mut ambient = Ambient::new(&self.def);
        if flags & AMBIENT != 0 {
            for to in &mut ambient.numbers {
                *to = number(parts_at);
                parts_at += 1;
            }
            ambient.changed = true;
            ambient.check(&self.def)?;
        }
        if self.layout.max_colliders > 0 {
            crate::colliders::check_stored(&number, parts_at)?;
        }
        if self.layout.targets {
            crate::targets::check_stored(&number, parts_at + self.colliders.numbers.len(), &self.layout)?;
        }

        let l = self.layout;
        let planes = [&mut *self.x.x, &mut *self.x.y, &mut *self.x.z, &mut *self.v.x, &mut *self.v.y, &mut *self.v.z];
        let pull_planes = if pull { self.pull.as_mut_slice() } else { &mut [] };
        let mut next = 0;
        for plane in planes.into_iter().chain(pull_planes.iter_mut().map(|p| &mut **p)) {
            let from = numbers.get(next..next + self.grid.particles()).unwrap_or(&[]);
            for (row, from) in from.chunks_exact(l.columns.max(1)).enumerate() {
                take_floats(plane.get_mut(l.row(row)..).unwrap_or(&mut []), from);
            }
            next += self.grid.particles();
        }
        // the budget depends on them
        self.stale |= self.ambient.damping() != ambient.damping() || self.ambient.rest_scale() != ambient.rest_scale();
        let drag = self.drag_share();
        self.ambient = ambient;
        self.stale |= drag != self.drag_share();
        self.frame = frame;
        let parts = [
            &mut *self.colliders.numbers,
            &mut *self.targets.planes,
            self.implicit.state_mut(),
            self.sleep.state_mut(),
            self.aim.state_mut(),
        ];
        let mut next = parts_at;
        for part in parts {
            for to in part {
                *to = number(next);
                next += 1;
            }
        }
        let first = numbers.len() - PIN_NUMBERS * pins;
        debug_assert_eq!(next, first);
        let same = pins == self.pins.count
            && (0..pins).all(|i| read(self.pins.numbers, i * PIN_NUMBERS) == number(first + i * PIN_NUMBERS));
        for (i, to) in self.pins.numbers.iter_mut().enumerate().take(PIN_NUMBERS * pins) {
            *to = number(first + i);
        }
        self.pins.count = pins;
        if self.has_pull && !pull {
            // a force that is pending now must not be added to one that is added later
            for p in &mut self.pull {
                p.fill(0.0);
            }
        }
        self.has_pull = pull;
        self.step_index = u64_at(header, 24);
        if !same || self.stale {
            // velocities were stored for the inertia of these pins: the momentum must not be kept a second time
            self.stale = true;
            self.refresh(false);
        }
        Ok(())
    }

    /// A snapshot holds a possible sleep, a possible aim, and ascending pins of existing particles.
    fn check_numbers(&self, number: &impl Fn(usize) -> f32, count: usize, pins: usize) -> Result<(), Error> {
        let first = count - PIN_NUMBERS * pins;
        // the last of the parts
        let aim = first - self.aim.state().len();
        if aim < first {
            Aim::check(number(aim))?;
        }
        if !self.sleep.state().is_empty() {
            self.sleep.check(number(aim - 1))?;
        }
        let mut least = 0.0;
        for i in 0..pins {
            let particle = number(first + i * PIN_NUMBERS);
            if self.layout.place(particle as usize).is_ok_and(|at| is_absent(self.mask, at)) {
                return Err(Error::Absent);
            }
            if particle < least || particle >= self.grid.particles() as f32 || particle != libm::floorf(particle) {
                return Err(Error::NoSuchParticle);
            }
            least = particle + 1.0;
        }
        Ok(())
    }
}

/// Whether no number has the exponent of infinity and NaN: in integers, which need not be summed in an order.
fn all_finite(numbers: &[[u8; 4]]) -> bool {
    const EXPONENT: u32 = 0x7f80_0000;
    let mut carried = 0u32;
    for b in numbers {
        // a full exponent carries into the sign
        carried |= (u32::from_le_bytes(*b) & EXPONENT) + (1 << 23);
    }
    carried >> 31 == 0
}

/// Bytes to the numbers that a row begins with. In blocks of eight: a row is short, and a loop over single numbers has more
/// to prepare than to copy.
#[inline(always)]
fn take_floats(to: &mut [f32], from: &[[u8; 4]]) {
    let (to, _) = to.split_at_mut_checked(from.len()).unwrap_or_default();
    let (blocks, rest) = to.as_chunks_mut::<8>();
    let (from_blocks, from_rest) = from.as_chunks::<8>();
    for (to, from) in blocks.iter_mut().zip(from_blocks) {
        *to = from.map(f32::from_le_bytes);
    }
    for (to, from) in rest.iter_mut().zip(from_rest) {
        *to = f32::from_le_bytes(*from);
    }
}

fn put(rest: &mut &mut [u8], bytes: &[u8]) {
    if let Some((head, tail)) = core::mem::take(rest).split_at_mut_checked(bytes.len()) {
        head.copy_from_slice(bytes);
        *rest = tail;
    }
}

fn put_floats(rest: &mut &mut [u8], values: &[f32]) {
    if let Some((head, tail)) = core::mem::take(rest).split_at_mut_checked(4 * values.len()) {
        let (to_blocks, to_rest) = head.as_chunks_mut::<4>().0.as_chunks_mut::<8>();
        let (blocks, last) = values.as_chunks::<8>();
        for (to, from) in to_blocks.iter_mut().zip(blocks) {
            *to = from.map(f32::to_le_bytes);
        }
        for (to, from) in to_rest.iter_mut().zip(last) {
            *to = from.to_le_bytes();
        }
        *rest = tail;
    }
}

/// A little-endian u32 at a place, 0 outside.
pub(crate) fn u32_at(bytes: &[u8], at: usize) -> u32 {
    bytes.get(at..).and_then(|b| b.first_chunk::<4>()).map_or(0, |b| u32::from_le_bytes(*b))
}

/// A little-endian u64 at a place, 0 outside.
pub(crate) fn u64_at(bytes: &[u8], at: usize) -> u64 {
    bytes.get(at..).and_then(|b| b.first_chunk::<8>()).map_or(0, |b| u64::from_le_bytes(*b))
}
