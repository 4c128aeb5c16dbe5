//! Normals of the sheet at the particles, for shading.

use crate::layout::read;
use crate::math::{max, sqrt};
use crate::{Cloth, Error, Vector3};

impl Cloth<'_> {
    /// Unit normal at a particle: the mean of the normals of its one to four cells, weighted by their areas. That of a cell
    /// with the corners a b (above) and c d (below) is (d - a) x (b - c), twice its vector area, which does not depend on
    /// how the cell is cut into triangles. It points to the side from which u runs to the right and v runs down. Zero where
    /// the cells have no area, or one that f32 cannot hold.
    ///
    /// Error: [`Error::NoSuchParticle`].
    pub fn normal(&self, particle: usize) -> Result<Vector3<f32>, Error> {
        self.layout.place(particle)?;
        // max: a grid has columns, but only so does the compiler know that nothing is divided by zero
        let columns = self.layout.columns.max(1);
        let (row, column) = (particle / columns, particle % columns);
        let mut sum = [0.0f32; 3];
        // the cells above left, above right, below left, below right, each by its upper left corner
        for (down, right) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            let (row, column) = (row + down, column + right);
            if row == 0 || column == 0 || row >= self.layout.rows || column >= self.layout.columns {
                continue;
            }
            let area = self.cell(self.layout.at(row - 1, column - 1));
            for (s, a) in sum.iter_mut().zip(area) {
                *s += a;
            }
        }
        Ok(unit(sum).into())
    }

    /// Twice the vector area of the cell whose upper left corner is at a place, in m^2.
    fn cell(&self, at: usize) -> [f32; 3] {
        let below = at + self.layout.stride;
        let way = |plane: &[f32]| (read(plane, below + 1) - read(plane, at), read(plane, at + 1) - read(plane, below));
        let ((px, qx), (py, qy), (pz, qz)) = (way(self.x.x), way(self.x.y), way(self.x.z));
        [py * qz - pz * qy, pz * qx - px * qz, px * qy - py * qx]
    }
}

/// The vector at length 1. Scaled by its largest number first: squares of areas of 1e-20 m^2 are no f32.
fn unit(v: [f32; 3]) -> [f32; 3] {
    let largest = max(v[0].abs(), max(v[1].abs(), v[2].abs()));
    if largest == 0.0 || !v.iter().all(|x| x.is_finite()) {
        return [0.0; 3];
    }
    let [x, y, z] = v.map(|x| x / largest);
    let length = sqrt(x * x + y * y + z * z);
    [x / length, y / length, z / length]
}
