//! The axes of the atlas, and the maps that are drawn over pairs of them.

use taut::{Budget, Solver, noise};

use super::cell::{Cell, Limits, Variant};
use super::start::Start;

/// One extreme, with the values that a map takes of it. The first and the last of some are beyond what is accepted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// Frames per second and substeps: dt.
    Step,
    /// Stiffness.
    Stiffness,
    /// Mass of every second particle over that of the others.
    MassRatio,
    /// Damping.
    Damping,
    /// Gravity.
    Gravity,
    /// Speed at the start.
    Speed,
    /// Distance of the cloth's frame from the world's origin.
    World,
    /// Distance of the sheet from the origin of its frame.
    Local,
    /// Jump of the pins.
    Jump,
    /// Shape of the grid.
    Shape,
    /// Shape at the start.
    Start,
}

const STEPS: [(f32, u32); 9] =
    [(0.5, 1), (1.0, 1), (10.0, 1), (60.0, 1), (60.0, 4), (60.0, 16), (60.0, 64), (1000.0, 64), (10_000.0, 256)];
const STIFFNESS: [f32; 10] = [-1.0, 0.0, 1e-40, 1e-3, 1.0, 100.0, 1e3, 1e5, 1e9, f32::MAX];
const MASSES: [f32; 11] = [1e-7, 1e-6, 1e-4, 1e-2, 0.1, 1.0, 10.0, 100.0, 1e4, 1e6, 1e7];
const DAMPING: [f32; 8] = [-1.0, 0.0, 1e-40, 0.1, 2.0, 20.0, 900.0, 1e5];
const GRAVITY: [f32; 8] = [0.0, 1e-40, 1.0, 9.81, 100.0, 1000.0, 1e4, 2e4];
const SPEEDS: [f32; 8] = [0.0, 1e-40, 1.0, 20.0, 100.0, 500.0, 1e6, 2e6];
const WORLD: [f64; 7] = [0.0, 1.0, 1e3, 1e6, 1e9, 1e12, 1e13];
const LOCAL: [f32; 9] = [0.0, 1.0, 10.0, 100.0, 1e3, 1e4, 1e5, 9.9e5, 1e6];
const JUMPS: [f64; 9] = [0.0, 1e-40, 0.01, 0.1, 1.0, 10.0, 1e3, 9e5, 2e6];
const SHAPES: [(u32, u32); 9] =
    [(1, 12), (2, 2), (3, 3), (2, 12), (12, 12), (64, 64), (2, 1024), (1024, 2), (512, 512)];

impl Axis {
    /// What it shows, with the unit.
    pub fn label(self) -> &'static str {
        match self {
            Axis::Step => "Hz x substeps",
            Axis::Stiffness => "stiffness, N/m",
            Axis::MassRatio => "mass ratio",
            Axis::Damping => "damping, 1/s",
            Axis::Gravity => "gravity, m/s\u{b2}",
            Axis::Speed => "speed at the start, m/s",
            Axis::World => "frame from the world's origin, m",
            Axis::Local => "sheet from its frame's origin, m",
            Axis::Jump => "jump of the pins in a frame, m",
            Axis::Shape => "rows x columns",
            Axis::Start => "start",
        }
    }

    /// Number of values.
    pub fn count(self) -> usize {
        match self {
            Axis::Step => STEPS.len(),
            Axis::Stiffness => STIFFNESS.len(),
            Axis::MassRatio => MASSES.len(),
            Axis::Damping => DAMPING.len(),
            Axis::Gravity => GRAVITY.len(),
            Axis::Speed => SPEEDS.len(),
            Axis::World => WORLD.len(),
            Axis::Local => LOCAL.len(),
            Axis::Jump => JUMPS.len(),
            Axis::Shape => SHAPES.len(),
            Axis::Start => Start::ALL.len(),
        }
    }

    /// A value as the axis names it.
    pub fn name(self, i: usize) -> String {
        match self {
            Axis::Step => format!("{} x {}", STEPS[i].0, STEPS[i].1),
            Axis::Stiffness => short(f64::from(STIFFNESS[i])),
            Axis::MassRatio => short(f64::from(MASSES[i])),
            Axis::Damping => short(f64::from(DAMPING[i])),
            Axis::Gravity => short(f64::from(GRAVITY[i])),
            Axis::Speed => short(f64::from(SPEEDS[i])),
            Axis::World => short(WORLD[i]),
            Axis::Local => short(f64::from(LOCAL[i])),
            Axis::Jump => short(JUMPS[i]),
            Axis::Shape => format!("{} x {}", SHAPES[i].0, SHAPES[i].1),
            Axis::Start => Start::ALL[i].name().into(),
        }
    }

    /// The cell with a value of this axis.
    pub fn put(self, i: usize, cell: Cell) -> Cell {
        match self {
            Axis::Step => Cell { rate_hz: STEPS[i].0, substeps: STEPS[i].1, ..cell },
            Axis::Stiffness => Cell { stiffness_n_m: STIFFNESS[i], ..cell },
            Axis::MassRatio => Cell { mass_ratio: MASSES[i], ..cell },
            Axis::Damping => Cell { damping_per_s: DAMPING[i], ..cell },
            Axis::Gravity => Cell { gravity_m_s2: GRAVITY[i], ..cell },
            Axis::Speed => Cell { speed_m_s: SPEEDS[i], ..cell },
            Axis::World => Cell { world_m: WORLD[i], ..cell },
            Axis::Local => Cell { local_m: LOCAL[i], ..cell },
            Axis::Jump => Cell { pin_jump_m: JUMPS[i], ..cell },
            Axis::Shape => Cell { rows: SHAPES[i].0, columns: SHAPES[i].1, ..cell },
            Axis::Start => Cell { start: Start::ALL[i], ..cell },
        }
    }
}

/// A number as short as a map wants it.
fn short(x: f64) -> String {
    if x != 0.0 && !(1e-3..1e4).contains(&x.abs()) { format!("{x:.0e}") } else { format!("{x}") }
}

/// A map over two axes, drawn for every [`Variant`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Map {
    /// In tables.
    pub name: &'static str,
    /// Along the bottom.
    pub x: Axis,
    /// Up the side.
    pub y: Axis,
}

/// The maps in the order in which they are drawn.
pub const MAPS: [Map; 11] = [
    Map { name: "step_stiffness", x: Axis::Step, y: Axis::Stiffness },
    Map { name: "step_mass", x: Axis::Step, y: Axis::MassRatio },
    Map { name: "step_damping", x: Axis::Step, y: Axis::Damping },
    Map { name: "step_gravity", x: Axis::Step, y: Axis::Gravity },
    Map { name: "step_speed", x: Axis::Step, y: Axis::Speed },
    Map { name: "step_jump", x: Axis::Step, y: Axis::Jump },
    Map { name: "step_start", x: Axis::Step, y: Axis::Start },
    Map { name: "stiffness_start", x: Axis::Stiffness, y: Axis::Start },
    Map { name: "shape_start", x: Axis::Shape, y: Axis::Start },
    Map { name: "local_stiffness", x: Axis::Local, y: Axis::Stiffness },
    Map { name: "world_jump", x: Axis::World, y: Axis::Jump },
];

impl Map {
    /// The cell of a variant at the values (x, y).
    pub fn cell(&self, variant: Variant, x: usize, y: usize) -> Cell {
        self.x.put(x, self.y.put(y, variant.cell()))
    }

    /// Places along x and y that are measured: all, or for the quick atlas every second one and the ends.
    pub fn places(&self, quick: bool) -> [Vec<usize>; 2] {
        [self.x, self.y].map(|axis| {
            let n = axis.count();
            (0..n).filter(|i| !quick || i % 2 == 0 || i + 1 == n).collect()
        })
    }
}

/// A cell of the full product of all axes, within what is accepted; the same seed is the same cell. Grids and substeps are
/// held to what a frame of it may cost.
pub fn sample(seed: u64) -> Cell {
    let pick = |axis: u32, from: usize, to: usize| from + (noise::uniform(seed, axis) * (to - from) as f32) as usize;
    let solver = [Solver::SymplecticEuler, Solver::ImplicitEuler, Solver::Bdf2][pick(0, 0, 3)];
    let mut cell = Cell {
        solver,
        budget: [Budget::Tuned, Budget::Certified][pick(1, 0, 2)],
        clamps: pick(2, 0, 2) == 1,
        limits: Limits::ALL[pick(3, 0, 3)],
        seed,
        ..Variant::Tuned.cell()
    };
    // from the first to one behind the last value that is accepted
    for (i, (axis, from, to)) in [
        (Axis::Step, 1, STEPS.len()),
        (Axis::Stiffness, 1, STIFFNESS.len()),
        (Axis::MassRatio, 1, MASSES.len() - 1),
        (Axis::Damping, 1, DAMPING.len() - 1),
        (Axis::Gravity, 0, GRAVITY.len() - 1),
        (Axis::Speed, 0, SPEEDS.len() - 1),
        (Axis::World, 0, WORLD.len() - 1),
        (Axis::Local, 0, LOCAL.len() - 1),
        (Axis::Jump, 0, JUMPS.len() - 1),
        (Axis::Shape, 1, SHAPES.len()),
        (Axis::Start, 0, Start::ALL.len()),
    ]
    .into_iter()
    .enumerate()
    {
        cell = axis.put(pick(10 + i as u32, from, to), cell);
    }
    while cell.damping_per_s >= cell.rate_hz * cell.substeps as f32 {
        cell.damping_per_s *= 0.1;
    }
    while cell.frame_cost() > FRAME && cell.substeps > 1 {
        cell.substeps /= 2;
        cell.damping_per_s = cell.damping_per_s.min(0.9 * cell.rate_hz * cell.substeps as f32);
    }
    while cell.frame_cost() > FRAME {
        (cell.rows, cell.columns) = (cell.rows.div_ceil(2).max(2), cell.columns.div_ceil(2).max(2));
    }
    cell
}

/// Most weighted particle-steps of a frame of a sampled cell.
const FRAME: f64 = 2e6;
