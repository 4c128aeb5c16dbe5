use taut_core::plan::plan;

use crate::plan_types::{Plan, PlanDef};
use crate::pointer::{Out, value};
use crate::result::{Code, answer};
use crate::types::{ClothDef, GridDef};
use crate::{cloth, grid};

const COOKIE: u32 = 0x6e61_6c70;

/// The default plan: two far corners of a light woven, 5 % at rest, 60 frames per second, any time.
///
/// Threads: any.
#[unsafe(no_mangle)]
pub extern "C" fn taut_plan_def_default() -> PlanDef {
    let d = taut_core::plan::PlanDef::default();
    PlanDef {
        size: size_of::<PlanDef>() as u32,
        cookie: COOKIE,
        hold: d.hold as u32,
        tolerance: d.tolerance,
        budget_ns: d.budget_ns,
        plain_ns: d.plain_ns,
        rate_hz: d.rate_hz,
        gravity_m_s2: d.gravity_m_s2,
        density_kg_m2: d.density_kg_m2,
        stiffness_n_m: d.stiffness_n_per_m,
    }
}

/// The settings that a scene on a grid requires: the cheapest that meet the tolerance within the time, or, where none do, those
/// of the least strain that fit the time. They come from a table of measured rows; nothing is simulated.
///
/// Errors: those of taut_grid_memory, TAUT_ERROR_NOT_FINITE, TAUT_ERROR_NEGATIVE, TAUT_ERROR_OUT_OF_RANGE,
/// TAUT_ERROR_STEP_SIZE (the rate), TAUT_ERROR_NO_PLAN: not even the cheapest fit the time.
/// Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_plan(on: *const GridDef, def: *const PlanDef, out: *mut Plan) -> Code {
    answer(|| {
        // SAFETY: the caller lends two definitions and a place for the answer; definitions are plain numbers.
        let (on, d, out) = unsafe { (grid::checked(on)?, value(def)?, Out::new(out)?) };
        if d.size as usize != size_of::<PlanDef>() || d.cookie != COOKIE {
            return Err(Code::TAUT_ERROR_BAD_DEFINITION);
        }
        let hold = taut_core::plan::Hold::ALL
            .into_iter()
            .find(|h| *h as u32 == d.hold)
            .ok_or(Code::TAUT_ERROR_OUT_OF_RANGE)?;
        let p = plan(
            &on,
            &taut_core::plan::PlanDef {
                hold,
                stiffness_n_per_m: d.stiffness_n_m,
                density_kg_m2: d.density_kg_m2,
                rate_hz: d.rate_hz,
                gravity_m_s2: d.gravity_m_s2,
                tolerance: d.tolerance,
                budget_ns: d.budget_ns,
                plain_ns: d.plain_ns,
            },
        )?;
        let fitted = p.fit(&taut_core::ClothDef::default());
        out.set(Plan {
            solver: p.solver as u32,
            substeps: p.substeps,
            cg_iterations: p.cg_iterations,
            families: p.families.0,
            features: p.features.0,
            stiffness: p.stiffness as u32,
            inertia_radius_m: p.inertia_radius_m,
            strain_limit: fitted.strain_limit[0],
            tether_slack: fitted.tether_slack[0],
            strain_passes: fitted.strain_passes,
            level_cycles: fitted.level_cycles,
            speed_limit: fitted.speed_limit,
            strain: p.strain,
            frame_ns: p.frame_ns,
            meets: p.meets.into(),
        });
        Ok(())
    })
}

/// Writes settings into the definitions of a grid and of a cloth: families, solver, substeps, iterations, inertia, limits and
/// speed limit, and their features beside those that are there. Every other field stays. The stiffness is not part of a
/// definition: after taut_cloth_create() call taut_cloth_set_stiffness_uniform() with 1e8 four times for
/// TAUT_STIFFNESS_STIFFEST, with the fabric's own for TAUT_STIFFNESS_FABRIC.
///
/// Errors: those of taut_grid_memory, and those of taut_cloth_memory for the definitions as they would be; then nothing is
/// changed.
/// Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_plan_apply(settings: *const Plan, on: *mut GridDef, def: *mut ClothDef) -> Code {
    answer(|| {
        // SAFETY: the caller lends settings and two definitions, which are plain numbers and are written to.
        let (p, g, d, to_grid, to_cloth) =
            unsafe { (*value(settings)?, *value(on)?, *value(def)?, Out::new(on)?, Out::new(def)?) };
        let new_grid = GridDef { families: p.families, ..g };
        let new_cloth = ClothDef {
            solver: p.solver,
            substeps: p.substeps,
            cg_iterations: p.cg_iterations,
            features: d.features | p.features,
            inertia_radius_m: p.inertia_radius_m,
            strain_limit: [p.strain_limit; 3],
            tether_slack: [p.tether_slack; 3],
            strain_passes: p.strain_passes,
            level_cycles: p.level_cycles,
            speed_limit: p.speed_limit,
            ..d
        };
        taut_core::Cloth::memory(&grid::check(&new_grid)?, &cloth::check(&new_cloth)?)?;
        to_grid.set(new_grid);
        to_cloth.set(new_cloth);
        Ok(())
    })
}
