//! The triangle mesh at rest.

use std::collections::BTreeMap;

use super::ReferenceError;

/// Largest side of a sheet in vertices.
const MOST: usize = 1024;

/// A flat sheet at rest in the plane of u (weft) and v (warp), in m.
#[derive(Clone, Debug)]
pub struct Sheet {
    /// (u, v) of the vertices.
    pub uv: Vec<[f64; 2]>,
    /// Triangles, counter-clockwise in the plane.
    pub triangles: Vec<[usize; 3]>,
    /// Hinges: the edge, then the corner left of it and the corner right of it.
    pub hinges: Vec<[usize; 4]>,
}

impl Sheet {
    /// A rectangle of `rows` x `columns` vertices, vertex `row * columns + column`, rows along v from v = 0, with alternating
    /// diagonals: the mesh of ARCSim's scenes. Errors: sides outside 2 to 1024 vertices, lengths that are not positive.
    pub fn rectangle(rows: usize, columns: usize, width_m: f64, height_m: f64) -> Result<Sheet, ReferenceError> {
        for (what, n) in [("the number of rows", rows), ("the number of columns", columns)] {
            if !(2..=MOST).contains(&n) {
                return Err(ReferenceError::OutOfRange { what, value: n as f64 });
            }
        }
        for (what, value) in [("the width in m", width_m), ("the height in m", height_m)] {
            if !(value.is_finite() && value > 0.0) {
                return Err(ReferenceError::OutOfRange { what, value });
            }
        }
        let share = |i: usize, n: usize| i as f64 / (n - 1) as f64;
        let uv = (0..rows * columns)
            .map(|i| [width_m * share(i % columns, columns), height_m * share(i / columns, rows)])
            .collect();
        Ok(Sheet::new(uv, cells(rows, columns)))
    }

    /// A disc around (0, 0) with `side` vertices along its diameter: those of the square grid within it, the ones nearest
    /// the rim moved onto it. Errors: as of [`Sheet::rectangle`], and an even number of vertices.
    pub fn disc(side: usize, radius_m: f64) -> Result<Sheet, ReferenceError> {
        if !(5..=MOST).contains(&side) || side.is_multiple_of(2) {
            return Err(ReferenceError::OutOfRange {
                what: "the number of vertices of a diameter",
                value: side as f64,
            });
        }
        if !(radius_m.is_finite() && radius_m > 0.0) {
            return Err(ReferenceError::OutOfRange { what: "the radius in m", value: radius_m });
        }
        let cell = 2.0 * radius_m / (side - 1) as f64;
        let mut uv = Vec::new();
        let mut number = vec![None; side * side];
        for i in 0..side * side {
            let at = [(i % side) as f64 * cell - radius_m, (i / side) as f64 * cell - radius_m];
            let r = at[0].hypot(at[1]);
            if r <= radius_m + 0.5 * cell {
                number[i] = Some(uv.len());
                let on_rim = r > radius_m - 0.5 * cell;
                uv.push(if on_rim { at.map(|x| x * radius_m / r) } else { at });
            }
        }
        let triangles: Vec<[usize; 3]> = (cells(side, side).into_iter())
            .filter_map(|t| Some([number[t[0]]?, number[t[1]]?, number[t[2]]?]))
            // three vertices of the rim that were moved may lie nearly on a line
            .filter(|t| area(t.map(|i| uv[i])) > 0.1 * cell * cell)
            .collect();
        // what no triangle holds is not there
        let mut used = vec![None; uv.len()];
        let mut kept = Vec::new();
        for i in triangles.iter().flatten() {
            used[*i].get_or_insert_with(|| {
                kept.push(uv[*i]);
                kept.len() - 1
            });
        }
        let triangles = triangles.iter().map(|t| t.map(|i| used[i].unwrap_or(0))).collect();
        Ok(Sheet::new(kept, triangles))
    }

    fn new(uv: Vec<[f64; 2]>, triangles: Vec<[usize; 3]>) -> Sheet {
        // each edge of two triangles is a hinge; the triangle that has it in its own order lies left of it
        let mut left: BTreeMap<[usize; 2], usize> = BTreeMap::new();
        for [a, b, c] in &triangles {
            for ([p, q], r) in [([*a, *b], *c), ([*b, *c], *a), ([*c, *a], *b)] {
                left.insert([p, q], r);
            }
        }
        let hinges = (left.iter())
            .filter(|([p, q], _)| p < q)
            .filter_map(|([p, q], l)| Some([*p, *q, *l, *left.get(&[*q, *p])?]))
            .collect();
        Sheet { uv, triangles, hinges }
    }

    /// Rest area of a triangle in m^2.
    pub fn area_m2(&self, triangle: [usize; 3]) -> f64 {
        area(triangle.map(|i| self.uv[i]))
    }
}

fn area([a, b, c]: [[f64; 2]; 3]) -> f64 {
    0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
}

/// The triangles of a grid's cells, the diagonals alternating.
fn cells(rows: usize, columns: usize) -> Vec<[usize; 3]> {
    let all = (0..rows - 1).flat_map(|row| (0..columns - 1).map(move |column| (row, column)));
    all.flat_map(|(row, column)| {
        let a = row * columns + column;
        let (b, c, d) = (a + 1, a + columns + 1, a + columns);
        if (row + column) % 2 == 0 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] }
    })
    .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rectangle_has_its_area_and_its_inner_edges() {
        let sheet = Sheet::rectangle(5, 7, 1.2, 0.8).unwrap();
        let all: f64 = sheet.triangles.iter().map(|t| sheet.area_m2(*t)).sum();
        assert!((all - 0.96).abs() < 1e-12);
        // along u, along v, diagonals
        assert_eq!(sheet.hinges.len(), 3 * 6 + 4 * 5 + 4 * 6);
        for [a, b, l, r] in &sheet.hinges {
            assert!(sheet.area_m2([*a, *b, *l]) > 0.0 && sheet.area_m2([*a, *b, *r]) < 0.0);
        }
        let lab = taut_lab::against::Mesh::square(9);
        assert_eq!(lab.triangles, Sheet::rectangle(9, 9, 1.0, 1.0).unwrap().triangles);
        assert!(Sheet::rectangle(1, 7, 1.0, 1.0).is_err() && Sheet::rectangle(3, 3, f64::NAN, 1.0).is_err());
    }

    #[test]
    fn a_disc_is_nearly_round() {
        let sheet = Sheet::disc(41, 0.15).unwrap();
        let all: f64 = sheet.triangles.iter().map(|t| sheet.area_m2(*t)).sum();
        let round = std::f64::consts::PI * 0.15 * 0.15;
        assert!((all / round - 1.0).abs() < 0.01, "{}", all / round);
        assert!(sheet.uv.iter().all(|p| p[0].hypot(p[1]) <= 0.15 + 1e-12));
        assert!(sheet.triangles.iter().all(|t| sheet.area_m2(*t) > 0.0));
        assert!(Sheet::disc(40, 0.15).is_err() && Sheet::disc(41, 0.0).is_err());
    }
}
