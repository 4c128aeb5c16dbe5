//! The front of a scene as a chart.

use super::{Correction, Row, SIDE, pareto};
use crate::plot::{Axis, Chart, Mark};

/// Smallest error that is drawn in points: what is nearer to the reference than this is drawn here.
const FLOOR: f64 = 1e-3;

/// The names of the series, in the order of their colours: corrections of explicit rows, then K as it is.
pub const SERIES: [&str; 8] = [
    "random",
    "uniform",
    "analytic",
    "data driven",
    "uniform + inertia",
    "analytic + inertia",
    "generated + inertia",
    "implicit, K as it is",
];

/// CPU time of a simulated second against the strain error of all rows of a scene in a fabric, N = 32; the Pareto front as
/// steps, and the cost of the reference as an upright line. None where no row has an error.
pub fn chart(rows: &[Row], scene: &str, fabric: &str) -> Option<Chart> {
    let here: Vec<&Row> = rows
        .iter()
        .filter(|r| r.scene == scene && r.fabric == fabric && r.side == SIDE && r.strain_error_points.is_some())
        .collect();
    let point = |r: &Row| [r.relative_cost, r.strain_error_points.unwrap_or(f64::NAN).max(FLOOR)];
    let rivals: Vec<&&Row> = here.iter().filter(|r| r.correction != Correction::Reference).collect();
    let all: Vec<[f64; 2]> = rivals.iter().map(|r| point(r)).collect();
    let front: Vec<[f64; 2]> = pareto(&all).into_iter().map(|i| all[i]).collect();
    if front.is_empty() {
        return None;
    }
    let mut chart = Chart::new(
        &format!("{scene}, {fabric}, {SIDE} x {SIDE}: what it costs and how wrong it is"),
        Axis::log("CPU time, 1 = the plain cloth at 60 Hz x 16"),
        Axis::log("strain error against the fabric, points of %"),
    );
    chart.size = (1100, 700);
    let ends = |i: usize| {
        let all = all.iter().map(|p| p[i]);
        all.fold([f64::INFINITY, 0.0f64], |[low, high], x| [low.min(x), high.max(x)])
    };
    let [cheapest, dearest] = ends(0);
    // the legend stands to the right of the dearest row
    chart.x.range = Some([cheapest / 1.3, 8.0 * dearest]);
    // first what the rows are seen before
    chart = chart.with("the front", Mark::Steps, front);
    let reference = here.iter().find(|r| r.correction == Correction::Reference);
    let line = reference.map_or(Vec::new(), |r| ends(1).map(|y| [r.relative_cost, y]).to_vec());
    chart = chart.with("cost of the reference", Mark::Line, line);
    for (i, name) in SERIES.into_iter().enumerate() {
        let of = |r: &&&&Row| match Correction::ALL.get(i) {
            Some(correction) => r.correction == *correction && r.solver == "euler",
            None => r.solver != "euler",
        };
        let points = rivals.iter().filter(of).map(|r| point(r)).collect();
        chart = chart.with(name, Mark::Points, points);
    }
    Some(chart)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::front::row::tests::row;
    use crate::plot::Figure;

    #[test]
    fn a_scene_has_its_chart() {
        let mut rows = vec![
            row(Correction::Reference, "none", 4.0, 5.8, 0.0),
            row(Correction::Uniform, "none", 1.0, 15.0, 2.0),
            row(Correction::Generated, "none", 1.1, 5.0, 0.7),
        ];
        let c = chart(&rows, "hang2", "denim").unwrap();
        assert_eq!(c.series.len(), SERIES.len() + 2);
        assert_eq!(c.series[0].points, [[1.0, 2.0], [1.1, 0.7]]);
        assert!(c.png().is_ok());
        assert_eq!(chart(&rows, "edge", "denim"), None);
        rows.truncate(1);
        assert_eq!(chart(&rows, "hang2", "denim"), None);
    }
}
