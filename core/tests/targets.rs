//! Largest distance and backstop: kept after every step, exact at the ends, closed forms at rest, bad input, rollback.

mod common;

use common::{Random, bare, bits, cloth, positions, snapshot, squares, steps, velocities};
use taut::{Cloth, ClothDef, Error, Families, Features, Hash64, Target, TargetLimit, Vector3};

type V3 = Vector3<f32>;

fn def() -> ClothDef {
    ClothDef { features: Features::TARGETS, ..ClothDef::default() }
}

fn made(def: &ClothDef) -> Cloth<'static> {
    let mut c = cloth(&squares(7, 19, 0.0625, Families::ALL), def);
    c.set_stiffness_uniform([300.0, 300.0, 90.0, 6.0]).unwrap();
    c
}

fn within(max_distance_m: f32) -> TargetLimit {
    TargetLimit { max_distance_m, ..TargetLimit::default() }
}

fn target(position_m: V3) -> Target {
    Target { position_m, normal: V3::zeros() }
}

/// Free until a limit is set: no bit changes, whatever the targets do.
#[test]
fn without_limits_nothing_changes() {
    let mut plain = made(&ClothDef::default());
    let mut c = made(&def());
    for c in [&mut plain, &mut c] {
        c.pin(3).unwrap();
    }
    for frame in 0..20 {
        c.move_targets(Vector3::zeros(), |i| target(V3::new(i as f32, frame as f32, 0.0))).unwrap();
        steps(&mut c, 1);
        steps(&mut plain, 1);
        assert_eq!(bits(&c), bits(&plain));
    }
    assert_eq!(
        Cloth::memory(c.grid(), &def()).unwrap() - Cloth::memory(c.grid(), &ClothDef::default()).unwrap(),
        15 * ((32 + 16) * (7 + 4) + 32)
    );
}

/// A largest distance of 0: the particle is its target, to the bit, with its velocity; the others hang on those.
#[test]
fn at_distance_0_a_particle_is_its_target() {
    let origin = Vector3::new(1000.0, -200.0, 30.0);
    let mut c = made(&ClothDef { origin_m: origin.into(), ..def() });
    let held = |i: usize| i < 19;
    c.set_target_limits(|i| if held(i) { within(0.0) } else { TargetLimit::default() }).unwrap();
    let base = origin + Vector3::new(2.0, 0.0, -1.0);
    let place = |frame: u32, i: usize| {
        let t = frame as f32 / 60.0;
        V3::new(0.05 * i as f32 + (3.0 * t).sin() - 2.0, (2.0 * t).cos() - 1.0, 1.0 + 0.3 * (5.0 * t).sin())
    };
    c.set_targets(base, |i| target(place(0, i))).unwrap();
    for frame in 1..60 {
        c.move_targets(base, |i| target(place(frame, i))).unwrap();
        steps(&mut c, 1);
        for i in 0..19 {
            let local = (base - origin + place(frame, i).cast()).cast::<f32>();
            assert_eq!(c.position(i).unwrap(), local);
            let before = (base - origin + place(frame - 1, i).cast()).cast::<f32>();
            assert!((c.velocity(i).unwrap() - (local - before) * 60.0).norm() < 1e-4);
        }
    }
    let lowest = positions(&c).iter().fold(0.0f32, |a, p| a.min(p.y));
    assert!(lowest < -0.2, "the rest hangs: {lowest}");
    // not moved again, they stand
    steps(&mut c, 1);
    assert!((0..19).all(|i| c.velocity(i).unwrap() == V3::zeros()));
}

/// One frame of four substeps moves the targets as four frames with a quarter of the way each.
#[test]
fn targets_are_interpolated_over_the_substeps() {
    let mut pair = [(60.0, 4), (240.0, 1)].map(|(rate_hz, substeps)| {
        let mut c = made(&ClothDef { rate_hz, substeps, ..def() });
        c.set_target_limits(|i| within([0.0, 0.125, f32::INFINITY][i % 3])).unwrap();
        c
    });
    let start = positions(&pair[0]);
    let mut at = V3::zeros();
    for frame in 0..12 {
        let way = V3::new(0.0625, if frame % 3 == 0 { -0.125 } else { 0.0 }, 0.25);
        let [coarse, fine] = &mut pair;
        coarse.move_targets(Vector3::zeros(), |i| target(start[i] + at + way)).unwrap();
        steps(coarse, 1);
        for quarter in 1..=4 {
            let here = at + way * (quarter as f32 / 4.0);
            fine.move_targets(Vector3::zeros(), |i| target(start[i] + here)).unwrap();
            steps(fine, 1);
        }
        at += way;
        assert_eq!(bits(coarse), bits(fine), "frame {frame}");
    }
}

/// Hanging on a string of the largest distance: straight below the target, at rest. And lying on a backstop above it.
#[test]
fn rest_is_where_the_balls_say() {
    let def = ClothDef { damping_per_s: 6.0, ..def() };
    let mut c = cloth(&squares(3, 5, 0.1, Families::ALL), &def);
    c.set_stiffness_uniform([0.0; 4]).unwrap();
    c.set_target_limits(|_| within(0.25)).unwrap();
    let start = positions(&c);
    for (i, p) in start.iter().enumerate() {
        c.set_position(i, p + V3::new(0.1, 0.0, 0.05)).unwrap();
    }
    steps(&mut c, 600);
    for (p, t) in positions(&c).iter().zip(&start) {
        assert!((p - t - V3::new(0.0, -0.25, 0.0)).norm() < 1e-4, "{}", p - t);
    }
    // the normal is up: the backstop is a large ball 2 cm below the target
    let backstop = TargetLimit { backstop_radius_m: 5.0, backstop_distance_m: 0.02, ..within(1.0) };
    c.set_target_limits(|_| backstop).unwrap();
    let up = |i: usize| Target { position_m: start[i], normal: V3::new(0.0, 2.0, 0.0) };
    c.set_targets(Vector3::zeros(), up).unwrap();
    for (i, p) in start.iter().enumerate() {
        c.set_position(i, *p).unwrap();
    }
    steps(&mut c, 60);
    for (p, t) in positions(&c).iter().zip(&start) {
        assert!((p - t - V3::new(0.0, -0.02, 0.0)).norm() < 1e-5, "{}", p - t);
    }
    assert!(velocities(&c).iter().all(|v| v.norm() < 1e-4));
    // a normal of zero keeps the last one, and so does the next frame
    c.move_targets(Vector3::zeros(), |i| target(start[i])).unwrap();
    steps(&mut c, 5);
    assert!((c.position(0).unwrap() - start[0] - V3::new(0.0, -0.02, 0.0)).norm() < 1e-5);
}

/// Wild skins: after every step each particle is within its largest distance and out of its backstop, both at once.
#[test]
fn both_limits_hold_after_every_step() {
    for seed in 0..6 {
        let mut r = Random::new(seed);
        let def = ClothDef { rate_hz: 240.0, substeps: 1 + r.below(4) as u32, ..def() };
        let mut c = made(&def);
        let n = c.grid().particles();
        let limits: Vec<TargetLimit> = (0..n)
            .map(|_| TargetLimit {
                max_distance_m: [0.0, 0.02, 0.3, f32::INFINITY][r.below(4)],
                backstop_radius_m: [0.0, 0.05, 0.2, 5.0][r.below(4)],
                backstop_distance_m: [0.0, 0.01, 0.1][r.below(3)],
            })
            .collect();
        c.set_target_limits(|i| limits[i]).unwrap();
        let mut skin: Vec<Target> = positions(&c)
            .into_iter()
            .map(|position_m| Target { position_m, normal: r.vector(1.0) + V3::new(0.0, 0.0, 0.1) })
            .collect();
        c.set_targets(Vector3::zeros(), |i| skin[i]).unwrap();
        let (mut at_distance, mut at_backstop, mut at_both) = (0, 0, 0);
        for _ in 0..60 {
            for t in &mut skin {
                t.position_m += r.vector(0.03);
                t.normal += r.vector(0.1) * t.normal.norm();
                if t.normal.norm() < 0.05 {
                    t.normal = V3::new(0.0, 0.0, 1.0);
                }
            }
            c.move_targets(Vector3::zeros(), |i| skin[i]).unwrap();
            steps(&mut c, 1);
            for (i, p) in positions(&c).iter().enumerate() {
                let (p, t) = (p.cast::<f64>(), skin[i].position_m.cast::<f64>());
                let l = limits[i];
                let away = (p - t).norm();
                assert!(away <= f64::from(l.max_distance_m) + 2e-6, "{i}: {away} {l:?}");
                let radius = f64::from(l.backstop_radius_m);
                if radius == 0.0 {
                    continue;
                }
                let behind = radius + f64::from(l.backstop_distance_m);
                let from = (p - t + skin[i].normal.cast::<f64>().normalize() * behind).norm();
                assert!(from >= radius - 1e-5, "{i}: {from} {l:?}");
                let (a, b) = (away > f64::from(l.max_distance_m) - 1e-5, from < radius + 1e-5);
                at_distance += usize::from(a);
                at_backstop += usize::from(b);
                at_both += usize::from(a && b);
            }
        }
        assert!(at_distance > 100 && at_backstop > 100 && at_both > 10, "{at_distance} {at_backstop} {at_both}");
    }
}

/// Without a way between there is no velocity: a teleport throws nothing.
#[test]
fn a_jump_of_the_targets_throws_nothing() {
    let def = ClothDef { gravity_m_s2: [0.0; 3], ..def() };
    let mut c = made(&def);
    c.set_target_limits(|_| within(0.0)).unwrap();
    let start = positions(&c);
    let far = V3::new(100.0, 50.0, -20.0);
    c.set_targets(Vector3::zeros(), |i| target(start[i] + far)).unwrap();
    steps(&mut c, 1);
    for (p, (q, v)) in start.iter().zip(positions(&c).iter().zip(velocities(&c))) {
        assert_eq!((*q, v), (p + far, V3::zeros()));
    }
}

#[test]
fn bad_input_is_refused_and_changes_nothing() {
    let mut c = made(&def());
    let hash = c.state_hash();
    let good = TargetLimit { max_distance_m: 0.1, backstop_radius_m: 0.1, backstop_distance_m: 0.1 };
    let mut refuse = |limit: TargetLimit, error: Error| {
        // only the last particle is bad
        assert_eq!(c.set_target_limits(|i| if i == 132 { limit } else { good }), Err(error), "{limit:?}");
    };
    refuse(TargetLimit { max_distance_m: f32::NAN, ..good }, Error::NotFinite);
    refuse(TargetLimit { max_distance_m: -1.0, ..good }, Error::Negative);
    refuse(TargetLimit { max_distance_m: f32::NEG_INFINITY, ..good }, Error::Negative);
    refuse(TargetLimit { max_distance_m: 1e7, ..good }, Error::OutOfRange);
    for x in [f32::NAN, f32::INFINITY] {
        refuse(TargetLimit { backstop_radius_m: x, ..good }, Error::NotFinite);
        refuse(TargetLimit { backstop_distance_m: x, ..good }, Error::NotFinite);
    }
    refuse(TargetLimit { backstop_radius_m: -0.1, ..good }, Error::Negative);
    refuse(TargetLimit { backstop_distance_m: -0.1, ..good }, Error::Negative);
    refuse(TargetLimit { backstop_distance_m: 2e6, ..good }, Error::OutOfRange);
    let up = V3::new(0.0, 1.0, 0.0);
    for (position_m, normal, error) in [
        (V3::new(f32::NAN, 0.0, 0.0), up, Error::NotFinite),
        (V3::new(0.0, f32::INFINITY, 0.0), up, Error::NotFinite),
        (V3::new(0.0, 2e6, 0.0), up, Error::OutOfRange),
        (up, V3::new(0.0, f32::NAN, 0.0), Error::NotFinite),
        (up, up * 1e-4, Error::OutOfRange),
        (up, up * 1e4, Error::OutOfRange),
    ] {
        let bad = |i: usize| if i == 132 { Target { position_m, normal } } else { target(up) };
        assert_eq!(c.move_targets(Vector3::zeros(), bad), Err(error));
        assert_eq!(c.set_targets(Vector3::zeros(), bad), Err(error));
    }
    let nowhere = Vector3::new(0.0, f64::NAN, 0.0);
    assert_eq!(c.set_targets(nowhere, |_| target(up)), Err(Error::NotFinite));
    assert_eq!(c.state_hash(), hash);
    let mut without = made(&bare());
    assert_eq!(without.set_target_limits(|_| good), Err(Error::FeatureOff));
    assert_eq!(without.set_targets(Vector3::zeros(), |_| target(up)), Err(Error::FeatureOff));
}

/// Pinned particles follow their pins, not their targets.
#[test]
fn pins_are_stronger() {
    let mut c = made(&def());
    c.pin(4).unwrap();
    let here = c.position(4).unwrap();
    c.set_target_limits(|_| within(0.0)).unwrap();
    c.set_targets(Vector3::zeros(), |_| target(V3::new(1.0, 1.0, 1.0))).unwrap();
    steps(&mut c, 2);
    assert_eq!(c.position(4).unwrap(), here);
    assert_eq!(c.position(5).unwrap(), V3::new(1.0, 1.0, 1.0));
}

/// Printed once on x86_64; every other target, width of vector and optimisation level must give the same.
const GOLDEN: u64 = 0xd1f4_75ae_b13e_8f27;

fn wave(c: &mut Cloth<'_>, start: &[V3], frame: u32) {
    let s = (frame % 16) as f32 / 32.0;
    let skin = |i: usize| Target {
        position_m: start[i] + V3::new(s, 0.25 * s, -s),
        normal: V3::new(s, 1.0 - s, (i % 5) as f32 / 4.0 + 0.25),
    };
    c.move_targets(Vector3::zeros(), skin).unwrap();
}

fn dressed() -> (Cloth<'static>, Vec<V3>) {
    let mut c = made(&def());
    let limit = |i: usize| TargetLimit {
        max_distance_m: [0.0, 0.0625, 0.25, f32::INFINITY][i % 4],
        backstop_radius_m: [0.0, 0.125, 1.0][i % 3],
        backstop_distance_m: [0.0, 0.03125][i % 2],
    };
    c.set_target_limits(limit).unwrap();
    let start = positions(&c);
    (c, start)
}

#[test]
fn golden_hash() {
    let (mut c, start) = dressed();
    for frame in 0..90 {
        wave(&mut c, &start, frame);
        steps(&mut c, 1);
    }
    assert_eq!(c.state_hash(), GOLDEN, "{:#x}", c.state_hash());
}

#[test]
fn every_frame_can_be_gone_back_to() {
    let (mut c, start) = dressed();
    for frame in 0..20 {
        wave(&mut c, &start, frame);
        let saved = snapshot(&mut c);
        let mut hashes = [0; 2];
        for hash in &mut hashes {
            for next in 1..4 {
                steps(&mut c, 1);
                wave(&mut c, &start, frame + next);
            }
            *hash = c.state_hash();
            // the limits and the targets are state too
            c.reset();
            c.restore(&saved).unwrap();
        }
        assert_eq!(hashes[0], hashes[1], "frame {frame}");
        steps(&mut c, 1);
    }
}

#[test]
fn forged_targets_are_refused() {
    let (mut c, _) = dressed();
    let saved = snapshot(&mut c);
    let hash = c.state_hash();
    let (plane, at) = ((32 + 16) * (7 + 4) + 32, 16 + 2 * 48 + 3);
    for (number, value, error) in [
        (0, 3e6, Error::OutOfRange),
        (3, 2.0, Error::OutOfRange),
        (10, 2.0, Error::OutOfRange),
        (12, -1.0, Error::Negative),
        (12, 2e6, Error::OutOfRange),
        (13, -1.0, Error::Negative),
        (14, 2e6, Error::OutOfRange),
        (14, f32::NAN, Error::NotFinite),
    ] {
        let mut s = saved.clone();
        let byte = 40 + 4 * (6 * 133 + number * plane + at);
        s[byte..byte + 4].copy_from_slice(&f32::to_le_bytes(value));
        let body = s.len() - 8;
        let mut h = Hash64::new();
        h.bulk(&s[..body]);
        s[body..].copy_from_slice(&h.finish().to_le_bytes());
        assert_eq!(c.restore(&s), Err(error), "plane {number} as {value}");
        assert_eq!(c.state_hash(), hash);
    }
}
