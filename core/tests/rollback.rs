//! Snapshots: the future of a restored cloth is the future of the cloth it was taken from, whatever was done in between;
//! what is not a snapshot of this cloth changes nothing.

mod common;

use common::{Random, bare, bits, cloth, snapshot, squares, stir};
use taut::{Cloth, ClothDef, Error, Families, Features, Grid, StepFlags, Vector3};

/// Inertia, pulls and everything else that is state.
fn def() -> ClothDef {
    ClothDef { substeps: 4, inertia_radius_m: 0.3, features: Features::PULL, max_pins: 12, ..ClothDef::default() }
}

fn made() -> Cloth<'static> {
    let grid = squares(9, 11, 0.1, Families::ALL);
    let mut c = cloth(&grid, &def());
    c.set_stiffness_uniform([800.0, 500.0, 100.0, 8.0]).unwrap();
    c
}

/// What a player does in a frame: drives, adds and takes pins, pulls.
fn input(c: &mut Cloth<'_>, frame: u64) {
    let mut random = Random::new(frame + 1000);
    if frame.is_multiple_of(3) {
        let p = random.below(c.grid().particles());
        if c.pin_count() < 12 {
            c.pin(p).unwrap();
        }
    }
    if frame % 7 == 5 {
        let first = c.pinned().next();
        if let Some(p) = first {
            c.unpin(p).unwrap();
        }
    }
    let pins: Vec<usize> = c.pinned().collect();
    for p in pins {
        let to = c.world_position(p).unwrap() + random.vector(0.01).cast();
        c.move_pin(p, to).unwrap();
    }
    if frame % 4 == 1 {
        let p = random.below(c.grid().particles());
        c.add_force(p, random.vector(0.5)).unwrap();
    }
}

/// A snapshot that forgets anything (pins' ways, pending pulls, velocities in the right inertia) fails here, since every
/// frame is left by a detour of eight frames with other input, and by a `reset`.
#[test]
fn every_frame_can_be_gone_back_to() {
    let mut straight = made();
    let mut hashes = Vec::new();
    for frame in 0..60 {
        input(&mut straight, frame);
        straight.step().unwrap();
        hashes.push(straight.state_hash());
    }
    let mut c = made();
    for frame in 0..60 {
        // before and after the input: with and without pending pulls and stale pins
        for after_input in [false, true] {
            if after_input {
                input(&mut c, frame);
            }
            let saved = snapshot(&mut c);
            let hash = c.state_hash();
            for i in 0..8 {
                input(&mut c, 500 + frame + i);
                c.step().unwrap();
            }
            c.restore(&saved).unwrap();
            assert_eq!(c.state_hash(), hash, "frame {frame}, input {after_input}");
            c.reset();
            c.pin(7).unwrap();
            c.restore(&saved).unwrap();
            assert_eq!(c.state_hash(), hash, "frame {frame} after reset");
        }
        c.step().unwrap();
        assert_eq!(c.state_hash(), hashes[frame as usize], "frame {frame}");
    }
    let distinct: std::collections::HashSet<_> = hashes.iter().collect();
    assert_eq!(distinct.len(), 60, "a hash must see that something moved");
}

/// The pins of the snapshot are pinned already, but the inertia field is still that of other pins: the velocities of the
/// snapshot must not be taken for velocities under that inertia.
#[test]
fn stale_pins_before_a_restore_do_not_touch_the_velocities() {
    let mut c = made();
    c.pin(0).unwrap();
    c.pin(10).unwrap();
    stir(&mut c, &mut Random::new(3), 0.5);
    c.step().unwrap();
    let saved = snapshot(&mut c);
    c.step().unwrap();
    let next = c.state_hash();

    c.restore(&saved).unwrap();
    c.unpin(10).unwrap();
    c.step().unwrap();
    c.pin(10).unwrap(); // the same pins as in the snapshot, not settled yet
    c.restore(&saved).unwrap();
    c.step().unwrap();
    assert_eq!(c.state_hash(), next);
}

/// A reset leaves the inertia of the old pins behind until the next step, and no pins: those of the first snapshot.
#[test]
fn a_reset_before_a_restore_does_not_touch_the_velocities() {
    let mut c = made();
    stir(&mut c, &mut Random::new(4), 0.5);
    c.step().unwrap();
    let saved = snapshot(&mut c);
    c.step().unwrap();
    let next = c.state_hash();

    c.pin(0).unwrap();
    c.step().unwrap();
    c.reset();
    c.restore(&saved).unwrap();
    c.step().unwrap();
    assert_eq!(c.state_hash(), next);
}

/// Pulls that were added before going back belong to the abandoned future.
#[test]
fn pending_pulls_do_not_survive_a_restore() {
    let mut c = made();
    c.pin(0).unwrap();
    let saved = snapshot(&mut c);
    c.add_force(50, Vector3::new(0.0, 0.0, 1.0)).unwrap();
    c.step().unwrap();
    let next = c.state_hash();

    c.restore(&saved).unwrap();
    c.add_force(40, Vector3::new(5.0, 0.0, 0.0)).unwrap();
    c.restore(&saved).unwrap();
    c.add_force(50, Vector3::new(0.0, 0.0, 1.0)).unwrap();
    c.step().unwrap();
    assert_eq!(c.state_hash(), next);
}

/// Velocities set after a change of pins are those that were asked for, not rescaled for it.
#[test]
fn a_velocity_set_after_a_pin_is_the_velocity_stepped_with() {
    let start = |c: &mut Cloth<'_>| {
        c.pin(0).unwrap();
        c.set_velocity(1, Vector3::new(0.0, 0.0, 1.0)).unwrap();
        c.step().unwrap();
        c.state_hash()
    };
    let mut c = made();
    let fresh = start(&mut c);
    c.reset();
    c.pin(5).unwrap();
    c.step().unwrap();
    c.reset();
    assert_eq!(start(&mut c), fresh);
}

/// The table of the module's documentation, byte by byte.
#[test]
fn the_bytes_are_those_that_are_documented() {
    let mut c = made();
    for p in [20, 3] {
        c.pin(p).unwrap();
    }
    for _ in 0..5 {
        c.step().unwrap();
    }
    c.move_pin(3, Vector3::new(1.5, -2.0, 0.25)).unwrap();
    c.add_force(17, Vector3::new(1.0, 2.0, 3.0)).unwrap();
    let s = snapshot(&mut c);
    let u32_at = |at: usize| u32::from_le_bytes(s[at..at + 4].try_into().unwrap());
    let u64_at = |at: usize| u64::from_le_bytes(s[at..at + 8].try_into().unwrap());
    let number = |i: usize| f32::from_bits(u32_at(40 + 4 * i));
    assert_eq!(&s[..8], b"TAUTSNAP");
    assert_eq!((u32_at(8), u32_at(12)), (3, s.len() as u32));
    assert_eq!(u64_at(24), 5);
    assert_eq!((u32_at(32), u32_at(36)), (2, 1));
    let n = 9 * 11;
    assert_eq!(s.len(), 40 + 4 * (9 * n + 2 * 7) + 8);
    for i in 0..n {
        let (x, v) = (c.position(i).unwrap(), c.velocity(i).unwrap());
        for a in 0..3 {
            assert_eq!(number(a * n + i), x[a]);
            assert_eq!(number((3 + a) * n + i), v[a]);
            let pull = if i == 17 { a as f32 + 1.0 } else { 0.0 };
            assert_eq!(number((6 + a) * n + i), pull);
        }
    }
    let pins: Vec<f32> = (0..14).map(|i| number(9 * n + i)).collect();
    let at = |p: usize| c.position(p).unwrap();
    let (a, b) = (at(3), at(20));
    assert_eq!(pins, [3.0, a.x, a.y, a.z, 1.5, -2.0, 0.25, 20.0, b.x, b.y, b.z, b.x, b.y, b.z]);
    let mut h = taut::Hash64::new();
    h.bulk(&s[..s.len() - 8]);
    assert_eq!(u64_at(s.len() - 8), h.finish());
    // what follows the snapshot is not looked at
    let mut longer = s.clone();
    longer.extend([7; 9]);
    c.restore(&longer).unwrap();
}

/// Writes a snapshot with its checksum made right again after a change.
fn forged(saved: &[u8], change: impl Fn(&mut [u8])) -> Vec<u8> {
    let mut s = saved.to_vec();
    let body = s.len() - 8;
    change(&mut s[..body]);
    let mut h = taut::Hash64::new();
    h.bulk(&s[..body]);
    s[body..].copy_from_slice(&h.finish().to_le_bytes());
    s
}

/// What the levels of a sheet aim at that hangs in its limit is state: without it the frames after a restore would be others.
#[test]
fn the_aim_of_the_levels_is_state() {
    let def = ClothDef { features: Features::LEVELS, substeps: 2, ..ClothDef::default() };
    let mut c = cloth(&squares(32, 32, 1.0 / 31.0, Families::ALL), &def);
    c.set_stiffness_uniform([1e8; 4]).unwrap();
    c.pin(0).unwrap();
    (0..90).for_each(|_| assert_eq!(c.step().unwrap(), StepFlags(0)));
    let saved = snapshot(&mut c);
    // the last number before the pin
    let at = saved.len() - 8 - 4 * 7 - 4;
    let aim = f32::from_le_bytes(saved[at..at + 4].try_into().unwrap());
    assert!((0.0..0.9).contains(&aim), "never lowered: {aim}");
    (0..30).for_each(|_| assert_eq!(c.step().unwrap(), StepFlags(0)));
    let after = (c.state_hash(), bits(&c));
    c.restore(&saved).unwrap();
    (0..30).for_each(|_| assert_eq!(c.step().unwrap(), StepFlags(0)));
    assert_eq!((c.state_hash(), bits(&c)), after);

    let with = |aim: f32| forged(&saved, |s| s[at..at + 4].copy_from_slice(&aim.to_le_bytes()));
    for (bad, error) in [(0.91, Error::OutOfRange), (-0.1, Error::OutOfRange), (f32::NAN, Error::NotFinite)] {
        assert_eq!(c.restore(&with(bad)), Err(error));
    }
    c.restore(&with(0.9)).unwrap();
    (0..30).for_each(|_| assert_eq!(c.step().unwrap(), StepFlags(0)));
    assert_ne!(bits(&c), after.1, "the aim is of no consequence");
    c.reset();
    let start = snapshot(&mut c);
    assert_eq!(start[start.len() - 12..start.len() - 8], 0.9f32.to_le_bytes());
}

#[test]
fn damaged_snapshots_are_refused_and_change_nothing() {
    let mut c = made();
    c.pin(4).unwrap();
    c.pin(8).unwrap();
    c.step().unwrap();
    let saved = snapshot(&mut c);
    c.step().unwrap();
    let (hash, before) = (c.state_hash(), bits(&c));
    let mut refuse = |bytes: &[u8], error: Error, what: &str| {
        assert_eq!(c.restore(bytes).unwrap_err(), error, "{what}");
        assert_eq!((c.state_hash(), bits(&c)), (hash, before.clone()), "{what}");
    };
    for n in (0..saved.len()).step_by(37).chain([saved.len() - 1]) {
        refuse(&saved[..n], Error::Truncated, "cut short");
    }
    for at in (40..saved.len()).step_by(131).chain([saved.len() - 1]) {
        let mut s = saved.clone();
        s[at] ^= 0x40;
        refuse(&s, Error::Checksum, "one bit");
    }
    // the step index, of which no value is impossible
    let mut s = saved.clone();
    s[25] ^= 1;
    refuse(&s, Error::Checksum, "step index");

    let put = |at: usize, number: u32| forged(&saved, |s| s[at..at + 4].copy_from_slice(&number.to_le_bytes()));
    refuse(&put(0, 7), Error::WrongKind, "magic");
    refuse(&put(8, 2), Error::UnsupportedVersion, "an older version");
    refuse(&put(8, 4), Error::UnsupportedVersion, "a newer version");
    refuse(&put(12, 47), Error::Shape, "size too small");
    refuse(&put(12, u32::MAX), Error::Truncated, "size too large");
    refuse(&put(16, 0), Error::Foreign, "digest");
    refuse(&put(32, 1), Error::Shape, "fewer pins");
    refuse(&put(32, u32::MAX), Error::Shape, "pins past any size");
    refuse(&put(36, 1), Error::Shape, "pulls that are not there");
    refuse(&put(36, 2), Error::Shape, "neither yes nor no");
    let (n, pins) = (9 * 11, 40 + 4 * 6 * 9 * 11);
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        for i in [0, 3 * n + 7, 6 * n + 1, 6 * n + 13] {
            refuse(&put(40 + 4 * i, bad.to_bits()), Error::NotFinite, "not finite");
        }
    }
    for index in [-1.0, 8.0, 4.5, 99.0, 1e30] {
        let s = put(pins, f32::to_bits(index));
        refuse(&s, Error::NoSuchParticle, "a pin out of order or nowhere");
    }
}

/// Too small a buffer is left as it was.
#[test]
fn a_small_buffer_is_refused_and_left_alone() {
    let mut c = made();
    let size = c.snapshot_size();
    let mut bytes = vec![0xa5; size];
    let e = c.snapshot(&mut bytes[..size - 1]).unwrap_err();
    assert_eq!(e, Error::BlockTooSmall);
    assert!(bytes.iter().all(|b| *b == 0xa5));
    assert_eq!(c.snapshot(&mut bytes), Ok(size));
}

/// Every part of grid and definition that changes the future makes a snapshot foreign; what does not (the world's origin)
/// does not.
#[test]
fn snapshots_of_other_cloths_are_foreign() {
    let mut home = made();
    home.step().unwrap();
    let saved = snapshot(&mut home);
    let d = def();
    let g = squares(9, 11, 0.1, Families::ALL);
    let grids: [Grid; 4] = [
        squares(11, 9, 0.1, Families::ALL),
        squares(9, 11, 0.1, Families::STRUCTURAL),
        squares(9, 11, 0.2, Families::ALL),
        squares(9, 12, 0.1, Families::ALL),
    ];
    let others = [
        ClothDef { rate_hz: 61.0, ..d },
        ClothDef { substeps: 5, ..d },
        ClothDef { density_kg_m2: 0.3, ..d },
        ClothDef { gravity_m_s2: [0.0, -9.8, 0.0], ..d },
        ClothDef { damping_per_s: 1.0, ..d },
        ClothDef { speed_limit: 0.5, ..d },
        ClothDef { compression_limit: false, ..d },
        ClothDef { budget: taut::Budget::Certified, ..d },
        ClothDef { inertia_radius_m: 0.2, ..d },
        ClothDef { inertia_max: 9.0, ..d },
        ClothDef { max_pins: 13, ..d },
        ClothDef { features: Features::NONE, ..d },
    ];
    let cases = grids.into_iter().map(|g| (g, d)).chain(others.into_iter().map(|d| (g, d)));
    for (g, d) in cases {
        let mut c = cloth(&g, &d);
        c.set_stiffness_uniform([100.0; 4]).unwrap();
        let before = c.state_hash();
        assert_eq!(c.restore(&saved).unwrap_err(), Error::Foreign, "{g:?} {d:?}");
        assert_eq!(c.state_hash(), before);
    }
    let away = ClothDef { origin_m: [1e6, 0.0, 0.0], ..d };
    cloth(&g, &away).restore(&saved).unwrap();
    cloth(&g, &bare()).restore(&saved).unwrap_err();
}
