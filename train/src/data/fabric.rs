//! Fabrics around the measured ones, and what the continuum cloth makes of them.

use taut::noise;
use taut_lab::fabric::{self as lab, Fabric};

use crate::reference::{Bending, MEASURED, Material, Measured, Membrane, ReferenceError};

/// How far two pieces of one fabric differ, as a share of how far the measured fabrics do.
const SPREAD: f64 = 0.1;

/// Numbers that tell a fabric: logarithms of its stiffness, anisotropy, shear ratio, density and bending rigidity.
const TRAITS: usize = 5;

fn traits(fabric: &Fabric) -> [f64; TRAITS] {
    let [uu, vv, shear] = secants(fabric);
    let mean = (uu * vv).sqrt();
    [mean, vv / uu, shear / mean, f64::from(fabric.density_kg_m2), f64::from(fabric.hinge_rigidity_n_m)].map(f64::ln)
}

/// k_uu, k_vv, k_shear in N/m that the springs of a fabric stand for (`taut_lab::fabric`).
fn secants(fabric: &Fabric) -> [f64; 3] {
    let [warp, weft, shear, bend] = fabric.stiffness.map(f64::from);
    [weft + shear + 4.0 * bend, warp + shear + 4.0 * bend, 2.0 * shear]
}

/// A fabric near a kind with a description that fits it: that of the lab, and then another piece of it. Pieces differ as the
/// measured fabrics do, a tenth as far: what is denser also bends harder, and so on.
pub fn sample(seed: u64, index: u32) -> (Fabric, String) {
    let (fabric, words) = lab::sample(seed, index);
    (piece(&fabric, seed, index), words)
}

/// Another piece of a fabric, drawn by (seed, index).
pub fn piece(fabric: &Fabric, seed: u64, index: u32) -> Fabric {
    let mut fabric = fabric.clone();
    let draws: [f64; TRAITS] =
        std::array::from_fn(|i| f64::from(noise::gaussian(seed ^ 0x70_6965_6365, index.wrapping_mul(8) + i as u32)));
    let root = correlated();
    let by: [f64; TRAITS] = std::array::from_fn(|i| (0..=i).map(|j| SPREAD * root[i][j] * draws[j]).sum());
    let [stiffness, anisotropy, shear, density, rigidity] = by;
    let [uu, vv, k_shear] = secants(&fabric);
    let bend = f64::from(fabric.stiffness[3]) * stiffness.exp();
    let diagonal = 0.5 * k_shear * (stiffness + shear).exp();
    // what the secants leave, as `taut_lab::fabric` has it
    let rest = |k: f64, by: f64| {
        let k = k * (stiffness + by).exp();
        (k - diagonal - 4.0 * bend).max(0.25 * k)
    };
    fabric.stiffness = [rest(vv, 0.5 * anisotropy), rest(uu, -0.5 * anisotropy), diagonal, bend].map(|k| k as f32);
    fabric.density_kg_m2 *= density.exp() as f32;
    fabric.hinge_rigidity_n_m *= rigidity.exp() as f32;
    fabric
}

/// Covariance of the traits of the measured fabrics.
fn covariance() -> [[f64; TRAITS]; TRAITS] {
    let all: Vec<[f64; TRAITS]> = MEASURED.iter().filter_map(|m| Some(traits(&m.kind().ok()?.fabric()))).collect();
    let n = all.len() as f64;
    let mean: [f64; TRAITS] = std::array::from_fn(|i| all.iter().map(|t| t[i]).sum::<f64>() / n);
    std::array::from_fn(|i| {
        std::array::from_fn(|j| all.iter().map(|t| (t[i] - mean[i]) * (t[j] - mean[j])).sum::<f64>() / (n - 1.0))
    })
}

/// Cholesky's lower triangle of the covariance.
fn correlated() -> [[f64; TRAITS]; TRAITS] {
    let covariance = covariance();
    let mut root = [[0.0; TRAITS]; TRAITS];
    for i in 0..TRAITS {
        for j in 0..=i {
            let rest = covariance[i][j] - (0..j).map(|k| root[i][k] * root[j][k]).sum::<f64>();
            root[i][j] = if i == j { rest.max(0.0).sqrt() } else { rest / root[j][j].max(1e-12) };
        }
    }
    root
}

/// What the continuum cloth of a fabric is made of: the tables of its kind, or where nobody measured it, of the measured fabric
/// whose stiffness is nearest, scaled to the fabric's own secants, density and bending rigidity. Along u with v the tables
/// scale by the mean of both, so that they stay positive definite.
pub fn material(fabric: &Fabric) -> Result<Material, ReferenceError> {
    let measured = nearest(fabric)?;
    let (own, table) = (secants(fabric), secants(&measured.kind()?.fabric()));
    let [uu, vv, shear]: [f64; 3] = std::array::from_fn(|i| own[i] / table[i]);
    let columns = [uu, (uu * vv).sqrt(), vv, shear];
    let stretching = measured.stretching.map(|row| std::array::from_fn(|c| columns[c] * row[c]));
    let mean = Bending::measured(&measured.bending).rigidities().iter().sum::<f64>() / 3.0;
    let factor = f64::from(fabric.hinge_rigidity_n_m) / mean;
    let bending = measured.bending.map(|row| row.map(|k| factor * k));
    Ok(Material {
        density_kg_m2: f64::from(fabric.density_kg_m2),
        membrane: Membrane::measured(&stretching),
        bending: Bending::measured(&bending),
    })
}

/// The measured fabric of the same kind, or the one that is nearest by the ratios of its secants and by how it stiffens.
fn nearest(fabric: &Fabric) -> Result<&'static Measured, ReferenceError> {
    if let Some(own) = MEASURED.iter().find(|m| m.kind == fabric.kind) {
        return Ok(own);
    }
    let numbers = |f: &Fabric| {
        let [uu, vv, shear] = secants(f);
        [uu, vv, shear, f64::from(f.softness[0]), f64::from(f.softness[1])].map(f64::ln)
    };
    let own = numbers(fabric);
    let mut best: Option<(f64, &Measured)> = None;
    for measured in &MEASURED {
        let other = numbers(&measured.kind()?.fabric());
        let far: f64 = own.iter().zip(&other).map(|(a, b)| (a - b).powi(2)).sum();
        if best.is_none_or(|(least, _)| far < least) {
            best = Some((far, measured));
        }
    }
    best.map(|(_, measured)| measured).ok_or_else(|| ReferenceError::Fabric(fabric.kind.into()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use taut_lab::fabric::KINDS;

    #[test]
    fn a_measured_fabric_keeps_its_tables() {
        for measured in &MEASURED {
            let (own, mapped) = (measured.material().unwrap(), material(&measured.kind().unwrap().fabric()).unwrap());
            for strain in [[0.0; 3], [0.02, -0.01, 0.03], [0.1, 0.05, -0.02]] {
                for (a, b) in own.membrane.stiffness(strain).iter().zip(mapped.membrane.stiffness(strain)) {
                    assert!((a - b).abs() <= 1e-9 * a.abs() + 1e-9, "{}", measured.name);
                }
            }
            for (a, b) in own.bending.rigidities().iter().zip(mapped.bending.rigidities()) {
                assert!((a / b - 1.0).abs() < 0.02, "{}", measured.name);
            }
        }
    }

    /// Tension over stretch, lateral fixed, as the kinds cite it: at 10 % for a knit, at small strain for a woven.
    #[test]
    fn a_sampled_fabric_has_its_own_secants_density_and_rigidity() {
        for i in 0..200 {
            let (fabric, words) = sample(5, i);
            let made = material(&fabric).unwrap();
            let knit = nearest(&fabric).unwrap().kind().unwrap().words.contains(&"knit");
            let tension = |axis: usize| {
                let stretch = 1.1f64;
                let e = 0.5 * (stretch * stretch - 1.0);
                let mut strain = [0.0; 3];
                if knit {
                    strain[axis] = e;
                }
                let k = made.membrane.stiffness(strain)[2 * axis];
                if knit { k * e * stretch / 0.1 } else { k }
            };
            let [uu, vv, shear] = secants(&fabric);
            for (found, cited) in [(tension(0), uu), (tension(1), vv)] {
                assert!((found / cited - 1.0).abs() < 3e-3, "{words}: {found} {cited}");
            }
            assert!(knit || (made.membrane.stiffness([0.0; 3])[3] / shear - 1.0).abs() < 3e-3, "{words}");
            assert_eq!(made.density_kg_m2, f64::from(fabric.density_kg_m2));
            let mean = made.bending.rigidities().iter().sum::<f64>() / 3.0;
            assert!((mean / f64::from(fabric.hinge_rigidity_n_m) - 1.0).abs() < 1e-9, "{words}");
        }
    }

    #[test]
    fn what_nobody_measured_takes_after_what_is_like_it() {
        let like = |name: &str| nearest(&KINDS.iter().find(|k| k.name == name).unwrap().fabric()).unwrap().kind;
        assert!(
            ["jersey", "rib knit", "sweatshirt knit", "swimwear knit"].contains(&like("fleece")),
            "{}",
            like("fleece")
        );
        assert_eq!(like("cotton"), "tablecloth");
        assert_eq!(like("velvet"), "blanket");
    }

    #[test]
    fn pieces_differ_as_the_measured_fabrics_do() {
        let n = 4000;
        let by: Vec<[f64; TRAITS]> = (0..n)
            .map(|i| {
                let (mine, labs) = (traits(&sample(9, i).0), traits(&lab::sample(9, i).0));
                std::array::from_fn(|k| mine[k] - labs[k])
            })
            .collect();
        let expected = covariance();
        for i in 0..TRAITS {
            for j in 0..TRAITS {
                let found = by.iter().map(|d| d[i] * d[j]).sum::<f64>() / f64::from(n);
                let scale = SPREAD.powi(2) * (expected[i][i] * expected[j][j]).sqrt();
                let off = found - SPREAD.powi(2) * expected[i][j];
                // the deviation of a covariance of 4000 is 0.02 of it
                assert!(off.abs() < 0.09 * scale, "{i} {j}: {found} off by {off} of {scale}");
            }
        }
    }
}
