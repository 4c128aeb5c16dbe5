//! The fits that make the planner's table of measured rows.

use std::fmt::Write;

use taut::plan::Hold;

use super::{LIMITS, Point, SIDES, bends};

/// Strains whose neighbours decide about margins: nobody asks for less or wants more.
const RANGE: std::ops::RangeInclusive<f64> = 0.005..=0.25;

/// Strains that the laws of K as it is are fitted to: below them is noise.
const LAW_RANGE: std::ops::RangeInclusive<f64> = 0.001..=0.4;

/// The strain that stands where a row blew up.
const BLOWN: f64 = 2.0;

/// The least margin, and the share of the rows that may lie further above their neighbours' line.
const LEAST_MARGIN: f64 = 0.03;
const OUTSIDE: f64 = 0.1;

/// Gravity of the rows in m/s^2, and the side of their sheets in m.
const GRAVITY: f64 = 9.81;
const SIDE_M: f64 = 1.0;

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

/// The value that a share of them lie at or below, 0 of none.
fn quantile(values: impl IntoIterator<Item = f64>, share: f64) -> f64 {
    let mut all: Vec<f64> = values.into_iter().filter(|v| v.is_finite()).collect();
    all.sort_by(f64::total_cmp);
    if all.is_empty() { 0.0 } else { crate::metrics::percentile(&all, share) }
}

/// What a padded particle costs in plain steps: a pass works on whole vectors of 16.
fn cost(p: &Point) -> f64 {
    p.cost * f64::from(p.side) / f64::from(p.side.next_multiple_of(16))
}

/// The law of a price. What the machine did beside lies far above it, and is left out of the next fit.
fn price(rows: &[&Point], steps: bool) -> String {
    let x = |p: &Point| {
        let step = if steps { 1.0 / f64::from(p.substeps) } else { 0.0 };
        vec![1.0, 1.0 / f64::from(p.side - 1), step]
    };
    let mut all: Vec<(Vec<f64>, f64)> = rows.iter().map(|p| (x(p), cost(p))).collect();
    for _ in 0..3 {
        let c = fit(&all).coefficients;
        let law = |x: &[f64]| x.iter().zip(&c).map(|(x, c)| x * c).sum::<f64>();
        all.retain(|(x, y)| *y < 1.2 * law(x));
    }
    let c = if all.is_empty() { vec![0.0; 3] } else { fit(&all).coefficients };
    format!("Price {{ constant: {:.2}, grid: {:.2}, step: {:.2} }}", c[0], c[1], c[2])
}

/// What levels do: the worst strains by limit, and the law of the price that three of four rows stay under.
fn levels(rows: &[&Point]) -> String {
    let mut worst = LIMITS;
    for (worst, limit) in worst.iter_mut().zip(LIMITS) {
        let of = rows.iter().filter(|p| (p.limit - f64::from(limit)).abs() < 1e-6);
        *worst = of.map(|p| p.strain as f32).fold(limit, f32::max);
    }
    // a larger limit never stretches less
    for i in 1..worst.len() {
        worst[i] = worst[i].max(worst[i - 1] + 1e-3);
    }
    let x = |p: &Point| vec![1.0, f64::from(p.side - 1).ln(), p.limit.ln()];
    let all: Vec<(Vec<f64>, f64)> = rows.iter().map(|p| (x(p), cost(p).ln())).collect();
    let c = fit(&all).coefficients;
    let above = all.iter().map(|(x, y)| y - x.iter().zip(&c).map(|(x, c)| x * c).sum::<f64>());
    let constant = c[0] + quantile(above, 0.75);
    format!(
        "LevelsLaw {{ worst: [{}], constant: {constant:.3}, grid: {:.3}, limit: {:.3} }}",
        worst.map(|w| format!("{w:.4}")).join(", "),
        c[1],
        c[2]
    )
}

/// The strains of a method, and what is added to them for what lies between.
fn strains(points: &[Point], hold: Hold, method: &str) -> String {
    let of = || points.iter().filter(|p| p.hold == hold && p.method == method);
    let mut substeps: Vec<u32> = of().map(|p| p.substeps).collect();
    substeps.sort_unstable();
    substeps.dedup();
    let strain = |side: u32, s: u32| of().find(|p| p.side == side && p.substeps == s).map_or(BLOWN, |p| p.strain);
    let measured: Vec<Vec<f64>> =
        SIDES.iter().map(|side| substeps.iter().map(|s| strain(*side, *s).max(1e-5).ln()).collect()).collect();
    let at: Vec<f64> = substeps.iter().map(|s| f64::from(*s).ln()).collect();
    // where folds fall is chance: what is fitted through neighbours takes it out, a line between them keeps what is smooth
    let (mut ln, margin) = [as_measured(&measured, &at), smoothed(&measured, &at, 1), smoothed(&measured, &at, 2)]
        .into_iter()
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .unwrap_or_default();
    for i in 0..ln.len() {
        for j in 0..substeps.len() {
            let coarser = if i > 0 { ln[i - 1][j] } else { f64::MIN };
            ln[i][j] = ln[i][j].max(coarser);
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

/// ln of the cells of the grids.
fn cells() -> [f64; SIDES.len()] {
    SIDES.map(|side| f64::from(side - 1).ln())
}

fn counts(ln_strain: f64) -> bool {
    RANGE.contains(&ln_strain.exp())
}

/// The margin that only the share [`OUTSIDE`] of the rows lie above.
fn margin(above: Vec<f64>) -> f64 {
    LEAST_MARGIN.max(quantile(above, 1.0 - OUTSIDE))
}

/// The strains as they are, and what they lie above the line through their neighbours.
fn as_measured(ln: &[Vec<f64>], substeps: &[f64]) -> (Vec<Vec<f64>>, f64) {
    let above = |x: &[f64], y: [f64; 3]| y[1] - (y[0] + (y[2] - y[0]) * (x[1] - x[0]) / (x[2] - x[0]));
    let mut all = Vec::new();
    for row in ln {
        let threes = substeps.windows(3).zip(row.windows(3)).filter(|(_, y)| counts(y[1]));
        all.extend(threes.map(|(x, y)| above(x, [y[0], y[1], y[2]])));
    }
    for (x, rows) in cells().windows(3).zip(ln.windows(3)) {
        let columns = rows[0].iter().zip(&rows[1]).zip(&rows[2]).filter(|((_, b), _)| counts(**b));
        all.extend(columns.map(|((a, b), c)| above(x, [*a, *b, *c])));
    }
    (ln.to_vec(), margin(all))
}

/// Each strain by a fit of its order through those of the grids beside and so many numbers of substeps on both sides: 1 is a plane,
/// 2 bends. And what a strain lies above the fit through the others.
fn smoothed(ln: &[Vec<f64>], substeps: &[f64], order: usize) -> (Vec<Vec<f64>>, f64) {
    let n = cells();
    let fitted = |i: usize, j: usize, itself: bool| {
        let mut around = Vec::new();
        for a in i.saturating_sub(1)..(i + 2).min(ln.len()) {
            for b in j.saturating_sub(order)..(j + order + 1).min(substeps.len()) {
                if itself || (a, b) != (i, j) {
                    let (x, y) = (n[a] - n[i], substeps[b] - substeps[j]);
                    let terms = if order == 1 { vec![1.0, x, y] } else { vec![1.0, x, y, x * x, x * y, y * y] };
                    around.push((terms, ln[a][b]));
                }
            }
        }
        fit(&around).coefficients[0]
    };
    let mut above = Vec::new();
    for (i, row) in ln.iter().enumerate() {
        for (j, y) in row.iter().enumerate() {
            if j > 0 && j + 1 < row.len() && i > 0 && i + 1 < ln.len() && counts(*y) {
                above.push(y - fitted(i, j, false));
            }
        }
    }
    let all = (0..ln.len()).map(|i| (0..substeps.len()).map(|j| fitted(i, j, true)).collect()).collect();
    (all, margin(above))
}

/// What bend springs do to strain and price: rows with the other choice beside those of the same grid and substeps.
fn bend(points: &[Point], hold: Hold) -> String {
    let of = |method: &'static str| points.iter().filter(move |p| p.hold == hold && p.method == method);
    let pairs = of("bend").filter_map(|o| {
        of("plain")
            .find(|p| (p.side, p.substeps) == (o.side, o.substeps))
            .map(|p| ((o.strain / p.strain).ln(), cost(o) - cost(p)))
    });
    let (strains, prices): (Vec<f64>, Vec<f64>) = pairs.unzip();
    let ln_strain = strains.into_iter().reduce(f64::max).unwrap_or(0.0);
    format!("Bend {{ kept: {}, ln_strain: {ln_strain:.3}, price: {:.2} }}", bends(hold), quantile(prices, 0.5))
}

/// The law of K as it is, from the rows of a method.
fn fabric_law<'a>(rows: impl Iterator<Item = &'a Point>) -> String {
    let rows: Vec<(Vec<f64>, f64)> = rows
        .filter(|p| LAW_RANGE.contains(&p.strain))
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
         use super::strains::Strains;\nuse super::{Bend, FabricLaw, Hold, LevelsLaw, Price, Row};\n\n",
    );
    let cells: Vec<String> = SIDES.iter().map(|side| format!("{}.0", side - 1)).collect();
    let _ = write!(
        text,
        "/// The limits of levels that were measured.\npub(super) const LIMITS: [f32; 3] = {LIMITS:?};\n\n\
         /// Cells along a side of the grids that were measured.\npub(super) const CELLS: [f32; {}] = [{}];\n\n\
         /// A row for each hold, in the order of their numbers.\n#[rustfmt::skip]\npub(super) const ROWS: [Row; Hold::ALL.len()] = [\n",
        cells.len(),
        cells.join(", ")
    );
    for hold in Hold::ALL {
        let of = |method: &'static str| points.iter().filter(move |p| p.hold == hold && p.method == method);
        let price = |rows: Vec<&Point>, steps: bool| price(&rows, steps);
        let _ = writeln!(
            text,
            "    // {hold:?}\n    Row {{\n        bend: {},\n        plain: {},\n        inertia: {},\n        tethers: {},\n        one_cycle: {},\n        whole: {},\n        implicit: {},\n        \
             plain_price: {},\n        tethers_price: {},\n        one_cycle_price: {},\n        levels: {},\n        implicit_price: {},\n    }},",
            bend(points, hold),
            strains(points, hold, "plain"),
            strains(points, hold, "inertia"),
            strains(points, hold, "tethers"),
            strains(points, hold, "one_cycle"),
            fabric_law(of("whole")),
            fabric_law(of("implicit")),
            price(of("plain").chain(of("inertia")).collect(), true),
            price(of("tethers").collect(), true),
            price(of("one_cycle").collect(), true),
            levels(&of("levels").collect::<Vec<_>>()),
            price(of("implicit").collect(), false),
        );
    }
    text + "];\n"
}

#[cfg(test)]
mod tests {
    use super::super::{csv, read};
    use super::*;

    const DATA: &str = include_str!("../../data/plan.csv");
    const TABLE: &str = include_str!("../../../core/src/plan/table.rs");

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
