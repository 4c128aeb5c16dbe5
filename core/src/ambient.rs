use crate::{Air, Cloth, ClothDef, Error};

/// What surrounds a cloth and may change while it runs: gravity, damping, air, rest lengths. It is part of the state once
/// it was changed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Ambient {
    /// Gravity in m/s^2 at 0 to 2, damping in 1/s at 3, air at 4 to 15, scales of the rest lengths (weft, warp, diagonal) at
    /// 16 to 18.
    pub numbers: [f32; 19],
    /// Whether it is not that of the definition any more.
    pub changed: bool,
}

/// Where the numbers of the air begin.
pub(crate) const AIR_AT: usize = 4;
/// Where the scales of the rest lengths begin.
pub(crate) const REST_AT: usize = 16;

impl Ambient {
    /// That of the definition: still air, rest lengths as they are.
    pub fn new(def: &ClothDef) -> Ambient {
        let mut numbers = [0.0; 19];
        let [x, y, z] = def.gravity_m_s2;
        let first = [x, y, z, def.damping_per_s];
        for (to, from) in numbers.iter_mut().zip(first) {
            *to = from;
        }
        for (to, from) in numbers.iter_mut().skip(AIR_AT).zip(Air::default().numbers()) {
            *to = from;
        }
        for scale in numbers.iter_mut().skip(REST_AT) {
            *scale = 1.0;
        }
        Ambient { numbers, changed: false }
    }

    /// The number at a place.
    pub fn get(&self, at: usize) -> f32 {
        self.numbers.get(at).copied().unwrap_or(0.0)
    }

    /// Writes numbers from a place on.
    pub fn set(&mut self, at: usize, values: &[f32]) {
        for (to, from) in self.numbers.iter_mut().skip(at).zip(values) {
            self.changed |= *to != *from;
            *to = *from;
        }
    }

    /// Gravity in m/s^2.
    pub fn gravity(&self) -> [f32; 3] {
        [self.get(0), self.get(1), self.get(2)]
    }

    /// Damping in 1/s.
    pub fn damping(&self) -> f32 {
        self.get(3)
    }

    /// Factors of the rest lengths along u, along v, along the diagonals.
    pub fn rest_scale(&self) -> [f32; 3] {
        [self.get(REST_AT), self.get(REST_AT + 1), self.get(REST_AT + 2)]
    }
}

impl Cloth<'_> {
    /// Gravity from the next step on, in m/s^2, at most 1e4 in size.
    ///
    /// Errors: [`Error::NotFinite`], [`Error::OutOfRange`].
    pub fn set_gravity(&mut self, gravity_m_s2: [f32; 3]) -> Result<(), Error> {
        ClothDef { gravity_m_s2, ..self.def }.check()?;
        self.ambient.set(0, &gravity_m_s2);
        Ok(())
    }

    /// Gravity in m/s^2.
    pub fn gravity(&self) -> [f32; 3] {
        self.ambient.gravity()
    }

    /// Damping from the next step on, in 1/s. The budget depends on it and is computed anew.
    ///
    /// Errors: [`Error::NotFinite`], [`Error::Negative`], [`Error::Damping`].
    pub fn set_damping(&mut self, damping_per_s: f32) -> Result<(), Error> {
        ClothDef { damping_per_s, ..self.def }.check()?;
        self.stale |= damping_per_s != self.ambient.damping();
        self.ambient.set(3, &[damping_per_s]);
        Ok(())
    }

    /// Damping in 1/s.
    pub fn damping(&self) -> f32 {
        self.ambient.damping()
    }
}
