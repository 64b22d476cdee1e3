//! Genome and body files that the user names.

use super::body_args::ChangeArgs;
use super::cli::{ReadArgs, TrialArgs};
use super::console::say;
use super::table::harmless;
use crate::creature::{Creature, Gene, Profile, Reading, Scales};
use crate::formats::urdf::{self, ReadBody};
use crate::formats::{GenomeCsvError, ReadGenome, genome_csv, vector_csv};
use crate::problems::{Locomotion, RobustBy, Robustness};
use crate::runs::Failure;
use crate::runs::config::LINKS_MAX;
use crate::runs::genome_files::{FILE_BYTES_MAX, dropped};
use crate::store::file;
use std::fmt::Display;
use std::path::Path;

/// The most clamped values, and notes on a body, that are reported one by one.
const SHOWN: usize = 20;

/// What a file that the user names may be.
#[derive(Debug)]
pub enum Specimen {
    /// A genome.
    Genome(Vec<Gene>),
    /// A body.
    Body(Box<ReadBody>),
}

impl Specimen {
    /// Reads a file, and says what of it does not count or had to be changed.
    ///
    /// # Errors
    /// One sentence that names the file and what to do.
    pub fn read(path: &Path, changes: &ChangeArgs) -> Result<Self, Failure> {
        let dropped = dropped(&changes.drop_columns)?;
        let bytes = bytes(path)?;
        let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&bytes);
        if text.trim_ascii_start().first() == Some(&b'<') {
            return body(text, path).map(|body| Self::Body(Box::new(body)));
        }
        genome(&bytes, path, dropped).map(Self::Genome)
    }

    /// The creature that it is.
    ///
    /// # Errors
    /// One sentence that names the file and what is wrong.
    pub fn creature(
        &self,
        path: &Path,
        reading: Reading,
        links_max: usize,
    ) -> Result<Creature, Failure> {
        match self {
            Self::Body(body) => Ok(body.creature.clone()),
            Self::Genome(genome) => {
                crate::creature::express(genome, reading, links_max).map_err(|error| {
                    Failure::usage(format!("cannot build {}: {error}", path.display()))
                })
            }
        }
    }
}

/// Reads a genome; what could not be read is for the caller to say.
///
/// # Errors
/// What is wrong with it.
pub fn read_quietly(path: &Path, dropped: &[usize]) -> Result<ReadGenome, String> {
    let bytes = file::read(path, FILE_BYTES_MAX).map_err(|error| error.reason())?;
    let read = genome_csv::read_without(bytes.as_slice(), dropped);
    read.map_err(|error| reason(&bytes, &error))
}

fn bytes(path: &Path) -> Result<Vec<u8>, Failure> {
    file::read(path, FILE_BYTES_MAX).map_err(|error| {
        wrong(
            path,
            &format!(
                "{}; name a file with a gene a line, such as a run's champion.csv",
                error.reason()
            ),
        )
    })
}

fn wrong(path: &Path, error: &dyn Display) -> Failure {
    Failure::usage(format!("cannot use {}: {error}", path.display()))
}

/// Why some bytes are no creature's genome.
fn reason(bytes: &[u8], error: &GenomeCsvError) -> String {
    match vector_csv::is_ours(bytes) {
        true => "it is a genome of another problem, and describes no creature; islands evaluate takes it with the \
                 --problem that it is of"
            .to_owned(),
        false => error.to_string(),
    }
}

fn genome(bytes: &[u8], path: &Path, dropped: &[usize]) -> Result<Vec<Gene>, Failure> {
    let read = genome_csv::read_without(bytes, dropped)
        .map_err(|error| wrong(path, &reason(bytes, &error)))?;
    for clamped in read.clamped.iter().take(SHOWN) {
        say(&format!("warning: {}: {clamped}", path.display()));
    }
    if let more @ 1.. = read.clamped.len().saturating_sub(SHOWN) {
        say(&format!("warning: {}: {more} more values are just under 1 now", path.display()));
    }
    Ok(read.genome)
}

fn body(text: &[u8], path: &Path) -> Result<ReadBody, Failure> {
    if text.len() > urdf::BYTES_MAX {
        return Err(wrong(path, &format!("it is larger than {} bytes", urdf::BYTES_MAX)));
    }
    let text = str::from_utf8(text).map_err(|_| wrong(path, &"it is not UTF-8 text"))?;
    let body = urdf::read(text).map_err(|error| wrong(path, &error))?;
    for note in body.notes.iter().take(SHOWN) {
        say(&format!("warning: {}: {}", path.display(), harmless(note)));
    }
    Ok(body)
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

/// Perturbed trials, if there may be so many.
///
/// # Errors
/// One sentence that says what to change.
pub fn robustness(trials: u32, by: RobustBy) -> Result<Robustness, Failure> {
    let most = Robustness::TRIALS_MAX;
    let wrong = || Failure::usage(format!("robustness must be from 0 to {most}, not {trials}"));
    (trials <= most).then_some(Robustness { trials, by }).ok_or_else(wrong)
}

impl ReadArgs {
    /// What the numbers of a gene mean, if that makes sense.
    ///
    /// # Errors
    /// One sentence that says what to change.
    pub fn checked(&self) -> Result<Reading, Failure> {
        reading(self.profile, self.changes.scales())
    }
}

/// A profile with changed scales, if it has such.
///
/// # Errors
/// One sentence that says what to change.
pub fn reading(profile: Profile, scales: Scales) -> Result<Reading, Failure> {
    let fine = scales.check(profile);
    fine.map(|()| Reading { profile, scales }).map_err(|error| Failure::usage(error.to_string()))
}

impl TrialArgs {
    /// The problem that a genome is tried with.
    ///
    /// # Errors
    /// If more links or trials are asked for than may be, or scales that the profile has not, or the terrain cannot be
    /// used.
    pub fn problem(&self) -> Result<Locomotion, Failure> {
        let Self { task, read, engine, robustness: trials, robust_by, judged, max_links, terrain } =
            self;
        let robustness = robustness(*trials, *robust_by)?;
        let (links_max, reading) = (links_max(*max_links)?, read.checked()?);
        let Reading { profile, scales } = reading;
        Ok(Locomotion {
            profile,
            scales,
            task: *task,
            engine: *engine,
            links_max,
            robustness,
            judged: *judged,
            terrain: terrain.read()?,
            ..Locomotion::DEFAULT
        })
    }
}
