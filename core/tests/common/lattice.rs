//! The springs and masses of a cloth, found from outside (one particle is lifted out of the plane, and the velocities
//! after one substep tell the forces on its neighbours), and the vibrations of such a lattice in f64.
//!
//! Nothing here knows how core averages and cuts: what is measured is what is stepped.

use super::{positions, put, velocities};
use taut::{Cloth, Grid, Vector3};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Family {
    Weft,
    Warp,
    Shear,
    Bend,
}

#[derive(Clone, Copy, Debug)]
pub struct Spring {
    pub a: usize,
    pub b: usize,
    pub family: Family,
    pub rest_m: f64,
    pub k: f64,
}

#[derive(Clone, Debug)]
pub struct Lattice {
    pub springs: Vec<Spring>,
    /// 1/M, 0 for pinned ones.
    pub inverse: Vec<f64>,
    /// The flat sheet.
    pub flat: Vec<Vector3<f64>>,
}

/// The springs of eq. 1 on a grid: structural to the neighbours, shear to the diagonals, bend two cells away; k is 0.
pub fn springs(grid: &Grid) -> Vec<Spring> {
    let (m, n) = (grid.rows(), grid.columns());
    let (u, v) = (f64::from(grid.rest_u()), f64::from(grid.rest_v()));
    let mut all = Vec::new();
    for row in 0..m {
        for column in 0..n {
            let mut add = |rows: usize, columns: isize, family, rest_m| {
                let to = column as isize + columns;
                if row + rows < m && (0..n as isize).contains(&to) {
                    let (a, b) = (row * n + column, (row + rows) * n + to as usize);
                    let k = 0.0;
                    all.push(Spring { a, b, family, rest_m, k });
                }
            };
            add(0, 1, Family::Weft, u);
            add(1, 0, Family::Warp, v);
            if grid.has_shear() {
                add(1, 1, Family::Shear, u.hypot(v));
                add(1, -1, Family::Shear, u.hypot(v));
            }
            if grid.has_bend() {
                add(0, 2, Family::Bend, 2.0 * u);
                add(2, 0, Family::Bend, 2.0 * v);
            }
        }
    }
    all
}

/// Measures a flat cloth in the plane z = 0 with gravity along z, one substep a frame, no speed limit. (Damping does not
/// matter: every measurement starts at rest.)
/// Springs between two pins cannot be seen (and move nothing): they keep k = 0. The cloth is flat and at rest after it.
///
/// Fails where the two ends of a spring feel different forces (Newton's third law).
pub fn measure(cloth: &mut Cloth<'_>) -> Lattice {
    let def = *cloth.def();
    let grid = *cloth.grid();
    assert!(def.substeps == 1 && def.speed_limit == 0.0);
    let (dt, g) = (f64::from(def.dt_s()), f64::from(def.gravity_m_s2[2]));
    let weight = f64::from(cloth.particle_mass_kg()) * g;
    let flat = positions(cloth);
    assert!(flat.iter().all(|p| p.z == 0.0));
    let (m, n) = (grid.rows(), grid.columns());

    let force_z = |cloth: &mut Cloth<'_>, from: &[Vector3<f32>]| -> Vec<f64> {
        put(cloth, from);
        assert_eq!(cloth.step().expect("a stiffness").0, 0);
        velocities(cloth).iter().map(|v| f64::from(v.z) / dt).collect()
    };
    // flat: no spring pulls along z, so the acceleration is weight / M
    let inverse: Vec<f64> = force_z(cloth, &flat).iter().map(|a| a / weight).collect();

    let h = f64::from(0.5 * grid.rest_u().min(grid.rest_v())) as f32;
    let mut all = springs(&grid);
    let mut seen = vec![[f64::NAN; 2]; all.len()];
    for color in 0..25 {
        let lifted = |i: usize| (i / n) % 5 == color / 5 && (i % n) % 5 == color % 5;
        let from: Vec<_> =
            flat.iter().enumerate().map(|(i, p)| if lifted(i) { Vector3::new(p.x, p.y, h) } else { *p }).collect();
        let a = force_z(cloth, &from);
        for (s, seen) in all.iter().zip(&mut seen) {
            for (end, (up, down)) in [(s.a, s.b), (s.b, s.a)].into_iter().enumerate() {
                if lifted(up) && inverse[down] > 0.0 {
                    let force = a[down] / inverse[down] - weight;
                    let h = f64::from(h);
                    let length = (s.rest_m * s.rest_m + h * h).sqrt();
                    seen[end] = force / ((1.0 - s.rest_m / length) * h);
                }
            }
        }
    }
    put(cloth, &flat);
    for (s, [ab, ba]) in all.iter_mut().zip(seen) {
        s.k = if ab.is_nan() { ba } else { ab };
        if s.k.is_nan() {
            s.k = 0.0;
        } else if !ab.is_nan() && !ba.is_nan() {
            let tolerance = 2e-4 * ab.abs().max(ba.abs()) + 1e-4 * weight.abs() / f64::from(h);
            assert!((ab - ba).abs() <= tolerance, "{m} x {n}: {s:?} pulls with {ab} and {ba}");
        }
    }
    Lattice { springs: all, inverse, flat: flat.iter().map(|p| p.cast()).collect() }
}

impl Lattice {
    /// Largest squared circular frequency of small vibrations of the flat sheet in 1/s^2.
    pub fn omega2_flat(&self, seed: u64) -> f64 {
        let flat = self.flat.clone();
        self.omega2(&flat, seed)
    }

    /// Largest squared circular frequency (largest eigenvalue of M^-1/2 H M^-1/2) of the sheet in any shape, by power
    /// iteration on the matrix made positive by a shift. It approaches from below.
    pub fn omega2(&self, shape: &[Vector3<f64>], seed: u64) -> f64 {
        let parts: Vec<(usize, usize, Vector3<f64>, f64, f64)> = self
            .springs
            .iter()
            .map(|s| {
                let d = shape[s.b] - shape[s.a];
                let across = 1.0 - s.rest_m / d.norm();
                (s.a, s.b, d.normalize(), s.k, s.k * across)
            })
            .collect();
        // a spring shorter than at rest pushes sideways: its part is at most 2 |across| (1/M_a + 1/M_b) below 0
        let mut below = vec![0.0; shape.len()];
        for (a, b, _, _, across) in &parts {
            below[*a] += 2.0 * (-across).max(0.0) * self.inverse[*a];
            below[*b] += 2.0 * (-across).max(0.0) * self.inverse[*b];
        }
        let shift = below.iter().fold(0.0, |a: f64, b| a.max(*b));
        let root: Vec<f64> = self.inverse.iter().map(|w| w.sqrt()).collect();
        let mut random = super::Random::new(seed);
        let mut y: Vec<Vector3<f64>> = (0..shape.len()).map(|_| random.vector(1.0).cast()).collect();
        let mut value = 0.0;
        for _ in 0..400 {
            let norm = y.iter().map(|v| v.norm_squared()).sum::<f64>().sqrt();
            let x: Vec<_> = y.iter().map(|v| v / norm).collect();
            let mut next: Vec<_> = x.iter().map(|v| v * shift).collect();
            for (a, b, n, k, across) in &parts {
                let d = x[*b] * root[*b] - x[*a] * root[*a];
                let f = n * (n.dot(&d) * (k - across)) + d * *across;
                next[*b] += f * root[*b];
                next[*a] -= f * root[*a];
            }
            value = x.iter().zip(&next).map(|(x, n)| x.dot(n)).sum::<f64>() - shift;
            y = next;
        }
        value
    }
}
