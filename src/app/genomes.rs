//! Genome files that the user names.

use super::Failure;
use super::cli::TrialArgs;
use super::config::LINKS_MAX;
use super::console::say;
use crate::creature::Gene;
use crate::formats::genome_csv;
use crate::problems::Locomotion;
use crate::store::file;
use std::path::Path;

/// The largest file of a genome, in bytes: the longest genome that can be read, in the longest useful form.
const FILE_BYTES_MAX: usize = 64 << 20;
/// The most clamped values that are reported one by one.
const CLAMPED_SHOWN: usize = 20;

/// Reads a genome, and says so if values had to be clamped.
///
/// # Errors
/// One sentence that names the file and what to do.
pub fn read(path: &Path) -> Result<Vec<Gene>, Failure> {
    let wrong = |error: &dyn std::fmt::Display| {
        Failure::usage(format!("cannot use {}: {error}", path.display()))
    };
    let bytes = file::read(path, FILE_BYTES_MAX).map_err(|error| {
        wrong(&format!(
            "{}; name a file with a gene a line, such as a run's champion.csv",
            error.reason()
        ))
    })?;
    let read = genome_csv::read(bytes.as_slice()).map_err(|error| wrong(&error))?;
    for clamped in read.clamped.iter().take(CLAMPED_SHOWN) {
        say(&format!("warning: {}: {clamped}", path.display()));
    }
    if let more @ 1.. = read.clamped.len().saturating_sub(CLAMPED_SHOWN) {
        say(&format!("warning: {}: {more} more values are just under 1 now", path.display()));
    }
    Ok(read.genome)
}

/// The bound of a body, if it may be asked for: development goes as deep.
///
/// # Errors
/// One sentence that says what to change.
pub fn links_max(wish: usize) -> Result<usize, Failure> {
    let fine = (1..=LINKS_MAX).contains(&wish);
    let wrong = || Failure::usage(format!("max-links must be from 1 to {LINKS_MAX}, not {wish}"));
    fine.then_some(wish).ok_or_else(wrong)
}

impl TrialArgs {
    /// The problem that a genome is tried with.
    ///
    /// # Errors
    /// If more links are asked for than may be.
    pub fn problem(&self) -> Result<Locomotion, Failure> {
        let Self { task, profile, engine, max_links } = *self;
        let links_max = links_max(max_links)?;
        Ok(Locomotion { profile, task, engine, links_max, ..Locomotion::default() })
    }
}
