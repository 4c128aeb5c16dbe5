//! The structures of the header. They are plain numbers without padding, so every bit pattern is a valid value and what
//! is wrong with it can be answered.

/// Most particles of a grid side.
pub const TAUT_MAX_SIDE: u32 = 4096;

/// Structural springs to the four neighbours: warp along v, weft along u. Always on.
pub const TAUT_FAMILY_STRUCTURAL: u32 = 1;
/// Shear springs to the four diagonal neighbours.
pub const TAUT_FAMILY_SHEAR: u32 = 2;
/// Bend springs to the particles two cells away.
pub const TAUT_FAMILY_BEND: u32 = 4;
/// All spring families.
pub const TAUT_FAMILY_ALL: u32 = 7;

/// No optional parts.
pub const TAUT_FEATURE_NONE: u32 = 0;
/// Forces on single particles (taut_cloth_add_force).
pub const TAUT_FEATURE_PULL: u32 = 1;
/// Air: drag, lift and wind (taut_cloth_set_air).
pub const TAUT_FEATURE_AIR: u32 = 2;
/// Hinge bending of the rigidity taut_cloth_def.hinge_rigidity_n_m.
pub const TAUT_FEATURE_HINGE: u32 = 4;
/// Tethers to the nearest pins.
pub const TAUT_FEATURE_TETHERS: u32 = 8;
/// The strain limit.
pub const TAUT_FEATURE_STRAIN_LIMIT: u32 = 16;
/// The strain limit on levels, from coarse to fine.
pub const TAUT_FEATURE_LEVELS: u32 = 32;
/// Colliders, up to TAUT_MAX_COLLIDERS.
pub const TAUT_FEATURE_COLLIDERS: u32 = 64;
/// A skinned target of each particle with a largest distance and a backstop.
pub const TAUT_FEATURE_TARGETS: u32 = 128;
/// A mass of its own for each particle (taut_cloth_set_masses).
pub const TAUT_FEATURE_MASS: u32 = 256;
/// Absent particles (taut_cloth_set_mask).
pub const TAUT_FEATURE_MASK: u32 = 512;
/// Working memory of an implicit solver; taut_cloth_def.solver chooses it.
pub const TAUT_FEATURE_IMPLICIT: u32 = 1024;

/// Most colliders of a cloth.
pub const TAUT_MAX_COLLIDERS: usize = 32;

/// A flag of taut_cloth_step: the frame would have ended with a number that is not finite. It was taken back whole:
/// positions, velocities, pins and step index are those before the call; pin targets, forces and the ways of colliders and
/// targets in the frame are dropped. One of the TAUT_STEP_NON_FINITE_* names the cause beside it.
pub const TAUT_STEP_NON_FINITE: u32 = 1;
/// A flag of taut_cloth_step: the cloth slept through the frame; only the step index has changed.
pub const TAUT_STEP_ASLEEP: u32 = 2;
/// A flag of taut_cloth_step: a pin is not finite, or without the ways of the pins the frame would have stayed finite.
pub const TAUT_STEP_NON_FINITE_PIN: u32 = 4;
/// A flag of taut_cloth_step: the air is not finite, or in still air the frame would have stayed finite.
pub const TAUT_STEP_NON_FINITE_AIR: u32 = 8;
/// A flag of taut_cloth_step: a force is not finite, or without the forces of taut_cloth_add_force the frame would have stayed
/// finite.
pub const TAUT_STEP_NON_FINITE_FORCE: u32 = 16;
/// A flag of taut_cloth_step: a collider is not finite, or without the ways of the colliders the frame would have stayed
/// finite.
pub const TAUT_STEP_NON_FINITE_COLLIDER: u32 = 32;
/// A flag of taut_cloth_step: a skinned target is not finite, or without the ways of the targets the frame would have stayed
/// finite.
pub const TAUT_STEP_NON_FINITE_TARGET: u32 = 64;
/// A flag of taut_cloth_step: none of these; positions, velocities or springs themselves run away.
pub const TAUT_STEP_NON_FINITE_STATE: u32 = 128;

/// A flag of taut_budget_report: the predicted stretch is above 0.2. It is not within 15 % of what will be, and the cloth
/// will look like rubber.
pub const TAUT_BUDGET_ABOVE_RANGE: u32 = 1;
/// A flag of taut_budget_report: there is no prediction. The cloth does not hang from a whole straight edge or from its two
/// corners with nothing but its weight to bear, its warp is more than twice as stiff as its weft or the reverse (two corners),
/// or its rest was not found. The bound holds.
pub const TAUT_BUDGET_STRETCH_UNKNOWN: u32 = 2;
/// A flag of taut_budget_report: limits were asked for that this cloth may exceed: tethers or the strain limit alone, levels
/// with a mask or with level_cycles above 0, or levels with a strain_limit below 3 m/s times dt / the smallest rest length.
pub const TAUT_BUDGET_LIMIT_NOT_KEPT: u32 = 4;

const _: () = {
    assert!(TAUT_MAX_SIDE == taut_core::Grid::MAX_SIDE);
    assert!(TAUT_FAMILY_STRUCTURAL == taut_core::Families::STRUCTURAL.0);
    assert!(TAUT_FAMILY_SHEAR == taut_core::Families::SHEAR.0);
    assert!(TAUT_FAMILY_BEND == taut_core::Families::BEND.0);
    assert!(TAUT_FAMILY_ALL == taut_core::Families::ALL.0);
    assert!(TAUT_FEATURE_NONE == taut_core::Features::NONE.0);
    assert!(TAUT_FEATURE_PULL == taut_core::Features::PULL.0);
    assert!(TAUT_FEATURE_AIR == taut_core::Features::AIR.0);
    assert!(TAUT_FEATURE_HINGE == taut_core::Features::HINGE.0);
    assert!(TAUT_FEATURE_TETHERS == taut_core::Features::TETHERS.0);
    assert!(TAUT_FEATURE_STRAIN_LIMIT == taut_core::Features::STRAIN_LIMIT.0);
    assert!(TAUT_FEATURE_LEVELS == taut_core::Features::LEVELS.0);
    assert!(TAUT_FEATURE_COLLIDERS == taut_core::Features::COLLIDERS.0);
    assert!(TAUT_FEATURE_TARGETS == taut_core::Features::TARGETS.0);
    assert!(TAUT_FEATURE_MASS == taut_core::Features::MASS.0);
    assert!(TAUT_FEATURE_MASK == taut_core::Features::MASK.0);
    assert!(TAUT_FEATURE_IMPLICIT == taut_core::Features::IMPLICIT.0);
    assert!(TAUT_MAX_COLLIDERS == taut_core::MAX_COLLIDERS);
    assert!(Solver::TAUT_SOLVER_SYMPLECTIC_EULER as u32 == taut_core::Solver::SymplecticEuler as u32);
    assert!(Solver::TAUT_SOLVER_IMPLICIT_EULER as u32 == taut_core::Solver::ImplicitEuler as u32);
    assert!(Solver::TAUT_SOLVER_BDF2 as u32 == taut_core::Solver::Bdf2 as u32);
    assert!(TAUT_STEP_NON_FINITE == taut_core::StepFlags::NON_FINITE.0);
    assert!(TAUT_STEP_ASLEEP == taut_core::StepFlags::ASLEEP.0);
    assert!(TAUT_STEP_NON_FINITE_PIN == taut_core::StepFlags::NON_FINITE_PIN.0);
    assert!(TAUT_STEP_NON_FINITE_AIR == taut_core::StepFlags::NON_FINITE_AIR.0);
    assert!(TAUT_STEP_NON_FINITE_FORCE == taut_core::StepFlags::NON_FINITE_FORCE.0);
    assert!(TAUT_STEP_NON_FINITE_COLLIDER == taut_core::StepFlags::NON_FINITE_COLLIDER.0);
    assert!(TAUT_STEP_NON_FINITE_TARGET == taut_core::StepFlags::NON_FINITE_TARGET.0);
    assert!(TAUT_STEP_NON_FINITE_STATE == taut_core::StepFlags::NON_FINITE_STATE.0);
    assert!(TAUT_BUDGET_ABOVE_RANGE == taut_core::BudgetFlags::ABOVE_RANGE.0);
    assert!(TAUT_BUDGET_STRETCH_UNKNOWN == taut_core::BudgetFlags::STRETCH_UNKNOWN.0);
    assert!(TAUT_BUDGET_LIMIT_NOT_KEPT == taut_core::BudgetFlags::LIMIT_NOT_KEPT.0);
    assert!(Width::TAUT_WIDTH_SCALAR as u32 == taut_core::Width::Scalar as u32);
    assert!(Width::TAUT_WIDTH_SSE2 as u32 == taut_core::Width::Sse2 as u32);
    assert!(Width::TAUT_WIDTH_AVX2 as u32 == taut_core::Width::Avx2 as u32);
    assert!(Width::TAUT_WIDTH_AVX512 as u32 == taut_core::Width::Avx512 as u32);
    assert!(Width::TAUT_WIDTH_NEON as u32 == taut_core::Width::Neon as u32);
    assert!(Budget::TAUT_BUDGET_CERTIFIED as u32 == taut_core::Budget::Certified as u32);
    assert!(Budget::TAUT_BUDGET_TUNED as u32 == taut_core::Budget::Tuned as u32);
};

/// How the stiffness is cut to what the step can carry. All four channels of a particle are cut alike.
#[allow(non_camel_case_types, reason = "these are the names in C")]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum Budget {
    /// 0.25 of the limit of the flat sheet, which holds for every shape of the cloth: stable from any start, and with some
    /// damping (1/s) it comes to rest without any limit on speed or compression. 0.31 of the stiffness of TAUT_BUDGET_TUNED.
    TAUT_BUDGET_CERTIFIED = 0,
    /// 0.8 of the limit of the flat sheet. Needs the speed limit and some damping. The default.
    TAUT_BUDGET_TUNED = 1,
}

/// How a frame is solved.
#[allow(non_camel_case_types, reason = "these are the names in C")]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum Solver {
    /// Symplectic Euler: explicit and cheapest; the stiffness is cut to the budget. The default.
    TAUT_SOLVER_SYMPLECTIC_EULER = 0,
    /// Implicit Euler with conjugate gradients: the stiffness as it is, at any step; damps motion.
    TAUT_SOLVER_IMPLICIT_EULER = 1,
    /// The second-order backward difference formula with conjugate gradients: as above, with less damping.
    TAUT_SOLVER_BDF2 = 2,
}

/// The vectors that a cloth is stepped in. Each gives the same bits; only the time differs.
#[allow(non_camel_case_types, reason = "these are the names in C")]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum Width {
    /// One number at a time: every processor.
    TAUT_WIDTH_SCALAR = 0,
    /// 4 numbers: every x86_64.
    TAUT_WIDTH_SSE2 = 1,
    /// 8 numbers: x86_64 with AVX2.
    TAUT_WIDTH_AVX2 = 2,
    /// 16 numbers: x86_64 with AVX-512F.
    TAUT_WIDTH_AVX512 = 3,
    /// 4 numbers: every aarch64.
    TAUT_WIDTH_NEON = 4,
}

/// The shape of a collider.
#[allow(non_camel_case_types, reason = "these are the names in C")]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum ColliderShape {
    /// A ball around the collider's position: radius_m[0].
    TAUT_SHAPE_SPHERE = 1,
    /// The hull of two balls: ends_m and radius_m. Where one ball holds the other it is the larger ball.
    TAUT_SHAPE_CAPSULE = 2,
    /// The half space behind the plane through the collider's position: normal.
    TAUT_SHAPE_PLANE = 3,
    /// A box around the collider's position: half_m.
    TAUT_SHAPE_BOX = 4,
}

/// What a grid is made of. Comes from taut_grid_def_default(), then change what you need.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct GridDef {
    /// Bytes of this structure. Set by taut_grid_def_default().
    pub size: u32,
    /// Shows that the definition came from taut_grid_def_default().
    pub cookie: u32,
    /// Particles along v, 2 to 4096. Default 32.
    pub rows: u32,
    /// Particles along u, 2 to 4096. Default 32.
    pub columns: u32,
    /// Side length along u in m, above 0, at most 10,000. Default 1.
    pub width_m: f32,
    /// Side length along v in m, above 0, at most 10,000. Default 1.
    pub height_m: f32,
    /// Spring families, TAUT_FAMILY_* or-ed; the structural ones must be on. A family that is off costs no memory and no
    /// time. Default TAUT_FAMILY_ALL.
    pub families: u32,
}

/// What a cloth is made of beside its grid. Comes from taut_cloth_def_default(), then change what you need. SI units; no
/// axis is "up".
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct ClothDef {
    /// Bytes of this structure. Set by taut_cloth_def_default().
    pub size: u32,
    /// Shows that the definition came from taut_cloth_def_default().
    pub cookie: u32,
    /// World position of the cloth's local frame in m, each at most 1e12 in size: where particle 0 starts. Default 0, 0, 0.
    pub origin_m: [f64; 3],
    /// Frames per second, 1 to 10,000. One taut_cloth_step is one frame. Fixed for the life of the cloth. Default 60.
    pub rate_hz: f32,
    /// Equal substeps of a frame, 1 to 1,024. dt = 1 / (rate_hz * substeps). More substeps carry stiffer cloth. Default 16.
    pub substeps: u32,
    /// Mass per area in kg/m^2, 1e-6 to 1e6; taut_field_info tells that of a baked field. Default 0.2.
    pub density_kg_m2: f32,
    /// Damping c in 1/s: the force -c M v on each particle. At least 0, and c dt below 1. Default 2.
    pub damping_per_s: f32,
    /// Speed limit as a fraction of the smallest rest length per substep, 1e-6 to 1e6; 0 = none. Default 0.25. The
    /// implicit solvers need none and do not know it.
    pub speed_limit: f32,
    /// 1: a compressed spring pushes with at most its stiffness times its length, which keeps crumpled cloth from
    /// exploding; 0: off. Default 1.
    pub compression_limit: u32,
    /// A taut_budget. Default TAUT_BUDGET_TUNED.
    pub budget: u32,
    /// Radius of the inertia field in m, 0 to 1e4; 0 = none. A particle closer to a pin than this has more inertia (radius /
    /// distance times its mass, its weight unchanged), so that the cloth can be stiff at the pins, where it stretches most,
    /// at no cost in dt. Default 0.
    pub inertia_radius_m: f32,
    /// Largest factor of the inertia field, 1 to 1e4. Default 32.
    pub inertia_max: f32,
    /// Most pins at a time, 28 bytes each; more than there are particles means all of them. Default 256, or the number of
    /// particles if that is less.
    pub max_pins: u32,
    /// A taut_solver; the implicit ones need TAUT_FEATURE_IMPLICIT. Default TAUT_SOLVER_SYMPLECTIC_EULER.
    pub solver: u32,
    /// Iterations of the conjugate gradients of an implicit solver in each of the two linearisations of a substep, 1 to 1,000.
    /// Default 10.
    pub cg_iterations: u32,
    /// How much longer than the way through the resting cloth a tether may get: warp, weft, diagonal, each 0 to 10 (0.05 is
    /// 5 %). Default 0.
    pub tether_slack: [f32; 3],
    /// Largest strain that the strain limit and the levels aim at; the levels keep it along warp and weft (see level_cycles):
    /// warp, weft, diagonal, each 0 to 10. Default 0.05.
    pub strain_limit: [f32; 3],
    /// Passes of the strain limit in each substep, and of the levels over the cloth itself in each cycle, 1 to 64. Default 2.
    pub strain_passes: u32,
    /// Bending rigidity D of the hinges in N m, 0 to 1e6. Default 1e-5.
    pub hinge_rigidity_n_m: f32,
    /// A cloth whose particles are all slower than this for half a second sleeps until something wakes it, in m/s, 0 to
    /// 1e3; 0 = never. Default 0.
    pub sleep_speed_m_s: f32,
    /// Optional parts, TAUT_FEATURE_* or-ed. What is not asked for costs no memory and no time. Default TAUT_FEATURE_NONE.
    pub features: u32,
    /// Gravity in m/s^2, at most 1e4 in size. Default 0, -9.81, 0.
    pub gravity_m_s2: [f32; 3],
    /// Direction of u (along a row) at the start, 1e-3 to 1e3 long. Default 1, 0, 0.
    pub u_axis: [f32; 3],
    /// Direction of v (along a column, from row 0 on) at the start, 1e-3 to 1e3 long. Default 0, -1, 0.
    pub v_axis: [f32; 3],
    /// Cycles through the levels in each substep, 1 to 32: at most so many are paid, and strain_limit is what they aim at,
    /// nothing that they promise. 0: as many as it takes that no structural spring is beyond strain_limit, at most 32. Only
    /// with TAUT_FEATURE_LEVELS. Default 0.
    pub level_cycles: u32,
}

/// Memory that a call asks for.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Memory {
    /// Bytes.
    pub size: usize,
    /// Alignment of the first byte, a power of two.
    pub align: usize,
}

/// Sizes of a grid.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Counts {
    /// Particles along v.
    pub rows: u32,
    /// Particles along u.
    pub columns: u32,
    /// Particles, rows times columns. Particle (row, column) has the index row * columns + column.
    pub particles: u32,
    /// Springs of all families that are on.
    pub springs: u32,
}

/// A box with sides along the axes, in the world in m.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Bounds {
    /// Smallest x, y and z in m.
    pub low_m: [f64; 3],
    /// Largest x, y and z in m.
    pub high_m: [f64; 3],
}

/// What the budget made of the stiffness.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct BudgetReport {
    /// Length of a substep in s.
    pub dt_s: f32,
    /// Largest substep in s that would have kept the whole stiffness; infinite where there is none to keep.
    pub max_dt_s: f32,
    /// Share of the stiffness that was cut, 0 to 1.
    pub cut_fraction: f32,
    /// Inertia that the inertia field adds, as a share of the mass of the free particles.
    pub inertia_added: f32,
    /// Share of the hinge rigidity that is kept, 0 to 1; 1 without hinges. Hinges may use a quarter of what the step can carry.
    pub hinge_fraction: f32,
    /// Predicted strain of the most stretched structural spring (0.05 is 5 %), when the cloth hangs at rest from a whole edge or
    /// from the two corners of one: within 15 % of what will be measured, up to 0.2. 0 where the flags say that it is unknown;
    /// only taut_cloth_predict_stretch knows it.
    pub stretch: f32,
    /// What the largest strain never exceeds, in a cloth that started unstretched and whose pins do not move: at rest, and
    /// unless stretch is known on the way there too. Infinite where nothing bounds it.
    pub stretch_bound: f32,
    /// TAUT_BUDGET_ABOVE_RANGE and so on, or-ed.
    pub flags: u32,
}

/// Where something is in the world and how it is turned: a collider, the frame of a cloth.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Pose {
    /// Position in m: of a collider at most 1e6 from the cloth's origin along each axis, of a frame at most 1e12 in size.
    pub position_m: [f64; 3],
    /// Rotation as a quaternion x, y, z, w, 1e-3 to 1e3 long. Of a frame only its changes count (the local axes stay those of the
    /// world): 0, 0, 0, 1 is how the cloth was made.
    pub rotation: [f32; 4],
}

/// What a collider is made of. Comes from taut_collider_def_default(), then change what you need. Lengths are in m, in the
/// collider's own frame; fields that the shape does not use are not looked at.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct ColliderDef {
    /// Bytes of this structure. Set by taut_collider_def_default().
    pub size: u32,
    /// Shows that the definition came from taut_collider_def_default().
    pub cookie: u32,
    /// Where it is. Default 0, 0, 0, not turned.
    pub pose: Pose,
    /// A taut_shape.
    pub shape: u32,
    /// Coefficient of Coulomb friction, 0 to 100. Default 0.3.
    pub friction: f32,
    /// Distance from the shape that the particles keep, in m, 0 to 1e3. Default 0.005.
    pub thickness_m: f32,
    /// Radius of the sphere, or of the capsule at its two ends, 1e-6 to 1e4. Default 0.1, 0.1.
    pub radius_m: [f32; 2],
    /// Ends of the capsule, at most 1e4 along each axis. Default (0, -0.1, 0) and (0, 0.1, 0).
    pub ends_m: [[f32; 3]; 2],
    /// Direction out of the half space, 1e-3 to 1e3 long. Default (0, 1, 0).
    pub normal: [f32; 3],
    /// Half the side lengths of the box, 1e-6 to 1e4. Default (0.1, 0.1, 0.1).
    pub half_m: [f32; 3],
    /// 0.
    pub reserved: u32,
}

/// The air around a cloth: drag and lift by the velocity of its cells relative to the wind. Comes from taut_air_default(),
/// then change what you need.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Air {
    /// Velocity of the wind in m/s, at most 1e3 in size. Default 0, 0, 0.
    pub wind_m_s: [f32; 3],
    /// Density in kg/m^3, 0 to 1e4; 0 = no air. Default 1.2.
    pub density_kg_m3: f32,
    /// Drag coefficient, 0 to 100: the drag of an area A at right angles to the flow is 0.5 density drag A speed^2. Default
    /// 1.2, that of a square plate.
    pub drag: f32,
    /// Lift coefficient, 0 to 100: the lift of an area A at the angle of attack a is 0.5 density lift A speed^2 sin(a) cos(a).
    /// Default 1.2.
    pub lift: f32,
    /// Gusts as a share of the wind's speed, 0 to 1: each component of the wind varies smoothly by up to so much. Default 0.
    pub gust: f32,
    /// How often a gust turns per second, 0 to 1e3. Default 1.
    pub gust_hz: f32,
    /// Which gusts: they are a function of the seed and the step index alone. Default 0.
    pub seed: u32,
}

/// What a baked field tells about its fabric beside the stiffness.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Fabric {
    /// Mass per area in kg/m^2.
    pub density_kg_m2: f32,
    /// Bending rigidity of a hinge in N m.
    pub hinge_rigidity_n_m: f32,
    /// Largest stretch of the fabric in use along the warp, as a fraction. To be strain limits with TAUT_FEATURE_LEVELS where
    /// cut_fraction of taut_cloth_budget is above 0.75; below, the field stretches like its fabric by itself, and limits hold
    /// it too tight.
    pub limit_warp: f32,
    /// The same along the weft.
    pub limit_weft: f32,
    /// The same along the diagonal.
    pub limit_diagonal: f32,
}

/// What a baked field is.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct FieldInfo {
    /// The seed it was generated with.
    pub seed: u64,
    /// Hash of the description it was generated from.
    pub description_hash: u64,
    /// Rows of the field. It need not be those of the grid: the field is resampled.
    pub rows: u32,
    /// Columns of the field.
    pub columns: u32,
    /// What it tells about the fabric.
    pub fabric: Fabric,
    /// 0.
    pub reserved: u32,
}

/// Strain of the structural springs: (length - rest length) / rest length, so 0.05 is stretched by 5 %.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Strain {
    /// Largest over all structural springs.
    pub largest: f32,
    /// Mean over all structural springs.
    pub mean: f32,
}

/// The positions of a cloth without a copy: particle (row, column) is number row * row_stride + column of x, y and z, in m
/// in the local frame; add origin_m for the world. Valid until the next call that is handed the cloth without const.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct PositionView {
    /// World position of the local frame in m.
    pub origin_m: [f64; 3],
    /// x of each particle in m.
    pub x: *const f32,
    /// y of each particle in m.
    pub y: *const f32,
    /// z of each particle in m.
    pub z: *const f32,
    /// Numbers from a row to the next; more than columns.
    pub row_stride: usize,
    /// Particles along v.
    pub rows: usize,
    /// Particles along u.
    pub columns: usize,
}

impl From<taut_core::baked::Fabric> for Fabric {
    fn from(f: taut_core::baked::Fabric) -> Fabric {
        let [limit_warp, limit_weft, limit_diagonal] = f.stretch_limits;
        Fabric {
            density_kg_m2: f.density_kg_m2,
            hinge_rigidity_n_m: f.hinge_rigidity_n_m,
            limit_warp,
            limit_weft,
            limit_diagonal,
        }
    }
}

impl From<taut_core::Pose> for Pose {
    fn from(p: taut_core::Pose) -> Pose {
        Pose { position_m: p.position_m.into(), rotation: p.rotation }
    }
}

impl From<Pose> for taut_core::Pose {
    fn from(p: Pose) -> taut_core::Pose {
        taut_core::Pose { position_m: p.position_m.into(), rotation: p.rotation }
    }
}

impl From<taut_core::BudgetReport> for BudgetReport {
    fn from(r: taut_core::BudgetReport) -> BudgetReport {
        BudgetReport {
            dt_s: r.dt_s,
            max_dt_s: r.max_dt_s,
            cut_fraction: r.cut_fraction,
            inertia_added: r.inertia_added,
            hinge_fraction: r.hinge_fraction,
            stretch: r.stretch,
            stretch_bound: r.stretch_bound,
            flags: r.flags.0,
        }
    }
}

impl From<taut_core::Air> for Air {
    fn from(a: taut_core::Air) -> Air {
        let taut_core::Air { wind_m_s, density_kg_m3, drag, lift, gust, gust_hz, seed } = a;
        Air { wind_m_s, density_kg_m3, drag, lift, gust, gust_hz, seed }
    }
}

impl From<Air> for taut_core::Air {
    fn from(a: Air) -> taut_core::Air {
        let Air { wind_m_s, density_kg_m3, drag, lift, gust, gust_hz, seed } = a;
        taut_core::Air { wind_m_s, density_kg_m3, drag, lift, gust, gust_hz, seed }
    }
}
