//! The planner on grids, fabrics and scenes that its table was not made from: the share of picks that meet the tolerance, and
//! their cost beside the best row. `cargo run --release -p taut-lab --example holdout [LEDGER.jsonl]`: with a ledger it can be
//! interrupted and goes on (of this program: a newer one needs a new ledger), and another table is judged by the rows that are there. All rows of a scene are measured in three
//! rounds, of which the cheapest counts: what the machine does beside only adds. Costs are in ms of CPU a simulated second.

use std::path::PathBuf;

use taut_lab::front::{Bench, Row, Set, Spec, least, rounds};
use taut_lab::holdout::{judge, summary};
use taut_lab::ledger::Ledger;
use taut_lab::scene::Scene;

/// Scenes that come to rest or are driven, where the tolerance is told for; cusick and the three fabrics are in no row of
/// the table, and neither are the two grids.
const SCENES: [Scene; 6] = [Scene::Hang2, Scene::Edge, Scene::Hang1, Scene::Curtain, Scene::Drape, Scene::Cusick];
const FABRICS: [&str; 3] = ["wool", "linen", "fleece"];
const SIDES: [u32; 2] = [24, 48];
const TOLERANCES: [f32; 4] = [0.01, 0.03, 0.06, 0.12];

const ROUNDS: usize = 3;

fn main() -> Result<(), String> {
    let text = |e: &dyn std::fmt::Display| e.to_string();
    let path = std::env::args().nth(1).map_or_else(
        || {
            let path = std::env::temp_dir().join("taut-holdout.jsonl");
            // rows of another program would be judged
            let _ = std::fs::remove_file(&path);
            path
        },
        PathBuf::from,
    );
    let mut ledger: Ledger<Row> = Ledger::open(&path, &"holdout 3").map_err(|e| text(&e))?;
    let mut none = |_: &str, _: Scene, _: u32| -> Result<Vec<f32>, String> { Err("no generator".into()) };
    let mut bench = Bench::new(Set::Quick, &mut none);
    // the same machine for all rows of a scene: what a plain step takes beside would only add its own noise
    let cost = |_: &Spec, row: &Row| row.cpu_ms_per_simulated_s;
    let mut measure = |specs: &[Spec]| {
        let rows = rounds(&mut bench, &mut ledger, specs, ROUNDS, &mut |_, _, key| eprintln!("{key}"));
        let least = |rows: Vec<Row>| least(&rows).cloned();
        rows.map_err(|e| text(&e))?.into_iter().map(least).collect::<Option<Vec<Row>>>().ok_or_else(|| "no row".into())
    };
    let mut all = Vec::new();
    println!("| row | tolerance % | told % | measured % | meets | cost | best | ratio | best row |");
    println!("|---|---|---|---|---|---|---|---|---|");
    for (i, scene) in SCENES.into_iter().enumerate() {
        for (j, side) in SIDES.into_iter().enumerate() {
            let fabric = FABRICS[(i + j) % FABRICS.len()];
            let verdicts = judge((scene, fabric, side), &TOLERANCES, &mut measure, &cost)?;
            for v in &verdicts {
                println!(
                    "| {} | {:.1} | {:.2} | {:.2} | {} | {:.2} | {:.2} | {:.2} | {} |",
                    v.spec.key(),
                    100.0 * v.tolerance,
                    100.0 * v.told,
                    100.0 * v.strain,
                    if v.meets() { "yes" } else { "no" },
                    v.cost,
                    v.best.as_ref().map_or(f64::NAN, |b| b.0),
                    v.cost_ratio().unwrap_or(f64::NAN),
                    v.best.as_ref().map_or("none", |b| &b.1)
                );
            }
            all.extend(verdicts);
        }
    }
    let [kept, fair, dearest] = summary(&all);
    println!(
        "\n{} picks; {:.0} % of the promises kept; {:.0} % cost at most 1.3 times the best row, the dearest {dearest:.2} times",
        all.len(),
        100.0 * kept,
        100.0 * fair
    );
    Ok(())
}
