use crate::layout::read;
use crate::mask::is_absent;
use crate::math::sqrt;
use crate::{Cloth, in_default_environment};

/// Strain of the structural springs: (length - rest length) / rest length, where the rest length is the scaled one
/// ([`Cloth::set_rest_scale`]). Springs of absent particles do not count; a cloth without springs has strain 0.
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
        each_structural(self, |_, _, strain| {
            sum += f64::from(strain);
            largest = crate::math::max(strain, largest);
            count += 1;
        });
        if count == 0 {
            return Strain::default();
        }
        Strain { largest, mean: (sum / f64::from(count)) as f32 }
    }

    /// Calls `visit(a, b, strain)` for every structural spring between the particles a and b: of each row first those
    /// along u, then those along v.
    pub fn each_structural_strain(&self, visit: impl FnMut(usize, usize, f32)) {
        in_default_environment(|| each_structural(self, visit));
    }
}

fn each_structural(cloth: &Cloth<'_>, mut visit: impl FnMut(usize, usize, f32)) {
    let (l, p, mask) = (&cloth.layout, cloth.x.view(), &*cloth.mask);
    let strain = |a: usize, b: usize, rest: f32| {
        let (dx, dy, dz) = (read(p.x, b) - read(p.x, a), read(p.y, b) - read(p.y, a), read(p.z, b) - read(p.z, a));
        sqrt(dx * dx + dy * dy + dz * dz) / rest - 1.0
    };
    let [scale_u, scale_v, _] = cloth.ambient.rest_scale();
    let (rest_u, rest_v) = (cloth.grid.rest_u() * scale_u, cloth.grid.rest_v() * scale_v);
    for row in 0..l.rows {
        for column in 0..l.columns {
            let (a, i) = (l.at(row, column), row * l.columns + column);
            if is_absent(mask, a) {
                continue;
            }
            if column + 1 < l.columns && !is_absent(mask, a + 1) {
                visit(i, i + 1, strain(a, a + 1, rest_u));
            }
            if row + 1 < l.rows && !is_absent(mask, a + l.stride) {
                visit(i, i + l.columns, strain(a, a + l.stride, rest_v));
            }
        }
    }
}
