//! Writes a generator file made of made-up parts and what burn answers to a few inputs, for `tests/onnx_parity.py`:
//! `cargo run -p taut-train --example export_parity -- FOLDER`.

use std::error::Error;
use std::path::PathBuf;
use std::process::ExitCode;

use taut_train::export::{ExportMeta, export, fixture, run_rounded};

/// Rows of the word table, as many as a real file has.
const WORDS: usize = 3000;

fn write(folder: PathBuf) -> Result<(), Box<dyn Error>> {
    std::fs::create_dir_all(&folder)?;
    let generator = fixture::seasoned_generator(16, 1, 6)?;
    let words = fixture::word_table(WORDS, 2);
    let meta = ExportMeta { model_name: "parity".into(), ..Default::default() };
    let bytes = export(&generator, &words, &meta)?;
    std::fs::write(folder.join("generator.onnx"), &bytes)?;
    println!("generator.onnx: {} bytes", bytes.len());
    for (name, batch) in [("sample_1.json", 1), ("sample_5.json", 5)] {
        let sample = run_rounded(&generator, &words, &fixture::input(batch, WORDS, batch as u64))?;
        std::fs::write(folder.join(name), serde_json::to_vec(&sample)?)?;
        println!("{name}: batch of {batch}");
    }
    Ok(())
}

fn main() -> ExitCode {
    let Some(folder) = std::env::args_os().nth(1) else {
        eprintln!("usage: export_parity FOLDER");
        return ExitCode::from(2);
    };
    match write(folder.into()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(e) => {
            eprintln!("{e}");
            ExitCode::from(2)
        }
    }
}
