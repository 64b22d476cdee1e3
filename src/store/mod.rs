//! What a run leaves on disk, so that nothing is lost.
//!
//! [`run_dir`] says where everything lies, and whose it is, [`experiment_dir`] the same of an experiment;
//! [`mod@file`] opens what may be anything; [`atomic`] writes files that are there whole or not at all; [`record_log`]
//! appends records, each with its checksum, and is what an island's [`journal`] and its logs of champions and
//! generations are made of; [`checkpoint`] is an island's whole state, of which [`checkpoints`] keeps the newest two. A
//! [`Logbook`] is all of it together, and what an island begins with after its death; it believes no state that could
//! not be one of the run.
//!
//! Architecture invariant: this alone imports bincode. What a file says is believed only after its checksum.

pub mod atomic;
pub mod checkpoint;
pub mod checkpoints;
pub mod entry;
pub mod experiment_dir;
pub mod file;
pub mod journal;
pub mod logbook;
#[cfg(test)]
mod power_loss;
pub mod record_log;
pub mod run_dir;
mod tail;
#[cfg(test)]
mod watched_disk;

pub use checkpoint::Checkpoint;
pub use checkpoints::Checkpoints;
pub use entry::Entry;
pub use experiment_dir::ExperimentDir;
pub use journal::{Journal, JournalReader};
pub use logbook::{Logbook, Restored};
pub use record_log::RecordLog;
pub use run_dir::{Claim, RunDir};
pub use tail::{Index, Tail};

use serde::{Serialize, de::DeserializeOwned};
use std::path::{Path, PathBuf};

/// Why something could not be stored or read back.
#[derive(Debug, thiserror::Error)]
pub enum StoreError {
    /// The file system refused.
    #[error("cannot {action} {}: {source}", path.display())]
    Io {
        /// What was tried.
        action: &'static str,
        /// With which file.
        path: PathBuf,
        /// What it said.
        source: std::io::Error,
    },
    /// A file is not what it should be.
    #[error("{} is damaged: {reason}", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        reason: String,
    },
    /// A checkpoint was saved under other settings.
    #[error("{} was saved by a run with other settings, or by another version", path.display())]
    Foreign {
        /// The file.
        path: PathBuf,
    },
    /// Another process runs this run.
    #[error("the run in {} is under way in another process", path.display())]
    UnderWay {
        /// The folder.
        path: PathBuf,
    },
    /// A file was written by a version that this one does not know.
    #[error("{} has format version {found}, and this program reads version {known}", path.display())]
    Version {
        /// The file.
        path: PathBuf,
        /// Its version.
        found: u32,
        /// Ours.
        known: u32,
    },
}

impl StoreError {
    /// What is wrong, for a sentence that names the file itself.
    pub fn reason(&self) -> String {
        match self {
            StoreError::Io { source, .. } => source.to_string(),
            StoreError::Damaged { reason, .. } => reason.clone(),
            other => other.to_string(),
        }
    }

    fn io<'a>(action: &'static str, path: &'a Path) -> impl FnOnce(std::io::Error) -> Self + 'a {
        move |source| StoreError::Io { action, path: path.to_owned(), source }
    }

    /// A file that is not what it should be.
    pub fn damaged(path: &Path, reason: impl Into<String>) -> Self {
        StoreError::Damaged { path: path.to_owned(), reason: reason.into() }
    }
}

/// No record or state of ours is larger than this, in bytes: a length that says so is a damaged one, and no
/// memory is asked for on its word.
const BYTES_MAX: usize = 1 << 30;

fn codec() -> impl bincode::config::Config {
    bincode::config::standard().with_fixed_int_encoding().with_limit::<BYTES_MAX>()
}

/// A value as records and checkpoints hold it. What migrates is never encoded; the benches say what that saves.
///
/// # Panics
/// If the value is no plain data, such as a sequence of a length that is not known beforehand.
pub fn encode<T: Serialize>(value: &T) -> Vec<u8> {
    bincode::serde::encode_to_vec(value, codec())
        .expect("our records are plain data, without maps or cycles")
}

/// The value that was encoded.
///
/// # Errors
/// What is wrong with `bytes`, if they are not exactly one value of this type.
pub fn decode<T: DeserializeOwned>(bytes: &[u8]) -> Result<T, String> {
    match bincode::serde::decode_from_slice(bytes, codec()) {
        Ok((value, read)) if read == bytes.len() => Ok(value),
        Ok((_, read)) => Err(format!("{} bytes too many", bytes.len() - read)),
        Err(error) => Err(error.to_string()),
    }
}

/// The checksum of what is stored: the first 8 bytes of its BLAKE3 hash.
fn checksum(bytes: &[u8]) -> [u8; 8] {
    let hash = blake3::hash(bytes);
    *hash.as_bytes().first_chunk().expect("a hash has 32 bytes")
}
