//! The air: closed forms of drag and lift, what it must leave alone, and that it only damps.

mod common;

use common::{Random, bare, bits, cloth, near, positions, put, snapshot, squares, steps, stir, velocities};
use taut::{Air, Budget, Cloth, ClothDef, Error, Families, Features, Vector3};

type V = Vector3<f64>;

fn airy() -> ClothDef {
    ClothDef { features: Features::AIR, ..bare() }
}

/// Air alone: no springs.
fn loose(rows: u32, columns: u32, def: &ClothDef, air: &Air) -> Cloth<'static> {
    let mut c = cloth(&squares(rows, columns, 0.05, Families::ALL), def);
    c.set_stiffness_uniform([0.0; 4]).unwrap();
    c.set_air(air).unwrap();
    c
}

fn sum(all: impl IntoIterator<Item = V>) -> V {
    all.into_iter().sum()
}

/// The force on the whole cloth in one substep from its momentum, no other force acting.
fn force(c: &mut Cloth<'_>) -> V {
    let before = sum(velocities(c).iter().map(|v| v.cast()));
    steps(c, 1);
    let after = sum(velocities(c).iter().map(|v| v.cast()));
    (after - before) * f64::from(c.particle_mass_kg()) / f64::from(c.def().dt_s())
}

/// One cell keeps flat while it falls, so its speed is v_t tanh(g t / v_t) with v_t = sqrt(2 m g / (rho Cd A)).
/// First order in dt, dt g / (2 v_t): 1e-3 here.
#[test]
fn a_falling_cell_reaches_its_terminal_velocity_as_tanh() {
    for (density_kg_m2, drag) in [(0.2, 1.2), (0.5, 0.7), (0.1, 2.0)] {
        let def = ClothDef { density_kg_m2, gravity_m_s2: [0.0, 0.0, -9.81], rate_hz: 3840.0, ..airy() };
        let mut c = loose(2, 2, &def, &Air { drag, ..Air::default() });
        let end = (2.0 * f64::from(density_kg_m2) * 9.81 / (1.2 * f64::from(drag))).sqrt();
        for tenth in 1..=30 {
            steps(&mut c, 384);
            let expected = end * (9.81 * 0.1 * f64::from(tenth) / end).tanh();
            for v in velocities(&c) {
                near(-f64::from(v.z), expected, 2e-3, "speed of the fall");
                assert!(v.xy().norm() < 1e-5, "{v}");
            }
        }
        near(-f64::from(c.velocity(0).unwrap().z), end, 1e-4, "terminal velocity");
    }
}

/// A whole sheet that is stiff to bend falls at the same speed: the mean over its particles, within 1 % for the little that
/// its border (less air, as much mass) hangs down.
#[test]
fn a_falling_sheet_reaches_the_same_terminal_velocity() {
    let def = ClothDef {
        gravity_m_s2: [0.0, 0.0, -9.81],
        features: Features(Features::AIR.0 | Features::HINGE.0),
        hinge_rigidity_n_m: 0.05,
        rate_hz: 240.0,
        substeps: 16,
        ..airy()
    };
    let mut c = cloth(&squares(9, 9, 0.05, Families(3)), &def);
    c.set_stiffness_uniform([2000.0, 2000.0, 600.0, 0.0]).unwrap();
    c.set_air(&Air::default()).unwrap();
    steps(&mut c, 240 * 3);
    let mean = sum(velocities(&c).iter().map(|v| v.cast())) / 81.0;
    near(-mean.z, (2.0f64 * 0.2 * 9.81 / (1.2 * 1.2)).sqrt(), 1e-2, "terminal velocity");
}

/// Drag 1/2 rho Cd A v^2 sin(alpha) along the wind and lift 1/2 rho Cl A v^2 sin(alpha) cos(alpha) across it, at any angle of
/// attack and from either side. f32 over 35 particles: 1e-4.
#[test]
fn an_inclined_sheet_has_the_drag_and_lift_of_its_angle() {
    let def = airy();
    let wind = 7.0f64;
    for degrees in [-170, -90, -35, -1, 5, 20, 45, 70, 90, 120] {
        let alpha = f64::from(degrees).to_radians();
        let (sin, cos) = alpha.sin_cos();
        let tilted = ClothDef { u_axis: [cos as f32, 0.0, -sin as f32], v_axis: [0.0, 1.0, 0.0], ..def };
        let (drag, lift) = (0.9, 1.7);
        let air = Air { wind_m_s: [wind as f32, 0.0, 0.0], density_kg_m3: 1.1, drag, lift, ..Air::default() };
        let f = force(&mut loose(5, 7, &tilted, &air));
        let area = 4.0 * 6.0 * 0.05 * 0.05;
        let q = 0.5 * 1.1 * area * wind * wind;
        near(f.x, q * f64::from(drag) * sin.abs(), 1e-4, "drag");
        // the leading edge stands high, so the wind lifts
        let expected = q * f64::from(lift) * sin.abs() * cos * sin.signum();
        assert!((f.z - expected).abs() < 1e-4 * q, "lift at {degrees} degrees: {} instead of {expected}", f.z);
        assert!(f.y.abs() < 1e-5 * q, "{f}");
    }
}

/// Air that rests with the sheet gives no force at all, not even a bit: still air and a sheet at rest, or a wind as fast as
/// the sheet. Catches a wind that is added with the wrong sign.
#[test]
fn air_that_moves_with_the_sheet_is_not_felt() {
    for v in [[0.0, 0.0, 0.0], [3.0, -1.5, 8.0]] {
        let mut c = loose(6, 70, &airy(), &Air { wind_m_s: v, ..Air::default() });
        for i in 0..c.grid().particles() {
            c.set_velocity(i, v.into()).unwrap();
        }
        let mut random = Random::new(5);
        steps(&mut c, 20);
        assert!(velocities(&c).iter().all(|u| *u == Vector3::from(v)));
        // it is felt as soon as it does not
        stir(&mut c, &mut random, 1.0);
        let before = velocities(&c);
        steps(&mut c, 1);
        assert_ne!(velocities(&c), before);
    }
}

/// No air (density 0, or no coefficient) leaves the bits of a cloth without the feature.
#[test]
fn no_air_leaves_no_trace() {
    let grid = squares(9, 12, 0.05, Families::ALL);
    let run = |air: Option<Air>| {
        let def =
            ClothDef { features: if air.is_some() { Features::AIR } else { Features::NONE }, ..ClothDef::default() };
        let mut c = cloth(&grid, &def);
        c.set_stiffness_uniform([20.0, 20.0, 5.0, 0.1]).unwrap();
        if let Some(air) = air {
            c.set_air(&air).unwrap();
        }
        c.pin(0).unwrap();
        steps(&mut c, 60);
        assert_eq!(c.budget().unwrap().cut_fraction, 0.0);
        bits(&c)
    };
    let wind = Air { wind_m_s: [9.0, 0.0, 2.0], ..Air::default() };
    let bare = run(None);
    assert_eq!(run(Some(Air { density_kg_m3: 0.0, ..wind })), bare);
    assert_eq!(run(Some(Air { drag: 0.0, lift: 0.0, ..wind })), bare);
    assert_ne!(run(Some(wind)), bare);
}

/// The force on every particle of a crumpled, moving sheet is that of the formula, computed cell by cell in f64.
/// Sizes around the 64 cells that core works on at a time.
#[test]
fn every_particle_has_the_force_of_its_cells() {
    for (seed, (rows, columns)) in [(2, 2), (2, 9), (7, 3), (4, 64), (3, 65), (3, 66), (5, 130)].into_iter().enumerate()
    {
        let mut random = Random::new(seed as u64);
        let (drag, lift) = (random.within(0.5, 2.0), random.within(0.0, 2.0));
        let air = Air { wind_m_s: random.vector(3.0).into(), drag, lift, ..Air::default() };
        let mut c = loose(rows, columns, &airy(), &air);
        let crumpled: Vec<_> = positions(&c).iter().map(|p| p + random.vector(0.02)).collect();
        put(&mut c, &crumpled);
        stir(&mut c, &mut random, 2.0);
        let (x, v): (Vec<V>, Vec<V>) =
            (positions(&c).iter().map(|p| p.cast()).collect(), velocities(&c).iter().map(|p| p.cast()).collect());
        let (dt, w) = (f64::from(c.def().dt_s()), 1.0 / f64::from(c.particle_mass_kg()));
        let mut f = vec![V::zeros(); x.len()];
        let n = columns as usize;
        for row in 0..rows as usize - 1 {
            for column in 0..n - 1 {
                let i = row * n + column;
                let corners = [i, i + 1, i + n, i + n + 1];
                let a = 0.5 * (x[i + n + 1] - x[i]).cross(&(x[i + n] - x[i + 1]));
                let u = sum(corners.map(|i| v[i])) / 4.0 - Vector3::from(air.wind_m_s).cast::<f64>();
                let e = u.normalize();
                let n = a.normalize() * a.dot(&u).signum();
                let q = 0.5 * 1.2 * a.norm() * u.norm_squared() * n.dot(&e);
                let force = -q * (f64::from(drag) * e + f64::from(lift) * (n - n.dot(&e) * e));
                for i in corners {
                    f[i] += force / 4.0;
                }
            }
        }
        steps(&mut c, 1);
        let size = f.iter().map(|f| f.norm()).fold(0.0, f64::max);
        for (i, (v0, v1)) in v.iter().zip(velocities(&c)).enumerate() {
            let found = (v1.cast::<f64>() - v0) / (dt * w);
            assert!((found - f[i]).norm() < 1e-3 * size, "{rows} x {columns}, {i}: {found} instead of {}", f[i]);
        }
    }
}

/// Whatever the shape, speed, step and air, a substep of the air alone never raises the kinetic energy relative to it: the
/// theorem at the top of air.rs. Without its cuts, dense or fast air multiplies the energy within a few substeps. Every other
/// cloth has particles of 1 to 32 times the inertia, around a pin that rests in still air and so does no work.
#[test]
fn the_air_only_damps() {
    for seed in 0..400 {
        let mut r = Random::new(seed);
        let inertia = seed % 2 == 0;
        let wind = if inertia { Vector3::zeros() } else { r.vector(1.0).normalize() * r.log(0.1, 900.0) };
        let air = Air {
            wind_m_s: wind.into(),
            density_kg_m3: r.log(0.1, 5000.0),
            drag: [0.0, r.log(0.01, 50.0)][r.below(2)],
            lift: [0.0, r.log(0.01, 50.0)][r.below(2)],
            gust: r.unit(),
            gust_hz: r.log(0.1, 100.0),
            seed: seed as u32,
        };
        let def = ClothDef {
            rate_hz: r.log(30.0, 2000.0),
            density_kg_m2: r.log(0.02, 2.0),
            inertia_radius_m: if inertia { 0.3 } else { 0.0 },
            ..airy()
        };
        let mut c = loose(2 + r.below(7) as u32, 2 + r.below(9) as u32, &def, &air);
        if inertia {
            c.pin(0).unwrap();
        }
        let crumpled: Vec<_> = positions(&c).iter().map(|p| p + r.vector(0.1)).collect();
        put(&mut c, &crumpled);
        let speed = r.log(0.1, 500.0);
        stir(&mut c, &mut r, speed);
        for step in 0..20 {
            let wind = Vector3::from(air.wind_at(step, 1.0 / f64::from(def.rate_hz))).cast::<f64>();
            let energy = |c: &Cloth<'_>| match inertia {
                true => c.kinetic_energy_j(),
                false => velocities(c).iter().map(|v| (v.cast() - wind).norm_squared()).sum::<f64>(),
            };
            let before = energy(&c);
            steps(&mut c, 1);
            assert!(energy(&c) <= before * (1.0 + 1e-5), "seed {seed}, step {step}: {} after {before}", energy(&c));
        }
    }
}

/// What the air may take is counted as damping: with the share s (a power of two from 1/64 to 1/4) the springs keep
/// (4 - 2 c dt - 4 s) / (4 - 2 c dt) of what they had. A storm takes a quarter, still air little.
#[test]
fn the_budget_counts_the_air_as_damping() {
    let stiffness = |air: Option<Air>, damping_per_s: f32| {
        let features = if air.is_some() { Features::AIR } else { Features::NONE };
        let def = ClothDef { features, damping_per_s, ..ClothDef::default() };
        let mut c = cloth(&squares(8, 8, 0.03, Families::ALL), &def);
        c.set_stiffness_uniform([1e6, 1e6, 3e5, 1e3]).unwrap();
        if let Some(air) = air {
            c.set_air(&air).unwrap();
        }
        1.0 - f64::from(c.budget().unwrap().cut_fraction)
    };
    let storm = Air { wind_m_s: [200.0, 0.0, 0.0], ..Air::default() };
    // 1/2 1.2 (1.2 + 1.2) (10 m/s) / 0.2 = 72 1/s: 0.075 a substep, so 1/8
    for (air, share) in [(storm, 0.25), (Air::default(), 0.125), (Air { density_kg_m3: 0.0, ..storm }, 1.0 / 64.0)] {
        for damping in [0.0, 2.0, 400.0] {
            let free = 4.0 - 2.0 * f64::from(damping) / 960.0;
            // cut_fraction is an f32 near 1
            near(stiffness(Some(air), damping), stiffness(None, damping) * (1.0 - 4.0 * share / free), 1e-3, "springs");
        }
    }
}

/// A flag in a storm, silk to canvas, both budgets, gusts: five seconds at 50 m/s stay finite and the cloth is no faster than
/// the air drives it. The certified one has neither speed limit nor damping of its own.
#[test]
fn a_flag_stays_whole_at_50_metres_a_second() {
    for density_kg_m2 in [0.04, 0.2, 0.6] {
        for budget in [Budget::Certified, Budget::Tuned] {
            let bare = budget == Budget::Certified;
            let def = ClothDef {
                density_kg_m2,
                budget,
                damping_per_s: if bare { 0.0 } else { 2.0 },
                speed_limit: if bare { 0.0 } else { 0.25 },
                features: Features::AIR,
                ..ClothDef::default()
            };
            let mut c = cloth(&squares(17, 25, 0.04, Families::ALL), &def);
            c.set_stiffness_uniform([5000.0, 5000.0, 1500.0, 100.0]).unwrap();
            let air = Air { wind_m_s: [48.0, 0.0, 14.0], gust: 0.5, gust_hz: 3.0, seed: 4, ..Air::default() };
            c.set_air(&air).unwrap();
            for row in 0..17 {
                c.pin(row * 25).unwrap();
            }
            let mut fastest = 0.0f32;
            for _ in 0..300 {
                assert_eq!(c.step().unwrap().0, 0);
                fastest = velocities(&c).iter().map(|v| v.norm()).fold(fastest, f32::max);
            }
            // the gusts reach 50 (1 + 0.5 sqrt(3)) = 93 m/s; the free end of silk that is cut to soft springs whips faster
            assert!(fastest < 4.0 * 93.0, "{density_kg_m2} {budget:?}: {fastest} m/s");
        }
    }
}

/// Gusts are smooth, bounded, without a mean, and others with another seed: slope at most 15/8 of the way between two turns.
#[test]
fn gusts_are_smooth_and_bounded() {
    let air = Air { wind_m_s: [6.0, 0.0, 8.0], gust: 0.3, gust_hz: 2.0, seed: 77, ..Air::default() };
    let other = Air { seed: 78 | 1 << 20, ..air };
    let (dt, n) = (1.0 / 960.0, 960 * 300);
    let mut mean = V::zeros();
    let (mut least, mut most, mut differ) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3], 0);
    for i in 0..n {
        let (now, next) = (air.wind_at(i, dt), air.wind_at(i + 1, dt));
        for a in 0..3 {
            let gust = now[a] - air.wind_m_s[a];
            assert!(gust.abs() <= 3.0, "{gust}");
            let slope = (next[a] - now[a]).abs() / dt as f32;
            assert!(slope <= 2.0 * 2.0 * 3.0 * 15.0 / 8.0 * 1.01, "{slope} m/s^2");
            (least[a], most[a]) = (least[a].min(gust), most[a].max(gust));
        }
        mean += Vector3::from(now).cast::<f64>() / n as f64;
        differ += usize::from(other.wind_at(i, dt) != now);
    }
    assert!((mean - Vector3::from(air.wind_m_s).cast()).norm() < 0.3, "{mean}");
    assert!(least.iter().all(|g| *g < -2.5) && most.iter().all(|g| *g > 2.5), "{least:?} {most:?}");
    assert!(differ > n as usize * 9 / 10);
    // a long time on they still move
    let late = u64::MAX / 2;
    assert!((0..960).any(|i| air.wind_at(late + (i << 20), dt) != air.wind_at(late, dt)));
    assert_eq!(Air { gust: 0.0, ..air }.wind_at(12345, dt), air.wind_m_s);
}

fn flag() -> Cloth<'static> {
    let def = ClothDef { features: Features::AIR, substeps: 8, ..ClothDef::default() };
    let mut c = cloth(&squares(9, 13, 0.06, Families::ALL), &def);
    c.set_stiffness_uniform([800.0, 500.0, 100.0, 8.0]).unwrap();
    for row in 0..9 {
        c.pin(row * 13).unwrap();
    }
    c
}

/// Rolled back, the wind blows as it did: gusts depend on the step alone, and a snapshot holds the air. The other cloth never
/// heard of it.
#[test]
fn a_rolled_back_frame_has_the_gust_that_it_had() {
    let air = Air { wind_m_s: [9.0, 1.0, 3.0], gust: 0.6, gust_hz: 4.0, seed: 0xdead_beef, ..Air::default() };
    let mut c = flag();
    c.set_air(&air).unwrap();
    steps(&mut c, 40);
    let kept = snapshot(&mut c);
    steps(&mut c, 30);
    let (hash, after) = (c.state_hash(), bits(&c));
    c.restore(&kept).unwrap();
    steps(&mut c, 30);
    assert_eq!(c.state_hash(), hash);
    let mut other = flag();
    steps(&mut other, 7);
    other.restore(&kept).unwrap();
    assert_eq!(other.air().unwrap(), air);
    steps(&mut other, 30);
    assert_eq!((other.state_hash(), bits(&other)), (hash, after));
    // the air is part of the state
    other.set_air(&Air { seed: 1, ..air }).unwrap();
    assert_ne!(other.state_hash(), hash);
    other.reset();
    assert_eq!(other.air().unwrap(), Air::default());
}

/// Printed once on x86_64; every target must give it.
#[test]
fn a_flag_in_gusts_has_the_golden_bits() {
    let mut c = flag();
    c.set_air(&Air { wind_m_s: [7.0, 0.5, 2.0], gust: 0.4, gust_hz: 1.5, seed: 9, lift: 0.8, ..Air::default() })
        .unwrap();
    steps(&mut c, 120);
    assert_eq!(c.state_hash(), GOLDEN, "{:#x}", c.state_hash());
}

const GOLDEN: u64 = 0xb908_35f8_16b5_418c;

#[test]
fn bad_air_is_refused() {
    let air = Air::default();
    let mut c = flag();
    let mut err = |air: Air| c.set_air(&air).unwrap_err();
    assert_eq!(err(Air { wind_m_s: [0.0, f32::NAN, 0.0], ..air }), Error::NotFinite);
    assert_eq!(err(Air { gust_hz: f32::INFINITY, ..air }), Error::NotFinite);
    assert_eq!(err(Air { density_kg_m3: -1.0, ..air }), Error::Negative);
    assert_eq!(err(Air { drag: -0.1, ..air }), Error::Negative);
    assert_eq!(err(Air { lift: -0.1, ..air }), Error::Negative);
    assert_eq!(err(Air { gust: -0.1, ..air }), Error::Negative);
    assert_eq!(err(Air { wind_m_s: [800.0, 800.0, 0.0], ..air }), Error::OutOfRange);
    assert_eq!(err(Air { density_kg_m3: 1.1e4, ..air }), Error::OutOfRange);
    assert_eq!(err(Air { drag: 101.0, ..air }), Error::OutOfRange);
    assert_eq!(err(Air { lift: 101.0, ..air }), Error::OutOfRange);
    assert_eq!(err(Air { gust: 1.5, ..air }), Error::OutOfRange);
    assert_eq!(err(Air { gust_hz: 2e3, ..air }), Error::OutOfRange);
    assert_eq!(c.air().unwrap(), air);
    let mut without = cloth(&squares(3, 3, 0.1, Families::ALL), &ClothDef::default());
    assert_eq!(without.set_air(&air).unwrap_err(), Error::FeatureOff);
    assert_eq!(without.air().unwrap_err(), Error::FeatureOff);
}

/// What is off has no memory; air and hinges share three planes of forces.
#[test]
fn air_costs_three_planes_of_memory() {
    let grid = squares(10, 20, 0.1, Families::ALL);
    let numbers = |features| Cloth::memory(&grid, &ClothDef { features, ..ClothDef::default() }).unwrap();
    let plane = (32 + 16) * (10 + 4) + 32;
    let both = Features(Features::AIR.0 | Features::HINGE.0);
    for features in [Features::AIR, Features::HINGE, both] {
        assert_eq!(numbers(features) - numbers(Features::NONE), 3 * plane);
    }
}
