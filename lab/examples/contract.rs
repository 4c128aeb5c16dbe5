//! The contract "never more than eps", measured: the largest structural strain over every frame of each scene, what is left
//! at rest, how fast it still moves, and what it costs. `cargo run -p taut-lab --example contract`

use std::f32::consts::FRAC_1_SQRT_2;
use std::f64::consts::TAU;

use cpu_time::ThreadTime;
use taut::{Cloth, ClothDef, Features, Grid, GridDef, StepFlags, Vector3};

const SIDE: usize = 32;
const SECONDS: u32 = 8;
const SCENES: [&str; 10] = ["hang2", "edge", "swing", "curtain", "shake", "teleport", "hang1", "disc", "hole", "tear"];

/// What is left of the sheet in the scenes with a mask, which fall from level as hang2 does.
fn mask(scene: &str) -> Option<Vec<u8>> {
    let leaves: fn(f32, f32) -> bool = match scene {
        "disc" => |row, column| row.hypot(column) <= 15.5,
        "hole" => |row, column| row.hypot(column) > 6.0,
        "tear" => |row, column| row != 1.5 || column < -11.0,
        _ => return None,
    };
    Some((0..SIDE * SIDE).map(|i| u8::from(leaves((i / SIDE) as f32 - 15.5, (i % SIDE) as f32 - 15.5))).collect())
}

fn pins(scene: &str) -> Vec<usize> {
    match scene {
        "edge" | "swing" => (0..SIDE).collect(),
        "curtain" => (0..SIDE).step_by(4).chain([SIDE - 1]).collect(),
        "hang1" => vec![0],
        // on its rim, a quarter of a turn apart
        "disc" => vec![5 * SIDE + 5, 5 * SIDE + 26],
        _ => vec![0, SIDE - 1],
    }
}

/// Where the pins are at a time in s, from their start.
fn moved(scene: &str, time: f64) -> Vector3<f64> {
    match scene {
        "curtain" => Vector3::new(0.2 * (TAU * time).sin(), 0.0, 0.0),
        "shake" => Vector3::new(0.1 * (TAU * time).sin(), 0.1 * (TAU * time).cos() - 0.1, 0.0),
        "teleport" if time > 4.0 => Vector3::new(3.0, 1.0, -2.0),
        _ => Vector3::zeros(),
    }
}

/// Prints one line.
fn measure(scene: &str, def: &ClothDef, k: [f32; 4]) -> Result<(), taut::Error> {
    let mask = mask(scene);
    let level = mask.is_some() || matches!(scene, "hang2" | "swing");
    let features = Features(def.features.0 | if mask.is_some() { Features::MASK.0 } else { 0 });
    let v_axis = if level { [0.0, 0.0, 1.0] } else { [0.0, -1.0, 0.0] };
    let damping_per_s = if scene == "swing" { 0.0 } else { 2.0 };
    let def = ClothDef { v_axis, damping_per_s, features, ..*def };
    let grid = Grid::new(&GridDef { rows: SIDE as u32, columns: SIDE as u32, ..GridDef::default() })?;
    let mut block = vec![0.0; Cloth::memory(&grid, &def)?];
    let mut cloth = Cloth::create(&grid, &def, &mut block)?;
    cloth.set_stiffness_uniform(k)?;
    if let Some(mask) = mask {
        cloth.set_mask(&mask)?;
    }
    if !level {
        for i in 0..SIDE * SIDE {
            let (u, v) = ((i % SIDE) as f32 / 31.0, (i / SIDE) as f32 / 31.0);
            let bump =
                (9.4 * u).sin() + 0.6 * (15.7 * u + 1.0).cos() + 0.4 * (6.3 * u + 3.0 * v).sin() + (3.1 * u).sin();
            let [x, y] = if scene == "hang1" { [(u - v) * FRAC_1_SQRT_2, -(u + v) * FRAC_1_SQRT_2] } else { [u, -v] };
            cloth.set_position(i, Vector3::new(x, y, 0.004 * v * bump))?;
        }
    }
    let pins = pins(scene);
    let start =
        pins.iter().map(|p| cloth.pin(*p).and_then(|()| cloth.world_position(*p))).collect::<Result<Vec<_>, _>>()?;
    let (mut peak, mut jitter, mut cpu) = (0.0f32, 0.0f32, 0.0);
    for frame in 1..=60 * SECONDS {
        for (p, s) in pins.iter().zip(&start) {
            cloth.move_pin(*p, s + moved(scene, f64::from(frame) / 60.0))?;
        }
        let before = (0..SIDE * SIDE).map(|i| cloth.position(i)).collect::<Result<Vec<_>, _>>()?;
        let clock = ThreadTime::now();
        assert_eq!(cloth.step()?, StepFlags(0));
        cpu += clock.elapsed().as_secs_f64();
        peak = peak.max(cloth.strain().largest);
        if frame > 60 * (SECONDS - 1) {
            let ways = before.iter().enumerate().map(|(i, b)| cloth.position(i).map(|p| 60.0 * (p - b).norm()));
            jitter = jitter.max(ways.collect::<Result<Vec<_>, _>>()?.iter().sum::<f32>() / (SIDE * SIDE) as f32);
        }
    }
    let rest = taut_lab::metrics::stretch(&cloth);
    let steps = f64::from(60 * SECONDS * def.substeps) * (SIDE * SIDE) as f64;
    println!(
        "{scene:9} peak {:7.2} %   at the end max {:6.2} p99 {:5.2} mean {:5.2} %   still {:7.4} m/s   {:5.0} ns",
        100.0 * peak,
        rest.max,
        rest.p99,
        rest.mean,
        jitter,
        1e9 * cpu / steps
    );
    Ok(())
}

fn main() -> Result<(), taut::Error> {
    let fabrics =
        [("as stiff as can be", [1e8; 4]), ("denim", [1975.0, 356.0, 54.0, 1.0]), ("knit", [573.0, 59.0, 17.0, 1.0])];
    for (substeps, limit) in [(16, 0.10), (32, 0.05)] {
        for (fabric, k) in fabrics {
            for features in [Features::NONE, Features::TETHERS, Features::STRAIN_LIMIT, Features::LEVELS] {
                let limits = [limit; 3];
                let slack = if features == Features::TETHERS { [0.0; 3] } else { limits };
                println!("60 x {substeps}, {fabric}, {features:?}, limit {} %", 100.0 * limit);
                for scene in SCENES {
                    let def = ClothDef {
                        substeps,
                        features,
                        strain_limit: limits,
                        tether_slack: slack,
                        ..ClothDef::default()
                    };
                    measure(scene, &def, k)?;
                }
            }
        }
    }
    Ok(())
}
