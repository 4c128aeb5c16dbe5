//! The planner on what its table was not made from: whether its picks meet the tolerance, and what they cost beside the best
//! row of the front.

use taut::plan::{Plan, PlanDef, PlanStiffness, plan};
use taut::{Error, Features, Grid, GridDef};

use crate::compare::Limits;
use crate::distill::{self, hold_of};
use crate::fabric::Fabric;
use crate::front::{Correction, Row, Spec};
use crate::scene::Scene;

/// A pick and what came of it.
#[derive(Clone, Debug)]
pub struct Verdict {
    /// The pick as a row.
    pub spec: Spec,
    /// Largest strain that was asked for.
    pub tolerance: f32,
    /// Largest strain that was told.
    pub told: f32,
    /// Largest strain that was measured, as a fraction; infinite where it blew up.
    pub strain: f64,
    /// What the pick cost.
    pub cost: f64,
    /// The cheapest row that met the tolerance, and its name; None where none did.
    pub best: Option<(f64, String)>,
    /// Whether the planner said that the tolerance would be met.
    pub promised: bool,
}

impl Verdict {
    /// Whether the pick did what was asked.
    pub fn meets(&self) -> bool {
        self.strain <= f64::from(self.tolerance)
    }

    /// Its cost over that of the best row. Below 1 where the pick is cheaper than every row.
    pub fn cost_ratio(&self) -> Option<f64> {
        self.best.as_ref().map(|b| self.cost / b.0)
    }
}

/// What the planner is asked for.
pub fn question(scene: Scene, fabric: &Fabric, tolerance: f32) -> PlanDef {
    PlanDef {
        hold: hold_of(scene),
        stiffness_n_per_m: fabric.stiffness,
        density_kg_m2: fabric.density_kg_m2,
        tolerance,
        ..PlanDef::default()
    }
}

/// A plan as a row.
pub fn row_of(plan: &Plan, scene: Scene, fabric: &'static str, side: u32) -> Spec {
    let has = |f| plan.features.contains(f);
    let limits = if has(Features::LEVELS) && plan.level_cycles > 0 {
        Limits::OneCycle(plan.limit)
    } else if has(Features::LEVELS) {
        Limits::levels(plan.limit)
    } else if has(Features::TETHERS) {
        Limits::Tethers(0.0)
    } else {
        Limits::None
    };
    let correction = match plan.stiffness {
        PlanStiffness::Fabric => Correction::Analytic,
        PlanStiffness::Stiffest if plan.inertia_radius_m > 0.0 => Correction::UniformInertia,
        PlanStiffness::Stiffest => Correction::Uniform,
    };
    Spec {
        substeps: plan.substeps,
        solver: plan.solver,
        cg_iterations: plan.cg_iterations,
        families: plan.families,
        limits,
        ..Spec::new(scene, fabric, side, correction)
    }
}

/// Measures rows, all of one scene and grid.
pub type Measure<'m> = dyn FnMut(&[Spec]) -> Result<Vec<Row>, String> + 'm;

/// Asks for plans of one scene and judges them. `measure` measures their rows and those beside them, `cost` says what one costs.
pub fn judge(
    (scene, fabric, side): (Scene, &'static str, u32),
    tolerances: &[f32],
    measure: &mut Measure<'_>,
    cost: &dyn Fn(&Spec, &Row) -> f64,
) -> Result<Vec<Verdict>, String> {
    let text = |e: Error| e.to_string();
    let grid = Grid::new(&GridDef { rows: side, columns: side, ..GridDef::default() }).map_err(text)?;
    let known = Fabric::named(fabric).ok_or_else(|| format!("`{fabric}` names no fabric"))?;
    let hold = hold_of(scene);
    let mut specs: Vec<Spec> = distill::methods(hold, scene, side, fabric).into_iter().map(|r| r.2).collect();
    specs.push(distill::implicit(hold, scene, side, fabric));
    specs.extend(specs.clone().iter().map(|s| Spec { families: distill::other(s.families), ..*s }));
    specs.push(Spec::reference(scene, fabric, side));
    let beside = specs.len();
    let mut plans = Vec::new();
    for &tolerance in tolerances {
        let p = plan(&grid, &question(scene, &known, tolerance)).map_err(text)?;
        let spec = row_of(&p, scene, fabric, side);
        // measured twice it would be compared with its own noise
        let at = specs.iter().position(|s| s.key() == spec.key()).unwrap_or(specs.len());
        if at == specs.len() {
            specs.push(spec);
        }
        plans.push((p, at));
    }
    let rows: Vec<(f64, f64)> = measure(&specs)?
        .iter()
        .zip(&specs)
        .map(|(row, spec)| (row.stretch_max_pct.map_or(f64::INFINITY, |pct| pct / 100.0), cost(spec, row)))
        .collect();
    let verdict = |(tolerance, (p, at)): (&f32, (Plan, usize))| {
        let met = rows.iter().zip(&specs).take(beside).filter(|(r, _)| r.0 <= f64::from(*tolerance));
        let best = met.min_by(|(a, _), (b, _)| a.1.total_cmp(&b.1)).map(|(r, spec)| (r.1, spec.key()));
        let (strain, cost) = rows[at];
        Verdict { spec: specs[at], tolerance: *tolerance, told: p.strain, strain, cost, best, promised: p.meets }
    };
    Ok(tolerances.iter().zip(plans).map(verdict).collect())
}

/// Share of the promises that were kept, share of the picks within 1.3 times the best row's cost, and the dearest of them.
pub fn summary(verdicts: &[Verdict]) -> [f64; 3] {
    let share = |of: Vec<bool>| of.iter().filter(|x| **x).count() as f64 / of.len().max(1) as f64;
    let kept = share(verdicts.iter().filter(|v| v.promised).map(Verdict::meets).collect());
    let ratios: Vec<f64> = verdicts.iter().filter(|v| v.meets()).filter_map(Verdict::cost_ratio).collect();
    [kept, share(ratios.iter().map(|r| *r <= 1.3).collect()), ratios.iter().copied().fold(0.0, f64::max)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::front::{Bench, Set};
    use taut::Solver;

    /// A grid and a fabric that no row of the table has. Costs are counted in plain steps, so that no clock decides: bend
    /// springs as 0.4, the others as 0.6 and with tethers as 1.1, what is implicit as 100, a step of levels as 25 and one of a
    /// single cycle as 8.
    #[test]
    fn picks_meet_the_tolerance_at_a_fair_cost() {
        let mut none = |_: &str, _: Scene, _: u32| -> Result<Vec<f32>, String> { Err("no generator".into()) };
        let mut bench = Bench::new(Set::Quick, &mut none);
        let cost = |spec: &Spec, row: &Row| {
            let bend = if spec.families.contains(taut::Families::BEND) { 0.4 } else { 0.0 };
            let step = match spec.limits {
                _ if spec.solver != Solver::SymplecticEuler => 100.0,
                Limits::None => 0.6 + bend,
                Limits::Levels(_) | Limits::WhereCut(_) => 25.0,
                Limits::OneCycle(_) => 8.0,
                Limits::Tethers(_) | Limits::StrainLimit(_) => 1.1 + bend,
            };
            step * f64::from(row.substeps)
        };
        let mut measure = |specs: &[Spec]| specs.iter().map(|s| bench.measure(s)).collect();
        for scene in [Scene::Hang2, Scene::Edge] {
            let verdicts = judge((scene, "wool", 22), &[0.02, 0.05, 0.1], &mut measure, &cost).unwrap();
            for v in &verdicts {
                assert!(v.promised && v.meets(), "{scene}: {v:?}");
                assert!(v.strain <= f64::from(v.told), "{scene}: {v:?}");
                assert!(v.cost_ratio().unwrap() <= 1.3, "{scene}: {v:?}");
            }
        }
    }
}
