//! From measured rows to the planner's table: `core/src/plan/table.rs`.
//!
//! The rows are in `lab/data/plan.csv`. The example `distill` measures them anew and writes both files; a test compares the
//! table with what [`table`] makes of the rows.

use std::fmt::Write;

use taut::plan::{Hold, Method, PlanDef, plan_of};
use taut::{Grid, GridDef, Solver};

use crate::compare::Limits;
use crate::fabric::Fabric;
use crate::front::{Correction, NO_BEND, Row, Spec};
use crate::scene::Scene;

/// The fabrics that the laws of K as it is are fitted to; the strains of a stiffest cloth are those of the first.
pub const FABRICS: [&str; 7] = ["denim", "polyester tablecloth", "cotton jersey", "rib knit", "silk", "canvas", "felt"];

/// Sides that the table is made from.
pub const SIDES: [u32; 3] = [16, 32, 64];

/// Strains whose neighbours decide about margins: below it is noise, above it nobody wants it.
const RANGE: std::ops::RangeInclusive<f64> = 0.001..=0.4;

/// The strain that stands where a row blew up.
const BLOWN: f64 = 2.0;

/// The least margin.
const LEAST_MARGIN: f64 = 0.03;

/// Gravity of the rows in m/s^2, and the side of their sheets in m.
const GRAVITY: f64 = 9.81;
const SIDE_M: f64 = 1.0;

/// The scene that stands for a hold.
pub fn scene_of(hold: Hold) -> Scene {
    match hold {
        Hold::Edge => Scene::Edge,
        Hold::Hooks => Scene::Curtain,
        Hold::Corners => Scene::Hang2,
        Hold::Corner => Scene::Hang1,
        Hold::Loose => Scene::Drape,
    }
}

/// How a scene holds its sheet.
pub fn hold_of(scene: Scene) -> Hold {
    match scene {
        Scene::Edge | Scene::Swing | Scene::Flag => Hold::Edge,
        Scene::Curtain => Hold::Hooks,
        Scene::Hang2 => Hold::Corners,
        Scene::Hang1 => Hold::Corner,
        Scene::Drape | Scene::Cusick => Hold::Loose,
    }
}

/// A row as the laws need it.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// The hold.
    pub hold: Hold,
    /// plain, inertia, tethers, levels or implicit.
    pub method: String,
    /// Particles of a side.
    pub side: u32,
    /// Substeps of a frame at 60 Hz.
    pub substeps: u32,
    /// Warp, weft, shear in N/m and kg/m^2 of the fabric.
    pub fabric: [f64; 4],
    /// Largest structural strain late in the run.
    pub strain: f64,
    /// Cost of a substep in plain steps.
    pub cost: f64,
}

/// The rows that the table needs, with the name of their method.
pub fn list() -> Vec<(Hold, &'static str, Spec)> {
    let mut rows = Vec::new();
    for hold in Hold::ALL {
        let scene = scene_of(hold);
        for side in SIDES {
            rows.extend(methods(hold, scene, side, FABRICS[0]));
            // where weight over stiffness is small for all of them, fewer tell as much
            let fabrics = if side == 64 { &FABRICS[..3] } else { &FABRICS[..] };
            for fabric in fabrics {
                rows.push((hold, "implicit", implicit(hold, scene, side, fabric)));
                rows.extend(whole(hold, scene, side, fabric).map(|spec| (hold, "whole", spec)));
            }
        }
    }
    rows
}

fn families(hold: Hold, spec: Spec) -> Spec {
    if matches!(hold, Hold::Corner | Hold::Loose) { spec } else { Spec { families: NO_BEND, ..spec } }
}

/// The row of the implicit method of a scene.
pub fn implicit(hold: Hold, scene: Scene, side: u32, fabric: &'static str) -> Spec {
    let base = Spec::new(scene, fabric, side, Correction::Analytic);
    families(hold, Spec { solver: Solver::ImplicitEuler, substeps: 1, ..base })
}

/// The row of the fabric's own stiffness with the substeps that it needs; None where those are too many.
pub fn whole(hold: Hold, scene: Scene, side: u32, fabric: &'static str) -> Option<Spec> {
    let grid = Grid::new(&GridDef { rows: side, columns: side, ..GridDef::default() }).ok()?;
    let known = Fabric::named(fabric)?;
    let def = PlanDef {
        hold,
        stiffness_n_per_m: known.stiffness,
        density_kg_m2: known.density_kg_m2,
        tolerance: 1.0,
        ..PlanDef::default()
    };
    let plan = plan_of(&grid, &def, Method::Whole).ok()??;
    let base = Spec::new(scene, fabric, side, Correction::Analytic);
    Some(families(hold, Spec { substeps: plan.substeps, ..base }))
}

/// The rows of the explicit methods of a scene: substeps upwards.
pub fn methods(hold: Hold, scene: Scene, side: u32, fabric: &'static str) -> Vec<(Hold, &'static str, Spec)> {
    let new = |correction| families(hold, Spec::new(scene, fabric, side, correction));
    let mut rows = Vec::new();
    for substeps in [4, 8, 12, 16, 24, 32, 64] {
        rows.push((hold, "plain", Spec { substeps, ..new(Correction::Uniform) }));
        if hold != Hold::Loose {
            rows.push((hold, "inertia", Spec { substeps, ..new(Correction::UniformInertia) }));
        }
    }
    if hold != Hold::Loose {
        for substeps in [2, 4, 8, 16] {
            let base = new(Correction::Uniform);
            rows.push((hold, "tethers", Spec { substeps, limits: Limits::Tethers(0.0), ..base }));
        }
    }
    if side < 64 {
        for substeps in [2, 4] {
            let base = new(Correction::Uniform);
            rows.push((hold, "levels", Spec { substeps, limits: Limits::levels(0.05), ..base }));
        }
    }
    rows
}

/// What the laws need of a row. None where it blew up.
pub fn point(hold: Hold, method: &str, spec: &Spec, row: &Row) -> Option<Point> {
    let fabric = Fabric::named(spec.fabric)?;
    let [warp, weft, shear, _] = fabric.stiffness.map(f64::from);
    Some(Point {
        hold,
        method: method.into(),
        side: spec.side,
        substeps: spec.substeps,
        fabric: [warp, weft, shear, f64::from(fabric.density_kg_m2)],
        strain: row.stretch_max_pct? / 100.0,
        cost: row.cost_in_plain_steps,
    })
}

const HEADER: &str =
    "hold,method,side,substeps,warp_n_per_m,weft_n_per_m,shear_n_per_m,density_kg_m2,strain,plain_steps";

/// The points as CSV, rounded as the table takes them.
pub fn csv(points: &[Point]) -> String {
    let mut text = format!("{HEADER}\n");
    for p in points {
        let [warp, weft, shear, density] = p.fabric;
        let _ = writeln!(
            text,
            "{:?},{},{},{},{warp:.3},{weft:.3},{shear:.3},{density:.4},{:.6},{:.3}",
            p.hold, p.method, p.side, p.substeps, p.strain, p.cost
        );
    }
    text
}

/// Reads what [`csv`] writes; None where it is something else.
pub fn read(text: &str) -> Option<Vec<Point>> {
    let mut lines = text.lines();
    if lines.next()? != HEADER {
        return None;
    }
    lines
        .map(|line| {
            let cells: Vec<&str> = line.split(',').collect();
            let number = |i: usize| cells.get(i)?.parse::<f64>().ok();
            Some(Point {
                hold: Hold::ALL.into_iter().find(|h| cells.first() == Some(&format!("{h:?}").as_str()))?,
                method: cells.get(1)?.to_string(),
                side: cells.get(2)?.parse().ok()?,
                substeps: cells.get(3)?.parse().ok()?,
                fabric: [number(4)?, number(5)?, number(6)?, number(7)?],
                strain: number(8)?,
                cost: number(9)?,
            })
        })
        .collect()
}

/// Coefficients of a fit, and how far above it the points lie at most.
struct Fit {
    coefficients: Vec<f64>,
    margin: f64,
}

/// Least squares by the normal equations, with a hair of damping so that what no point tells is 0.
fn fit(rows: &[(Vec<f64>, f64)]) -> Fit {
    let n = rows.first().map_or(0, |r| r.0.len());
    let mut a = vec![vec![0.0; n + 1]; n];
    for (x, y) in rows {
        for (row, xi) in a.iter_mut().zip(x) {
            for (sum, xj) in row.iter_mut().zip(x.iter().chain([y])) {
                *sum += xi * xj;
            }
        }
    }
    for (i, row) in a.iter_mut().enumerate() {
        row[i] += 1e-6;
    }
    // Gauss and Jordan; symmetric and positive, so no pivots are sought
    for i in 0..n {
        let pivot = a[i].clone();
        for (j, row) in a.iter_mut().enumerate() {
            if j != i {
                let factor = row[i] / pivot[i];
                row.iter_mut().zip(&pivot).for_each(|(r, p)| *r -= factor * p);
            }
        }
    }
    let coefficients: Vec<f64> = (0..n).map(|i| a[i][n] / a[i][i]).collect();
    let above = rows.iter().map(|(x, y)| y - x.iter().zip(&coefficients).map(|(x, c)| x * c).sum::<f64>());
    Fit { margin: above.fold(0.0, f64::max), coefficients }
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut all: Vec<f64> = values.filter(|v| v.is_finite()).collect();
    all.sort_by(f64::total_cmp);
    if all.is_empty() { 0.0 } else { crate::metrics::percentile(&all, 0.5) }
}

/// The strains of a method, and what is added to them for what lies between.
fn strains(points: &[Point], hold: Hold, method: &str) -> String {
    let of = || points.iter().filter(|p| p.hold == hold && p.method == method);
    let mut substeps: Vec<u32> = of().map(|p| p.substeps).collect();
    substeps.sort_unstable();
    substeps.dedup();
    let strain = |side: u32, s: u32| of().find(|p| p.side == side && p.substeps == s).map_or(BLOWN, |p| p.strain);
    let mut ln: Vec<Vec<f64>> =
        SIDES.iter().map(|side| substeps.iter().map(|s| strain(*side, *s).max(1e-5).ln()).collect()).collect();
    let margin = margin(&ln, &substeps);
    for i in 0..ln.len() {
        for j in (0..substeps.len()).rev() {
            let finer = if j + 1 < substeps.len() { ln[i][j + 1] } else { f64::MIN };
            let coarser = if i > 0 { ln[i - 1][j] } else { f64::MIN };
            ln[i][j] = ln[i][j].max(finer).max(coarser);
        }
    }
    let list = |values: Vec<String>| format!("&[{}]", values.join(", "));
    let rows: Vec<String> = ln.iter().map(|row| list(row.iter().map(|x| format!("{x:.3}")).collect())).collect();
    format!(
        "Strains {{ substeps: {}, ln_strain: [{}], margin: {margin:.3} }}",
        list(substeps.iter().map(|s| format!("{s}.0")).collect()),
        rows.join(", ")
    )
}

/// Half of what a row lies above the line through its neighbours at most: they are twice as far from each other as those that
/// a strain is looked up between.
fn margin(ln: &[Vec<f64>], substeps: &[u32]) -> f64 {
    let counts = |x: f64| RANGE.contains(&x.exp());
    let above = |x: [f64; 3], y: [f64; 3]| y[1] - (y[0] + (y[2] - y[0]) * (x[1] - x[0]) / (x[2] - x[0]));
    let mut most = 2.0 * LEAST_MARGIN;
    let s: Vec<f64> = substeps.iter().map(|s| f64::from(*s).ln()).collect();
    for row in ln {
        for (x, y) in s.windows(3).zip(row.windows(3)).filter(|(_, y)| counts(y[1])) {
            most = most.max(above([x[0], x[1], x[2]], [y[0], y[1], y[2]]));
        }
    }
    let n = SIDES.map(|side| f64::from(side - 1).ln());
    if let [a, b, c] = ln {
        for ((a, b), c) in a.iter().zip(b).zip(c).filter(|((_, b), _)| counts(**b)) {
            most = most.max(above(n, [*a, *b, *c]));
        }
    }
    0.5 * most
}

/// The law of K as it is, from the rows of a method.
fn fabric_law<'a>(rows: impl Iterator<Item = &'a Point>) -> String {
    let rows: Vec<(Vec<f64>, f64)> = rows
        .filter(|p| RANGE.contains(&p.strain))
        .map(|p| {
            let [warp, weft, shear, density] = p.fabric;
            let weight = density * GRAVITY * SIDE_M;
            // shares that add up to 1: strain is proportional to weight over stiffness
            let ratio = [warp, weft, shear].map(|k| (weight / k).ln());
            let x = vec![1.0, f64::from(p.side - 1).ln(), ratio[0] - ratio[2], ratio[1] - ratio[2]];
            (x, p.strain.ln() - ratio[2])
        })
        .collect();
    let f = fit(&rows);
    let c = &f.coefficients;
    format!(
        "FabricLaw {{ constant: {:.3}, grid: {:.3}, warp: {:.3}, weft: {:.3}, shear: {:.3}, margin: {:.3} }}",
        c[0],
        c[1],
        c[2],
        c[3],
        1.0 - c[2] - c[3],
        f.margin
    )
}

/// The source of the planner's table.
pub fn table(points: &[Point]) -> String {
    let mut text = String::from(
        "//! Written by the lab's example `distill` from lab/data/plan.csv: do not edit.\n\n\
         use super::strains::Strains;\nuse super::{FabricLaw, Price, Row};\n\n\
         /// A row for each hold, in the order of their numbers.\n#[rustfmt::skip]\npub(super) const ROWS: [Row; 5] = [\n",
    );
    for hold in Hold::ALL {
        let of = |method: &'static str| points.iter().filter(move |p| p.hold == hold && p.method == method);
        // what the scene needs beside the plain step is no price of a method
        let scene = if hold == Hold::Loose { median(of("plain").map(|p| p.cost)) - 1.0 } else { 0.0 };
        let price = |c: [f64; 3]| format!("Price {{ constant: {:.2}, grid: {:.2}, step: {:.2} }}", c[0], c[1], c[2]);
        let fitted = |rows: Vec<&Point>, steps: bool| {
            let x = |p: &Point| {
                let step = if steps { 1.0 / f64::from(p.substeps) } else { 0.0 };
                vec![1.0, 1.0 / f64::from(p.side - 1), step]
            };
            let c = fit(&rows.iter().map(|p| (x(p), p.cost - scene)).collect::<Vec<_>>()).coefficients;
            [c[0], c[1], c[2]]
        };
        let plain = match hold {
            Hold::Loose => [1.0, 0.0, 0.0],
            _ => fitted(of("plain").chain(of("inertia")).collect(), true),
        };
        // levels meet any limit with two substeps, so no others are planned
        let levels = of("levels").filter(|p| p.substeps == 2).map(|p| p.cost - scene);
        let _ = writeln!(
            text,
            "    // {hold:?}\n    Row {{\n        plain: {},\n        inertia: {},\n        tethers: {},\n        whole: {},\n        implicit: {},\n        \
             plain_price: {},\n        tethers_price: {},\n        levels_price: {},\n        implicit_price: {},\n    }},",
            strains(points, hold, "plain"),
            strains(points, hold, "inertia"),
            strains(points, hold, "tethers"),
            fabric_law(of("whole")),
            fabric_law(of("implicit")),
            price(plain),
            price([median(of("tethers").map(|p| p.cost)), 0.0, 0.0]),
            price([median(levels), 0.0, 0.0]),
            price(fitted(of("implicit").collect(), false)),
        );
    }
    text + "];\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    const DATA: &str = include_str!("../data/plan.csv");
    const TABLE: &str = include_str!("../../core/src/plan/table.rs");

    #[test]
    fn the_table_of_core_is_that_of_the_rows() {
        let points = read(DATA).unwrap();
        assert_eq!(csv(&points), DATA);
        assert_eq!(table(&points), TABLE, "run the example distill");
    }

    #[test]
    fn a_law_is_found_again() {
        let rows: Vec<(Vec<f64>, f64)> = (1..20)
            .map(|i| {
                let (n, s) = (f64::from(i % 5 + 3).ln(), f64::from(i % 7 + 1).ln());
                (vec![1.0, n, s], 0.5 + 3.0 * n + 1.1 * s)
            })
            .collect();
        let f = fit(&rows);
        for (found, put) in f.coefficients.iter().zip([0.5, 3.0, 1.1]) {
            assert!((found - put).abs() < 1e-3, "{:?}", f.coefficients);
        }
        assert!(f.margin < 1e-3);
    }
}
