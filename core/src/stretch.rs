//! What stretch to expect, told before the first step: a prediction for sheets that hang from an edge, an upper bound for
//! every cloth that is pinned, and whether the limits that were asked for can be kept. See docs/budget.md.

use crate::layout::read;
use crate::math::{max, min, sqrt};
use crate::statics::{Edge, Sheet};
use crate::{BudgetReport, Cloth, Error, Features, in_default_environment};

/// What a [`BudgetReport`] says about itself, as bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct BudgetFlags(pub u32);

impl BudgetFlags {
    /// The predicted stretch is above [`STRETCH_RANGE`]: it is not within 15 % of what will be, and the cloth will look like
    /// rubber.
    pub const ABOVE_RANGE: BudgetFlags = BudgetFlags(1);
    /// There is no prediction: it was not asked for ([`Cloth::predict_stretch`]), the cloth does not hang from a whole straight edge or from its two corners with nothing but its
    /// weight to bear, its warp is more than twice as stiff as its weft or the reverse (two corners), or its rest was not found.
    /// The bound holds.
    pub const STRETCH_UNKNOWN: BudgetFlags = BudgetFlags(2);
    /// Limits were asked for that this cloth may exceed: tethers or the strain limit alone, levels with a mask or with
    /// given [`crate::ClothDef::level_cycles`], or levels with a [`crate::ClothDef::strain_limit`] that is too small for the
    /// step ([`LIMIT_SPEED_M_S`]).
    pub const LIMIT_NOT_KEPT: BudgetFlags = BudgetFlags(4);

    /// Whether every flag of `other` is set.
    pub const fn contains(self, other: BudgetFlags) -> bool {
        self.0 & other.0 == other.0
    }
}

/// Largest predicted strain that is within 15 % of what will be measured.
pub const STRETCH_RANGE: f32 = 0.2;

/// What the levels can take back in a second: they keep a limit where limit x smallest rest length / dt is at least this,
/// in m/s. (10 % at 60 Hz x 16 and 5 % at 60 x 32 on 32 particles a metre, in all scenes of docs/limits.md.)
pub const LIMIT_SPEED_M_S: f32 = 3.0;

/// The bound of a sheet whose stretch is predicted, as a multiple of it: within the range and above it.
const MARGIN: [f32; 2] = [1.25, 2.0];

/// How much stiffer warp or weft may be than the other under two corners.
const BALANCE: f64 = 2.2;

/// How far pins may be from a straight, level edge of the resting length, as a share of it.
const STRAIGHT: f32 = 0.01;

impl Cloth<'_> {
    /// The budget's report with the stretch to expect: [`BudgetReport::stretch`], and a bound that it makes sharper. The rest of
    /// a sheet that hangs from an edge is searched for in its plane, which takes some hundred passes over the springs and more:
    /// from milliseconds at 16 x 16 to seconds at 64 x 64. For a loading screen, not for a frame.
    ///
    /// Error: [`crate::Error::NoStiffness`].
    pub fn predict_stretch(&mut self) -> Result<BudgetReport, Error> {
        self.budget()?;
        let report = self.report;
        Ok(in_default_environment(|| self.predict(report, true)))
    }

    /// Fills in what the springs alone do not tell, with the search for the rest if asked.
    pub(crate) fn predict(&mut self, mut report: BudgetReport, search: bool) -> BudgetReport {
        let mut flags = 0;
        let features = |f: Features| self.def.features.contains(f);
        let limited = features(Features::TETHERS) || features(Features::STRAIN_LIMIT) || features(Features::LEVELS);
        let kept = self.keeps_limit();
        let limit = max(self.def.strain_limit[0], self.def.strain_limit[1]);
        report.stretch_bound = self.energy_bound();
        let hanging = if !search || limited && !kept { None } else { self.hangs_from() };
        let predicted = hanging.and_then(|(edge, whole)| {
            let (l, d) = (self.layout, self.grid.def());
            let gravity = self.ambient.gravity();
            let g = sqrt(gravity.iter().map(|g| g * g).sum());
            let sheet = Sheet {
                layout: &l,
                springs: &self.springs,
                cell: [self.grid.rest_u(), self.grid.rest_v()],
                weight: self.def.density_kg_m2 * d.width_m * d.height_m * g,
                edge,
                whole,
            };
            sheet.largest_strain(self.good)
        });
        report.stretch = predicted.unwrap_or(0.0);
        match predicted {
            None => flags |= BudgetFlags::STRETCH_UNKNOWN.0,
            Some(e) => {
                let above = e > STRETCH_RANGE && !(kept && limit <= STRETCH_RANGE);
                flags |= if above { BudgetFlags::ABOVE_RANGE.0 } else { 0 };
                report.stretch_bound = min(report.stretch_bound, e * MARGIN[usize::from(e > STRETCH_RANGE)]);
            }
        }
        if kept {
            report.stretch = min(report.stretch, limit);
            report.stretch_bound = min(report.stretch_bound, limit);
        } else if limited {
            flags |= BudgetFlags::LIMIT_NOT_KEPT.0;
        }
        report.flags = BudgetFlags(flags);
        report
    }

    /// Whether the levels keep the limit that was asked for.
    fn keeps_limit(&self) -> bool {
        let [warp, weft, _] = self.def.strain_limit;
        let cell = self.grid.least_rest();
        // a rounding of the product must not decide
        let enough = min(warp, weft) * cell >= 0.999 * LIMIT_SPEED_M_S * self.def.dt_s();
        self.layout.levels && self.def.level_cycles == 0 && !self.layout.mask && enough
    }

    /// The edge that the sheet hangs from, and whether by all of it or by its two corners.
    fn hangs_from(&self) -> Option<(Edge, bool)> {
        let l = self.layout;
        let burdened = l.mask
            || l.targets
            || (l.max_colliders > 0 && self.collider_count() > 0)
            || self.air().is_ok_and(|air| air.density_kg_m3 > 0.0 && air.wind_m_s != [0.0; 3])
            || self.ambient.rest_scale() != [1.0; 3]
            || (l.mass && self.masses.iter().any(|m| *m != 0.0 && *m != self.mass));
        let edge = Edge::ALL.into_iter().find_map(|edge| {
            let n = edge.len(l.rows, l.columns);
            let whole = self.pins.count == n && n > 2;
            if !whole && self.pins.count != 2 {
                return None;
            }
            let particle = |i: usize| {
                let (row, column) = edge.at(if whole { i } else { i * (n - 1) }, l.rows, l.columns);
                row * l.columns + column
            };
            let pinned = |i: usize| self.pins.find(particle(i)).is_ok();
            if (0..self.pins.count).all(pinned) { Some((edge, n, whole)) } else { None }
        });
        let (edge, n, whole) = edge?;
        let planar = whole || self.is_balanced();
        if burdened || !planar { None } else { self.is_level(edge, n).then_some((edge, whole)) }
    }

    /// Whether neither of warp and weft is more than [`BALANCE`] times as stiff as the other. Beyond that a sheet on two corners
    /// leaves its plane to hang on the stiffer ones, and stretches up to 2.4 times as much as its plane would.
    fn is_balanced(&self) -> bool {
        let l = self.layout;
        let (mut u, mut v) = (0.0f64, 0.0f64);
        for row in 0..l.rows {
            for column in 0..l.columns {
                u += f64::from(read(self.springs.u, l.at(row, column)));
                v += f64::from(read(self.springs.v, l.at(row, column)));
            }
        }
        // per spring
        u *= (l.rows.saturating_sub(1) * l.columns) as f64;
        v *= (l.columns.saturating_sub(1) * l.rows) as f64;
        u <= BALANCE * v && v <= BALANCE * u
    }

    /// Whether the pins of an edge of n particles stand where a resting, level edge has them.
    fn is_level(&self, edge: Edge, n: usize) -> bool {
        let l = self.layout;
        let place = |i: usize| {
            let (row, column) = edge.at(i, l.rows, l.columns);
            self.pins.find(row * l.columns + column).map(|i| self.pins.get(i).to)
        };
        let (Ok(first), Ok(last)) = (place(0), place(n.saturating_sub(1))) else {
            return false;
        };
        let cell = if matches!(edge, Edge::FirstRow | Edge::LastRow) { self.grid.rest_u() } else { self.grid.rest_v() };
        let length = cell * (n.saturating_sub(1)) as f32;
        let way = [last[0] - first[0], last[1] - first[1], last[2] - first[2]];
        let gravity = self.ambient.gravity();
        let along = way[0] * gravity[0] + way[1] * gravity[1] + way[2] * gravity[2];
        let near = |a: [f32; 3], b: [f32; 3]| norm([a[0] - b[0], a[1] - b[1], a[2] - b[2]]) <= STRAIGHT * length;
        let straight = (0..n).all(|i| {
            let share = i as f32 / max(n.saturating_sub(1) as f32, 1.0);
            // a particle between the corners need not be pinned
            place(i).is_ok_and(|p| near(p, [0, 1, 2].map(|a| first[a] + share * way[a]))) || place(i).is_err()
        });
        straight && (norm(way) - length).abs() <= STRAIGHT * length && along.abs() <= 0.02 * norm(gravity) * length
    }

    /// What the energy allows, at rest and on the way there: from an unstretched start with pins that stay, the springs can hold
    /// no more than the weight has done. A particle falls at most twice its way through the cloth to a pin, of at most c
    /// cells, and what that way is stretched by. So with the load w of a spring, the weight that hangs on it by these ways,
    /// the sum over the springs of k d^2 / 2 - w d is at most 2 weight c a. The others can lower that sum by w^2 / (2 k) each.
    /// With s = weight / (k a) of the softest structural spring: strain <= s + sqrt(s^2 + s c (4 + s)).
    fn energy_bound(&self) -> f32 {
        let l = self.layout;
        let mut softest = f32::INFINITY;
        let mut mass = 0.0f64;
        for row in 0..l.rows {
            for column in 0..l.columns {
                let at = l.at(row, column);
                if column + 1 < l.columns {
                    softest = min(softest, read(self.springs.u, at) * self.grid.rest_u());
                }
                if row + 1 < l.rows {
                    softest = min(softest, read(self.springs.v, at) * self.grid.rest_v());
                }
                mass += f64::from(if l.mass { read(self.masses, at) } else { self.mass });
            }
        }
        if self.pins.count == 0
            || self.pins_are_apart()
            || softest <= 0.0
            || l.mask
            || self.ambient.rest_scale() != [1.0; 3]
        {
            return f32::INFINITY;
        }
        let s = mass as f32 * norm(self.ambient.gravity()) / softest;
        let d = self.grid.def();
        let cells = (d.width_m + d.height_m) / self.grid.least_rest();
        let bound = s + sqrt(s * s + s * cells * (4.0 + s));
        if bound.is_finite() { bound } else { f32::INFINITY }
    }

    /// Whether two pins are farther apart than the cloth between them is long.
    fn pins_are_apart(&self) -> bool {
        let l = self.layout;
        // checked, since a closure does not show the compiler that a grid has columns
        let place = |particle: usize| {
            let (row, column) = (particle.checked_div(l.columns), particle.checked_rem(l.columns));
            (row.unwrap_or(0), column.unwrap_or(0))
        };
        self.pins.iter().enumerate().any(|(i, a)| {
            self.pins.iter().skip(i + 1).any(|b| {
                let ((row, column), (other_row, other_column)) = (place(a.particle), place(b.particle));
                let v = row.abs_diff(other_row) as f32 * self.grid.rest_v();
                let u = column.abs_diff(other_column) as f32 * self.grid.rest_u();
                let d = [a.to[0] - b.to[0], a.to[1] - b.to[1], a.to[2] - b.to[2]];
                norm(d) > 1.001 * sqrt(u * u + v * v)
            })
        })
    }
}

fn norm([x, y, z]: [f32; 3]) -> f32 {
    sqrt(x * x + y * y + z * z)
}
