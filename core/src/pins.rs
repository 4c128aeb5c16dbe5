use crate::layout::{PIN_NUMBERS, read, write};
use crate::{Cloth, Error, Vector3};

/// The pinned particles, sorted by index: so the same set of pins is the same state, however it was made.
/// Each pin is [`PIN_NUMBERS`] numbers: particle index (below 2^24, so exact in f32), where it is, where it shall be at
/// the end of the next frame.
pub(crate) struct Pins<'a> {
    pub numbers: &'a mut [f32],
    pub count: usize,
    pub capacity: usize,
}

/// One pin, positions in the local frame in m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pin {
    pub particle: usize,
    pub from: [f32; 3],
    pub to: [f32; 3],
}

/// The pin of a number among [`Pins::numbers`].
pub(crate) fn pin_of(numbers: &[f32], i: usize) -> Pin {
    let n = |j: usize| read(numbers, i * PIN_NUMBERS + j);
    Pin { particle: n(0) as usize, from: [n(1), n(2), n(3)], to: [n(4), n(5), n(6)] }
}

impl Pin {
    /// Where it is at `share` (0 to 1) of the frame, and how fast it goes.
    pub fn at(&self, share: f32, rate_hz: f32) -> ([f32; 3], [f32; 3]) {
        let (mut here, mut velocity) = (self.to, [0.0; 3]);
        for a in 0..3 {
            let way = self.to[a] - self.from[a];
            if share < 1.0 {
                here[a] = self.from[a] + way * share;
            }
            velocity[a] = way * rate_hz;
        }
        (here, velocity)
    }
}

impl Pins<'_> {
    pub fn get(&self, i: usize) -> Pin {
        pin_of(self.numbers, i)
    }

    pub fn set(&mut self, i: usize, pin: Pin) {
        let values = [pin.particle as f32, pin.from[0], pin.from[1], pin.from[2], pin.to[0], pin.to[1], pin.to[2]];
        for (j, v) in values.into_iter().enumerate() {
            write(self.numbers, i * PIN_NUMBERS + j, v);
        }
    }

    pub fn iter(&self) -> impl Iterator<Item = Pin> {
        (0..self.count).map(|i| self.get(i))
    }

    fn remove(&mut self, place: usize) {
        for i in place + 1..self.count {
            let next = self.get(i);
            self.set(i - 1, next);
        }
        self.count -= 1;
    }

    /// Removes the pins of all particles that `keep` does not want.
    pub fn keep(&mut self, keep: impl Fn(usize) -> bool) {
        let mut kept = 0;
        for i in 0..self.count {
            let pin = self.get(i);
            if keep(pin.particle) {
                self.set(kept, pin);
                kept += 1;
            }
        }
        self.count = kept;
    }

    /// Ok: the place of the particle's pin. Err: the place where it would be.
    pub fn find(&self, particle: usize) -> Result<usize, usize> {
        let (mut low, mut high) = (0, self.count);
        while low < high {
            let middle = low + (high - low) / 2;
            let p = self.get(middle).particle;
            if p == particle {
                return Ok(middle);
            }
            if p < particle {
                low = middle + 1;
            } else {
                high = middle;
            }
        }
        Err(low)
    }
}

impl Cloth<'_> {
    /// Pins a particle where it is. A particle that is pinned already stays as it is.
    ///
    /// Errors: [`Error::NoSuchParticle`], [`Error::Absent`], [`Error::TooManyPins`].
    pub fn pin(&mut self, particle: usize) -> Result<(), Error> {
        let at = self.present_place(particle)?;
        let Err(place) = self.pins.find(particle) else {
            return Ok(());
        };
        if self.pins.count >= self.pins.capacity {
            return Err(Error::TooManyPins);
        }
        let here = self.local(at);
        self.pins.count += 1;
        for i in (place + 1..self.pins.count).rev() {
            let previous = self.pins.get(i - 1);
            self.pins.set(i, previous);
        }
        self.pins.set(place, Pin { particle, from: here, to: here });
        self.set_velocity_at(at, [0.0; 3]);
        self.stale = true;
        self.wake();
        Ok(())
    }

    /// Moves a pin: at the end of the next frame it is at `world_m`, and on the way there it is interpolated over the
    /// substeps. Without a new call it then stays.
    ///
    /// Errors: [`Error::NoSuchParticle`], [`Error::NotPinned`], [`Error::NotFinite`], [`Error::OutOfRange`] (more than
    /// 1e6 m from the cloth's origin).
    pub fn move_pin(&mut self, particle: usize, world_m: Vector3<f64>) -> Result<(), Error> {
        self.layout.place(particle)?;
        let Ok(place) = self.pins.find(particle) else {
            return Err(Error::NotPinned);
        };
        let to = self.to_local(world_m)?;
        let pin = self.pins.get(place);
        if to != pin.to {
            self.pins.set(place, Pin { to, ..pin });
            self.wake();
        }
        Ok(())
    }

    /// Frees a pinned particle; it keeps the velocity of its pin.
    ///
    /// Errors: [`Error::NoSuchParticle`], [`Error::NotPinned`].
    pub fn unpin(&mut self, particle: usize) -> Result<(), Error> {
        self.layout.place(particle)?;
        let Ok(place) = self.pins.find(particle) else {
            return Err(Error::NotPinned);
        };
        self.pins.remove(place);
        self.stale = true;
        self.wake();
        Ok(())
    }

    /// Number of pins.
    pub fn pin_count(&self) -> usize {
        self.pins.count
    }

    /// Indices of the pinned particles, ascending.
    pub fn pinned(&self) -> impl Iterator<Item = usize> {
        self.pins.iter().map(|p| p.particle)
    }

    /// Puts the pinned particles where they are at `share` (0 to 1) of the frame.
    pub(crate) fn place_pins(&mut self, share: f32) {
        let rate = self.def.rate_hz;
        for i in 0..self.pins.count {
            let pin = self.pins.get(i);
            let Ok(at) = self.layout.place(pin.particle) else {
                continue;
            };
            let (here, velocity) = pin.at(share, rate);
            self.set_position_at(at, here);
            self.set_velocity_at(at, velocity);
        }
    }

    /// The pins stay where they are.
    pub(crate) fn drop_pin_ways(&mut self) {
        for i in 0..self.pins.count {
            let pin = self.pins.get(i);
            self.pins.set(i, Pin { to: pin.from, ..pin });
        }
    }

    /// The next frame starts where this one ended.
    pub(crate) fn finish_pins(&mut self) {
        for i in 0..self.pins.count {
            let pin = self.pins.get(i);
            self.pins.set(i, Pin { from: pin.to, ..pin });
        }
    }
}
