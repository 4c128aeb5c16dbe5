//! Bending: a hinge at every inner edge (Bridson, Marino, Fedkiw 2003; Grinspun, Hirani, Desbrun, Schroeder 2003).

use super::material::Bending;
use super::sheet::Sheet;
use super::vector::{V3, along, cross, dot, length, outer, scale, sub};

/// An inner edge.
#[derive(Clone, Debug)]
pub(super) struct Hinge {
    /// The two ends of the edge, the corner left of it, the corner right of it.
    pub nodes: [usize; 4],
    /// l / (2 A): times the angle it is the curvature by which the table is read, in 1/m.
    curvature: f64,
    /// l^2 / (4 A).
    shape: f64,
    /// Angle of the edge from u, folded into 0 to 90 degrees, as a place among the table's rows.
    row: f64,
}

/// A hinge as it is now.
pub(super) struct Folded {
    /// Dihedral angle, positive where the corners have moved towards the normal.
    angle: f64,
    /// Its derivatives by the positions in 1/m.
    gradient: [V3; 4],
    /// Torque per angle in N m.
    stiffness: f64,
}

impl Hinge {
    pub fn new(sheet: &Sheet, nodes: [usize; 4]) -> Hinge {
        let [a, b, left, right] = nodes;
        let area = sheet.area_m2([a, b, left]) + sheet.area_m2([b, a, right]);
        let [du, dv] = [0, 1].map(|axis| sheet.uv[b][axis] - sheet.uv[a][axis]);
        let length = du.hypot(dv);
        let row = dv.abs().atan2(du.abs()) / std::f64::consts::FRAC_PI_4;
        Hinge { nodes, curvature: length / (2.0 * area), shape: length * length / (4.0 * area), row }
    }

    /// The hinge at its vertices' positions; nothing where a triangle has no area.
    pub fn at(&self, x: &[V3], bending: &Bending) -> Option<Folded> {
        let [a, b, left, right] = self.nodes.map(|i| x[i]);
        let edge = sub(b, a);
        let (p, q) = (sub(left, a), sub(right, a));
        let (n0, n1) = (cross(edge, p), cross(q, edge));
        let (l, a0, a1) = (length(edge), length(n0), length(n1));
        if !(l > 0.0 && a0 > 0.0 && a1 > 0.0) {
            return None;
        }
        let (n0, n1) = (scale(1.0 / a0, n0), scale(1.0 / a1, n1));
        let angle = (-dot(edge, cross(n0, n1)) / l).atan2(dot(n0, n1));
        // unit normals over the heights of the corners, and where these stand on the edge
        let (g0, g1) = (scale(l / a0, n0), scale(l / a1, n1));
        let (s0, s1) = (dot(p, edge) / (l * l), dot(q, edge) / (l * l));
        let gradient = [along(scale(s0 - 1.0, g0), s1 - 1.0, g1), along(scale(-s0, g0), -s1, g1), g0, g1];
        let stiffness = self.shape * bending.stiffness(self.row, self.curvature * angle);
        Some(Folded { angle, gradient, stiffness })
    }

    /// Energy in J of a stiffness that does not change.
    pub fn energy(&self, now: &Folded) -> f64 {
        0.5 * now.stiffness * now.angle * now.angle
    }

    /// Forces on the four vertices in N.
    pub fn forces(&self, now: &Folded) -> [V3; 4] {
        now.gradient.map(|g| scale(-now.stiffness * now.angle, g))
    }

    /// Calls `add(i, j, block)` with the second derivatives of the energy in N/m for i <= j without those of the angle: they
    /// are what it is for a flat hinge, and never negative.
    pub fn hessian(&self, now: &Folded, mut add_block: impl FnMut(usize, usize, [[f64; 3]; 3])) {
        for i in 0..4 {
            for j in i..4 {
                add_block(i, j, outer(now.stiffness, now.gradient[i], now.gradient[j]));
            }
        }
    }
}
