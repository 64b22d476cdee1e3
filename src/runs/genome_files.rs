//! Files of genomes, of whichever problem.

use super::failure::Failure;
use super::subject::Subject;
use crate::store::file;
use std::path::Path;

/// The largest file of a genome, in bytes: the longest genome that can be read, in the longest useful form.
pub const FILE_BYTES_MAX: usize = 64 << 20;
/// The most columns that may be left out.
const DROPPED_MAX: usize = 64;

/// Reads a genome of any problem; what could not be read is for the caller to say.
///
/// # Errors
/// What is wrong with it.
pub fn read_for<P: Subject>(
    problem: &P,
    path: &Path,
    dropped: &[usize],
) -> Result<Vec<P::Gene>, String> {
    let bytes = file::read(path, FILE_BYTES_MAX).map_err(|error| error.reason())?;
    problem.read_genome(&bytes, dropped)
}

/// The columns to leave out of lines that have so many more than a gene has, if they can be.
///
/// # Errors
/// One sentence that says what to change.
pub fn dropped(columns: &[usize], of_a_gene: usize) -> Result<&[usize], Failure> {
    if of_a_gene == 0 && !columns.is_empty() {
        return Err(Failure::usage("--drop-column means nothing to this problem: leave it out"));
    }
    let most = of_a_gene + columns.len();
    let are_there = columns.iter().all(|column| (1..=most).contains(column));
    let twice = (1..columns.len()).any(|i| columns[..i].contains(&columns[i]));
    match columns.len() <= DROPPED_MAX && are_there && !twice {
        true => Ok(columns),
        false => Err(Failure::usage(format!(
            "--drop-column takes different columns from 1 to {most} of lines with {most}"
        ))),
    }
}
