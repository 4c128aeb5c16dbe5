//! What the parts of a cape cost (`taut_lab::fall::capes`): 16 x 24 particles on a walking character, with tethers, with two
//! capsules that it lies on, with the same far away, with both. Thread CPU time in ns per particle-step, parts taken in turn,
//! the least of each frame over the rounds, mean of the second half of the frames.
//!
//! `taskset -c 1 cargo run --release -p taut-lab --example cape_parts [width] [frames] [rounds]`

use cpu_time::ThreadTime;
use taut::{Cloth, ClothDef, ColliderDef, Error, Features, Grid, GridDef, Pose, Shape, Vector3, Width};
use taut_lab::block::Block;

const COLUMNS: u32 = 16;
const ROWS: u32 = 24;
const SUBSTEPS: u32 = 8;

/// Name, tethers, and how far behind the shoulders the capsules are in m.
type Part = (&'static str, bool, Option<f32>);

const PARTS: [Part; 5] = [
    ("plain", false, None),
    ("tethers", true, None),
    ("capsules far", false, Some(9.0)),
    ("capsules", false, Some(0.15)),
    ("both", true, Some(0.15)),
];

/// Walks the frames; the time of each step in ns goes to `least` where it is less.
fn walk((_, tethers, capsules): Part, width: Width, least: &mut [f64]) -> Result<(), Error> {
    let grid = Grid::new(&GridDef { rows: ROWS, columns: COLUMNS, width_m: 0.5, height_m: 1.1, ..GridDef::default() })?;
    let with = |on: bool, f: Features| if on { f.0 } else { 0 };
    let def = ClothDef {
        substeps: SUBSTEPS,
        features: Features(with(tethers, Features::TETHERS) | with(capsules.is_some(), Features::COLLIDERS)),
        max_pins: COLUMNS,
        u_axis: [0.0, 0.0, 1.0],
        origin_m: [0.0, 1.5, -0.25],
        ..ClothDef::default()
    };
    let mut block = Block::new(Cloth::memory(&grid, &def)?);
    let mut cloth = Cloth::create(&grid, &def, block.numbers_mut())?;
    cloth.set_width(width)?;
    cloth.set_stiffness_uniform([1e6, 1e6, 3e5, 2e4])?;
    for column in 0..COLUMNS as usize {
        cloth.pin(column)?;
    }
    let mut ids = Vec::new();
    if let Some(x) = capsules {
        for (ends_y, radii_m) in [([-0.5, -0.12], [0.14, 0.13]), ([-1.4, -0.6], [0.08, 0.13])] {
            let shape = Shape::Capsule { ends_m: ends_y.map(|y| [x, y, 0.0]), radii_m };
            ids.push(cloth.add_collider(&ColliderDef::new(shape, Pose::at(Vector3::new(0.0, 1.5, 0.0))))?);
        }
    }
    for (frame, least) in least.iter_mut().enumerate() {
        let time_s = (frame + 1) as f64 / 60.0;
        let step = std::f64::consts::TAU * 2.0 * time_s;
        let at = Vector3::new(1.5 * time_s, 1.5 + 0.03 * step.sin(), 0.05 * (0.5 * step).sin());
        for column in 0..COLUMNS as usize {
            let across = 0.5 * (column as f64 / f64::from(COLUMNS - 1) - 0.5);
            cloth.move_pin(column, at + Vector3::new(0.0, 0.0, across))?;
        }
        for id in &ids {
            cloth.move_collider(*id, &Pose::at(at))?;
        }
        let clock = ThreadTime::now();
        cloth.step()?;
        *least = least.min(clock.elapsed().as_nanos() as f64);
    }
    Ok(())
}

fn main() -> Result<(), Error> {
    let mut args = std::env::args().skip(1);
    let name = args.next().unwrap_or_else(|| Width::best().name().into());
    let width = Width::ALL.into_iter().find(|w| w.name() == name).unwrap_or(Width::best());
    let mut number = |or: usize| args.next().and_then(|a| a.parse().ok()).unwrap_or(or);
    let (frames, rounds) = (number(80).max(2), number(8));
    let mut least = PARTS.map(|_| vec![f64::INFINITY; frames]);
    for _ in 0..rounds {
        for (part, least) in PARTS.into_iter().zip(&mut least) {
            walk(part, width, least)?;
        }
    }
    for ((name, ..), least) in PARTS.iter().zip(&least) {
        let half = &least[frames / 2..];
        let ns = half.iter().sum::<f64>() / half.len() as f64 / f64::from(ROWS * COLUMNS * SUBSTEPS);
        println!("{} {name:12} {ns:6.2}", width.name());
    }
    Ok(())
}
