use crate::force::View;
use crate::layout::{Layout, read};
use crate::math::sqrt;
use crate::{Cloth, Grid, in_default_environment};

/// Strain of the structural springs: (length - rest length) / rest length.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Strain {
    /// Largest over all structural springs.
    pub largest: f32,
    /// Mean over all structural springs.
    pub mean: f32,
}

impl Cloth<'_> {
    /// Strain of the structural springs as they are now. O(particles).
    pub fn strain(&self) -> Strain {
        in_default_environment(|| self.measure_strain())
    }

    fn measure_strain(&self) -> Strain {
        let mut sum = 0.0f64;
        let mut largest = f32::NEG_INFINITY;
        let mut count = 0u32;
        each_structural(self.grid(), &self.layout, self.x.view(), |_, _, strain| {
            sum += f64::from(strain);
            largest = crate::math::max(strain, largest);
            count += 1;
        });
        Strain { largest, mean: (sum / f64::from(count)) as f32 }
    }

    /// Calls `visit(a, b, strain)` for every structural spring between the particles a and b: of each row first those
    /// along u, then those along v.
    pub fn each_structural_strain(&self, visit: impl FnMut(usize, usize, f32)) {
        in_default_environment(|| each_structural(self.grid(), &self.layout, self.x.view(), visit));
    }
}

fn each_structural(grid: &Grid, l: &Layout, p: View<'_>, mut visit: impl FnMut(usize, usize, f32)) {
    let strain = |a: usize, b: usize, rest: f32| {
        let (dx, dy, dz) = (read(p.x, b) - read(p.x, a), read(p.y, b) - read(p.y, a), read(p.z, b) - read(p.z, a));
        sqrt(dx * dx + dy * dy + dz * dz) / rest - 1.0
    };
    let (rest_u, rest_v) = (grid.rest_u(), grid.rest_v());
    for row in 0..l.rows {
        for column in 0..l.columns {
            let (a, i) = (l.at(row, column), row * l.columns + column);
            if column + 1 < l.columns {
                visit(i, i + 1, strain(a, a + 1, rest_u));
            }
            if row + 1 < l.rows {
                visit(i, i + l.columns, strain(a, a + l.stride, rest_v));
            }
        }
    }
}
