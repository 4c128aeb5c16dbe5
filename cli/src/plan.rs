//! `taut plan`: which settings a scene requires, and why.

use serde::Serialize;
use taut::plan::{Hold, METHODS, Method, Plan, PlanDef, PlanStiffness, plan, plan_of};
use taut::{Families, Features, Grid, GridDef, Solver};
use taut_lab::distill::hold_of;
use taut_lab::fabric::Fabric;

use crate::args;
use crate::failure::{self, Failure};

/// Settings as JSON.
#[derive(Serialize)]
struct Settings {
    scene: &'static str,
    fabric: &'static str,
    grid: [u32; 2],
    rate_hz: f32,
    tolerance_pct: f32,
    meets_tolerance: bool,
    method: &'static str,
    solver: &'static str,
    substeps: u32,
    cg_iterations: Option<u32>,
    stiffness: &'static str,
    shear: bool,
    bend: bool,
    inertia_radius_m: f32,
    tether_slack: Option<f32>,
    strain_limit: Option<f32>,
    level_cycles: Option<u32>,
    strain_passes: Option<u32>,
    speed_limit: f32,
    stretch_pct: f32,
    us_per_frame: f32,
    why: Vec<String>,
}

/// Runs the command.
pub fn run(args: &args::Plan) -> Result<(), Failure> {
    let fabric = Fabric::named(&args.description).ok_or_else(|| {
        let words = failure::one_line(&args.description);
        Failure::new(format_args!("`{words}` names no fabric: try denim, jersey, silk, canvas, wool or felt"))
    })?;
    let grid = Grid::new(&GridDef {
        rows: args.grid.rows,
        columns: args.grid.columns,
        width_m: args.size.width_m,
        height_m: args.size.height_m,
        ..GridDef::default()
    })
    .map_err(Failure::new)?;
    let def = PlanDef {
        hold: hold_of(args.scene),
        stiffness_n_per_m: fabric.stiffness,
        density_kg_m2: fabric.density_kg_m2,
        rate_hz: args.rate,
        tolerance: args.tolerance / 100.0,
        budget_ns: args.budget_us.map_or(f32::INFINITY, |us| 1e3 * us),
        plain_ns: args.plain_ns,
        ..PlanDef::default()
    };
    let chosen = plan(&grid, &def).map_err(Failure::new)?;
    let others = METHODS
        .into_iter()
        .map(|m| Ok((m, plan_of(&grid, &def, m, None).map_err(Failure::new)?)))
        .collect::<Result<Vec<_>, Failure>>()?;
    let bend = chosen.families.contains(Families::BEND);
    let other_bend = plan_of(&grid, &def, method(&chosen), Some(!bend)).map_err(Failure::new)?;
    let has_levels = chosen.features.contains(Features::LEVELS);
    let settings = Settings {
        scene: args.scene.name(),
        fabric: fabric.kind,
        grid: [args.grid.rows, args.grid.columns],
        rate_hz: args.rate,
        tolerance_pct: args.tolerance,
        meets_tolerance: chosen.meets,
        method: name(method(&chosen)),
        solver: solver(chosen.solver),
        substeps: chosen.substeps,
        cg_iterations: (chosen.solver != Solver::SymplecticEuler).then_some(chosen.cg_iterations),
        stiffness: match chosen.stiffness {
            PlanStiffness::Stiffest => "stiffest",
            PlanStiffness::Fabric => "fabric",
        },
        shear: chosen.families.contains(Families::SHEAR),
        bend: chosen.families.contains(Families::BEND),
        inertia_radius_m: chosen.inertia_radius_m,
        tether_slack: chosen.features.contains(Features::TETHERS).then_some(0.0),
        strain_limit: has_levels.then_some(chosen.limit),
        level_cycles: has_levels.then_some(chosen.level_cycles),
        strain_passes: has_levels.then_some(chosen.strain_passes),
        speed_limit: chosen.speed_limit,
        stretch_pct: 100.0 * chosen.strain,
        us_per_frame: 1e-3 * chosen.frame_ns,
        why: why(args, &def, &chosen, &others, other_bend.as_ref()),
    };
    if args.json {
        return failure::print(&(serde_json::to_string_pretty(&settings).map_err(Failure::new)? + "\n"));
    }
    failure::print(&text(&settings))
}

fn solver(solver: Solver) -> &'static str {
    match solver {
        Solver::SymplecticEuler => "symplectic Euler",
        Solver::ImplicitEuler => "implicit Euler",
        Solver::Bdf2 => "BDF2",
    }
}

/// The method that a plan is of.
fn method(p: &Plan) -> Method {
    let has = |f| p.features.contains(f);
    match p.stiffness {
        PlanStiffness::Fabric if p.solver == Solver::SymplecticEuler => Method::Whole,
        PlanStiffness::Fabric => Method::Implicit,
        PlanStiffness::Stiffest if has(Features::LEVELS) && p.level_cycles > 0 => Method::OneCycle,
        PlanStiffness::Stiffest if has(Features::LEVELS) => Method::Levels,
        PlanStiffness::Stiffest if has(Features::TETHERS) => Method::Tethers,
        PlanStiffness::Stiffest if p.inertia_radius_m > 0.0 => Method::Inertia,
        PlanStiffness::Stiffest => Method::Plain,
    }
}

fn name(method: Method) -> &'static str {
    match method {
        Method::Plain => "springs alone",
        Method::Inertia => "the inertia field",
        Method::Tethers => "tethers",
        Method::Levels => "levels that keep a limit",
        Method::OneCycle => "one cycle through the levels",
        Method::Whole => "the fabric's own stiffness",
        Method::Implicit => "the implicit solver",
    }
}

/// Why a plan is as it is, a sentence for each choice.
fn why(
    args: &args::Plan,
    def: &PlanDef,
    chosen: &Plan,
    others: &[(Method, Option<Plan>)],
    other_bend: Option<&Plan>,
) -> Vec<String> {
    let pct = |x: f32| format!("{:.2} %", 100.0 * x);
    let us = |p: &Plan| format!("{:.0} us", 1e-3 * p.frame_ns);
    let mut why = Vec::new();
    let left = def.tolerance - chosen.strain;
    let about = args.scene.about();
    why.push(if chosen.meets {
        format!(
            "{} with {}: the scene ({about}) stretches by at most {} at rest, {} less than your tolerance, for {} a frame",
            substeps(chosen.substeps),
            name(method(chosen)),
            pct(chosen.strain),
            pct(left),
            us(chosen)
        )
    } else {
        format!(
            "nothing meets {} within your time: {} with {} is the best that fits, {} for {} a frame",
            pct(def.tolerance),
            substeps(chosen.substeps),
            name(method(chosen)),
            pct(chosen.strain),
            us(chosen)
        )
    });
    for (other, best) in others.iter().filter(|(m, _)| *m != method(chosen)) {
        let what = name(*other);
        why.push(match best {
            None if matches!(other, Method::Inertia | Method::Tethers) && def.hold == Hold::Loose => {
                format!("{what} off: there is no pin that it could act from, or it does not fit your time")
            }
            None => format!("{what} off: it does not fit your time, or was not measured at this tolerance"),
            Some(p) if p.meets => {
                let ratio = p.frame_ns / chosen.frame_ns;
                format!("{what} off: it needs {} and {ratio:.1} times the time", substeps(p.substeps))
            }
            Some(p) => format!("{what} off: it stretches by {} even with {}", pct(p.strain), substeps(p.substeps)),
        });
    }
    let bend = if chosen.families.contains(Families::BEND) {
        ["on", "without bend springs"]
    } else {
        ["off", "with bend springs"]
    };
    why.push(match other_bend {
        None => format!("bend {}: {} it does not fit your time", bend[0], bend[1]),
        Some(p) if !p.meets => {
            format!("bend {}: {} it stretches by {} even with {}", bend[0], bend[1], pct(p.strain), substeps(p.substeps))
        }
        Some(p) => format!(
            "bend {}: the scene ({about}) stretches {} less than your tolerance as it is; {} it needs {}, stretches by {} and takes {:.2} times the time",
            bend[0],
            pct(left),
            bend[1],
            substeps(p.substeps),
            pct(p.strain),
            p.frame_ns / chosen.frame_ns
        ),
    });
    why
}

fn substeps(n: u32) -> String {
    if n == 1 { "1 substep".into() } else { format!("{n} substeps") }
}

fn text(s: &Settings) -> String {
    let [rows, columns] = s.grid;
    let mut text = format!(
        "{}, {}, {rows} x {columns}, {} Hz, tolerance {} %\n\n  solver      {}\n  substeps    {}\n  stiffness   {}\n  families    structural{}{}\n",
        s.scene,
        s.fabric,
        s.rate_hz,
        s.tolerance_pct,
        s.solver,
        s.substeps,
        if s.stiffness == "fabric" { "the fabric's own" } else { "as stiff as the step carries" },
        if s.shear { ", shear" } else { "" },
        if s.bend { ", bend" } else { "" },
    );
    if let Some(iterations) = s.cg_iterations {
        text += &format!("  iterations  {iterations}\n");
    }
    if s.inertia_radius_m > 0.0 {
        text += &format!("  inertia     radius {} m\n", s.inertia_radius_m);
    }
    if s.tether_slack.is_some() {
        text += "  tethers     no slack\n";
    }
    match (s.strain_limit, s.level_cycles) {
        (Some(limit), Some(0)) => text += &format!("  levels      that keep {:.2} %\n", 100.0 * limit),
        (Some(limit), Some(cycles)) => {
            text += &format!(
                "  levels      {cycles} cycle a substep that aims at {:.0} % strain, passes over the cloth {}, speed limit {}\n",
                100.0 * limit,
                s.strain_passes.unwrap_or_default(),
                s.speed_limit
            );
        }
        _ => (),
    }
    text +=
        &format!("  stretch     {:.2} % at most\n  time        {:.0} us a frame\n\n", s.stretch_pct, s.us_per_frame);
    for line in &s.why {
        text += &format!("{line}.\n");
    }
    text
}
