//! The program: one executable that is launcher, island and monitor.
//!
//! `args` is what can be said. `commands` has a file or a folder for each verb, `processes` has those that make up a
//! run. Both use the rest: `genomes` reads those that are named, `ancestry_text` puts ancestries into words, `viewer` opens a
//! viewer, `console` prints and reads the clock, `table` lays out. What a run is, [`crate::runs`] knows.
//!
//! Architecture invariant: this alone imports clap, prints, and reads a clock; no reading of the clock decides
//! a result.

#[cfg(feature = "view")]
mod ancestry_text;
mod args;
mod commands;
mod console;
mod genomes;
mod processes;
mod table;
#[cfg(feature = "view")]
mod viewer;

use args::cli::{self, Command};
use commands::{clean, evaluate, experiment, export, import, inspect, replay, verify};
use processes::{island, monitor, run};
use std::process::ExitCode;

/// Parses the command line, does what it says and returns the program's exit code: 0, 1 if something failed,
/// 2 if the user has to say something else, 130 if the run was interrupted.
pub fn main() -> ExitCode {
    let cli = cli::parse();
    let done = match cli.command {
        None => run::run(&cli.run),
        Some(Command::Run(args)) => run::run(&args),
        Some(Command::Resume(args)) => run::resume(&args),
        Some(Command::Experiment(args)) => experiment::run(&args),
        Some(Command::Evaluate(args)) => evaluate::run(&args),
        Some(Command::Inspect(args)) => inspect::run(&args),
        Some(Command::Replay(args)) => replay::run(&args),
        Some(Command::Import(args)) => import::run(&args),
        Some(Command::Export(args)) => export::run(&args),
        Some(Command::Monitor(args)) => monitor::run(&args),
        Some(Command::Verify(args)) => verify::run(&args),
        Some(Command::Clean(args)) => clean::run(&args),
        Some(Command::Island(args)) => island::run(&args),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            console::say(&format!("error: {}", failure.message));
            ExitCode::from(failure.code)
        }
    }
}
