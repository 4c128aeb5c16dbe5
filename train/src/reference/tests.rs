//! Closed forms, finite differences, conservation.

use super::membrane::Triangle;
use super::vector::{add, dot, length, scale, sub};
use super::{Bending, Cloth, Material, Membrane, Sheet, Solid, Surroundings, V3};

const NOTHING: Surroundings = Surroundings {
    gravity_m_s2: [0.0; 3],
    air_kg_m3: 0.0,
    drag_kg_m2_s: 0.0,
    solid: None,
    thickness_m: 0.0,
    friction: 0.0,
};

fn material(stiffness: [f64; 4], rigidity_n_m: f64) -> Material {
    Material { density_kg_m2: 0.2, membrane: Membrane::constant(stiffness), bending: Bending::constant(rigidity_n_m) }
}

/// Upright: u along x, v along y.
fn upright(sheet: &Sheet) -> Vec<V3> {
    sheet.uv.iter().map(|[u, v]| [*u, *v, 0.0]).collect()
}

/// A shape without any symmetry.
fn crumpled(sheet: &Sheet) -> Vec<V3> {
    let wave = |a: f64, b: f64, [u, v]: [f64; 2]| 0.05 * (a * u + b * v + 1.0).sin();
    sheet
        .uv
        .iter()
        .map(|p| [p[0] + wave(5.0, 3.0, *p), 1.1 * p[1] + wave(-2.0, 7.0, *p), 3.0 * wave(9.0, 4.0, *p)])
        .collect()
}

#[test]
fn forces_are_the_slope_of_the_energy() {
    let sheet = Sheet::rectangle(4, 5, 0.8, 0.7).unwrap();
    // membrane alone, bending alone, both
    for (k, d) in [([300.0, 40.0, 500.0, 80.0], 0.0), ([0.0; 4], 0.02), ([300.0, 40.0, 500.0, 80.0], 0.02)] {
        let mut cloth = Cloth::new(&sheet, material(k, d), NOTHING, crumpled(&sheet), &[]).unwrap();
        let forces = cloth.elastic_forces_n();
        let scale = forces.iter().map(|f| length(*f)).fold(0.0, f64::max);
        for i in 0..sheet.uv.len() {
            let x = cloth.positions()[i];
            for axis in 0..3 {
                let mut at = |way: f64| {
                    let mut moved = x;
                    moved[axis] += way;
                    cloth.set_position(i, moved);
                    cloth.energy_j()
                };
                let h = 1e-6;
                let slope = (at(h) - at(-h)) / (2.0 * h);
                cloth.set_position(i, x);
                assert!((forces[i][axis] + slope).abs() < 1e-6 * scale, "{i} {axis}: {} {slope}", forces[i][axis]);
            }
        }
    }
}

#[test]
fn the_membranes_hessian_is_the_slope_of_its_forces() {
    let sheet = Sheet::rectangle(2, 2, 0.3, 0.2).unwrap();
    let membrane = Membrane::constant([300.0, 40.0, 500.0, 80.0]);
    let x = crumpled(&sheet);
    let t = Triangle::new(&sheet, sheet.triangles[0]);
    let mut whole = [[[[0.0; 3]; 3]; 3]; 3];
    t.hessian(&t.at(&x, &membrane), false, |i, j, block| {
        whole[i][j] = block;
        whole[j][i] = std::array::from_fn(|r| std::array::from_fn(|c| block[c][r]));
    });
    for j in 0..3 {
        for c in 0..3 {
            let forces = |way: f64| {
                let mut x = x.clone();
                x[t.nodes[j]][c] += way;
                t.forces(&t.at(&x, &membrane))
            };
            let (up, down) = (forces(1e-6), forces(-1e-6));
            for i in 0..3 {
                for r in 0..3 {
                    let slope = -(up[i][r] - down[i][r]) / 2e-6;
                    assert!((whole[i][j][r][c] - slope).abs() < 1e-5, "{i}{j}{r}{c}: {} {slope}", whole[i][j][r][c]);
                }
            }
        }
    }
    // its convex part pulls nowhere less than it does, and never backwards
    t.hessian(&t.at(&x, &membrane), true, |i, j, block| {
        if i == j {
            for (r, row) in block.iter().enumerate() {
                assert!(row[r] >= whole[i][i][r][r] - 1e-9 && row[r] >= 0.0);
            }
        }
    });
}

/// The elastic force on the line of vertices u = width or v = height of a sheet that is deformed evenly.
fn pull(stiffness: [f64; 4], shape: impl Fn([f64; 2]) -> V3, side: usize) -> V3 {
    let sheet = Sheet::rectangle(6, 5, 0.4, 0.5).unwrap();
    let x = sheet.uv.iter().map(|p| shape(*p)).collect();
    let cloth = Cloth::new(&sheet, material(stiffness, 1e-5), NOTHING, x, &[]).unwrap();
    let far = if side == 0 { 0.4 } else { 0.5 };
    let forces = cloth.elastic_forces_n();
    let inner = sheet.uv.iter().zip(&forces).filter(|([u, v], _)| *u > 0.0 && *u < 0.4 && *v > 0.0 && *v < 0.5);
    inner.for_each(|(_, f)| assert!(length(*f) < 1e-9, "an even strain leaves no force within"));
    let edge = sheet.uv.iter().zip(forces).filter(|(p, _)| (p[side] - far).abs() < 1e-9);
    edge.fold([0.0; 3], |sum, (_, f)| add(sum, f))
}

#[test]
fn tension_and_shear_have_their_closed_forms() {
    let [uu, uv, vv, shear] = [300.0, 40.0, 500.0, 80.0];
    let k = [uu, uv, vv, shear];
    let green = |s: f64| 0.5 * ((1.0 + s).powi(2) - 1.0);
    for s in [-0.05, 0.01, 0.2] {
        // stretched along u, held along v: k E (1 + s) per width
        let f = pull(k, |[u, v]| [(1.0 + s) * u, v, 0.0], 0);
        assert!((f[0] + uu * green(s) * (1.0 + s) * 0.5).abs() < 1e-9 && f[1].abs() < 1e-9, "{f:?}");
        // and what holds it
        let f = pull(k, |[u, v]| [(1.0 + s) * u, v, 0.0], 1);
        assert!((f[1] + uv * green(s) * 0.4).abs() < 1e-9 && f[0].abs() < 1e-9, "{f:?}");
        let f = pull(k, |[u, v]| [u, (1.0 + s) * v, 0.0], 1);
        assert!((f[1] + vv * green(s) * (1.0 + s) * 0.4).abs() < 1e-9, "{f:?}");
    }
    // sheared by g: E = (0, g^2/2, g/2), F S = ((g Suv, ..), ..); the line v = height is pulled along x by Suv + g Svv
    for g in [0.001, 0.1] {
        let f = pull(k, |[u, v]| [u + g * v, v, 0.0], 1);
        let (svv, suv) = (0.5 * vv * g * g, 0.5 * shear * g);
        let suu_v = 0.5 * uv * g * g;
        assert!((f[0] + 0.4 * (suv + g * svv)).abs() < 1e-9 && (f[1] + 0.4 * svv).abs() < 1e-9, "{f:?}");
        let f = pull(k, |[u, v]| [u + g * v, v, 0.0], 0);
        assert!((f[0] + 0.5 * (suu_v + g * suv)).abs() < 1e-9 && (f[1] + 0.5 * suv).abs() < 1e-9, "{f:?}");
    }
    // turned without strain
    let f = pull(k, |[u, v]| [0.6 * u - 0.8 * v, 0.0, 0.8 * u + 0.6 * v], 0);
    assert!(length(f) < 1e-9);
}

#[test]
fn a_hanging_sheet_stretches_by_its_own_weight() {
    let (rows, columns, h) = (21, 5, 1.0);
    let sheet = Sheet::rectangle(rows, columns, 0.2, h).unwrap();
    let (vv, g) = (2000.0, 9.8);
    let pins: Vec<usize> = ((rows - 1) * columns..rows * columns).collect();
    let around = Surroundings { gravity_m_s2: [0.0, -g, 0.0], ..NOTHING };
    let mut cloth =
        Cloth::new(&sheet, material([2000.0, 0.0, vv, 900.0], 1e-5), around, upright(&sheet), &pins).unwrap();
    let steps = cloth.settle(1e-9, 300).unwrap();
    assert!(steps < 300);
    // rho g H^2/(2 E h), and rho g H/(E h) at the top, to the first order in the strain (0.1 %)
    let load = 0.2 * g / vv;
    let x = cloth.positions();
    let longer = x[(rows - 1) * columns][1] - x[2][1] - h;
    assert!((longer / (0.5 * load * h * h) - 1.0).abs() < 2e-3, "{longer}");
    let cell = h / (rows - 1) as f64;
    let top = (x[(rows - 1) * columns + 2][1] - x[(rows - 2) * columns + 2][1]) / cell - 1.0;
    assert!((top / (load * (h - 0.5 * cell)) - 1.0).abs() < 1e-2, "{top}");
    // without Poisson's effect it keeps its width: halfway up, a ratio of 0.3 would take 3e-5 m
    let middle = rows / 2 * columns;
    assert!((x[middle + 4][0] - x[middle][0] - 0.2).abs() < 2e-6, "{}", x[middle + 4][0] - x[middle][0] - 0.2);
}

/// Deflection of the end of a level strip, clamped at u = 0, and its closed form; `load` = rho g L^3/B.
fn cantilever(load: f64, along_u: bool) -> f64 {
    let (n, m, l) = (33, 9, 0.2);
    let cell = l / (n as f64 - 0.5);
    let w = (m - 1) as f64 * cell;
    // the first hinge bends half a cell on either side of it: there the clamp is
    let long = l + 0.5 * cell;
    let at = |[u, v]: [f64; 2]| if along_u { [u, v] } else { [v, u] };
    let sheet =
        if along_u { Sheet::rectangle(m, n + 1, long, w) } else { Sheet::rectangle(n + 1, m, w, long) }.unwrap();
    let rigidity = 2e-5;
    let g = load * rigidity / (0.2 * l.powi(3));
    let around = Surroundings { gravity_m_s2: [0.0, -g, 0.0], ..NOTHING };
    let x = sheet
        .uv
        .iter()
        .map(|p| {
            let [s, t] = at(*p);
            [s, 0.0, t]
        })
        .collect();
    let pins: Vec<usize> = (0..sheet.uv.len()).filter(|i| at(sheet.uv[*i])[0] < 1.5 * cell).collect();
    let mut cloth = Cloth::new(&sheet, material([5000.0, 0.0, 5000.0, 2000.0], rigidity), around, x, &pins).unwrap();
    cloth.settle(1e-4, 400).unwrap();
    let end = (0..sheet.uv.len()).filter(|i| at(sheet.uv[*i])[0] > long - 1e-9);
    let ends: Vec<f64> = end.map(|i| -cloth.positions()[i][1] / l).collect();
    ends.iter().sum::<f64>() / ends.len() as f64
}

/// The elastica under its own weight: theta'' = -load (1 - s) cos(theta), clamped at s = 0, free at s = 1; the fall of its
/// end over its length. Shooting by bisection, Runge-Kutta.
fn elastica(load: f64) -> f64 {
    let shoot = |slope: f64| {
        let n = 400;
        let h = 1.0 / n as f64;
        let (mut y, mut fall) = ([0.0, slope], 0.0);
        let rate = |s: f64, y: [f64; 2]| [y[1], -load * (1.0 - s) * y[0].cos()];
        for i in 0..n {
            let s = i as f64 * h;
            let k1 = rate(s, y);
            let go = |k: [f64; 2], by: f64| [y[0] + by * k[0], y[1] + by * k[1]];
            let k2 = rate(s + 0.5 * h, go(k1, 0.5 * h));
            let k3 = rate(s + 0.5 * h, go(k2, 0.5 * h));
            let k4 = rate(s + h, go(k3, h));
            let before = y[0];
            y = std::array::from_fn(|c| y[c] + h / 6.0 * (k1[c] + 2.0 * k2[c] + 2.0 * k3[c] + k4[c]));
            fall += 0.5 * h * (before.sin() + y[0].sin());
        }
        (y[1], fall)
    };
    let (mut low, mut high) = (0.0, load);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        *(if shoot(middle).0 > 0.0 { &mut high } else { &mut low }) = middle;
    }
    shoot(low).1
}

#[test]
fn a_cantilever_bends_as_a_beam() {
    // the closed form itself: load / 8 where it bends little
    assert!((elastica(0.01) / (0.01 / 8.0) - 1.0).abs() < 1e-3);
    for along_u in [true, false] {
        for load in [0.05, 3.0] {
            let (mine, beam) = (cantilever(load, along_u), elastica(load));
            assert!((mine / beam - 1.0).abs() < 0.02, "{load}: {mine} {beam}");
        }
    }
}

#[test]
fn a_free_cloth_falls_as_a_stone_and_keeps_its_momentum() {
    let sheet = Sheet::rectangle(6, 6, 0.5, 0.5).unwrap();
    let around = Surroundings { gravity_m_s2: [0.0, -9.8, 0.0], ..NOTHING };
    let mut cloth =
        Cloth::new(&sheet, material([300.0, 40.0, 500.0, 80.0], 1e-4), around, crumpled(&sheet), &[]).unwrap();
    let mean = |cloth: &Cloth, of: &[V3]| {
        let all: f64 = cloth.masses_kg().iter().sum();
        scale(1.0 / all, of.iter().zip(cloth.masses_kg()).fold([0.0; 3], |sum, (x, m)| add(sum, scale(*m, *x))))
    };
    let start = mean(&cloth, cloth.positions());
    let (dt, n) = (1.0 / 240.0, 60);
    for _ in 0..n {
        cloth.step(dt).unwrap();
    }
    let (way, v) = (sub(mean(&cloth, cloth.positions()), start), mean(&cloth, cloth.velocities()));
    // implicit Euler: n (n + 1) dt^2 g / 2
    let fall = 0.5 * 9.8 * dt * dt * f64::from(n * (n + 1));
    assert!((way[1] + fall).abs() < 1e-9 && way[0].abs() < 1e-9 && way[2].abs() < 1e-9, "{way:?}");
    assert!((v[1] + 9.8 * dt * f64::from(n)).abs() < 1e-9 && v[0].abs() < 1e-9, "{v:?}");
    assert!(cloth.rms_speed_m_s() > 2.0);
}

#[test]
fn in_air_a_level_sheet_falls_at_its_final_speed() {
    let sheet = Sheet::rectangle(5, 5, 0.5, 0.5).unwrap();
    let around = Surroundings { gravity_m_s2: [0.0, -9.8, 0.0], air_kg_m3: 1.0, ..NOTHING };
    let x = sheet.uv.iter().map(|[u, v]| [*u, 0.0, *v]).collect();
    let mut cloth = Cloth::new(&sheet, material([900.0, 0.0, 900.0, 400.0], 1e-2), around, x, &[]).unwrap();
    let dt = 1.0 / 240.0;
    for _ in 0..480 {
        cloth.step(dt).unwrap();
    }
    // rho g = rho_air v^2; on the way v = v_end tanh(g t / v_end)
    let end = (0.2f64 * 9.8).sqrt();
    let v = cloth.velocities()[12][1];
    assert!((v / -end - 1.0).abs() < 1e-3, "{v} {end}");
}

#[test]
fn a_sheet_rests_on_a_ball_or_slides_from_it() {
    let sheet = Sheet::rectangle(5, 5, 0.02, 0.02).unwrap();
    // small against the ball, 20 degrees from its top: friction 0.5 holds (tan 20 = 0.36), 0.2 does not
    let ball = Solid::Sphere { middle_m: [0.0; 3], radius_m: 10.0 };
    let (s, c) = 20f64.to_radians().sin_cos();
    let x: Vec<V3> = (sheet.uv.iter())
        .map(|[u, v]| {
            let at = [u - 0.01, 10.0, v - 0.01];
            [c * at[0] + s * at[1], -s * at[0] + c * at[1], at[2]]
        })
        .collect();
    // the way down in the first and in the second half
    let slide = |friction: f64| {
        let around = Surroundings { gravity_m_s2: [0.0, -9.8, 0.0], solid: Some(ball), friction, ..NOTHING };
        let mut cloth = Cloth::new(&sheet, material([900.0, 0.0, 900.0, 400.0], 1e-4), around, x.clone(), &[]).unwrap();
        let mut ways = [0.0; 2];
        for way in &mut ways {
            let before = cloth.positions()[12];
            for _ in 0..60 {
                cloth.step(1.0 / 240.0).unwrap();
            }
            *way = dot(sub(cloth.positions()[12], before), [c, -s, 0.0]);
        }
        let deepest = cloth.positions().iter().map(|x| ball.distance(*x).0).fold(0.0, f64::min);
        assert!(deepest > -1e-4, "{deepest}");
        ways
    };
    // it falls by some micrometres before it touches
    let [first, second] = slide(0.5);
    assert!(first < 2e-3 && second.abs() < 1e-4, "{first} {second}");
    // half a second at g (sin - mu cos)
    let way = 0.5 * 9.8 * (s - 0.2 * c) * 0.25;
    let slid: f64 = slide(0.2).iter().sum();
    assert!((slid / way - 1.0).abs() < 0.05, "{slid} {way}");
}

#[test]
fn what_cannot_be_is_refused() {
    let sheet = Sheet::rectangle(3, 3, 1.0, 1.0).unwrap();
    let ok = || material([1.0; 4], 1.0);
    let x = upright(&sheet);
    assert!(Cloth::new(&sheet, ok(), NOTHING, x[1..].to_vec(), &[]).is_err());
    assert!(Cloth::new(&sheet, ok(), NOTHING, x.clone(), &[9]).is_err());
    assert!(Cloth::new(&sheet, ok(), NOTHING, x.clone(), &[0, 1, 2, 3, 4, 5, 6, 7, 8]).is_err());
    assert!(Cloth::new(&sheet, ok(), Surroundings { friction: -1.0, ..NOTHING }, x.clone(), &[]).is_err());
    assert!(Cloth::new(&sheet, Material { density_kg_m2: 0.0, ..ok() }, NOTHING, x.clone(), &[]).is_err());
    let mut cloth = Cloth::new(&sheet, ok(), NOTHING, x, &[0]).unwrap();
    assert!(cloth.step(f64::NAN).is_err() && cloth.step(0.0).is_err());
}
