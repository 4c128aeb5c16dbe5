//! The same scene with different corrections: what each costs and how wrong it is.

use cpu_time::ThreadTime;
use serde::Serialize;
use taut::field::FieldView;
use taut::plan::ONE_CYCLE_SPEED;
use taut::{Budget, Cloth, ClothDef, Error, Families, Features, Grid, GridDef, Solver, noise};

use crate::block::Block;
use crate::fabric::Fabric;
use crate::metrics::{self, StretchPct};
use crate::scene::Scene;

/// The reference uses at most this many substeps of a frame.
const MOST_SUBSTEPS: u32 = 1024;

/// Radius of the inertia field as a share of the larger side, and its largest q: 15 % more inertia with two pins on 1 m.
pub const INERTIA_RADIUS: f32 = 0.3;
/// See [`INERTIA_RADIUS`].
pub const INERTIA_MAX: f32 = 32.0;

/// Stiffness that every budget cuts: "as stiff as the step allows" in N/m.
pub const BEYOND: f32 = 1e8;

/// Warp, weft, shear, bend: the best of the analytic choices where the budget clamps them all.
pub const RATIOS: [f32; 4] = [1.0, 1.0, 0.3, 0.02];

/// What all settings of a comparison share.
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    /// The scene.
    pub scene: Scene,
    /// Particles along v.
    pub rows: u32,
    /// Particles along u.
    pub columns: u32,
    /// Sides in m, along u and along v.
    pub size_m: [f32; 2],
    /// Frames per second.
    pub rate_hz: f32,
    /// Substeps of a frame.
    pub substeps: u32,
    /// The stability budget.
    pub budget: Budget,
    /// Mass per area in kg/m^2.
    pub density_kg_m2: f32,
    /// Simulated time in s.
    pub seconds: f32,
    /// Bending rigidity in N m of the scenes that bend by hinges ([`Scene::features`]).
    pub hinge_rigidity_n_m: f32,
    /// Seed of the random stiffness.
    pub seed: u64,
}

impl Case {
    /// A fabric on a square metre, as many particles on each side, at 60 Hz with the tuned budget.
    pub fn square(scene: Scene, fabric: &Fabric, side: u32, substeps: u32, seconds: f32) -> Case {
        Case {
            scene,
            rows: side,
            columns: side,
            size_m: [1.0, 1.0],
            rate_hz: 60.0,
            substeps,
            budget: Budget::Tuned,
            density_kg_m2: fabric.density_kg_m2,
            seconds,
            hinge_rigidity_n_m: fabric.hinge_rigidity_n_m,
            seed: 0,
        }
    }
}

/// A correction: where the stiffness comes from and whether the inertia field goes with it.
#[derive(Clone, Debug, PartialEq)]
pub enum Setting {
    /// Physical stiffness with as many substeps as it needs.
    Reference(Fabric),
    /// Random stiffness, U(0, 1) of the budget at each particle: the choice that the paper calls traditional.
    Random,
    /// As stiff as the step allows, structural and shear springs alike.
    Uniform,
    /// Physical stiffness from the membrane constants (Lloyd's second class), cut by the budget.
    Analytic(Fabric),
    /// [`Setting::Uniform`] with the inertia field.
    UniformInertia,
    /// [`Setting::Analytic`] with the inertia field.
    AnalyticInertia(Fabric),
    /// As stiff as the step allows in the ratios [`RATIOS`], with the inertia field.
    RatiosInertia,
    /// A generated field `[4][rows][columns]` in N/m with the inertia field.
    Generated(Vec<f32>),
    /// The same field without the inertia field.
    GeneratedAlone(Vec<f32>),
    /// Four numbers in N/m (warp, weft, shear, bend) that were fitted to strains ([`crate::front::fit`]).
    DataDriven([f32; 4]),
}

impl Setting {
    /// The name in reports.
    pub fn name(&self) -> &'static str {
        match self {
            Setting::Reference(_) => "reference",
            Setting::Random => "random",
            Setting::Uniform => "uniform",
            Setting::Analytic(_) => "analytic",
            Setting::UniformInertia => "uniform_inertia",
            Setting::AnalyticInertia(_) => "analytic_inertia",
            Setting::RatiosInertia => "ratios_inertia",
            Setting::Generated(_) => "generated",
            Setting::GeneratedAlone(_) => "generated_alone",
            Setting::DataDriven(_) => "data_driven",
        }
    }

    fn has_inertia(&self) -> bool {
        match self {
            Setting::UniformInertia | Setting::AnalyticInertia(_) | Setting::RatiosInertia | Setting::Generated(_) => {
                true
            }
            Setting::Reference(_)
            | Setting::Random
            | Setting::Uniform
            | Setting::Analytic(_)
            | Setting::GeneratedAlone(_)
            | Setting::DataDriven(_) => false,
        }
    }

    /// The field at the particles in N/m.
    fn field(&self, case: &Case) -> Vec<f32> {
        let n = (case.rows * case.columns) as usize;
        let constant = |k: [f32; 4]| k.iter().flat_map(|k| std::iter::repeat_n(*k, n)).collect();
        match self {
            Setting::Reference(f) | Setting::Analytic(f) | Setting::AnalyticInertia(f) => constant(f.stiffness),
            Setting::DataDriven(k) => constant(*k),
            Setting::Uniform | Setting::UniformInertia => constant([BEYOND, BEYOND, BEYOND, BEYOND]),
            Setting::Random => {
                // one matrix for all families, as the paper has it; U(0, 1) of the budget comes by the scale below
                (0..4 * n).map(|i| noise::uniform(case.seed, (i % n) as u32)).collect()
            }
            Setting::RatiosInertia => constant(RATIOS.map(|r| r * BEYOND)),
            Setting::Generated(field) | Setting::GeneratedAlone(field) => field.clone(),
        }
    }
}

/// What keeps lengths beside the springs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Limits {
    /// Nothing.
    #[default]
    None,
    /// Tethers with this slack in every direction.
    Tethers(f32),
    /// Two passes of the strain limit at this strain.
    StrainLimit(f32),
    /// Levels at these strains along warp, weft and diagonal, with tethers of the same slacks.
    Levels([f32; 3]),
    /// The same where the budget takes more than [`CUT`] of the field, else nothing.
    WhereCut([f32; 3]),
    /// One cycle a substep through levels that aim at this strain, with one sweep over the cloth itself and a speed limit of
    /// eight spacings, since it is for few substeps.
    OneCycle(f32),
}

/// The share of a field above which limits stand in for the stiffness that the step cannot carry: what is left stretches more than
/// four times as far as the fabric. Below it a field with limits is farther from its fabric than without (docs/evaluation.md).
pub const CUT: f32 = 0.75;

impl Limits {
    /// The name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Limits::None => "none",
            Limits::Tethers(_) => "tethers",
            Limits::StrainLimit(_) => "strain_limit",
            Limits::Levels(_) => "levels",
            Limits::WhereCut(_) => "levels_where_cut",
            Limits::OneCycle(_) => "one_cycle",
        }
    }

    /// Levels at one strain in every direction.
    pub fn levels(strain: f32) -> Limits {
        Limits::Levels([strain; 3])
    }

    /// The slack or the strain along warp, weft and diagonal.
    pub fn strains(self) -> Option<[f32; 3]> {
        match self {
            Limits::None => None,
            Limits::Tethers(strain) | Limits::StrainLimit(strain) | Limits::OneCycle(strain) => Some([strain; 3]),
            Limits::Levels(strains) | Limits::WhereCut(strains) => Some(strains),
        }
    }

    /// The largest of [`Limits::strains`].
    pub fn strain(self) -> Option<f32> {
        self.strains().map(|s| s.into_iter().fold(0.0, f32::max))
    }

    /// A definition with these limits.
    pub fn fit(self, def: &ClothDef) -> ClothDef {
        let features = match self {
            Limits::None => Features::NONE,
            Limits::Tethers(_) => Features::TETHERS,
            Limits::StrainLimit(_) => Features::STRAIN_LIMIT,
            Limits::Levels(_) | Limits::WhereCut(_) | Limits::OneCycle(_) => Features::LEVELS,
        };
        let strain = self.strains().unwrap_or(def.strain_limit);
        let slack = self.strains().unwrap_or(def.tether_slack);
        let def = ClothDef {
            features: Features(def.features.0 | features.0),
            strain_limit: strain,
            tether_slack: slack,
            ..*def
        };
        match self {
            Limits::OneCycle(_) => ClothDef { level_cycles: 1, strain_passes: 1, speed_limit: ONE_CYCLE_SPEED, ..def },
            _ => def,
        }
    }
}

/// A cloth in a case: where its stiffness comes from and how it is stepped.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    /// Where the stiffness comes from.
    pub setting: Setting,
    /// Spring families.
    pub families: Families,
    /// The solver; the implicit ones take K as it is.
    pub solver: Solver,
    /// Iterations of each linearisation of an implicit solver.
    pub cg_iterations: u32,
    /// What keeps lengths beside the springs.
    pub limits: Limits,
}

impl Model {
    /// A setting with limits on levels, else as [`Model::from`] has it.
    pub fn limited(setting: Setting, strains: [f32; 3]) -> Model {
        Model { limits: Limits::Levels(strains), ..setting.into() }
    }

    /// The same where the budget takes most of the field.
    pub fn limited_where_cut(setting: Setting, strains: [f32; 3]) -> Model {
        Model { limits: Limits::WhereCut(strains), ..setting.into() }
    }

    /// The name in reports: that of the setting, or with limits on levels that with "limits" for the inertia.
    pub fn name(&self) -> &'static str {
        let name = self.setting.name();
        match (self.limits, name) {
            (Limits::Levels(_), "uniform_inertia") => "uniform_limits",
            (Limits::Levels(_), "analytic_inertia") => "analytic_limits",
            (Limits::Levels(_), "ratios_inertia") => "ratios_limits",
            (Limits::Levels(_), "generated") => "generated_limits",
            (Limits::Levels(_), _) => "limits",
            (Limits::WhereCut(_), "generated") => "generated_limits_where_cut",
            (Limits::WhereCut(_), _) => "limits_where_cut",
            _ => name,
        }
    }
}

impl From<Setting> for Model {
    /// All families, the explicit solver, no limits.
    fn from(setting: Setting) -> Model {
        let d = ClothDef::default();
        Model {
            setting,
            families: Families::ALL,
            solver: d.solver,
            cg_iterations: d.cg_iterations,
            limits: Limits::None,
        }
    }
}

/// The result of one setting.
#[derive(Clone, Debug, Serialize)]
pub struct Outcome {
    /// Its name.
    pub name: &'static str,
    /// Substeps it used.
    pub substeps: u32,
    /// Structural stretch at the end.
    pub stretch_pct: StretchPct,
    /// Largest structural stretch over all frames, the fall included.
    pub peak_stretch_pct: f64,
    /// Share of the stiffness that the budget cut.
    pub cut_fraction: f64,
    /// Inertia added by the inertia field, as a share of the free mass.
    pub inertia_added: f64,
    /// Thread CPU time per particle and substep.
    pub ns_per_particle_step: f64,
    /// Memory of the cloth in bytes.
    pub memory_bytes: usize,
    /// Whether the whole run stayed finite.
    pub finite: bool,
    /// Root mean square speed at the end in m/s: 0 is at rest.
    pub rms_speed_m_s: f64,
    /// Hash of the state at the end, 16 hexadecimal digits.
    pub state_hash: String,
    /// Positions at the end in m, row by row; not part of the report.
    #[serde(skip)]
    pub positions: Vec<[f32; 3]>,
}

/// A frame that was stepped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Its number, from 0 on.
    pub index: u32,
    /// How many there will be.
    pub of: u32,
    /// Thread CPU time of the step.
    pub cpu: std::time::Duration,
}

impl Frame {
    /// The share of the frames that is done.
    pub fn done(self) -> f32 {
        (self.index + 1) as f32 / self.of as f32
    }
}

/// Runs a case with a setting. `progress` is called after every frame with the share that is done.
pub fn run(case: &Case, setting: &Setting, mut progress: impl FnMut(f32)) -> Result<Outcome, Error> {
    run_model(case, &setting.clone().into(), |_, frame| progress(frame.done()))
}

/// Runs a case with a model and shows every frame to `look`.
pub fn run_model(case: &Case, model: &Model, mut look: impl FnMut(&Cloth<'_>, Frame)) -> Result<Outcome, Error> {
    let setting = &model.setting;
    let grid = Grid::new(&GridDef {
        rows: case.rows,
        columns: case.columns,
        width_m: case.size_m[0],
        height_m: case.size_m[1],
        families: model.families,
    })?;
    let shape = (case.rows as usize, case.columns as usize);
    let memory = if model.solver == Solver::SymplecticEuler { Features::NONE } else { Features::IMPLICIT };
    let base = ClothDef {
        rate_hz: case.rate_hz,
        substeps: case.substeps,
        density_kg_m2: case.density_kg_m2,
        budget: case.budget,
        inertia_radius_m: if setting.has_inertia() { INERTIA_RADIUS * case.size_m[0].max(case.size_m[1]) } else { 0.0 },
        inertia_max: INERTIA_MAX,
        hinge_rigidity_n_m: case.hinge_rigidity_n_m,
        solver: model.solver,
        cg_iterations: model.cg_iterations,
        features: memory,
        ..ClothDef::default()
    };
    let mut def = case.scene.fit(&model.limits.fit(&base), shape.0, shape.1);
    let mut block = Block::new(Cloth::memory(&grid, &def)?);
    let field = setting.field(case);
    // what the budget says of the field where the scene pins it
    let mut told = |def: &ClothDef| {
        let mut cloth = Cloth::create(&grid, def, block.numbers_mut())?;
        cloth.set_stiffness_field(&FieldView::new(4, shape.0, shape.1, &field)?);
        case.scene.set_up(&mut cloth, 0)?;
        cloth.budget()
    };
    if let Setting::Reference(_) = setting {
        // the substeps at which the budget cuts nothing, with a fifth more for the motion
        let needed = 1.2 / (told(&def)?.max_dt_s * case.rate_hz);
        def.substeps = (needed.ceil() as u32).clamp(case.substeps.min(MOST_SUBSTEPS), MOST_SUBSTEPS);
    }
    if let Limits::WhereCut(_) = model.limits
        && told(&def)?.cut_fraction <= CUT
    {
        def = case.scene.fit(&base, shape.0, shape.1);
    }
    let mut cloth = Cloth::create(&grid, &def, block.numbers_mut())?;
    let scaled: Vec<f32>;
    let field = if *setting == Setting::Random {
        // scale so that the largest is what the budget would give a uniform cloth
        cloth.set_stiffness_uniform([1.0, 1.0, 1.0, 1.0])?;
        case.scene.set_up(&mut cloth, 0)?;
        let b = cloth.budget()?;
        let k = (b.max_dt_s / b.dt_s).powi(2);
        scaled = field.iter().map(|f| f * k).collect();
        &scaled
    } else {
        &field
    };
    cloth.set_stiffness_field(&FieldView::new(4, shape.0, shape.1, field)?);
    case.scene.set_up(&mut cloth, 0)?;
    let budget = cloth.budget()?;

    let frames = (case.seconds * case.rate_hz).round().max(1.0) as u32;
    let (mut finite, mut peak) = (true, 0.0f32);
    let mut cpu = std::time::Duration::ZERO;
    for frame in 0..frames {
        case.scene.drive(&mut cloth, f64::from(frame + 1) / f64::from(case.rate_hz), 0)?;
        let start = ThreadTime::now();
        finite &= !cloth.step()?.contains(taut::StepFlags::NON_FINITE);
        let frame = Frame { index: frame, of: frames, cpu: start.elapsed() };
        cpu += frame.cpu;
        peak = peak.max(cloth.strain().largest);
        look(&cloth, frame);
    }
    let particles = grid.particles();
    let mass = f64::from(cloth.particle_mass_kg());
    let steps = f64::from(frames) * f64::from(def.substeps) * particles as f64;
    Ok(Outcome {
        name: model.name(),
        substeps: def.substeps,
        stretch_pct: metrics::stretch(&cloth),
        peak_stretch_pct: 100.0 * f64::from(peak),
        cut_fraction: f64::from(budget.cut_fraction),
        inertia_added: f64::from(budget.inertia_added),
        ns_per_particle_step: cpu.as_secs_f64() * 1e9 / steps,
        memory_bytes: size_of::<f32>() * Cloth::memory(&grid, &def)?,
        finite,
        rms_speed_m_s: (2.0 * cloth.kinetic_energy_j() / (mass * particles as f64)).sqrt(),
        state_hash: format!("{:016x}", cloth.state_hash()),
        positions: (0..particles).map(|i| cloth.position(i).map(|p| [p.x, p.y, p.z])).collect::<Result<_, _>>()?,
    })
}
