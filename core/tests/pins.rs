//! Pins: where they are during a frame and after it, how fast, in what order, and what is refused.

mod common;

use common::{Random, bare, bits, cloth, positions, squares, steps, stir};
use taut::{Cloth, ClothDef, Error, Families, Vector3};

/// 240 substeps a second, as frames of four substeps or of one.
fn pair() -> [Cloth<'static>; 2] {
    [(60.0, 4), (240.0, 1)].map(|(rate_hz, substeps)| {
        let def = ClothDef { rate_hz, substeps, ..ClothDef::default() };
        let mut c = cloth(&squares(5, 5, 0.25, Families::ALL), &def);
        c.set_stiffness_uniform([200.0, 100.0, 30.0, 2.0]).unwrap();
        c.pin(0).unwrap();
        c.pin(4).unwrap();
        c
    })
}

/// One frame of four substeps moves a pin as four frames of one substep with a quarter of the way each. Numbers are
/// multiples of 2^-6, so that both are exact. A pin that jumps at the start or the end of the frame, or is late by a
/// substep, pulls its neighbours otherwise.
#[test]
fn pins_are_interpolated_over_the_substeps() {
    let [mut coarse, mut fine] = pair();
    let mut at = [Vector3::zeros(), Vector3::new(1.0, 0.0, 0.0)];
    let way = [Vector3::new(0.0625, -0.125, 0.25), Vector3::new(0.0, 0.0, -0.0625)];
    for frame in 0..10 {
        let way = way.map(|w: Vector3<f64>| if frame % 3 == 2 { -w } else { w });
        for (i, p) in [0, 4].into_iter().enumerate() {
            coarse.move_pin(p, at[i] + way[i]).unwrap();
        }
        steps(&mut coarse, 1);
        for quarter in 1..=4 {
            for (i, p) in [0, 4].into_iter().enumerate() {
                let to = at[i] + way[i] * (f64::from(quarter) / 4.0);
                fine.move_pin(p, to).unwrap();
            }
            steps(&mut fine, 1);
        }
        for i in 0..2 {
            at[i] += way[i];
        }
        assert_eq!(bits(&coarse), bits(&fine), "frame {frame}");
    }
}

#[test]
fn a_pin_arrives_exactly_and_then_rests() {
    let def = ClothDef {
        substeps: 7, // shares of 1/7 are not exact
        origin_m: [100.0, -20.0, 3.0],
        ..ClothDef::default()
    };
    let mut c = cloth(&squares(4, 6, 0.1, Families::ALL), &def);
    c.set_stiffness_uniform([100.0, 100.0, 30.0, 2.0]).unwrap();
    c.pin(9).unwrap();
    let to = Vector3::new(100.3, -20.1, 2.95);
    c.move_pin(9, to).unwrap();
    let from = c.world_position(9).unwrap();
    steps(&mut c, 1);
    let here = c.position(9).unwrap();
    let local = to - Vector3::new(100.0, -20.0, 3.0);
    assert_eq!(here, local.cast::<f32>());
    let v = c.velocity(9).unwrap().cast::<f64>();
    assert!((v - (to - from) * 60.0).norm() < 1e-3, "{v}");
    steps(&mut c, 1);
    assert_eq!(c.position(9).unwrap(), here);
    assert_eq!(c.velocity(9).unwrap(), Vector3::zeros());
    // an old target does not come back
    steps(&mut c, 3);
    assert_eq!(c.position(9).unwrap(), here);
}

/// Thrown: after the pin is gone the particle flies on with the pin's velocity; nothing else acts on it here.
#[test]
fn an_unpinned_particle_keeps_the_velocity_of_its_pin() {
    let mut c = cloth(&squares(2, 2, 0.5, Families::ALL), &bare());
    c.set_stiffness_uniform([0.0; 4]).unwrap();
    c.pin(3).unwrap();
    let at = c.position(3).unwrap();
    let way = Vector3::new(0.0, 0.125, -0.25f32);
    c.move_pin(3, (at + way).cast()).unwrap();
    steps(&mut c, 1);
    c.unpin(3).unwrap();
    assert_eq!(c.velocity(3).unwrap(), way * 960.0);
    steps(&mut c, 1);
    assert!((c.position(3).unwrap() - (at + way * 2.0)).norm() < 1e-6);
    assert_eq!(c.pin_count(), 0);
    // a pin that rested before has no velocity to give
    c.pin(0).unwrap();
    steps(&mut c, 1);
    c.unpin(0).unwrap();
    assert_eq!(c.velocity(0).unwrap(), Vector3::zeros());
}

/// Pinning stops a particle where it is, and what is pinned already is left alone (with its target).
#[test]
fn pinning_stops_and_pinning_twice_does_nothing() {
    let mut c = cloth(&squares(4, 4, 0.1, Families::ALL), &bare());
    c.set_stiffness_uniform([50.0; 4]).unwrap();
    stir(&mut c, &mut Random::new(1), 1.0);
    steps(&mut c, 3);
    let before = positions(&c);
    c.pin(6).unwrap();
    assert_eq!(c.velocity(6).unwrap(), Vector3::zeros());
    let target = Vector3::new(0.5, 0.5, 0.5);
    c.move_pin(6, target.cast()).unwrap();
    c.pin(6).unwrap();
    assert_eq!(c.pin_count(), 1);
    assert_eq!(positions(&c), before);
    steps(&mut c, 1);
    assert_eq!(c.position(6).unwrap(), target);
}

/// A set of pins is the same state however it was made.
#[test]
fn the_order_of_pinning_does_not_matter() {
    let mut random = Random::new(5);
    let made = |order: &[usize], extra: &[usize]| {
        let def = ClothDef { max_pins: 20, inertia_radius_m: 0.4, ..ClothDef::default() };
        let mut c = cloth(&squares(8, 8, 0.1, Families::ALL), &def);
        c.set_stiffness_uniform([300.0, 300.0, 90.0, 6.0]).unwrap();
        for p in order.iter().chain(extra) {
            c.pin(*p).unwrap();
        }
        for p in extra {
            c.unpin(*p).unwrap();
        }
        for p in order {
            let to = c.world_position(*p).unwrap().add_scalar(0.01);
            c.move_pin(*p, to).unwrap();
        }
        assert!(c.pinned().is_sorted());
        assert!(c.pinned().all(|p| order.contains(&p)));
        let start = c.state_hash();
        steps(&mut c, 10);
        (start, c.state_hash())
    };
    let mut order: Vec<usize> = (0..12).map(|i| (i * 29) % 64).collect();
    let first = made(&order, &[]);
    for _ in 0..20 {
        for i in (1..order.len()).rev() {
            order.swap(i, random.below(i + 1));
        }
        assert_eq!(made(&order, &[]), first);
        assert_eq!(made(&order, &[62, 1, 30]), first);
    }
}

/// Moving a pinned particle by hand moves its pin, with no way left to go.
#[test]
fn a_pinned_particle_that_is_placed_stays_there() {
    let mut c = cloth(&squares(3, 3, 0.1, Families::ALL), &bare());
    c.set_stiffness_uniform([10.0; 4]).unwrap();
    c.pin(2).unwrap();
    c.move_pin(2, Vector3::new(9.0, 9.0, 9.0)).unwrap();
    let p = Vector3::new(0.3, 0.1, -0.2);
    c.set_position(2, p).unwrap();
    steps(&mut c, 2);
    assert_eq!(c.position(2).unwrap(), p);
    // and it has no velocity of its own
    c.set_velocity(2, Vector3::new(1.0, 0.0, 0.0)).unwrap();
    assert_eq!(c.velocity(2).unwrap(), Vector3::zeros());
}

/// Small grids take the default definition, though it has room for more pins than they have particles.
#[test]
fn every_particle_of_a_small_grid_can_be_pinned() {
    let mut c = cloth(&squares(2, 3, 0.1, Families::ALL), &ClothDef { inertia_radius_m: 0.3, ..ClothDef::default() });
    c.set_stiffness_uniform([10.0; 4]).unwrap();
    for p in 0..6 {
        c.pin(p).unwrap();
    }
    let before = positions(&c);
    steps(&mut c, 5);
    assert_eq!(positions(&c), before);
    let report = c.budget().unwrap();
    assert_eq!((report.inertia_added, report.cut_fraction), (0.0, 0.0));
}

#[test]
fn what_cannot_be_is_named_and_changes_nothing() {
    let def = ClothDef { max_pins: 2, origin_m: [1e9, 0.0, 0.0], ..ClothDef::default() };
    let mut c = cloth(&squares(4, 4, 0.1, Families::ALL), &def);
    c.set_stiffness_uniform([10.0; 4]).unwrap();
    c.pin(5).unwrap();
    c.pin(2).unwrap();
    let hash = c.state_hash();
    let o = Vector3::new(1e9, 0.0, 0.0);
    assert_eq!(c.pin(7), Err(Error::TooManyPins));
    assert_eq!(c.pin(2), Ok(()), "pinned already, so no room is needed");
    assert_eq!(c.pin(16), Err(Error::NoSuchParticle));
    assert_eq!(c.pin(usize::MAX), Err(Error::NoSuchParticle));
    assert_eq!(c.unpin(3), Err(Error::NotPinned));
    assert_eq!(c.unpin(16), Err(Error::NoSuchParticle));
    assert_eq!(c.move_pin(3, o), Err(Error::NotPinned));
    assert_eq!(c.move_pin(16, o), Err(Error::NoSuchParticle));
    let nan = Vector3::new(f64::NAN, 0.0, 0.0);
    assert_eq!(c.move_pin(2, nan), Err(Error::NotFinite));
    let far = o + Vector3::new(0.0, 1.1e6, 0.0);
    assert_eq!(c.move_pin(2, far), Err(Error::OutOfRange));
    assert_eq!(c.move_pin(2, Vector3::zeros()), Err(Error::OutOfRange));
    assert_eq!(c.state_hash(), hash);
    assert_eq!(c.pinned().collect::<Vec<_>>(), [2, 5]);
    let edge = o + Vector3::new(0.0, 1e6, 0.0);
    assert_eq!(c.move_pin(2, edge), Ok(()));
    c.unpin(5).unwrap();
    assert_eq!(c.pin(7), Ok(()));
}
