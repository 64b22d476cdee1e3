//! Genome files that the user names.

use super::Failure;
use super::cli::TrialArgs;
use super::console::say;
use crate::creature::Gene;
use crate::formats::genome_csv;
use crate::problems::Locomotion;
use std::fs::File;
use std::path::Path;

/// Reads a genome, and says so if values had to be clamped.
///
/// # Errors
/// One sentence that names the file and what to do.
pub fn read(path: &Path) -> Result<Vec<Gene>, Failure> {
    let wrong = |error: &dyn std::fmt::Display| {
        Failure::usage(format!("cannot use {}: {error}", path.display()))
    };
    let file = File::open(path).map_err(|error| {
        wrong(&format!("{error}; name a file with a gene a line, such as a run's champion.csv"))
    })?;
    let read = genome_csv::read(file).map_err(|error| wrong(&error))?;
    for clamped in &read.clamped {
        say(&format!("warning: {}: {clamped}", path.display()));
    }
    Ok(read.genome)
}

impl TrialArgs {
    /// The problem that a genome is tried with.
    pub fn problem(&self) -> Locomotion {
        let Self { task, profile, max_links } = *self;
        Locomotion { profile, task, genes: 1, links_max: max_links }
    }
}
