//! What the implicit solvers cost and lose, beside the explicit step at the physical stiffness and at equal cost: the tables
//! of docs/implicit.md. `cargo run --release -p taut-lab --example implicit [side] [damping]`
//!
//! Swing: let go from horizontal, the largest strain of 3.5 s, the kinetic energy in J/kg (mean of 2.5 to 3.5 s) and the rms
//! error of the centre of mass against the converged run. Rest: the largest strain after 8 s with damping 2 1/s.

use std::time::Duration;

use cpu_time::ThreadTime;
use taut::{Cloth, ClothDef, Features, Grid, GridDef, Solver, Vector3};
use taut_lab::block::Block;

const FRAMES: usize = 210;

#[derive(Clone, Copy, PartialEq)]
enum Scene {
    Corners,
    Edge,
}

struct Fabric {
    name: &'static str,
    k: [f32; 4],
    density: f32,
    /// Substeps at which the explicit step carries it whole, and those of the converged run.
    substeps: [u32; 2],
}

/// Two fabrics as warp, weft, shear, bend in N/m.
const FABRICS: [Fabric; 2] = [
    Fabric { name: "denim", k: [2028.0, 410.0, 107.0, 1.0], density: 0.324, substeps: [64, 192] },
    Fabric { name: "stiff woven", k: [3900.0, 3900.0, 60.0, 1.0], density: 0.2, substeps: [96, 288] },
];

struct Swing {
    peak: f32,
    energy: f64,
    heights: Vec<f64>,
    us_per_frame: f64,
}

fn with_cloth<T>(
    side: u32,
    def: &ClothDef,
    fabric: &Fabric,
    scene: Scene,
    work: impl FnOnce(&mut Cloth<'_>) -> T,
) -> T {
    let grid = Grid::new(&GridDef { rows: side, columns: side, ..GridDef::default() }).expect("a valid grid");
    let mut block = Block::new(Cloth::memory(&grid, def).expect("a valid definition"));
    let mut c = Cloth::create(&grid, def, block.numbers_mut()).expect("the block is large enough");
    c.set_stiffness_uniform(fabric.k).expect("a stiffness");
    let last = side as usize - 1;
    let pins = if scene == Scene::Edge { (0..=last).collect() } else { vec![0, last] };
    for p in pins {
        c.pin(p).expect("room for the pins");
    }
    work(&mut c)
}

fn swing(side: u32, def: &ClothDef, fabric: &Fabric, scene: Scene) -> Swing {
    let def = ClothDef { v_axis: [0.0, 0.0, 1.0], ..*def };
    with_cloth(side, &def, fabric, scene, |c| {
        let particles = c.grid().particles();
        let (mut peak, mut energy, mut heights, mut time) = (0.0f32, 0.0, Vec::new(), Duration::ZERO);
        for frame in 0..FRAMES {
            let start = ThreadTime::now();
            let flags = c.step().expect("a stiffness was set");
            time += start.elapsed();
            if flags.0 != 0 {
                peak = f32::INFINITY;
            }
            peak = peak.max(c.strain().largest);
            let y = |i| f64::from(c.position(i).expect("a particle").y);
            heights.push((0..particles).map(y).sum::<f64>() / particles as f64);
            if frame >= 150 {
                energy += c.kinetic_energy_j() / f64::from(fabric.density) / 60.0;
            }
        }
        Swing { peak, energy, heights, us_per_frame: time.as_secs_f64() * 1e6 / FRAMES as f64 }
    })
}

fn rest(side: u32, def: &ClothDef, fabric: &Fabric, scene: Scene) -> f32 {
    let def = ClothDef { damping_per_s: 2.0, ..*def };
    with_cloth(side, &def, fabric, scene, |c| {
        let pinned: Vec<usize> = c.pinned().collect();
        for i in (0..c.grid().particles()).filter(|i| !pinned.contains(i)) {
            let p = c.position(i).expect("a particle");
            let bump = 0.004 * (9.0 * p.x).sin() * (1.0 + p.y);
            c.set_position(i, p + Vector3::new(0.0, 0.0, bump)).expect("within reach");
        }
        for _ in 0..480 {
            c.step().expect("a stiffness was set");
        }
        c.strain().largest
    })
}

fn main() {
    let number = |i: usize, default: f32| {
        std::env::args().nth(i).map_or(default, |s| s.parse().expect("a number: side, then damping in 1/s"))
    };
    let (side, damping) = (number(1, 32.0) as u32, number(2, 0.5));
    for scene in [Scene::Corners, Scene::Edge] {
        for fabric in &FABRICS {
            let place = if scene == Scene::Edge { "one edge" } else { "two corners" };
            println!("\n{side} x {side}, {}, {place}, damping {damping} 1/s\n", fabric.name);
            println!("| solver | substeps x iterations | rest % | peak % | COM mm | energy J/kg | kept | us/frame |");
            println!("|---|---|---|---|---|---|---|---|");
            let base = ClothDef {
                density_kg_m2: fabric.density,
                speed_limit: 0.0,
                damping_per_s: damping,
                ..ClothDef::default()
            };
            let [whole, converged] = fabric.substeps.map(|s| s * side / 32);
            let truth = swing(side, &ClothDef { substeps: converged, ..base }, fabric, scene);
            let line = |name: &str, def: &ClothDef| {
                let s = swing(side, def, fabric, scene);
                let error = s.heights.iter().zip(&truth.heights).map(|(a, b)| (a - b).powi(2)).sum::<f64>();
                println!(
                    "| {name} | {} x {} | {:.2} | {:.2} | {:.0} | {:.3} | {:.2} | {:.0} |",
                    def.substeps,
                    if def.solver == Solver::SymplecticEuler {
                        "-".to_string()
                    } else {
                        format!("2 x {}", def.cg_iterations)
                    },
                    100.0 * rest(side, def, fabric, scene),
                    100.0 * s.peak,
                    1e3 * (error / FRAMES as f64).sqrt(),
                    s.energy,
                    s.energy / truth.energy,
                    s.us_per_frame
                );
            };
            line("explicit, converged", &ClothDef { substeps: converged, ..base });
            line("explicit, K as it is", &ClothDef { substeps: whole, ..base });
            let limited = ClothDef { speed_limit: 0.25, ..base };
            for substeps in [16, 32, 48] {
                line("explicit, K cut", &ClothDef { substeps, ..limited });
            }
            for (solver, name) in [(Solver::ImplicitEuler, "implicit Euler"), (Solver::Bdf2, "BDF2")] {
                for substeps in [1, 2, 4] {
                    for cg_iterations in [5, 10, 20, 40] {
                        let features = Features::IMPLICIT;
                        line(name, &ClothDef { solver, substeps, cg_iterations, features, ..base });
                    }
                }
            }
        }
    }
}
