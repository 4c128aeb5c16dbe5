//! Orthotropic membrane: constant strain triangles, Green strain, stiffness that may depend on the strain.

use super::material::Membrane;
use super::sheet::Sheet;
use super::vector::{V3, add, along, outer, scale};

/// A triangle of the membrane.
#[derive(Clone, Debug)]
pub(super) struct Triangle {
    /// Its vertices.
    pub nodes: [usize; 3],
    /// Rest area in m^2.
    pub area_m2: f64,
    /// Derivatives of the three shape functions along u and v in 1/m.
    gradient: [[f64; 2]; 3],
}

/// A triangle as it is now: its deformation gradient (two columns) and its second Piola-Kirchhoff stress.
pub(super) struct Stretched {
    f: [V3; 2],
    /// k_uu, k_uv, k_vv, k_shear in N/m.
    stiffness: [f64; 4],
    /// Green strain uu, vv, uv.
    strain: [f64; 3],
    /// Stress uu, vv, uv in N/m.
    stress: [f64; 3],
}

impl Triangle {
    pub fn new(sheet: &Sheet, nodes: [usize; 3]) -> Triangle {
        let [a, b, c] = nodes.map(|i| sheet.uv[i]);
        let area_m2 = sheet.area_m2(nodes);
        let turned = |p: [f64; 2], q: [f64; 2]| [(p[1] - q[1]) / (2.0 * area_m2), (q[0] - p[0]) / (2.0 * area_m2)];
        Triangle { nodes, area_m2, gradient: [turned(b, c), turned(c, a), turned(a, b)] }
    }

    /// The triangle at its vertices' positions.
    pub fn at(&self, x: &[V3], membrane: &Membrane) -> Stretched {
        let column = |axis: usize| {
            let [p, q, r] = [0, 1, 2].map(|i| scale(self.gradient[i][axis], x[self.nodes[i]]));
            add(p, add(q, r))
        };
        let f = [column(0), column(1)];
        let square = |a: V3, b: V3| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let strain = [0.5 * (square(f[0], f[0]) - 1.0), 0.5 * (square(f[1], f[1]) - 1.0), 0.5 * square(f[0], f[1])];
        let stiffness = membrane.stiffness(strain);
        let [uu, uv, vv, shear] = stiffness;
        let stress = [uu * strain[0] + uv * strain[1], vv * strain[1] + uv * strain[0], shear * strain[2]];
        Stretched { f, stiffness, strain, stress }
    }

    /// Energy in J of a stiffness that does not change.
    pub fn energy(&self, now: &Stretched) -> f64 {
        let ([s, t, w], [e, g, h]) = (now.stress, now.strain);
        self.area_m2 * (0.5 * s * e + 0.5 * t * g + w * h)
    }

    /// Forces on the three vertices in N: -A F S grad.
    pub fn forces(&self, now: &Stretched) -> [V3; 3] {
        let [uu, vv, uv] = now.stress;
        let p = along(scale(uu, now.f[0]), uv, now.f[1]);
        let q = along(scale(vv, now.f[1]), uv, now.f[0]);
        self.gradient.map(|[gu, gv]| scale(-self.area_m2, along(scale(gu, p), gv, q)))
    }

    /// Calls `add(i, j, block)` with the second derivatives of the energy in N/m for i <= j, the stiffness held fixed.
    /// `convex` takes the positive semidefinite part.
    pub fn hessian(&self, now: &Stretched, convex: bool, mut add_block: impl FnMut(usize, usize, [[f64; 3]; 3])) {
        let [uu, mut uv, vv, shear] = now.stiffness;
        let mut stress = now.stress;
        if convex {
            // stiffness: |k_uv| at most the geometric mean; stress: pressure taken away
            let most = (uu.max(0.0) * vv.max(0.0)).sqrt();
            uv = uv.clamp(-most, most);
            stress = tension(stress);
        }
        let a = self.area_m2;
        let part = |i: usize| {
            let [gu, gv] = self.gradient[i];
            let both = scale(0.5, along(scale(gu, now.f[1]), gv, now.f[0]));
            (scale(gu, now.f[0]), scale(gv, now.f[1]), both)
        };
        let parts = [part(0), part(1), part(2)];
        for i in 0..3 {
            for j in i..3 {
                let ((iu, iv, is), (ju, jv, js)) = (parts[i], parts[j]);
                let mut k = outer(a * uu, iu, ju);
                for more in [
                    outer(a * vv, iv, jv),
                    outer(a * uv, iu, jv),
                    outer(a * uv, iv, ju),
                    outer(2.0 * a * shear, is, js),
                ] {
                    for r in 0..3 {
                        k[r] = add(k[r], more[r]);
                    }
                }
                let ([iu, iv], [ju, jv]) = (self.gradient[i], self.gradient[j]);
                let geometric = a * (stress[0] * iu * ju + stress[1] * iv * jv + stress[2] * (iu * jv + iv * ju));
                for r in 0..3 {
                    k[r][r] += geometric;
                }
                add_block(i, j, k);
            }
        }
    }
}

/// A symmetric 2 x 2 stress (uu, vv, uv) without its negative eigenvalues.
fn tension([uu, vv, uv]: [f64; 3]) -> [f64; 3] {
    let (middle, half) = (0.5 * (uu + vv), 0.5 * (uu - vv));
    let radius = half.hypot(uv);
    let (high, low) = (middle + radius, middle - radius);
    if low >= 0.0 {
        return [uu, vv, uv];
    }
    if high <= 0.0 {
        return [0.0; 3];
    }
    // high times the projector on its eigenvector
    let (c, s) = (half / radius, uv / radius);
    [0.5 * high * (1.0 + c), 0.5 * high * (1.0 - c), 0.5 * high * s]
}
