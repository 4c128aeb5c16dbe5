//! What a substep costs in every vector width, beside what the core can do at best, as a table. Thread CPU time; the least
//! and the lower quartile of many short runs, since other programs on the machine only make a run longer.
//!
//! `taskset -c 1 cargo run --release -p taut-lab --example widths`

use taut::{Cloth, ClothDef, Families, Grid, GridDef, Width};
use taut_lab::block::Block;
use taut_lab::bound::Throughput;

/// Time of a cell of the table.
const RUN_MS: u128 = 700;

/// ns per particle-step: least and lower quartile.
fn measure(side: u32, families: Families, width: Width) -> (f64, f64) {
    let grid = Grid::new(&GridDef { rows: side, columns: side, families, ..GridDef::default() }).expect("a grid");
    let def = ClothDef::default();
    let mut memory = Block::new(Cloth::memory(&grid, &def).expect("a definition"));
    let block = memory.numbers_mut();
    let mut cloth = Cloth::create(&grid, &def, block).expect("the block is large enough");
    cloth.set_width(width).expect("it was asked for");
    cloth.set_stiffness_uniform([5000.0, 5000.0, 1500.0, 100.0]).expect("a stiffness");
    cloth.pin(0).expect("a pin");
    cloth.pin(side as usize - 1).expect("a pin");
    let steps = f64::from(side * side * def.substeps);
    let (begun, mut times) = (std::time::Instant::now(), Vec::new());
    while begun.elapsed().as_millis() < RUN_MS {
        let start = cpu_time::ThreadTime::now();
        cloth.step().expect("a stiffness was set");
        times.push(start.elapsed().as_nanos() as f64 / steps);
    }
    times.sort_by(f64::total_cmp);
    (times[0], times[times.len() / 4])
}

fn main() {
    const SIDES: [u32; 5] = [16, 32, 64, 128, 256];
    println!(
        "ns per particle-step (lower quartile of the runs), two pins, gravity, damping, limits, a field of springs"
    );
    println!("| width | bound gather | bound once | families | {} |", SIDES.map(|n| format!("N = {n}")).join(" | "));
    println!("|---|---|---|---|{}", "---|".repeat(SIDES.len()));
    for width in Width::ALL.into_iter().filter(|w| w.is_supported()) {
        for (name, families) in [("all", Families::ALL), ("structural", Families::STRUCTURAL)] {
            let bound = Throughput::measure(width);
            let times = SIDES.map(|side| measure(side, families, width));
            let cells = times.map(|(least, quartile)| format!("{least:.2} ({quartile:.2})")).join(" | ");
            let bounds = bound.map_or("- | -".into(), |b| format!("{:.2} | {:.2}", b.gather_ns(), b.once_ns()));
            println!("| {} | {bounds} | {name} | {cells} |", width.name());
        }
        if let Some(t) = Throughput::measure(width) {
            eprintln!(
                "{}: ns per number: sqrt {:.3}, div {:.3}, add or mul {:.3}; GB/s {:.1}",
                width.name(),
                t.sqrt_ns,
                t.div_ns,
                t.arithmetic_ns,
                1.0 / t.byte_ns
            );
        }
    }
}
