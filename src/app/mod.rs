//! The program: one executable that is launcher, island and monitor.
//!
//! `cli`, `settings`, `terrain_args` and `body_args` are what can be said. `run` is the launcher: it starts
//! a process for each island (`island`) and one that watches (`monitor`), tied to it by `parent_link`: they die with it,
//! and stop when it closes their standard input. `experiment` compares settings over many runs in this process. `verify`
//! looks whether a run's folder holds what it claims, `clean` removes what a killed launcher left; `evaluate`, `inspect`
//! and `replay` look at single `genomes` and bodies, `import` takes them in and `export` takes them elsewhere. `pedigree`
//! puts ancestries into words, and `viewer` opens a viewer. `console` prints and reads the clock, `table` lays out.
//! What a run is, [`crate::runs`] knows.
//!
//! Architecture invariant: this alone imports clap, prints, and reads a clock; no reading of the clock decides
//! a result.

mod body_args;
mod clean;
mod cli;
mod console;
mod evaluate;
mod experiment;
mod export;
mod genomes;
mod import;
mod inspect;
mod island;
mod monitor;
mod parent_link;
#[cfg(feature = "view")]
mod pedigree;
mod replay;
mod run;
mod settings;
mod table;
mod terrain_args;
mod verify;
#[cfg(feature = "view")]
mod viewer;

use cli::Command;
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
