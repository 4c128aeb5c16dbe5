//! The program `taut`: fabric in words, corrected cloth out.
//!
//! `taut drape` simulates one scene with seven ways to choose the stiffness and shows them side by side,
//! `taut correct` writes a stiffness field for a game to load, `taut plan` tells which settings a scene requires, `taut measure`
//! measures what settings cost and how wrong they are, `taut info` tells what a generator file is.
//!
//! Everything that a user can get wrong ends with one line on stderr, `taut: ...`, and exit code 2.
#![forbid(unsafe_code)]

mod args;
mod colour;
mod correct;
mod drape;
mod failure;
mod film;
mod gallery;
mod info;
mod measure;
mod model;
mod notes;
mod numbers;
mod output;
mod picture;
mod plan;
mod progress;
mod report;
mod table;

use std::process::ExitCode;

use clap::Parser;

use crate::args::{Cli, Command};
use crate::failure::Failure;

fn run() -> Result<(), Failure> {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(e) => return args::answer(&e),
    };
    match &cli.command {
        Command::Drape(args) => drape::run(args),
        Command::Film(args) => film::run(args),
        Command::Gallery(args) => gallery::run(args),
        Command::Correct(args) => correct::run(args),
        Command::Plan(args) => plan::run(args),
        Command::Info(args) => info::run(args),
        Command::Measure(what) => measure::run(what),
    }
}

fn main() -> ExitCode {
    failure::quiet_panics();
    output::clean_up_on_interrupt();
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.report(),
    }
}
