//! Normals of the sheet at the particles, for shading.

use crate::layout::read;
use crate::mask::is_absent;
use crate::math::{max, sqrt};
use crate::{Cloth, Error, Vector3};

impl Cloth<'_> {
    /// Unit normal at a particle: the mean of the normals of its one to four cells, weighted by their areas. That of a cell
    /// with the corners a b (above) and c d (below) is (d - a) x (b - c), twice its vector area, which does not depend on
    /// how the cell is cut into triangles. It points to the side from which u runs to the right and v runs down. Zero where
    /// the cells have no area, or one that f32 cannot hold; a cell with an absent corner does not count.
    ///
    /// Error: [`Error::NoSuchParticle`].
    pub fn normal(&self, particle: usize) -> Result<Vector3<f32>, Error> {
        self.layout.place(particle)?;
        // max: a grid has columns, but only so does the compiler know that nothing is divided by zero
        let columns = self.layout.columns.max(1);
        let (row, column) = (particle / columns, particle % columns);
        Ok(mean(self.cells(row, column), self.cells(row, column + 1)))
    }

    /// The normals of all particles in their order, with the bits of [`Cloth::normal`] at half the cost.
    pub fn normals(&self) -> impl Iterator<Item = Vector3<f32>> {
        (0..self.layout.rows).flat_map(move |row| {
            let mut left = self.cells(row, 0);
            (0..self.layout.columns).map(move |column| {
                let right = self.cells(row, column + 1);
                let normal = mean(left, right);
                left = right;
                normal
            })
        })
    }

    /// Twice the vector areas in m^2 of the cell above a row, and of that below it, both to the left of a column. Zero where
    /// there is none.
    fn cells(&self, row: usize, column: usize) -> [[f32; 3]; 2] {
        [self.cell(row, column), self.cell(row + 1, column)]
    }

    /// The same of the cell whose lower right corner is at (row, column).
    fn cell(&self, row: usize, column: usize) -> [f32; 3] {
        if row == 0 || column == 0 || row >= self.layout.rows || column >= self.layout.columns {
            return [0.0; 3];
        }
        let above = self.layout.at(row - 1, column - 1);
        let below = self.layout.at(row, column - 1);
        if [above, above + 1, below, below + 1].into_iter().any(|at| is_absent(self.mask, at)) {
            return [0.0; 3];
        }
        let ways = |p: &[f32]| (read(p, below + 1) - read(p, above), read(p, above + 1) - read(p, below));
        let ((px, qx), (py, qy), (pz, qz)) = (ways(self.x.x), ways(self.x.y), ways(self.x.z));
        [py * qz - pz * qy, pz * qx - px * qz, px * qy - py * qx]
    }
}

/// The direction of the sum: above left, above right, below left, below right.
fn mean(left: [[f32; 3]; 2], right: [[f32; 3]; 2]) -> Vector3<f32> {
    let mut sum = [0.0f32; 3];
    for cell in [left[0], right[0], left[1], right[1]] {
        for (s, a) in sum.iter_mut().zip(cell) {
            *s += a;
        }
    }
    unit(sum).into()
}

/// The vector at length 1, 0 if it has no direction.
fn unit(v: [f32; 3]) -> [f32; 3] {
    let largest = max(v[0].abs(), max(v[1].abs(), v[2].abs()));
    if largest == 0.0 || !v.iter().all(|x| x.is_finite()) {
        return [0.0; 3];
    }
    // elsewhere the squares are no f32: a cell may have 1e-20 m^2
    let v = if (1e-15..=1e15).contains(&largest) { v } else { v.map(|x| x / largest) };
    let length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    v.map(|x| x / length)
}
