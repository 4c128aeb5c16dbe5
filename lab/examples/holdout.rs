//! The planner on grids, fabrics and scenes that its table was not made from: the share of picks that meet the tolerance, and
//! their cost beside the best row. `cargo run --release -p taut-lab --example holdout`

use taut_lab::front::{Bench, Row, Set, Spec};
use taut_lab::holdout::{judge, summary};
use taut_lab::scene::Scene;

/// Scenes that come to rest or are driven, where the tolerance is told for; cusick and the three fabrics are in no row of
/// the table, and neither are the two grids.
const SCENES: [Scene; 6] = [Scene::Hang2, Scene::Edge, Scene::Hang1, Scene::Curtain, Scene::Drape, Scene::Cusick];
const FABRICS: [&str; 3] = ["wool", "linen", "fleece"];
const SIDES: [u32; 2] = [24, 48];
const TOLERANCES: [f32; 4] = [0.01, 0.03, 0.06, 0.12];

fn main() -> Result<(), String> {
    let mut none = |_: &str, _: Scene, _: u32| -> Result<Vec<f32>, String> { Err("no generator".into()) };
    let mut bench = Bench::new(Set::Quick, &mut none);
    let cost = |_: &Spec, row: &Row| row.relative_cost;
    let mut all = Vec::new();
    println!("| row | tolerance % | told % | measured % | meets | cost | best | ratio | best row |");
    println!("|---|---|---|---|---|---|---|---|---|");
    for (i, scene) in SCENES.into_iter().enumerate() {
        for (j, side) in SIDES.into_iter().enumerate() {
            let fabric = FABRICS[(i + j) % FABRICS.len()];
            let verdicts =
                judge(&mut bench, (scene, fabric, side), &TOLERANCES, 2, &cost, &mut |row| eprintln!("{row}"))?;
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
