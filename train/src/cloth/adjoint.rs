//! Implicit differentiation at the shape at rest.

use super::equilibrium::{Cloth, TINY, vector};
use super::hessian::Hessian;
use super::law::Law;

impl Cloth<'_> {
    /// Gradient of a loss with respect to the stiffness of every spring, from its gradient `by_position` with respect to
    /// the shape at rest `x` (m). There g(x, k) = 0, so dx/dk = -H^-1 dg/dk and dL/dk = -(H^-1 dL/dx) . dg/dk: one solve.
    /// What `by_position` says of pinned particles has no effect.
    pub fn adjoint(&self, x: &[[f64; 3]], by_position: &[[f64; 3]]) -> Vec<f64> {
        let mut hessian = Hessian::new(self.pattern);
        hessian.assemble(self.springs, self.stiffness, x, self.limit, false);
        // A minimum has no negative direction; the tiny shift stands for the free turn of a sheet on a single pin, along
        // which dg/dk vanishes. It grows only where rounding asks for it.
        let mean = hessian.mean_diagonal();
        let mut shift = TINY * mean;
        hessian.shift(shift);
        while !hessian.factorise() {
            hessian.shift(9.0 * shift);
            shift *= 10.0;
            if shift.is_nan() || shift > 1e3 * mean {
                // Only numbers that are not finite come here.
                return vec![f64::NAN; self.stiffness.len()];
            }
        }
        let mut solution: Vec<f64> = self.pattern.free().iter().flat_map(|&i| by_position[i].map(|g| -g)).collect();
        hessian.solve(&mut solution);
        let mut lambda = vec![[0.0; 3]; x.len()];
        for (part, &i) in solution.chunks_exact(3).zip(self.pattern.free()) {
            lambda[i].copy_from_slice(part);
        }
        self.springs
            .list()
            .iter()
            .map(|s| {
                let (d, l) = (vector(x, s.a, s.b), vector(&lambda, s.a, s.b));
                Law::new(d, s.rest_m, self.limit).factor * (d[0] * l[0] + d[1] * l[1] + d[2] * l[2])
            })
            .collect()
    }
}
