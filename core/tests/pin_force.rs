//! The forces that hold the pins, against what hangs on them.

mod common;

use common::{Scene, bare, cloth, near, squares, steps};
use taut::{Cloth, ClothDef, Error, Families, Features, Vector3};

fn sum(c: &mut Cloth<'_>) -> Vector3<f64> {
    c.pin_forces().map(|(_, f)| f.cast::<f64>()).sum()
}

/// One spring of length 1 m: k (l - 1) along it, to rounding; a compressed one pushes, down to the limit of k l.
#[test]
fn one_spring() {
    for (length, limited, expected) in [(1.3f64, true, 0.3), (0.7, true, -0.3), (0.2, false, -0.8), (0.2, true, -0.2)] {
        let def = ClothDef { features: Features::MASK, compression_limit: limited, ..bare() };
        let mut c = cloth(&squares(2, 2, 1.0, Families::ALL), &def);
        c.set_mask(&[1, 1, 0, 0]).unwrap();
        c.set_stiffness_uniform([40.0; 4]).unwrap();
        c.pin(0).unwrap();
        c.set_position(1, Vector3::new(0.6, 0.0, 0.8) * length as f32).unwrap();
        let f = c.pin_force(0).unwrap().cast::<f64>();
        // the pin pulls against the spring
        assert!((f + Vector3::new(0.6, 0.0, 0.8) * 40.0 * expected).norm() < 2e-5, "{length}: {f}");
    }
}

/// At rest the pins carry the weight of the whole sheet, and no sideways force in sum; with the inertia field, a heavy hem,
/// both, and every scene.
#[test]
fn the_pins_carry_the_weight() {
    for scene in Scene::ALL {
        for features in [Features::NONE, Features::MASS] {
            for radius in [0.0, 0.3] {
                let def = ClothDef {
                    damping_per_s: 6.0,
                    inertia_radius_m: radius,
                    inertia_max: 8.0,
                    features,
                    ..ClothDef::default()
                };
                let mut c = cloth(&squares(10, 10, 0.1, Families::ALL), &def);
                c.set_stiffness_uniform([600.0, 400.0, 100.0, 8.0]).unwrap();
                let m = c.particle_mass_kg();
                let mut weight = 100.0;
                if features == Features::MASS {
                    c.set_masses(&(0..100).map(|i| if i >= 90 { 5.0 * m } else { m }).collect::<Vec<_>>()).unwrap();
                    weight += 40.0;
                }
                scene.pin(&mut c);
                steps(&mut c, 1800);
                let total = sum(&mut c);
                let weight = weight * f64::from(m) * 9.81;
                near(total.y, weight, 1e-2, &format!("{scene:?} {features:?} {radius}"));
                assert!(total.x.abs() + total.z.abs() < 1e-2 * weight, "{scene:?}: {total}");
                if scene == Scene::Hang2 {
                    let [a, b] = [0, 9].map(|p| c.pin_force(p).unwrap());
                    near(a.y.into(), b.y.into(), 1e-2, "both corners alike");
                    near(a.x.into(), (-b.x).into(), 1e-2, "the corners are drawn together");
                    assert!(a.x < 0.0);
                }
            }
        }
    }
}

/// A pull hangs on the pins as the weight does: on a free particle through the springs, on the pinned one itself at once.
#[test]
fn the_pins_carry_pulls() {
    let def = ClothDef { features: Features::PULL, damping_per_s: 6.0, ..ClothDef::default() };
    let mut c = cloth(&squares(6, 6, 0.1, Families::ALL), &def);
    c.set_stiffness_uniform([600.0, 400.0, 100.0, 8.0]).unwrap();
    Scene::Edge.pin(&mut c);
    let pull = Vector3::new(0.1, -0.2, 0.05f32);
    for _ in 0..1200 {
        c.add_force(33, pull).unwrap();
        steps(&mut c, 1);
    }
    let weight = 36.0 * f64::from(c.particle_mass_kg()) * 9.81;
    let expected = Vector3::new(0.0, weight, 0.0) - pull.cast::<f64>();
    let total = sum(&mut c);
    assert!((total - expected).norm() < 0.01 * expected.norm(), "{total} {expected}");
    let before = c.pin_force(3).unwrap();
    c.add_force(3, pull).unwrap();
    assert!((c.pin_force(3).unwrap() - (before - pull)).norm() < 1e-6);
}

/// All at once or one by one, ascending; asking changes nothing.
#[test]
fn all_at_once_are_the_single_ones() {
    for features in [Features::NONE, Features::PULL, Features::MASS] {
        let def = ClothDef { features, ..ClothDef::default() };
        let mut c = cloth(&squares(6, 6, 0.1, Families::ALL), &def);
        c.set_stiffness_uniform([600.0, 400.0, 100.0, 8.0]).unwrap();
        for p in [35, 0, 14, 5] {
            c.pin(p).unwrap();
        }
        steps(&mut c, 7);
        let hash = c.state_hash();
        let all: Vec<_> = c.pin_forces().collect();
        assert_eq!(all.iter().map(|(p, _)| *p).collect::<Vec<_>>(), [0, 5, 14, 35]);
        for (p, f) in all {
            assert_eq!(c.pin_force(p), Ok(f));
            assert!(f.norm() > 0.0);
        }
        assert_eq!(c.pin_force(1), Err(Error::NotPinned));
        assert_eq!(c.pin_force(36), Err(Error::NoSuchParticle));
        assert_eq!(c.state_hash(), hash);
    }
}
