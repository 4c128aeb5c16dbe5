//! What the first cycle of a substep through the levels aims at, where they keep a limit.
//!
//! Springs that are far too soft for the load pull a sheet beyond any limit in every substep. A cycle that aims just below the
//! limit then leaves some of it, more cycles follow, they overshoot, the next substep needs none: the sheet boils and pays for it.
//! So the aim is lowered while one cycle is not enough, and raised slowly while the sheet stays well within its limit: at rest
//! every substep is one cycle with one aim, and moves nothing. The aim is state: it is in snapshots and in the hash.

use crate::strain_limit::TARGET;
use crate::{ClothDef, Error, Features};

/// How much lower the next aim is after a substep that needed more than one cycle.
const DROP: f32 = 0.1;
/// How much the aim rises in a second while no link is beyond [`KEPT_WELL`]. Faster, it comes back before a sheet is at rest.
const RISE_PER_S: f32 = 0.2;
/// The share of its limit that no link is beyond in a sheet that stays well within it.
pub(crate) const KEPT_WELL: f32 = 0.9;

/// The aim as a share of the limit, 0 to [`TARGET`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Aim {
    is_on: bool,
    share: [f32; 1],
    good: f32,
}

impl Aim {
    pub fn new(def: &ClothDef) -> Aim {
        let is_on = def.features.contains(Features::LEVELS) && def.level_cycles == 0;
        Aim { is_on, share: [TARGET], good: TARGET }
    }

    pub fn share(&self) -> f32 {
        self.share[0]
    }

    /// After a substep: `cycles` were needed, and `kept_well` says whether no link is beyond [`KEPT_WELL`].
    pub fn learn(&mut self, cycles: u32, kept_well: impl FnOnce() -> bool, dt: f32) {
        let aim = self.share[0];
        if self.is_on && cycles > 1 {
            self.share[0] = f32::max(aim - DROP, 0.0);
        } else if self.is_on && aim < TARGET && kept_well() {
            self.share[0] = f32::min(aim + RISE_PER_S * dt, TARGET);
        }
    }

    pub fn keep_good(&mut self) {
        self.good = self.share[0];
    }

    pub fn back_to_good(&mut self) {
        self.share[0] = self.good;
    }

    /// What a snapshot must hold: nothing where no limit is kept.
    pub fn state(&self) -> &[f32] {
        if self.is_on { &self.share } else { &[] }
    }

    /// What a hash must hold: a limit that never was hard to keep is in no bit.
    pub fn lowered(&self) -> &[f32] {
        if self.share[0] < TARGET { &self.share } else { &[] }
    }

    pub fn state_mut(&mut self) -> &mut [f32] {
        if self.is_on { &mut self.share } else { &mut [] }
    }

    /// Checks the state of a snapshot. Error: [`Error::OutOfRange`].
    pub fn check(aim: f32) -> Result<(), Error> {
        if (0.0..=TARGET).contains(&aim) { Ok(()) } else { Err(Error::OutOfRange) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_aim_falls_in_steps_rises_slowly_and_stays_within_its_range() {
        let kept = ClothDef { features: Features::LEVELS, ..ClothDef::default() };
        let mut aim = Aim::new(&kept);
        assert_eq!(aim.share(), TARGET);
        aim.learn(1, || panic!("the highest aim has nothing to ask"), 0.1);
        aim.learn(2, || true, 0.1);
        assert_eq!(aim.share(), TARGET - DROP);
        aim.learn(1, || false, 0.1);
        assert_eq!(aim.share(), TARGET - DROP);
        aim.learn(1, || true, 0.1);
        assert!((aim.share() - (TARGET - DROP + 0.02)).abs() < 1e-6);
        (0..99).for_each(|_| aim.learn(32, || false, 0.1));
        assert_eq!(aim.share(), 0.0);
        (0..99).for_each(|_| aim.learn(0, || true, 0.1));
        assert_eq!(aim.share(), TARGET);

        for def in [ClothDef { level_cycles: 1, ..kept }, ClothDef::default()] {
            let mut off = Aim::new(&def);
            off.learn(9, || true, 0.1);
            assert_eq!((off.share(), off.state()), (TARGET, &[][..]));
        }
        for bad in [-0.1, 1.0, f32::NAN] {
            assert_eq!(Aim::check(bad), Err(Error::OutOfRange));
        }
    }
}
