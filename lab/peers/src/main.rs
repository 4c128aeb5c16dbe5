//! `taut-peers ENGINE N SUBSTEPS ITERATIONS` lets a sheet fall in another engine and prints one line of JSON.
//! `taut-peers` alone prints the engines with their versions, a line each.

mod bullet;
mod rapier;
mod scene;

use std::process::ExitCode;

use scene::Engine;

const RAPIER_VERSION: &str = "0.36.1";

fn main() -> ExitCode {
    let args: Vec<String> = std::env::args().skip(1).collect();
    if args.is_empty() {
        println!("bullet {}\nrapier3d {RAPIER_VERSION}", env!("BULLET_VERSION"));
        return ExitCode::SUCCESS;
    }
    let numbers: Vec<u32> =
        args.iter().skip(1).filter_map(|a| a.parse().ok()).filter(|n| (1..=4096).contains(n)).collect();
    let (&[side, substeps, iterations], 4) = (&*numbers, args.len()) else {
        eprintln!("usage: taut-peers bullet|rapier3d N SUBSTEPS ITERATIONS");
        return ExitCode::from(2);
    };
    let n = side as usize;
    let mut engine: Box<dyn Engine> = match &*args[0] {
        "bullet" if side > 1 => Box::new(bullet::Bullet::new(n, substeps, iterations)),
        "rapier3d" if side > 1 => Box::new(rapier::Rapier::new(n, substeps, iterations)),
        _ => {
            eprintln!("usage: taut-peers bullet|rapier3d N SUBSTEPS ITERATIONS");
            return ExitCode::from(2);
        }
    };
    let result = scene::fall(&mut *engine, n);
    let setting = format!(r#""engine":"{}","n":{side},"substeps":{substeps},"iterations":{iterations}"#, args[0]);
    match result {
        None => println!("{{{setting},\"finite\":false}}"),
        Some(r) => println!(
            "{{{setting},\"finite\":true,\"cpu_ms_per_s\":{:.4},\"mean_pct\":{:.5},\"p99_pct\":{:.5},\"peak_pct\":{:.4},\
             \"height_m\":{:.5}}}",
            r.cpu_ms_per_s, r.mean_pct, r.p99_pct, r.peak_pct, r.height_m
        ),
    }
    ExitCode::SUCCESS
}
