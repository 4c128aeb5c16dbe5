//! The operator and its solver against the springs written down one by one in f64.

extern crate std;

use std::vec;
use std::vec::Vec;

use super::gradients::{Image, System, Work};
use super::operator::{Diagonal, Linearise, Residual};
use super::{Implicit, blocks, coarse};
use crate::force::Planes;
use crate::layout::{read, write};
use crate::{Cloth, ClothDef, Families, Features, Grid, GridDef, Solver, noise, simd};

const B: f32 = 0.02;
const SIZES: [(u32, u32, Families); 8] = [
    (2, 2, Families::ALL),
    (3, 2, Families::STRUCTURAL),
    (2, 9, Families(3)),
    (4, 4, Families::ALL),
    (5, 7, Families(5)),
    (7, 6, Families::ALL),
    (9, 17, Families::ALL),
    (16, 5, Families::ALL),
];

/// A crumpled cloth with pins and springs of very different stiffness.
fn crumpled(rows: u32, columns: u32, families: Families, noise_m: f32) -> Cloth<'static> {
    let def = GridDef { rows, columns, width_m: 0.1 * columns as f32, height_m: 0.08 * rows as f32, families };
    let grid = Grid::new(&def).unwrap();
    let def = ClothDef { solver: Solver::Bdf2, features: Features::IMPLICIT, ..ClothDef::default() };
    let block = vec![f32::NAN; Cloth::memory(&grid, &def).unwrap()].leak();
    let mut c = Cloth::create(&grid, &def, block).unwrap();
    let field: Vec<f32> = (0..16).map(|i| [900.0, 300.0, 50.0, 5.0][i / 4] * (1.0 + (i % 4) as f32)).collect();
    c.set_stiffness_field(&crate::field::FieldView::new(4, 2, 2, &field).unwrap());
    for i in 0..grid.particles() {
        let g = |a: u32| noise_m * noise::gaussian(7, 3 * i as u32 + a);
        let p = c.position(i).unwrap() + crate::Vector3::new(g(0), g(1), g(2));
        c.set_position(i, p).unwrap();
    }
    c.pin(0).unwrap();
    c.pin(grid.particles() / 2).unwrap();
    c.refresh(true);
    c
}

/// a, b, k, rest length of every spring.
fn springs(c: &Cloth<'_>) -> Vec<(usize, usize, f64, f64)> {
    let (l, s, mut all) = (c.layout, c.layout.stride, Vec::new());
    let k = c.constants();
    let planes = [
        (&*c.springs.u, 1, k.rest_u),
        (&*c.springs.v, s, k.rest_v),
        (&*c.springs.right, s + 1, k.rest_diagonal),
        (&*c.springs.left, s - 1, k.rest_diagonal),
        (&*c.springs.bend_u, 2, 2.0 * k.rest_u),
        (&*c.springs.bend_v, 2 * s, 2.0 * k.rest_v),
    ];
    for (plane, to, rest) in planes {
        for i in 0..c.grid.particles() {
            let at = l.place(i).unwrap();
            if read(plane, at) > 0.0 {
                let j =
                    (0..c.grid.particles()).find(|j| l.place(*j).unwrap() == at + to).expect("no spring ends outside");
                all.push((i, j, f64::from(read(plane, at)), f64::from(rest)));
            }
        }
    }
    assert_eq!(all.len(), c.grid.springs());
    all
}

fn at(c: &Cloth<'_>, planes: &Planes<'_>, i: usize) -> [f64; 3] {
    let at = c.layout.place(i).unwrap();
    [&planes.x, &planes.y, &planes.z].map(|p| f64::from(read(p, at)))
}

/// The matrix A of the free particles in f64; rows and columns of pinned ones are those of 1.
fn dense(c: &Cloth<'_>) -> Vec<Vec<f64>> {
    let n = 3 * c.grid.particles();
    let b2 = f64::from(B) * f64::from(B);
    let mut a = vec![vec![0.0; n]; n];
    let free = |i: usize| read(c.inverse, c.layout.place(i).unwrap()) > 0.0;
    for i in 0..n {
        let m = f64::from(read(c.implicit.linear.mass, c.layout.place(i / 3).unwrap()));
        a[i][i] = if free(i / 3) { m } else { 1.0 };
    }
    for (i, j, k, rest) in springs(c) {
        let (p, q) = (at(c, &c.x, i), at(c, &c.x, j));
        let d: Vec<f64> = (0..3).map(|a| q[a] - p[a]).collect();
        let l2: f64 = d.iter().map(|x| x * x).sum();
        let across = (1.0 - rest / l2.sqrt()).max(0.0);
        for r in 0..3 {
            for s in 0..3 {
                let h = b2 * k * ((1.0 - across) * d[r] * d[s] / l2 + if r == s { across } else { 0.0 });
                for (u, v, sign) in [(i, i, 1.0), (j, j, 1.0), (i, j, -1.0), (j, i, -1.0)] {
                    if free(u) && free(v) {
                        a[3 * u + r][3 * v + s] += sign * h;
                    }
                }
            }
        }
    }
    a
}

/// Solves A x = b by Cholesky; fails where A is not positive definite.
fn cholesky(mut a: Vec<Vec<f64>>, mut b: Vec<f64>) -> Vec<f64> {
    let n = b.len();
    for j in 0..n {
        for i in j..n {
            let s: f64 = (0..j).map(|k| a[i][k] * a[j][k]).sum();
            if i == j {
                assert!(a[j][j] - s > 0.0, "not positive definite");
                a[j][j] = (a[j][j] - s).sqrt();
            } else {
                a[i][j] = (a[i][j] - s) / a[j][j];
            }
        }
    }
    for i in 0..n {
        b[i] = (b[i] - (0..i).map(|k| a[i][k] * b[k]).sum::<f64>()) / a[i][i];
    }
    for i in (0..n).rev() {
        b[i] = (b[i] - (i + 1..n).map(|k| a[k][i] * b[k]).sum::<f64>()) / a[i][i];
    }
    b
}

/// Linearises a cloth where it is, with its residual at rest, ready to be solved.
fn linearised(c: &mut Cloth<'_>) {
    let (l, k) = (c.layout, c.constants());
    for i in 0..c.grid.particles() {
        let at = l.place(i).unwrap();
        let w = read(c.inverse, at);
        write(c.implicit.linear.mass, at, if w > 0.0 { 1.1 / w } else { 0.0 });
        write(c.implicit.linear.free, at, if w > 0.0 { 1.0 } else { 0.0 });
    }
    let (x, v) = (c.x.view(), c.v.view());
    let Implicit { residual, known, linear, blocks, coarse, .. } = &mut c.implicit;
    let (width, known) = (c.width, known.view());
    simd::run(width, Linearise { l: &l, c: &k, x, springs: &c.springs, linear });
    let outer = [&[][..]; 3];
    simd::run(width, Residual { l: &l, b: B, weight: k.weight, x, v, known, linear, outer, residual });
    simd::run(width, Diagonal { l: &l, b: B, x, linear, blocks });
    coarse::prepare(width, &l, linear.mass, blocks.each_ref().map(|p| &**p), coarse);
    simd::run(width, blocks::Invert { l: &l, mass: linear.mass, blocks });
}

/// A search for a search of Gaussian numbers, 0 at pins; returns both.
fn applied(c: &mut Cloth<'_>, seed: u64) -> (Vec<f64>, Vec<f64>) {
    let free = |i: usize| read(c.implicit.linear.free, c.layout.place(i / 3).unwrap());
    let search: Vec<f64> =
        (0..3 * c.grid.particles()).map(|i| f64::from(free(i) * noise::gaussian(seed, i as u32))).collect();
    let image = image_of(c, &search);
    (search, image)
}

/// A search.
fn image_of(c: &mut Cloth<'_>, search: &[f64]) -> Vec<f64> {
    let l = c.layout;
    let x = c.x.view();
    let particles = c.grid.particles();
    let Implicit { search: to, image, linear, .. } = &mut c.implicit;
    for i in 0..particles {
        let at = l.place(i).unwrap();
        write(to.x, at, search[3 * i] as f32);
        write(to.y, at, search[3 * i + 1] as f32);
        write(to.z, at, search[3 * i + 2] as f32);
    }
    simd::run(c.width, Image { l: &l, x, linear, share: None, search: to, image, carry: c.carry });
    list(c, &c.implicit.image)
}

fn list(c: &Cloth<'_>, planes: &Planes<'_>) -> Vec<f64> {
    (0..c.grid.particles()).flat_map(|i| at(c, planes, i)).collect()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The operator on rows is the matrix of the springs, element by element; so it is symmetric, and its Cholesky
/// decomposition shows that it is positive definite, however crumpled the cloth is.
#[test]
fn the_operator_is_the_matrix_of_the_springs() {
    for (rows, columns, families) in SIZES {
        for noise_m in [0.0, 0.02, 0.2] {
            let mut c = crumpled(rows, columns, families, noise_m);
            linearised(&mut c);
            let a = dense(&c);
            let (p, q) = applied(&mut c, 1);
            let (p2, q2) = applied(&mut c, 2);
            let largest = a.iter().flatten().fold(0.0f64, |a, x| a.max(x.abs()));
            for (row, q) in a.iter().zip(&q) {
                let size: f64 = row.iter().zip(&p).map(|(a, p)| (a * p).abs()).sum();
                // in the flat sheet a spring's part across is the rounding of its length
                let rounding = 1e-6 * largest;
                assert!((dot(row, &p) - q).abs() <= 3e-5 * size + rounding, "{rows} x {columns}: {} {q}", dot(row, &p));
            }
            let (xy, yx) = (dot(&p, &q2), dot(&p2, &q));
            let scale = (dot(&p, &q) * dot(&p2, &q2)).sqrt();
            assert!((xy - yx).abs() < 1e-5 * scale, "symmetric: {xy} {yx}");
            assert!(dot(&p, &q) > 0.0);
            cholesky(a, q);
        }
    }
}

/// Enough iterations solve the system, from 2 x 2 to sizes with several coarse levels, odd and even.
#[test]
fn the_gradients_find_what_a_dense_solver_finds() {
    for (rows, columns, families) in SIZES {
        for noise_m in [0.0, 0.02] {
            let mut c = crumpled(rows, columns, families, noise_m);
            linearised(&mut c);
            let residual = list(&c, &c.implicit.residual);
            let exact = cholesky(dense(&c), residual.clone());
            solve(&mut c, 200);
            let found = list(&c, &c.implicit.change);
            let error: Vec<f64> = exact.iter().zip(&found).map(|(a, b)| a - b).collect();
            let relative = (dot(&error, &error) / dot(&exact, &exact)).sqrt();
            assert!(relative < 2e-4, "{rows} x {columns}, noise {noise_m}: off by {relative:.1e}");
        }
    }
}

fn solve(c: &mut Cloth<'_>, iterations: u32) {
    let (l, x) = (c.layout, c.x.view());
    let Implicit { change, residual, search, image, linear, blocks, coarse, .. } = &mut c.implicit;
    for p in [&mut *change.x, &mut *change.y, &mut *change.z] {
        p.fill(0.0);
    }
    let blocks = blocks.each_ref().map(|p| &**p);
    let system = System { width: c.width, l: &l, x, linear, blocks, floating: false };
    system.solve(iterations, &mut Work { change, residual, search, image, levels: coarse, carry: c.carry });
}

/// The coarse levels are there for the sake of few iterations: on a stiff sheet of 33 x 40, loaded by its weight, 20 of
/// them leave less than a third of the error (in the energy norm) that 80 of block Jacobi alone leave.
#[test]
fn the_coarse_levels_carry_the_load_down() {
    let mut c = crumpled(33, 40, Families::ALL, 0.0);
    c.set_stiffness_uniform([8e4, 4e4, 5e3, 50.0]).unwrap();
    c.refresh(true);
    linearised(&mut c);
    solve(&mut c, 600);
    let exact = list(&c, &c.implicit.change);
    let size = dot(&exact, &image_of(&mut c, &exact)).sqrt();
    let mut left = |levels: bool, iterations: u32| {
        linearised(&mut c);
        let coarse = if levels { None } else { Some(core::mem::take(&mut c.implicit.coarse)) };
        solve(&mut c, iterations);
        c.implicit.coarse = coarse.unwrap_or(core::mem::take(&mut c.implicit.coarse));
        let found = list(&c, &c.implicit.change);
        let error: Vec<f64> = exact.iter().zip(&found).map(|(a, b)| a - b).collect();
        dot(&error, &image_of(&mut c, &error)).sqrt() / size
    };
    let (with, without) = (left(true, 20), left(false, 80));
    assert!(with < without / 3.0, "with levels {with:.1e}, without {without:.1e}");
}

/// A residual of 0 changes nothing: no 0 / 0.
#[test]
fn nothing_to_do_is_done() {
    let mut c = crumpled(6, 7, Families::ALL, 0.02);
    linearised(&mut c);
    for p in [&mut *c.implicit.residual.x, &mut *c.implicit.residual.y, &mut *c.implicit.residual.z] {
        p.fill(0.0);
    }
    solve(&mut c, 10);
    for p in [&c.implicit.change.x, &c.implicit.change.y, &c.implicit.change.z] {
        assert!(p.iter().all(|v| *v == 0.0));
    }
}

/// b^2 H is b times the derivative of b F where every spring is longer than at rest: central differences of the residual.
#[test]
fn the_operator_is_the_derivative_of_the_force() {
    for (rows, columns, families) in SIZES {
        let mut c = crumpled(rows, columns, families, 0.0);
        // stretched, so that nothing is clamped
        for i in 0..c.grid.particles() {
            let g = |a: u32| 0.004 * noise::gaussian(9, 3 * i as u32 + a);
            let p = c.position(i).unwrap() * 1.5 + crate::Vector3::new(g(0), g(1), g(2));
            c.set_position(i, p).unwrap();
        }
        linearised(&mut c);
        let (p, q) = applied(&mut c, 4);
        let shape: Vec<_> = (0..c.grid.particles()).map(|i| c.position(i).unwrap()).collect();
        let h = 2e-4;
        let mut force = |sign: f32| -> Vec<f64> {
            for (i, x) in shape.iter().enumerate() {
                let d = crate::Vector3::new(p[3 * i] as f32, p[3 * i + 1] as f32, p[3 * i + 2] as f32);
                c.set_position(i, x + d * (sign * h)).unwrap();
            }
            linearised(&mut c);
            list(&c, &c.implicit.residual)
        };
        let (plus, minus) = (force(1.0), force(-1.0));
        let free: Vec<f64> =
            (0..q.len()).map(|i| f64::from(read(c.implicit.linear.mass, c.layout.place(i / 3).unwrap()))).collect();
        let (mut error, mut size) = (0.0, 0.0);
        for i in 0..q.len() {
            let numeric = -f64::from(B) * (plus[i] - minus[i]) / (2.0 * f64::from(h));
            let analytic = q[i] - free[i] * p[i];
            error += (numeric - analytic).powi(2);
            size += analytic * analytic;
        }
        assert!((error / size).sqrt() < 2e-3, "{rows} x {columns}: {:.1e}", (error / size).sqrt());
    }
}

/// A frame that would end without finite numbers is taken back; BDF2 then forgets its past (it belonged to that frame) and
/// goes on with a step of implicit Euler.
#[test]
fn a_frame_that_is_taken_back_leaves_no_past() {
    let made = |solver| {
        let grid = Grid::new(&GridDef { rows: 5, columns: 4, ..GridDef::default() }).unwrap();
        let features = Features(Features::IMPLICIT.0 | Features::PULL.0);
        let def = ClothDef { solver, substeps: 1, features, ..ClothDef::default() };
        let mut c = Cloth::create(&grid, &def, vec![0.0; Cloth::memory(&grid, &def).unwrap()].leak()).unwrap();
        c.set_stiffness_uniform([900.0, 400.0, 60.0, 1.0]).unwrap();
        c.pin(0).unwrap();
        c
    };
    let mut c = made(Solver::Bdf2);
    for _ in 0..5 {
        c.step().unwrap();
    }
    let mut euler = made(Solver::ImplicitEuler);
    for i in 0..20 {
        euler.set_position(i, c.position(i).unwrap()).unwrap();
        euler.set_velocity(i, c.velocity(i).unwrap()).unwrap();
    }
    let state = |c: &Cloth<'_>| (list(c, &c.x), list(c, &c.v));
    let before = state(&c);
    // no call lets such a force in
    c.pull[1][c.layout.place(7).unwrap()] = f32::NAN;
    c.has_pull = true;
    let flags = crate::StepFlags::NON_FINITE.0 | crate::StepFlags::NON_FINITE_FORCE.0;
    assert_eq!(c.step().unwrap().0, flags);
    assert_eq!(state(&c), before);
    assert_eq!(c.step().unwrap(), crate::StepFlags(0));
    euler.step().unwrap();
    assert_eq!(state(&c), state(&euler));
}
