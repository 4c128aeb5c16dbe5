//! What changes while a cloth runs: gravity, damping, rest lengths.

mod common;

use common::{Random, bare, bits, cloth, near, positions, put, snapshot, squares, steps, stir};
use taut::{Budget, Cloth, ClothDef, Error, Families, Hash64, Vector3};

fn made(def: &ClothDef) -> Cloth<'static> {
    let mut c = cloth(&squares(7, 9, 0.1, Families::ALL), def);
    c.set_stiffness_uniform([800.0, 500.0, 100.0, 8.0]).unwrap();
    c
}

#[test]
fn gravity_changes_at_once() {
    let mut c = made(&ClothDef { damping_per_s: 0.0, speed_limit: 0.0, ..ClothDef::default() });
    steps(&mut c, 30);
    c.set_gravity([0.0, 0.0, 3.0]).unwrap();
    assert_eq!(c.gravity(), [0.0, 0.0, 3.0]);
    steps(&mut c, 60);
    let v = c.velocity(40).unwrap();
    near(v.y.into(), -9.81 * 0.5, 1e-4, "fell for half a second");
    near(v.z.into(), 3.0, 1e-4, "then was drawn for one");
}

/// Each substep takes the share c dt of the velocity.
#[test]
fn damping_changes_at_once_and_the_budget_with_it() {
    let mut c = made(&bare());
    c.set_stiffness_uniform([0.0; 4]).unwrap();
    for i in 0..63 {
        c.set_velocity(i, Vector3::new(1.0, 0.0, 0.0)).unwrap();
    }
    steps(&mut c, 10);
    assert_eq!(c.velocity(3).unwrap().x, 1.0);
    c.set_damping(20.0).unwrap();
    assert_eq!(c.damping(), 20.0);
    steps(&mut c, 96);
    near(c.velocity(3).unwrap().x.into(), (1.0f64 - 20.0 / 960.0).powi(96), 1e-5, "damped");
    c.set_stiffness_uniform([800.0, 500.0, 100.0, 8.0]).unwrap();
    let mut other = made(&ClothDef { damping_per_s: 20.0, ..bare() });
    assert_eq!(c.budget().unwrap(), other.budget().unwrap());
}

/// A cloth whose surroundings were changed is the cloth that was made in them.
#[test]
fn changed_surroundings_are_those_of_another_definition() {
    let other = ClothDef { gravity_m_s2: [1.0, 2.0, -3.0], damping_per_s: 5.0, ..ClothDef::default() };
    let mut a = made(&other);
    let mut b = made(&ClothDef::default());
    b.set_gravity(other.gravity_m_s2).unwrap();
    b.set_damping(5.0).unwrap();
    for c in [&mut a, &mut b] {
        c.pin(0).unwrap();
        steps(c, 50);
    }
    assert_eq!(bits(&a), bits(&b));
}

/// Snapshots from before and after a change, each restored into a cloth in the other state.
#[test]
fn the_surroundings_are_state() {
    let mut c = made(&ClothDef::default());
    c.pin(0).unwrap();
    c.pin(8).unwrap();
    steps(&mut c, 10);
    let future = |c: &mut Cloth<'_>| {
        let saved = snapshot(c);
        let hash = c.state_hash();
        steps(c, 20);
        (saved, hash, c.state_hash(), c.budget().unwrap())
    };
    let plain = future(&mut c);
    c.set_gravity([0.5, -3.0, 0.0]).unwrap();
    c.set_damping(9.0).unwrap();
    c.set_rest_scale([0.9, 1.1, 1.0]).unwrap();
    let changed = future(&mut c);
    assert!(changed.0.len() > plain.0.len());
    assert_ne!(changed.3, plain.3);
    for _ in 0..2 {
        for (i, (saved, now, then, report)) in [&plain, &changed].into_iter().enumerate() {
            c.restore(saved).unwrap();
            assert_eq!(c.state_hash(), *now);
            assert_eq!(c.gravity(), [[0.0, -9.81, 0.0], [0.5, -3.0, 0.0]][i]);
            assert_eq!((c.damping(), c.rest_scale()), [(2.0, [1.0; 3]), (9.0, [0.9, 1.1, 1.0])][i]);
            steps(&mut c, 20);
            assert_eq!((c.state_hash(), c.budget().unwrap()), (*then, *report));
        }
    }
    c.restore(&changed.0).unwrap();
    c.reset();
    assert_eq!((c.gravity(), c.damping(), c.rest_scale()), ([0.0, -9.81, 0.0], 2.0, [1.0; 3]));
}

#[test]
fn what_is_out_of_range_changes_nothing() {
    let mut c = made(&ClothDef::default());
    let hash = c.state_hash();
    let nan = f32::NAN;
    assert_eq!(c.set_gravity([nan, 0.0, 0.0]), Err(Error::NotFinite));
    assert_eq!(c.set_gravity([0.0, 1.1e4, 0.0]), Err(Error::OutOfRange));
    assert_eq!(c.set_damping(nan), Err(Error::NotFinite));
    assert_eq!(c.set_damping(-1.0), Err(Error::Negative));
    assert_eq!(c.set_damping(960.0), Err(Error::Damping));
    assert_eq!(c.set_rest_scale([1.0, nan, 1.0]), Err(Error::NotFinite));
    assert_eq!(c.set_rest_scale([1.0, 1.0, 0.49]), Err(Error::OutOfRange));
    assert_eq!(c.set_rest_scale([2.01, 1.0, 1.0]), Err(Error::OutOfRange));
    assert_eq!(c.state_hash(), hash);
    c.set_gravity(c.gravity()).unwrap();
    assert_eq!(c.state_hash(), hash, "the same again is no change");
}

/// Bytes that no cloth wrote, with the right checksum.
#[test]
fn a_forged_snapshot_cannot_bring_surroundings_that_the_calls_refuse() {
    let mut c = made(&ClothDef::default());
    c.set_damping(3.0).unwrap();
    let saved = snapshot(&mut c);
    let hash = c.state_hash();
    let first = 40 + 4 * 6 * 63;
    for (place, value, error) in [
        (1, 2e4f32, Error::OutOfRange),
        (3, -1.0, Error::Negative),
        (3, 1e3, Error::Damping),
        (3, f32::NAN, Error::NotFinite),
        (16, 0.0, Error::OutOfRange),
        (18, -1.0, Error::OutOfRange),
    ] {
        let mut forged = saved.clone();
        forged[first + 4 * place..][..4].copy_from_slice(&value.to_le_bytes());
        let end = forged.len() - 8;
        let mut h = Hash64::new();
        h.bulk(&forged[..end]);
        forged[end..].copy_from_slice(&h.finish().to_le_bytes());
        assert_eq!(c.restore(&forged), Err(error), "{place} {value}");
        assert_eq!(c.state_hash(), hash);
    }
    c.restore(&saved).unwrap();
}

/// A free sheet takes on the scaled lengths, u and v apart, and its strain is then 0.
#[test]
fn a_free_sheet_shrinks_and_grows() {
    let (warp, weft) = (0.7f32, 1.25f32);
    let diagonal = ((warp * warp + weft * weft) / 2.0).sqrt();
    let def = ClothDef { gravity_m_s2: [0.0; 3], damping_per_s: 20.0, ..ClothDef::default() };
    let mut c = cloth(&squares(6, 6, 0.1, Families::ALL), &def);
    c.set_stiffness_uniform([300.0, 300.0, 100.0, 6.0]).unwrap();
    c.set_rest_scale([warp, weft, diagonal]).unwrap();
    let s = c.strain();
    near(s.largest.into(), 1.0 / 0.7 - 1.0, 1e-5, "strain against the scaled length");
    steps(&mut c, 240);
    let x = positions(&c);
    near((x[1] - x[0]).norm().into(), 0.125, 1e-4, "along u");
    near((x[6] - x[0]).norm().into(), 0.07, 1e-4, "along v");
    near((x[7] - x[0]).norm().into(), 0.1 * 2f64.sqrt() * f64::from(diagonal), 1e-4, "across");
    assert!(c.strain().largest.abs() < 1e-4);
}

/// At the scaled lengths nothing pulls, bend springs included: a sheet put there stays there.
#[test]
fn the_scaled_sheet_is_at_rest() {
    for scale in [0.5f32, 0.75, 2.0] {
        let mut c = cloth(&squares(8, 8, 0.125, Families::ALL), &bare());
        c.set_stiffness_uniform([100.0, 100.0, 30.0, 2.0]).unwrap();
        c.set_rest_scale([scale; 3]).unwrap();
        let x: Vec<_> = positions(&c).iter().map(|p| p * scale).collect();
        put(&mut c, &x);
        steps(&mut c, 300);
        let moved = positions(&c).iter().zip(&x).fold(0.0f32, |a, (p, q)| a.max((p - q).norm()));
        assert!(moved < 2e-6, "{scale}: {moved} m");
    }
}

/// The extension is W/k whatever the length, so the strain is W / (k s L0).
#[test]
fn a_scaled_spring_is_as_stiff() {
    let def = ClothDef { damping_per_s: 8.0, ..ClothDef::default() };
    for scale in [0.5f32, 1.0, 1.5] {
        let mut c = cloth(&squares(6, 3, 0.1, Families::STRUCTURAL), &def);
        c.set_stiffness_uniform([100.0, 100.0, 0.0, 0.0]).unwrap();
        c.set_rest_scale([scale, 1.0, 1.0]).unwrap();
        for i in 0..3 {
            c.pin(i).unwrap();
        }
        steps(&mut c, 600);
        let weight = 5.0 * f64::from(c.particle_mass_kg()) * 9.81;
        near(c.strain().largest.into(), weight / (100.0 * 0.1 * f64::from(scale)), 2e-3, "top spring");
    }
}

/// A sheet held at twice its rest lengths is stiff across its springs too: structural ones alone have 4k + t 4k with
/// t = 1 - s = 1/2 instead of 4k at each particle, so the largest step is shorter by sqrt(2/3).
#[test]
fn the_tuned_budget_sees_the_tension() {
    let def = ClothDef { damping_per_s: 0.0, ..ClothDef::default() };
    let mut c = cloth(&squares(12, 12, 0.1, Families::STRUCTURAL), &def);
    c.set_stiffness_uniform([50.0, 50.0, 0.0, 0.0]).unwrap();
    let flat = c.budget().unwrap();
    c.set_rest_scale([0.5; 3]).unwrap();
    near(c.budget().unwrap().max_dt_s.into(), f64::from(flat.max_dt_s) * (2f64 / 3.0).sqrt(), 1e-5, "held");
    c.set_rest_scale([1.5; 3]).unwrap();
    near(c.budget().unwrap().max_dt_s.into(), flat.max_dt_s.into(), 1e-5, "slack");
}

/// Pinned all around, pre-stretched, at the limit of the budget (so uncut, uniform, and at rest while flat), no damping and no
/// clamps: a small motion stays small. Under the bound of the sheet without tension the tuned one of structural springs
/// blows up.
#[test]
fn a_pre_stretched_drum_is_stable() {
    for budget in [Budget::Certified, Budget::Tuned] {
        // bend springs would pull the rows beside the border inwards
        for (families, scale) in [(1, 0.5f32), (1, 0.8), (3, 0.5), (3, 0.8)] {
            let mut c = cloth(&squares(14, 14, 0.1, Families(families)), &ClothDef { budget, ..bare() });
            let k = [100.0, 100.0, 30.0, 2.0];
            c.set_stiffness_uniform(k).unwrap();
            c.set_rest_scale([scale; 3]).unwrap();
            for i in (0..196).filter(|i| i / 14 % 13 == 0 || i % 14 % 13 == 0) {
                c.pin(i).unwrap();
            }
            // without damping the largest dt goes with 1 / sqrt(k)
            let share = c.budget().unwrap().max_dt_s * 960.0;
            c.set_stiffness_uniform(k.map(|k| k * share * share * 0.9999)).unwrap();
            let report = c.budget().unwrap();
            assert!(report.cut_fraction == 0.0 && report.max_dt_s * 960.0 < 1.001, "{report:?}");
            stir(&mut c, &mut Random::new(5), 0.01);
            let start = c.kinetic_energy_j();
            steps(&mut c, 4000);
            let end = c.kinetic_energy_j();
            assert!(end < 4.0 * start, "{budget:?} {families} {scale}: {start} J became {end} J");
        }
    }
}
