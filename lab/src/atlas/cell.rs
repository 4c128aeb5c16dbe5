//! One cell of the atlas: everything that is chosen for one run.

use serde_json::{Value, json};
use taut::{Budget, ClothDef, Error, Families, Features, Grid, GridDef, Solver};

use super::start::Start;

/// What keeps the length beside the springs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Limits {
    /// Nothing.
    None,
    /// Tethers without slack and the strain limit at 5 %.
    TethersStrain,
    /// Limits on levels at 10 %.
    Levels,
}

impl Limits {
    /// All of them.
    pub const ALL: [Limits; 3] = [Limits::None, Limits::TethersStrain, Limits::Levels];

    fn name(self) -> &'static str {
        match self {
            Limits::None => "none",
            Limits::TethersStrain => "tethers_strain",
            Limits::Levels => "levels",
        }
    }
}

/// The six settings that every map of the atlas is drawn for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Variant {
    /// Symplectic Euler, tuned budget, with the clamps on speed and compression that it asks for.
    Tuned,
    /// Symplectic Euler, certified budget, without any clamp: it promises to need none.
    Certified,
    /// As `Tuned`, with tethers and the strain limit.
    Tethers,
    /// As `Tuned`, with limits on levels.
    Levels,
    /// Implicit Euler.
    ImplicitEuler,
    /// The second-order backward difference formula.
    Bdf2,
}

impl Variant {
    /// All of them, in the order of the columns.
    pub const ALL: [Variant; 6] =
        [Variant::Tuned, Variant::Certified, Variant::Tethers, Variant::Levels, Variant::ImplicitEuler, Variant::Bdf2];

    /// The name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Variant::Tuned => "tuned",
            Variant::Certified => "certified",
            Variant::Tethers => "tethers_strain",
            Variant::Levels => "levels",
            Variant::ImplicitEuler => "implicit_euler",
            Variant::Bdf2 => "bdf2",
        }
    }

    /// The name above its maps.
    pub fn title(self) -> &'static str {
        match self {
            Variant::Tuned => "explicit, tuned",
            Variant::Certified => "explicit, certified",
            Variant::Tethers => "tuned + tethers, strain",
            Variant::Levels => "tuned + levels",
            Variant::ImplicitEuler => "implicit Euler",
            Variant::Bdf2 => "BDF2",
        }
    }

    /// The ordinary cell that the maps start from: 12 x 12 on 1 m x 1 m, denim-like springs, two corners pinned.
    pub fn cell(self) -> Cell {
        let implicit = matches!(self, Variant::ImplicitEuler | Variant::Bdf2);
        Cell {
            rows: 12,
            columns: 12,
            rate_hz: 60.0,
            substeps: if implicit { 2 } else { 16 },
            stiffness_n_m: 1000.0,
            mass_ratio: 1.0,
            damping_per_s: 2.0,
            gravity_m_s2: 9.81,
            speed_m_s: 0.0,
            world_m: 0.0,
            local_m: 0.0,
            pin_jump_m: 0.0,
            start: Start::Flat,
            solver: match self {
                Variant::ImplicitEuler => Solver::ImplicitEuler,
                Variant::Bdf2 => Solver::Bdf2,
                _ => Solver::SymplecticEuler,
            },
            budget: if self == Variant::Certified { Budget::Certified } else { Budget::Tuned },
            clamps: self != Variant::Certified,
            limits: match self {
                Variant::Tethers => Limits::TethersStrain,
                Variant::Levels => Limits::Levels,
                _ => Limits::None,
            },
            seed: 0,
        }
    }
}

/// One run: a sheet hung at two corners, its longer side 1 m, and what is extreme about it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// Particles along v.
    pub rows: u32,
    /// Particles along u. Cells are square.
    pub columns: u32,
    /// Frames per second.
    pub rate_hz: f32,
    /// Substeps of a frame.
    pub substeps: u32,
    /// Stiffness of warp and weft in N/m; shear has 0.4 and bend 0.01 of it.
    pub stiffness_n_m: f32,
    /// Mass of every second particle (as on a chess-board) over that of the others.
    pub mass_ratio: f32,
    /// Damping in 1/s.
    pub damping_per_s: f32,
    /// Gravity along -y in m/s^2.
    pub gravity_m_s2: f32,
    /// Speed of all free particles at the start, along (0.6, 0, 0.8), in m/s.
    pub speed_m_s: f32,
    /// Distance of the cloth's own frame from the world's origin in m.
    pub world_m: f64,
    /// Distance of the sheet from the origin of its own frame in m, where f32 holds the positions.
    pub local_m: f32,
    /// How far both pins jump along x within one frame, after a quarter of the run, in m.
    pub pin_jump_m: f64,
    /// The shape at the start.
    pub start: Start,
    /// The solver.
    pub solver: Solver,
    /// The stability budget.
    pub budget: Budget,
    /// Whether the limits on speed and on compression are on.
    pub clamps: bool,
    /// What keeps the length.
    pub limits: Limits,
    /// Seed of what is random in the start.
    pub seed: u64,
}

impl Cell {
    /// The grid. Errors: those of [`Grid::new`].
    pub fn grid(&self) -> Result<Grid, Error> {
        let side = 1.0 / (self.rows.max(self.columns).max(2) - 1) as f32;
        let length = |n: u32| side * n.saturating_sub(1) as f32;
        Grid::new(&GridDef {
            rows: self.rows,
            columns: self.columns,
            width_m: length(self.columns),
            height_m: length(self.rows),
            families: Families::ALL,
        })
    }

    /// The definition.
    pub fn def(&self) -> ClothDef {
        let limits = match self.limits {
            Limits::None => Features::NONE,
            Limits::TethersStrain => Features(Features::TETHERS.0 | Features::STRAIN_LIMIT.0),
            Limits::Levels => Features::LEVELS,
        };
        let when = |on: bool, f: Features| if on { f.0 } else { 0 };
        let implicit = self.solver != Solver::SymplecticEuler;
        let strain = if self.limits == Limits::Levels { 0.1 } else { 0.05 };
        let plain = ClothDef::default();
        ClothDef {
            rate_hz: self.rate_hz,
            substeps: self.substeps,
            gravity_m_s2: [0.0, -self.gravity_m_s2, 0.0],
            damping_per_s: self.damping_per_s,
            speed_limit: if self.clamps { plain.speed_limit } else { 0.0 },
            compression_limit: self.clamps,
            budget: self.budget,
            max_pins: 2,
            solver: self.solver,
            strain_limit: [strain; 3],
            tether_slack: if self.limits == Limits::Levels { [strain; 3] } else { [0.0; 3] },
            features: Features(
                limits.0 | when(self.mass_ratio != 1.0, Features::MASS) | when(implicit, Features::IMPLICIT),
            ),
            origin_m: [self.world_m, 0.0, -self.world_m],
            ..plain
        }
    }

    /// Warp, weft, shear, bend in N/m.
    pub fn stiffness(&self) -> [f32; 4] {
        let k = self.stiffness_n_m;
        [k, k, 0.4 * k, 0.01 * k]
    }

    /// About how many plain particle-steps a substep costs per particle.
    pub fn weight(&self) -> f64 {
        let solver = if self.solver == Solver::SymplecticEuler { 1.0 } else { 60.0 };
        let limits = match self.limits {
            Limits::None => 0.0,
            Limits::TethersStrain => 8.0,
            Limits::Levels => 40.0,
        };
        solver + limits
    }

    /// What a frame costs in plain particle-steps.
    pub fn frame_cost(&self) -> f64 {
        f64::from(self.rows) * f64::from(self.columns) * f64::from(self.substeps) * self.weight()
    }

    /// Everything by name, in the order of the columns of the table. Together they are the cell.
    pub fn fields(&self) -> Vec<(&'static str, Value)> {
        vec![
            ("rows", json!(self.rows)),
            ("columns", json!(self.columns)),
            ("rate_hz", short(self.rate_hz)),
            ("substeps", json!(self.substeps)),
            ("stiffness_n_m", short(self.stiffness_n_m)),
            ("mass_ratio", short(self.mass_ratio)),
            ("damping_per_s", short(self.damping_per_s)),
            ("gravity_m_s2", short(self.gravity_m_s2)),
            ("speed_m_s", short(self.speed_m_s)),
            ("world_m", json!(self.world_m)),
            ("local_m", short(self.local_m)),
            ("pin_jump_m", json!(self.pin_jump_m)),
            ("start", json!(self.start.name())),
            (
                "solver",
                json!(match self.solver {
                    Solver::SymplecticEuler => "symplectic_euler",
                    Solver::ImplicitEuler => "implicit_euler",
                    Solver::Bdf2 => "bdf2",
                }),
            ),
            (
                "budget",
                json!(match self.budget {
                    Budget::Certified => "certified",
                    Budget::Tuned => "tuned",
                }),
            ),
            ("clamps", json!(self.clamps)),
            ("limits", json!(self.limits.name())),
            ("seed", json!(self.seed)),
        ]
    }

    /// The cell in one word: equal cells, and only they, have equal keys.
    pub fn key(&self) -> String {
        format!("{self:?}")
    }
}

/// The shortest decimal number that is this f32; null where it is not finite.
fn short(x: f32) -> Value {
    json!(x.to_string().parse::<f64>().ok().filter(|x| x.is_finite()))
}

/// A value as a table has it: texts without quotes, null as nothing.
pub fn plain(v: &Value) -> String {
    match v {
        Value::String(s) => s.clone(),
        Value::Null => String::new(),
        other => other.to_string(),
    }
}
