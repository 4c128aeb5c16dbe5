//! What each feature costs beside the plain step, in every vector width, as a table: thread CPU time in ns per
//! particle-step, loads of `taut measure features` in turn, the least over many rounds, since other programs on the machine
//! only make a frame longer; in brackets times the load that it is compared with.
//!
//! `taskset -c 1 cargo run --release -p taut-lab --example feature_cost [side] [rounds] [widths] [loads]`

use cpu_time::ThreadTime;
use taut::{Cloth, Width};
use taut_lab::block::Block;
use taut_lab::cost::Load;

fn main() -> Result<(), taut::Error> {
    let mut args = std::env::args().skip(1);
    let mut number = |or: u32| args.next().and_then(|a| a.parse().ok()).unwrap_or(or);
    let (side, rounds) = (number(64), number(100));
    let (names, loads) = (args.next().unwrap_or_else(|| "all".into()), args.next().unwrap_or_else(|| "all".into()));
    let is_in = |list: &str, name: &str| list == "all" || list.split(',').any(|n| n == name);
    for width in Width::ALL.into_iter().filter(|w| w.is_supported() && is_in(&names, w.name())) {
        let chosen: Vec<Load> = Load::ALL
            .into_iter()
            .filter(|l| matches!(l, Load::Plain | Load::NoBend) || is_in(&loads, l.name()))
            .collect();
        let mut cloths: Vec<Cloth<'static>> = Vec::new();
        for load in &chosen {
            cloths.push(load.create(side, width, Block::leaked(load.memory(side)?))?);
        }
        let mut least = vec![f64::INFINITY; cloths.len()];
        for _ in 0..rounds {
            for (cloth, least) in cloths.iter_mut().zip(&mut least) {
                let clock = ThreadTime::now();
                cloth.step()?;
                let steps = f64::from(side * side * cloth.def().substeps);
                *least = least.min(clock.elapsed().as_nanos() as f64 / steps);
            }
        }
        for (load, ns) in chosen.iter().zip(&least) {
            let other = chosen.iter().position(|l| *l == load.beside()).map_or(*ns, |i| least[i]);
            println!("{:8} {:18} {ns:8.2} ({:.2})", width.name(), load.name(), ns / other);
        }
    }
    Ok(())
}
