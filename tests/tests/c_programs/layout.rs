//! Sizes, offsets, values, names and defaults in C are those in Rust.

use std::fmt::Write;
use std::mem::{offset_of, size_of};

use taut::{ClothDef, Error, Features, Grid, GridDef};

use crate::library::run_c;

/// The structures as the library has them. The library itself cannot be linked from Rust.
#[allow(dead_code, reason = "only the layout is looked at")]
#[path = "../../../ffi/src/types.rs"]
mod types;

#[allow(dead_code, reason = "only the layout is looked at")]
#[path = "../../../ffi/src/plan_types.rs"]
mod plan_types;

/// The static assertions about a structure.
macro_rules! structure {
    ($text:expr, $rust:ty, $c:literal, $($field:ident),+) => {{
        writeln!($text, "_Static_assert(sizeof({}) == {}, \"size of {}\");", $c, size_of::<$rust>(), $c).unwrap();
        let mut size = 0;
        $(
            let (c, field) = ($c, stringify!($field));
            writeln!($text, "_Static_assert(offsetof({c}, {field}) == {}, \"{c}.{field}\");", offset_of!($rust, $field))
                .unwrap();
            let field_size = size_of_field(|s: &$rust| &raw const s.$field);
            writeln!($text, "_Static_assert(sizeof((({c} *)0)->{field}) == {field_size}, \"{c}.{field}\");").unwrap();
            size += field_size;
        )+
        // padding would mean bytes that nobody sets; and a field that is not listed here would show as padding
        assert_eq!(size, size_of::<$rust>(), "{}", $c);
    }};
}

fn size_of_field<S, F>(_: impl Fn(&S) -> *const F) -> usize {
    size_of::<F>()
}

/// NotFinite becomes TAUT_ERROR_NOT_FINITE.
fn c_name(error: Error) -> String {
    let mut name = String::from("TAUT_ERROR");
    for letter in format!("{error:?}").chars() {
        if letter.is_ascii_uppercase() {
            name.push('_');
        }
        name.push(letter.to_ascii_uppercase());
    }
    name
}

#[test]
fn structures_and_values_are_those_of_rust() {
    let mut text = String::from(
        "#include <stdio.h>\n#include <string.h>\n#include \"taut.h\"\n\
         #define REQUIRE(c) do { if (!(c)) { printf(\"%s\\n\", #c); failed = 1; } } while (0)\n",
    );
    let t = &mut text;
    structure!(t, types::GridDef, "taut_grid_def", size, cookie, rows, columns, width_m, height_m, families);
    structure!(
        t,
        types::ClothDef,
        "taut_cloth_def",
        size,
        cookie,
        origin_m,
        rate_hz,
        substeps,
        density_kg_m2,
        damping_per_s,
        speed_limit,
        compression_limit,
        budget,
        inertia_radius_m,
        inertia_max,
        max_pins,
        solver,
        cg_iterations,
        tether_slack,
        strain_limit,
        strain_passes,
        hinge_rigidity_n_m,
        sleep_speed_m_s,
        features,
        gravity_m_s2,
        u_axis,
        v_axis,
        level_cycles
    );
    structure!(
        t,
        plan_types::PlanDef,
        "taut_plan_def",
        size,
        cookie,
        hold,
        tolerance,
        budget_ns,
        plain_ns,
        rate_hz,
        gravity_m_s2,
        density_kg_m2,
        stiffness_n_m
    );
    structure!(
        t,
        plan_types::Plan,
        "taut_settings",
        solver,
        substeps,
        cg_iterations,
        families,
        features,
        stiffness,
        inertia_radius_m,
        strain_limit,
        tether_slack,
        strain_passes,
        level_cycles,
        speed_limit,
        strain,
        frame_ns,
        meets
    );
    structure!(t, types::Memory, "taut_memory", size, align);
    structure!(t, types::Counts, "taut_counts", rows, columns, particles, springs);
    structure!(t, types::Bounds, "taut_bounds", low_m, high_m);
    structure!(
        t,
        types::BudgetReport,
        "taut_budget_report",
        dt_s,
        max_dt_s,
        cut_fraction,
        inertia_added,
        hinge_fraction,
        stretch,
        stretch_bound,
        flags
    );
    structure!(t, types::Pose, "taut_pose", position_m, rotation);
    structure!(
        t,
        types::ColliderDef,
        "taut_collider_def",
        size,
        cookie,
        pose,
        shape,
        friction,
        thickness_m,
        radius_m,
        ends_m,
        normal,
        half_m,
        reserved
    );
    structure!(t, types::Air, "taut_air", wind_m_s, density_kg_m3, drag, lift, gust, gust_hz, seed);
    structure!(
        t,
        types::Fabric,
        "taut_fabric",
        density_kg_m2,
        hinge_rigidity_n_m,
        limit_warp,
        limit_weft,
        limit_diagonal
    );
    structure!(t, types::FieldInfo, "taut_field", seed, description_hash, rows, columns, fabric, reserved);
    structure!(t, types::Strain, "taut_strain", largest, mean);
    structure!(t, types::PositionView, "taut_position_view", origin_m, x, y, z, row_stride, rows, columns);
    for error in Error::ALL {
        let name = c_name(error);
        writeln!(t, "_Static_assert({name} == {}, \"{name}\");", error.code()).unwrap();
    }
    for (name, value) in [
        ("TAUT_OK", 0),
        ("TAUT_ERROR_BAD_HANDLE", -100),
        ("TAUT_BUDGET_CERTIFIED", taut::Budget::Certified as i64),
        ("TAUT_BUDGET_TUNED", taut::Budget::Tuned as i64),
        ("TAUT_SOLVER_SYMPLECTIC_EULER", taut::Solver::SymplecticEuler as i64),
        ("TAUT_SOLVER_IMPLICIT_EULER", taut::Solver::ImplicitEuler as i64),
        ("TAUT_SOLVER_BDF2", taut::Solver::Bdf2 as i64),
        ("TAUT_HOLD_EDGE", taut::plan::Hold::Edge as i64),
        ("TAUT_HOLD_HOOKS", taut::plan::Hold::Hooks as i64),
        ("TAUT_HOLD_CORNERS", taut::plan::Hold::Corners as i64),
        ("TAUT_HOLD_CORNER", taut::plan::Hold::Corner as i64),
        ("TAUT_HOLD_LOOSE", taut::plan::Hold::Loose as i64),
        ("TAUT_HOLD_AREA", taut::plan::Hold::Area as i64),
        ("TAUT_STIFFNESS_STIFFEST", taut::plan::PlanStiffness::Stiffest as i64),
        ("TAUT_STIFFNESS_FABRIC", taut::plan::PlanStiffness::Fabric as i64),
        ("TAUT_SHAPE_SPHERE", types::ColliderShape::TAUT_SHAPE_SPHERE as i64),
        ("TAUT_SHAPE_CAPSULE", types::ColliderShape::TAUT_SHAPE_CAPSULE as i64),
        ("TAUT_SHAPE_PLANE", types::ColliderShape::TAUT_SHAPE_PLANE as i64),
        ("TAUT_SHAPE_BOX", types::ColliderShape::TAUT_SHAPE_BOX as i64),
        ("TAUT_FAMILY_STRUCTURAL", i64::from(taut::Families::STRUCTURAL.0)),
        ("TAUT_FAMILY_SHEAR", i64::from(taut::Families::SHEAR.0)),
        ("TAUT_FAMILY_BEND", i64::from(taut::Families::BEND.0)),
        ("TAUT_FAMILY_ALL", i64::from(taut::Families::ALL.0)),
        ("TAUT_FEATURE_NONE", i64::from(Features::NONE.0)),
        ("TAUT_FEATURE_PULL", i64::from(Features::PULL.0)),
        ("TAUT_FEATURE_AIR", i64::from(Features::AIR.0)),
        ("TAUT_FEATURE_HINGE", i64::from(Features::HINGE.0)),
        ("TAUT_FEATURE_TETHERS", i64::from(Features::TETHERS.0)),
        ("TAUT_FEATURE_STRAIN_LIMIT", i64::from(Features::STRAIN_LIMIT.0)),
        ("TAUT_FEATURE_LEVELS", i64::from(Features::LEVELS.0)),
        ("TAUT_FEATURE_COLLIDERS", i64::from(Features::COLLIDERS.0)),
        ("TAUT_FEATURE_TARGETS", i64::from(Features::TARGETS.0)),
        ("TAUT_FEATURE_MASS", i64::from(Features::MASS.0)),
        ("TAUT_FEATURE_MASK", i64::from(Features::MASK.0)),
        ("TAUT_FEATURE_IMPLICIT", i64::from(Features::IMPLICIT.0)),
        ("TAUT_MAX_COLLIDERS", taut::MAX_COLLIDERS as i64),
        ("TAUT_STEP_NON_FINITE", i64::from(taut::StepFlags::NON_FINITE.0)),
        ("TAUT_STEP_ASLEEP", i64::from(taut::StepFlags::ASLEEP.0)),
        ("TAUT_STEP_NON_FINITE_PIN", i64::from(taut::StepFlags::NON_FINITE_PIN.0)),
        ("TAUT_STEP_NON_FINITE_AIR", i64::from(taut::StepFlags::NON_FINITE_AIR.0)),
        ("TAUT_STEP_NON_FINITE_FORCE", i64::from(taut::StepFlags::NON_FINITE_FORCE.0)),
        ("TAUT_STEP_NON_FINITE_COLLIDER", i64::from(taut::StepFlags::NON_FINITE_COLLIDER.0)),
        ("TAUT_STEP_NON_FINITE_TARGET", i64::from(taut::StepFlags::NON_FINITE_TARGET.0)),
        ("TAUT_STEP_NON_FINITE_STATE", i64::from(taut::StepFlags::NON_FINITE_STATE.0)),
        ("TAUT_BUDGET_ABOVE_RANGE", i64::from(taut::BudgetFlags::ABOVE_RANGE.0)),
        ("TAUT_BUDGET_STRETCH_UNKNOWN", i64::from(taut::BudgetFlags::STRETCH_UNKNOWN.0)),
        ("TAUT_BUDGET_LIMIT_NOT_KEPT", i64::from(taut::BudgetFlags::LIMIT_NOT_KEPT.0)),
        ("TAUT_WIDTH_SCALAR", taut::Width::Scalar as i64),
        ("TAUT_WIDTH_SSE2", taut::Width::Sse2 as i64),
        ("TAUT_WIDTH_AVX2", taut::Width::Avx2 as i64),
        ("TAUT_WIDTH_AVX512", taut::Width::Avx512 as i64),
        ("TAUT_WIDTH_NEON", taut::Width::Neon as i64),
        ("TAUT_MAX_SIDE", i64::from(Grid::MAX_SIDE)),
        ("(sizeof(taut_result))", 4),
        ("(sizeof(taut_budget))", 4),
        ("(sizeof(taut_solver))", 4),
        ("(sizeof(taut_shape))", 4),
        ("(sizeof(taut_width))", 4),
        ("(sizeof(taut_hold))", 4),
        ("(sizeof(taut_stiffness))", 4),
    ] {
        writeln!(t, "_Static_assert({name} == {value}, \"{name}\");").unwrap();
    }

    t.push_str("int main(void)\n{\n    int failed = 0;\n");
    for error in Error::ALL {
        let (name, message) = (c_name(error), error.message());
        writeln!(t, "    REQUIRE(!strcmp(taut_result_name({name}), \"{name}\"));").unwrap();
        writeln!(t, "    REQUIRE(!strcmp(taut_result_message({name}), \"{message}\"));").unwrap();
    }
    t.push_str(
        "    REQUIRE(!strcmp(taut_result_name(TAUT_OK), \"TAUT_OK\"));\n\
         \x20   REQUIRE(!strcmp(taut_result_name(TAUT_ERROR_BAD_HANDLE), \"TAUT_ERROR_BAD_HANDLE\"));\n\
         \x20   REQUIRE(!strcmp(taut_result_name(1), \"TAUT_ERROR_UNKNOWN\"));\n\
         \x20   REQUIRE(!strcmp(taut_result_name(-2147483647 - 1), \"TAUT_ERROR_UNKNOWN\"));\n\
         \x20   REQUIRE(taut_result_message(-24)[0] != 0);\n",
    );
    writeln!(t, "    REQUIRE(taut_version() == TAUT_VERSION_ID);").unwrap();
    defaults(t);
    t.push_str("    return failed;\n}\n");
    assert_eq!(run_c(t, &[]), "");
}

/// The definitions start as those of core do.
fn defaults(t: &mut String) {
    let g = GridDef::default();
    writeln!(t, "    taut_grid_def g = taut_grid_def_default();").unwrap();
    writeln!(t, "    taut_plan_def p = taut_plan_def_default();").unwrap();
    let mut equal = |what: &str, value: f64| writeln!(t, "    REQUIRE({what} == {value:?}f);").unwrap();
    equal("(float)g.rows", g.rows.into());
    equal("(float)g.columns", g.columns.into());
    equal("g.width_m", g.width_m.into());
    equal("g.height_m", g.height_m.into());
    equal("(float)g.families", g.families.0.into());
    let p = taut::plan::PlanDef::default();
    equal("(float)p.hold", f64::from(p.hold as u32));
    equal("p.tolerance", p.tolerance.into());
    equal("p.plain_ns", p.plain_ns.into());
    equal("p.rate_hz", p.rate_hz.into());
    equal("p.gravity_m_s2", p.gravity_m_s2.into());
    equal("p.density_kg_m2", p.density_kg_m2.into());
    (0..4).for_each(|i| equal(&format!("p.stiffness_n_m[{i}]"), p.stiffness_n_per_m[i].into()));
    writeln!(t, "    REQUIRE(p.budget_ns > 1e38f);").unwrap();
    writeln!(t, "    taut_cloth_def d = taut_cloth_def_default(NULL);").unwrap();
    let d = ClothDef::default();
    let mut equal = |what: &str, value: f64| writeln!(t, "    REQUIRE({what} == (float){value:?});").unwrap();
    equal("d.rate_hz", d.rate_hz.into());
    equal("(float)d.substeps", d.substeps.into());
    equal("d.density_kg_m2", d.density_kg_m2.into());
    equal("d.damping_per_s", d.damping_per_s.into());
    equal("d.speed_limit", d.speed_limit.into());
    equal("(float)d.compression_limit", d.compression_limit.into());
    equal("(float)d.budget", f64::from(d.budget as u32));
    equal("d.inertia_radius_m", d.inertia_radius_m.into());
    equal("d.inertia_max", d.inertia_max.into());
    equal("(float)d.max_pins", d.max_pins.into());
    equal("(float)d.solver", f64::from(d.solver as u32));
    equal("(float)d.cg_iterations", d.cg_iterations.into());
    equal("(float)d.strain_passes", d.strain_passes.into());
    equal("(float)d.level_cycles", d.level_cycles.into());
    equal("d.hinge_rigidity_n_m", d.hinge_rigidity_n_m.into());
    equal("d.sleep_speed_m_s", d.sleep_speed_m_s.into());
    equal("(float)d.features", d.features.0.into());
    for i in 0..3 {
        equal(&format!("(float)d.origin_m[{i}]"), d.origin_m[i]);
        equal(&format!("d.tether_slack[{i}]"), d.tether_slack[i].into());
        equal(&format!("d.strain_limit[{i}]"), d.strain_limit[i].into());
        equal(&format!("d.gravity_m_s2[{i}]"), d.gravity_m_s2[i].into());
        equal(&format!("d.u_axis[{i}]"), d.u_axis[i].into());
        equal(&format!("d.v_axis[{i}]"), d.v_axis[i].into());
    }
}
