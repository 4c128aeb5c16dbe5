//! `taut-peers ENGINE N SUBSTEPS ITERATIONS` lets a sheet fall in another engine and prints one line of JSON.
//! `taut-peers` alone prints the engines with their versions, a line each.

#[cfg(feature = "bullet")]
mod bullet;
#[cfg(feature = "rapier")]
mod rapier;
mod scene;

use std::process::ExitCode;

use scene::Engine;

/// The engines that were built in, with their versions.
const ENGINES: &[(&str, &str)] = &[
    #[cfg(feature = "bullet")]
    ("bullet", env!("BULLET_VERSION")),
    #[cfg(feature = "rapier")]
    ("rapier3d", "0.36.1"),
];

const USAGE: &str = "usage: taut-peers bullet|rapier3d N SUBSTEPS ITERATIONS";

fn main() -> ExitCode {
    let args: Vec<String> = std::env::args().skip(1).collect();
    if args.is_empty() {
        for (name, version) in ENGINES {
            println!("{name} {version}");
        }
        return ExitCode::SUCCESS;
    }
    let numbers: Vec<u32> =
        args.iter().skip(1).filter_map(|a| a.parse().ok()).filter(|n| (1..=4096).contains(n)).collect();
    let (&[side, substeps, iterations], 4, true) = (&*numbers, args.len(), numbers.first() > Some(&1)) else {
        eprintln!("{USAGE}");
        return ExitCode::from(2);
    };
    let n = side as usize;
    let mut engine: Box<dyn Engine> = match &*args[0] {
        #[cfg(feature = "bullet")]
        "bullet" => Box::new(bullet::Bullet::new(n, substeps, iterations)),
        #[cfg(feature = "rapier")]
        "rapier3d" => Box::new(rapier::Rapier::new(n, substeps, iterations)),
        _ => {
            eprintln!("{USAGE}; built with: {ENGINES:?}");
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
