use super::ClothError;

/// Channel of the structural springs along v (the columns).
pub const WARP: usize = 0;
/// Channel of the structural springs along u (the rows).
pub const WEFT: usize = 1;
/// Channel of the springs along both diagonals.
pub const SHEAR: usize = 2;
/// Channel of the springs to the particles two cells away.
pub const BEND: usize = 3;
/// Number of channels of a stiffness field.
pub const CHANNELS: usize = 4;

/// One spring of the flat sheet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spring {
    /// The end with the smaller index.
    pub a: usize,
    /// The end with the larger index.
    pub b: usize,
    /// [`WARP`], [`WEFT`], [`SHEAR`] or [`BEND`].
    pub channel: usize,
    /// Rest length in m.
    pub rest_m: f64,
    /// Unit direction (u, v) in the flat sheet.
    pub direction: [f64; 2],
}

/// The spring network of a grid (paper, eq. 1): structural springs to the four neighbours, shear springs to the four
/// diagonal neighbours, bend springs to the particles two cells away. The flat sheet is the rest shape.
#[derive(Clone, Debug, PartialEq)]
pub struct Springs {
    rows: usize,
    columns: usize,
    width_m: f64,
    height_m: f64,
    list: Vec<Spring>,
}

impl Springs {
    /// The network of `rows` x `columns` particles (2 to 4096 each), `width_m` along u and `height_m` along v (above 0,
    /// at most 10,000 m). Errors: [`ClothError::GridSize`], [`ClothError::OutOfRange`].
    pub fn new(rows: usize, columns: usize, width_m: f64, height_m: f64) -> Result<Springs, ClothError> {
        let side = |n: usize| (2..=4096).contains(&n);
        if !side(rows) || !side(columns) {
            return Err(ClothError::GridSize { rows, columns });
        }
        for (what, value) in [("width in m", width_m), ("height in m", height_m)] {
            if !(value > 0.0 && value <= 10_000.0) {
                return Err(ClothError::OutOfRange { what, value });
            }
        }
        let mut springs = Springs { rows, columns, width_m, height_m, list: Vec::new() };
        for row in 0..rows {
            for column in 0..columns {
                springs.add(row, column, 0, 1, WEFT);
                springs.add(row, column, 1, 0, WARP);
                springs.add(row, column, 1, 1, SHEAR);
                springs.add(row, column, 1, -1, SHEAR);
                springs.add(row, column, 0, 2, BEND);
                springs.add(row, column, 2, 0, BEND);
            }
        }
        Ok(springs)
    }

    /// Adds the spring from (row, column) by (down, right) cells where its other end exists.
    fn add(&mut self, row: usize, column: usize, down: usize, right: isize, channel: usize) {
        let Some(to) = column.checked_add_signed(right).filter(|&c| c < self.columns && row + down < self.rows) else {
            return;
        };
        let (u, v) = (right as f64 * self.rest_u_m(), down as f64 * self.rest_v_m());
        let rest_m = u.hypot(v);
        self.list.push(Spring {
            a: row * self.columns + column,
            b: (row + down) * self.columns + to,
            channel,
            rest_m,
            direction: [u / rest_m, v / rest_m],
        });
    }

    /// Particles along v.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Particles along u.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Number of particles.
    pub fn particles(&self) -> usize {
        self.rows * self.columns
    }

    /// Side length along u in m.
    pub fn width_m(&self) -> f64 {
        self.width_m
    }

    /// Side length along v in m.
    pub fn height_m(&self) -> f64 {
        self.height_m
    }

    /// Rest length of the weft springs in m.
    pub fn rest_u_m(&self) -> f64 {
        self.width_m / (self.columns - 1) as f64
    }

    /// Rest length of the warp springs in m.
    pub fn rest_v_m(&self) -> f64 {
        self.height_m / (self.rows - 1) as f64
    }

    /// All springs, in a fixed order.
    pub fn list(&self) -> &[Spring] {
        &self.list
    }

    /// Place (u, v) in m of a particle in the flat sheet; row 0 has v = 0.
    pub fn flat(&self, particle: usize) -> [f64; 2] {
        let (row, column) = (particle / self.columns, particle % self.columns);
        [column as f64 * self.rest_u_m(), row as f64 * self.rest_v_m()]
    }

    /// World position in m of a particle of the flat sheet that hangs vertically from row 0: (u, -v, 0).
    pub fn hung_flat(&self, particle: usize) -> [f64; 3] {
        let [u, v] = self.flat(particle);
        [u, -v, 0.0]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_and_lengths() {
        let s = Springs::new(3, 4, 3.0, 4.0).unwrap();
        let count = |c| s.list().iter().filter(|s| s.channel == c).count();
        assert_eq!([count(WARP), count(WEFT), count(SHEAR), count(BEND)], [8, 9, 12, 10]);
        for spring in s.list() {
            assert!(spring.a < spring.b && spring.b < 12);
            let [p, q] = [s.flat(spring.a), s.flat(spring.b)];
            assert!(((q[0] - p[0]).hypot(q[1] - p[1]) - spring.rest_m).abs() < 1e-15);
        }
        assert_eq!(s.list().iter().find(|s| s.channel == WARP).unwrap().rest_m, 2.0);
        assert_eq!(s.hung_flat(11), [3.0, -4.0, 0.0]);
    }

    #[test]
    fn refuses_bad_grids() {
        assert!(matches!(Springs::new(1, 1, 1.0, 1.0), Err(ClothError::GridSize { .. })));
        assert!(matches!(Springs::new(70_000, 2, 1.0, 1.0), Err(ClothError::GridSize { .. })));
        assert!(matches!(Springs::new(2, 2, f64::NAN, 1.0), Err(ClothError::OutOfRange { .. })));
        assert!(matches!(Springs::new(2, 2, 1.0, 0.0), Err(ClothError::OutOfRange { .. })));
    }
}
