//! The moving frame: what of its motion the cloth feels, and that teleports and new origins are not felt at all.

mod common;

use common::{Random, bare, bits, cloth, near, positions, snapshot, squares, steps, stir, velocities};
use taut::{Cloth, ClothDef, Error, Families, Features, Pose, Vector3};

const STILL: [f32; 4] = [0.0, 0.0, 0.0, 1.0];

fn at(position_m: [f64; 3]) -> Pose {
    Pose { position_m: position_m.into(), rotation: STILL }
}

/// Turned about y by an angle.
fn about_y(position_m: [f64; 3], angle: f64) -> Pose {
    Pose { position_m: position_m.into(), rotation: [0.0, (angle / 2.0).sin() as f32, 0.0, (angle / 2.0).cos() as f32] }
}

fn turned_y(p: Vector3<f64>, angle: f64) -> Vector3<f64> {
    let (s, c) = angle.sin_cos();
    Vector3::new(c * p.x + s * p.z, p.y, c * p.z - s * p.x)
}

/// A cape: pinned at both upper corners.
fn cape(def: &ClothDef) -> Cloth<'static> {
    let mut c = cloth(&squares(9, 9, 0.125, Families::ALL), def);
    c.set_stiffness_uniform([900.0, 700.0, 200.0, 10.0]).unwrap();
    c.pin(0).unwrap();
    c.pin(8).unwrap();
    c
}

/// Where pin 0 and pin 8 are in the frame.
const PINS: [(usize, [f64; 3]); 2] = [(0, [0.0; 3]), (8, [1.0, 0.0, 0.0])];

/// A frame along a path of multiples of 2^-10 m, so that all sums are exact.
fn path(frame: u32) -> [f64; 3] {
    let t = f64::from(frame);
    [(4.0 * t).round() / 256.0, (30.0 * (0.2 * t).sin()).round() / 128.0, -(t * t).round() / 1024.0]
}

/// Without inertia the cloth does not notice that its frame moves: it has the bits of one that stays, wherever pins are moved,
/// before the frame or after it.
#[test]
fn without_inertia_a_shift_is_not_felt() {
    for pins_first in [false, true] {
        let (mut still, mut c) = (cape(&ClothDef::default()), cape(&ClothDef::default()));
        for frame in 1..=90 {
            let place = Vector3::from(path(frame));
            if !pins_first {
                c.set_frame(&at(place.into()), 0.0, 0.0).unwrap();
            }
            for (pin, local) in PINS {
                c.move_pin(pin, place + Vector3::from(local)).unwrap();
            }
            if pins_first {
                c.set_frame(&at(place.into()), 0.0, 0.0).unwrap();
            }
            steps(&mut c, 1);
            steps(&mut still, 1);
            assert_eq!(bits(&c), bits(&still), "frame {frame}");
            assert_eq!(c.world_position(80).unwrap(), place + still.position(80).unwrap().cast());
            assert_eq!(c.positions().origin_m, path(frame));
        }
    }
}

/// With full inertia the frame is only another way of writing the same numbers: the world sees the cloth whose pins move and
/// whose frame stays, but for the rounding of a local f32, which grows where cloth crumples: within 1e-4 m after a second.
#[test]
fn with_full_inertia_only_the_pins_matter() {
    let def = ClothDef { damping_per_s: 10.0, ..ClothDef::default() };
    let (mut fixed, mut c) = (cape(&def), cape(&def));
    let (mut largest, mut fastest) = (0.0f64, 0.0f32);
    for frame in 1..=60 {
        let t = f64::from(frame) / 60.0;
        let (angle, place) = (0.5 * t, Vector3::new(1.5 * t * t, 0.1 * (6.0 * t).sin(), -t));
        c.set_frame(&about_y(place.into(), angle), 1.0, 1.0).unwrap();
        for (pin, local) in PINS {
            let to = place + turned_y(local.into(), angle);
            c.move_pin(pin, to).unwrap();
            fixed.move_pin(pin, to).unwrap();
        }
        steps(&mut c, 1);
        steps(&mut fixed, 1);
        for i in 0..81 {
            largest = largest.max((c.world_position(i).unwrap() - fixed.world_position(i).unwrap()).norm());
            fastest = fastest.max((c.velocity(i).unwrap() - fixed.velocity(i).unwrap()).norm());
        }
    }
    assert!(largest < 1e-4 && fastest < 0.1, "{largest} m, {fastest} m/s");
    assert!(fixed.position(0).unwrap().norm() > 1.5, "the pins must have moved far");
}

/// A free particle without forces goes the share 1 - inertia of the frame's way, and gets no velocity.
#[test]
fn inertia_is_the_share_that_is_felt() {
    for inertia in [0.0, 0.25, 0.5, 1.0f32] {
        let mut c = cloth(&squares(3, 3, 0.5, Families::ALL), &bare());
        c.set_stiffness_uniform([50.0; 4]).unwrap();
        let start = c.world_position(4).unwrap();
        for frame in 1..=40 {
            c.set_frame(&at([0.25 * f64::from(frame), 0.0, -0.125]), inertia, 0.0).unwrap();
            steps(&mut c, 1);
        }
        let moved = c.world_position(4).unwrap() - start;
        let carried = 1.0 - f64::from(inertia);
        assert!((moved - Vector3::new(10.0, 0.0, -0.125) * carried).norm() < 1e-5, "{inertia}: {moved}");
        assert!(velocities(&c).iter().all(|v| v.norm() < 1e-3));
    }
}

/// The same for turns, about the frame's position, to the shorter side, velocities along.
#[test]
fn angular_inertia_is_the_share_of_the_turn_that_is_felt() {
    let home = [5.0, -3.0, 1.0];
    for (inertia, sign) in [(0.0f32, 1.0f32), (0.5, -1.0), (1.0, 1.0)] {
        let mut c = cloth(&squares(3, 3, 0.5, Families::ALL), &ClothDef { origin_m: home, ..bare() });
        c.set_stiffness_uniform([0.0; 4]).unwrap();
        for i in 0..9 {
            c.set_velocity(i, Vector3::new(1.0, 0.5, 0.0)).unwrap();
        }
        let local = c.position(5).unwrap().cast::<f64>();
        let mut frame = about_y(home, 0.8);
        // the same rotation, written with the other sign and another length
        frame.rotation = frame.rotation.map(|q| q * sign * 3.0);
        c.set_frame(&frame, 0.3, inertia).unwrap();
        let angle = 0.8 * (1.0 - f64::from(inertia));
        let (x, v) = (c.world_position(5).unwrap() - Vector3::from(home), c.velocity(5).unwrap().cast::<f64>());
        assert!((x - turned_y(local, angle)).norm() < 1e-6, "{inertia}: {x}");
        assert!((v - turned_y(Vector3::new(1.0, 0.5, 0.0), angle)).norm() < 1e-6, "{inertia}: {v}");
        let now = c.frame();
        assert!(
            (f64::from(now.rotation[1].abs()) - 0.4f64.sin()).abs() < 1e-6 && now.position_m == Vector3::from(home)
        );
        // the same frame again is no motion
        let before = bits(&c);
        c.set_frame(&frame, 0.0, 0.0).unwrap();
        assert_eq!(bits(&c), before);
    }
}

/// About the axis of gravity: a cape whose frame turns without angular inertia looks from the frame like one that stays.
#[test]
fn without_inertia_a_turn_is_not_felt() {
    let (mut still, mut c) = (cape(&ClothDef::default()), cape(&ClothDef::default()));
    stir(&mut still, &mut Random::new(1), 0.3);
    stir(&mut c, &mut Random::new(1), 0.3);
    for frame in 1..=120 {
        let angle = 0.05 * f64::from(frame);
        let place = Vector3::new(0.1 * f64::from(frame), 0.0, 0.0);
        c.set_frame(&about_y(place.into(), angle), 0.0, 0.0).unwrap();
        for (pin, local) in PINS {
            c.move_pin(pin, place + turned_y(local.into(), angle)).unwrap();
        }
        steps(&mut c, 1);
        steps(&mut still, 1);
        for i in 0..81 {
            let seen = turned_y(c.world_position(i).unwrap() - place, -angle);
            let off = (seen - still.world_position(i).unwrap()).norm();
            assert!(off < 2e-4, "frame {frame}, particle {i}: {off} m");
        }
    }
}

/// A pin that nobody moves stays in the world while its frame goes away, whatever is carried.
#[test]
fn pins_stay_where_they_were_told_to_be() {
    for inertia in [0.0, 0.5, 1.0f32] {
        let mut c = cape(&ClothDef::default());
        for frame in 1..=30 {
            c.set_frame(&about_y(path(frame), 0.1 * f64::from(frame)), inertia, inertia).unwrap();
            steps(&mut c, 1);
            for (pin, place) in PINS {
                let off = (c.world_position(pin).unwrap() - Vector3::from(place)).norm();
                assert!(off < 1e-5, "inertia {inertia}, frame {frame}: {off} m");
            }
        }
    }
}

/// A leap of 1000 km: not a bit of the local state changes, pins and their ways included, and the run goes on as it would have.
#[test]
fn a_teleport_is_not_felt() {
    let def = ClothDef { features: Features::PULL, ..ClothDef::default() };
    let (mut stays, mut c) = (cape(&def), cape(&def));
    for frame in 0..60 {
        for c in [&mut stays, &mut c] {
            let base = Vector3::from(c.positions().origin_m);
            c.move_pin(0, base + Vector3::new(0.0, 0.0078125 * f64::from(frame), 0.0)).unwrap();
            c.add_force(40, Vector3::new(0.0, 0.0, 0.01)).unwrap();
        }
        if frame % 20 == 7 {
            let hash = c.state_hash();
            c.teleport(&at([1e9 * f64::from(frame), 0.0, 1024.0])).unwrap();
            assert_eq!(c.state_hash(), hash);
        }
        if frame % 20 == 13 {
            c.set_origin(Vector3::new(-65536.0, 0.5, 0.0)).unwrap();
            assert_eq!(c.positions().origin_m, [-65536.0, 0.5, 0.0]);
        }
        steps(&mut stays, 1);
        steps(&mut c, 1);
        assert_eq!(c.state_hash(), stays.state_hash(), "frame {frame}");
    }
}

/// A teleport that turns rounds each position once: no strain beyond 3e-6, no speed, and pins turn along.
#[test]
fn a_turning_teleport_adds_no_strain_and_no_speed() {
    let mut c = cape(&ClothDef::default());
    steps(&mut c, 40);
    let (x, v) = (positions(&c), velocities(&c));
    let mut before = Vec::new();
    c.each_structural_strain(|_, _, s| before.push(s));
    let energy = c.kinetic_energy_j();
    let s = 0.5f32.sqrt();
    // a quarter about x: (x, y, z) becomes (x, -z, y)
    c.teleport(&Pose { position_m: [3.0, 0.0, 0.0].into(), rotation: [s, 0.0, 0.0, s] }).unwrap();
    let quarter = |p: Vector3<f32>| Vector3::new(p.x, -p.z, p.y);
    for i in 0..81 {
        assert!((c.position(i).unwrap() - quarter(x[i])).norm() < 3e-7);
        assert!((c.velocity(i).unwrap() - quarter(v[i])).norm() < 1e-6);
    }
    let mut i = 0;
    c.each_structural_strain(|_, _, s| {
        assert!((s - before[i]).abs() < 3e-6, "{s} {}", before[i]);
        i += 1;
    });
    near(c.kinetic_energy_j(), energy, 1e-5, "energy");
    let pin = c.world_position(8).unwrap();
    steps(&mut c, 2);
    assert_eq!(c.world_position(8).unwrap(), pin);
    assert_eq!(c.velocity(8).unwrap(), Vector3::zeros());
}

/// Rollback over frames: the snapshot brings the frame back, so the next one is no leap; `reset` goes back to the definition.
#[test]
fn the_frame_is_in_the_snapshot() {
    let def = ClothDef { origin_m: [1.0, 2.0, 3.0], ..ClothDef::default() };
    let mut c = cape(&def);
    steps(&mut c, 3);
    let plain = snapshot(&mut c);
    let go = |c: &mut Cloth<'_>, frames: std::ops::Range<u32>| {
        for frame in frames {
            c.set_frame(&about_y(path(frame), 0.1 * f64::from(frame)), 0.4, 0.7).unwrap();
            steps(c, 1);
        }
        (c.state_hash(), c.frame())
    };
    go(&mut c, 1..10);
    let saved = snapshot(&mut c);
    assert_eq!(saved.len(), plain.len() + 56);
    assert!(c.snapshot_size_max() >= saved.len());
    let then = go(&mut c, 10..20);
    c.restore(&saved).unwrap();
    assert_eq!(go(&mut c, 10..20), then);
    c.restore(&plain).unwrap();
    assert_eq!(c.frame(), at([1.0, 2.0, 3.0]));
    go(&mut c, 1..3);
    c.reset();
    assert_eq!(c.frame(), at([1.0, 2.0, 3.0]));
    // another machine has shifted its world: another frame, the same hash
    let mut other = cape(&ClothDef { origin_m: [0.0; 3], ..def });
    steps(&mut other, 3);
    c.restore(&plain).unwrap();
    other.set_origin(Vector3::new(512.0, 0.0, 0.0)).unwrap();
    assert_eq!(other.state_hash(), c.state_hash());
}

#[test]
fn bad_frames_are_refused() {
    let mut c = cape(&ClothDef::default());
    let hash = c.state_hash();
    let (nan, still) = (f64::NAN, at([0.0; 3]));
    let turned = |rotation| Pose { position_m: [0.0; 3].into(), rotation };
    let cases = [
        (at([nan, 0.0, 0.0]), 0.0, 0.0, Error::NotFinite),
        (turned([0.0, f32::NAN, 0.0, 1.0]), 0.0, 0.0, Error::NotFinite),
        (still, f32::NAN, 0.0, Error::NotFinite),
        (turned([0.0; 4]), 0.0, 0.0, Error::OutOfRange),
        (turned([f32::MAX; 4]), 0.0, 0.0, Error::OutOfRange),
        (at([0.0, 1.1e6, 0.0]), 0.0, 0.0, Error::OutOfRange),
        (at([0.0, 1.1e12, 0.0]), 0.0, 0.0, Error::OutOfRange),
        (still, 1.1, 0.0, Error::OutOfRange),
        (still, 0.0, -0.1, Error::OutOfRange),
    ];
    for (frame, linear, angular, error) in cases {
        assert_eq!(c.set_frame(&frame, linear, angular), Err(error), "{frame:?}");
    }
    assert_eq!(c.teleport(&at([0.0, 0.0, 1.1e12])), Err(Error::OutOfRange));
    assert_eq!(c.teleport(&turned([0.0; 4])), Err(Error::OutOfRange));
    assert_eq!(c.set_origin(Vector3::new(0.0, nan, 0.0)), Err(Error::NotFinite));
    assert_eq!((c.state_hash(), c.frame()), (hash, still));
}
