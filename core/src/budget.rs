//! The stability budget: whatever the field says, what is stepped is stable at this dt.
//!
//! Symplectic Euler with damping c is stable while omega^2 dt^2 < 4 - 2 c dt. The Hessian of the springs obeys
//! x^T H x <= sum over the particles of x_i^T B_i x_i with B_i = sum over its springs of (1 + [other end free]) k n n^T
//! (a spring between two free ends: (n.(x_i - x_j))^2 <= 2 (n.x_i)^2 + 2 (n.x_j)^2; at a pin x_j = 0), so
//! omega^2 <= max_i lambda_max(B_i) / M_i for any masses. Both budgets take n from the flat sheet (2 x 2 eigenvalue), 0.8
//! and 0.25 of the limit. The latter holds for every shape of the cloth: n n^T <= 1 gives sum (1 + [other end free]) k,
//! which is the trace of that 2 x 2 matrix and so at most twice its larger eigenvalue: 0.5 of the limit.
//!
//! Hinges add their own bound to that of every particle (see hinge.rs) and may use [`HINGE_SHARE`] of what is allowed: above
//! it the whole rigidity is scaled down. The drag of the air counts as damping.

use crate::field::MAX_STIFFNESS;
use crate::force::Springs;
use crate::layout::{Layout, read, write};
use crate::mask::cuts;
use crate::masses::Body;
use crate::math::{max, min, sqrt};
use crate::{Budget, BudgetFlags, ClothDef, Grid, Solver};

/// The bend channel is cut to at most this share of the mean structural stiffness of the particle: Provot's bend springs
/// also resist stretch, and a fit that may use them for that hangs the load on them.
pub const BEND_SHARE: f32 = 0.02;

/// Share of the limit of the flat sheet that [`Budget::Tuned`] uses.
pub const TUNED_SHARE: f32 = 0.8;

/// Share of the limit of the flat sheet that [`Budget::Certified`] uses.
///
/// Up to 0.5 no shape of the cloth is unstable while it keeps that shape. But in a violent motion the Hessian changes from
/// step to step, and near the limit the fastest modes then draw energy from the stepping itself: at 0.5 a crumpled sheet
/// boils for ever, in spite of damping of 1/s; at 0.35 ten of 10,000 hostile starts do, at 0.3 three, at 0.25 none
/// (docs/budget.md).
pub const CERTIFIED_SHARE: f32 = 0.25;

/// The hinges may use at most this share of the limit: the springs need it more, or the cloth stretches.
pub const HINGE_SHARE: f32 = 0.25;

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
    /// Share of the hinge rigidity that is kept, 0 to 1: at the finest grids even thin cloth is too stiff for a game's step.
    pub hinge_fraction: f32,
    /// Predicted strain of the most stretched structural spring, when the cloth hangs at rest from a whole edge or from the
    /// two corners of one: within 15 % of what will be measured, up to [`crate::STRETCH_RANGE`]. 0 where the flags say that it is
    /// not known; only [`crate::Cloth::predict_stretch`] knows it.
    pub stretch: f32,
    /// What the largest strain never exceeds, in a cloth that started unstretched and whose pins do not move: at rest, and
    /// unless `stretch` is known on the way there too. Infinite where nothing bounds it.
    pub stretch_bound: f32,
    /// What to know about these.
    pub flags: BudgetFlags,
}

/// Writes the springs of a target field after the budget. `hinges` is what the hinges add to a particle at most in N/m,
/// `scale` is scratch of one plane.
pub(crate) fn project(
    body: &Body<'_>,
    target: &[&mut [f32]; 4],
    inverse: &[f32],
    hinges: f64,
    springs: &mut Springs<'_>,
    scale: &mut [f32],
) -> BudgetReport {
    let (def, l) = (body.def, body.layout);
    average(body, target, springs);
    let dt = def.dt_s();
    // an implicit solver is stable with the stiffness as it is
    let explicit = def.solver == Solver::SymplecticEuler;
    let allowed = 4.0 / (dt * dt) - 2.0 * def.damping_per_s / dt;
    let share = match def.budget {
        Budget::Certified => CERTIFIED_SHARE,
        Budget::Tuned => TUNED_SHARE,
    };
    let (mut lightest, mut worst) = (0.0f32, 0.0f32);
    for row in 0..l.rows {
        for column in 0..l.columns {
            lightest = max(read(inverse, l.at(row, column)), lightest);
        }
    }
    let top = f64::from(HINGE_SHARE * share * allowed) / f64::from(max(lightest, f32::MIN_POSITIVE));
    let hinge_fraction = if hinges > top { top / hinges } else { 1.0 };
    // held to finite numbers, so that nothing times 0 is NaN where all is pinned
    let [hinges, kept] = [hinges, hinges * hinge_fraction].map(|h| min(h as f32, f32::MAX));
    for row in 0..l.rows {
        for column in 0..l.columns {
            let at = l.at(row, column);
            let w = read(inverse, at);
            let omega2 = bound(body, at, inverse, springs) * w;
            let hinge2 = hinges * w;
            worst = max(worst, max(omega2 + hinge2, hinge2 / HINGE_SHARE));
            let s = (share * allowed - kept * w) / max(omega2, f32::MIN_POSITIVE);
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
    let (mut mass, mut inertia) = (0.0f64, 0.0f64);
    for row in 0..l.rows {
        for column in 0..l.columns {
            let at = l.at(row, column);
            let w = read(inverse, at);
            if w > 0.0 {
                mass += f64::from(body.mass_at(at));
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
        inertia_added: if mass > 0.0 { (inertia / mass - 1.0) as f32 } else { 0.0 },
        hinge_fraction: hinge_fraction as f32,
        ..BudgetReport::default()
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

/// Each spring has the mean of its two ends, and nothing where absent particles cut it.
fn average(body: &Body<'_>, target: &[&mut [f32]; 4], springs: &mut Springs<'_>) {
    // channel of each spring plane: u weft, v warp, the diagonals shear, bend twice
    const CHANNEL: [usize; 6] = [1, 0, 2, 2, 3, 3];
    each_spring(body.layout, |at, other, plane| {
        if cuts(body.mask, body.layout.stride, at, other, plane) {
            write(springs.plane(plane), at, 0.0);
            return;
        }
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

/// lambda_max(B_i) of the flat sheet.
fn bound(body: &Body<'_>, at: usize, inverse: &[f32], k: &Springs<'_>) -> f32 {
    let s = body.layout.stride;
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
    let (u, v) = (body.grid.rest_u(), body.grid.rest_v());
    let diagonal = body.grid.rest_diagonal();
    if body.rest_scale == [1.0; 3] {
        let (cos, sin) = (u / diagonal, v / diagonal);
        let a = along_u + (right + left) * (cos * cos);
        let d = along_v + (right + left) * (sin * sin);
        return largest(a, d, (right - left) * (cos * sin));
    }
    // Two flat sheets: the one of the scaled lengths, without tension, and the one that is held at the lengths of the
    // grid, in which a shortened spring with the factor s pulls, and so resists the ways across it with the share
    // 1 - L0/l = 1 - s of its stiffness too: k (n n^T + t (1 - n n^T)).
    let [scale_u, scale_v, scale_diagonal] = body.rest_scale;
    let bound = |u: f32, v: f32, across: [f32; 3]| {
        let d2 = u * u + v * v;
        let (cos2, sin2, mixed) = (u * u / d2, v * v / d2, u * v / d2);
        let [tu, tv, td] = across;
        let a = along_u + tv * along_v + (right + left) * (cos2 + td * sin2);
        let d = along_v + tu * along_u + (right + left) * (sin2 + td * cos2);
        largest(a, d, (1.0 - td) * (right - left) * mixed)
    };
    let across = [scale_u, scale_v, scale_diagonal].map(|s| max(1.0 - s, 0.0));
    max(bound(u * scale_u, v * scale_v, [0.0; 3]), bound(u, v, across))
}

/// The larger eigenvalue of the symmetric matrix of the diagonal a, d and b beside it.
fn largest(a: f32, d: f32, b: f32) -> f32 {
    let half = 0.5 * (a - d);
    0.5 * (a + d) + sqrt(half * half + b * b)
}

#[cfg(test)]
mod tests {
    extern crate std;

    use super::*;
    use crate::field::FieldView;
    use crate::{Cloth, Families, GridDef, noise};
    use std::vec;
    use std::vec::Vec;

    struct Random(u64, u32);

    impl Random {
        fn unit(&mut self) -> f32 {
            self.1 += 1;
            noise::uniform(self.0, self.1)
        }

        fn below(&mut self, n: usize) -> usize {
            ((self.unit() * n as f32) as usize).min(n - 1)
        }

        fn log(&mut self, low: f32, high: f32) -> f32 {
            libm::expf(libm::logf(low) + self.unit() * libm::logf(high / low))
        }

        /// A number as a network may print it: any bits, a value that breaks things, or a stiffness.
        fn printed(&mut self) -> f32 {
            const BAD: [f32; 10] =
                [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1.0, -0.0, 0.0, 1e-45, 1e30, f32::MAX, f32::MIN];
            match self.below(4) {
                0 => f32::from_bits((self.below(1 << 16) as u32) << 16 | self.below(1 << 16) as u32),
                1 => BAD[self.below(10)],
                _ => self.log(1e-6, 1e9),
            }
        }
    }

    /// Twice the stiffness that pulls at each particle as a matrix over (u, v), from the springs themselves.
    fn pull_at(c: &Cloth<'_>) -> Vec<[f64; 4]> {
        let l = c.layout;
        let (u, v) = (f64::from(c.grid.rest_u()), f64::from(c.grid.rest_v()));
        let d = libm::hypot(u, v);
        let k = &c.springs;
        let planes: [(&[f32], isize, isize, f64, f64); 6] = [
            (k.u, 0, 1, 1.0, 0.0),
            (k.v, 1, 0, 0.0, 1.0),
            (k.right, 1, 1, u / d, v / d),
            (k.left, 1, -1, -u / d, v / d),
            (k.bend_u, 0, 2, 1.0, 0.0),
            (k.bend_v, 2, 0, 0.0, 1.0),
        ];
        let mut pull = vec![[0.0; 4]; l.plane];
        for (plane, rows, columns, nu, nv) in planes {
            for row in 0..l.rows {
                for column in 0..l.columns {
                    let (r, c2) = (row as isize + rows, column as isize + columns);
                    let at = l.at(row, column);
                    if plane.is_empty() || r >= l.rows as isize || !(0..l.columns as isize).contains(&c2) {
                        continue;
                    }
                    let other = l.at(r as usize, c2 as usize);
                    let k = plane[at];
                    assert!(k.is_finite() && k >= 0.0, "{k} N/m");
                    let k = f64::from(k);
                    for (here, there) in [(at, other), (other, at)] {
                        let w = if c.inverse[there] > 0.0 { 2.0 * k } else { k };
                        for (p, n) in pull[here].iter_mut().zip([nu * nu, nv * nv, nu * nv, 1.0]) {
                            *p += w * n;
                        }
                    }
                }
            }
        }
        pull
    }

    /// One random cloth with a field of the right shape and any numbers: its springs are finite, and the bound holds at every
    /// particle, computed anew in f64. Returns the largest share of the limit.
    fn carried(seed: u64) -> f64 {
        let mut r = Random(seed, 0);
        let families = [1, 3, 5, 7][r.below(4)];
        let (m, n) = (2 + r.below(5) as u32, 2 + r.below(5) as u32);
        let (width_m, height_m) = (r.log(1e-3, 1e3), r.log(1e-3, 1e3));
        let grid =
            Grid::new(&GridDef { rows: m, columns: n, width_m, height_m, families: Families(families) }).unwrap();
        let def = ClothDef {
            rate_hz: r.log(1.0, 1e4),
            substeps: 1 + r.below(64) as u32,
            density_kg_m2: r.log(1e-6, 1e6),
            damping_per_s: [0.0, 0.9][r.below(2)],
            budget: [Budget::Certified, Budget::Tuned][r.below(2)],
            inertia_radius_m: [0.0, width_m][r.below(2)],
            max_pins: 4,
            ..ClothDef::default()
        };
        let mut block = vec![f32::NAN; Cloth::memory(&grid, &def).unwrap()];
        let mut c = Cloth::create(&grid, &def, &mut block).unwrap();
        let channels = [1, 4][r.below(2)];
        let (rows, columns) = if r.below(2) == 0 { (m, n) } else { (2, 3) };
        let data: Vec<f32> = (0..channels * rows * columns).map(|_| r.printed()).collect();
        let field = FieldView::sanitised(channels as usize, rows as usize, columns as usize, &data).unwrap();
        c.set_stiffness_field(&field);
        for _ in 0..r.below(4) {
            c.pin(r.below(grid.particles())).unwrap();
        }
        let report = c.budget().unwrap();
        assert!((0.0..=1.0).contains(&report.cut_fraction) && report.max_dt_s > 0.0, "seed {seed}: {report:?}");
        let dt = f64::from(def.dt_s());
        let allowed = 4.0 / (dt * dt) - 2.0 * f64::from(def.damping_per_s) / dt;
        let mut highest = 0.0f64;
        for (at, [a, b, ab, sum]) in pull_at(&c).into_iter().enumerate() {
            let of_limit = |k: f64| k * f64::from(c.inverse[at]) / allowed;
            let limit = f64::from([CERTIFIED_SHARE, TUNED_SHARE][def.budget as usize]);
            let share = of_limit(0.5 * (a + b) + libm::hypot(0.5 * (a - b), ab)) / limit;
            assert!(share <= 1.0 + 1e-4, "seed {seed}: {share} of the budget, {def:?}");
            // what holds in every shape
            assert!(of_limit(sum) <= 2.0 * limit * (1.0 + 1e-4), "seed {seed}: {sum} N/m, {def:?}");
            highest = highest.max(share);
        }
        highest
    }

    fn all_are_carried(seeds: core::ops::Range<u64>) {
        let n = seeds.end - seeds.start;
        let cut = seeds.filter(|seed| carried(*seed) > 0.999).count() as u64;
        // and the budget was what held them
        assert!(cut > n / 4, "only {cut} of {n} were cut");
    }

    #[test]
    fn any_field_is_carried() {
        all_are_carried(0..5_000);
    }

    /// `cargo test -p taut --lib -- --ignored a_million` (about a minute).
    #[test]
    #[ignore = "a minute"]
    fn a_million_fields_are_carried() {
        all_are_carried(5_000..1_005_000);
    }
}
