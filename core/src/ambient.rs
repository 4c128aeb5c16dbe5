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

    /// Writes numbers from a place on. Returns whether one of them was another before.
    pub fn set(&mut self, at: usize, values: &[f32]) -> bool {
        let mut changed = false;
        for (to, from) in self.numbers.iter_mut().skip(at).zip(values) {
            // bits: -0 is another number, which the signs of sums can show
            changed |= to.to_bits() != from.to_bits();
            *to = *from;
        }
        self.changed |= changed;
        changed
    }

    /// Checks what may be anything, as the setters do. Errors: theirs.
    pub fn check(&self, def: &ClothDef) -> Result<(), Error> {
        ClothDef { gravity_m_s2: self.gravity(), damping_per_s: self.damping(), ..*def }.check()?;
        Air::from_numbers(|i| self.get(AIR_AT + i)).check()?;
        check_scale(self.rest_scale())
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
        if self.ambient.set(0, &gravity_m_s2) {
            self.wake();
        }
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
        if self.ambient.set(3, &[damping_per_s]) {
            self.stale = true;
            self.wake();
        }
        Ok(())
    }

    /// Damping in 1/s.
    pub fn damping(&self) -> f32 {
        self.ambient.damping()
    }

    /// Factors of the rest lengths from the next step on, 0.5 to 2: of the warp (structural and bend springs along v), the weft
    /// (those along u), and the diagonals. Below 1 the cloth shrinks, or is pre-stretched where pins hold it; above 1 it
    /// has slack. A sheet that is flat at rest without tension needs diagonals that fit the sides: with the weft w times a
    /// and the warp h times b, sqrt((w a)^2 + (h b)^2) / sqrt(w^2 + h^2). Strain is that against the scaled lengths. The
    /// stiffness k stays, and the inertia field keeps the distances of the grid; the budget is computed anew.
    ///
    /// Errors: [`Error::NotFinite`], [`Error::OutOfRange`].
    pub fn set_rest_scale(&mut self, [warp, weft, diagonal]: [f32; 3]) -> Result<(), Error> {
        let scale = [weft, warp, diagonal];
        check_scale(scale)?;
        if self.ambient.set(REST_AT, &scale) {
            self.stale = true;
            self.wake();
        }
        Ok(())
    }

    /// Factors of the rest lengths: warp, weft, diagonal.
    pub fn rest_scale(&self) -> [f32; 3] {
        let [weft, warp, diagonal] = self.ambient.rest_scale();
        [warp, weft, diagonal]
    }
}

fn check_scale(scale: [f32; 3]) -> Result<(), Error> {
    if !scale.iter().all(|s| s.is_finite()) {
        return Err(Error::NotFinite);
    }
    if !scale.iter().all(|s| (0.5..=2.0).contains(s)) {
        return Err(Error::OutOfRange);
    }
    Ok(())
}
