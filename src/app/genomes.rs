//! Genome and body files that the user names.

use crate::app::args::body_args::ChangeArgs;
use crate::app::console::say;
use crate::app::table::harmless;
use crate::creature::{Creature, Encoding};
use crate::evolution::Gene;
use crate::formats::urdf::{self, ReadBody};
use crate::formats::{GenomeCsvError, ReadGenome, genome_csv, network_csv, vector_csv};
use crate::runs::Failure;
use crate::runs::genome_files::{FILE_BYTES_MAX, dropped};
use crate::store::file;
use std::fmt::Display;
use std::path::Path;

/// The most clamped values, and notes on a body, that are reported one by one.
const SHOWN: usize = 20;

/// What a file that the user names may be.
#[derive(Debug)]
pub enum Specimen<G> {
    /// A genome.
    Genome(Vec<G>),
    /// A body.
    Body(Box<ReadBody>),
}

impl<G: Gene> Specimen<G> {
    /// Reads a file, and says what of it does not count or had to be changed.
    ///
    /// # Errors
    /// One sentence that names the file and what to do.
    pub fn read(
        path: &Path,
        encoding: &impl Encoding<Gene = G>,
        changes: &ChangeArgs,
    ) -> Result<Self, Failure> {
        let dropped = dropped(&changes.drop_columns, encoding.columns().len())?;
        let bytes = bytes(path)?;
        let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&bytes);
        if text.trim_ascii_start().first() == Some(&b'<') {
            return body(text, path).map(|body| Self::Body(Box::new(body)));
        }
        genome(encoding, &bytes, path, dropped).map(Self::Genome)
    }

    /// The creature that it is.
    ///
    /// # Errors
    /// One sentence that names the file and what is wrong.
    pub fn creature(
        &self,
        path: &Path,
        encoding: &impl Encoding<Gene = G>,
    ) -> Result<Creature, Failure> {
        match self {
            Self::Body(body) => Ok(body.creature.clone()),
            Self::Genome(genome) => encoding.express(genome).map_err(|error| {
                Failure::usage(format!("cannot build {}: {error}", path.display()))
            }),
        }
    }
}

/// Reads a genome; what could not be read is for the caller to say.
///
/// # Errors
/// What is wrong with it.
pub fn read_quietly<E: Encoding>(
    encoding: &E,
    path: &Path,
    dropped: &[usize],
) -> Result<ReadGenome<E::Gene>, String> {
    let bytes = file::read(path, FILE_BYTES_MAX).map_err(|error| error.reason())?;
    let read = genome_csv::read_without(encoding, bytes.as_slice(), dropped);
    read.map_err(|error| reason(&bytes, &error))
}

/// What a file says of a network, if it is one.
///
/// # Errors
/// One sentence that names the file and what is wrong with it.
pub fn network(path: &Path) -> Result<Option<Vec<network_csv::Row>>, Failure> {
    let bytes = bytes(path)?;
    let rows = network_csv::is_ours(&bytes).then(|| network_csv::read_rows(&bytes));
    rows.transpose().map_err(|error| wrong(path, &error))
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
    match vector_csv::is_ours(bytes) || network_csv::is_ours(bytes) {
        true => "it is a genome of another problem, and describes no creature; islands evaluate takes it with the \
                 --problem that it is of"
            .to_owned(),
        false => error.to_string(),
    }
}

fn genome<E: Encoding>(
    encoding: &E,
    bytes: &[u8],
    path: &Path,
    dropped: &[usize],
) -> Result<Vec<E::Gene>, Failure> {
    let read = genome_csv::read_without(encoding, bytes, dropped)
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
