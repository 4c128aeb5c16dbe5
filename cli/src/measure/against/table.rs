//! The tables of `taut measure against`.

use taut_lab::against::{Comparison, Strain};

use super::batch::Mean;
use crate::notes::number;
use crate::table::aligned;

fn both(s: Strain) -> String {
    format!("{} / {}", number(s.mean), number(s.p99))
}

fn optional(x: Option<f64>) -> String {
    x.map_or("-".into(), number)
}

/// One trajectory: the reference, then each setting.
pub fn single(settings: &[(&'static str, Comparison)]) -> String {
    let header = ["ex_pin %: mean / p99", "u", "v", "diag", "silhouette NMSE", "PSNR dB", "SSIM", "distance %"];
    let mut rows = Vec::new();
    if let Some((_, c)) = settings.first() {
        let d = &c.ex_pin_pct;
        let strains = [d.u, d.v, d.diag].map(|b| both(b.reference));
        rows.push([vec!["the trajectory".into()], strains.to_vec()].concat());
    }
    for (name, c) in settings {
        let d = &c.ex_pin_pct;
        let mut row = vec![name.to_string()];
        row.extend([d.u, d.v, d.diag].map(|b| both(b.taut)));
        row.extend([format!("{:.4}", c.silhouette_nmse), number(c.psnr_db), format!("{:.3}", c.ssim)]);
        row.push(optional(c.distance_pct));
        rows.push(row);
    }
    aligned(&header, &rows)
}

/// Mean errors over the fabrics of one scene.
pub fn means(scene: &str, fabrics: usize, means: &[(String, Mean)]) -> String {
    let header = [
        "mean error",
        "u mean",
        "v mean",
        "diag mean",
        "u p99",
        "v p99",
        "diag p99",
        "silhouette NMSE",
        "PSNR dB",
        "SSIM",
        "distance %",
    ];
    let rows: Vec<Vec<String>> = (means.iter())
        .map(|(name, m)| {
            let mut row = vec![name.clone()];
            row.extend(m.mean_points.iter().chain(&m.p99_points).map(|x| format!("{x:.3}")));
            row.extend([format!("{:.4}", m.silhouette_nmse), format!("{:.1}", m.psnr_db), format!("{:.3}", m.ssim)]);
            row.push(m.distance_pct.map_or("-".into(), |d| format!("{d:.2}")));
            row
        })
        .collect();
    format!("{scene}, {fabrics} fabrics: strains in points of %\n{}", aligned(&header, &rows))
}
