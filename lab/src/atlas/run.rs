//! Runs one cell and says what became of it.
//!
//! A cell is *stable* when every frame of its last quarter is (1) quiet: its kinetic energy is no more than what the start,
//! gravity and the pins account for,
//!
//! ```text
//! E_kin(t) <= 1.1 W(t) + 2 e^(-c t) (E_kin(0) + E_springs(0) + E_pins) + M (0.1 m/s)^2 / 2
//! ```
//!
//! with W the work of gravity so far (its largest value), c the damping, M the mass, E_springs(0) the springs' energy at
//! the start with the stiffness that the budget can have left at most, and E_pins = 2 M (jump * rate)^2 + 10 k jump^2 / 2
//! from the frame of the jump on; and (2) whole: no structural spring is longer than twice its rest length. What limits
//! on length do to a start that is too long is not accounted for: x += D and v += D/dt, so at a tiny dt they fling it.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::Duration;

use cpu_time::ThreadTime;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use taut::{Budget, CERTIFIED_SHARE, Cloth, ClothDef, Error, Grid, Solver, StepFlags, TUNED_SHARE, Vector3};

use super::cell::Cell;

/// What became of a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Class {
    /// Quiet and whole: see the head of this file.
    Stable,
    /// Bounded: finite in every frame and quiet, but at the end a spring is longer than twice its rest length.
    Stretched,
    /// Bounded: finite in every frame, but faster than what the start, gravity and the pins account for.
    Fast,
    /// A step would have left the finite numbers. It said so ([`StepFlags::NON_FINITE`]) and was taken back whole.
    TakenBack,
    /// A call answered with an error before the first step, or a pin's target was refused.
    Refused,
    /// A bug: a state that is not finite without a flag, a panic, or a step that takes for ever.
    Broken,
}

impl Class {
    /// All classes.
    pub const ALL: [Class; 6] =
        [Class::Stable, Class::Stretched, Class::Fast, Class::TakenBack, Class::Refused, Class::Broken];

    /// The name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Class::Stable => "stable",
            Class::Stretched => "stretched",
            Class::Fast => "fast",
            Class::TakenBack => "taken_back",
            Class::Refused => "refused",
            Class::Broken => "broken",
        }
    }

    /// The name in the legend.
    pub fn about(self) -> &'static str {
        match self {
            Class::Stable => "stable: quiet and whole",
            Class::Stretched => "bounded: quiet, stretched beyond twice its length",
            Class::Fast => "bounded: faster than what drives it accounts for",
            Class::TakenBack => "frame taken back and flagged",
            Class::Refused => "refused with a code",
            Class::Broken => "broken",
        }
    }
}

/// How much a cell may cost.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Effort {
    /// Simulated time in s, where the work allows it.
    pub seconds: f64,
    /// Most particle-steps, those of an expensive solver counted by [`Cell::weight`].
    pub particle_steps: f64,
}

/// Least frames of a run, whatever they cost.
const LEAST_FRAMES: u32 = 1;

/// A cell that takes longer than this has hung.
const HUNG: Duration = Duration::from_secs(600);

/// What was found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Finding {
    /// What became of the cell.
    pub class: Class,
    /// The result code of a refusal ([`Error::code`]).
    pub code: Option<i32>,
    /// What was wrong with a broken cell.
    pub fault: Option<String>,
    /// Frames stepped, and how many of them were taken back.
    pub frames: u32,
    /// See `frames`.
    pub taken_back_frames: u32,
    /// Simulated time in s.
    pub simulated_s: f64,
    /// Largest structural strain of the last quarter in percent.
    pub strain_pct: Option<f64>,
    /// Largest structural strain of all frames in percent.
    pub peak_strain_pct: Option<f64>,
    /// Largest root mean square speed of the last quarter in m/s.
    pub rms_speed_m_s: Option<f64>,
    /// Kinetic energy over what is accounted for, largest of the last quarter.
    pub energy_ratio: Option<f64>,
    /// Share of the stiffness that the budget cut.
    pub cut_fraction: Option<f64>,
    /// Processor time per particle and substep.
    pub ns_per_particle_step: Option<f64>,
}

impl Finding {
    fn of(class: Class) -> Finding {
        Finding {
            class,
            code: None,
            fault: None,
            frames: 0,
            taken_back_frames: 0,
            simulated_s: 0.0,
            strain_pct: None,
            peak_strain_pct: None,
            rms_speed_m_s: None,
            energy_ratio: None,
            cut_fraction: None,
            ns_per_particle_step: None,
        }
    }

    /// Everything by name, in the order of the columns of the table.
    pub fn fields(&self) -> Vec<(&'static str, Value)> {
        vec![
            ("class", json!(self.class.name())),
            ("code", json!(self.code)),
            ("fault", json!(self.fault)),
            ("frames", json!(self.frames)),
            ("taken_back_frames", json!(self.taken_back_frames)),
            ("simulated_s", json!(self.simulated_s)),
            ("strain_pct", json!(self.strain_pct)),
            ("peak_strain_pct", json!(self.peak_strain_pct)),
            ("rms_speed_m_s", json!(self.rms_speed_m_s)),
            ("energy_ratio", json!(self.energy_ratio)),
            ("cut_fraction", json!(self.cut_fraction)),
            ("ns_per_particle_step", json!(self.ns_per_particle_step)),
        ]
    }
}

/// Runs a cell. `tick` is called after every frame with the share that is done.
pub fn run(cell: &Cell, effort: &Effort, tick: impl FnMut(f32)) -> Finding {
    let broken = |fault: String| Finding { fault: Some(fault), ..Finding::of(Class::Broken) };
    match catch_unwind(AssertUnwindSafe(|| attempt(cell, effort, tick))) {
        Ok(Ok(finding)) => finding,
        Ok(Err(e)) => Finding { code: Some(e.code()), ..Finding::of(Class::Refused) },
        Err(panic) => broken(format!("panic: {}", panic_text(&*panic))),
    }
}

fn panic_text(panic: &(dyn std::any::Any + Send)) -> &str {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    text.or(panic.downcast_ref::<&str>().copied()).unwrap_or("no text")
}

fn attempt(cell: &Cell, effort: &Effort, mut tick: impl FnMut(f32)) -> Result<Finding, Error> {
    let (grid, def) = (cell.grid()?, cell.def());
    let mut block = vec![0.0; Cloth::memory(&grid, &def)?];
    let mut cloth = Cloth::create(&grid, &def, &mut block)?;
    set_up(cell, &mut cloth)?;
    let budget = cloth.budget()?;
    let mut accounts = Accounts::open(cell, &cloth)?;
    let frames = frames_of(cell, effort);
    let jump_at = frames / 4;
    let mut found = Finding { cut_fraction: Some(f64::from(budget.cut_fraction)), ..Finding::of(Class::Stable) };
    let (mut strain, mut peak, mut speed2, mut ratio) = (0.0f64, 0.0f64, 0.0f64, 0.0f64);
    let mut cpu = Duration::ZERO;
    for frame in 0..frames {
        if frame == jump_at && cell.pin_jump_m != 0.0 {
            for p in cell_pins(&grid) {
                let to = cloth.world_position(p)? + Vector3::new(cell.pin_jump_m, 0.0, 0.0);
                cloth.move_pin(p, to)?;
            }
            accounts.jump(cell);
        }
        let start = ThreadTime::now();
        let flags = cloth.step()?;
        cpu += start.elapsed();
        found.frames += 1;
        found.taken_back_frames += u32::from(flags.contains(StepFlags::NON_FINITE));
        let kinetic = cloth.kinetic_energy_j();
        if !is_finite(&cloth) || !kinetic.is_finite() {
            found.class = Class::Broken;
            found.fault = Some(format!("not finite after frame {frame}, flags {}", flags.0));
            break;
        }
        if cpu > HUNG {
            found.class = Class::Broken;
            found.fault = Some(format!("{} s for {} frames", cpu.as_secs(), found.frames));
            break;
        }
        let allowed = accounts.allowed(&cloth, 1.0 / f64::from(cell.rate_hz));
        let s = f64::from(cloth.strain().largest);
        peak = peak.max(s);
        if frame >= frames - frames.div_ceil(4) {
            strain = strain.max(s);
            speed2 = speed2.max(2.0 * kinetic / accounts.mass);
            ratio = ratio.max(kinetic / allowed);
        }
        tick((frame + 1) as f32 / frames as f32);
    }
    found.simulated_s = f64::from(found.frames) / f64::from(cell.rate_hz);
    found.strain_pct = finite(100.0 * strain);
    found.peak_strain_pct = finite(100.0 * peak);
    found.rms_speed_m_s = finite(speed2.sqrt());
    found.energy_ratio = finite(ratio);
    let steps = f64::from(found.frames) * f64::from(cell.substeps) * grid.particles() as f64;
    found.ns_per_particle_step = finite(cpu.as_secs_f64() * 1e9 / steps);
    if found.class != Class::Broken {
        found.class = class_of(found.taken_back_frames, ratio, strain);
    }
    Ok(found)
}

fn class_of(taken_back: u32, energy_ratio: f64, strain: f64) -> Class {
    if taken_back > 0 {
        Class::TakenBack
    } else if energy_ratio > 1.0 {
        Class::Fast
    } else if strain > 1.0 {
        Class::Stretched
    } else {
        Class::Stable
    }
}

fn finite(x: f64) -> Option<f64> {
    x.is_finite().then_some(x)
}

/// The corners that hold the sheet.
fn cell_pins(grid: &Grid) -> [usize; 2] {
    [0, grid.columns() - 1]
}

/// Frames that fit into the effort.
fn frames_of(cell: &Cell, effort: &Effort) -> u32 {
    let wanted = effort.seconds * f64::from(cell.rate_hz);
    (wanted.min(effort.particle_steps / cell.frame_cost()) as u32).max(LEAST_FRAMES)
}

fn set_up(cell: &Cell, cloth: &mut Cloth<'_>) -> Result<(), Error> {
    let grid = *cloth.grid();
    cloth.set_stiffness_uniform(cell.stiffness())?;
    if cell.mass_ratio != 1.0 {
        let share = cloth.particle_mass_kg();
        let heavy = |i: usize| (i / grid.columns() + i % grid.columns()) % 2 == 1;
        let kg = |i: usize| if heavy(i) { share * cell.mass_ratio } else { share };
        cloth.set_masses(&(0..grid.particles()).map(kg).collect::<Vec<f32>>())?;
    }
    let pins = cell_pins(&grid);
    let start = |i: usize| cell.start.of(&grid, i, pins.contains(&i), cell.seed);
    for i in 0..grid.particles() {
        let [x, y, z] = start(i)[0];
        cloth.set_position(i, Vector3::new(x + cell.local_m, y, z))?;
    }
    for p in pins {
        cloth.pin(p)?;
    }
    for i in 0..grid.particles() {
        let [x, y, z] = start(i)[1];
        let flung = cell.speed_m_s;
        cloth.set_velocity(i, Vector3::new(x + 0.6 * flung, y, z + 0.8 * flung))?;
    }
    Ok(())
}

/// Whether every position and velocity that a caller can read is finite.
fn is_finite(cloth: &Cloth<'_>) -> bool {
    let good = |v: Vector3<f32>| v.iter().all(|x| x.is_finite());
    (0..cloth.grid().particles()).all(|i| cloth.position(i).is_ok_and(good) && cloth.velocity(i).is_ok_and(good))
}

/// What the motion may owe its energy to.
struct Accounts {
    /// Mass of the free particles in kg.
    mass: f64,
    /// Weight of each particle along y in N, negative; 0 for the pinned.
    weights: Vec<f64>,
    /// Sum of weight times height at the start in J.
    height: f64,
    /// Largest work of gravity so far in J.
    fallen: f64,
    kinetic: f64,
    springs: f64,
    pins: f64,
    damping: f64,
    /// Since the start, and since the pins jumped, in s.
    time: f64,
    since_jump: f64,
}

/// The speed in m/s of the bound at the head of this file.
const STILL_M_S: f64 = 0.1;

impl Accounts {
    fn open(cell: &Cell, cloth: &Cloth<'_>) -> Result<Accounts, Error> {
        let n = cloth.grid().particles();
        let pinned: Vec<usize> = cloth.pinned().collect();
        let mass = |i: usize| if pinned.contains(&i) { Ok(0.0) } else { cloth.mass_kg(i).map(f64::from) };
        let masses = (0..n).map(mass).collect::<Result<Vec<f64>, Error>>()?;
        let weights: Vec<f64> = masses.iter().map(|m| -m * f64::from(cell.gravity_m_s2)).collect();
        Ok(Accounts {
            mass: masses.iter().sum(),
            height: work(&weights, cloth),
            weights,
            fallen: 0.0,
            kinetic: cloth.kinetic_energy_j(),
            springs: spring_energy(cell, cloth, &masses)?,
            pins: 0.0,
            damping: f64::from(cell.damping_per_s),
            time: 0.0,
            since_jump: 0.0,
        })
    }

    fn jump(&mut self, cell: &Cell) {
        let way = cell.pin_jump_m.abs();
        let k = stiffness_left(cell, f64::from(cell.stiffness_n_m), self.mass / self.weights.len() as f64);
        self.pins = 2.0 * self.mass * (way * f64::from(cell.rate_hz)).powi(2) + 5.0 * k * way * way;
        self.since_jump = 0.0;
    }

    /// What the kinetic energy may be after one frame more.
    fn allowed(&mut self, cloth: &Cloth<'_>, frame_s: f64) -> f64 {
        self.time += frame_s;
        self.since_jump += frame_s;
        self.fallen = self.fallen.max(work(&self.weights, cloth) - self.height);
        let left = |t: f64| 2.0 * (-self.damping * t).exp();
        1.1 * self.fallen
            + left(self.time) * (self.kinetic + self.springs)
            + left(self.since_jump) * self.pins
            + 0.5 * self.mass * STILL_M_S * STILL_M_S
    }
}

fn work(weights: &[f64], cloth: &Cloth<'_>) -> f64 {
    let y = |i: usize| cloth.position(i).map_or(0.0, |p| f64::from(p.y));
    weights.iter().enumerate().map(|(i, w)| w * y(i)).sum()
}

/// The most that the budget can have left of a spring at particles of a mass in kg, in N/m: each particle's
/// omega^2 >= k/M is below the budget's share of 4/dt^2 - 2 c/dt.
fn stiffness_left(cell: &Cell, k: f64, mass: f64) -> f64 {
    let dt = f64::from(ClothDef { rate_hz: cell.rate_hz, substeps: cell.substeps, ..ClothDef::default() }.dt_s());
    let share = match cell.budget {
        Budget::Certified => CERTIFIED_SHARE,
        Budget::Tuned => TUNED_SHARE,
    };
    let top = f64::from(share) * (4.0 / (dt * dt) - 2.0 * f64::from(cell.damping_per_s) / dt) * mass;
    let k = k.min(f64::from(taut::field::MAX_STIFFNESS));
    if cell.solver == Solver::SymplecticEuler { k.min(top) } else { k }
}

/// Energy of the springs as they lie, in J; `masses` are 0 where pinned.
fn spring_energy(cell: &Cell, cloth: &Cloth<'_>, masses: &[f64]) -> Result<f64, Error> {
    let g = cloth.grid();
    let (rows, columns) = (g.rows(), g.columns());
    let (u, v) = (f64::from(g.rest_u()), f64::from(g.rest_v()));
    let [warp, weft, shear, bend] = cell.stiffness().map(f64::from);
    // columns on, rows on, rest length, stiffness
    let kinds: [(isize, usize, f64, f64); 6] = [
        (1, 0, u, weft),
        (0, 1, v, warp),
        (1, 1, u.hypot(v), shear),
        (-1, 1, u.hypot(v), shear),
        (2, 0, 2.0 * u, bend),
        (0, 2, 2.0 * v, bend),
    ];
    let mut sum = 0.0;
    for i in 0..rows * columns {
        let from = cloth.position(i)?.cast::<f64>();
        for (right, down, rest, k) in kinds {
            let (row, column) = (i / columns + down, (i % columns) as isize + right);
            if row >= rows || !(0..columns as isize).contains(&column) {
                continue;
            }
            let j = row * columns + column as usize;
            let mass = [masses[i], masses[j]].into_iter().filter(|m| *m > 0.0).fold(f64::INFINITY, f64::min);
            let strained = (cloth.position(j)?.cast::<f64>() - from).norm() - rest;
            if mass.is_finite() {
                sum += 0.5 * stiffness_left(cell, k, mass) * strained * strained;
            }
        }
    }
    Ok(sum)
}

#[cfg(test)]
mod tests {
    use super::super::cell::Variant;
    use super::super::start::Start;
    use super::*;

    const SHORT: Effort = Effort { seconds: 3.0, particle_steps: 1e7 };

    fn run_it(cell: &Cell) -> Finding {
        run(cell, &SHORT, |_| {})
    }

    #[test]
    fn the_ordinary_cell_is_stable_in_every_variant() {
        for variant in Variant::ALL {
            let found = run_it(&variant.cell());
            assert_eq!(found.class, Class::Stable, "{}: {found:?}", variant.name());
            assert!(found.simulated_s > 1.5, "{found:?}");
        }
    }

    /// What is refused, and with which code: each beside the last value that is accepted.
    #[test]
    fn refusals_have_their_codes() {
        let c = Variant::Tuned.cell();
        for (good, bad, code) in [
            (Cell { mass_ratio: 1e6, ..c }, Cell { mass_ratio: 1.01e6, ..c }, Error::OutOfRange),
            (Cell { mass_ratio: 1e-6, ..c }, Cell { mass_ratio: 0.99e-6, ..c }, Error::OutOfRange),
            (Cell { damping_per_s: 950.0, ..c }, Cell { damping_per_s: 960.0, ..c }, Error::Damping),
            (Cell { gravity_m_s2: 1e4, ..c }, Cell { gravity_m_s2: 1.01e4, ..c }, Error::OutOfRange),
            (Cell { speed_m_s: 1e6, ..c }, Cell { speed_m_s: 1.3e6, ..c }, Error::OutOfRange),
            (Cell { local_m: 999_998.0, ..c }, Cell { local_m: 1e6, ..c }, Error::OutOfRange),
            (Cell { world_m: 1e12, ..c }, Cell { world_m: 1.01e12, ..c }, Error::OutOfRange),
            (Cell { pin_jump_m: 999_998.0, ..c }, Cell { pin_jump_m: 1e6, ..c }, Error::OutOfRange),
            (Cell { stiffness_n_m: 0.0, ..c }, Cell { stiffness_n_m: -1.0, ..c }, Error::Negative),
            (Cell { stiffness_n_m: f32::MAX, ..c }, Cell { stiffness_n_m: f32::NAN, ..c }, Error::NotFinite),
            (Cell { rows: 2, ..c }, Cell { rows: 1, ..c }, Error::GridSize),
            (Cell { rate_hz: 1.0, ..c }, Cell { rate_hz: 0.5, ..c }, Error::StepSize),
        ] {
            let found = run(&bad, &Effort { seconds: 0.2, ..SHORT }, |_| {});
            assert_eq!((found.class, found.code), (Class::Refused, Some(code.code())), "{bad:?}");
            let found = run(&good, &Effort { seconds: 0.2, ..SHORT }, |_| {});
            assert_ne!(found.class, Class::Refused, "{good:?}: {found:?}");
        }
    }

    /// The classes are not all one: a known boil is fast, cloth as soft as air is stretched, and a start at the end of what
    /// the tuned budget carries without its clamps leaves the finite numbers.
    #[test]
    fn each_class_has_a_cell() {
        let c = Variant::Tuned.cell();
        let soft = Cell { stiffness_n_m: 0.1, ..c };
        assert_eq!(run_it(&soft).class, Class::Stretched);
        let bare = Cell { clamps: false, stiffness_n_m: 1e6, start: Start::Noise30, damping_per_s: 0.1, ..c };
        let found = run_it(&bare);
        assert!(matches!(found.class, Class::Fast | Class::TakenBack), "{found:?}");
        let clamped = Cell { clamps: true, damping_per_s: 2.0, ..bare };
        assert_eq!(run(&clamped, &Effort { seconds: 6.0, ..SHORT }, |_| {}).class, Class::Stable);
        assert_eq!(class_of(1, 0.0, 0.0), Class::TakenBack);
        assert_eq!(class_of(0, 1.01, 2.0), Class::Fast);
        assert_eq!(class_of(0, 0.99, 1.01), Class::Stretched);
    }

    /// Free fall (no stiffness) owes everything to gravity: the account of the work is as large as the kinetic energy, not
    /// many times larger, or it would excuse anything.
    #[test]
    fn the_work_of_gravity_is_what_the_fall_gains() {
        let c = Cell { stiffness_n_m: 0.0, damping_per_s: 0.0, clamps: false, ..Variant::Certified.cell() };
        let found = run(&c, &Effort { seconds: 1.0, ..SHORT }, |_| {});
        let ratio = found.energy_ratio.unwrap();
        assert!((0.89..0.91).contains(&ratio), "{ratio}");
        let speed = found.rms_speed_m_s.unwrap();
        assert!((speed - 9.81).abs() < 0.02, "{speed} m/s after 1 s");
    }
}
