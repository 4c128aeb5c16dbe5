//! Sleep: when it begins, what it leaves, and that every call that changes something ends it.

mod common;

use common::{bits, cloth, positions, snapshot, squares, steps, velocities};
use taut::{Cloth, ClothDef, Error, Families, Features, Hash64, Pose, StepFlags, Vector3};

fn def() -> ClothDef {
    ClothDef {
        sleep_speed_m_s: 0.01,
        damping_per_s: 10.0,
        features: Features(Features::PULL.0 | Features::MASK.0 | Features::MASS.0),
        ..ClothDef::default()
    }
}

fn hanging(def: &ClothDef) -> Cloth<'static> {
    let mut c = cloth(&squares(8, 8, 0.1, Families::ALL), def);
    c.set_stiffness_uniform([900.0, 700.0, 200.0, 10.0]).unwrap();
    c.pin(0).unwrap();
    c.pin(7).unwrap();
    c
}

/// Frames until it sleeps.
fn fall_asleep(c: &mut Cloth<'_>) -> u32 {
    for frame in 1..2000 {
        assert_eq!(c.step().unwrap(), StepFlags(0));
        if c.is_asleep() {
            return frame;
        }
    }
    panic!("it never sleeps");
}

fn fastest(c: &Cloth<'_>) -> f32 {
    velocities(c).iter().fold(0.0, |a, v| a.max(v.norm()))
}

/// Up to the frame in which it falls asleep it has the bits of a cloth that never sleeps; that is the 30th in a row in which
/// all are slow. Then only the index changes.
#[test]
fn it_sleeps_after_half_a_second_of_quiet_and_stays_as_it_is() {
    let (mut c, mut awake) = (hanging(&def()), hanging(&ClothDef { sleep_speed_m_s: 0.0, ..def() }));
    let mut quiet = 0;
    for _ in 0..2000 {
        steps(&mut awake, 1);
        quiet = if fastest(&awake) < 0.01 { quiet + 1 } else { 0 };
        assert_eq!(c.step().unwrap(), StepFlags(0));
        assert_eq!(c.is_asleep(), quiet == 30);
        assert_eq!(positions(&c), positions(&awake));
        if quiet == 30 {
            break;
        }
        assert_eq!(bits(&c), bits(&awake));
    }
    assert!(c.is_asleep());
    assert!(velocities(&c).iter().all(|v| *v == Vector3::zeros()));
    let (index, before) = (c.step_index(), bits(&c));
    for i in 1..=100 {
        assert_eq!(c.step().unwrap(), StepFlags::ASLEEP);
        assert_eq!(c.step_index(), index + i);
    }
    assert_eq!(bits(&c), before);
    // it was at rest: awake again it goes nowhere, and sleeps again after half a second
    c.wake();
    assert_eq!(fall_asleep(&mut c), 30);
    let moved = positions(&c).iter().zip(positions(&awake)).fold(0.0f32, |a, (p, q)| a.max((p - q).norm()));
    assert!(moved < 0.002, "{moved} m");
}

#[test]
fn without_a_speed_it_never_sleeps() {
    let mut c = hanging(&ClothDef { sleep_speed_m_s: 0.0, damping_per_s: 30.0, ..def() });
    for _ in 0..1500 {
        assert_eq!(c.step().unwrap(), StepFlags(0));
    }
    assert!(!c.is_asleep() && fastest(&c) < 1e-3);
}

type Call = fn(&mut Cloth<'_>);

/// Everything that changes something.
const WAKING: [(&str, Call); 19] = [
    ("wake", |c| c.wake()),
    ("pin", |c| c.pin(30).unwrap()),
    ("move_pin", |c| c.move_pin(0, Vector3::new(0.0, 0.001, 0.0)).unwrap()),
    ("unpin", |c| c.unpin(7).unwrap()),
    ("set_position", |c| c.set_position(20, Vector3::new(0.3, -0.3, 0.0)).unwrap()),
    ("set_velocity", |c| c.set_velocity(20, Vector3::new(0.0, 0.0, 1.0)).unwrap()),
    ("add_force", |c| c.add_force(20, Vector3::new(0.0, 0.0, 0.1)).unwrap()),
    ("set_stiffness_uniform", |c| c.set_stiffness_uniform([500.0; 4]).unwrap()),
    ("set_gravity", |c| c.set_gravity([0.0, -5.0, 0.0]).unwrap()),
    ("set_damping", |c| c.set_damping(3.0).unwrap()),
    ("set_rest_scale", |c| c.set_rest_scale([1.0, 0.9, 1.0]).unwrap()),
    ("set_masses", |c| {
        let m = c.particle_mass_kg();
        c.set_masses(&[2.0 * m; 64]).unwrap();
    }),
    ("set_mask", |c| {
        let mut mask = [1; 64];
        mask[60] = 0;
        c.set_mask(&mask).unwrap();
    }),
    ("set_frame", |c| c.set_frame(&Pose { position_m: [0.01, 0.0, 0.0].into(), ..c.frame() }, 1.0, 1.0).unwrap()),
    ("set_frame without inertia", |c| {
        c.set_frame(&Pose { position_m: [0.01, 0.0, 0.0].into(), ..c.frame() }, 0.0, 0.0).unwrap();
    }),
    ("a turn", |c| c.set_frame(&Pose { rotation: [0.0, 0.1, 0.0, 1.0], ..c.frame() }, 1.0, 0.0).unwrap()),
    ("a turning teleport", |c| c.teleport(&Pose { rotation: [0.1, 0.0, 0.0, 1.0], ..c.frame() }).unwrap()),
    ("reset", |c| c.reset()),
    ("load_stiffness", |c| {
        let mut file = [0; 1024];
        let fabric = taut::baked::Fabric::default();
        let n = taut::baked::write(2, 2, &[300.0; 16], &fabric, 1, "denim", &mut file).unwrap();
        c.load_stiffness(&file[..n]).unwrap();
    }),
];

#[test]
fn whatever_changes_something_wakes_it() {
    for (name, call) in WAKING {
        let mut c = hanging(&def());
        fall_asleep(&mut c);
        let before = positions(&c);
        call(&mut c);
        assert!(!c.is_asleep(), "{name}");
        for _ in 0..29 {
            assert_eq!(c.step().unwrap(), StepFlags(0), "{name}");
        }
        let moved = positions(&c).iter().zip(before).fold(0.0f32, |a, (p, q)| a.max((p - q).norm()));
        let at_rest = ["wake", "pin", "set_damping"].contains(&name);
        assert!(at_rest || moved > 1e-4, "{name}: {moved} m");
    }
}

/// Looking at it, and calls that tell it what it knows.
#[test]
fn what_changes_nothing_lets_it_sleep() {
    let mut c = hanging(&def());
    fall_asleep(&mut c);
    let hash = c.state_hash();
    c.pin(7).unwrap();
    c.move_pin(0, c.world_position(0).unwrap()).unwrap();
    c.set_gravity(c.gravity()).unwrap();
    c.set_damping(c.damping()).unwrap();
    c.set_rest_scale([1.0; 3]).unwrap();
    c.set_mask(&[1; 64]).unwrap();
    let m = c.particle_mass_kg();
    c.set_masses(&[m; 64]).unwrap();
    c.set_frame(&c.frame(), 1.0, 1.0).unwrap();
    c.teleport(&Pose { position_m: [1e6, 0.0, 0.0].into(), ..c.frame() }).unwrap();
    c.set_origin(Vector3::new(5.0, 0.0, 0.0)).unwrap();
    c.budget().unwrap();
    c.pin_force(0).unwrap();
    c.strain();
    snapshot(&mut c);
    c.pin(99).unwrap_err();
    c.set_gravity([f32::NAN; 3]).unwrap_err();
    assert_eq!(c.state_hash(), hash);
    assert_eq!(c.step().unwrap(), StepFlags::ASLEEP);
}

/// A pin that crawls far below the speed, a force that is too small to move anything: as long as they go on it is awake.
#[test]
fn it_does_not_sleep_while_something_acts() {
    let mut c = hanging(&ClothDef { damping_per_s: 30.0, ..def() });
    for i in 0..400 {
        c.move_pin(0, Vector3::new(0.0, 1e-5 * f64::from(i), 0.0)).unwrap();
        assert_eq!(c.step().unwrap(), StepFlags(0));
    }
    assert!(fastest(&c) < 0.01);
    for _ in 0..100 {
        c.add_force(30, Vector3::new(0.0, 1e-6, 0.0)).unwrap();
        assert_eq!(c.step().unwrap(), StepFlags(0));
    }
    assert!(!c.is_asleep());
    assert_eq!(fall_asleep(&mut c), 29, "the last frame with a force was quiet too");
}

/// How long it has been quiet is state: from any frame the future repeats itself, the falling asleep included.
#[test]
fn sleep_is_state() {
    let mut c = hanging(&def());
    let mut all = Vec::new();
    let end = fall_asleep(&mut c) + 10;
    let mut c = hanging(&def());
    for _ in 0..end {
        all.push((snapshot(&mut c), c.state_hash()));
        c.step().unwrap();
    }
    for start in [0, 5, end as usize - 35, end as usize - 12, end as usize - 10, end as usize - 1] {
        c.restore(&all[start].0).unwrap();
        for (_, hash) in &all[start..] {
            assert_eq!(c.state_hash(), *hash);
            c.step().unwrap();
        }
        assert!(c.is_asleep());
    }
    // a snapshot of a cloth that never sleeps is another definition's
    let mut other = hanging(&ClothDef { sleep_speed_m_s: 0.0, ..def() });
    assert_eq!(c.restore(&snapshot(&mut other)), Err(Error::Foreign));
    // forged: more quiet than there can be, or half a frame of it
    let saved = &all[0].0;
    for value in [31.0f32, 0.5, -1.0] {
        let mut forged = saved.clone();
        let place = forged.len() - 8 - 4 * (2 * 7 + 1);
        forged[place..place + 4].copy_from_slice(&value.to_le_bytes());
        let end = forged.len() - 8;
        let mut h = Hash64::new();
        h.bulk(&forged[..end]);
        forged[end..].copy_from_slice(&h.finish().to_le_bytes());
        assert_eq!(c.restore(&forged), Err(Error::OutOfRange), "{value}");
    }
    c.restore(saved).unwrap();
}
