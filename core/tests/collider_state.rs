//! Colliders as state: memory, golden hash, rollback, forged snapshots, frames that are taken back.

mod common;

use common::contact::{UP, at, turned, with};
use common::{cloth, snapshot, squares, steps};
use taut::{Cloth, ClothDef, ColliderId, Error, Families, Features, Hash64, Pose, Shape};
use taut::{StepFlags, Vector3};

/// What is off costs no byte, and 32 colliders cost 4 KiB.
#[test]
fn the_memory_is_that_of_the_list() {
    let grid = squares(9, 9, 0.1, Families::ALL);
    let of = |features| Cloth::memory(&grid, &ClothDef { features, ..ClothDef::default() }).unwrap();
    assert_eq!(of(Features::COLLIDERS) - of(Features::NONE), 1024);
}

/// All shapes at once, moved, turned, added and removed as the frame tells.
fn crowd(origin: Vector3<f64>) -> (Cloth<'static>, Vec<ColliderId>) {
    let def = ClothDef {
        features: Features::COLLIDERS,
        origin_m: origin.into(),
        v_axis: [0.0, 0.0, 1.0],
        ..ClothDef::default()
    };
    let mut c = cloth(&squares(20, 21, 0.0625, Families::ALL), &def);
    c.set_stiffness_uniform([600.0, 600.0, 150.0, 8.0]).unwrap();
    c.pin(0).unwrap();
    let shapes = [
        Shape::Sphere { radius_m: 0.25 },
        Shape::Capsule { ends_m: [[-0.25, 0.0, 0.0], [0.25, 0.125, 0.0]], radii_m: [0.125, 0.0625] },
        Shape::Box { half_m: [0.25, 0.03125, 0.125] },
        UP,
    ];
    let place = [[0.5, -0.5, 0.5], [0.25, -0.25, 1.0], [1.0, -0.25, 0.25], [0.0, -1.0, 0.0]];
    let add = |(shape, p): (Shape, [f64; 3])| {
        c.add_collider(&with(shape, Pose::at(origin + Vector3::from(p)), 0.25, 0.0078125))
    };
    let ids = shapes.into_iter().zip(place).map(add).collect::<Result<Vec<_>, _>>().unwrap();
    (c, ids)
}

fn stir_crowd(c: &mut Cloth<'_>, ids: &mut [ColliderId], frame: u32, origin: Vector3<f64>) {
    // 1/64 steps, so that a shifted origin changes no bit of the local poses
    let step = |k: u32| f64::from((frame * k) % 16) / 64.0;
    let moved = |p: [f64; 3]| origin + Vector3::from(p);
    c.move_collider(ids[0], &Pose::at(moved([0.5 + step(3), -0.5, 0.5]))).unwrap();
    c.move_collider(ids[1], &turned(moved([0.25, -0.25, 1.0]), [0.0, 1.0, 0.0], f64::from(frame) * 0.1)).unwrap();
    c.move_collider(ids[2], &turned(moved([1.0, -0.25 + step(1), 0.25]), [0.6, 0.0, 0.8], f64::from(frame) * 0.05))
        .unwrap();
    if frame % 11 == 5 {
        let def = c.collider(ids[3]).unwrap();
        c.remove_collider(ids[3]).unwrap();
        ids[3] = c.add_collider(&def).unwrap();
    }
}

/// Printed once on x86_64; every other target, width of vector and optimisation level must give the same.
const GOLDEN: u64 = 0xfde5_5711_14af_a3cc;

#[test]
fn golden_hash_at_any_origin() {
    for origin in [Vector3::zeros(), Vector3::new(1e6, -2e6, 1e6)] {
        let (mut c, mut ids) = crowd(origin);
        for frame in 0..120 {
            stir_crowd(&mut c, &mut ids, frame, origin);
            steps(&mut c, 1);
        }
        assert_eq!(c.state_hash(), GOLDEN, "{:#x} at {origin}", c.state_hash());
    }
}

/// A snapshot in the middle of a motion holds the way that is left, the ids and the generations.
#[test]
fn every_frame_can_be_gone_back_to() {
    let origin = Vector3::zeros();
    let (mut c, mut ids) = crowd(origin);
    for frame in 0..30 {
        stir_crowd(&mut c, &mut ids, frame, origin);
        let (saved, kept) = (snapshot(&mut c), ids.clone());
        let size = c.snapshot_size();
        assert_eq!(size, saved.len());
        let mut hashes = [0; 2];
        for hash in &mut hashes {
            for next in 1..5 {
                steps(&mut c, 1);
                stir_crowd(&mut c, &mut ids, frame + next, origin);
            }
            *hash = c.state_hash();
            c.restore(&saved).unwrap();
            ids = kept.clone();
        }
        assert_eq!(hashes[0], hashes[1], "frame {frame}");
        steps(&mut c, 1);
    }
}

/// A snapshot whose colliders could not have been added is refused whole, its checksum right or not.
#[test]
fn forged_colliders_are_refused() {
    let (mut c, mut ids) = crowd(Vector3::zeros());
    stir_crowd(&mut c, &mut ids, 3, Vector3::zeros());
    let saved = snapshot(&mut c);
    let hash = c.state_hash();
    let first = 40 + 4 * 6 * 20 * 21;
    let forged = |number: usize, value: f32| {
        let mut s = saved.clone();
        let at = first + 4 * number;
        s[at..at + 4].copy_from_slice(&value.to_le_bytes());
        let body = s.len() - 8;
        let mut h = Hash64::new();
        h.bulk(&s[..body]);
        s[body..].copy_from_slice(&h.finish().to_le_bytes());
        s
    };
    // kind, generation, friction, thickness, radius, position, rotation; of the first and of an empty place
    let cases = [
        (0, 5.0, Error::OutOfRange),
        (0, 0.5, Error::OutOfRange),
        (1, -1.0, Error::OutOfRange),
        (1, 0.5, Error::OutOfRange),
        (1, 1e9, Error::OutOfRange),
        (2, -1.0, Error::Negative),
        (3, 1e9, Error::OutOfRange),
        (4, 0.0, Error::OutOfRange),
        (4, f32::NAN, Error::NotFinite),
        (12, 1e7, Error::OutOfRange),
        (18, 2.0, Error::OutOfRange),
        (25, 0.0, Error::OutOfRange),
        (9 * 32, 1.0, Error::OutOfRange),
        (9 * 32 + 1, -3.0, Error::OutOfRange),
    ];
    for (number, value, error) in cases {
        assert_eq!(c.restore(&forged(number, value)), Err(error), "number {number} as {value}");
        assert_eq!(c.state_hash(), hash);
    }
    // the same bytes with nothing wrong
    c.restore(&forged(2, 0.25)).unwrap();
    assert_eq!(c.state_hash(), hash);
}

/// A frame that is taken back leaves the colliders where they were.
#[test]
fn a_frame_that_is_taken_back_takes_back_the_colliders() {
    let (mut c, ids) = crowd(Vector3::zeros());
    let mut s = snapshot(&mut c);
    let n = c.grid().particles();
    for plane in [0, 3] {
        let at = 40 + 4 * (plane * n + 6);
        s[at..at + 4].copy_from_slice(&f32::MAX.to_le_bytes());
    }
    let body = s.len() - 8;
    let mut h = Hash64::new();
    h.bulk(&s[..body]);
    s[body..].copy_from_slice(&h.finish().to_le_bytes());
    c.restore(&s).unwrap();
    let hash = c.state_hash();
    c.move_collider(ids[0], &at(0.3, 0.3, 0.3)).unwrap();
    assert!(c.step().unwrap().contains(StepFlags::NON_FINITE));
    assert_eq!(c.state_hash(), hash);
}
