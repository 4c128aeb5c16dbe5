//! The start of a first solve: a hanging sheet, brought near its rest by explicit damped steps.

use super::equilibrium::{Cloth, vector};
use super::law::Law;
use super::springs::Springs;

/// Length of an explicit step in s.
const STEP_S: f64 = 1.0 / 960.0;
/// Number of explicit steps.
const STEPS: usize = 4000;
/// Damping of the explicit steps in 1/s.
const DAMPING_PER_S: f64 = 2.0;
/// Size of the waves of the first shape as a share of the height.
const WAVES: f64 = 0.01;

/// The flat sheet hanging vertically from row 0, with small waves out of the plane, without which it could not find its
/// folds. The waves vanish at the top row.
pub(super) fn hanging_sheet(springs: &Springs) -> Vec<[f64; 3]> {
    use std::f64::consts::PI;
    (0..springs.particles())
        .map(|i| {
            let [x, y, _] = springs.hung_flat(i);
            let (u, w) = (x / springs.width_m(), -y / springs.height_m());
            let waves =
                ((3.0 * PI * u).sin() + 0.6 * (5.0 * PI * u + 1.0).cos() + 0.4 * (2.0 * PI * u + 3.0 * w).sin()) * w;
            [x, y, WAVES * springs.height_m() * (waves + (PI * u).sin() * (0.3 + w) * w.min(1.0))]
        })
        .collect()
}

impl Cloth<'_> {
    /// Lets the free particles of `x` (m) fall for some damped symplectic Euler steps (paper, eq. 17). Only the shape
    /// matters, so stiffness and inertia are bent to what a large step carries: all springs are softened alike until the
    /// median particle is stable, and a particle that is stiffer than the median gets more inertia. Weights stay.
    pub fn relax(&self, x: &mut [[f64; 3]], mass_kg: f64) {
        let n = x.len();
        let mut sums = vec![0.0; n];
        for (s, &k) in self.springs.list().iter().zip(self.stiffness) {
            sums[s.a] += 2.0 * k;
            sums[s.b] += 2.0 * k;
        }
        let mut sorted: Vec<f64> = self.pattern.free().iter().map(|&i| sums[i]).collect();
        sorted.sort_unstable_by(f64::total_cmp);
        let median = sorted[sorted.len() / 2];
        // omega^2 <= sums/M bounds any frequency, for any shape; this fills half of what dt < 2/omega allows.
        let soften = (2.0 * mass_kg / (STEP_S * STEP_S * median)).min(1.0);
        let inverse_mass: Vec<f64> = (0..n)
            .map(|i| match self.pattern.is_pinned(i) {
                true => 0.0,
                false => 1.0 / (0.5 * STEP_S * STEP_S * soften * sums[i]).max(mass_kg),
            })
            .collect();
        let keep = 1.0 - DAMPING_PER_S * STEP_S;
        let mut velocity = vec![[0.0; 3]; n];
        let mut force = vec![[0.0; 3]; n];
        for _ in 0..STEPS {
            force.fill(self.weight_n);
            for (s, &k) in self.springs.list().iter().zip(self.stiffness) {
                let d = vector(x, s.a, s.b);
                let factor = soften * k * Law::new(d, s.rest_m, true).factor;
                for c in 0..3 {
                    force[s.a][c] += factor * d[c];
                    force[s.b][c] -= factor * d[c];
                }
            }
            for i in 0..n {
                for c in 0..3 {
                    velocity[i][c] = keep * velocity[i][c] + STEP_S * inverse_mass[i] * force[i][c];
                    x[i][c] += STEP_S * velocity[i][c];
                }
            }
        }
    }
}
