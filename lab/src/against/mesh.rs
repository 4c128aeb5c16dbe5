//! The triangle mesh of a reference and its strains.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use serde::Serialize;

use crate::metrics::{PIN_RADIUS_M, percentile};
use crate::npz::{Npz, NpzError};

/// Most vertices of a mesh.
const MOST_VERTICES: usize = 1 << 20;

/// Two places in the rest shape closer than this along an axis have the same coordinate, in m.
const SAME_M: f32 = 1e-5;

/// A flat mesh at rest: places in m along u and v, triangles, and the edges by their direction.
#[derive(Clone, Debug)]
pub struct Mesh {
    /// (u, v) of the vertices in m.
    pub uv: Vec<[f32; 2]>,
    /// Vertices of the triangles.
    pub triangles: Vec<[usize; 3]>,
    /// Edges along u, along v, and both diagonals of every cell.
    edges: [Vec<[usize; 2]>; 3],
}

/// Mean and 99th percentile of strains in percent.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Strain {
    /// Mean, compressed edges with their sign.
    pub mean: f64,
    /// 99th percentile.
    pub p99: f64,
}

impl Strain {
    /// Where there is nothing to measure.
    pub const NONE: Strain = Strain { mean: f64::NAN, p99: f64::NAN };
}

impl Mesh {
    /// Reads the arrays `uv` [n, 2] in m and `tris` [t, 3]. Errors: those of the file, shapes, vertices that do not exist,
    /// places outside the square from (0, 0) to (1, 1).
    pub fn load(path: &Path) -> Result<Mesh, NpzError> {
        let mut npz = Npz::open(path)?;
        let uv = npz.floats("uv")?;
        let [n, 2] = uv.shape[..] else {
            return Err(npz.wrong("uv", format!("has the shape {:?}, not [n, 2]", uv.shape)));
        };
        if !(3..=MOST_VERTICES).contains(&n) {
            return Err(npz.wrong("uv", format!("has {n} vertices, not 3 to {MOST_VERTICES}")));
        }
        if let Some(i) = uv.values.iter().position(|x| !(-SAME_M..=1.0 + SAME_M).contains(x)) {
            return Err(npz.wrong("uv", format!("vertex {} lies outside the square metre", i / 2)));
        }
        let triangles = npz.indices("tris")?;
        let [t, 3] = triangles.shape[..] else {
            return Err(npz.wrong("tris", format!("has the shape {:?}, not [n, 3]", triangles.shape)));
        };
        if t == 0 {
            return Err(npz.wrong("tris", "has no triangle"));
        }
        if let Some(i) = triangles.values.iter().position(|v| *v >= n) {
            return Err(npz.wrong("tris", format!("triangle {} has a vertex beyond the {n} of `uv`", i / 3)));
        }
        let uv = uv.values.as_chunks::<2>().0.to_vec();
        Ok(Mesh::new(uv, triangles.values.as_chunks::<3>().0.to_vec()))
    }

    /// The square metre of `side` x `side` vertices, row by row from v = 0, with alternating diagonals.
    pub fn square(side: usize) -> Mesh {
        let share = |i: usize| i as f32 / (side - 1) as f32;
        let uv = (0..side * side).map(|i| [share(i % side), share(i / side)]).collect();
        let cells = (0..side - 1).flat_map(|row| (0..side - 1).map(move |column| (row, column)));
        let triangles = cells.flat_map(|(row, column)| {
            let a = row * side + column;
            let (b, c, d) = (a + 1, a + side + 1, a + side);
            if (row + column) % 2 == 0 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] }
        });
        Mesh::new(uv, triangles.collect())
    }

    fn new(uv: Vec<[f32; 2]>, triangles: Vec<[usize; 3]>) -> Mesh {
        // the edges with the corners across them: where two triangles share a diagonal, these are the ends of the other one
        let mut across: BTreeMap<[usize; 2], Vec<usize>> = BTreeMap::new();
        for [a, b, c] in &triangles {
            for ([a, b], c) in [([a, b], c), ([b, c], a), ([c, a], b)] {
                if a != b {
                    across.entry([*a.min(b), *a.max(b)]).or_default().push(*c);
                }
            }
        }
        let is_diagonal = |[a, b]: [usize; 2]| (0..2).all(|i| (uv[a][i] - uv[b][i]).abs() >= SAME_M);
        let mut all: BTreeSet<[usize; 2]> = across.keys().copied().collect();
        for (edge, corners) in &across {
            if let [a, b] = corners[..]
                && is_diagonal(*edge)
                && is_diagonal([a, b])
            {
                all.insert([a.min(b), a.max(b)]);
            }
        }
        let mut edges = [vec![], vec![], vec![]];
        for [a, b] in all {
            let [du, dv] = [0, 1].map(|i| (uv[a][i] - uv[b][i]).abs());
            match (du < SAME_M, dv < SAME_M) {
                (true, true) => {}
                (false, true) => edges[0].push([a, b]),
                (true, false) => edges[1].push([a, b]),
                (false, false) => edges[2].push([a, b]),
            }
        }
        Mesh { uv, triangles, edges }
    }

    /// Strains along u, along v and of the diagonal edges of a shape of the mesh, of the edges whose ends both lie more
    /// than 0.1 m from any of the pinned vertices at rest.
    pub fn strains(&self, x: &[[f32; 3]], pinned: &[usize]) -> [Strain; 3] {
        let distance = |a: [f32; 2], b: [f32; 2]| (a[0] - b[0]).hypot(a[1] - b[1]);
        let far: Vec<bool> = (self.uv.iter())
            .map(|at| pinned.iter().all(|p| distance(*at, self.uv[*p]) > PIN_RADIUS_M + SAME_M))
            .collect();
        self.edges.each_ref().map(|edges| {
            let kept = edges.iter().filter(|[a, b]| far[*a] && far[*b]);
            let mut all: Vec<f64> = kept
                .map(|[a, b]| {
                    let way: f64 = (0..3).map(|i| f64::from(x[*a][i] - x[*b][i]).powi(2)).sum();
                    100.0 * (way.sqrt() / f64::from(distance(self.uv[*a], self.uv[*b])) - 1.0)
                })
                .collect();
            if all.is_empty() || all.iter().any(|e| !e.is_finite()) {
                return Strain::NONE;
            }
            all.sort_by(f64::total_cmp);
            Strain { mean: all.iter().sum::<f64>() / all.len() as f64, p99: percentile(&all, 0.99) }
        })
    }

    /// A grid whose row 0 is v = 1 at the places of the vertices, bilinear between its particles.
    pub fn resampled(&self, grid: &[[f32; 3]], rows: usize, columns: usize) -> Vec<[f32; 3]> {
        let split = |share: f32, n: usize| {
            let at = share.clamp(0.0, 1.0) * (n - 1) as f32;
            let first = (at as usize).min(n - 2);
            (first, at - first as f32)
        };
        (self.uv.iter())
            .map(|[u, v]| {
                let ((column, s), (row, t)) = (split(*u, columns), split(1.0 - v, rows));
                let at = |r: usize, c: usize| grid[(row + r) * columns + column + c];
                let [a, b, c, d] = [at(0, 0), at(0, 1), at(1, 0), at(1, 1)];
                std::array::from_fn(|i| {
                    let (top, bottom) = (a[i] + (b[i] - a[i]) * s, c[i] + (d[i] - c[i]) * s);
                    top + (bottom - top) * t
                })
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_affine_shape_has_the_strains_of_its_matrix() {
        let mesh = Mesh::square(33);
        assert_eq!(mesh.edges.each_ref().map(Vec::len), [33 * 32, 33 * 32, 2 * 32 * 32]);
        // 2 % longer along u, 1 % shorter along v, sheared by 0.1: x = 1.02 u + 0.1 v
        let x: Vec<[f32; 3]> = mesh.uv.iter().map(|[u, v]| [1.02 * u + 0.1 * v, 0.99 * v, 3.0]).collect();
        let [u, v, diagonal] = mesh.strains(&x, &[1056, 1088]);
        assert!((u.mean - 2.0).abs() < 1e-3 && (u.p99 - 2.0).abs() < 1e-3, "{u:?}");
        assert!((v.mean - 100.0 * (0.99f64.hypot(0.1) - 1.0)).abs() < 1e-3, "{v:?}");
        // the diagonals of the square: 1.12, 0.99 and 0.92, -0.99
        let lengths = [1.12f64.hypot(0.99), 0.92f64.hypot(0.99)].map(|l| 100.0 * (l / 2f64.sqrt() - 1.0));
        assert!((diagonal.mean - 0.5 * (lengths[0] + lengths[1])).abs() < 0.02, "{diagonal:?}");
        assert!((diagonal.p99 - lengths[0]).abs() < 1e-3);
    }

    #[test]
    fn what_is_near_a_pin_does_not_count() {
        let mesh = Mesh::square(33);
        let mut x: Vec<[f32; 3]> = mesh.uv.iter().map(|[u, v]| [*u, *v, 0.0]).collect();
        x[1056][1] += 0.02;
        assert!(mesh.strains(&x, &[])[1].p99 < 1e-3 && mesh.strains(&x, &[])[1].mean > 1e-2 / 1056.0);
        assert!(mesh.strains(&x, &[1056])[1].mean.abs() < 1e-5);
        let all: Vec<usize> = (0..33 * 33).collect();
        assert!(mesh.strains(&x, &all)[0].mean.is_nan());
    }

    #[test]
    fn a_linear_grid_is_resampled_exactly() {
        let mesh = Mesh::square(33);
        let (rows, columns) = (16, 24);
        let grid: Vec<[f32; 3]> = (0..rows * columns)
            .map(|i| {
                let (u, v) = ((i % columns) as f32 / 23.0, 1.0 - (i / columns) as f32 / 15.0);
                [u, v, 2.0 * u - v]
            })
            .collect();
        for ([u, v], x) in mesh.uv.iter().zip(mesh.resampled(&grid, rows, columns)) {
            let meant = [*u, *v, 2.0 * u - v];
            assert!(x.iter().zip(meant).all(|(a, b)| (a - b).abs() < 1e-5), "{x:?} {meant:?}");
        }
    }

    #[test]
    fn meshes_that_are_none_are_refused() {
        use crate::npz::tests::{f4, i4, write};
        let home = tempfile::tempdir().unwrap();
        let path = home.path().join("mesh.npz");
        let square = [0.0, 0.0, 1.0, 0.0, 0.0, 1.0];
        let load = |uv: Vec<u8>, tris: Vec<u8>| {
            write(&path, &[("uv", uv), ("tris", tris)]);
            Mesh::load(&path).map_err(|e| e.to_string())
        };
        assert_eq!(load(f4("(3, 2)", &square), i4("(1, 3)", &[0, 1, 2])).unwrap().triangles, [[0, 1, 2]]);
        for (uv, tris, named) in [
            (f4("(2, 3)", &square), i4("(1, 3)", &[0, 1, 2]), "`uv`: has the shape [2, 3]"),
            (f4("(3, 2)", &square), i4("(3,)", &[0, 1, 2]), "`tris`: has the shape [3]"),
            (f4("(3, 2)", &square), i4("(1, 3)", &[0, 1, 3]), "triangle 0 has a vertex beyond the 3"),
            (f4("(3, 2)", &square), i4("(0, 3)", &[]), "no triangle"),
            (f4("(3, 2)", &[0.0, 0.0, 7.0, 0.0, 0.0, 1.0]), i4("(1, 3)", &[0, 1, 2]), "vertex 1 lies outside"),
        ] {
            let e = load(uv, tris).unwrap_err();
            assert!(e.contains("mesh.npz") && e.contains(named), "{e}");
        }
    }
}
