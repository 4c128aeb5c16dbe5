//! Draws a sheet of seven cloths: `cargo run -p taut-lab --example sheet -- OUT.png [hang2|hang1]`.
//!
//! The cloths come from a few lines of explicit springs right here, so that the picture can be worked on by itself.

use std::path::Path;
use std::process::ExitCode;

use taut_lab::picture::{Grid, Panel, PictureError, Sheet};

const SIDE: usize = 32;
const FRAMES: usize = 300;

/// A square metre of cloth after five seconds; `strength` is the structural stiffness over the particle mass, 1/s^2,
/// `shear` and `bend` are shares of it.
fn hang(pins: &[usize], strength: f32, shear: f32, bend: f32) -> Vec<[f32; 3]> {
    let rest = 1.0 / (SIDE - 1) as f32;
    let dt = 1.0 / (60.0 * 64.0);
    let mut position: Vec<[f32; 3]> = (0..SIDE * SIDE)
        .map(|i| {
            let (row, column) = ((i / SIDE) as f32, (i % SIDE) as f32);
            // A slight wave, so that folds have a side to fall to.
            let wave = 0.02 * (column * 0.55).sin() + 0.012 * (row * 0.4 + column * 0.2).cos();
            [column * rest - 0.5, -row * rest * 0.3, row * rest * 0.95 + wave - 0.2]
        })
        .collect();
    let mut velocity = vec![[0.0f32; 3]; SIDE * SIDE];
    let families = [(0, 1, 1.0), (1, 0, 1.0), (1, 1, shear), (1, -1, shear), (0, 2, bend), (2, 0, bend)];
    for _ in 0..FRAMES * 64 {
        let mut force = vec![[0.0f32, -9.81, 0.0]; SIDE * SIDE];
        for (dr, dc, share) in families {
            let length = rest * ((dr * dr + dc * dc) as f32).sqrt();
            for row in 0..SIDE {
                for column in 0..SIDE {
                    let (r, c) = (row as i32 + dr, column as i32 + dc);
                    if r >= SIDE as i32 || c < 0 || c >= SIDE as i32 {
                        continue;
                    }
                    let (a, b) = (row * SIDE + column, r as usize * SIDE + c as usize);
                    let d: [f32; 3] = std::array::from_fn(|i| position[b][i] - position[a][i]);
                    let now = (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt().max(1e-9);
                    let pull = strength * share * (now - length) / now;
                    for i in 0..3 {
                        force[a][i] += pull * d[i];
                        force[b][i] -= pull * d[i];
                    }
                }
            }
        }
        for i in 0..SIDE * SIDE {
            if pins.contains(&i) {
                continue;
            }
            for axis in 0..3 {
                velocity[i][axis] = (velocity[i][axis] + force[i][axis] * dt) * (1.0 - 1.2 * dt);
                position[i][axis] += velocity[i][axis] * dt;
            }
        }
    }
    position
}

fn sheet(scene: &str) -> Result<Sheet, PictureError> {
    let cap = (60.0f32 * 64.0).powi(2);
    let settings = [
        ("reference", 0.55, 0.30, 0.010),
        ("random K", 0.004, 0.50, 0.200),
        ("uniform K", 0.030, 0.60, 0.100),
        ("analytic K", 0.022, 0.35, 0.020),
        ("uniform K + inertia", 0.120, 0.60, 0.100),
        ("analytic K + inertia", 0.200, 0.30, 0.020),
        ("generated K", 0.400, 0.20, 0.003),
    ];
    let pins: &[usize] = if scene == "hang1" { &[0] } else { &[0, SIDE - 1] };
    let mut sheet = Sheet::new("picture example")
        .subtitle(format!("{scene}, {SIDE} x {SIDE}, 1 m x 1 m, after 5 s"))
        .outline_of(0)
        .footer("Stand-in data from the picture example: the springs are chosen by hand, no fabric was measured.");
    for (name, strength, shear, bend) in settings {
        let grid = Grid::new(&hang(pins, strength * cap, shear, bend), SIDE, SIDE, 1.0, 1.0)?.with_pins(pins)?;
        let mut strains: Vec<f32> = (0..SIDE * (SIDE - 1))
            .flat_map(|i| {
                [grid.strain_u(i / (SIDE - 1), i % (SIDE - 1)), grid.strain_v(i % (SIDE - 1), i / (SIDE - 1))]
            })
            .collect();
        strains.sort_by(f32::total_cmp);
        let percent = |quantile: f32| strains[((strains.len() - 1) as f32 * quantile) as usize] * 100.0;
        let line = format!("max {:.1} %  p99 {:.1} %", percent(1.0), percent(0.99));
        sheet = sheet.panel(Panel::new(name, grid).line(line));
    }
    Ok(sheet)
}

fn main() -> ExitCode {
    let path = std::env::args().nth(1).unwrap_or_else(|| "sheet.png".to_owned());
    let scene = std::env::args().nth(2).unwrap_or_else(|| "hang2".to_owned());
    match sheet(&scene).and_then(|sheet| sheet.save(Path::new(&path))) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(2)
        }
    }
}
