//! Trains the word table or prints neighbours: `cargo run -p taut-train --example words -- --help`.

use clap::Parser;
use taut_train::words::command::{WordsCommand, run};

/// Word vectors for descriptions of fabrics
#[derive(Parser)]
struct Arguments {
    #[command(subcommand)]
    command: WordsCommand,
}

fn main() -> std::process::ExitCode {
    match run(&Arguments::parse().command) {
        Ok(()) => std::process::ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("words: {error}");
            std::process::ExitCode::from(2)
        }
    }
}
