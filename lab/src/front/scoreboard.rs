//! The corrections at equal cost.

use serde::Serialize;

use super::{Correction, Row, SIDE};

/// A row may cost this much more and still count as equally dear: times are noisy.
const SLACK: f64 = 1.2;

/// Names of the limits, "none" first.
const LIMITS: [&str; 5] = ["none", "tethers", "strain_limit", "levels", "one_cycle"];

/// How a correction fares under a limit at a cost: medians over the scenes in which it has a row that cheap.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Cell {
    /// Where the stiffness comes from.
    pub correction: Correction,
    /// none, tethers, strain_limit, levels or one_cycle.
    pub limits: &'static str,
    /// In how many scenes it has a row that cheap.
    pub scenes: usize,
    /// Median of the strain error against the fabric's reference.
    pub strain_error_points: Option<f64>,
    /// Median of the largest stretch of the same rows.
    pub stretch_max_pct: Option<f64>,
    /// Median of the cost of the same rows, in plain cloths at 60 Hz x 16.
    pub relative_cost: Option<f64>,
}

/// What the corrections reach at one cost, in one fabric.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Scoreboard {
    /// The fabric.
    pub fabric: String,
    /// In plain cloths of the same scene at 60 Hz x 16.
    pub cost: f64,
    /// How many scenes were measured.
    pub scenes: usize,
    /// All corrections, each with every limit.
    pub cells: Vec<Cell>,
}

impl Scoreboard {
    /// The best row of every correction and limit that costs at most `cost` times the plain uniform cloth at 60 Hz x 16 of
    /// its scene, explicit and with all families. Best is the least strain error; where it blew up it has none.
    pub fn new(rows: &[Row], fabric: &str, cost: f64) -> Scoreboard {
        let compared: Vec<&Row> = rows
            .iter()
            .filter(|r| r.fabric == fabric && r.side == SIDE && r.solver == "euler" && r.families == "all")
            .collect();
        let plain: Vec<&&Row> = compared
            .iter()
            .filter(|r| {
                r.correction == Correction::Uniform && r.limits == "none" && r.substeps == 16 && r.rate_hz == 60.0
            })
            .collect();
        let mut cells = Vec::new();
        for correction in Correction::ALL {
            for limits in LIMITS {
                let best: Vec<&&Row> = plain
                    .iter()
                    .filter_map(|base| {
                        let cheap = compared.iter().filter(|r| {
                            r.scene == base.scene
                                && r.correction == correction
                                && r.limits == limits
                                && r.relative_cost <= SLACK * cost * base.relative_cost
                        });
                        let wrong = |r: &Row| r.strain_error_points.unwrap_or(f64::INFINITY);
                        cheap.min_by(|a, b| wrong(a).total_cmp(&wrong(b)))
                    })
                    .collect();
                let median = |of: fn(&Row) -> Option<f64>| {
                    // what blew up is the worst, not left out
                    let mut all: Vec<f64> = best.iter().map(|r| of(r).unwrap_or(f64::INFINITY)).collect();
                    all.sort_by(f64::total_cmp);
                    if all.is_empty() {
                        return None;
                    }
                    Some(0.5 * (all[(all.len() - 1) / 2] + all[all.len() / 2])).filter(|x| x.is_finite())
                };
                cells.push(Cell {
                    correction,
                    limits,
                    scenes: best.len(),
                    strain_error_points: median(|r| r.strain_error_points),
                    stretch_max_pct: median(|r| r.stretch_max_pct),
                    relative_cost: median(|r| Some(r.relative_cost)),
                });
            }
        }
        Scoreboard { fabric: fabric.into(), cost, scenes: plain.len(), cells }
    }

    /// The cell of a correction with a limit.
    pub fn cell(&self, correction: Correction, limits: &str) -> Option<&Cell> {
        self.cells.iter().find(|c| c.correction == correction && c.limits == limits)
    }

    /// How the generated field does beside the best of the others under the same limit, in a sentence each.
    pub fn verdicts(&self) -> Vec<String> {
        let mut verdicts = Vec::new();
        for limits in LIMITS {
            let error = |c: &Cell| c.strain_error_points.filter(|_| c.scenes == self.scenes);
            let Some(own) = self.cell(Correction::Generated, limits).and_then(error) else { continue };
            let others = self.cells.iter().filter(|c| c.limits == limits && c.correction != Correction::Generated);
            let best = others.filter_map(|c| error(c).map(|e| (c, e))).min_by(|a, b| a.1.total_cmp(&b.1));
            let Some((best, least)) = best else { continue };
            let word = if own < least { "wins" } else { "loses" };
            verdicts.push(format!(
                "{}, cost {}, {}: the learned field {word}, {own:.2} points against {least:.2} of {}",
                self.fabric,
                self.cost,
                if limits == "none" { "alone".into() } else { format!("with {}", limits.replace('_', " ")) },
                best.correction.name()
            ));
        }
        verdicts
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::front::row::tests::row;

    #[test]
    fn the_best_row_that_is_cheap_enough_counts() {
        let rows = [
            row(Correction::Uniform, "none", 1.0, 15.0, 2.0),
            row(Correction::Generated, "none", 1.1, 5.0, 0.7),
            row(Correction::Generated, "none", 0.5, 9.0, 1.7),
            row(Correction::Generated, "none", 3.0, 4.0, 0.1),
            row(Correction::UniformInertia, "none", 1.0, 3.0, 0.9),
            row(Correction::Random, "none", 1.0, f64::NAN, f64::NAN),
        ];
        let board = Scoreboard::new(&rows, "denim", 1.0);
        assert_eq!(board.scenes, 1);
        let cell = board.cell(Correction::Generated, "none").unwrap();
        assert_eq!((cell.scenes, cell.strain_error_points, cell.stretch_max_pct), (1, Some(0.7), Some(5.0)));
        let random = board.cell(Correction::Random, "none").unwrap();
        assert_eq!((random.scenes, random.strain_error_points), (1, None));
        assert_eq!(board.cell(Correction::Generated, "levels").unwrap().scenes, 0);
        assert_eq!(board.verdicts().len(), 1);
        assert!(
            board.verdicts()[0].contains("wins, 0.70 points against 0.90 of uniform_inertia"),
            "{:?}",
            board.verdicts()
        );
        let dear = Scoreboard::new(&rows, "denim", 4.0);
        assert_eq!(dear.cell(Correction::Generated, "none").unwrap().strain_error_points, Some(0.1));
    }
}
