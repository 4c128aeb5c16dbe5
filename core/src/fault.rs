//! What made a frame end with numbers that are not finite.
//!
//! The setters refuse such numbers, so what is left is memory that was overwritten and finite numbers that are too large.
//! The former is looked for at the start of a frame where it is cheap (a comparison could hide it in the middle of one), the
//! latter by dropping one input after the other and stepping the frame again until it stays finite: a frame that is taken back
//! costs up to six.

use crate::ambient::AIR_AT;
use crate::layout::PIN_NUMBERS;
use crate::{Air, Cloth, StepFlags};

/// Whether all numbers are finite. In integers, which need not be summed in an order: infinity and NaN have the exponent of
/// all ones.
pub(crate) fn all_finite(numbers: &[f32]) -> bool {
    const EXPONENT: u32 = 0x7f80_0000;
    let bad = |x: &f32| u32::from(x.to_bits() & EXPONENT == EXPONENT);
    numbers.iter().fold(0, |found, x| found | bad(x)) == 0
}

impl Cloth<'_> {
    /// Flags of the inputs that are not finite before the frame. Of forces it is seen afterwards.
    pub(crate) fn broken_inputs(&self) -> StepFlags {
        let mut flags = 0;
        let mut check = |numbers: &[f32], flag: StepFlags| {
            if !all_finite(numbers) {
                flags |= flag.0;
            }
        };
        check(self.pins.numbers.get(..PIN_NUMBERS * self.pins.count).unwrap_or(&[]), StepFlags::NON_FINITE_PIN);
        check(self.colliders.numbers, StepFlags::NON_FINITE_COLLIDER);
        check(self.targets.planes, StepFlags::NON_FINITE_TARGET);
        let (surroundings, air) = self.ambient.numbers.split_at(AIR_AT);
        check(air, StepFlags::NON_FINITE_AIR);
        check(surroundings, StepFlags::NON_FINITE_STATE);
        StepFlags(flags)
    }

    /// Names what a frame that was not finite would have had to do without. The pin targets, the forces and the ways of
    /// colliders and targets are dropped for good on the way; positions and velocities are left as they come.
    #[cold]
    #[inline(never)]
    pub(crate) fn find_cause(&mut self) -> StepFlags {
        if self.pull.iter().any(|p| !all_finite(p)) {
            return StepFlags::NON_FINITE_FORCE;
        }
        if self.has_pull {
            self.drop_forces();
            if self.stays_finite() {
                return StepFlags::NON_FINITE_FORCE;
            }
        }
        if self.pins.iter().any(|p| p.from != p.to) {
            self.drop_pin_ways();
            if self.stays_finite() {
                return StepFlags::NON_FINITE_PIN;
            }
        }
        if self.layout.max_colliders > 0 && self.collider_count() > 0 {
            self.finish_colliders(false);
            if self.stays_finite() {
                return StepFlags::NON_FINITE_COLLIDER;
            }
        }
        if self.layout.targets {
            self.finish_targets(false);
            if self.stays_finite() {
                return StepFlags::NON_FINITE_TARGET;
            }
        }
        if self.layout.air {
            let ambient = self.ambient;
            let air = Air { density_kg_m3: 0.0, ..Air::default() };
            self.ambient.set(AIR_AT, &air.numbers());
            let finite = self.stays_finite();
            self.ambient = ambient;
            if finite {
                return StepFlags::NON_FINITE_AIR;
            }
        }
        StepFlags::NON_FINITE_STATE
    }

    /// Whether the frame, stepped again with the inputs that are left, stays finite.
    #[inline(never)]
    fn stays_finite(&mut self) -> bool {
        self.back_to_good();
        self.implicit.reset();
        self.advance()
    }
}

#[cfg(test)]
mod tests {
    extern crate std;

    use super::*;
    use crate::{ClothDef, ColliderDef, Features, Grid, GridDef, Pose, Shape, Target, Vector3};
    use std::vec;
    use std::vec::Vec;

    fn made() -> Cloth<'static> {
        let grid = Grid::new(&GridDef { rows: 6, columns: 17, ..GridDef::default() }).unwrap();
        let features = Features::PULL.0 | Features::AIR.0 | Features::COLLIDERS.0 | Features::TARGETS.0;
        let def = ClothDef { features: Features(features), substeps: 4, ..ClothDef::default() };
        let block = vec![0.0; Cloth::memory(&grid, &def).unwrap()].leak();
        let mut c = Cloth::create(&grid, &def, block).unwrap();
        c.set_stiffness_uniform([100.0, 100.0, 30.0, 2.0]).unwrap();
        c.pin(0).unwrap();
        c.set_air(&Air { wind_m_s: [0.0, 0.0, 2.0], ..Air::default() }).unwrap();
        let pose = Pose::at(Vector3::new(0.5, -0.5, -3.0));
        c.add_collider(&ColliderDef::new(Shape::Sphere { radius_m: 0.1 }, pose)).unwrap();
        let place: Vec<_> = (0..grid.particles()).map(|i| c.position(i).unwrap()).collect();
        c.set_targets(Vector3::zeros(), |i| Target { position_m: place[i], normal: Vector3::z() }).unwrap();
        for _ in 0..3 {
            assert_eq!(c.step().unwrap(), StepFlags(0));
        }
        c
    }

    fn state(c: &Cloth<'_>) -> (u64, Vec<u32>) {
        let all = [&*c.x.x, &*c.x.y, &*c.x.z, &*c.v.x, &*c.v.y, &*c.v.z];
        (c.step_index, all.iter().flat_map(|p| p.iter().map(|x| x.to_bits())).collect())
    }

    /// Memory that was overwritten with what no setter takes: found in the same step, the cause named, the state as it was.
    #[test]
    fn each_broken_input_is_found_in_the_same_step_and_named() {
        type Break = fn(&mut Cloth<'_>, f32);
        let causes: [(StepFlags, Break); 8] = [
            (StepFlags::NON_FINITE_PIN, |c, x| c.pins.numbers[4] = x),
            (StepFlags::NON_FINITE_PIN, |c, x| c.pins.numbers[2] = x),
            (StepFlags::NON_FINITE_AIR, |c, x| c.ambient.numbers[AIR_AT] = x),
            (StepFlags::NON_FINITE_FORCE, |c, x| {
                let at = c.layout.at(3, 16);
                c.pull[1][at] = x;
                c.has_pull = true;
            }),
            (StepFlags::NON_FINITE_COLLIDER, |c, x| c.colliders.numbers[4] = x),
            (StepFlags::NON_FINITE_COLLIDER, |c, x| c.colliders.numbers[30] = x),
            (StepFlags::NON_FINITE_STATE, |c, x| c.ambient.numbers[1] = x),
            (StepFlags::NON_FINITE_STATE, |c, x| c.springs.u[c.layout.at(2, 3)] = x),
        ];
        for (i, (cause, damage)) in causes.into_iter().enumerate() {
            for x in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
                let mut c = made();
                let before = state(&c);
                damage(&mut c, x);
                let flags = c.step().unwrap();
                assert_eq!(flags.0, StepFlags::NON_FINITE.0 | cause.0, "{i}: {x}");
                assert_eq!(state(&c), before, "{i}: {x}");
            }
        }
    }

    /// Targets that are not finite reach the particles, where they hold them.
    #[test]
    fn a_broken_target_is_named() {
        let mut c = made();
        c.set_target_limits(|_| crate::TargetLimit { max_distance_m: 0.01, ..Default::default() }).unwrap();
        c.step().unwrap();
        let before = state(&c);
        let at = 6 * c.layout.plane + c.layout.at(2, 2);
        c.targets.planes[at] = f32::NAN;
        let flags = c.step().unwrap();
        assert_eq!(flags.0, StepFlags::NON_FINITE.0 | StepFlags::NON_FINITE_TARGET.0);
        assert_eq!(state(&c), before);
    }

    /// Two at a time are both named.
    #[test]
    fn two_causes_are_both_named() {
        let mut c = made();
        c.pins.numbers[4] = f32::NAN;
        c.ambient.numbers[AIR_AT + 2] = f32::NAN;
        let flags = c.step().unwrap();
        assert_eq!(flags.0, (StepFlags::NON_FINITE.0 | StepFlags::NON_FINITE_PIN.0 | StepFlags::NON_FINITE_AIR.0));
    }

    /// Numbers that the setters take, but that the step cannot carry: named by what the frame would have stayed finite without.
    /// The next frame, without it, is a good one.
    #[test]
    fn a_finite_input_that_runs_away_is_named() {
        let families = crate::Families(3);
        let grid = Grid::new(&GridDef { rows: 8, columns: 8, families, ..GridDef::default() }).unwrap();
        // no clamps: a flat sheet rests, a crumpled one explodes
        let def = ClothDef {
            features: Features::PULL,
            rate_hz: 1.0,
            substeps: 1000,
            gravity_m_s2: [0.0; 3],
            speed_limit: 0.0,
            compression_limit: false,
            damping_per_s: 0.0,
            ..ClothDef::default()
        };
        let mut block = vec![0.0; Cloth::memory(&grid, &def).unwrap()];
        let mut c = Cloth::create(&grid, &def, &mut block).unwrap();
        c.set_stiffness_uniform([1.0, 1.0, 1e6, 0.0]).unwrap();
        assert_eq!(c.step().unwrap(), StepFlags(0));
        for i in 0..64 {
            let f = |j: u32| 1e6 * (crate::noise::uniform(5, 3 * i + j) - 0.5);
            c.add_force(i as usize, Vector3::new(f(0), f(1), f(2))).unwrap();
        }
        let before = state(&c);
        let flags = c.step().unwrap();
        assert_eq!(flags.0, StepFlags::NON_FINITE.0 | StepFlags::NON_FINITE_FORCE.0);
        assert_eq!(state(&c), before);
        assert_eq!(c.step().unwrap(), StepFlags(0));
    }
}
