//! The grid as a renderer sees it: triangles and texture coordinates.

use crate::{Error, Grid};

impl Grid {
    /// Number of triangles: two in each cell.
    pub fn triangle_count(&self) -> usize {
        2 * (self.rows() - 1) * (self.columns() - 1)
    }

    /// The triangles as particle indices, cell after cell along the rows. The front, where the corners run
    /// counterclockwise, is the side from which u runs to the right and v runs down, as a picture is looked at; there
    /// the normals of [`crate::Cloth::normal`] point. Each cell is cut from its lower left to its upper right corner.
    pub fn triangles(&self) -> impl Iterator<Item = [u32; 3]> {
        let (rows, columns) = (self.def().rows, self.def().columns);
        (0..rows - 1).flat_map(move |row| {
            (0..columns - 1).flat_map(move |column| {
                let upper = row * columns + column;
                let lower = upper + columns;
                [[upper, lower, upper + 1], [upper + 1, lower, lower + 1]]
            })
        })
    }

    /// Texture coordinates of a particle, 0 to 1: (0, 0) at particle 0, u along the columns, v along the rows.
    ///
    /// Error: [`Error::NoSuchParticle`].
    pub fn uv(&self, particle: usize) -> Result<[f32; 2], Error> {
        if particle >= self.particles() {
            return Err(Error::NoSuchParticle);
        }
        // max: a grid has columns, but only so does the compiler know that nothing is divided by zero
        let columns = self.columns().max(1);
        let (row, column) = (particle / columns, particle % columns);
        Ok([column as f32 / (self.def().columns - 1) as f32, row as f32 / (self.def().rows - 1) as f32])
    }
}
