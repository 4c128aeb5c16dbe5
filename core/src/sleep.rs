//! Sleep: a cloth at rest costs almost nothing.
//!
//! When every particle has been slower than [`ClothDef::sleep_speed_m_s`] at the end of each frame for half a second, the
//! velocities are set to zero and the positions stay: a frame is then only counted. Every call that changes something wakes
//! the cloth and starts the half second anew, so a cloth whose pins or colliders are moved in every frame never falls
//! asleep. How long it has been quiet is state: it is in snapshots and in the hash.

use crate::layout::span;
use crate::{Cloth, ClothDef, Error};

/// How long the particles must be slow, in s.
const QUIET_S: f32 = 0.5;

/// How close a cloth is to sleep.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sleep {
    /// The square of the speed; 0 = never.
    speed2: f32,
    /// Frames that must be quiet.
    needed: f32,
    /// Frames that were quiet so far: a whole number, at most `needed`; that many is asleep.
    quiet: [f32; 1],
}

impl Sleep {
    pub fn new(def: &ClothDef) -> Sleep {
        let speed = def.sleep_speed_m_s;
        let needed = libm::ceilf(QUIET_S * def.rate_hz);
        Sleep { speed2: speed * speed, needed, quiet: [0.0] }
    }

    fn is_on(&self) -> bool {
        self.speed2 > 0.0
    }

    pub fn is_asleep(&self) -> bool {
        self.quiet[0] >= self.needed
    }

    /// What a snapshot must hold: nothing where the cloth never sleeps.
    pub fn state(&self) -> &[f32] {
        if self.is_on() { &self.quiet } else { &[] }
    }

    pub fn state_mut(&mut self) -> &mut [f32] {
        if self.is_on() { &mut self.quiet } else { &mut [] }
    }

    /// Checks the state of a snapshot. Error: [`Error::OutOfRange`].
    pub fn check(&self, quiet: f32) -> Result<(), Error> {
        let whole = quiet == libm::floorf(quiet);
        if (0.0..=self.needed).contains(&quiet) && whole { Ok(()) } else { Err(Error::OutOfRange) }
    }
}

impl Cloth<'_> {
    /// Whether the cloth sleeps.
    pub fn is_asleep(&self) -> bool {
        self.sleep.is_asleep()
    }

    /// Wakes the cloth. Calls that change something do it by themselves.
    pub fn wake(&mut self) {
        self.sleep.quiet = [0.0];
    }

    /// Called at the end of a frame: counts the quiet ones, and puts the cloth to sleep.
    pub(crate) fn settle(&mut self, finite: bool) {
        if !self.sleep.is_on() {
            return;
        }
        // a gust may come at any time
        let gusty = self.air().is_ok_and(|air| air.gust > 0.0);
        if !finite || gusty || !self.is_slow() {
            self.wake();
            return;
        }
        self.sleep.quiet[0] += 1.0;
        if self.sleep.is_asleep() {
            for v in [&mut *self.v.x, &mut *self.v.y, &mut *self.v.z] {
                v.fill(0.0);
            }
        }
    }

    fn is_slow(&self) -> bool {
        let l = self.layout;
        (0..l.rows).all(|row| {
            let [x, y, z] = [&self.v.x, &self.v.y, &self.v.z].map(|v| span(v, l.row(row), l.columns));
            x.iter().zip(y).zip(z).all(|((x, y), z)| x * x + y * y + z * z < self.sleep.speed2)
        })
    }
}
