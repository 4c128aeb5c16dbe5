//! Measures the planner's rows and writes `lab/data/plan.csv` and `core/src/plan/table.rs`.
//! `cargo run --release -p taut-lab --example distill [LEDGER.jsonl]`: with a ledger it can be interrupted and goes on. Without
//! any measuring, `cargo run -p taut-lab --example distill -- --table` writes the table of the rows that are there.

use std::error::Error;
use std::path::{Path, PathBuf};

use taut_lab::distill;
use taut_lab::front::{Bench, Row, Set};
use taut_lab::ledger::Ledger;
use taut_lab::scene::Scene;

/// How often a row is measured.
const ROUNDS: usize = 2;

fn main() -> Result<(), Box<dyn Error>> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let data = root.join("data/plan.csv");
    let argument = std::env::args().nth(1);
    if argument.as_deref() != Some("--table") {
        let path = argument.map_or_else(|| std::env::temp_dir().join("taut-distill.jsonl"), PathBuf::from);
        let mut ledger: Ledger<Row> = Ledger::open(&path, &"distill 6")?;
        let mut none = |_: &str, _: Scene, _: u32| -> Result<Vec<f32>, String> { Err("no generator".into()) };
        let mut bench = Bench::new(Set::Quick, &mut none);
        let list = distill::list();
        let mut rows: Vec<Option<Row>> = vec![None; list.len()];
        // what the machine does beside only adds: the least of all rounds, and of the plain steps of all rows
        let mut plain_ns = f64::INFINITY;
        for round in 0..ROUNDS {
            for (i, ((_, _, spec), least)) in list.iter().zip(&mut rows).enumerate() {
                let key = format!("{round}/{}", spec.key());
                if ledger.get(&key).is_none() {
                    eprintln!("round {} of {ROUNDS}, {} of {}: {key}", round + 1, i + 1, list.len());
                    ledger.add(&key, bench.measure(spec)?)?;
                }
                let row = ledger.get(&key).ok_or("no row")?;
                plain_ns = plain_ns.min(row.ns_per_particle_step / row.cost_in_plain_steps);
                if least.as_ref().is_none_or(|l| row.ns_per_particle_step < l.ns_per_particle_step) {
                    *least = Some(row.clone());
                }
            }
        }
        let point = |((hold, method, spec), row): (&(_, &str, _), &Option<Row>)| {
            let mut row = row.clone()?;
            row.cost_in_plain_steps = row.ns_per_particle_step / plain_ns;
            distill::point(*hold, method, spec, &row)
        };
        let points: Vec<_> = list.iter().zip(&rows).filter_map(point).collect();
        std::fs::create_dir_all(root.join("data"))?;
        std::fs::write(&data, distill::csv(&points))?;
    }
    let points = distill::read(&std::fs::read_to_string(&data)?).ok_or("lab/data/plan.csv is no list of rows")?;
    std::fs::write(root.join("../core/src/plan/table.rs"), distill::table(&points))?;
    println!("{} rows", points.len());
    Ok(())
}
