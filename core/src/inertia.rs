//! The inertia field: M_i = q_i m with q_i = clip(radius / distance to the nearest pin, 1, inertia_max).
//!
//! A stiff spring needs a small step only in proportion to k/M; so inertia where the cloth stretches most (at the pins)
//! buys stiffness there at the same step. The weight stays m g, so the rest shape is that of the stiffer cloth.

use crate::layout::{Layout, read, write};
use crate::mask::is_absent;
use crate::masses::Body;
use crate::math::{max, min, sqrt};
use crate::{ClothDef, Grid};

/// Writes 1/M of every particle, 0 for pinned and absent ones.
///
/// `distance` is scratch of one plane. The squared distance in the rest grid is found exactly: first down and up each
/// column, then along each row (only as far as the radius reaches). Cost: O(particles x columns within the radius).
pub(crate) fn inverse_masses(
    body: &Body<'_>,
    pinned: impl Iterator<Item = usize>,
    inverse: &mut [f32],
    distance: &mut [f32],
) {
    let (grid, def, l) = (body.grid, body.def, body.layout);
    for row in 0..l.rows {
        for column in 0..l.columns {
            let at = l.at(row, column);
            write(inverse, at, 1.0 / body.mass_at(at));
        }
    }
    for at in pinned {
        write(inverse, at, 0.0);
    }
    if def.has_inertia() {
        add_inertia(grid, def, l, inverse, distance);
    }
    if l.mask {
        // only now: they are no pins that the inertia field is about
        for row in 0..l.rows {
            for column in 0..l.columns {
                let at = l.at(row, column);
                if is_absent(body.mask, at) {
                    write(inverse, at, 0.0);
                }
            }
        }
    }
}

/// Divides 1/M by q; pinned particles are those with 1/M = 0.
fn add_inertia(grid: &Grid, def: &ClothDef, l: &Layout, inverse: &mut [f32], distance: &mut [f32]) {
    // `distance` along the column, in m; infinite where no pin stands in it
    for column in 0..l.columns {
        let mut d = f32::INFINITY;
        for row in 0..l.rows {
            let at = l.at(row, column);
            d = if read(inverse, at) == 0.0 { 0.0 } else { d + grid.rest_v() };
            write(distance, at, d);
        }
        let mut d = f32::INFINITY;
        for row in (0..l.rows).rev() {
            let at = l.at(row, column);
            d = if read(inverse, at) == 0.0 { 0.0 } else { d + grid.rest_v() };
            write(distance, at, min(d, read(distance, at)));
        }
    }
    for row in 0..l.rows {
        for column in 0..l.columns {
            let at = l.at(row, column);
            if read(inverse, at) == 0.0 {
                continue;
            }
            let d = read(distance, at);
            let mut best = d * d;
            let reach = def.inertia_radius_m * def.inertia_radius_m;
            for step in 1..l.columns {
                let du = step as f32 * grid.rest_u();
                let du2 = du * du;
                if du2 >= best || du2 > reach {
                    break;
                }
                if step <= column {
                    let d = read(distance, at - step);
                    best = min(du2 + d * d, best);
                }
                if column + step < l.columns {
                    let d = read(distance, at + step);
                    best = min(du2 + d * d, best);
                }
            }
            let q = min(max(def.inertia_radius_m / sqrt(max(best, 1e-12)), 1.0), def.inertia_max);
            let heavy = read(inverse, at) / q;
            write(inverse, at, heavy);
        }
    }
}
