//! Measures the planner's rows and writes `lab/data/plan.csv` and `core/src/plan/table.rs`.
//! `cargo run --release -p taut-lab --example distill [LEDGER.jsonl]`: with a ledger it can be interrupted and goes on. Without
//! any measuring, `cargo run -p taut-lab --example distill -- --table` writes the table of the rows that are there.

use std::error::Error;
use std::path::{Path, PathBuf};

use taut_lab::distill;
use taut_lab::front::{Bench, Row, Set, least, rounds};
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
        let specs: Vec<_> = list.iter().map(|(_, _, spec)| *spec).collect();
        let rows = rounds(&mut bench, &mut ledger, &specs, ROUNDS, &mut |round, i, key| {
            eprintln!("round {} of {ROUNDS}, {} of {}: {key}", round + 1, i + 1, specs.len());
        })?;
        // of all rows: what the machine does beside only adds
        let plain_ns =
            rows.iter().flatten().map(|r| r.ns_per_particle_step / r.cost_in_plain_steps).fold(f64::INFINITY, f64::min);
        let point = |((hold, method, spec), rows): (&(_, &str, _), &Vec<Row>)| {
            let least = least(rows)?;
            let row = Row { cost_in_plain_steps: least.ns_per_particle_step / plain_ns, ..least.clone() };
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
