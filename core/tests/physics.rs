//! The cloth against closed forms: what the discrete scheme (eq. 17) must give exactly, and what the continuum says.

mod common;

use common::{Random, bare, cloth, grid, near, positions, put, squares, steps, stir, velocities};
use taut::field::FieldView;
use taut::{Budget, Cloth, ClothDef, Families, Features, Vector3};

fn sum(all: impl IntoIterator<Item = Vector3<f32>>) -> Vector3<f64> {
    all.into_iter().map(|p| p.cast::<f64>()).sum()
}

/// x_n = g dt^2 n (n + 1) / 2: the sum of symplectic Euler. Explicit Euler has n - 1, which is off by 0.2 % here.
#[test]
fn free_fall_is_the_discrete_one() {
    let def = ClothDef { gravity_m_s2: [1.0, -9.81, 0.5], substeps: 16, rate_hz: 60.0, ..bare() };
    let mut c = cloth(&grid(6, 9, 0.8, 0.3, Families::ALL), &def);
    c.set_stiffness_uniform([300.0, 200.0, 50.0, 4.0]).unwrap();
    let flat = positions(&c);
    let start = sum(positions(&c)) / 54.0;
    steps(&mut c, 60);
    let fallen = sum(positions(&c)) / 54.0 - start;
    // every spring has its rest length in the flat sheet, so it stays flat (cells are oblong: a swapped length shows)
    for (from, to) in flat.iter().zip(positions(&c)) {
        assert!((to.cast::<f64>() - from.cast() - fallen).norm() < 2e-5, "{from} to {to}");
    }
    let dt = f64::from(def.dt_s());
    let n = 960.0;
    for a in 0..3 {
        let g = f64::from(def.gravity_m_s2[a]);
        near(fallen[a], g * dt * dt * n * (n + 1.0) / 2.0, 2e-5, "free fall");
    }
    let v = c.velocity(7).unwrap();
    near(f64::from(v.y), -9.81 * n * dt, 2e-4, "speed");
}

/// F_damping = -c M v: v_n = v_0 (1 - c dt)^n, which is e^(-c t) to first order in dt; with gravity the speed ends at g / c.
#[test]
fn damping_is_exponential() {
    for inertia_radius_m in [0.0, 0.4] {
        let def = ClothDef { damping_per_s: 3.0, substeps: 16, rate_hz: 60.0, inertia_radius_m, ..bare() };
        let mut c = cloth(&squares(5, 5, 0.1, Families::ALL), &def);
        c.set_stiffness_uniform([0.0; 4]).unwrap();
        c.pin(0).unwrap();
        let v0 = Vector3::new(2.0, -1.0, 0.5);
        for i in 0..25 {
            c.set_velocity(i, v0).unwrap();
        }
        steps(&mut c, 30);
        let dt = f64::from(def.dt_s());
        for i in [1, 12, 24] {
            let share = f64::from(c.velocity(i).unwrap().norm() / v0.norm());
            near(share, (1.0 - 3.0 * dt).powi(480), 1e-4, "discrete damping");
            near(share, (-1.5f64).exp(), 3e-3, "damping");
        }
    }
    let def = ClothDef { damping_per_s: 5.0, gravity_m_s2: [0.0, 0.0, -9.81], ..bare() };
    let mut c = cloth(&squares(4, 4, 0.1, Families::ALL), &def);
    c.set_stiffness_uniform([100.0; 4]).unwrap();
    steps(&mut c, 960 * 4);
    near(f64::from(c.velocity(5).unwrap().z), -9.81 / 5.0, 1e-4, "terminal speed");
}

/// Two particles hang side by side on a warp spring each: a linear oscillator of omega^2 = k / m. Returns its period in s
/// at the step of `def` from the zero crossings.
fn period(def: &ClothDef, k: f32) -> f64 {
    let mut c = cloth(&squares(2, 2, 1.0, Families::STRUCTURAL), def);
    c.set_stiffness_uniform([k, 0.0, 0.0, 0.0]).unwrap();
    assert_eq!(c.budget().unwrap().cut_fraction, 0.0);
    c.pin(0).unwrap();
    c.pin(1).unwrap();
    for p in [2, 3] {
        let at = c.position(p).unwrap();
        c.set_position(p, at + Vector3::new(0.0, -0.2, 0.0)).unwrap();
    }
    let dt = f64::from(def.dt_s());
    let (mut last, mut crossings, mut t) = (1.0, Vec::new(), 0.0);
    while crossings.len() < 201 {
        steps(&mut c, 1);
        let x = -1.0 - f64::from(c.position(3).unwrap().y);
        if last < 0.0 && x >= 0.0 {
            crossings.push(t + dt * last / (last - x));
        }
        (last, t) = (x, t + dt);
        assert!(t < 1e4, "no oscillation");
    }
    (crossings[200] - crossings[0]) / 200.0
}

/// cos(omega_discrete dt) = 1 - (omega dt)^2 / 2, so the period's error is of second order in dt.
#[test]
fn the_period_of_a_spring_is_right_to_second_order() {
    let mut errors = Vec::new();
    for rate_hz in [40.0, 80.0] {
        let def = ClothDef { rate_hz, ..bare() };
        let (k, m, dt) = (20.0, 0.05, 1.0 / f64::from(rate_hz)); // density 0.2 x 1 m^2 / 4
        let omega = f64::sqrt(k / m);
        let t = period(&def, k as f32);
        let discrete = std::f64::consts::PI * dt / (omega * dt / 2.0).asin();
        near(t, discrete, 5e-5, "discrete period");
        errors.push(1.0 - t * omega / std::f64::consts::TAU);
    }
    // leading term (omega dt)^2 / 24
    near(errors[1], 0.0625 / 24.0, 0.05, "error of the period");
    near(errors[0] / errors[1], 4.0, 0.05, "order of the period's error");
}

/// Lets a cloth come to rest.
fn settle(c: &mut Cloth<'_>, frames: usize) {
    steps(c, frames);
    let v = velocities(c).iter().fold(0.0f32, |a, v| a.max(v.norm()));
    assert!(v < 1e-3, "still moving with {v} m/s");
}

/// A sheet of parallel warps: the spring below row i carries the rows under it, so the top strain is (R - 1) m g / (k L0)
/// and the elongation the sum; in the continuum rho g H / (E h) and rho g H^2 / (2 E h). Catches a wrong mass per
/// particle, a spring constant that counts twice, weft in the place of warp.
#[test]
fn a_hanging_sheet_stretches_under_its_own_weight() {
    for inertia_radius_m in [0.0, 0.2] {
        let (rows, columns) = (21u32, 5u32);
        let (width, height, k) = (0.2, 1.0, 60.0f32);
        let def = ClothDef {
            substeps: 16,
            rate_hz: 60.0,
            gravity_m_s2: [0.0, -9.81, 0.0],
            damping_per_s: 6.0,
            inertia_radius_m,
            ..bare()
        };
        let mut c = cloth(&grid(rows, columns, width, height, Families::STRUCTURAL), &def);
        c.set_stiffness_uniform([k, 7.0, 0.0, 0.0]).unwrap();
        assert_eq!(c.budget().unwrap().cut_fraction, 0.0);
        for p in 0..columns as usize {
            c.pin(p).unwrap();
        }
        settle(&mut c, 600);
        let (m, l0) = (f64::from(c.particle_mass_kg()), 1.0 / 20.0);
        let y = |row: usize| f64::from(c.position(row * 5 + 2).unwrap().y);
        for row in 0..20 {
            let strain = (y(row) - y(row + 1)) / l0 - 1.0;
            let carried = (20 - row) as f64 * m * 9.81;
            let expected = carried / (f64::from(k) * l0);
            // positions are known to 6e-8 m
            assert!((strain - expected).abs() < 1e-3 * expected + 5e-6, "row {row}: {strain} instead of {expected}");
        }
        let top = (y(0) - y(1)) / l0 - 1.0;
        let elongation = y(0) - y(20) - 1.0;
        near(elongation, m * 9.81 * 20.0 * 21.0 / (2.0 * f64::from(k)), 1e-3, "elongation");
        // E h = k L0 n / W; the discrete sheet differs by 1/R
        let (eh, rho) = (f64::from(k) * l0 * 5.0 / 0.2, 0.2);
        near(top, rho * 9.81 * 1.0 / eh, 0.06, "rho g H / (E h)");
        near(elongation, rho * 9.81 / (2.0 * eh), 0.01, "rho g H^2 / (2 E h)");
    }
}

/// The rest shape is that of the springs: neither the step nor the frame rate is in it.
#[test]
fn the_rest_shape_does_not_depend_on_the_step() {
    let shapes: Vec<_> = [(60.0, 10), (60.0, 20), (200.0, 4)]
        .into_iter()
        .map(|(rate_hz, substeps)| {
            let def = ClothDef { rate_hz, substeps, damping_per_s: 6.0, gravity_m_s2: [0.0, -9.81, 0.0], ..bare() };
            let mut c = cloth(&squares(9, 9, 0.05, Families::ALL), &def);
            c.set_stiffness_uniform([60.0, 60.0, 20.0, 1.0]).unwrap();
            assert_eq!(c.budget().unwrap().cut_fraction, 0.0);
            c.pin(0).unwrap();
            c.pin(8).unwrap();
            settle(&mut c, rate_hz as usize * 8);
            positions(&c)
        })
        .collect();
    for other in &shapes[1..] {
        for (a, b) in shapes[0].iter().zip(other) {
            assert!((a - b).norm() < 2e-4, "{a} and {b}");
        }
    }
}

/// Forces in N on the particles of a sheet in a shape: what one substep does to the velocities.
fn forces(c: &mut Cloth<'_>, shape: &[Vector3<f32>]) -> Vec<Vector3<f64>> {
    put(c, shape);
    steps(c, 1);
    let m_dt = f64::from(c.particle_mass_kg()) / f64::from(c.def().dt_s());
    velocities(c).iter().map(|v| v.cast() * m_dt).collect()
}

/// The stiffness of a square lattice: C11 = k_weft + k_d + 4 k_b, C22 = k_warp + k_d + 4 k_b, C12 = C66 = k_d, all per
/// metre of width. A finite sheet has one row of structural and bend springs more than rows of cells, which is counted.
#[test]
fn the_moduli_of_the_lattice_are_those_of_its_springs() {
    let (m, n, cell) = (7usize, 9usize, 0.1f32);
    let (warp, weft, shear, bend) = (400.0, 250.0, 120.0, 5.0);
    let def = ClothDef { rate_hz: 9600.0, ..bare() };
    let mut c = cloth(&squares(7, 9, cell, Families::ALL), &def);
    c.set_stiffness_uniform([warp, weft, shear, bend]).unwrap();
    assert_eq!(c.budget().unwrap().cut_fraction, 0.0);
    let flat = positions(&c);
    let (k_v, k_u, k_d, k_b) = (f64::from(warp), f64::from(weft), f64::from(shear), f64::from(bend));
    let (rows, columns) = (m as f64, n as f64);
    let e = 1e-3f32;
    // linear part of the force on some particles under a gradient of displacement (x' = x + e (a x, b y))
    let mut linear = |gradient: [[f32; 2]; 2], of: &dyn Fn(usize, usize) -> bool| -> Vector3<f64> {
        let mut at = |e: f32| -> Vector3<f64> {
            let shape: Vec<_> = flat
                .iter()
                .map(|p| {
                    let d = |g: [f32; 2]| e * (g[0] * p.x + g[1] * p.y);
                    p + Vector3::new(d(gradient[0]), d(gradient[1]), 0.0)
                })
                .collect();
            let f = forces(&mut c, &shape);
            (0..m * n).filter(|i| of(i / n, i % n)).map(|i| f[i]).sum::<Vector3<f64>>()
        };
        (at(e) - at(-e)) / (2.0 * f64::from(e) * f64::from(cell))
    };
    let right = |_: usize, column: usize| column >= n - 2;
    let bottom = |row: usize, _: usize| row >= m - 2;
    let tolerance = 1e-3;

    // stretched along u: the pull on the right end per strain, and the push along v on the bottom
    let along_u = [[1.0, 0.0], [0.0, 0.0]];
    let c11 = -linear(along_u, &right).x;
    near(c11, rows * (k_u + 4.0 * k_b) + (rows - 1.0) * k_d, tolerance, "C11");
    let c12 = linear(along_u, &bottom).y;
    near(c12, (columns - 1.0) * k_d, tolerance, "C12");
    // along v (y is down from row 0, so the bottom is pulled up)
    let along_v = [[0.0, 0.0], [0.0, 1.0]];
    let c22 = linear(along_v, &bottom).y;
    near(c22, columns * (k_v + 4.0 * k_b) + (columns - 1.0) * k_d, tolerance, "C22");
    // sheared
    let c66 = linear([[0.0, 1.0], [0.0, 0.0]], &bottom).x;
    near(c66, (columns - 1.0) * k_d, tolerance, "C66");
    // inside, a uniform strain pulls nowhere
    let inside = linear(along_u, &|row, column| (row, column) == (3, 4));
    assert!(inside.norm() < 1e-3 * k_u, "{inside}");
}

/// k_s = 3/4 E h, k_d = 3/8 E h: pulled along u, a strip stretches by T / (E h) and shrinks across by a third of that.
#[test]
fn a_pulled_strip_shows_its_modulus_and_poisson_ratio() {
    let (m, n, cell, eh) = (5usize, 33usize, 0.05f32, 400.0f32);
    let def = ClothDef { damping_per_s: 8.0, substeps: 16, rate_hz: 100.0, features: Features::PULL, ..bare() };
    let mut c = cloth(&squares(5, 33, cell, Families(3)), &def);
    c.set_stiffness_uniform([0.75 * eh, 0.75 * eh, 0.375 * eh, 0.0]).unwrap();
    assert_eq!(c.budget().unwrap().cut_fraction, 0.0);
    let each = 0.15f32;
    for _ in 0..600 {
        for row in 0..m {
            let f = Vector3::new(each, 0.0, 0.0);
            c.add_force(row * n + n - 1, f).unwrap();
            c.add_force(row * n, -f).unwrap();
        }
        steps(&mut c, 1);
    }
    let at = |row: usize, column: usize| c.position(row * n + column).unwrap().cast::<f64>();
    let l = f64::from(cell);
    let along = (at(2, 24).x - at(2, 8).x) / (16.0 * l) - 1.0;
    let across = (at(0, 16) - at(4, 16)).norm() / (4.0 * l) - 1.0;
    near(-across / along, 1.0 / 3.0, 0.02, "Poisson ratio");
    // with the free edge's whole springs: T = e [m k_s + (m - 1) k_d] - (e / 3) (m - 1) k_d, all times the cell
    let (k_s, k_d) = (0.75 * f64::from(eh), 0.375 * f64::from(eh));
    let stiffness = 5.0 * k_s + 4.0 * k_d * (2.0 / 3.0);
    near(along, 5.0 * f64::from(each) / (stiffness * l), 0.02, "strain");
}

/// A free cloth without outer forces: sum of m v and sum of x cross m v are kept to rounding over 60 frames, whatever the
/// springs, crumpled and stretched. Catches a spring that acts on one end only, or with another length on the other.
#[test]
fn momentum_and_angular_momentum_are_kept() {
    for seed in 0..8u64 {
        let mut r = Random::new(seed);
        let def = ClothDef {
            substeps: 8,
            rate_hz: 60.0,
            budget: Budget::Certified,
            compression_limit: seed % 2 == 0,
            ..bare()
        };
        let mut c = cloth(&grid(10, 13, 1.2, 0.7, Families([1, 3, 5, 7][seed as usize % 4])), &def);
        let field: Vec<f32> = (0..4 * 130).map(|_| r.log(1.0, 60.0)).collect();
        c.set_stiffness_field(&FieldView::new(4, 10, 13, &field).unwrap());
        let from: Vec<_> = positions(&c).iter().map(|p| p * 1.05 + r.vector(0.01)).collect();
        put(&mut c, &from);
        stir(&mut c, &mut r, 0.5);
        let moments = |c: &Cloth<'_>| {
            let (x, v) = (positions(c), velocities(c));
            let spin: Vector3<f64> = x.iter().zip(&v).map(|(x, v)| x.cast::<f64>().cross(&v.cast())).sum();
            let speed: f64 = v.iter().map(|v| f64::from(v.norm())).sum();
            (sum(v), spin, speed)
        };
        let (p0, l0, speed) = moments(&c);
        let moved = positions(&c);
        steps(&mut c, 60);
        let (p, l, _) = moments(&c);
        assert!((p - p0).norm() < 1e-5 * speed, "{p0} became {p}");
        assert!((l - l0).norm() < 2e-5 * speed, "{l0} became {l}");
        assert!((positions(&c)[5] - moved[5]).norm() > 0.01);
    }
}

/// A pull of F on a free sheet accelerates its centre by F / (sum of m) for one frame and no longer.
#[test]
fn a_pull_acts_for_one_frame() {
    let def = ClothDef { features: Features::PULL, substeps: 4, rate_hz: 100.0, ..bare() };
    let mut c = cloth(&squares(4, 5, 0.1, Families::ALL), &def);
    c.set_stiffness_uniform([50.0, 50.0, 20.0, 1.0]).unwrap();
    let f = Vector3::new(0.3f32, -0.1, 0.2);
    c.add_force(7, f).unwrap();
    c.add_force(7, f).unwrap();
    c.add_force(12, -f).unwrap();
    for _ in 0..3 {
        steps(&mut c, 1);
        let p = sum(velocities(&c)) * f64::from(c.particle_mass_kg());
        for a in 0..3 {
            near(p[a], f64::from(f[a]) * 0.01, 1e-4, "impulse");
        }
    }
}

/// The speed limit: a fraction of the smallest rest length per substep; the compression limit: a force of at most k l.
#[test]
fn the_clamps_limit_what_they_say() {
    let def = ClothDef { speed_limit: 0.25, gravity_m_s2: [0.0, -1e4, 0.0], ..bare() };
    let mut c = cloth(&grid(4, 4, 0.6, 0.3, Families::ALL), &def);
    c.set_stiffness_uniform([50.0; 4]).unwrap();
    steps(&mut c, 20);
    let limit = 0.25 * 0.1 * 960.0;
    near(f64::from(c.velocity(3).unwrap().norm()), limit, 1e-5, "speed");

    // one warp spring pressed to a tenth: 1 - L0/l = -9 without the limit, -1 with it
    for (compression_limit, factor) in [(false, -9.0), (true, -1.0)] {
        let def = ClothDef { compression_limit, ..bare() };
        let mut c = cloth(&squares(2, 2, 1.0, Families::STRUCTURAL), &def);
        c.set_stiffness_uniform([30.0, 0.0, 0.0, 0.0]).unwrap();
        let mut shape = positions(&c);
        shape[2].y = -0.1;
        let f = forces(&mut c, &shape);
        near(f[2].y, 30.0 * factor * 0.1, 1e-4, "push");
        near(f[0].y, -30.0 * factor * 0.1, 1e-4, "push back");
    }
}
