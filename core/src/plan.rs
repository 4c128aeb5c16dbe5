//! The planner: which settings a scene requires, and no more.
//!
//! For every method (see [`METHODS`]) it knows the largest structural strain at rest, and the cost of a substep in plain steps;
//! both were measured (`lab/data/plan.csv`, by the lab's example `distill`, which wrote plan/table.rs). A cloth that is as stiff
//! as its step carries has a strain that depends on its grid and on g dt^2 / L only, and is looked up between the measured
//! ones; one with the fabric's own stiffness has a strain that is proportional to its weight over its stiffness, a law with
//! fitted shares. The planner walks the substeps of each method upwards until the tolerance is met, and takes the cheapest.

mod strains;
mod table;

use self::strains::Strains;
use crate::budget::TUNED_SHARE;
use crate::math::{max, min, sqrt};
use crate::{ClothDef, Error, Families, Features, Grid, Solver, in_default_environment};

/// How a sheet is held: what decides where it stretches, and how fast that grows with its grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum Hold {
    /// A whole edge is pinned: a banner, a flag, a cape along the shoulders.
    Edge = 0,
    /// Points of an edge are pinned, at most a few cells apart: a curtain.
    Hooks = 1,
    /// Two far corners are pinned.
    Corners = 2,
    /// One particle is pinned.
    Corner = 3,
    /// Nothing is pinned: it lies on something.
    Loose = 4,
    /// An area in its middle is pinned, and the rest hangs over: a cloth clamped to a table.
    Area = 5,
}

impl Hold {
    /// All of them, in the order of their numbers.
    pub const ALL: [Hold; 6] = [Hold::Edge, Hold::Hooks, Hold::Corners, Hold::Corner, Hold::Loose, Hold::Area];
}

/// What is to be planned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanDef {
    /// How the sheet is held. Default `Corners`.
    pub hold: Hold,
    /// The fabric's stiffness in N/m: warp, weft, shear, bend; each at least 0, at most 1e9. Default that of a light woven.
    pub stiffness_n_per_m: [f32; 4],
    /// Mass per area in kg/m^2, 1e-6 to 1e6. Default 0.2.
    pub density_kg_m2: f32,
    /// Frames per second, 1 to 10,000. Default 60.
    pub rate_hz: f32,
    /// Size of gravity in m/s^2, above 0, at most 1e4. Default 9.81.
    pub gravity_m_s2: f32,
    /// Largest structural strain at rest, above 0, at most 1 (0.05 is 5 %). Default 0.05.
    pub tolerance: f32,
    /// CPU time of a frame in ns, above 0; infinity is allowed, and the default.
    pub budget_ns: f32,
    /// CPU time of a plain particle-step on the caller's machine in ns, above 0, at most 1e6. Default 7.
    pub plain_ns: f32,
}

impl Default for PlanDef {
    fn default() -> Self {
        PlanDef {
            hold: Hold::Corners,
            stiffness_n_per_m: [2000.0, 2000.0, 60.0, 1.0],
            density_kg_m2: 0.2,
            rate_hz: 60.0,
            gravity_m_s2: 9.81,
            tolerance: 0.05,
            budget_ns: f32::INFINITY,
            plain_ns: 7.0,
        }
    }
}

/// Where the planned stiffness comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum PlanStiffness {
    /// As stiff as the step carries: [`crate::Cloth::set_stiffness_uniform`] with 1e8 N/m in every channel. It stretches less than the fabric.
    Stiffest = 0,
    /// The fabric's own.
    Fabric = 1,
}

/// Settings for a definition, and what to expect of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plan {
    /// The solver.
    pub solver: Solver,
    /// Substeps of a frame.
    pub substeps: u32,
    /// Iterations of an implicit solver.
    pub cg_iterations: u32,
    /// Spring families.
    pub families: Families,
    /// Features that the plan needs; those that the scene needs come beside them.
    pub features: Features,
    /// Where the stiffness comes from.
    pub stiffness: PlanStiffness,
    /// Radius of the inertia field in m; 0 = none.
    pub inertia_radius_m: f32,
    /// Strain of the limits and slack of the tethers.
    pub limit: f32,
    /// Passes of the levels over the cloth itself in each cycle.
    pub strain_passes: u32,
    /// Cycles through the levels in each substep; 0 = until the limit is kept.
    pub level_cycles: u32,
    /// The speed limit as a share of the smallest rest length per substep.
    pub speed_limit: f32,
    /// Largest strain to expect at rest, the margin of the law counted in.
    pub strain: f32,
    /// CPU time to expect of a frame in ns, with what such scenes mostly need beside: a collider and hinges where a sheet lies on
    /// something.
    pub frame_ns: f32,
    /// Whether `strain` is within the tolerance; else this is the best that fits the time.
    pub meets: bool,
}

impl Plan {
    /// A definition with the settings of the plan; its other features stay.
    pub fn fit(&self, def: &ClothDef) -> ClothDef {
        ClothDef {
            solver: self.solver,
            substeps: self.substeps,
            cg_iterations: self.cg_iterations,
            features: Features(def.features.0 | self.features.0),
            inertia_radius_m: self.inertia_radius_m,
            strain_limit: [self.limit; 3],
            tether_slack: [if self.features.contains(Features::LEVELS) { self.limit } else { 0.0 }; 3],
            strain_passes: self.strain_passes,
            level_cycles: self.level_cycles,
            speed_limit: self.speed_limit,
            ..*def
        }
    }
}

/// A way to step a cloth that the planner knows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum Method {
    /// As stiff as the step carries.
    Plain = 0,
    /// The same with the inertia field, of a radius of 0.3 of the longer side.
    Inertia = 1,
    /// `Plain` with tethers.
    Tethers = 2,
    /// `Plain` with levels at the tolerance.
    Levels = 3,
    /// The fabric's own stiffness with as many substeps as it needs.
    Whole = 4,
    /// The fabric's own stiffness with implicit Euler, one substep and ten iterations.
    Implicit = 5,
    /// `Plain` with one cycle through the levels in each substep that aims at no strain at all.
    OneCycle = 6,
}

/// All methods.
pub const METHODS: [Method; 7] = [
    Method::Plain,
    Method::Inertia,
    Method::Tethers,
    Method::OneCycle,
    Method::Levels,
    Method::Whole,
    Method::Implicit,
];

/// ln(strain) of a cloth of its own stiffness = constant + grid ln(n) + the sum over warp, weft, shear of a share times
/// ln(weight per area times L / stiffness), n = cells along the longer side; `margin` is how far the rows lie above it at
/// most.
#[derive(Clone, Copy, Debug)]
struct FabricLaw {
    constant: f32,
    grid: f32,
    warp: f32,
    weft: f32,
    shear: f32,
    margin: f32,
}

/// Cost of a substep of a padded particle in plain steps (all families, no features), with the families of [`Bend::kept`] and what scenes of the hold
/// need beside (a collider and hinges where a sheet lies on something): constant + grid / n + step / substeps.
#[derive(Clone, Copy, Debug)]
struct Price {
    constant: f32,
    grid: f32,
    step: f32,
}

/// What levels that keep a limit do with two substeps. What they cost is the exponential of constant + grid ln(n) +
/// limit ln(limit), which three of four measured rows stay under.
#[derive(Clone, Copy, Debug)]
struct LevelsLaw {
    /// The largest strain at rest of all grids with each limit of [`table::LIMITS`]: what lies on something is pushed out last.
    worst: [f32; 3],
    constant: f32,
    grid: f32,
    limit: f32,
}

impl LevelsLaw {
    /// The largest limit whose worst strain is at most this, if it was seen to be kept.
    fn limit(&self, strain: f32) -> Option<f32> {
        let (mut limit, mut worst) = (table::LIMITS[0], self.worst[0]);
        if strain < worst {
            return None;
        }
        for (next, next_worst) in table::LIMITS.into_iter().zip(self.worst).skip(1) {
            if strain < next_worst {
                return Some(limit + (next - limit) * (strain - worst) / (next_worst - worst));
            }
            (limit, worst) = (next, next_worst);
        }
        Some(limit + (strain - worst))
    }

    fn price(&self, cells: f32, limit: f32) -> Price {
        let ln = self.constant + self.grid * libm::logf(cells) + self.limit * libm::logf(limit);
        Price { constant: libm::expf(ln), grid: 0.0, step: 0.0 }
    }
}

/// What bend springs do.
#[derive(Clone, Copy, Debug)]
struct Bend {
    /// Whether the rows have them.
    kept: bool,
    /// What is added to ln of the strain with the other choice, that of a row in four being more.
    ln_strain: f32,
    /// What the other choice adds to the cost of a substep, in plain steps.
    price: f32,
}

/// What was measured of a hold.
#[derive(Clone, Copy, Debug)]
struct Row {
    bend: Bend,
    plain: Strains,
    inertia: Strains,
    tethers: Strains,
    one_cycle: Strains,
    whole: FabricLaw,
    implicit: FabricLaw,
    plain_price: Price,
    tethers_price: Price,
    one_cycle_price: Price,
    levels: LevelsLaw,
    implicit_price: Price,
}

/// The inertia field of the plans: its radius as a share of the longer side.
const RADIUS: f32 = 0.3;
/// Most substeps of a plan.
const MOST: u32 = 256;
/// Iterations of the implicit solver.
const ITERATIONS: u32 = 10;
/// Tethers, levels and one cycle with fewer substeps were not measured; levels are planned with these.
const LEAST_LIMITED: u32 = 2;
/// The speed limit of [`Method::OneCycle`] in spacings a substep: it is for few substeps.
pub const ONE_CYCLE_SPEED: f32 = 8.0;
/// What levels aim at as a share of the tolerance.
const AIM: f32 = 0.98;
/// No substep is cheaper than this in plain steps, wherever a law leads to.
const LEAST_PRICE: f32 = 0.3;

/// The settings that the scene requires: the cheapest that meet the tolerance within the time, or, where none do, those of
/// the least strain that fit the time (then [`Plan::meets`] is false).
///
/// Errors: [`Error::NotFinite`], [`Error::Negative`], [`Error::OutOfRange`], [`Error::StepSize`] (the rate),
/// [`Error::NoPlan`]: not even the cheapest fits the time.
pub fn plan(grid: &Grid, def: &PlanDef) -> Result<Plan, Error> {
    in_default_environment(|| {
        check(def)?;
        let mut best: Option<Plan> = None;
        for method in METHODS {
            best = better(best, of_method(grid, def, method, None));
        }
        best.ok_or(Error::NoPlan)
    })
}

/// The best plan of one method, or None where it does not fit the time or cannot be done: what a caller compares to see why
/// [`plan`] chose as it did. `bend` asks for one with bend springs or without, None for the better of both. Errors: those of
/// [`plan`] but for `NoPlan`.
pub fn plan_of(grid: &Grid, def: &PlanDef, method: Method, bend: Option<bool>) -> Result<Option<Plan>, Error> {
    in_default_environment(|| {
        check(def)?;
        Ok(of_method(grid, def, method, bend))
    })
}

/// What meets the tolerance beats what does not; then the cheaper, or else the less strained one. The first where both are
/// alike.
fn better(a: Option<Plan>, b: Option<Plan>) -> Option<Plan> {
    let (Some(x), Some(y)) = (a, b) else { return a.or(b) };
    let second = match (x.meets, y.meets) {
        (true, true) => y.frame_ns < x.frame_ns,
        (false, false) => y.strain < x.strain,
        (_, y) => y,
    };
    if second { b } else { a }
}

fn check(def: &PlanDef) -> Result<(), Error> {
    let numbers = [def.density_kg_m2, def.rate_hz, def.gravity_m_s2, def.tolerance, def.plain_ns];
    if !numbers.iter().chain(&def.stiffness_n_per_m).all(|x| x.is_finite()) || def.budget_ns.is_nan() {
        return Err(Error::NotFinite);
    }
    if def.stiffness_n_per_m.iter().any(|k| *k < 0.0) {
        return Err(Error::Negative);
    }
    if !(1.0..=10_000.0).contains(&def.rate_hz) {
        return Err(Error::StepSize);
    }
    let within = (1e-6..=1e6).contains(&def.density_kg_m2)
        && (f32::MIN_POSITIVE..=1e4).contains(&def.gravity_m_s2)
        && (f32::MIN_POSITIVE..=1.0).contains(&def.tolerance)
        && (f32::MIN_POSITIVE..=1e6).contains(&def.plain_ns)
        && def.budget_ns > 0.0
        && def.stiffness_n_per_m.iter().all(|k| *k <= 1e9);
    if within { Ok(()) } else { Err(Error::OutOfRange) }
}

fn of_method(grid: &Grid, def: &PlanDef, method: Method, bend: Option<bool>) -> Option<Plan> {
    let g = grid.def();
    let row = table::ROWS.get(def.hold as usize)?;
    let can_bend = g.families.contains(Families::BEND);
    let mut best = None;
    for with in [row.bend.kept, !row.bend.kept] {
        if bend.unwrap_or(with) != with || (with && !can_bend) {
            continue;
        }
        let families = if with { g.families } else { Families(g.families.0 & !Families::BEND.0) };
        let cells = (g.rows.max(g.columns) - 1) as f32;
        best = better(best, Sheet { grid, def, row, side: max(g.width_m, g.height_m), cells, families }.of(method));
    }
    best
}

/// A sheet as the laws see it.
struct Sheet<'a> {
    grid: &'a Grid,
    def: &'a PlanDef,
    row: &'static Row,
    /// Longer side in m, and cells along the finer one.
    side: f32,
    cells: f32,
    families: Families,
}

impl Sheet<'_> {
    /// The fewest substeps that meet the tolerance, else the most that fit the time.
    fn of(&self, method: Method) -> Option<Plan> {
        let mut last = None;
        for substeps in 1..=MOST {
            let Some(next) = self.at(method, substeps) else { continue };
            if next.frame_ns > self.def.budget_ns {
                break;
            }
            last = Some(next);
            // more substeps change nothing where the stiffness is the fabric's
            if next.meets || matches!(method, Method::Whole | Method::Implicit) {
                break;
            }
        }
        last
    }

    /// What to expect of a method with so many substeps; None where it cannot be done.
    fn at(&self, method: Method, substeps: u32) -> Option<Plan> {
        let row = self.row;
        let tolerance = self.def.tolerance;
        let (mut solver, mut features, mut radius, mut limit) =
            (Solver::SymplecticEuler, Features::NONE, 0.0, tolerance);
        let mut stiffness = PlanStiffness::Stiffest;
        let d = ClothDef::default();
        let (mut cycles, mut passes, mut speed_limit) = (d.level_cycles, d.strain_passes, d.speed_limit);
        let (strain, price) = match method {
            Method::Plain => (self.by_step(&row.plain, substeps), row.plain_price),
            Method::Inertia => {
                radius = RADIUS * self.side;
                (self.by_step(&row.inertia, substeps), row.plain_price)
            }
            Method::Tethers => {
                features = Features::TETHERS;
                (self.by_step(&row.tethers, substeps), row.tethers_price)
            }
            Method::OneCycle => {
                (features, limit, cycles, passes, speed_limit) = (Features::LEVELS, 0.0, 1, 1, ONE_CYCLE_SPEED);
                (self.by_step(&row.one_cycle, substeps), row.one_cycle_price)
            }
            Method::Levels => {
                features = Features::LEVELS;
                let strain = AIM * tolerance;
                limit = row.levels.limit(strain)?;
                (strain, row.levels.price(self.cells, limit))
            }
            Method::Whole => {
                if substeps < self.whole_substeps() {
                    return None;
                }
                stiffness = PlanStiffness::Fabric;
                (self.by_fabric(&row.whole), row.plain_price)
            }
            Method::Implicit => {
                (solver, features, stiffness) = (Solver::ImplicitEuler, Features::IMPLICIT, PlanStiffness::Fabric);
                (self.by_fabric(&row.implicit), row.implicit_price)
            }
        };
        let is_limited = matches!(method, Method::Tethers | Method::OneCycle | Method::Levels);
        if substeps < LEAST_LIMITED && is_limited {
            return None;
        }
        // tethers need pins, inertia too
        if self.def.hold == Hold::Loose && matches!(method, Method::Tethers | Method::Inertia) {
            return None;
        }
        let as_measured = self.families.contains(Families::BEND) == row.bend.kept;
        let (factor, more) = if as_measured { (1.0, 0.0) } else { (libm::expf(row.bend.ln_strain), row.bend.price) };
        // levels end at their limit with any springs
        let strain = if method == Method::Levels { strain } else { min(strain * factor, f32::MAX) };
        // a pass works on whole vectors of 16
        let padded = self.grid.def().rows as f32 * self.grid.def().columns.next_multiple_of(16) as f32;
        let price = max(price.constant + price.grid / self.cells + price.step / substeps as f32 + more, LEAST_PRICE);
        Some(Plan {
            solver,
            substeps,
            cg_iterations: ITERATIONS,
            families: self.families,
            features,
            stiffness,
            inertia_radius_m: radius,
            limit,
            strain_passes: passes,
            level_cycles: cycles,
            speed_limit,
            strain,
            frame_ns: padded * substeps as f32 * price * self.def.plain_ns,
            meets: strain <= tolerance,
        })
    }

    fn by_step(&self, strains: &Strains, substeps: u32) -> f32 {
        strains.at(self.cells, self.def.rate_hz, substeps as f32, self.side, self.def.gravity_m_s2)
    }

    fn by_fabric(&self, law: &FabricLaw) -> f32 {
        let weight = self.def.density_kg_m2 * self.def.gravity_m_s2 * self.side;
        let [warp, weft, shear, _] = self.def.stiffness_n_per_m;
        let term = |share: f32, k: f32| share * libm::logf(weight / max(k, 1e-6));
        let sum = term(law.warp, warp) + term(law.weft, weft) + term(law.shear, shear);
        min(libm::expf(law.constant + law.grid * libm::logf(self.cells) + sum + law.margin), f32::MAX)
    }

    /// Substeps at which the tuned budget cuts nothing of the fabric: the limit of the flat sheet (budget.rs) solved for dt.
    fn whole_substeps(&self) -> u32 {
        let (u, v) = (self.grid.rest_u(), self.grid.rest_v());
        let share_u = u * u / (u * u + v * v);
        let [warp, weft, shear, bend] = self.def.stiffness_n_per_m;
        let bend = if self.families.contains(Families::BEND) { bend } else { 0.0 };
        let shear = if self.families.contains(Families::SHEAR) { shear } else { 0.0 };
        let along_u = 4.0 * (weft + bend) + 8.0 * shear * share_u;
        let along_v = 4.0 * (warp + bend) + 8.0 * shear * (1.0 - share_u);
        let g = self.grid.def();
        let mass = self.def.density_kg_m2 * g.width_m * g.height_m / self.grid.particles() as f32;
        let omega = sqrt(max(along_u, along_v) / mass);
        let needed = omega / sqrt(4.0 * TUNED_SHARE) / self.def.rate_hz;
        // a hair for the damping; `as` holds what is too large to the largest
        max(needed * 1.01, 1.0) as u32 + 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::GridDef;

    fn grid(side: u32) -> Grid {
        Grid::new(&GridDef { rows: side, columns: side, ..GridDef::default() }).unwrap()
    }

    #[test]
    fn a_tighter_tolerance_never_costs_less() {
        for hold in Hold::ALL {
            for side in [8, 24, 50, 100] {
                let mut cost = 0.0;
                for tolerance in [0.5, 0.2, 0.1, 0.05, 0.02] {
                    let p = plan(&grid(side), &PlanDef { hold, tolerance, ..PlanDef::default() }).unwrap();
                    if p.meets {
                        assert!(p.frame_ns >= cost && p.strain <= tolerance, "{hold:?}, {side}, {tolerance}: {p:?}");
                        cost = p.frame_ns;
                    }
                }
                assert!(cost > 0.0, "{hold:?}, {side}: nothing ever meets");
            }
        }
    }

    #[test]
    fn limits_are_those_whose_worst_strain_is_asked_for() {
        let [a, b, c] = table::LIMITS;
        let law = LevelsLaw { worst: [0.03, 0.055, c], constant: 0.0, grid: 0.0, limit: 0.0 };
        assert_eq!(law.limit(0.029), None);
        for (strain, limit) in [(0.03, a), (0.055, b), (c, c), (c + 0.1, c + 0.1), (0.0425, 0.5 * (a + b))] {
            assert!((law.limit(strain).unwrap() - limit).abs() < 1e-6, "{strain}");
        }
    }

    #[test]
    fn what_does_not_fit_the_time_is_answered() {
        let def = PlanDef { tolerance: 0.01, ..PlanDef::default() };
        let free = plan(&grid(32), &def).unwrap();
        assert!(free.meets);
        let tight = plan(&grid(32), &PlanDef { budget_ns: 0.5 * free.frame_ns, ..def }).unwrap();
        assert!(!tight.meets && tight.frame_ns <= 0.5 * free.frame_ns && tight.strain > free.strain, "{tight:?}");
        assert_eq!(plan(&grid(32), &PlanDef { budget_ns: 1.0, ..def }), Err(Error::NoPlan));
    }

    #[test]
    fn bad_definitions_are_refused() {
        let d = PlanDef::default();
        let err = |d: PlanDef| plan(&grid(8), &d).unwrap_err();
        assert_eq!(err(PlanDef { tolerance: f32::NAN, ..d }), Error::NotFinite);
        assert_eq!(err(PlanDef { budget_ns: f32::NAN, ..d }), Error::NotFinite);
        assert_eq!(err(PlanDef { stiffness_n_per_m: [-1.0; 4], ..d }), Error::Negative);
        assert_eq!(err(PlanDef { rate_hz: 0.0, ..d }), Error::StepSize);
        for bad in [
            PlanDef { tolerance: 0.0, ..d },
            PlanDef { tolerance: 1.5, ..d },
            PlanDef { density_kg_m2: 0.0, ..d },
            PlanDef { gravity_m_s2: 0.0, ..d },
            PlanDef { plain_ns: 0.0, ..d },
            PlanDef { budget_ns: 0.0, ..d },
            PlanDef { stiffness_n_per_m: [1e10; 4], ..d },
        ] {
            assert_eq!(err(bad), Error::OutOfRange, "{bad:?}");
        }
    }

    #[test]
    fn a_plan_makes_a_definition_that_core_takes() {
        let mut cycles = 0;
        for hold in Hold::ALL {
            for tolerance in [0.3, 0.05, 0.001] {
                for method in METHODS {
                    let def = PlanDef { hold, tolerance, ..PlanDef::default() };
                    if let Some(p) = plan_of(&grid(32), &def, method, None).unwrap() {
                        let fitted = p.fit(&ClothDef::default());
                        assert_eq!(fitted.check(), Ok(()), "{p:?}");
                        assert_eq!(fitted.level_cycles, u32::from(method == Method::OneCycle));
                        cycles += fitted.level_cycles;
                    }
                }
            }
        }
        assert!(cycles > 0, "no plan of one cycle");
    }
}
