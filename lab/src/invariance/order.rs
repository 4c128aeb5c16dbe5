//! The order of each solver by Richardson: halving the step twice, the differences of the results fall by 2^order.

use serde::Serialize;
use taut::{Cloth, ClothDef, Error, Families, Features, GridDef, Solver, Vector3};

use super::swing::{J0_ZERO, j0};
use super::{positions, with_cloth};

/// Scenes whose motion is smooth.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Smooth {
    /// Two particles on a spring each, pulled down.
    Spring,
    /// Five rows of two particles hang stretched by their weight and swing a little.
    Chain,
    /// A sheet swings in its plane along v within its linear range.
    Sheet,
}

impl Smooth {
    /// All of them.
    pub const ALL: [Smooth; 3] = [Smooth::Spring, Smooth::Chain, Smooth::Sheet];

    /// The name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Smooth::Spring => "spring",
            Smooth::Chain => "chain",
            Smooth::Sheet => "sheet",
        }
    }

    fn grid(self) -> GridDef {
        let families = Families::STRUCTURAL;
        let plain = GridDef { families, ..GridDef::default() };
        match self {
            Smooth::Spring => GridDef { rows: 2, columns: 2, ..plain },
            Smooth::Chain => GridDef { rows: 5, columns: 2, width_m: 0.25, ..plain },
            Smooth::Sheet => GridDef { rows: 8, columns: 8, ..plain },
        }
    }

    fn stiffness(self) -> [f32; 4] {
        match self {
            Smooth::Spring => [20.0, 0.0, 0.0, 0.0],
            Smooth::Chain | Smooth::Sheet => [20.0, 20.0, 0.0, 0.0],
        }
    }

    fn gravity(self) -> [f32; 3] {
        if self == Smooth::Chain { [0.0, -9.81, 0.0] } else { [0.0; 3] }
    }

    /// Frames of the coarsest step and its rate: what resolves the motion, and the explicit solver carries.
    fn coarsest(self, solver: Solver) -> (u32, f32) {
        match (self, solver) {
            (Smooth::Spring, Solver::Bdf2) => (160, 320.0),
            (Smooth::Spring, _) => (320, 640.0),
            (Smooth::Chain, Solver::SymplecticEuler) => (200, 400.0),
            (Smooth::Chain, Solver::ImplicitEuler) => (80, 160.0),
            (Smooth::Chain, Solver::Bdf2) => (30, 60.0),
            (Smooth::Sheet, Solver::Bdf2) => (60, 240.0),
            (Smooth::Sheet, _) => (240, 960.0),
        }
    }

    fn set_up(self, cloth: &mut Cloth<'_>) -> Result<(), Error> {
        let g = *cloth.grid();
        let (m, n) = (g.rows(), g.columns());
        let stretch = f64::from(cloth.particle_mass_kg()) * 9.81 / f64::from(self.stiffness()[0]);
        for p in 0..n {
            cloth.pin(p)?;
        }
        let share = |row: usize| row as f64 / (m - 1) as f64;
        // the lowest swing of a chain, and of a row of springs with a free end
        let across = |row: usize| 0.1 * j0(J0_ZERO * (1.0 - share(row)).sqrt());
        let along = |row: usize| 0.02 * (std::f64::consts::FRAC_PI_2 * row as f64 / (m as f64 - 0.5)).sin();
        let (mut down, mut out) = (0.0, 0.0);
        for row in 1..m {
            match self {
                Smooth::Spring => down = 1.2,
                // the springs keep the length at which they hang, or fast oscillations of it would not be smooth
                Smooth::Chain => {
                    let length = share(1) + (m - row) as f64 * stretch;
                    let aside = across(row) - out;
                    down += (length * length - aside * aside).sqrt();
                    out += aside;
                }
                Smooth::Sheet => down = share(row) + along(row),
            }
            for column in 0..n {
                let at = cloth.position(row * n + column)?;
                cloth.set_position(row * n + column, Vector3::new(at.x, -down as f32, out as f32))?;
            }
        }
        Ok(())
    }
}

/// The order that was measured.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Order {
    /// The scene.
    pub scene: Smooth,
    /// The solver.
    pub solver: &'static str,
    /// What theory says.
    pub expected: f64,
    /// The coarsest step in ms; each next is half as long.
    pub coarsest_dt_ms: f64,
    /// Root mean square difference of the positions from one step to the next finer in m.
    pub differences_m: Vec<f64>,
    /// log2 of the quotients of neighbours.
    pub orders: Vec<f64>,
}

/// How often the step is halved.
const HALVINGS: u32 = 3;

/// Measures the order of a solver in a scene.
pub fn order(scene: Smooth, solver: Solver) -> Result<Order, Error> {
    let (frames, rate_hz) = scene.coarsest(solver);
    let mut shapes = Vec::new();
    for halving in 0..=HALVINGS {
        let factor = 1u32 << halving;
        let def = ClothDef {
            rate_hz,
            substeps: factor,
            damping_per_s: 0.0,
            gravity_m_s2: scene.gravity(),
            speed_limit: 0.0,
            compression_limit: false,
            solver,
            cg_iterations: 30,
            features: if solver == Solver::SymplecticEuler { Features::NONE } else { Features::IMPLICIT },
            ..ClothDef::default()
        };
        shapes.push(with_cloth(&scene.grid(), &def, |cloth| {
            cloth.set_stiffness_uniform(scene.stiffness())?;
            scene.set_up(cloth)?;
            // a stiffness that is cut would be another at each step
            if cloth.budget()?.cut_fraction != 0.0 {
                return Err(Error::StepSize);
            }
            for _ in 0..frames {
                cloth.step()?;
            }
            positions(cloth)
        })?);
    }
    let rms = |a: &[[f64; 3]], b: &[[f64; 3]]| {
        let squares: f64 = a.iter().zip(b).map(|(a, b)| super::distance(a, b).powi(2)).sum();
        (squares / a.len() as f64).sqrt()
    };
    let differences_m: Vec<f64> = shapes.windows(2).map(|w| rms(&w[0], &w[1])).collect();
    Ok(Order {
        scene,
        solver: match solver {
            Solver::SymplecticEuler => "symplectic_euler",
            Solver::ImplicitEuler => "implicit_euler",
            Solver::Bdf2 => "bdf2",
        },
        expected: if solver == Solver::Bdf2 { 2.0 } else { 1.0 },
        coarsest_dt_ms: 1000.0 / f64::from(rate_hz),
        orders: differences_m.windows(2).map(|d| (d[0] / d[1]).log2()).collect(),
        differences_m,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_orders_are_those_of_theory() {
        let mut wrong = Vec::new();
        for scene in Smooth::ALL {
            for solver in [Solver::SymplecticEuler, Solver::ImplicitEuler, Solver::Bdf2] {
                let o = order(scene, solver).unwrap();
                if (o.orders.last().unwrap() - o.expected).abs() > 0.15 {
                    wrong.push(o);
                }
            }
        }
        assert!(wrong.is_empty(), "{wrong:#?}");
    }
}
