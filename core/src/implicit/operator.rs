//! The operator of the conjugate gradients, A = M (1 + b c) + b^2 H, and the right side.
//!
//! A spring of stiffness k, length l and direction n has H = k (n n^T + a (1 - n n^T)), a = 1 - L0/l. Where it is
//! compressed a is negative and H indefinite; a is taken as 0 there (Choi and Ko 2002), which makes A positive definite for
//! every shape. With d = l n this is alpha + gamma d d^T, alpha = k a, gamma = (k - alpha) / l^2: two numbers a spring,
//! kept while the shape is; the vectors d come from the positions.

use crate::Error;
use crate::force::{Planes, Springs, Substep, View};
use crate::lanes::{LANES, Lanes};
use crate::layout::{Layout, span, take};
use crate::math::{max, sqrt};

/// A spring shorter than this share of its rest length is linearised as if it had this length.
const SHORTEST: f32 = 1e-3;

/// Springs linearised at a shape. The planes are ordered as in [`Springs`]; those of a family that is off are empty.
pub(super) struct Linear<'a> {
    /// M (1 + b c) in kg, 0 for pinned ones and spare places.
    pub mass: &'a mut [f32],
    /// 1 for free particles, 0 for the others.
    pub free: &'a mut [f32],
    pub alpha: [&'a mut [f32]; 6],
    pub gamma: [&'a mut [f32]; 6],
}

impl<'a> Linear<'a> {
    pub fn new(l: &Layout, n: usize, block: &mut &'a mut [f32]) -> Result<Self, Error> {
        let six = |block: &mut &'a mut [f32]| -> Result<[&'a mut [f32]; 6], Error> {
            let (shear, bend) = (if l.shear { n } else { 0 }, if l.bend { n } else { 0 });
            Ok([
                take(block, n)?,
                take(block, n)?,
                take(block, shear)?,
                take(block, shear)?,
                take(block, bend)?,
                take(block, bend)?,
            ])
        };
        let (alpha, gamma) = (six(block)?, six(block)?);
        Ok(Linear { mass: take(block, n)?, free: take(block, n)?, alpha, gamma })
    }

    /// Linearises the springs at the shape `x`. `alpha` becomes the force per vector d in N/m, negative where a spring
    /// pushes: what [`residual_row`] needs. [`Linear::clamp`] makes it that of the operator.
    pub fn linearise(&mut self, l: &Layout, c: &Substep, x: View<'_>, k: &Springs<'_>) {
        let s = l.stride;
        let springs: [(&[f32], usize, f32); 6] = [
            (k.u, 1, c.rest_u),
            (k.v, s, c.rest_v),
            (k.right, s + 1, c.rest_diagonal),
            (k.left, s - 1, c.rest_diagonal),
            (k.bend_u, 2, 2.0 * c.rest_u),
            (k.bend_v, 2 * s, 2.0 * c.rest_v),
        ];
        for ((alpha, gamma), (k, to, rest)) in self.alpha.iter_mut().zip(&mut self.gamma).zip(springs) {
            for row in 0..l.rows {
                spring_row(l, row, to, rest, c.floor, x, k, alpha, gamma);
            }
        }
    }

    /// Makes `alpha` and `gamma` those of b^2 H, positive.
    pub fn clamp(&mut self, l: &Layout, b: f32) {
        let b2 = b * b;
        for plane in self.alpha.iter_mut().chain(&mut self.gamma) {
            for row in 0..l.rows {
                let at = l.row(row);
                for x in plane.get_mut(at..at + l.width).unwrap_or(&mut []) {
                    *x = max(*x, 0.0) * b2;
                }
            }
        }
    }
}

#[inline(never)]
#[allow(clippy::too_many_arguments)]
fn spring_row(
    l: &Layout,
    row: usize,
    to: usize,
    rest: f32,
    floor: f32,
    x: View<'_>,
    k: &[f32],
    alpha: &mut [f32],
    gamma: &mut [f32],
) {
    let (at, n) = (l.row(row), l.width);
    let ends = [x.x, x.y, x.z].map(|p| span(p, at, n).iter().zip(span(p, at + to, n)));
    let [ex, ey, ez] = ends;
    let (Some(alpha), Some(gamma)) = (alpha.get_mut(at..at + n), gamma.get_mut(at..at + n)) else {
        return;
    };
    let least = SHORTEST * rest * (SHORTEST * rest) + 1e-28;
    let to = alpha.iter_mut().zip(gamma);
    for ((((a, g), k), (x0, x1)), ((y0, y1), (z0, z1))) in to.zip(span(k, at, n)).zip(ex).zip(ey.zip(ez)) {
        let (dx, dy, dz) = (x1 - x0, y1 - y0, z1 - z0);
        let l2 = max(dx * dx + dy * dy + dz * dz, least);
        let factor = max(1.0 - rest / sqrt(l2), floor);
        *a = k * factor;
        *g = k * (1.0 - max(factor, 0.0)) / l2;
    }
}

/// Cuts the rows that the loops below walk along: exactly n / LANES blocks each, or the function ends.
macro_rules! rows {
    ($l:expr, $row:expr; $($name:ident = $plane:expr, $offset:expr;)*) => {
        $(
            let $name = span($plane, $l.row($row).wrapping_add_signed($offset), $l.width).as_chunks::<LANES>().0;
            if $name.len() != $l.width / LANES {
                return;
            }
        )*
    };
}

macro_rules! rows_mut {
    ($l:expr, $row:expr; $($name:ident = $plane:expr;)*) => {
        $(
            let at = $l.row($row);
            let Some($name) = $plane.get_mut(at..at.wrapping_add($l.width)) else {
                return;
            };
            let $name = $name.as_chunks_mut::<LANES>().0;
            if $name.len() != $l.width / LANES {
                return;
            }
        )*
    };
}

/// The rows of one plane that the springs of a row reach.
macro_rules! around {
    ($l:expr, $row:expr, $plane:expr) => {{
        let s = $l.stride as isize;
        rows! { $l, $row;
            here = $plane, 0;
            r1 = $plane, 1; l1 = $plane, -1; d1 = $plane, s; u1 = $plane, -s;
            dr = $plane, s + 1; ul = $plane, -s - 1; dl = $plane, s - 1; ur = $plane, -s + 1;
            r2 = $plane, 2; l2 = $plane, -2; d2 = $plane, 2 * s; u2 = $plane, -2 * s;
        }
        [here, r1, l1, d1, u1, dr, ul, dl, ur, r2, l2, d2, u2]
    }};
}

/// The numbers of the twelve springs of the particles of a row, those of a family that is off replaced by `$spare`.
macro_rules! springs {
    ($l:expr, $row:expr, $planes:expr, $shear:expr, $bend:expr) => {{
        let s = $l.stride as isize;
        let [u, v, right, left, bend_u, bend_v] = $planes;
        let (right, left) = if $shear { (right, left) } else { (u, u) };
        let (bend_u, bend_v) = if $bend { (bend_u, bend_v) } else { (u, u) };
        rows! { $l, $row;
            r1 = u, 0; l1 = u, -1; d1 = v, 0; u1 = v, -s;
            dr = right, 0; ul = right, -s - 1; dl = left, 0; ur = left, -s + 1;
            r2 = bend_u, 0; l2 = bend_u, -2; d2 = bend_v, 0; u2 = bend_v, -2 * s;
        }
        [r1, l1, d1, u1, dr, ul, dl, ur, r2, l2, d2, u2]
    }};
}

/// One row of image = A search.
#[inline(never)]
pub(super) fn apply_row<const SHEAR: bool, const BEND: bool>(
    l: &Layout,
    row: usize,
    x: View<'_>,
    linear: &Linear<'_>,
    search: View<'_>,
    image: &mut Planes<'_>,
) {
    let (x, y, z) = (around!(l, row, x.x), around!(l, row, x.y), around!(l, row, x.z));
    let (px, py, pz) = (around!(l, row, search.x), around!(l, row, search.y), around!(l, row, search.z));
    let alpha = springs!(l, row, linear.alpha.each_ref().map(|p| &**p), SHEAR, BEND);
    let gamma = springs!(l, row, linear.gamma.each_ref().map(|p| &**p), SHEAR, BEND);
    rows! { l, row; mass = linear.mass, 0; free = linear.free, 0; }
    rows_mut! { l, row; qx = image.x; qy = image.y; qz = image.z; }
    for i in 0..l.width / LANES {
        let load = |r: &[[f32; LANES]]| Lanes(r[i]);
        let m = load(mass);
        let (x0, y0, z0) = (load(x[0]), load(y[0]), load(z[0]));
        let (px0, py0, pz0) = (load(px[0]), load(py[0]), load(pz[0]));
        let (mut ax, mut ay, mut az) = (m * px0, m * py0, m * pz0);
        macro_rules! spring {
            ($($j:literal)*) => {$(
                let (dx, dy, dz) = (x0 - load(x[$j]), y0 - load(y[$j]), z0 - load(z[$j]));
                let (ex, ey, ez) = (px0 - load(px[$j]), py0 - load(py[$j]), pz0 - load(pz[$j]));
                let a = load(alpha[$j - 1]);
                let along = load(gamma[$j - 1]) * (dx * ex + dy * ey + dz * ez);
                ax = ax + (a * ex + along * dx);
                ay = ay + (a * ey + along * dy);
                az = az + (a * ez + along * dz);
            )*};
        }
        spring!(1 2 3 4);
        if SHEAR {
            spring!(5 6 7 8);
        }
        if BEND {
            spring!(9 10 11 12);
        }
        let free = load(free);
        (qx[i], qy[i], qz[i]) = ((free * ax).0, (free * ay).0, (free * az).0);
    }
}

/// One row of the right side b F - M (1 + b c) (v - known), known = v_bar / (1 + b c), for the shape x; 0 where nothing is
/// free. `outer` are the forces beside springs and weight, in N, none where they are empty.
#[inline(never)]
#[allow(clippy::too_many_arguments)]
pub(super) fn residual_row<const SHEAR: bool, const BEND: bool>(
    l: &Layout,
    row: usize,
    b: f32,
    weight: [f32; 3],
    x: View<'_>,
    v: View<'_>,
    known: View<'_>,
    linear: &Linear<'_>,
    outer: [&[f32]; 3],
    residual: &mut Planes<'_>,
) {
    let (x, y, z) = (around!(l, row, x.x), around!(l, row, x.y), around!(l, row, x.z));
    let alpha = springs!(l, row, linear.alpha.each_ref().map(|p| &**p), SHEAR, BEND);
    rows! { l, row; mass = linear.mass, 0; free = linear.free, 0; }
    let has_outer = !outer[0].is_empty();
    let [ox, oy, oz] = if has_outer { outer } else { [&*linear.mass; 3] };
    rows! { l, row; ox = ox, 0; oy = oy, 0; oz = oz, 0; }
    rows! { l, row; vx = v.x, 0; vy = v.y, 0; vz = v.z, 0; kx = known.x, 0; ky = known.y, 0; kz = known.z, 0; }
    rows_mut! { l, row; rx = residual.x; ry = residual.y; rz = residual.z; }
    let (b, weight) = (Lanes::all(b), weight.map(Lanes::all));
    for i in 0..l.width / LANES {
        let load = |r: &[[f32; LANES]]| Lanes(r[i]);
        let (x0, y0, z0) = (load(x[0]), load(y[0]), load(z[0]));
        let zero = Lanes::all(0.0);
        let (mut fx, mut fy, mut fz) = (zero, zero, zero);
        macro_rules! spring {
            ($($j:literal)*) => {$(
                let a = load(alpha[$j - 1]);
                fx = fx + a * (load(x[$j]) - x0);
                fy = fy + a * (load(y[$j]) - y0);
                fz = fz + a * (load(z[$j]) - z0);
            )*};
        }
        spring!(1 2 3 4);
        if SHEAR {
            spring!(5 6 7 8);
        }
        if BEND {
            spring!(9 10 11 12);
        }
        (fx, fy, fz) = (fx + weight[0], fy + weight[1], fz + weight[2]);
        if has_outer {
            (fx, fy, fz) = (fx + load(ox), fy + load(oy), fz + load(oz));
        }
        let (m, free) = (load(mass), load(free));
        rx[i] = (free * (b * fx) - m * (load(vx) - load(kx))).0;
        ry[i] = (free * (b * fy) - m * (load(vy) - load(ky))).0;
        rz[i] = (free * (b * fz) - m * (load(vz) - load(kz))).0;
    }
}

/// One row of the diagonal blocks of A: xx, yy, zz, xy, xz, yz.
#[inline(never)]
pub(super) fn diagonal_row<const SHEAR: bool, const BEND: bool>(
    l: &Layout,
    row: usize,
    x: View<'_>,
    linear: &Linear<'_>,
    blocks: &mut [&mut [f32]; 6],
) {
    let (x, y, z) = (around!(l, row, x.x), around!(l, row, x.y), around!(l, row, x.z));
    let alpha = springs!(l, row, linear.alpha.each_ref().map(|p| &**p), SHEAR, BEND);
    let gamma = springs!(l, row, linear.gamma.each_ref().map(|p| &**p), SHEAR, BEND);
    rows! { l, row; mass = linear.mass, 0; }
    let [xx, yy, zz, xy, xz, yz] = blocks;
    rows_mut! { l, row; xx = xx; yy = yy; zz = zz; xy = xy; xz = xz; yz = yz; }
    for i in 0..l.width / LANES {
        let load = |r: &[[f32; LANES]]| Lanes(r[i]);
        let (x0, y0, z0) = (load(x[0]), load(y[0]), load(z[0]));
        let zero = Lanes::all(0.0);
        let (mut a, mut sum) = (load(mass), [zero; 6]);
        macro_rules! spring {
            ($($j:literal)*) => {$(
                let (dx, dy, dz) = (load(x[$j]) - x0, load(y[$j]) - y0, load(z[$j]) - z0);
                let g = load(gamma[$j - 1]);
                let (gx, gy, gz) = (g * dx, g * dy, g * dz);
                a = a + load(alpha[$j - 1]);
                let parts = [gx * dx, gy * dy, gz * dz, gx * dy, gx * dz, gy * dz];
                for (sum, part) in sum.iter_mut().zip(parts) {
                    *sum = *sum + part;
                }
            )*};
        }
        spring!(1 2 3 4);
        if SHEAR {
            spring!(5 6 7 8);
        }
        if BEND {
            spring!(9 10 11 12);
        }
        (xx[i], yy[i], zz[i]) = ((sum[0] + a).0, (sum[1] + a).0, (sum[2] + a).0);
        (xy[i], xz[i], yz[i]) = (sum[3].0, sum[4].0, sum[5].0);
    }
}
