//! The stability budget: whatever the field says, what is stepped is stable at this dt.
//!
//! Symplectic Euler with damping c is stable while omega^2 dt^2 < 4 - 2 c dt. The Hessian of the springs obeys
//! x^T H x <= sum over the particles of x_i^T B_i x_i with B_i = sum over its springs of (1 + [other end free]) k n n^T
//! (a spring between two free ends: (n.(x_i - x_j))^2 <= 2 (n.x_i)^2 + 2 (n.x_j)^2; at a pin x_j = 0), so
//! omega^2 <= max_i lambda_max(B_i) / M_i for any masses. `Tuned` takes n from the flat sheet (2 x 2 eigenvalue) and
//! 0.8 of the limit; `Certified` takes the trace bound n n^T <= 1, which holds for every shape of the cloth.

use crate::field::MAX_STIFFNESS;
use crate::force::Springs;
use crate::layout::{Layout, read, write};
use crate::math::{max, min, sqrt};
use crate::{Budget, ClothDef, Grid, Solver};

/// The bend channel is cut to at most this share of the mean structural stiffness of the particle: Provot's bend springs
/// also resist stretch, and a fit that may use them for that hangs the load on them.
pub const BEND_SHARE: f32 = 0.02;

/// Share of the limit of the flat sheet that [`Budget::Tuned`] uses.
pub const TUNED_SHARE: f32 = 0.8;

/// Share of its bound that [`Budget::Certified`] uses: rounding must not lift it above 1.
const CERTIFIED_SHARE: f32 = 0.99;

/// What the budget made of the stiffness field.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct BudgetReport {
    /// Length of a substep in s.
    pub dt_s: f32,
    /// Largest dt in s at which the whole field would have been kept, under the same budget and damping.
    pub max_dt_s: f32,
    /// Share of the stiffness that was cut, 0 to 1: 1 - (sum over the springs after) / (sum before).
    pub cut_fraction: f32,
    /// Inertia that the inertia field adds, as a share of the mass of the free particles.
    pub inertia_added: f32,
}

/// Writes the springs of a target field after the budget. `scale` is scratch of one plane.
pub(crate) fn project(
    grid: &Grid,
    def: &ClothDef,
    l: &Layout,
    target: &[&mut [f32]; 4],
    inverse: &[f32],
    springs: &mut Springs<'_>,
    scale: &mut [f32],
) -> BudgetReport {
    average(l, target, springs);
    let dt = def.dt_s();
    // an implicit solver is stable with the stiffness as it is
    let explicit = def.solver == Solver::SymplecticEuler;
    let allowed = 4.0 / (dt * dt) - 2.0 * def.damping_per_s / dt;
    let share = match def.budget {
        Budget::Certified => CERTIFIED_SHARE,
        Budget::Tuned => TUNED_SHARE,
    };
    let mut worst = 0.0f32;
    for row in 0..l.rows {
        for column in 0..l.columns {
            let at = l.at(row, column);
            let omega2 = bound(grid, def.budget, l, at, inverse, springs) * read(inverse, at);
            worst = max(worst, omega2);
            let s = share * allowed / max(omega2, f32::MIN_POSITIVE);
            write(scale, at, if explicit { min(s, 1.0) } else { 1.0 });
        }
    }
    let (mut before, mut after) = (0.0f64, 0.0f64);
    each_spring(l, |at, other, plane| {
        let Some(k) = springs.plane(plane).get_mut(at) else {
            return;
        };
        before += f64::from(*k);
        *k *= min(read(scale, at), read(scale, other));
        after += f64::from(*k);
    });
    let (mut free, mut inertia) = (0u32, 0.0f64);
    let mass = f64::from(particle_mass(grid, def));
    for row in 0..l.rows {
        for column in 0..l.columns {
            let w = read(inverse, l.at(row, column));
            if w > 0.0 {
                free += 1;
                inertia += 1.0 / f64::from(w);
            }
        }
    }
    // omega^2 dt^2 + 2 c dt share = 4 share, solved for dt without cancellation
    let w = f64::from(worst) / f64::from(share);
    let c = f64::from(def.damping_per_s);
    let max_dt = if explicit && w > 0.0 { (4.0 / (c + libm::sqrt(c * c + 4.0 * w))) as f32 } else { f32::INFINITY };
    BudgetReport {
        dt_s: dt,
        max_dt_s: max_dt,
        cut_fraction: if before > 0.0 { (1.0 - after / before) as f32 } else { 0.0 },
        inertia_added: if free > 0 { (inertia / (f64::from(free) * mass) - 1.0) as f32 } else { 0.0 },
    }
}

/// Mass of a particle in kg.
pub(crate) fn particle_mass(grid: &Grid, def: &ClothDef) -> f32 {
    let d = grid.def();
    def.density_kg_m2 * d.width_m * d.height_m / grid.particles() as f32
}

/// The four channels of a particle with the bend cut to its share and everything to [`MAX_STIFFNESS`].
fn channels(target: &[&mut [f32]; 4], at: usize) -> [f32; 4] {
    let [warp, weft, shear, bend] = [0, 1, 2, 3].map(|c| target.get(c).map_or(0.0, |p| read(p, at)));
    // halved before the sum, which could overflow
    let bend = min(bend, BEND_SHARE * (0.5 * warp + 0.5 * weft));
    let top = max(max(warp, weft), shear);
    let s = if top > MAX_STIFFNESS { MAX_STIFFNESS / top } else { 1.0 };
    [warp * s, weft * s, shear * s, bend * s]
}

/// Each spring has the mean of its two ends.
fn average(l: &Layout, target: &[&mut [f32]; 4], springs: &mut Springs<'_>) {
    // channel of each spring plane: u weft, v warp, the diagonals shear, bend twice
    const CHANNEL: [usize; 6] = [1, 0, 2, 2, 3, 3];
    each_spring(l, |at, other, plane| {
        let channel = CHANNEL.get(plane).copied().unwrap_or(0);
        let k = |at: usize| channels(target, at).get(channel).copied().unwrap_or(0.0);
        let mean = 0.5 * (k(at) + k(other));
        write(springs.plane(plane), at, mean);
    });
}

impl Springs<'_> {
    /// The planes in the order of [`each_spring`].
    fn plane(&mut self, i: usize) -> &mut [f32] {
        match i {
            0 => self.u,
            1 => self.v,
            2 => self.right,
            3 => self.left,
            4 => self.bend_u,
            _ => self.bend_v,
        }
    }
}

/// Calls `visit(place, place of the other end, plane)` for every spring.
fn each_spring(l: &Layout, mut visit: impl FnMut(usize, usize, usize)) {
    let s = l.stride;
    for row in 0..l.rows {
        for column in 0..l.columns {
            let at = l.at(row, column);
            let (right, below) = (column + 1 < l.columns, row + 1 < l.rows);
            if right {
                visit(at, at + 1, 0);
            }
            if below {
                visit(at, at + s, 1);
            }
            if l.shear && below {
                if right {
                    visit(at, at + s + 1, 2);
                }
                if column > 0 {
                    visit(at, at + s - 1, 3);
                }
            }
            if l.bend {
                if column + 2 < l.columns {
                    visit(at, at + 2, 4);
                }
                if row + 2 < l.rows {
                    visit(at, at + 2 * s, 5);
                }
            }
        }
    }
}

/// lambda_max(B_i), or its bound for every shape of the cloth.
fn bound(grid: &Grid, budget: Budget, l: &Layout, at: usize, inverse: &[f32], k: &Springs<'_>) -> f32 {
    let s = l.stride;
    let weighted = |plane: &[f32], place: usize, other: usize| {
        read(plane, place) * if read(inverse, other) > 0.0 { 2.0 } else { 1.0 }
    };
    let along_u = weighted(k.u, at, at + 1)
        + weighted(k.u, at - 1, at - 1)
        + weighted(k.bend_u, at, at + 2)
        + weighted(k.bend_u, at - 2, at - 2);
    let along_v = weighted(k.v, at, at + s)
        + weighted(k.v, at - s, at - s)
        + weighted(k.bend_v, at, at + 2 * s)
        + weighted(k.bend_v, at - 2 * s, at - 2 * s);
    let right = weighted(k.right, at, at + s + 1) + weighted(k.right, at - s - 1, at - s - 1);
    let left = weighted(k.left, at, at + s - 1) + weighted(k.left, at - s + 1, at - s + 1);
    match budget {
        Budget::Certified => along_u + along_v + right + left,
        Budget::Tuned => {
            let (u, v, d) = (grid.rest_u(), grid.rest_v(), grid.rest_diagonal());
            let (cos, sin) = (u / d, v / d);
            let a = along_u + (right + left) * (cos * cos);
            let d = along_v + (right + left) * (sin * sin);
            let b = (right - left) * (cos * sin);
            let half = 0.5 * (a - d);
            0.5 * (a + d) + sqrt(half * half + b * b)
        }
    }
}
