//! The structures of the planner, as those of types.rs.

/// How a sheet is held: what decides where it stretches, and how fast that grows with its grid.
#[allow(non_camel_case_types, reason = "these are the names in C")]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum Hold {
    /// A whole edge is pinned: a banner, a flag, a cape along the shoulders.
    TAUT_HOLD_EDGE = 0,
    /// Points of an edge are pinned, at most a few cells apart: a curtain.
    TAUT_HOLD_HOOKS = 1,
    /// Two far corners are pinned.
    TAUT_HOLD_CORNERS = 2,
    /// One particle is pinned.
    TAUT_HOLD_CORNER = 3,
    /// Nothing is pinned: it lies on something.
    TAUT_HOLD_LOOSE = 4,
    /// An area in its middle is pinned, and the rest hangs over: a cloth clamped to a table.
    TAUT_HOLD_AREA = 5,
}

/// Where a planned stiffness comes from.
#[allow(non_camel_case_types, reason = "these are the names in C")]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum Stiffness {
    /// As stiff as the step carries: taut_cloth_set_stiffness_uniform with 1e8 N/m four times. It stretches less than the
    /// fabric.
    TAUT_STIFFNESS_STIFFEST = 0,
    /// The fabric's own.
    TAUT_STIFFNESS_FABRIC = 1,
}

/// What is to be planned. Comes from taut_plan_def_default(), then change what you need.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct PlanDef {
    /// Bytes of this structure. Set by taut_plan_def_default().
    pub size: u32,
    /// Shows that the definition came from taut_plan_def_default().
    pub cookie: u32,
    /// How the sheet is held, a taut_hold. Default TAUT_HOLD_CORNERS.
    pub hold: u32,
    /// Largest structural strain at rest, above 0, at most 1 (0.05 is 5 %). Default 0.05.
    pub tolerance: f32,
    /// CPU time of a frame in ns, above 0. Default infinite.
    pub budget_ns: f32,
    /// CPU time of a plain particle-step on this machine in ns, above 0, at most 1e6: the time of a taut_cloth_step of a cloth
    /// without features divided by its particles and substeps. Default 7.
    pub plain_ns: f32,
    /// Frames per second, 1 to 10,000. Default 60.
    pub rate_hz: f32,
    /// Size of gravity in m/s^2, above 0, at most 1e4. Default 9.81.
    pub gravity_m_s2: f32,
    /// Mass per area in kg/m^2, 1e-6 to 1e6. Default 0.2.
    pub density_kg_m2: f32,
    /// The fabric's warp, weft, shear and bend in N/m, each 0 to 1e9. Default 2000, 2000, 60, 1.
    pub stiffness_n_m: [f32; 4],
}

/// Settings that a scene requires, and what to expect of them. taut_plan_apply() writes them into the definitions.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Plan {
    /// The solver, a taut_solver.
    pub solver: u32,
    /// Substeps of a frame.
    pub substeps: u32,
    /// Iterations of an implicit solver.
    pub cg_iterations: u32,
    /// Spring families for the grid.
    pub families: u32,
    /// Features that the plan needs, to be or-ed with those that the scene needs.
    pub features: u32,
    /// Where the stiffness comes from, a taut_stiffness.
    pub stiffness: u32,
    /// Radius of the inertia field in m; 0 = none.
    pub inertia_radius_m: f32,
    /// For all three of strain_limit.
    pub strain_limit: f32,
    /// For all three of tether_slack.
    pub tether_slack: f32,
    /// Passes of the levels over the cloth itself in each cycle.
    pub strain_passes: u32,
    /// Cycles through the levels in each substep; 0 = until the limit is kept.
    pub level_cycles: u32,
    /// The speed limit in rest lengths a substep.
    pub speed_limit: f32,
    /// Largest structural strain to expect at rest, with a margin that nine of ten measured rows stay under.
    pub strain: f32,
    /// CPU time to expect of a frame in ns, with what such scenes mostly need beside: a collider and hinges where a sheet lies on
    /// something.
    pub frame_ns: f32,
    /// 1 where the strain is within the tolerance; 0 where these are the settings of the least strain that fit the time.
    pub meets: u32,
}

const _: () = {
    assert!(size_of::<PlanDef>() == 13 * 4 && size_of::<Plan>() == 15 * 4);
    assert!(Hold::TAUT_HOLD_EDGE as u32 == taut_core::plan::Hold::Edge as u32);
    assert!(Hold::TAUT_HOLD_HOOKS as u32 == taut_core::plan::Hold::Hooks as u32);
    assert!(Hold::TAUT_HOLD_CORNERS as u32 == taut_core::plan::Hold::Corners as u32);
    assert!(Hold::TAUT_HOLD_CORNER as u32 == taut_core::plan::Hold::Corner as u32);
    assert!(Hold::TAUT_HOLD_LOOSE as u32 == taut_core::plan::Hold::Loose as u32);
    assert!(Hold::TAUT_HOLD_AREA as u32 == taut_core::plan::Hold::Area as u32);
    assert!(Stiffness::TAUT_STIFFNESS_STIFFEST as u32 == taut_core::plan::PlanStiffness::Stiffest as u32);
    assert!(Stiffness::TAUT_STIFFNESS_FABRIC as u32 == taut_core::plan::PlanStiffness::Fabric as u32);
};
