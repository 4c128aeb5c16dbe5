//! The scene as the network sees it: how far each place of the cloth is from a pin.

use ndarray::Array2;

use crate::Error;

/// Distance to the nearest pin over the larger side, clipped to [0, 1], at `grid` x `grid` places
/// whose corners are the corners of the cloth; row 0 is the top row. All 1 when nothing is pinned.
///
/// Pins are (row, column) on a grid of `rows` x `columns` particles with sides of `width_m` (along
/// the columns) and `height_m` (along the rows). They may repeat, and all particles may be pinned:
/// the cost is `grid` * (pins + rows * `grid`). Errors: [`Error::GridSize`] (also for a `grid` below
/// 2), [`Error::SideLength`], [`Error::Pin`].
pub fn pin_distance(
    grid: usize,
    pins: &[(usize, usize)],
    [rows, columns]: [usize; 2],
    [width_m, height_m]: [f32; 2],
) -> Result<Array2<f32>, Error> {
    check_grid(rows, columns)?;
    check_grid(grid, grid)?;
    let length = |l: f32| l > 0.0 && l <= 10_000.0;
    if !length(width_m) || !length(height_m) {
        return Err(Error::SideLength { width_m, height_m });
    }
    if let Some(&(row, column)) = pins.iter().find(|p| p.0 >= rows || p.1 >= columns) {
        return Err(Error::Pin { row, column, rows, columns });
    }
    let larger = f64::from(width_m.max(height_m));
    // sides in units of the larger one
    let (width, height) = (f64::from(width_m) / larger, f64::from(height_m) / larger);
    let place = |i: usize, n: usize, side: f64| i as f64 / (n - 1) as f64 * side;

    // Separable, as the squared distance is a sum: first the nearest pin of each row along u, then
    // the nearest row. `along_u[column of the map]` holds (v of the row, squared distance along u).
    let mut pinned_rows: Vec<Vec<usize>> = vec![Vec::new(); rows];
    for &(row, column) in pins {
        pinned_rows[row].push(column);
    }
    let mut along_u: Vec<Vec<(f64, f64)>> = vec![Vec::new(); grid];
    for (row, pinned) in pinned_rows.iter().enumerate().filter(|(_, p)| !p.is_empty()) {
        let v = place(row, rows, height);
        for (j, nearest) in along_u.iter_mut().enumerate() {
            let u = place(j, grid, width);
            let squared = |&c: &usize| (place(c, columns, width) - u) * (place(c, columns, width) - u);
            nearest.push((v, pinned.iter().map(squared).fold(f64::INFINITY, f64::min)));
        }
    }
    Ok(Array2::from_shape_fn((grid, grid), |(i, j)| {
        let v = place(i, grid, height);
        let squared = along_u[j].iter().map(|&(row_v, du2)| (row_v - v) * (row_v - v) + du2);
        // infinite when nothing is pinned
        squared.fold(f64::INFINITY, f64::min).sqrt().min(1.0) as f32
    }))
}

/// Whether both sides have 2 to 4096 particles.
pub(crate) fn check_grid(rows: usize, columns: usize) -> Result<(), Error> {
    let side = |n| (2..=4096).contains(&n);
    if side(rows) && side(columns) { Ok(()) } else { Err(Error::GridSize { rows, columns }) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_pin_is_one_everywhere() {
        let map = pin_distance(32, &[], [10, 10], [1.0, 1.0]).unwrap();
        assert!(map.iter().all(|&d| d == 1.0));
    }

    #[test]
    fn hang2_by_hand() {
        let map = pin_distance(32, &[(0, 0), (0, 31)], [32, 32], [1.0, 1.0]).unwrap();
        assert_eq!((map[[0, 0]], map[[0, 31]]), (0.0, 0.0));
        assert!((map[[0, 1]] - 1.0 / 31.0).abs() < 1e-7);
        assert!((map[[31, 0]] - 1.0).abs() < 1e-7 && (map[[31, 31]] - 1.0).abs() < 1e-7);
        let mid = (15.0f32 / 31.0).hypot(10.0 / 31.0);
        assert!((map[[10, 15]] - mid).abs() < 1e-6 && (map[[10, 16]] - mid).abs() < 1e-6);
    }

    #[test]
    fn agrees_with_the_naive_sum() {
        let (rows, columns, sides) = (7, 19, [2.0f32, 0.5]);
        let pins: Vec<_> = (0..23).map(|i| (i * 5 % rows, i * 11 % columns)).collect();
        let map = pin_distance(32, &pins, [rows, columns], sides).unwrap();
        for ((i, j), &d) in map.indexed_iter() {
            let at = |r: f64, c: f64| (c * f64::from(sides[0]), r * f64::from(sides[1]));
            let (u, v) = at(i as f64 / 31.0, j as f64 / 31.0);
            let nearest = pins
                .iter()
                .map(|&(r, c)| at(r as f64 / (rows - 1) as f64, c as f64 / (columns - 1) as f64))
                .map(|(pu, pv)| (pu - u).hypot(pv - v) / 2.0)
                .fold(1.0, f64::min);
            assert!((f64::from(d) - nearest).abs() < 1e-6, "{i} {j}: {d} {nearest}");
        }
    }

    #[test]
    fn the_same_scene_looks_the_same_on_every_grid() {
        let a = pin_distance(32, &[(0, 0)], [2, 2], [1.0, 3.0]).unwrap();
        let b = pin_distance(32, &[(0, 0)], [4096, 100], [1.0, 3.0]).unwrap();
        assert_eq!(a, b);
    }

    #[test]
    fn everything_pinned_is_quick_and_near_zero() {
        let pins: Vec<_> = (0..512 * 512).map(|i| (i / 512, i % 512)).collect();
        let map = pin_distance(32, &pins, [512, 512], [1.0, 1.0]).unwrap();
        assert!(map.iter().all(|&d| d < 0.002));
    }

    #[test]
    fn refuses_bad_scenes() {
        let map = |pins: &[(usize, usize)], shape, sides| pin_distance(32, pins, shape, sides);
        assert!(matches!(map(&[], [1, 1], [1.0, 1.0]), Err(Error::GridSize { .. })));
        assert!(matches!(map(&[], [70_000, 2], [1.0, 1.0]), Err(Error::GridSize { .. })));
        for sides in [[0.0, 1.0], [1.0, f32::NAN], [f32::INFINITY, 1.0], [1.0, -1.0], [2e4, 1.0]] {
            assert!(matches!(map(&[], [2, 2], sides), Err(Error::SideLength { .. })));
        }
        let pin = Error::Pin { row: 0, column: 2, rows: 2, columns: 2 };
        assert_eq!(map(&[(1, 1), (0, 2)], [2, 2], [1.0, 1.0]), Err(pin));
    }
}
