//! What a cloth carries while it is timed.

use taut::field::FieldView;
use taut::{
    Cloth, ClothDef, ColliderDef, Error, Families, Features, Grid, GridDef, Pose, Shape, Solver, Target, TargetLimit,
    Vector3, Width, noise,
};

/// Limits that nothing reaches, and limits that a hanging sheet of soft springs is held at.
const FAR: f32 = 10.0;
const NEAR: f32 = 0.02;

/// A cloth of N x N particles pinned at two corners, with gravity, damping and a stiffness of its own at every particle, and
/// one thing more.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Load {
    /// Nothing more: all three families, speed limit and compression limit.
    Plain,
    /// Structural springs alone.
    StructuralOnly,
    /// Without bend springs.
    NoBend,
    /// Neither speed limit nor compression limit.
    NoClamps,
    /// The inertia field.
    Inertia,
    /// Forces on single particles.
    Pull,
    /// Wind with gusts.
    Air,
    /// Hinges in place of the bend springs; compare with [`Load::NoBend`].
    Hinge,
    /// Two tethers a particle.
    Tethers,
    /// The strain limit, two passes, with nothing too long.
    StrainLimitIdle,
    /// The strain limit, two passes, with much too long.
    StrainLimit,
    /// Levels with nothing too long.
    LevelsIdle,
    /// Levels with much too long.
    Levels,
    /// One cycle through levels that aim at no strain, one sweep over the cloth itself.
    OneCycle,
    /// A sphere that is far.
    ColliderFar,
    /// A plane that every particle lies on.
    ColliderTouched,
    /// Skinned targets with a largest distance that nothing reaches.
    Targets,
    /// A mass of its own for every particle.
    Mass,
    /// A disc.
    Mask,
    /// Implicit Euler, 10 iterations.
    ImplicitEuler,
    /// BDF2, 10 iterations.
    Bdf2,
}

impl Load {
    /// Every load, the plain one first.
    pub const ALL: [Load; 21] = [
        Load::Plain,
        Load::StructuralOnly,
        Load::NoBend,
        Load::NoClamps,
        Load::Inertia,
        Load::Pull,
        Load::Air,
        Load::Hinge,
        Load::Tethers,
        Load::StrainLimitIdle,
        Load::StrainLimit,
        Load::LevelsIdle,
        Load::Levels,
        Load::OneCycle,
        Load::ColliderFar,
        Load::ColliderTouched,
        Load::Targets,
        Load::Mass,
        Load::Mask,
        Load::ImplicitEuler,
        Load::Bdf2,
    ];

    /// The name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Load::Plain => "plain",
            Load::StructuralOnly => "structural_only",
            Load::NoBend => "no_bend",
            Load::NoClamps => "no_clamps",
            Load::Inertia => "inertia",
            Load::Pull => "pull",
            Load::Air => "air",
            Load::Hinge => "hinge",
            Load::Tethers => "tethers",
            Load::StrainLimitIdle => "strain_limit_idle",
            Load::StrainLimit => "strain_limit",
            Load::LevelsIdle => "levels_idle",
            Load::Levels => "levels",
            Load::OneCycle => "one_cycle",
            Load::ColliderFar => "collider_far",
            Load::ColliderTouched => "collider_touched",
            Load::Targets => "targets",
            Load::Mass => "mass",
            Load::Mask => "mask",
            Load::ImplicitEuler => "implicit_euler",
            Load::Bdf2 => "bdf2",
        }
    }

    /// The load that it is compared with: what it adds is the difference.
    pub fn beside(self) -> Load {
        if self == Load::Hinge { Load::NoBend } else { Load::Plain }
    }

    /// The solver's name.
    pub fn solver(self) -> &'static str {
        match self {
            Load::ImplicitEuler => "implicit_euler",
            Load::Bdf2 => "bdf2",
            _ => "symplectic_euler",
        }
    }

    /// Its grid.
    pub fn grid(self, side: u32) -> Result<Grid, Error> {
        let families = match self {
            Load::StructuralOnly => Families::STRUCTURAL,
            Load::NoBend | Load::Hinge => Families(Families::STRUCTURAL.0 | Families::SHEAR.0),
            _ => Families::ALL,
        };
        Grid::new(&GridDef { rows: side, columns: side, families, ..GridDef::default() })
    }

    /// Its definition.
    pub fn def(self) -> ClothDef {
        let def = ClothDef::default();
        let with = |features| ClothDef { features, ..def };
        let limited = |features, limit| ClothDef { features, strain_limit: [limit; 3], ..def };
        match self {
            Load::Plain | Load::StructuralOnly | Load::NoBend => def,
            Load::NoClamps => ClothDef { speed_limit: 0.0, compression_limit: false, ..def },
            Load::Inertia => ClothDef { inertia_radius_m: 0.3, ..def },
            Load::Pull => with(Features::PULL),
            Load::Air => with(Features::AIR),
            Load::Hinge => with(Features::HINGE),
            Load::Tethers => with(Features::TETHERS),
            Load::StrainLimitIdle => limited(Features::STRAIN_LIMIT, FAR),
            Load::StrainLimit => limited(Features::STRAIN_LIMIT, NEAR),
            Load::LevelsIdle => limited(Features::LEVELS, FAR),
            Load::Levels => limited(Features::LEVELS, NEAR),
            Load::OneCycle => ClothDef { level_cycles: 1, strain_passes: 1, ..limited(Features::LEVELS, 0.0) },
            Load::ColliderFar | Load::ColliderTouched => with(Features::COLLIDERS),
            Load::Targets => with(Features::TARGETS),
            Load::Mass => with(Features::MASS),
            Load::Mask => with(Features::MASK),
            Load::ImplicitEuler => ClothDef { solver: Solver::ImplicitEuler, ..with(Features::IMPLICIT) },
            Load::Bdf2 => ClothDef { solver: Solver::Bdf2, ..with(Features::IMPLICIT) },
        }
    }

    /// f32 numbers of its memory.
    pub fn memory(self, side: u32) -> Result<usize, Error> {
        Cloth::memory(&self.grid(side)?, &self.def())
    }

    /// A cloth with the load in a block, in motion.
    pub fn create<'a>(self, side: u32, width: Width, block: &'a mut [f32]) -> Result<Cloth<'a>, Error> {
        let grid = self.grid(side)?;
        let mut cloth = Cloth::create(&grid, &self.def(), block)?;
        cloth.set_width(width)?;
        let n = side as usize;
        let particles = n * n;
        // as a generated field is: no two springs alike
        let levels = [5000.0, 4000.0, 1500.0, 80.0];
        let field: Vec<f32> =
            (0..4 * particles).map(|i| levels[i / particles] * (0.9 + 0.2 * noise::uniform(7, i as u32))).collect();
        cloth.set_stiffness_field(&FieldView::new(4, n, n, &field)?);
        match self {
            Load::Mask => {
                let middle = 0.5 * (n - 1) as f32;
                let inside = |i: usize| ((i / n) as f32 - middle).hypot((i % n) as f32 - middle) <= middle + 0.6;
                cloth.set_mask(&(0..particles).map(|i| u8::from(inside(i))).collect::<Vec<u8>>())?;
                cloth.pin(n / 2)?;
            }
            Load::ColliderTouched => {
                let floor = Shape::Plane { normal: [0.0, 0.0, 1.0] };
                cloth.add_collider(&ColliderDef::new(floor, Pose::at(Vector3::new(0.0, 0.0, -0.001))))?;
                cloth.set_gravity([0.0, -1.0, -9.81])?;
                cloth.pin(0)?;
                cloth.pin(n - 1)?;
            }
            _ => {
                cloth.pin(0)?;
                cloth.pin(n - 1)?;
            }
        }
        match self {
            Load::Pull => cloth.add_force(particles / 2, Vector3::new(0.0, 0.0, 0.1))?,
            Load::Air => cloth.set_air(&taut::Air { wind_m_s: [1.0, 0.0, 3.0], gust: 0.3, ..taut::Air::default() })?,
            Load::ColliderFar => {
                let ball = Shape::Sphere { radius_m: 0.2 };
                cloth.add_collider(&ColliderDef::new(ball, Pose::at(Vector3::new(9.0, 0.0, 0.0))))?;
            }
            Load::Targets => {
                let up = Target { position_m: Vector3::new(0.5, 0.0, 0.5), normal: Vector3::new(0.0, 1.0, 0.0) };
                cloth.set_targets(Vector3::zeros(), |_| up)?;
                cloth.set_target_limits(|_| TargetLimit { max_distance_m: 100.0, ..TargetLimit::default() })?;
            }
            Load::Mass => {
                let mass = cloth.particle_mass_kg();
                let kg: Vec<f32> = (0..particles).map(|i| mass * (1.0 + 0.5 * noise::uniform(3, i as u32))).collect();
                cloth.set_masses(&kg)?;
            }
            // fifty times too soft for its limits, so that they hold the sheet
            Load::Levels | Load::StrainLimit => {
                let soft: Vec<f32> = field.iter().map(|k| 0.02 * k).collect();
                cloth.set_stiffness_field(&FieldView::new(4, n, n, &soft)?);
            }
            _ => {}
        }
        for _ in 0..3 {
            cloth.step()?;
        }
        Ok(cloth)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_load_steps_and_does_what_it_says() {
        for load in Load::ALL {
            let mut block = vec![0.0; load.memory(17).unwrap()];
            let mut cloth =
                load.create(17, Width::best(), &mut block).unwrap_or_else(|e| panic!("{}: {e}", load.name()));
            for _ in 0..20 {
                assert_eq!(cloth.step().unwrap(), taut::StepFlags(0), "{}", load.name());
            }
            let largest = cloth.strain().largest;
            match load {
                Load::Levels => assert!((0.002..0.05).contains(&largest), "held: {largest}"),
                Load::OneCycle => assert!(largest < 0.01, "held: {largest}"),
                Load::LevelsIdle | Load::StrainLimitIdle => {
                    let mut block = vec![0.0; Load::Plain.memory(17).unwrap()];
                    let mut plain = Load::Plain.create(17, Width::best(), &mut block).unwrap();
                    for _ in 0..20 {
                        plain.step().unwrap();
                    }
                    assert_eq!(plain.position(100), cloth.position(100), "{} does nothing", load.name());
                }
                _ => {}
            }
        }
    }
}
