//! An island's journal: every outbox that it ever sent, so that any epoch can be asked for again,
//! whatever died and however far back a reborn neighbour starts. It is also the run's migration log.

use super::{RecordLog, StoreError};
use crate::archipelago::Outbox;
use crate::evolution::Gene;
use std::path::{Path, PathBuf};

/// A journal, open for appending.
#[derive(Debug)]
pub struct Journal<G> {
    path: PathBuf,
    log: RecordLog<Outbox<G>>,
}

impl<G: Gene> Journal<G> {
    /// Opens the journal at `path`, new or as it is.
    ///
    /// # Errors
    /// If the file cannot be opened or read.
    pub fn open(path: &Path) -> Result<Self, StoreError> {
        Ok(Self { path: path.to_owned(), log: RecordLog::open(path)? })
    }

    /// Appends an outbox and makes it durable: do this before it is sent.
    ///
    /// # Errors
    /// If the disk is full or gone.
    pub fn append(&mut self, outbox: &Outbox<G>) -> Result<(), StoreError> {
        self.log.append(outbox)
    }

    /// The outboxes of `epoch` and after it, in the order of their epochs.
    ///
    /// # Errors
    /// If the file cannot be read.
    pub fn since(&self, epoch: u32) -> Result<Vec<Outbox<G>>, StoreError> {
        let mut outboxes = RecordLog::<Outbox<G>>::read(&self.path)?;
        outboxes.retain(|outbox| outbox.epoch >= epoch);
        Ok(outboxes)
    }
}
