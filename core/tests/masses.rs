//! A mass for each particle: weight, inertia, energy and budget, against closed forms.

mod common;

use common::{Random, bare, bits, cloth, near, positions, snapshot, squares, steps, stir, velocities};
use taut::{Budget, ClothDef, Error, Families, Features, Vector3};

fn with(features: u32, def: ClothDef) -> ClothDef {
    ClothDef { features: Features(Features::MASS.0 | features), ..def }
}

#[test]
fn equal_masses_have_the_bits_of_no_masses() {
    let run = |features: Features| {
        let def = ClothDef { features, inertia_radius_m: 0.3, ..ClothDef::default() };
        let mut c = cloth(&squares(9, 20, 0.05, Families::ALL), &def);
        c.set_stiffness_uniform([3000.0, 2000.0, 500.0, 30.0]).unwrap();
        c.pin(0).unwrap();
        c.pin(19).unwrap();
        stir(&mut c, &mut Random::new(3), 0.5);
        steps(&mut c, 100);
        (bits(&c), c.kinetic_energy_j().to_bits())
    };
    assert_eq!(run(Features::MASS), run(Features::NONE));
}

/// Everything falls alike: v = -g t. The weight m g is rounded and divided by m, which is 2 ulp a substep at most. Springs add
/// what the rounding of positions (5e-7 m after a fall of 5 m) makes of forces on the lightest ones, but no momentum.
#[test]
fn free_fall_does_not_depend_on_the_mass() {
    let def = with(0, ClothDef { damping_per_s: 0.0, speed_limit: 0.0, ..ClothDef::default() });
    for (k, tolerance) in [([0.0; 4], 1e-5), ([500.0, 500.0, 100.0, 8.0], 5e-3)] {
        let mut c = cloth(&squares(8, 8, 0.1, Families::ALL), &def);
        c.set_stiffness_uniform(k).unwrap();
        let mut random = Random::new(1);
        let kg: Vec<f32> = (0..64).map(|_| c.particle_mass_kg() * random.log(1.1e-6, 0.9e6)).collect();
        c.set_masses(&kg).unwrap();
        steps(&mut c, 60);
        for v in velocities(&c) {
            near(v.y.into(), -9.81, tolerance, "v");
            assert!(f64::from(v.x.abs()) < 10.0 * tolerance && v.z == 0.0);
        }
        assert!(c.strain().largest < 2e-3);
        let momentum: f64 = velocities(&c).iter().zip(&kg).map(|(v, m)| f64::from(v.y * m)).sum();
        let mass: f64 = kg.iter().map(|m| f64::from(*m)).sum();
        near(momentum, -9.81 * mass, 1e-5, "momentum");
    }
}

/// Two particles on a spring: the period is 2 pi sqrt(mu / k) with mu = a b / (a + b); symplectic Euler shortens it by
/// (omega dt)^2 / 24, here 1e-5. And the centre of mass stays.
#[test]
fn two_masses_on_a_spring() {
    let def = with(Features::MASK.0, bare());
    for ratio in [1.0, 3.0, 100.0] {
        let mut c = cloth(&squares(2, 2, 1.0, Families::STRUCTURAL), &def);
        c.set_mask(&[1, 1, 0, 0]).unwrap();
        let (a, b) = (0.25f32, 0.25 * ratio);
        c.set_masses(&[a, b, 0.05, 0.05]).unwrap();
        let k = 10.0f32;
        c.set_stiffness_uniform([k; 4]).unwrap();
        assert_eq!(c.budget().unwrap().cut_fraction, 0.0);
        c.set_position(1, Vector3::new(1.1, 0.0, 0.0)).unwrap();
        let mu = f64::from(a * b / (a + b));
        let period = std::f64::consts::TAU * (mu / f64::from(k)).sqrt();
        // the stretch is a cosine of the time, up to half a substep
        let mut last = 0.1;
        let mut crossings = Vec::new();
        for i in 1..=20_000 {
            steps(&mut c, 1);
            let (x, y) = (c.position(0).unwrap().x, c.position(1).unwrap().x);
            let stretch = f64::from(y - x) - 1.0;
            if last > 0.0 && stretch <= 0.0 {
                crossings.push((f64::from(i) - stretch / (stretch - last)) / 960.0);
            }
            last = stretch;
            let momentum = a * c.velocity(0).unwrap().x + b * c.velocity(1).unwrap().x;
            assert!(momentum.abs() < 1e-5, "momentum {momentum}");
        }
        let n = crossings.len() - 1;
        near((crossings[n] - crossings[0]) / n as f64, period, 1e-4, "period");
        let (v, w) =
            (f64::from(c.velocity(0).unwrap().norm_squared()), f64::from(c.velocity(1).unwrap().norm_squared()));
        near(c.kinetic_energy_j(), 0.5 * (f64::from(a) * v + f64::from(b) * w), 1e-5, "energy");
    }
}

/// A hem of ten times the mass: the spring below row r carries the rows below it, so it is longer by (sum of m) g / k.
#[test]
fn a_heavy_hem_sags_as_the_closed_form_says() {
    let (rows, columns, k) = (12usize, 5usize, 200.0f32);
    let def = with(0, ClothDef { damping_per_s: 8.0, ..ClothDef::default() });
    let mut c = cloth(&squares(rows as u32, columns as u32, 0.1, Families::STRUCTURAL), &def);
    let m = c.particle_mass_kg();
    let kg = |i: usize| if i / columns == rows - 1 { 10.0 * m } else { m };
    c.set_masses(&(0..rows * columns).map(kg).collect::<Vec<_>>()).unwrap();
    c.set_stiffness_uniform([k, k, 0.0, 0.0]).unwrap();
    assert_eq!(c.budget().unwrap().cut_fraction, 0.0);
    for i in 0..columns {
        c.pin(i).unwrap();
    }
    steps(&mut c, 600);
    let x = positions(&c);
    for i in 0..(rows - 1) * columns {
        let below = f64::from(m) * ((rows - 2 - i / columns) as f64 + 10.0);
        let stretch = f64::from((x[i] - x[i + columns]).norm()) - 0.1;
        near(stretch, below * 9.81 / f64::from(k), 2e-3, &format!("spring {i}"));
    }
}

/// The bound is in k/M: four times the mass carries the same stiffness at twice the step; one light particle in the middle of
/// heavy ones is what limits it, and only its own springs are cut.
#[test]
fn the_budget_follows_the_masses() {
    for budget in [Budget::Certified, Budget::Tuned] {
        let def = with(0, ClothDef { budget, damping_per_s: 0.0, ..ClothDef::default() });
        let mut c = cloth(&squares(9, 9, 0.1, Families::ALL), &def);
        c.set_stiffness_uniform([100.0, 100.0, 20.0, 1.0]).unwrap();
        let (m, before) = (c.particle_mass_kg(), c.budget().unwrap());
        assert_eq!(before.cut_fraction, 0.0);
        c.set_masses(&[4.0 * m; 81]).unwrap();
        near(c.budget().unwrap().max_dt_s.into(), f64::from(before.max_dt_s) * 2.0, 1e-5, "max dt");
        let mut kg = [m; 81];
        kg[40] = 1e-4 * m;
        c.set_masses(&kg).unwrap();
        let report = c.budget().unwrap();
        near(report.max_dt_s.into(), f64::from(before.max_dt_s) / 100.0, 1e-5, "max dt");
        // 4 structural, 4 shear, 4 bend of 144, 128, 126 springs
        let (all, cut) = (144.0 * 100.0 + 128.0 * 20.0 + 126.0, 400.0 + 80.0 + 4.0);
        assert!((0.97..=1.0).contains(&(f64::from(report.cut_fraction) / (cut / all))), "{report:?}");
        assert!(report.inertia_added.abs() < 1e-6);
    }
}

/// Ratios of 1e12 between neighbours, any stiffness, noise: finite under both budgets, `Certified` without any clamp.
#[test]
fn any_ratio_of_masses_stays_finite() {
    for seed in 0..8 {
        let mut random = Random::new(seed);
        let budget = [Budget::Certified, Budget::Tuned][seed as usize % 2];
        let clamps = budget == Budget::Tuned;
        let def = ClothDef {
            budget,
            rate_hz: 240.0,
            substeps: 4,
            damping_per_s: 1.0,
            speed_limit: if clamps { 0.25 } else { 0.0 },
            compression_limit: clamps,
            inertia_radius_m: if seed < 4 { 0.3 } else { 0.0 },
            ..ClothDef::default()
        };
        let mut c = cloth(&squares(16, 16, 0.05, Families::ALL), &with(0, def));
        let share = c.particle_mass_kg();
        let kg: Vec<f32> = (0..256).map(|_| share * [1e-6f32, 1.0, 1e6][random.below(3)]).collect();
        c.set_masses(&kg).unwrap();
        c.set_stiffness_uniform([random.log(1.0, 1e9), random.log(1.0, 1e9), random.log(1.0, 1e9), 1e9]).unwrap();
        c.pin(0).unwrap();
        c.pin(15).unwrap();
        for i in 1..256 {
            let p = c.position(i).unwrap() + random.vector(0.02);
            c.set_position(i, p).unwrap();
        }
        steps(&mut c, 1000);
        assert!(positions(&c).iter().all(|p| p.norm() < 1e3), "seed {seed}");
    }
}

#[test]
fn new_masses_leave_velocities_alone_and_bad_ones_are_refused() {
    let def = with(0, ClothDef { inertia_radius_m: 0.3, ..ClothDef::default() });
    let mut c = cloth(&squares(6, 6, 0.1, Families::ALL), &def);
    c.set_stiffness_uniform([500.0; 4]).unwrap();
    c.pin(0).unwrap();
    stir(&mut c, &mut Random::new(1), 1.0);
    steps(&mut c, 3);
    let saved = snapshot(&mut c);
    let (before, m) = (velocities(&c), c.particle_mass_kg());
    let kg: Vec<f32> = (0..36).map(|i| m * (1 + i) as f32).collect();
    let energy = c.kinetic_energy_j();
    c.set_masses(&kg).unwrap();
    assert_eq!(velocities(&c), before);
    assert_eq!(c.mass_kg(3), Ok(4.0 * m));
    assert!(c.kinetic_energy_j() > 1.5 * energy);
    let hash = c.state_hash();
    assert_eq!(c.restore(&saved), Err(Error::Foreign));
    for (bad, error) in
        [(f32::NAN, Error::NotFinite), (-m, Error::Negative), (0.0, Error::OutOfRange), (2e6 * m, Error::OutOfRange)]
    {
        let mut kg = kg.clone();
        kg[35] = bad;
        assert_eq!(c.set_masses(&kg), Err(error));
    }
    assert_eq!(c.set_masses(&kg[1..]), Err(Error::Shape));
    assert_eq!((c.state_hash(), c.mass_kg(35)), (hash, Ok(36.0 * m)));
    c.set_masses(&[m; 36]).unwrap();
    c.restore(&saved).unwrap();
    assert_eq!(velocities(&c), before);
    let mut none = cloth(&squares(6, 6, 0.1, Families::ALL), &ClothDef::default());
    assert_eq!(none.set_masses(&kg), Err(Error::FeatureOff));
    assert_eq!(none.mass_kg(36), Err(Error::NoSuchParticle));
}
