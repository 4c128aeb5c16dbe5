//! The inertia field: M_i = q_i m with q_i = clip(radius / distance to the nearest pin, 1, max), weight unchanged.

mod common;

use common::{Random, bare, cloth, grid, near, positions, squares, steps, stir, velocities};
use taut::{Budget, Cloth, ClothDef, Families, Grid, Vector3};

/// q of every particle, 0 for pinned ones: what a weak gravity along z does in one substep to the flat sheet at rest.
fn inertia_of(c: &mut Cloth<'_>) -> Vec<f64> {
    let (g, dt) = (c.def().gravity_m_s2[2], c.def().dt_s());
    steps(c, 1);
    velocities(c).iter().map(|v| if v.z == 0.0 { 0.0 } else { f64::from(g) * f64::from(dt) / f64::from(v.z) }).collect()
}

/// The formula of the documentation, every particle against every pin.
fn expected(grid: &Grid, def: &ClothDef, pins: &[usize]) -> Vec<f64> {
    let n = grid.columns();
    let (u, v) = (f64::from(grid.rest_u()), f64::from(grid.rest_v()));
    let at = |i: usize| ((i % n) as f64 * u, (i / n) as f64 * v);
    (0..grid.particles())
        .map(|i| {
            if pins.contains(&i) {
                return 0.0;
            }
            let distance = pins.iter().fold(f64::INFINITY, |d, p| {
                let ((x, y), (px, py)) = (at(i), at(*p));
                d.min((x - px).hypot(y - py))
            });
            (f64::from(def.inertia_radius_m) / distance).clamp(1.0, f64::from(def.inertia_max))
        })
        .collect()
}

/// Catches a search along rows that stops too early, a mix-up of u and v, distances in cells instead of metres.
#[test]
fn q_is_that_of_the_nearest_pin() {
    let mut seen = [0usize; 3];
    for seed in 0..80 {
        let mut r = Random::new(seed);
        let (m, n) = (2 + r.below(24) as u32, 2 + r.below(24) as u32);
        let grid = grid(m, n, r.log(0.1, 10.0), r.log(0.1, 10.0), Families::ALL);
        let size = grid.def().width_m.max(grid.def().height_m);
        let def = ClothDef {
            gravity_m_s2: [0.0, 0.0, 1e-3],
            inertia_radius_m: size * r.log(0.01, 2.0),
            inertia_max: r.log(1.5, 100.0),
            ..bare()
        };
        let mut c = cloth(&grid, &def);
        c.set_stiffness_uniform([100.0, 100.0, 30.0, 1.0]).unwrap();
        let most = 1 + r.below(12);
        let mut pins: Vec<usize> = (0..most).map(|_| r.below(grid.particles())).collect();
        if seed % 4 == 0 {
            pins = (0..n as usize).collect(); // a whole edge
        }
        for p in &pins {
            c.pin(*p).unwrap();
        }
        let report = c.budget().unwrap();
        let q = inertia_of(&mut c);
        let e = expected(&grid, &def, &pins);
        let free = e.iter().filter(|q| **q > 0.0);
        for (i, (q, e)) in q.iter().zip(&e).enumerate() {
            assert!((q - e).abs() <= 2e-5 * e, "seed {seed}, particle {i}: {q} instead of {e}");
            let kind = if *e <= 1.0 {
                0
            } else if *e < f64::from(def.inertia_max) {
                1
            } else {
                2
            };
            seen[kind] += usize::from(*e > 0.0);
        }
        let count = free.clone().count();
        if count > 0 {
            let added = free.sum::<f64>() / count as f64 - 1.0;
            assert!(
                (f64::from(report.inertia_added) - added).abs() < 1e-4 * (1.0 + added),
                "seed {seed}: {report:?}, not {added}"
            );
        }
    }
    assert!(seen.iter().all(|s| *s > 200), "{seen:?}");
}

#[test]
fn nothing_pinned_or_no_radius_is_no_inertia() {
    for (radius, max, pin) in [(0.0, 32.0, true), (0.3, 1.0, true), (0.3, 32.0, false)] {
        let def = ClothDef { gravity_m_s2: [0.0, 0.0, 1e-3], inertia_radius_m: radius, inertia_max: max, ..bare() };
        let mut c = cloth(&squares(6, 6, 0.1, Families::ALL), &def);
        c.set_stiffness_uniform([100.0; 4]).unwrap();
        if pin {
            c.pin(14).unwrap();
        }
        let q = inertia_of(&mut c);
        assert!(q.iter().all(|q| *q == 0.0 || (q - 1.0).abs() < 1e-6), "{q:?}");
        assert_eq!(q.iter().filter(|q| **q == 0.0).count(), usize::from(pin));
        assert!(c.budget().unwrap().inertia_added.abs() < 1e-6);
    }
}

/// When pins come and go every particle that stays free keeps M v, so the sheet gets no kick. (That is the definition's
/// word; a cloth that kept v would gain up to 32 x the momentum around a new pin.)
#[test]
fn momentum_is_kept_when_pins_change() {
    let mut r = Random::new(11);
    let g = squares(9, 14, 0.1, Families::ALL);
    let def = ClothDef { inertia_radius_m: 0.5, ..bare() };
    let mut c = cloth(&g, &def);
    c.set_stiffness_uniform([50.0, 50.0, 10.0, 1.0]).unwrap();
    let mut pins = vec![0, 13];
    for p in &pins {
        c.pin(*p).unwrap();
    }
    steps(&mut c, 1);
    for change in 0..40 {
        stir(&mut c, &mut r, 1.0);
        let before = velocities(&c);
        let q0 = expected(&g, &def, &pins);
        let energy = c.kinetic_energy_j();
        if pins.len() > 1 && change % 2 == 1 {
            let p = pins.swap_remove(r.below(pins.len()));
            c.unpin(p).unwrap();
        }
        let p = r.below(g.particles());
        if !pins.contains(&p) {
            c.pin(p).unwrap();
            pins.push(p);
        }
        assert_eq!(c.pin_count(), pins.len());
        c.state_hash(); // settles it, as the next step would
        let q1 = expected(&g, &def, &pins);
        for (i, (v0, v1)) in before.iter().zip(velocities(&c)).enumerate() {
            if q0[i] > 0.0 && q1[i] > 0.0 {
                let (p0, p1) = (v0.cast::<f64>() * q0[i], v1.cast::<f64>() * q1[i]);
                assert!((p0 - p1).norm() < 1e-4 * p0.norm(), "particle {i}");
            } else if q1[i] == 0.0 {
                assert_eq!(v1, Vector3::zeros(), "pinned particle {i}");
            }
        }
        assert!(energy > 0.0);
    }
}

/// The kinetic energy counts q m.
#[test]
fn the_kinetic_energy_has_the_inertial_mass() {
    let g = squares(7, 7, 0.1, Families::ALL);
    let def = ClothDef { inertia_radius_m: 0.4, ..bare() };
    let mut c = cloth(&g, &def);
    c.set_stiffness_uniform([50.0; 4]).unwrap();
    c.pin(24).unwrap();
    stir(&mut c, &mut Random::new(2), 2.0);
    let q = expected(&g, &def, &[24]);
    let m = f64::from(c.particle_mass_kg());
    let by_hand: f64 = velocities(&c).iter().zip(&q).map(|(v, q)| 0.5 * q * m * v.cast::<f64>().norm_squared()).sum();
    near(c.kinetic_energy_j(), by_hand, 1e-5, "kinetic energy");
}

/// The weight stays m g: with the same springs the rest shape is that of the cloth without the field, and the springs at
/// the pins carry the weight of the free particles. A field that scaled the weight too would hang up to 32 x too much
/// weight there.
#[test]
fn the_weight_is_unchanged() {
    let rest = |inertia_radius_m: f32| {
        let def = ClothDef {
            rate_hz: 60.0,
            substeps: 16,
            damping_per_s: 5.0,
            gravity_m_s2: [0.0, -9.81, 0.0],
            inertia_radius_m,
            inertia_max: 8.0,
            ..bare()
        };
        let mut c = cloth(&squares(8, 8, 0.05, Families(3)), &def);
        c.set_stiffness_uniform([60.0, 60.0, 30.0, 0.0]).unwrap();
        c.pin(0).unwrap();
        c.pin(7).unwrap();
        let report = c.budget().unwrap();
        assert_eq!(report.cut_fraction, 0.0);
        steps(&mut c, 900);
        assert!(c.kinetic_energy_j() < 1e-9);
        (positions(&c), report.inertia_added, c.particle_mass_kg())
    };
    let ((light, none, m), (heavy, some, _)) = (rest(0.0), rest(0.3));
    assert!(none.abs() < 1e-6 && some > 0.3, "{none} {some}");
    for (a, b) in light.iter().zip(&heavy) {
        assert!((a - b).norm() < 2e-4, "{a} and {b}");
    }
    let mut reaction = Vector3::zeros();
    for (pin, side) in [(0usize, 1isize), (7, -1)] {
        for (other, k, l0) in [
            ((pin as isize + side) as usize, 60.0, 0.05),
            (pin + 8, 60.0, 0.05),
            ((pin as isize + 8 + side) as usize, 30.0, 0.05 * 2f64.sqrt()),
        ] {
            let d: Vector3<f64> = (heavy[other] - heavy[pin]).cast();
            reaction += d * (k * (1.0 - l0 / d.norm()));
        }
    }
    near(reaction.y, -62.0 * f64::from(m) * 9.81, 2e-3, "weight on the pins");
    assert!(reaction.x.abs() < 2e-3 * reaction.y.abs());
}

/// What it is for: at the same step, and K at the budget, the sheet stretches several times less at its pins.
#[test]
fn the_pins_stretch_less_at_the_same_step() {
    let stretch = |inertia_radius_m| {
        let def = ClothDef { budget: Budget::Tuned, inertia_radius_m, ..ClothDef::default() };
        let mut c = cloth(&squares(17, 17, 0.0625, Families::ALL), &def);
        c.set_stiffness_uniform([1e5, 1e5, 3e4, 2e3]).unwrap();
        c.pin(0).unwrap();
        c.pin(16).unwrap();
        steps(&mut c, 480);
        c.strain().largest
    };
    let (without, with) = (stretch(0.0), stretch(0.3));
    assert!(with < 0.4 * without, "{without} without, {with} with");
}
