//! The program `taut-train`.

use std::process::ExitCode;

use clap::{Parser, Subcommand};
use taut_train::{data, evaluate, gan, own, reference, words};

/// Trains the generator of taut: words in, a stiffness field out.
#[derive(Debug, Parser)]
#[command(version, about)]
struct Program {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// From nothing to a generator file; goes on where an interrupted run of the same folder ended
    Run(gan::RunArgs),
    /// The figures of the paper's evaluation, and fabrics that no net has seen
    Evaluate(evaluate::EvaluateArgs),
    /// Pictures of cloth to learn from and to judge by: 7338 of 64 x 64
    Data(data::DataArgs),
    /// The constants of your own fabric from its tension tests, for a configuration of `run`
    Fabric(own::FabricArgs),
    /// The continuum cloth that stands in for ARCSim, beside its runs where there are some
    Reference(reference::command::ReferenceArgs),
    /// Word vectors
    #[command(subcommand)]
    Words(words::command::WordsCommand),
}

fn main() -> ExitCode {
    let result = match Program::parse().command {
        Command::Run(args) => {
            gan::run(&args).map_err(|e| (e.to_string(), matches!(e, gan::TrainError::Interrupted { .. })))
        }
        Command::Evaluate(args) => {
            evaluate::run(&args).map_err(|e| (e.to_string(), matches!(e, evaluate::EvaluateError::Interrupted)))
        }
        Command::Data(args) => data::run(&args).map_err(|e| (e.to_string(), matches!(e, data::DataError::Interrupted))),
        Command::Fabric(args) => own::run(&args).map_err(|e| (e.to_string(), false)),
        Command::Reference(args) => reference::command::run(&args)
            .map_err(|e| (e.to_string(), matches!(e, reference::command::CommandError::Interrupted))),
        Command::Words(command) => words::command::run(&command).map_err(|e| (e.to_string(), false)),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err((message, interrupted)) => {
            eprintln!("taut-train: {message}");
            ExitCode::from(if interrupted { 130 } else { 2 })
        }
    }
}
