//! The box that a renderer culls by.

use crate::layout::read;
use crate::mask::is_absent;
use crate::math::{max, min};
use crate::{Cloth, Vector3};

/// A box with sides along the axes, in the world in m. Every particle that is there lies in it, and each of its
/// sides touches one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Smallest x, y and z in m.
    pub low_m: [f64; 3],
    /// Largest x, y and z in m.
    pub high_m: [f64; 3],
}

impl Cloth<'_> {
    /// The box around all particles. O(particles).
    pub fn bounds(&self) -> Bounds {
        let l = self.layout;
        let (mut low, mut high) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
        for (axis, plane) in [&*self.x.x, &*self.x.y, &*self.x.z].into_iter().enumerate() {
            for row in 0..l.rows {
                for column in 0..l.columns {
                    if is_absent(self.mask, l.at(row, column)) {
                        continue;
                    }
                    let x = read(plane, l.at(row, column));
                    low[axis] = min(x, low[axis]);
                    high[axis] = max(x, high[axis]);
                }
            }
        }
        // the sum that `world_position` forms: it rounds all positions alike, so none falls out of the box
        let world = |p: [f32; 3]| (Vector3::from(p).cast::<f64>() + Vector3::from(self.frame.position)).into();
        Bounds { low_m: world(low), high_m: world(high) }
    }
}
