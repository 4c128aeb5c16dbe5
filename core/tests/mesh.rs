//! What a renderer reads: triangles, texture coordinates, normals, bounds.

mod common;

use common::{Random, bare, cloth, grid, squares};
use taut::{Cloth, ClothDef, Error, Families, Vector3};

/// Puts every particle where a surface over (u, v) in [0, 1] x [0, 1] has it.
fn shape(c: &mut Cloth<'_>, at: impl Fn(f64, f64) -> Vector3<f64>) {
    for i in 0..c.grid().particles() {
        let [u, v] = c.grid().uv(i).unwrap();
        c.set_position(i, at(u.into(), v.into()).cast()).unwrap();
    }
}

/// Every edge inside belongs to two triangles that run along it in opposite directions, every edge of the border to one;
/// and they cover the sheet: Euler's formula of a disc, V - E + F = 1.
#[test]
fn the_triangles_are_a_disc_that_looks_one_way() {
    for (rows, columns) in [(2, 2), (2, 7), (5, 2), (9, 6)] {
        let g = squares(rows, columns, 0.1, Families::ALL);
        let triangles: Vec<[u32; 3]> = g.triangles().collect();
        assert_eq!(triangles.len(), g.triangle_count());
        assert_eq!(triangles[0], [0, columns, 1]);
        let mut edges = std::collections::BTreeSet::new();
        for t in &triangles {
            assert!(t.iter().all(|i| (*i as usize) < g.particles()));
            for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
                assert!(edges.insert((a, b)), "two triangles run from {a} to {b}");
            }
        }
        let border = edges.iter().filter(|(a, b)| !edges.contains(&(*b, *a))).count();
        assert_eq!(border, 2 * (rows - 1 + columns - 1) as usize);
        let all = (edges.len() + border) / 2;
        assert_eq!(g.particles() as i64 - all as i64 + triangles.len() as i64, 1);
    }
}

/// The sheet's area, and all triangles look to where the normals point.
#[test]
fn the_triangles_cover_the_sheet_once() {
    let g = grid(7, 12, 0.9, 0.4, Families::STRUCTURAL);
    let c = cloth(&g, &ClothDef::default());
    let mut area = 0.0;
    for t in g.triangles() {
        let [a, b, d] = t.map(|i| c.world_position(i as usize).unwrap());
        let n = (b - a).cross(&(d - a)) / 2.0;
        assert!(n.dot(&c.normal(t[0] as usize).unwrap().cast()) > 0.0);
        area += n.norm();
    }
    // 132 sums of positions that are exact to 2^-24 of a metre
    assert!((area - 0.36).abs() < 1e-6, "{area}");
}

#[test]
fn texture_coordinates_run_from_corner_to_corner() {
    let g = grid(3, 5, 2.0, 1.0, Families::ALL);
    assert_eq!(g.uv(0), Ok([0.0, 0.0]));
    assert_eq!(g.uv(4), Ok([1.0, 0.0]));
    assert_eq!(g.uv(7), Ok([0.5, 0.5]));
    assert_eq!(g.uv(14), Ok([1.0, 1.0]));
    assert_eq!(g.uv(15), Err(Error::NoSuchParticle));
}

/// A plane has one normal, v x u, wherever it lies, however large its cells are and however they are sheared.
#[test]
fn a_plane_has_one_normal() {
    let mut random = Random::new(3);
    for size in [1e-6f32, 1.0, 1e4] {
        for _ in 0..20 {
            let (u, v) = (random.vector(1.0), random.vector(1.0));
            if u.normalize().cross(&v.normalize()).norm() < 0.2 {
                continue; // too thin to tell the normal from f32 positions
            }
            let g = grid(6, 9, size, size, Families::ALL);
            let mut c = cloth(&g, &bare());
            let (u, v) = (u.cast::<f64>() * f64::from(size), v.cast::<f64>() * f64::from(size));
            shape(&mut c, |a, b| u * a + v * b);
            let is = v.cross(&u).normalize();
            for i in 0..g.particles() {
                let n = c.normal(i).unwrap();
                // a position is off by 2^-24 of the size, a cell is an 8th of it, the sine of the corner is above 0.2
                assert!((n.cast() - is).norm() < 1e-5, "{size}: {n} for {is}");
            }
        }
    }
}

/// A flat new cloth looks along +z: u is +x, v is -y.
#[test]
fn a_new_cloth_faces_the_viewer() {
    let c = cloth(&squares(2, 2, 0.1, Families::ALL), &ClothDef::default());
    for i in 0..4 {
        assert_eq!(c.normal(i), Ok(Vector3::new(0.0, 0.0, 1.0)));
    }
    assert_eq!(c.normal(4), Err(Error::NoSuchParticle));
}

/// On a cut-out of a sphere the normals are the radii. With half the cell the error at a place inside is a quarter (the four
/// cells lie alike on all sides), at the border a half (all cells lie on one side).
#[test]
fn the_normals_of_a_sphere_are_its_radii() {
    // the largest error at the places of a 16 x 16 grid, inside and at the border
    let worst = |fine: u32| {
        let n = 16 * fine;
        let g = squares(n + 1, n + 1, 1.0 / n as f32, Families::ALL);
        let mut c = cloth(&g, &bare());
        shape(&mut c, |u, v| {
            let (x, y) = (u - 0.4, 0.55 - v);
            Vector3::new(x, y, (1.0 - x * x - y * y).sqrt())
        });
        let mut worst = [0.0f32; 2];
        for row in 0..=16 {
            for column in 0..=16 {
                let i = (row * fine * (n + 1) + column * fine) as usize;
                let off = (c.normal(i).unwrap() - c.position(i).unwrap()).norm();
                let border = [0, 16].contains(&row) || [0, 16].contains(&column);
                worst[usize::from(border)] = worst[usize::from(border)].max(off);
            }
        }
        worst
    };
    let (coarse, fine) = (worst(1), worst(2));
    assert!(coarse[0] < 0.01 && coarse[1] < 0.08, "{coarse:?}");
    let order = [0, 1].map(|i| (coarse[i] / fine[i]).log2());
    assert!((order[0] - 2.0).abs() < 0.2, "inside {order:?}");
    assert!((order[1] - 1.0).abs() < 0.2, "border {order:?}");
}

/// Two halves folded flat on each other cancel, and the fold has no normal. Nor has a sheet that is a line.
#[test]
fn no_area_no_normal() {
    let g = squares(3, 3, 0.5, Families::ALL);
    let mut c = cloth(&g, &bare());
    shape(&mut c, |u, v| Vector3::new((u - 0.5).abs(), v, 0.0));
    for row in 0..3 {
        assert_eq!(c.normal(3 * row), Ok(Vector3::new(0.0, 0.0, 1.0)));
        assert_eq!(c.normal(3 * row + 1), Ok(Vector3::zeros()));
        assert_eq!(c.normal(3 * row + 2), Ok(Vector3::new(0.0, 0.0, -1.0)));
    }
    shape(&mut c, |u, _| Vector3::new(u, u, u));
    assert!((0..9).all(|i| c.normal(i) == Ok(Vector3::zeros())));
}

/// All at once are the same as one by one, to the bit, on a crumpled sheet of any size of cells.
#[test]
fn the_list_of_normals_is_that_of_the_particles() {
    let mut random = Random::new(5);
    for (rows, columns, size) in [(2, 2, 1.0), (7, 4, 1e-9), (5, 19, 1e5)] {
        let g = squares(rows, columns, 0.1, Families::ALL);
        let mut c = cloth(&g, &bare());
        for i in 0..g.particles() {
            c.set_position(i, random.vector(size)).unwrap();
        }
        let all: Vec<Vector3<f32>> = c.normals().collect();
        assert_eq!(all.len(), g.particles());
        for (i, n) in all.iter().enumerate() {
            assert_eq!(n.map(f32::to_bits), c.normal(i).unwrap().map(f32::to_bits));
            assert!((n.norm() - 1.0).abs() < 1e-6, "{n}");
        }
    }
}

/// The weights are the areas: a long cell beside a short one that is bent up.
#[test]
fn large_cells_count_more() {
    let g = squares(2, 3, 1.0, Families::ALL);
    let mut c = cloth(&g, &bare());
    // columns at x = 0, 3 flat, then 1 up along z: areas 3 (normal +z) and 1 (normal -x)
    for row in 0..2 {
        for (column, (x, z)) in [(0.0, 0.0), (3.0, 0.0), (3.0, 1.0)].into_iter().enumerate() {
            c.set_position(3 * row + column, Vector3::new(x, -(row as f32), z)).unwrap();
        }
    }
    let n = c.normal(1).unwrap();
    let is = Vector3::new(-1.0, 0.0, 3.0).normalize();
    assert!((n - is).norm() < 1e-6, "{n}");
}

/// Every particle is inside, and every side touches one: exactly, also far from the world's origin.
#[test]
fn bounds_are_tight() {
    let g = squares(6, 5, 0.2, Families::ALL);
    let mut random = Random::new(11);
    for origin in [0.0, 1e6 + 0.1, -1e11] {
        let mut c = cloth(&g, &ClothDef { origin_m: [origin, -origin, 3.0], ..bare() });
        for i in 0..g.particles() {
            c.set_position(i, random.vector(2.0)).unwrap();
        }
        let b = c.bounds();
        for axis in 0..3 {
            let all: Vec<f64> = (0..g.particles()).map(|i| c.world_position(i).unwrap()[axis]).collect();
            assert_eq!(b.low_m[axis], all.iter().copied().fold(f64::INFINITY, f64::min));
            assert_eq!(b.high_m[axis], all.iter().copied().fold(f64::NEG_INFINITY, f64::max));
        }
    }
}

/// A grid of 4096 x 4096 has indices up to 2^24 and no overflow on the way.
#[test]
fn the_largest_grid() {
    let g = squares(4096, 4096, 0.001, Families::STRUCTURAL);
    assert_eq!(g.triangle_count(), 2 * 4095 * 4095);
    assert_eq!(g.triangles().last(), Some([(1 << 24) - 4097, (1 << 24) - 2, (1 << 24) - 1]));
    assert_eq!(g.uv((1 << 24) - 1), Ok([1.0, 1.0]));
}
