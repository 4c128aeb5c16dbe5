//! From measured rows to the planner's table: `core/src/plan/table.rs`.
//!
//! The rows are in `lab/data/plan.csv`. The example `distill` measures them anew and writes both files; a test compares the
//! table with what [`table`] makes of the rows.

mod table;

use std::fmt::Write;

use taut::plan::{Hold, Method, PlanDef, plan_of};
use taut::{Families, Grid, GridDef, Solver};

use crate::compare::Limits;
use crate::fabric::Fabric;
use crate::front::{Correction, NO_BEND, Row, Spec};
use crate::scene::Scene;

pub use table::table;

/// The fabrics that the laws of K as it is are fitted to; the strains of a stiffest cloth are those of the first.
pub const FABRICS: [&str; 7] = ["denim", "polyester tablecloth", "cotton jersey", "rib knit", "silk", "canvas", "felt"];

/// Sides that strains are looked up between, half an octave of cells apart.
pub const SIDES: [u32; 7] = [16, 22, 32, 45, 64, 90, 128];

/// Sides that the laws of K as it is, of prices and of bend springs are fitted to.
const LAW_SIDES: [u32; 3] = [16, 32, 64];

/// Substeps with which bend springs are tried the other way.
const BEND_SUBSTEPS: [u32; 3] = [8, 16, 32];

/// The limits of the rows with levels.
pub(crate) const LIMITS: [f32; 3] = [0.02, 0.05, 0.1];

/// The scene that stands for a hold.
pub fn scene_of(hold: Hold) -> Scene {
    match hold {
        Hold::Edge => Scene::Edge,
        Hold::Hooks => Scene::Curtain,
        Hold::Corners => Scene::Hang2,
        Hold::Corner => Scene::Hang1,
        Hold::Loose => Scene::Drape,
        Hold::Area => Scene::Cusick,
    }
}

/// How a scene holds its sheet.
pub fn hold_of(scene: Scene) -> Hold {
    match scene {
        Scene::Edge | Scene::Swing | Scene::Flag => Hold::Edge,
        Scene::Curtain => Hold::Hooks,
        Scene::Hang2 => Hold::Corners,
        Scene::Hang1 => Hold::Corner,
        Scene::Drape => Hold::Loose,
        Scene::Cusick => Hold::Area,
    }
}

/// A row as the laws need it.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// The hold.
    pub hold: Hold,
    /// plain, inertia, tethers, one_cycle, levels, whole, implicit, or bend: plain with bend springs where the others have none, and without
    /// where they have.
    pub method: String,
    /// Particles of a side.
    pub side: u32,
    /// Substeps of a frame at 60 Hz.
    pub substeps: u32,
    /// The limit of levels; 0 of other methods.
    pub limit: f64,
    /// Warp, weft, shear in N/m and kg/m^2 of the fabric.
    pub fabric: [f64; 4],
    /// Largest structural strain late in the run.
    pub strain: f64,
    /// Cost of a substep in plain steps.
    pub cost: f64,
}

/// The rows that the table needs, with the name of their method.
pub fn list() -> Vec<(Hold, &'static str, Spec)> {
    let mut rows = Vec::new();
    for hold in Hold::ALL {
        let scene = scene_of(hold);
        for side in SIDES {
            rows.extend(methods(hold, scene, side, FABRICS[0]));
            if !LAW_SIDES.contains(&side) {
                continue;
            }
            for substeps in BEND_SUBSTEPS {
                let plain = families(hold, Spec::new(scene, FABRICS[0], side, Correction::Uniform));
                rows.push((hold, "bend", Spec { substeps, families: other(plain.families), ..plain }));
            }
            // where weight over stiffness is small for all of them, fewer tell as much
            let fabrics = if side == 64 { &FABRICS[..3] } else { &FABRICS[..] };
            for fabric in fabrics {
                rows.push((hold, "implicit", implicit(hold, scene, side, fabric)));
                rows.extend(whole(hold, scene, side, fabric).map(|spec| (hold, "whole", spec)));
            }
        }
    }
    rows
}

/// Whether the rows of a hold have bend springs: where a sheet lies on something they take a third to a half off its strain,
/// where it hangs a twentieth.
pub(crate) fn bends(hold: Hold) -> bool {
    matches!(hold, Hold::Loose | Hold::Area)
}

fn families(hold: Hold, spec: Spec) -> Spec {
    if bends(hold) { spec } else { Spec { families: NO_BEND, ..spec } }
}

/// The families with bend springs where they have none, and without where they have.
pub fn other(families: Families) -> Families {
    if families == NO_BEND { Families::ALL } else { NO_BEND }
}

/// The row of the implicit method of a scene.
pub fn implicit(hold: Hold, scene: Scene, side: u32, fabric: &'static str) -> Spec {
    let base = Spec::new(scene, fabric, side, Correction::Analytic);
    families(hold, Spec { solver: Solver::ImplicitEuler, substeps: 1, ..base })
}

/// The row of the fabric's own stiffness with the substeps that it needs; None where those are too many.
pub fn whole(hold: Hold, scene: Scene, side: u32, fabric: &'static str) -> Option<Spec> {
    let grid = Grid::new(&GridDef { rows: side, columns: side, ..GridDef::default() }).ok()?;
    let known = Fabric::named(fabric)?;
    let def = PlanDef {
        hold,
        stiffness_n_per_m: known.stiffness,
        density_kg_m2: known.density_kg_m2,
        tolerance: 1.0,
        ..PlanDef::default()
    };
    let plan = plan_of(&grid, &def, Method::Whole, Some(bends(hold))).ok()??;
    let base = Spec::new(scene, fabric, side, Correction::Analytic);
    Some(families(hold, Spec { substeps: plan.substeps, ..base }))
}

/// The rows of the explicit methods of a scene: substeps upwards.
pub fn methods(hold: Hold, scene: Scene, side: u32, fabric: &'static str) -> Vec<(Hold, &'static str, Spec)> {
    let new = |correction| families(hold, Spec::new(scene, fabric, side, correction));
    let mut rows = Vec::new();
    for substeps in [4, 8, 12, 16, 24, 32, 64, 128] {
        rows.push((hold, "plain", Spec { substeps, ..new(Correction::Uniform) }));
        if hold != Hold::Loose {
            rows.push((hold, "inertia", Spec { substeps, ..new(Correction::UniformInertia) }));
        }
    }
    if hold != Hold::Loose {
        for substeps in [2, 3, 4, 6, 8, 12, 16] {
            let base = new(Correction::Uniform);
            rows.push((hold, "tethers", Spec { substeps, limits: Limits::Tethers(0.0), ..base }));
        }
    }
    for substeps in [2, 3, 4, 6, 8, 12] {
        rows.push((hold, "one_cycle", Spec { substeps, limits: Limits::OneCycle(0.0), ..new(Correction::Uniform) }));
    }
    for limit in LIMITS {
        let base = new(Correction::Uniform);
        rows.push((hold, "levels", Spec { substeps: 2, limits: Limits::levels(limit), ..base }));
    }
    rows
}

/// What the laws need of a row. None where it blew up.
pub fn point(hold: Hold, method: &str, spec: &Spec, row: &Row) -> Option<Point> {
    let fabric = Fabric::named(spec.fabric)?;
    let [warp, weft, shear, _] = fabric.stiffness.map(f64::from);
    Some(Point {
        hold,
        method: method.into(),
        side: spec.side,
        substeps: spec.substeps,
        limit: if method == "levels" { f64::from(spec.limits.strain()?) } else { 0.0 },
        fabric: [warp, weft, shear, f64::from(fabric.density_kg_m2)],
        strain: row.stretch_max_pct? / 100.0,
        cost: row.cost_in_plain_steps,
    })
}

const HEADER: &str =
    "hold,method,side,substeps,limit,warp_n_per_m,weft_n_per_m,shear_n_per_m,density_kg_m2,strain,plain_steps";

/// The points as CSV, rounded as the table takes them.
pub fn csv(points: &[Point]) -> String {
    let mut text = format!("{HEADER}\n");
    for p in points {
        let [warp, weft, shear, density] = p.fabric;
        let _ = writeln!(
            text,
            "{:?},{},{},{},{:.2},{warp:.3},{weft:.3},{shear:.3},{density:.4},{:.6},{:.3}",
            p.hold, p.method, p.side, p.substeps, p.limit, p.strain, p.cost
        );
    }
    text
}

/// Reads what [`csv`] writes; None where it is something else.
pub fn read(text: &str) -> Option<Vec<Point>> {
    let mut lines = text.lines();
    if lines.next()? != HEADER {
        return None;
    }
    lines
        .map(|line| {
            let cells: Vec<&str> = line.split(',').collect();
            let number = |i: usize| cells.get(i)?.parse::<f64>().ok();
            Some(Point {
                hold: Hold::ALL.into_iter().find(|h| cells.first() == Some(&format!("{h:?}").as_str()))?,
                method: cells.get(1)?.to_string(),
                side: cells.get(2)?.parse().ok()?,
                substeps: cells.get(3)?.parse().ok()?,
                limit: number(4)?,
                fabric: [number(5)?, number(6)?, number(7)?, number(8)?],
                strain: number(9)?,
                cost: number(10)?,
            })
        })
        .collect()
}
