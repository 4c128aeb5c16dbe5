//! The cloth that a panel shows: positions of a grid, its rest size and its pins.

use super::error::PictureError;
use super::vector::{Vec3, add, cross, length, normalized, scale, sub};
use crate::scene::Solid;

/// Most rows and columns of a grid.
const MAX_SIDE: usize = 4096;

/// A `rows` x `columns` grid of particles as it hangs, and the rectangle that it is at rest.
///
/// Particle `row * columns + column`; u runs along a row (weft), v along a column (warp), row 0 is the top row.
#[derive(Debug, Clone, PartialEq)]
pub struct Grid {
    positions: Vec<Vec3>,
    rows: usize,
    columns: usize,
    width_m: f32,
    height_m: f32,
    pins: Vec<usize>,
    /// Whether each particle is there; empty where all are.
    present: Vec<bool>,
    solid: Option<Solid>,
}

impl Grid {
    /// A grid of positions in metres (finite or not) whose rest shape is `width_m` (u) x `height_m` (v).
    ///
    /// # Errors
    /// Fewer than two or more than 4096 rows or columns, another number of positions than `rows * columns`, a side
    /// length that is not positive and finite.
    pub fn new(
        positions: &[Vec3],
        rows: usize,
        columns: usize,
        width_m: f32,
        height_m: f32,
    ) -> Result<Self, PictureError> {
        if !(2..=MAX_SIDE).contains(&rows) || !(2..=MAX_SIDE).contains(&columns) {
            return Err(PictureError::Grid { rows, columns });
        }
        if positions.len() != rows * columns {
            return Err(PictureError::Positions { rows, columns, given: positions.len() });
        }
        if ![width_m, height_m].iter().all(|side| side.is_finite() && *side > 0.0) {
            return Err(PictureError::RestSize { width_m, height_m });
        }
        Ok(Self {
            positions: positions.to_vec(),
            rows,
            columns,
            width_m,
            height_m,
            pins: Vec::new(),
            present: Vec::new(),
            solid: None,
        })
    }

    /// The same grid with these particles marked as pinned.
    ///
    /// # Errors
    /// A pin that is no particle of the grid.
    pub fn with_pins(mut self, pins: &[usize]) -> Result<Self, PictureError> {
        let particles = self.positions.len();
        if let Some(&pin) = pins.iter().find(|&&pin| pin >= particles) {
            return Err(PictureError::Pin { pin, particles });
        }
        self.pins = pins.to_vec();
        Ok(self)
    }

    /// The same grid without the particles for which `present` is false: neither they nor what hangs on them is drawn.
    ///
    /// # Errors
    /// Another number of answers than particles.
    pub fn with_mask(mut self, present: &[bool]) -> Result<Self, PictureError> {
        if present.len() != self.positions.len() {
            let (rows, columns) = (self.rows, self.columns);
            return Err(PictureError::Positions { rows, columns, given: present.len() });
        }
        self.present = present.to_vec();
        Ok(self)
    }

    /// The same grid with what it lies on.
    #[must_use]
    pub fn with_solid(mut self, solid: Option<Solid>) -> Self {
        self.solid = solid;
        self
    }

    /// What it lies on.
    pub fn solid(&self) -> Option<Solid> {
        self.solid
    }

    /// Whether a particle is there.
    pub fn has(&self, row: usize, column: usize) -> bool {
        self.present.get(row * self.columns + column).copied().unwrap_or(true)
    }

    /// Positions of the particles that are there.
    pub fn present(&self) -> Vec<Vec3> {
        let there = |i: &usize| self.present.get(*i).copied().unwrap_or(true);
        (0..self.positions.len()).filter(there).map(|i| self.positions[i]).collect()
    }

    /// Positions, metres, row by row.
    pub fn positions(&self) -> &[Vec3] {
        &self.positions
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Number of columns.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Pinned particles.
    pub fn pins(&self) -> &[usize] {
        &self.pins
    }

    /// Position of a particle.
    pub fn at(&self, row: usize, column: usize) -> Vec3 {
        self.positions[row * self.columns + column]
    }

    /// Rest length of the edges along a row and along a column, metres.
    pub fn rest_m(&self) -> [f32; 2] {
        [self.width_m / (self.columns - 1) as f32, self.height_m / (self.rows - 1) as f32]
    }

    /// Diagonal of the rest shape, metres.
    pub fn diagonal_m(&self) -> f32 {
        self.width_m.hypot(self.height_m)
    }

    /// True when every coordinate of the particles that are there is a finite number.
    pub fn is_finite(&self) -> bool {
        self.present().iter().flatten().all(|v| v.is_finite())
    }

    /// Strain (1 = 100 %, negative when compressed) of the weft edge from `column` to the next one; 0 where it is not there.
    pub fn strain_u(&self, row: usize, column: usize) -> f32 {
        if !self.has(row, column) || !self.has(row, column + 1) {
            return 0.0;
        }
        length(sub(self.at(row, column + 1), self.at(row, column))) / self.rest_m()[0] - 1.0
    }

    /// Strain (1 = 100 %, negative when compressed) of the warp edge from `row` to the next one; 0 where it is not there.
    pub fn strain_v(&self, row: usize, column: usize) -> f32 {
        if !self.has(row, column) || !self.has(row + 1, column) {
            return 0.0;
        }
        length(sub(self.at(row + 1, column), self.at(row, column))) / self.rest_m()[1] - 1.0
    }

    /// Mean strain along u and along v of the edges that meet at each particle.
    pub fn particle_strains(&self) -> Vec<[f32; 2]> {
        let mean = |before: Option<f32>, after: Option<f32>| match (before, after) {
            (Some(a), Some(b)) => 0.5 * (a + b),
            (a, b) => a.or(b).unwrap_or(0.0),
        };
        (0..self.positions.len())
            .map(|particle| {
                let (row, column) = (particle / self.columns, particle % self.columns);
                [
                    mean(
                        (column > 0).then(|| self.strain_u(row, column - 1)),
                        (column + 1 < self.columns).then(|| self.strain_u(row, column)),
                    ),
                    mean(
                        (row > 0).then(|| self.strain_v(row - 1, column)),
                        (row + 1 < self.rows).then(|| self.strain_v(row, column)),
                    ),
                ]
            })
            .collect()
    }

    /// Mean of the four corners of the cell below and right of a particle.
    pub fn cell_center(&self, row: usize, column: usize) -> Vec3 {
        let top = add(self.at(row, column), self.at(row, column + 1));
        let bottom = add(self.at(row + 1, column), self.at(row + 1, column + 1));
        scale(add(top, bottom), 0.25)
    }

    /// Unit normals at the particles, by central differences; +z for a grid that hangs flat with u along +x, rows down.
    ///
    /// Where the cloth is degenerate (two neighbours in one place) the normal is +z.
    pub fn normals(&self) -> Vec<Vec3> {
        let (last_row, last_column) = (self.rows - 1, self.columns - 1);
        (0..self.positions.len())
            .map(|particle| {
                let (row, column) = (particle / self.columns, particle % self.columns);
                // a neighbour that is not there is the particle itself
                let near = |r: usize, c: usize| if self.has(r, c) { self.at(r, c) } else { self.at(row, column) };
                let right = near(row, (column + 1).min(last_column));
                let left = near(row, column.saturating_sub(1));
                let below = near((row + 1).min(last_row), column);
                let above = near(row.saturating_sub(1), column);
                normalized(cross(sub(right, left), sub(above, below))).unwrap_or([0.0, 0.0, 1.0])
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn flat(stretch: f32) -> Vec<Vec3> {
        (0..12).map(|i| [(i % 4) as f32 * 0.1 * stretch, (i / 4) as f32 * -0.2, 0.0]).collect()
    }

    #[test]
    fn strains_and_normals_of_a_flat_grid() {
        let grid = Grid::new(&flat(1.1), 3, 4, 0.3, 0.4).expect("a grid");
        assert!((grid.strain_u(2, 2) - 0.1).abs() < 1e-5);
        assert!(grid.strain_v(1, 3).abs() < 1e-5);
        assert!(grid.particle_strains().iter().all(|[u, v]| (u - 0.1).abs() < 1e-5 && v.abs() < 1e-5));
        assert!(grid.normals().iter().all(|n| (n[2] - 1.0).abs() < 1e-6));
    }

    #[test]
    fn bad_grids_are_named() {
        let positions = flat(1.0);
        let message = |result: Result<Grid, PictureError>| result.expect_err("refused").to_string();
        assert!(message(Grid::new(&positions, 1, 12, 1.0, 1.0)).contains("1 x 12"));
        assert!(message(Grid::new(&positions, 2, 70_000, 1.0, 1.0)).contains("70000"));
        assert!(message(Grid::new(&positions, 4, 4, 1.0, 1.0)).contains("16 positions, not 12"));
        for side in [0.0, -1.0, f32::NAN, f32::INFINITY] {
            assert!(message(Grid::new(&positions, 3, 4, side, 1.0)).contains("rest size"));
        }
        let grid = Grid::new(&positions, 3, 4, 0.3, 0.4).expect("a grid");
        assert!(message(grid.with_pins(&[0, 12])).contains("pin 12"));
    }

    #[test]
    fn absent_particles_count_for_nothing() {
        let mut positions = flat(1.1);
        positions[0] = [f32::NAN; 3];
        let mut present = [true; 12];
        present[0] = false;
        let grid = Grid::new(&positions, 3, 4, 0.3, 0.4).and_then(|g| g.with_mask(&present)).expect("a grid");
        assert!(grid.is_finite() && grid.present().len() == 11 && !grid.has(0, 0));
        assert_eq!((grid.strain_u(0, 0), grid.strain_v(0, 0)), (0.0, 0.0));
        assert!((grid.strain_u(0, 1) - 0.1).abs() < 1e-5);
        assert!(grid.normals().iter().skip(1).all(|n| (n[2] - 1.0).abs() < 1e-6));
        let short = Grid::new(&positions, 3, 4, 0.3, 0.4).and_then(|g| g.with_mask(&[true]));
        assert!(short.is_err());
    }

    #[test]
    fn a_collapsed_grid_has_normals_still() {
        let grid = Grid::new(&[[0.0; 3]; 4], 2, 2, 1.0, 1.0).expect("a grid");
        assert_eq!(grid.normals(), vec![[0.0, 0.0, 1.0]; 4]);
    }
}
