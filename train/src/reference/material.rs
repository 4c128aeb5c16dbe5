//! What a fabric is made of: how its membrane and its hinges answer, as ARCSim 0.2.1 reads the tables of Wang, O'Brien and
//! Ramamoorthi ("Data-Driven Elastic Models for Cloth", 2011).
//!
//! The tables give the secant stiffness k in S = k E (E the Green strain, S the second Piola-Kirchhoff stress), which
//! changes with the strain itself. The stress is that of the energy k_uu/2 Euu^2 + k_vv/2 Evv^2 + k_uv Euu Evv + k_shear Euv^2
//! at that k, without the derivatives of k: so the engine does it, and so a table whose k changes has no exact energy.

/// The engine reads the table through a grid of this many samples per axis over Euu and Evv from -0.25 and |Euv| from 0, at
/// steps of 1/30, linear in between. Strain 0 lies halfway between samples: a fabric that stiffens as it stretches is
/// several times stiffer at rest than its table says.
const SAMPLES: usize = 30;
const LOWEST: f64 = -0.25;

/// A stretch of 1/6 is where the rows beyond the first were measured.
const PER_STRETCH: f64 = 6.0;

/// Rigidity of a sheet of equal hinges with alternating diagonals over a quarter of the table's number. A quarter is what a
/// cylinder of curvature k costs as long as its vertices lie on it. They do not: those where no diagonals meet step off it
/// by k h^2 / 12, which unfolds the edges across (angle k h - k h / 6) and folds those along (k h / 6) and the diagonals
/// (k h sqrt(2) / 6, at twice the weight): 25/36 + 1/36 + 4/36 = 5/6 of the energy.
pub(super) const RELAXED: f64 = 5.0 / 6.0;

/// Rows of the table of stretching: small strain, then a stretch of 1/6 at 0, 22.5, 45, 67.5, 90 degrees from u. Columns:
/// k_uu, k_uv, k_vv, k_shear in N/m. Half of what acts.
pub type StretchingTable = [[f64; 4]; 6];

/// Rows of the table of bending: edges at 0, 45, 90 degrees from u. Columns: at a curvature of 0, 5, 10, 15, 20 1/m. N m.
pub type BendingTable = [[f64; 5]; 3];

/// How a membrane answers a strain.
#[derive(Clone, Debug, PartialEq)]
pub struct Membrane(Law);

#[derive(Clone, Debug, PartialEq)]
enum Law {
    Constant([f64; 4]),
    Samples(Vec<[f64; 4]>),
}

impl Membrane {
    /// k_uu, k_uv, k_vv, k_shear in N/m at every strain.
    pub fn constant(stiffness: [f64; 4]) -> Membrane {
        Membrane(Law::Constant(stiffness))
    }

    /// A measured table as the engine uses it: resampled, no sample below 0, doubled.
    pub fn measured(table: &StretchingTable) -> Membrane {
        let at = |i: usize| i as f64 / SAMPLES as f64;
        let mut samples = Vec::with_capacity(SAMPLES.pow(3));
        for i in 0..SAMPLES {
            for j in 0..SAMPLES {
                for k in 0..SAMPLES {
                    let strain = [LOWEST + at(i), LOWEST + at(j), at(k)];
                    samples.push(read(table, strain).map(|k| 2.0 * k.max(0.0)));
                }
            }
        }
        Membrane(Law::Samples(samples))
    }

    /// k_uu, k_uv, k_vv, k_shear in N/m at a Green strain (uu, vv, uv).
    pub fn stiffness(&self, [uu, vv, uv]: [f64; 3]) -> [f64; 4] {
        let samples = match &self.0 {
            Law::Constant(k) => return *k,
            Law::Samples(samples) => samples,
        };
        let split = |strain: f64| {
            let at = (strain * SAMPLES as f64).clamp(0.0, (SAMPLES - 1) as f64 - 1e-5);
            (at as usize, at.fract())
        };
        let [(i, a), (j, b), (k, c)] = [split(uu - LOWEST), split(vv - LOWEST), split(uv.abs())];
        let mut stiffness = [0.0; 4];
        for (di, dj, dk) in (0..8).map(|n| (n & 1, n >> 1 & 1, n >> 2)) {
            let part = |share: f64, upper: usize| if upper == 1 { share } else { 1.0 - share };
            let weight = part(a, di) * part(b, dj) * part(c, dk);
            let sample = &samples[((i + di) * SAMPLES + j + dj) * SAMPLES + k + dk];
            for (sum, s) in stiffness.iter_mut().zip(sample) {
                *sum += weight * s;
            }
        }
        stiffness
    }
}

/// The table at a strain: linear in the largest principal stretch up to 1/6, and in its angle from u.
fn read(table: &StretchingTable, [uu, vv, uv]: [f64; 3]) -> [f64; 4] {
    let (middle, half) = (1.0 + uu + vv, uu - vv);
    // F^T F = 1 + 2 E has the eigenvalues middle +- radius
    let radius = half.hypot(2.0 * uv);
    let stretch = (PER_STRETCH * ((middle + radius).sqrt() - 1.0)).clamp(0.0, 1.0);
    // its largest eigenvector lies at half of this angle; where both are equal, along u
    let angle = (2.0 * uv).abs().atan2(half) / std::f64::consts::PI * 4.0;
    let first = (angle as usize).min(3);
    let share = angle - first as f64;
    let [low, near, far] = [&table[0], &table[1 + first], &table[2 + first]];
    std::array::from_fn(|c| low[c] + stretch * (near[c] + share * (far[c] - near[c]) - low[c]))
}

/// How hinges answer a fold.
#[derive(Clone, Debug, PartialEq)]
pub struct Bending(BendingTable);

impl Bending {
    /// A plate's rigidity in N m, at every curvature and angle.
    pub fn constant(rigidity_n_m: f64) -> Bending {
        Bending([[4.0 / RELAXED * rigidity_n_m; 5]; 3])
    }

    /// A measured table.
    pub fn measured(table: &BendingTable) -> Bending {
        Bending(*table)
    }

    /// A quarter of the table's numbers for flat edges at 0, 45, 90 degrees from u, in N m: what is cited as the rigidity. A
    /// sheet of equal hinges has five sixths of it.
    pub fn rigidities(&self) -> [f64; 3] {
        self.0.map(|row| 0.25 * row[0])
    }

    /// The table's number in N m for an edge (0 along u, 1 at 45 degrees, 2 along v, linear in between) at a curvature in
    /// 1/m: linear between the columns, constant beyond the last, extrapolated below 0 as the engine does, never below 0.
    pub(super) fn stiffness(&self, row: f64, curvature_per_m: f64) -> f64 {
        let at = (0.2 * curvature_per_m).min(4.0);
        let column = (at.max(0.0) as usize).min(3);
        let first = (row.max(0.0) as usize).min(1);
        let of = |row: &[f64; 5]| row[column] + (at - column as f64) * (row[column + 1] - row[column]);
        let (near, far) = (of(&self.0[first]), of(&self.0[first + 1]));
        (near + (row - first as f64) * (far - near)).max(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_of_equal_rows_is_constant_and_doubled() {
        let k = [100.0, 10.0, 200.0, 30.0];
        let membrane = Membrane::measured(&[k; 6]);
        for strain in [[0.0; 3], [0.1, -0.2, 0.05], [0.6, 0.6, -0.5], [-0.4, 3.0, 2.0]] {
            for (a, b) in membrane.stiffness(strain).iter().zip(k) {
                assert!((a - 2.0 * b).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn the_table_is_read_at_its_rows() {
        let table: StretchingTable = std::array::from_fn(|r| [r as f64; 4]);
        let sixth = 0.5 * ((7.0f64 / 6.0).powi(2) - 1.0);
        // a stretch of s at an angle: E = e n n^T
        let at = |degrees: f64, e: f64| {
            let (s, c) = degrees.to_radians().sin_cos();
            read(&table, [e * c * c, e * s * s, e * s * c])[0]
        };
        for (row, degrees) in [0.0, 22.5, 45.0, 67.5, 90.0].into_iter().enumerate() {
            assert!((at(degrees, sixth) - (row + 1) as f64).abs() < 1e-9, "{degrees}");
            assert!((at(-degrees, sixth) - (row + 1) as f64).abs() < 1e-9, "{degrees}");
        }
        assert!((at(11.25, 5.0) - 1.5).abs() < 1e-9 && at(0.0, -0.1) == 0.0);
        assert!((at(90.0, 0.5 * ((13.0f64 / 12.0).powi(2) - 1.0)) - 2.5).abs() < 1e-9, "half way in the stretch");
    }

    #[test]
    fn bending_is_linear_between_its_samples() {
        let bending = Bending::measured(&[[4.0, 3.0, 2.0, 1.0, 5.0], [8.0; 5], [12.0, 0.0, 0.0, 0.0, 0.0]]);
        assert_eq!(bending.rigidities(), [1.0, 2.0, 3.0]);
        assert_eq!(bending.stiffness(0.0, 12.5), 1.5);
        assert_eq!(bending.stiffness(0.0, 1e9), 5.0);
        assert_eq!(bending.stiffness(0.0, -5.0), 5.0, "extrapolated");
        assert_eq!(bending.stiffness(0.5, 0.0), 6.0);
        assert_eq!(bending.stiffness(2.0, 2.5), 6.0);
        assert!((Bending::constant(0.5).stiffness(1.3, -80.0) - 2.4).abs() < 1e-12);
    }
}
