//! The program: one executable that is launcher, island and monitor.
//!
//! `cli`, `settings`, `problem_args` and `body_args` are what can be said, [`config`] the whole of a run in one struct.
//! [`catalogue`] alone knows every problem, and hands the one that is meant to whoever does something with it;
//! [`subject`] is what the program has to know of it. `run` is the launcher: it starts a process for each island
//! (`island`) and one that watches (`monitor`), tied to it by `parent_link`: they die with it, and stop when it closes
//! their standard input. What they wrote is gathered into a `result`, their `reports` into the metrics. `experiment`
//! compares settings over many runs in this process. `verify` looks whether a run's folder holds what it claims, `clean`
//! removes what a killed launcher left; `evaluate`, `inspect` and `replay` look at single `genomes` and bodies, `import` takes them in and `export`
//! takes them elsewhere; `seeds` are genomes that a run begins with, `terrains` what it stands on. `pedigree` puts
//! ancestries into words, and `viewer` opens a viewer. `console` prints and reads the clock, `table` lays out.
//!
//! Architecture invariant: this alone imports clap, prints, and reads a clock; no reading of the clock decides
//! a result.

mod body_args;
pub mod catalogue;
mod clean;
mod cli;
pub mod config;
mod console;
mod evaluate;
mod experiment;
mod export;
mod genomes;
mod import;
mod inspect;
mod island;
mod kept;
mod map_output;
mod monitor;
mod parent_link;
#[cfg(feature = "view")]
mod pedigree;
mod problem_args;
mod replay;
mod reports;
mod result;
mod run;
mod seeds;
mod settings;
pub mod subject;
mod table;
mod terrains;
mod verify;
#[cfg(feature = "view")]
mod viewer;

use crate::store::{RunDir, StoreError};
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

/// The exit code of a run that the user stopped.
const INTERRUPTED: u8 = 130;

/// Why the program ends without having done what it was asked for.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct Failure {
    /// One sentence that says what to do.
    pub message: String,
    /// The exit code.
    pub code: u8,
}

impl Failure {
    /// The user has to say something else.
    pub fn usage(message: impl Into<String>) -> Self {
        Self { message: message.into(), code: 2 }
    }

    /// In this folder is no run.
    pub fn no_run(dir: &RunDir) -> Self {
        let path = dir.path().display();
        Self::usage(format!(
            "there is no run in {path}: name the folder of one, such as runs/walk-seed7"
        ))
    }

    /// Something did not work.
    pub fn failed(message: impl Into<String>) -> Self {
        Self { message: message.into(), code: 1 }
    }

    /// The user stopped it.
    pub fn interrupted(message: impl Into<String>) -> Self {
        Self { message: message.into(), code: INTERRUPTED }
    }

    /// Whether the user stopped it.
    pub fn is_interruption(&self) -> bool {
        self.code == INTERRUPTED
    }
}

impl From<StoreError> for Failure {
    fn from(error: StoreError) -> Self {
        Self::failed(error.to_string())
    }
}

impl From<crate::transport::TransportError> for Failure {
    fn from(error: crate::transport::TransportError) -> Self {
        use crate::transport::TransportError::{
            NoSpace, TooManyEdges, TooManyFiles, TooManyMigrants,
        };
        match error {
            NoSpace { .. } | TooManyEdges { .. } | TooManyFiles { .. } | TooManyMigrants { .. } => {
                Self::usage(error.to_string())
            }
            _ => Self::failed(error.to_string()),
        }
    }
}

#[cfg(feature = "view")]
impl From<crate::view::ViewError> for Failure {
    fn from(error: crate::view::ViewError) -> Self {
        Self::failed(error.to_string())
    }
}
