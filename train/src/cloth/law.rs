//! The law of one spring: energy, tension and Hessian per unit of stiffness.

/// A spring of unit stiffness at a given elongation vector.
pub(super) struct Law {
    /// Unit direction from the first to the second end.
    pub normal: [f64; 3],
    /// Energy in m^2 (times k in N/m: J).
    pub energy: f64,
    /// Factor of the elongation vector in the force, 1 - L0/l (paper, eq. 1), kept at -1 or above where compression is
    /// limited.
    pub factor: f64,
    /// Stiffness along the direction: 1, or -1 where the limit of compression acts.
    pub along: f64,
}

impl Law {
    /// `d` is the vector from the first to the second end in m, `rest` the rest length in m. With `limit`, as in core,
    /// a spring shorter than half its rest length pushes with k times its length.
    #[inline]
    pub fn new(d: [f64; 3], rest: f64, limit: bool) -> Law {
        // The floor keeps coincident ends finite; they push in no direction, as in core.
        let length = (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt().max(1e-12);
        let normal = [d[0] / length, d[1] / length, d[2] / length];
        if limit && length < 0.5 * rest {
            // Continuous with the energy of the spring at half its length.
            let energy = 0.25 * rest * rest - 0.5 * length * length;
            return Law { normal, energy, factor: -1.0, along: -1.0 };
        }
        let stretch = length - rest;
        Law { normal, energy: 0.5 * stretch * stretch, factor: 1.0 - rest / length, along: 1.0 }
    }

    /// Upper triangle (xx, xy, xz, yy, yz, zz) of the 3 x 3 Hessian with respect to the elongation vector:
    /// t I + (along - t) n n^T. `convex` drops what is negative: the across part of a compressed spring, and the limit of
    /// compression, whose place the plain spring takes.
    #[inline]
    pub fn hessian(&self, convex: bool) -> [f64; 6] {
        let (across, along) = if convex { (self.factor.max(0.0), 1.0) } else { (self.factor, self.along) };
        let (n, w) = (self.normal, along - across);
        [
            across + w * n[0] * n[0],
            w * n[0] * n[1],
            w * n[0] * n[2],
            across + w * n[1] * n[1],
            w * n[1] * n[2],
            across + w * n[2] * n[2],
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn derivatives_are_those_of_the_energy() {
        for (d, limit) in [([0.3, -0.9, 0.4], true), ([0.2, 0.3, 0.1], false), ([0.2, 0.3, 0.1], true)] {
            let law = Law::new(d, 1.0, limit);
            assert_eq!(law.factor == -1.0, limit && d[0] < 0.25);
            let h = law.hessian(false);
            let full = [[h[0], h[1], h[2]], [h[1], h[3], h[4]], [h[2], h[4], h[5]]];
            for i in 0..3 {
                let step = |s: f64| {
                    let mut e = d;
                    e[i] += s;
                    (e, Law::new(e, 1.0, limit))
                };
                let ((dp, p), (dm, m)) = (step(1e-6), step(-1e-6));
                assert!(((p.energy - m.energy) / 2e-6 - law.factor * d[i]).abs() < 1e-8);
                for j in 0..3 {
                    let slope = (p.factor * dp[j] - m.factor * dm[j]) / 2e-6;
                    assert!((slope - full[i][j]).abs() < 1e-8, "{slope} {}", full[i][j]);
                }
            }
        }
    }
}
