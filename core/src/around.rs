//! What lies around the particles of a block: looked up once a block, so that nothing is checked for each vector.

use crate::force::View;
use crate::layout::block;
use crate::simd::{Three, Vector};

/// Particles of a row that are worked on at a time.
pub(crate) const LANES: usize = 16;

/// The numbers of a plane at [`LANES`] particles of a row and at what their terms reach.
pub(crate) struct Around<'a> {
    here: &'a [f32; LANES + 4],
    above: [&'a [f32; LANES + 2]; 2],
    far: [&'a [f32; LANES]; 2],
}

impl<'a> Around<'a> {
    /// None where the plane ends before.
    #[inline(always)]
    pub fn new(plane: &'a [f32], at: usize, stride: usize) -> Option<Around<'a>> {
        Some(Around {
            here: block(plane, at.wrapping_sub(2))?,
            above: [block(plane, at.wrapping_sub(stride + 1))?, block(plane, at.wrapping_add(stride - 1))?],
            far: [block(plane, at.wrapping_sub(2 * stride))?, block(plane, at.wrapping_add(2 * stride))?],
        })
    }

    /// Those of the particles two to the left of a lane to two to the right.
    #[inline(always)]
    pub fn row<V: Vector>(&self, zero: V, lane: usize) -> [V; 5] {
        let at = |by| lane.wrapping_add(by);
        let row = self.here;
        [
            zero.read(row, at(0)),
            zero.read(row, at(1)),
            zero.read(row, at(2)),
            zero.read(row, at(3)),
            zero.read(row, at(4)),
        ]
    }

    /// Those of the rows above and below, so many columns from a lane.
    #[inline(always)]
    pub fn beside<V: Vector>(&self, zero: V, lane: usize, by: isize) -> [V; 2] {
        let ([above, below], at) = (self.above, lane.wrapping_add_signed(by + 1));
        [zero.read(above, at), zero.read(below, at)]
    }

    /// The other end of a spring of the particles from a lane on, in the order of the sums: 1 right, 2 left, 3 below, 4 above, 5
    /// lower right, 6 upper left, 7 lower left, 8 upper right, 9 to 12 as 1 to 4 two on. 0: the particles.
    #[inline(always)]
    pub fn other<V: Vector>(&self, zero: V, spring: usize, lane: usize) -> V {
        let at = |by| lane.wrapping_add(by);
        let ([above, below], [far_above, far_below], row) = (self.above, self.far, self.here);
        match spring {
            1 => zero.read(row, at(3)),
            2 => zero.read(row, at(1)),
            3 => zero.read(below, at(1)),
            4 => zero.read(above, at(1)),
            5 => zero.read(below, at(2)),
            6 => zero.read(above, at(0)),
            7 => zero.read(below, at(0)),
            8 => zero.read(above, at(2)),
            9 => zero.read(row, at(4)),
            10 => zero.read(row, at(0)),
            11 => zero.read(far_below, at(0)),
            12 => zero.read(far_above, at(0)),
            _ => zero.read(row, at(2)),
        }
    }

    /// Those two rows above and below.
    #[inline(always)]
    pub fn two_on<V: Vector>(&self, zero: V, lane: usize) -> [V; 2] {
        let [above, below] = self.far;
        [zero.read(above, lane), zero.read(below, lane)]
    }
}

/// The same of three planes.
pub(crate) struct Around3<'a>([Around<'a>; 3]);

impl<'a> Around3<'a> {
    /// None where a plane ends before.
    #[inline(always)]
    pub fn new(planes: View<'a>, at: usize, stride: usize) -> Option<Around3<'a>> {
        let View { x, y, z } = planes;
        Some(Around3([Around::new(x, at, stride)?, Around::new(y, at, stride)?, Around::new(z, at, stride)?]))
    }

    /// The particles from a lane on.
    #[inline(always)]
    pub fn here<V: Vector>(&self, zero: V, lane: usize) -> Three<V> {
        let [x, y, z] = &self.0;
        Three([x.other(zero, 0, lane), y.other(zero, 0, lane), z.other(zero, 0, lane)])
    }

    /// The other ends of their springs: [`Around::other`].
    #[inline(always)]
    pub fn other<V: Vector>(&self, zero: V, spring: usize, lane: usize) -> Three<V> {
        let [x, y, z] = &self.0;
        Three([x.other(zero, spring, lane), y.other(zero, spring, lane), z.other(zero, spring, lane)])
    }
}

/// The numbers of the twelve springs of the particles of a block, from six planes ordered as in [`crate::force::Springs`].
pub(crate) struct Twelve<'a> {
    u: &'a [f32; LANES + 1],
    v: [&'a [f32; LANES]; 2],
    /// To the lower right and from the upper left, to the lower left and from the upper right. None where shear is off.
    pub shear: Option<[&'a [f32; LANES]; 4]>,
    /// None where bend is off.
    pub bend: Option<Bend<'a>>,
}

/// Those of the bend springs.
pub(crate) struct Bend<'a> {
    u: &'a [f32; LANES + 2],
    v: [&'a [f32; LANES]; 2],
}

impl<'a> Twelve<'a> {
    /// None where a plane ends before.
    #[inline(always)]
    pub fn new(planes: [&'a [f32]; 6], at: usize, stride: usize) -> Option<Twelve<'a>> {
        let [u, v, right, left, bend_u, bend_v] = planes;
        let above = at.wrapping_sub(stride);
        let shear = || {
            let (upper_left, upper_right) = (above.wrapping_sub(1), above.wrapping_add(1));
            Some([block(right, at)?, block(right, upper_left)?, block(left, at)?, block(left, upper_right)?])
        };
        let bend = || {
            let v = [block(bend_v, at)?, block(bend_v, above.wrapping_sub(stride))?];
            Some(Bend { u: block(bend_u, at.wrapping_sub(2))?, v })
        };
        let u = block(u, at.wrapping_sub(1))?;
        Some(Twelve { u, v: [block(v, at)?, block(v, above)?], shear: shear(), bend: bend() })
    }

    /// Of the spring that is numbered as in [`Around::other`]; 0 where the family is off.
    #[inline(always)]
    pub fn read<V: Vector>(&self, zero: V, spring: usize, lane: usize) -> V {
        let shear = |i: usize| match &self.shear {
            Some(planes) => planes[i],
            None => &[0.0; LANES],
        };
        match (spring, &self.bend) {
            (1, _) => zero.read(self.u, lane.wrapping_add(1)),
            (2, _) => zero.read(self.u, lane),
            (3, _) => zero.read(self.v[0], lane),
            (4, _) => zero.read(self.v[1], lane),
            (5, _) => zero.read(shear(0), lane),
            (6, _) => zero.read(shear(1), lane),
            (7, _) => zero.read(shear(2), lane),
            (8, _) => zero.read(shear(3), lane),
            (9, Some(bend)) => zero.read(bend.u, lane.wrapping_add(2)),
            (10, Some(bend)) => zero.read(bend.u, lane),
            (11, Some(bend)) => zero.read(bend.v[0], lane),
            (12, Some(bend)) => zero.read(bend.v[1], lane),
            _ => zero,
        }
    }
}
