//! The spring forces (eq. 1) and the velocity half of the substep (eq. 17), row by row.
//!
//! Each particle gathers its twelve springs in one fixed order, so that no sum depends on how the work is split. The loop
//! is plain arithmetic over rows, which the compiler turns into vectors of any width with the same bits.

use crate::lanes::{LANES, Lanes};
use crate::layout::{Layout, span};

/// Below this squared length in m^2 a spring has no direction and gives no force.
pub(crate) const TINY: f32 = 1e-30;

/// The springs that start at each particle, in N/m, after the budget.
pub(crate) struct Springs<'a> {
    /// To the right neighbour (weft), and to the one below (warp).
    pub u: &'a mut [f32],
    pub v: &'a mut [f32],
    /// To the lower right, and to the lower left. Empty where shear is off.
    pub right: &'a mut [f32],
    pub left: &'a mut [f32],
    /// Two columns on, and two rows on. Empty where bend is off.
    pub bend_u: &'a mut [f32],
    pub bend_v: &'a mut [f32],
}

/// The constants of a substep.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Substep {
    pub dt: f32,
    pub damping: f32,
    /// Weight of a particle, m g.
    pub weight: [f32; 3],
    pub rest_u: f32,
    pub rest_v: f32,
    pub rest_diagonal: f32,
    /// Smallest value of 1 - L0/l: -1, or minus infinity without the limit.
    pub floor: f32,
    /// Speed limit in m/s, infinity without one.
    pub speed: f32,
}

/// Positions or velocities, as three planes.
pub(crate) struct Planes<'a> {
    pub x: &'a mut [f32],
    pub y: &'a mut [f32],
    pub z: &'a mut [f32],
}

/// The reading half of [`Planes`].
#[derive(Clone, Copy)]
pub(crate) struct View<'a> {
    pub x: &'a [f32],
    pub y: &'a [f32],
    pub z: &'a [f32],
}

impl Planes<'_> {
    pub fn view(&self) -> View<'_> {
        View { x: self.x, y: self.y, z: self.z }
    }
}

/// A row of three planes.
type Row<'a> = (&'a [[f32; LANES]], &'a [[f32; LANES]], &'a [[f32; LANES]]);

/// v += a dt for the particles of one row, with a = (sum of springs + weight + pull) / M - c v, then the speed limit.
///
/// `inverse` is 1/M, 0 for pinned particles and spare places.
#[inline(never)]
#[allow(clippy::too_many_arguments)] // each array is a parameter of its own: so the compiler knows that they do not overlap
pub(crate) fn velocity_row<const SHEAR: bool, const BEND: bool, const PULL: bool>(
    l: &Layout,
    row: usize,
    c: &Substep,
    p: View<'_>,
    k: &Springs<'_>,
    inverse: &[f32],
    pull: [&[f32]; 3],
    vx: &mut [f32],
    vy: &mut [f32],
    vz: &mut [f32],
) {
    let (at, n, s) = (l.row(row), l.width, l.stride);
    // Every row below has exactly n / LANES blocks, or the function ends here; so no index of the loop can be out of range.
    macro_rules! row {
        ($plane:expr, $at:expr) => {{
            let r = span($plane, $at, n).as_chunks::<LANES>().0;
            if r.len() != n / LANES {
                return;
            }
            r
        }};
    }
    macro_rules! row3 {
        ($at:expr) => {{
            let r: Row<'_> = (row!(p.x, $at), row!(p.y, $at), row!(p.z, $at));
            r
        }};
    }
    macro_rules! row_if {
        ($on:expr, $plane:expr, $at:expr) => {
            if $on { row!($plane, $at) } else { row!(inverse, at) }
        };
    }
    let here = row3!(at);
    let (r1, l1, d1, u1) = (row3!(at + 1), row3!(at - 1), row3!(at + s), row3!(at - s));
    let (dr, dl, ur, ul) = (row3!(at + s + 1), row3!(at + s - 1), row3!(at - s + 1), row3!(at - s - 1));
    let (r2, l2, d2, u2) = (row3!(at + 2), row3!(at - 2), row3!(at + 2 * s), row3!(at - 2 * s));
    let (k_r1, k_l1) = (row!(k.u, at), row!(k.u, at - 1));
    let (k_d1, k_u1) = (row!(k.v, at), row!(k.v, at - s));
    let (k_dr, k_ul) = (row_if!(SHEAR, k.right, at), row_if!(SHEAR, k.right, at - s - 1));
    let (k_dl, k_ur) = (row_if!(SHEAR, k.left, at), row_if!(SHEAR, k.left, at - s + 1));
    let (k_r2, k_l2) = (row_if!(BEND, k.bend_u, at), row_if!(BEND, k.bend_u, at - 2));
    let (k_d2, k_u2) = (row_if!(BEND, k.bend_v, at), row_if!(BEND, k.bend_v, at - 2 * s));
    let (px, py, pz) = (row_if!(PULL, pull[0], at), row_if!(PULL, pull[1], at), row_if!(PULL, pull[2], at));
    let w = row!(inverse, at);
    macro_rules! row_mut {
        ($plane:expr) => {
            match $plane.get_mut(at..at.wrapping_add(n)) {
                Some(r) => {
                    let r = r.as_chunks_mut::<LANES>().0;
                    if r.len() != n / LANES {
                        return;
                    }
                    r
                }
                None => return,
            }
        };
    }
    let (vx, vy, vz) = (row_mut!(vx), row_mut!(vy), row_mut!(vz));
    let all = Lanes::all;
    let (rest_u, rest_v, rest_diagonal) = (all(c.rest_u), all(c.rest_v), all(c.rest_diagonal));
    let (bend_u, bend_v) = (all(2.0 * c.rest_u), all(2.0 * c.rest_v));
    let (dt, damping, floor, tiny, one) = (all(c.dt), all(c.damping), all(c.floor), all(TINY), all(1.0));
    let weight = c.weight.map(all);
    let (limited, speed, speed2) = (c.speed < f32::INFINITY, all(c.speed), all(c.speed * c.speed));
    for i in 0..n / LANES {
        let load = |r: &[[f32; LANES]]| Lanes(r[i]);
        let (x, y, z) = (load(here.0), load(here.1), load(here.2));
        let zero = all(0.0);
        let (mut fx, mut fy, mut fz) = (zero, zero, zero);
        macro_rules! spring {
            ($other:expr, $k:expr, $rest:expr) => {{
                let (dx, dy, dz) = (load($other.0) - x, load($other.1) - y, load($other.2) - z);
                let length = (dx * dx + dy * dy + dz * dz).max(tiny).sqrt();
                let factor = load($k) * (one - $rest.over(length)).max(floor);
                fx = fx + factor * dx;
                fy = fy + factor * dy;
                fz = fz + factor * dz;
            }};
        }
        spring!(r1, k_r1, rest_u);
        spring!(l1, k_l1, rest_u);
        spring!(d1, k_d1, rest_v);
        spring!(u1, k_u1, rest_v);
        if SHEAR {
            spring!(dr, k_dr, rest_diagonal);
            spring!(ul, k_ul, rest_diagonal);
            spring!(dl, k_dl, rest_diagonal);
            spring!(ur, k_ur, rest_diagonal);
        }
        if BEND {
            spring!(r2, k_r2, bend_u);
            spring!(l2, k_l2, bend_u);
            spring!(d2, k_d2, bend_v);
            spring!(u2, k_u2, bend_v);
        }
        (fx, fy, fz) = (fx + weight[0], fy + weight[1], fz + weight[2]);
        if PULL {
            (fx, fy, fz) = (fx + load(px), fy + load(py), fz + load(pz));
        }
        let (ux, uy, uz, w) = (Lanes(vx[i]), Lanes(vy[i]), Lanes(vz[i]), load(w));
        let mut sx = ux + (w * fx - damping * ux) * dt;
        let mut sy = uy + (w * fy - damping * uy) * dt;
        let mut sz = uz + (w * fz - damping * uz) * dt;
        if limited {
            // sqrt(a^2) = a exactly, so the factor is exactly 1 below the limit
            let scale = speed.over((sx * sx + sy * sy + sz * sz).max(speed2).sqrt());
            (sx, sy, sz) = (sx * scale, sy * scale, sz * scale);
        }
        (vx[i], vy[i], vz[i]) = (sx.0, sy.0, sz.0);
    }
}

/// x += v dt for the particles of one row.
pub(crate) fn position_row(l: &Layout, row: usize, dt: f32, x: &mut [f32], v: &[f32]) {
    let at = l.row(row);
    let Some(x) = x.get_mut(at..at + l.width) else {
        return;
    };
    for (x, v) in x.iter_mut().zip(span(v, at, l.width)) {
        *x += v * dt;
    }
}
