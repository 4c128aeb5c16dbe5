use std::sync::Arc;

use super::ClothError;
use super::equilibrium::{Cloth, Outcome};
use super::hessian::Pattern;
use super::projection::{Budget, Projection, TUNED_FRACTION, inertia};
use super::relax::hanging_sheet;
use super::springs::{CHANNELS, Springs};

/// Most Newton iterations from the last shape, and from a first shape.
const MOST_ITERATIONS: [usize; 2] = [100, 600];

/// Largest residual force on a particle as a share of its weight.
const TOLERANCE: f64 = 1e-6;

/// A particle held at a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pin {
    /// Index of the particle.
    pub particle: usize,
    /// Where it is held, in m.
    pub position_m: [f64; 3],
}

/// What a scene is made of beside its springs. SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneDef {
    /// Pins: at least one, and not all particles.
    pub pins: Vec<Pin>,
    /// Mass per area in kg/m^2, above 0. Each particle has the same share of the sheet's mass. Default 0.2.
    pub density_kg_m2: f64,
    /// Gravity in m/s^2, not zero. Default (0, -9.81, 0).
    pub gravity_m_s2: [f64; 3],
    /// Length of a substep in s, above 0: what the budget is for. Default 1/960.
    pub dt_s: f64,
    /// Damping c in 1/s, c dt below 1. It counts in the budget only. Default 2.
    pub damping_per_s: f64,
    /// Share of the stability limit to fill, above 0, at most 1. Default [`TUNED_FRACTION`].
    pub fraction: f64,
    /// Radius of the inertia field in m, 0 = none. It counts in the budget only. Default 0.3.
    pub inertia_radius_m: f64,
    /// Largest q of the inertia field, at least 1. Default 32.
    pub inertia_max: f64,
    /// Whether springs shorter than half their rest length push with k times their length, as in core. Default true.
    pub compression_limit: bool,
}

impl SceneDef {
    /// The defaults, with `particles` pinned where the flat sheet hangs vertically from row 0: hang2 is the two top
    /// corners, edge the top row, hang1 particle 0. Particles that do not exist are refused by [`Scene::new`].
    pub fn hung(springs: &Springs, particles: &[usize]) -> SceneDef {
        SceneDef {
            pins: particles.iter().map(|&p| Pin { particle: p, position_m: springs.hung_flat(p) }).collect(),
            density_kg_m2: 0.2,
            gravity_m_s2: [0.0, -9.81, 0.0],
            dt_s: 1.0 / 960.0,
            damping_per_s: 2.0,
            fraction: TUNED_FRACTION,
            inertia_radius_m: 0.3,
            inertia_max: 32.0,
            compression_limit: true,
        }
    }

    fn check(&self, particles: usize) -> Result<(), ClothError> {
        let range = |what, value: f64, good: bool| match good {
            true => Ok(()),
            false => Err(ClothError::OutOfRange { what, value }),
        };
        let gravity = self.gravity_m_s2.iter().map(|g| g * g).sum::<f64>().sqrt();
        range("density in kg/m^2", self.density_kg_m2, (1e-6..=1e6).contains(&self.density_kg_m2))?;
        range("gravity in m/s^2", gravity, (1e-6..=1e4).contains(&gravity))?;
        range("time step in s", self.dt_s, (1e-9..=1.0).contains(&self.dt_s))?;
        let damping = self.damping_per_s;
        range("damping in 1/s", damping, damping >= 0.0 && damping * self.dt_s < 1.0)?;
        range("share of the budget", self.fraction, self.fraction > 0.0 && self.fraction <= 1.0)?;
        range("inertia radius in m", self.inertia_radius_m, (0.0..=1e4).contains(&self.inertia_radius_m))?;
        range("largest inertia", self.inertia_max, (1.0..=1e4).contains(&self.inertia_max))?;
        let mut pinned = vec![false; particles];
        for pin in &self.pins {
            let seen = pinned.get_mut(pin.particle).ok_or(ClothError::Pin { particle: pin.particle })?;
            if std::mem::replace(seen, true) {
                return Err(ClothError::Pin { particle: pin.particle });
            }
            for value in pin.position_m {
                range("position of a pin in m", value, value.abs() <= 1e5)?;
            }
        }
        Ok(())
    }
}

/// How a solve ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settled {
    /// Whether the shape is a minimum of the energy with every component of the residual force within 1e-6 of a
    /// particle's weight. Where it is not, the shape is the last one tried and its gradient is zero.
    pub settled: bool,
    /// Largest component of the residual force in N.
    pub residual_n: f64,
    /// Newton iterations.
    pub iterations: usize,
    /// How much of the springs' total stiffness the budget took away, 0 to 1.
    pub cut_fraction: f64,
}

/// What does not change from solve to solve; shared by clones of a scene.
#[derive(Debug)]
struct Fixed {
    springs: Arc<Springs>,
    def: SceneDef,
    mass_kg: f64,
    budget: Budget,
    pattern: Pattern,
}

impl Fixed {
    fn cloth<'a>(&'a self, projection: &'a Projection) -> Cloth<'a> {
        Cloth {
            springs: &self.springs,
            pattern: &self.pattern,
            stiffness: projection.stiffness(),
            weight_n: self.def.gravity_m_s2.map(|g| g * self.mass_kg),
            limit: self.def.compression_limit,
        }
    }
}

/// A cloth that hangs somewhere: pins, masses, time step, and the shape in which the next solve starts. Clones share
/// everything but that shape.
#[derive(Clone, Debug)]
pub struct Scene {
    fixed: Arc<Fixed>,
    last: Option<Vec<[f64; 3]>>,
}

impl Scene {
    /// Checks a definition and prepares the solver. Errors: [`ClothError::OutOfRange`], [`ClothError::Pin`],
    /// [`ClothError::Pins`], [`ClothError::Factorisation`].
    pub fn new(springs: &Arc<Springs>, def: SceneDef) -> Result<Scene, ClothError> {
        let n = springs.particles();
        def.check(n)?;
        let mut pinned = vec![false; n];
        def.pins.iter().for_each(|p| pinned[p.particle] = true);
        let pattern = Pattern::new(springs, &pinned)?;
        let mass_kg = def.density_kg_m2 * springs.width_m() * springs.height_m() / n as f64;
        let q = inertia(springs, &pinned, def.inertia_radius_m, def.inertia_max);
        let budget = Budget {
            dt_s: def.dt_s,
            damping_per_s: def.damping_per_s,
            fraction: def.fraction,
            inertial_mass_kg: q.iter().map(|q| q * mass_kg).collect(),
            pinned,
        };
        Ok(Scene { fixed: Arc::new(Fixed { springs: springs.clone(), def, mass_kg, budget, pattern }), last: None })
    }

    /// The spring network.
    pub fn springs(&self) -> &Arc<Springs> {
        &self.fixed.springs
    }

    /// The definition it was made from.
    pub fn def(&self) -> &SceneDef {
        &self.fixed.def
    }

    /// The budget that the field is projected to.
    pub fn budget(&self) -> &Budget {
        &self.fixed.budget
    }

    /// The shape in m in which the next solve starts: the last one that settled. None: a hanging sheet.
    pub fn start(&self) -> Option<&[[f64; 3]]> {
        self.last.as_deref()
    }

    /// Sets the shape in which the next solve starts, one position in m per particle (pins stay where they are), or
    /// forgets it. Errors: [`ClothError::Shape`], [`ClothError::OutOfRange`].
    pub fn set_start(&mut self, start: Option<Vec<[f64; 3]>>) -> Result<(), ClothError> {
        if let Some(start) = &start {
            let expected = self.springs().particles();
            if start.len() != expected {
                let (expected, found) = (vec![expected], vec![start.len()]);
                return Err(ClothError::Shape { what: "a start", expected, found });
            }
            if let Some(&value) = start.as_flattened().iter().find(|x| x.is_nan() || x.abs() > 1e5) {
                return Err(ClothError::OutOfRange { what: "position of a start in m", value });
            }
        }
        self.last = start;
        Ok(())
    }

    /// The shape at rest for `field`, `[channel][row][column]` in N/m, projected to the budget. Starts in the last shape
    /// that settled; from a hanging sheet where there is none, or where that leads nowhere. Errors:
    /// [`ClothError::Shape`], [`ClothError::Stiffness`] (as item 0). A shape that does not settle is no error:
    /// [`Solution::outcome`] says so.
    pub fn solve(&mut self, field: &[f64]) -> Result<Solution, ClothError> {
        self.check_field(field, 0)?;
        Ok(self.solve_checked(field))
    }

    /// Whether `field` has the right length and only finite numbers of at least 0.
    pub(super) fn check_field(&self, field: &[f64], item: usize) -> Result<(), ClothError> {
        let springs = self.springs();
        let (rows, columns, n) = (springs.rows(), springs.columns(), springs.particles());
        if field.len() != CHANNELS * n {
            let (expected, found) = (vec![CHANNELS, rows, columns], vec![field.len()]);
            return Err(ClothError::Shape { what: "a stiffness field", expected, found });
        }
        match field.iter().position(|k| !(*k >= 0.0 && k.is_finite())) {
            Some(j) => Err(ClothError::Stiffness { item, channel: j / n, row: j % n / columns, column: j % columns }),
            None => Ok(()),
        }
    }

    pub(super) fn solve_checked(&mut self, field: &[f64]) -> Solution {
        let fixed = &self.fixed;
        let projection = Projection::new(&fixed.springs, &fixed.budget, field);
        let cloth = fixed.cloth(&projection);
        let weight = fixed.mass_kg * fixed.def.gravity_m_s2.iter().map(|g| g * g).sum::<f64>().sqrt();
        let hold = |x: &mut Vec<[f64; 3]>| fixed.def.pins.iter().for_each(|p| x[p.particle] = p.position_m);
        let attempt = |mut x: Vec<[f64; 3]>, most| {
            let outcome = cloth.settle(&mut x, TOLERANCE * weight, most);
            (x, outcome)
        };
        let warm = self.last.take().map(|mut x| {
            hold(&mut x);
            attempt(x, MOST_ITERATIONS[0])
        });
        let (positions, outcome) = match warm {
            Some(end) if end.1.settled => end,
            _ => {
                let mut x = hanging_sheet(&fixed.springs);
                hold(&mut x);
                cloth.relax(&mut x, fixed.mass_kg);
                attempt(x, MOST_ITERATIONS[1])
            }
        };
        let Outcome { residual_n, iterations, settled } = outcome;
        self.last = settled.then(|| positions.clone());
        let outcome = Settled { settled, residual_n, iterations, cut_fraction: projection.cut_fraction() };
        Solution { fixed: fixed.clone(), projection, positions, outcome }
    }
}

/// A shape at rest, and what its gradient needs.
#[derive(Clone, Debug)]
pub struct Solution {
    fixed: Arc<Fixed>,
    projection: Projection,
    positions: Vec<[f64; 3]>,
    outcome: Settled,
}

impl Solution {
    /// Position of every particle in m.
    pub fn positions(&self) -> &[[f64; 3]] {
        &self.positions
    }

    /// How the solve ended.
    pub fn outcome(&self) -> Settled {
        self.outcome
    }

    /// The projected field.
    pub fn projection(&self) -> &Projection {
        &self.projection
    }

    /// Strain of every spring, l/L0 - 1, in the order of [`Springs::list`].
    pub fn strains(&self) -> Vec<f64> {
        let x = &self.positions;
        let strain = |s: &super::Spring| {
            let d = super::equilibrium::vector(x, s.a, s.b);
            (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt() / s.rest_m - 1.0
        };
        self.fixed.springs.list().iter().map(strain).collect()
    }

    /// Gradient of a loss with respect to the field, `[channel][row][column]`, from its gradient with respect to the
    /// positions (one entry per particle). Zero where the shape did not settle. Errors: [`ClothError::Shape`].
    pub fn gradient(&self, by_position: &[[f64; 3]]) -> Result<Vec<f64>, ClothError> {
        if by_position.len() != self.positions.len() {
            let (expected, found) = (vec![self.positions.len()], vec![by_position.len()]);
            return Err(ClothError::Shape { what: "a gradient by position", expected, found });
        }
        if !self.outcome.settled {
            return Ok(vec![0.0; CHANNELS * self.positions.len()]);
        }
        let by_spring = self.fixed.cloth(&self.projection).adjoint(&self.positions, by_position);
        Ok(self.projection.vjp(&self.fixed.springs, &self.fixed.budget, &by_spring))
    }
}
