//! The preconditioner: the inverses of the 3 x 3 diagonal blocks of the operator.

use crate::layout::Layout;
use crate::math::max;
use crate::simd::{Pass, Vector};

/// Share of its trace that is added to the diagonal of a block. A block is far stiffer along the sheet than across it;
/// below this ratio its smallest eigenvalue is lost in the rounding of the others.
const SHARE: f32 = 1e-5;

/// Inverts the blocks in place. Blocks of pinned particles and spare places (`mass` 0) become 0, which keeps them out of the
/// search: the filter of Baraff and Witkin.
///
/// Plain loops: the compiler makes vectors of the width of them.
pub(super) struct Invert<'p, 'a> {
    pub l: &'p Layout,
    pub mass: &'p [f32],
    pub blocks: &'p mut [&'a mut [f32]; 6],
}

impl Pass for Invert<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self, _: V) {
        for row in 0..self.l.rows {
            invert_row(self.l, row, self.mass, self.blocks);
        }
    }
}

#[inline(always)]
fn invert_row(l: &Layout, row: usize, mass: &[f32], blocks: &mut [&mut [f32]; 6]) {
    let at = l.row(row);
    let [xx, yy, zz, xy, xz, yz] = blocks.each_mut().map(|p| p.get_mut(at..at + l.width).unwrap_or(&mut []));
    let mass = crate::layout::span(mass, at, l.width);
    for (((((xx, yy), zz), xy), xz), (yz, m)) in
        xx.iter_mut().zip(yy).zip(zz).zip(xy).zip(xz).zip(yz.iter_mut().zip(mass))
    {
        let block = inverse([*xx, *yy, *zz, *xy, *xz, *yz]);
        // chosen, not multiplied: an empty block has no finite inverse
        let [a, b, c, d, e, f] = block.map(|x| if *m > 0.0 { x } else { 0.0 });
        (*xx, *yy, *zz) = (a, b, c);
        (*xy, *xz, *yz) = (d, e, f);
    }
}

/// The inverse of a block, with [`SHARE`] of its trace on the diagonal; finite for every block that is not 0.
#[inline(always)]
pub(super) fn inverse([xx, yy, zz, xy, xz, yz]: [f32; 6]) -> [f32; 6] {
    // scaled by the trace, so that nothing overflows
    let scale = 1.0 / max(xx + yy + zz, f32::MIN_POSITIVE);
    let (a, b, c) = (xx * scale + SHARE, yy * scale + SHARE, zz * scale + SHARE);
    let (d, e, f) = (xy * scale, xz * scale, yz * scale);
    let (ca, cb, cc) = (b * c - f * f, a * c - e * e, a * b - d * d);
    let (cd, ce, cf) = (e * f - d * c, d * f - e * b, d * e - a * f);
    let s = scale / (a * ca + d * cd + e * ce);
    [ca * s, cb * s, cc * s, cd * s, ce * s, cf * s]
}
