//! The report in words: the table, and the sentences that go with it.

use crate::report::{Difference, NO_KIND, Report, Setting, Stiffness};
use crate::table::aligned;

/// Speed in m/s above which a cloth is still moving.
const AT_REST_M_S: f64 = 0.01;

/// A number with two decimals; `-` where there is none.
pub fn number(x: f64) -> String {
    match x {
        x if !x.is_finite() => "-".into(),
        x if x.abs() >= 1e6 => format!("{x:.1e}"),
        x => format!("{x:.2}"),
    }
}

/// A setting's name for people.
pub fn heading(name: &str) -> String {
    name.replace("_inertia", " + inertia")
}

/// Whether the stiffness of a setting is whatever the step can carry: then there is no target that could be cut.
pub fn fills_the_budget(name: &str) -> bool {
    name == "uniform" || name == "uniform_inertia"
}

/// How much of K was cut, in percent.
pub fn cut(s: &Setting) -> String {
    if fills_the_budget(s.name) { "-".into() } else { format!("{:.0}", 100.0 * s.cut_fraction.max(0.0)) }
}

/// CPU time of a frame in microseconds.
pub fn us_per_frame(s: &Setting, grid: [u32; 2]) -> f64 {
    let particles = f64::from(grid[0]) * f64::from(grid[1]);
    s.ns_per_particle_step * particles * f64::from(s.substeps) * 1e-3
}

/// The table of all settings with a line that explains its columns.
pub fn table(report: &Report) -> String {
    let header =
        ["setting", "substeps", "max %", "p99 %", "mean %", "ex-pin %", "peak %", "cut %", "ns", "us/frame", "finite"];
    let rows: Vec<Vec<String>> = report
        .settings
        .iter()
        .map(|s| {
            let stretch = s.stretch_pct;
            vec![
                heading(s.name),
                s.substeps.to_string(),
                number(stretch.max),
                number(stretch.p99),
                number(stretch.mean),
                number(stretch.ex_pin_max),
                number(s.peak_stretch_pct),
                cut(s),
                format!("{:.1}", s.ns_per_particle_step),
                format!("{:.0}", us_per_frame(s, report.grid)),
                if s.finite { "yes" } else { "NO" }.into(),
            ]
        })
        .collect();
    aligned(&header, &rows)
        + "max, p99, mean: stretch of the warp and weft edges at the end; ex-pin: the largest more than 0.1 m from any pin; \
           peak: the largest\nof the whole run; cut: share of K that the budget took (-: K is what the step can carry); \
           ns: CPU time per particle and substep\n"
}

/// What the simulated scene is, in a line.
pub fn setup(report: &Report) -> String {
    let [rows, columns] = report.grid;
    let [width, height] = report.size_m;
    format!(
        "{}, {rows} x {columns} particles, {width} m x {height} m, {} Hz x {} substeps, {} budget, {:.3} kg/m^2, seed {}, \
         after {} s",
        report.scene, report.rate_hz, report.substeps, report.budget, report.density_kg_m2, report.seed, report.seconds
    )
}

/// Stiffness in a few words.
pub fn stiffness(k: Stiffness) -> String {
    format!("warp {:.0}, weft {:.0}, shear {:.1}, bend {:.2} N/m", k.warp, k.weft, k.shear, k.bend)
}

/// The generated cloth against another, largest / away from pins.
fn points(d: Difference, other: &str) -> String {
    let signed = |x: f64| {
        if x.is_finite() { format!("{x:+.2}") } else { "-".into() }
    };
    let (max, ex_pin) = (signed(d.max_points), signed(d.ex_pin_max_points));
    format!("{max} / {ex_pin} against {other}")
}

/// What the reader must know beside the numbers, a sentence each.
pub fn notes(report: &Report) -> Vec<String> {
    let mut notes = Vec::new();
    let r = &report.reference_fabric;
    let fabric = match (r.kind.as_str(), r.measured) {
        (NO_KIND, _) => "no fabric is named, so it has the medians of the generated field".to_string(),
        (kind, true) => format!("{kind}, measured"),
        (kind, false) => format!("{kind}, an estimate"),
    };
    let words = if r.changed_by_words { ", changed by the words that go with it" } else { "" };
    let substeps = report.reference_substeps.map_or(String::new(), |n| format!(", {n} substeps"));
    notes.push(format!("Reference: {fabric}{words}: {}{substeps}.", stiffness(r.stiffness_n_per_m)));
    notes.push(format!(
        "Generated: medians before the budget: {}.",
        stiffness(report.generator.median_stiffness_n_per_m)
    ));
    if let Some(share) = report.net_share {
        notes.push(format!(
            "The net's own share, points of stretch at the largest / away from pins (below 0: it stretches less): {}, {}; {}.",
            points(share.uniform_inertia, "uniform + inertia"),
            points(share.analytic_inertia, "analytic + inertia"),
            points(share.reference, "the reference")
        ));
    }
    let named = |pick: &dyn Fn(&&Setting) -> bool| -> String {
        let names: Vec<String> = report.settings.iter().filter(pick).map(|s| heading(s.name)).collect();
        names.join(", ")
    };
    let blown = named(&|s| !s.finite);
    if !blown.is_empty() {
        notes.push(format!("Blew up: {blown}."));
    }
    let moving = named(&|s| s.finite && s.rms_speed_m_s > AT_REST_M_S);
    if !moving.is_empty() {
        notes.push(format!("Still moving after {} s, so not the stretch at rest: {moving}.", report.seconds));
    }
    notes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        assert_eq!(number(15.096), "15.10");
        assert_eq!(number(f64::NAN), "-");
        assert_eq!(number(1.5e30), "1.5e30");
        assert_eq!(heading("uniform_inertia"), "uniform + inertia");
        assert_eq!(heading("generated"), "generated");
    }
}
