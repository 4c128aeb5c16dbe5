//! Measures rows.

use std::collections::HashMap;

use taut::{Error, Solver};

use super::row::finite;
use super::spec::{families_name, solver_name};
use super::{Correction, Row, Set, Spec, Trace, fit, plain_ns};
use crate::compare::{Case, Limits, Model, Outcome, Setting, run_model};
use crate::fabric::Fabric;
use crate::metrics::percentile;
use crate::scene::Scene;

/// Where a generated field `[4][rows][columns]` in N/m comes from: the fabric in words, a scene, particles of a side.
pub type Generate<'a> = dyn FnMut(&str, Scene, u32) -> Result<Vec<f32>, String> + 'a;

/// The sheet of all rows in m.
const SIZE_M: [f32; 2] = [1.0, 1.0];
const SEED: u64 = 0;

/// How much of K may be missing where it is still called the same.
const SAME: f64 = 1e-6;

/// References of this many grids are kept.
const KEPT: usize = 16;

/// A reference: what it did and what came out.
struct Reference {
    trace: Trace,
    /// Strains in the order of the springs.
    strains: Vec<f64>,
}

/// Measures rows, and keeps what several of them share.
pub struct Bench<'a> {
    set: Set,
    generate: &'a mut Generate<'a>,
    references: HashMap<(Scene, &'static str, u32), Reference>,
    fitted: HashMap<String, [f32; 4]>,
}

impl<'a> Bench<'a> {
    /// A bench with a generator.
    pub fn new(set: Set, generate: &'a mut Generate<'a>) -> Bench<'a> {
        Bench { set, generate, references: HashMap::new(), fitted: HashMap::new() }
    }

    /// Measures a row. The error says which one.
    pub fn measure(&mut self, spec: &Spec) -> Result<Row, String> {
        self.row(spec).map_err(|e| format!("{}: {e}", spec.key()))
    }

    fn row(&mut self, spec: &Spec) -> Result<Row, String> {
        let text = |e: Error| e.to_string();
        let fabric = fabric(spec.fabric)?;
        let setting = match spec.correction {
            Correction::Reference => Setting::Reference(fabric.clone()),
            Correction::Random => Setting::Random,
            Correction::Uniform => Setting::Uniform,
            Correction::Analytic => Setting::Analytic(fabric.clone()),
            Correction::UniformInertia => Setting::UniformInertia,
            Correction::AnalyticInertia => Setting::AnalyticInertia(fabric.clone()),
            Correction::DataDriven => Setting::DataDriven(self.fit(spec, &fabric).map_err(text)?),
            Correction::Generated => Setting::Generated((self.generate)(spec.fabric, spec.scene, spec.side)?),
        };
        let model = Model {
            families: spec.families,
            solver: spec.solver,
            cg_iterations: spec.cg_iterations,
            limits: spec.limits,
            ..setting.into()
        };
        let case = self.case(spec, &fabric);
        let before = plain_ns().map_err(text)?;
        let (trace, outcome) = run(&case, &model).map_err(text)?;
        let plain = before.min(plain_ns().map_err(text)?);
        if spec.correction == Correction::Reference {
            self.keep(spec, &case, &trace);
        }
        let reference = self.reference(spec.scene, spec.fabric, spec.side).map_err(text)?;
        Ok(row(spec, &trace, &outcome, &reference.trace, plain))
    }

    fn case(&self, spec: &Spec, fabric: &Fabric) -> Case {
        let seconds = self.set.seconds(spec.scene);
        let square = Case::square(spec.scene, fabric, spec.side, spec.substeps, seconds);
        Case { size_m: SIZE_M, rate_hz: spec.rate_hz, seed: SEED, ..square }
    }

    fn keep(&mut self, spec: &Spec, case: &Case, trace: &Trace) {
        if self.references.len() >= KEPT {
            self.references.clear();
        }
        let strains = fit::strains(case, &trace.positions);
        let reference = Reference { trace: trace.clone(), strains };
        self.references.insert((spec.scene, spec.fabric, spec.side), reference);
    }

    /// The reference of a scene, run where it is not known.
    fn reference(&mut self, scene: Scene, words: &'static str, side: u32) -> Result<&Reference, Error> {
        let key = (scene, words, side);
        if !self.references.contains_key(&key) {
            let Ok(fabric) = fabric(words) else { return Err(Error::OutOfRange) };
            let spec = Spec::reference(scene, words, side);
            let case = self.case(&spec, &fabric);
            let (trace, _) = run(&case, &Setting::Reference(fabric).into())?;
            self.keep(&spec, &case, &trace);
        }
        self.references.get(&key).ok_or(Error::OutOfRange)
    }

    /// The data-driven numbers for the grid and the step of a row, found without limits.
    fn fit(&mut self, spec: &Spec, fabric: &Fabric) -> Result<[f32; 4], Error> {
        let key = format!("{}/{}/{}x{}", spec.fabric, spec.side, spec.rate_hz, spec.substeps);
        if let Some(k) = self.fitted.get(&key) {
            return Ok(*k);
        }
        let mut goals = Vec::new();
        for scene in [Scene::Hang2, Scene::Edge] {
            let goal = self.reference(scene, spec.fabric, spec.side)?.strains.clone();
            goals.push((self.case(&Spec { scene, limits: Limits::None, ..*spec }, fabric), goal));
        }
        let found = fit::to_strains(fabric, &goals)?;
        self.fitted.insert(key, found);
        Ok(found)
    }
}

fn fabric(words: &str) -> Result<Fabric, String> {
    Fabric::named(words).ok_or_else(|| format!("`{words}` names no fabric"))
}

fn run(case: &Case, model: &Model) -> Result<(Trace, Outcome), Error> {
    let mut trace = Trace::default();
    let outcome = run_model(case, model, |cloth, frame| trace.take(case.scene, case.rate_hz, cloth, frame))?;
    trace.finish();
    Ok((trace, outcome))
}

fn row(spec: &Spec, trace: &Trace, outcome: &Outcome, reference: &Trace, plain: f64) -> Row {
    let mut frames = trace.frames_s.clone();
    frames.sort_by(f64::total_cmp);
    let median_s = percentile(&frames, 0.5);
    let particles = f64::from(spec.side * spec.side);
    let ns = 1e9 * median_s / (particles * f64::from(outcome.substeps));
    let [max, p99, mean] = trace.stretch_pct();
    let explicit = spec.solver == Solver::SymplecticEuler;
    let physical = matches!(spec.correction, Correction::Reference | Correction::Analytic);
    let exact = matches!(spec.scene, Scene::Hang2 | Scene::Edge);
    let sound = |x: f64| if outcome.finite { finite(x) } else { None };
    let only = |when: bool, x: f64| if when { sound(x) } else { None };
    let relative = |a: f64, b: f64| 100.0 * (a / b - 1.0);
    Row {
        scene: spec.scene.name().into(),
        fabric: spec.fabric.into(),
        side: spec.side,
        rate_hz: spec.rate_hz,
        substeps: outcome.substeps,
        solver: solver_name(spec.solver).into(),
        cg_iterations: (!explicit).then_some(spec.cg_iterations),
        families: families_name(spec.families).into(),
        limits: spec.limits.name().into(),
        limit_pct: spec.limits.strain().map(|s| f64::from((s * 1e4).round()) / 100.0),
        correction: spec.correction,
        ns_per_particle_step: ns,
        cost_in_plain_steps: ns / plain,
        cpu_ms_per_simulated_s: 1e3 * median_s * f64::from(spec.rate_hz),
        frame_us_p95: 1e6 * percentile(&frames, 0.95),
        relative_cost: ns / plain * f64::from(outcome.substeps) * f64::from(spec.rate_hz) / 960.0,
        memory_bytes: outcome.memory_bytes as u64,
        stretch_max_pct: sound(max),
        stretch_p99_pct: sound(p99),
        stretch_mean_pct: sound(mean),
        peak_stretch_pct: sound(outcome.peak_stretch_pct),
        strain_error_points: sound(trace.strain_error_points(reference)),
        distance_pct: only(exact, 100.0 * trace.distance_m(reference) / f64::from(SIZE_M[0].max(SIZE_M[1]))),
        centre_error_mm: sound(1e3 * trace.centre_error_m(reference)),
        kinetic_energy_error_pct: only(
            !spec.scene.rests(),
            relative(trace.kinetic_energy(), reference.kinetic_energy()),
        ),
        period_error_pct: only(
            spec.scene == Scene::Swing,
            relative(trace.swing_period_s(spec.rate_hz), reference.swing_period_s(60.0)),
        ),
        same_stiffness: physical && outcome.cut_fraction < SAME && spec.families.0 == 7,
        cut_fraction: outcome.cut_fraction,
        inertia_added: outcome.inertia_added,
        rms_speed_m_s: sound(outcome.rms_speed_m_s),
        finite: outcome.finite,
        state_hash: outcome.state_hash.clone(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::front::FABRICS;

    #[test]
    fn the_reference_is_its_own_truth_and_a_row_repeats_itself() {
        let mut none = |_: &str, _: Scene, _: u32| -> Result<Vec<f32>, String> { Err("no generator".into()) };
        let mut bench = Bench::new(Set::Quick, &mut none);
        let reference = bench.measure(&Spec::reference(Scene::Edge, FABRICS[0], 12)).unwrap();
        assert!(reference.same_stiffness && reference.finite);
        assert_eq!((reference.strain_error_points, reference.distance_pct), (Some(0.0), Some(0.0)));

        let uniform =
            Spec { correction: Correction::Uniform, substeps: 4, ..Spec::reference(Scene::Edge, FABRICS[0], 12) };
        let (a, b) = (bench.measure(&uniform).unwrap(), bench.measure(&uniform).unwrap());
        assert_eq!(
            (&a.state_hash, a.stretch_max_pct, a.strain_error_points),
            (&b.state_hash, b.stretch_max_pct, b.strain_error_points)
        );
        assert!(a.stretch_max_pct > reference.stretch_max_pct, "{a:?}");
        assert!(a.strain_error_points > Some(0.1) && a.distance_pct > Some(0.1) && !a.same_stiffness, "{a:?}");

        // implicit Euler comes to the same rest without its K being cut
        let implicit = Spec { correction: Correction::Analytic, solver: Solver::ImplicitEuler, substeps: 1, ..uniform };
        let rest = bench.measure(&implicit).unwrap();
        assert!(rest.same_stiffness && rest.strain_error_points < Some(0.05), "{rest:?}");

        let missing = Spec { correction: Correction::Generated, ..uniform };
        assert!(bench.measure(&missing).unwrap_err().contains("no generator"));
    }

    #[test]
    fn the_fit_is_nearer_than_what_it_starts_from() {
        let mut none = |_: &str, _: Scene, _: u32| -> Result<Vec<f32>, String> { Err("no generator".into()) };
        let mut bench = Bench::new(Set::Quick, &mut none);
        let base = Spec { substeps: 4, ..Spec::reference(Scene::Hang2, FABRICS[0], 10) };
        let error = |bench: &mut Bench<'_>, correction| {
            let both = [Scene::Hang2, Scene::Edge].map(|scene| {
                let row = bench.measure(&Spec { scene, correction, ..base }).unwrap();
                row.strain_error_points.unwrap()
            });
            both.iter().sum::<f64>()
        };
        let (fitted, analytic) = (error(&mut bench, Correction::DataDriven), error(&mut bench, Correction::Analytic));
        assert!(fitted < analytic, "{fitted} against {analytic}");
    }

    #[test]
    fn strains_have_the_order_of_the_springs() {
        let fabric = fabric(FABRICS[0]).unwrap();
        let mut none = |_: &str, _: Scene, _: u32| -> Result<Vec<f32>, String> { Err("no generator".into()) };
        let bench = Bench::new(Set::Quick, &mut none);
        let case = bench.case(&Spec::reference(Scene::Hang2, FABRICS[0], 5), &fabric);
        let mut told = Vec::new();
        let outcome = run_model(&case, &Setting::Uniform.into(), |cloth, _| {
            told.clear();
            cloth.each_structural_strain(|_, _, s| told.push(f64::from(s)));
        });
        let found = fit::strains(&case, &outcome.unwrap().positions);
        assert_eq!(found.len(), told.len());
        assert!(found.iter().zip(&told).all(|(a, b)| (a - b).abs() < 1e-5));
    }
}
