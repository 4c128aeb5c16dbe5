//! Renders a flat and a sagging sheet, each beside an augmented copy, and times the renderer.
//!
//! `cargo run -p taut-train --example pictures -- FILE.png`

use std::error::Error;
use std::num::NonZero;
use std::path::PathBuf;
use std::time::Instant;

use taut_train::image::{
    AugmentBatch, AugmentConfig, RenderConfig, Renderer, SheetLayout, available_threads, nmse, psnr, ssim, write_sheet,
};

const GRID: usize = 32;

/// A 1 m cloth, top left particle at the origin, whose upper border sags by `sag` metres between the upper corners.
fn sheet(sag: f32) -> Vec<f32> {
    let mut positions = Vec::new();
    for row in 0..GRID {
        for column in 0..GRID {
            let s = 2.0 * column as f32 / (GRID - 1) as f32 - 1.0;
            let v = row as f32 / (GRID - 1) as f32;
            let drop = sag * (1.0 - s * s) * (1.0 - v) * (1.0 - 0.6 * v);
            let depth = sag * v * (0.15 * (6.0 * s).cos() + 0.1 * (14.0 * s).sin());
            positions.extend([0.5 + 0.5 * s * (1.0 - 0.5 * sag * v), -(1.0 + 0.2 * sag) * v - drop, depth]);
        }
    }
    positions
}

fn main() -> Result<(), Box<dyn Error>> {
    let path = PathBuf::from(std::env::args().nth(1).ok_or("give the name of the PNG to write")?);
    let config = RenderConfig::default();
    let channels = config.channels.clone();
    let renderer = Renderer::new(config, GRID, GRID)?;
    let positions = [sheet(0.0), sheet(0.35)].concat();
    let images = renderer.render_batch(&positions, available_threads())?;
    let augmentations = AugmentBatch::draw(&AugmentConfig::default(), &channels, 7, 0, 2)?;
    let augmented = augmentations.apply(&images, available_threads())?;
    write_sheet(&path, &images, &augmented, SheetLayout { channels: channels.len(), pairs_per_row: 1, zoom: 4 })?;
    let (flat, sagging) = images.split_at(renderer.image_len());
    println!(
        "flat against sagging: PSNR {:.1} dB, SSIM {:.3}, NMSE {:.3}",
        psnr(flat, sagging)?,
        ssim(flat, sagging, 64, 64)?,
        nmse(flat, sagging)?
    );
    println!("wrote {}", path.display());

    let batch: Vec<f32> = (0..32).flat_map(|i| sheet(0.012 * i as f32)).collect();
    let gradient = vec![1.0; 32 * renderer.image_len()];
    for threads in [NonZero::<usize>::MIN, available_threads()] {
        let fastest = |work: &dyn Fn() -> bool| {
            let runs = (0..10).map(|_| {
                let start = Instant::now();
                assert!(work());
                start.elapsed().as_secs_f64() * 1e3 / 32.0
            });
            runs.fold(f64::INFINITY, f64::min)
        };
        let forward = fastest(&|| renderer.render_batch(&batch, threads).is_ok());
        let backward = fastest(&|| renderer.vjp_batch(&batch, &gradient, threads).is_ok());
        println!(
            "{GRID} x {GRID}, {threads} thread(s): forward {forward:.2} ms, backward {backward:.2} ms per picture"
        );
    }
    Ok(())
}
