//! An island's journal: every outbox that it ever sent, so that any epoch can be asked for again,
//! whatever died and however far back a reborn neighbour starts. It is also the run's migration log.

use super::{RecordLog, StoreError, Tail};
use crate::archipelago::Outbox;
use crate::evolution::Gene;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// A journal, open for appending: record k is the outbox of epoch k.
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

    /// Reads some epochs of a journal that another process writes, as far as they are there and whole.
    ///
    /// # Errors
    /// If the file cannot be read or is not ours.
    pub fn read(path: &Path, epochs: Range<u32>) -> Result<Vec<Outbox<G>>, StoreError> {
        let mut tail = Tail::of(path);
        tail.skip(epochs.start as usize)?;
        let mut outboxes = Vec::new();
        for epoch in epochs {
            match tail.next_record()? {
                Some(outbox) => outboxes.push(in_place(path, outbox, epoch)?),
                None => break,
            }
        }
        Ok(outboxes)
    }

    /// The epochs that it has: those below this one.
    pub fn epochs(&self) -> u32 {
        // An epoch is a u32, and so is the number of records.
        self.log.len() as u32
    }

    /// Appends an outbox and makes it durable: do this before it is sent. An island that evolves an epoch
    /// once more, after its death, must come to the same outbox, which is then not appended again.
    ///
    /// # Errors
    /// If the disk is full or gone, or the same epoch was another one before: then the island cannot be
    /// trusted, and neither can those who took that outbox in.
    pub fn append(&mut self, outbox: &Outbox<G>) -> Result<(), StoreError> {
        let epoch = outbox.epoch as usize;
        if epoch == self.log.len() {
            return self.log.append(outbox);
        }
        let damaged = |reason| StoreError::damaged(&self.path, reason);
        match self.log.get(epoch)? {
            Some(before) if before == *outbox => Ok(()),
            Some(_) => Err(damaged(format!(
                "epoch {epoch} came out otherwise when it was evolved again: this machine or this build does \
                 not compute the same"
            ))),
            None => Err(damaged(format!("epochs {} to {epoch} are missing", self.log.len()))),
        }
    }

    /// The outbox of an epoch, if it was sent.
    ///
    /// # Errors
    /// If the file cannot be read or is not ours.
    pub fn outbox(&self, epoch: u32) -> Result<Option<Outbox<G>>, StoreError> {
        let outbox = self.log.get(epoch as usize)?;
        outbox.map(|outbox| in_place(&self.path, outbox, epoch)).transpose()
    }
}

/// Reads a journal that another process writes, forwards only.
#[derive(Debug)]
pub struct JournalReader<G> {
    path: PathBuf,
    tail: Tail<Outbox<G>>,
    /// The epoch that it comes to next.
    next: u32,
}

impl<G: Gene> JournalReader<G> {
    /// A reader of the journal at `path`, which need not exist yet.
    pub fn of(path: impl Into<PathBuf>) -> Self {
        let path = path.into();
        Self { tail: Tail::of(&path), path, next: 0 }
    }

    /// The outbox of an epoch, if it is there by now; none of one that is not after all that were read before.
    ///
    /// # Errors
    /// If the file cannot be read or is not ours.
    pub fn outbox(&mut self, epoch: u32) -> Result<Option<Outbox<G>>, StoreError> {
        while self.next <= epoch {
            let Some(outbox) = self.tail.next_record()? else { break };
            let outbox = in_place(&self.path, outbox, self.next)?;
            self.next += 1;
            if outbox.epoch == epoch {
                return Ok(Some(outbox));
            }
        }
        Ok(None)
    }
}

fn in_place<G>(path: &Path, outbox: Outbox<G>, epoch: u32) -> Result<Outbox<G>, StoreError> {
    if outbox.epoch == epoch {
        Ok(outbox)
    } else {
        Err(StoreError::damaged(path, format!("epoch {epoch} is not in its place")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn outbox(epoch: u32, migrants: usize) -> Outbox<crate::creature::Gene> {
        let migrant = crate::evolution::Individual {
            id: crate::evolution::Id { island: 0, generation: epoch, index: 0 },
            parents: [None; 2],
            origin: 0,
            genome: vec![crate::creature::Gene([0.5; 17])],
            fitness: crate::evolution::Fitness::new(1.0),
        };
        Outbox { island: 0, epoch, migrants: vec![migrant; migrants] }
    }

    #[test]
    fn an_epoch_that_is_evolved_again_must_be_the_same_and_is_kept_once() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("journal");
        let mut journal = Journal::open(&path).expect("the folder is writable");
        for epoch in [0, 1, 0, 1, 2] {
            journal.append(&outbox(epoch, 1)).expect("it is the same");
        }
        assert_eq!(journal.epochs(), 3);
        let other = journal.append(&outbox(1, 2)).expect_err("it is another").to_string();
        assert!(other.contains("epoch 1 came out otherwise"), "{other}");
        assert!(journal.append(&outbox(9, 1)).is_err(), "there would be a hole");
        assert_eq!(journal.outbox(2).expect("it is readable"), Some(outbox(2, 1)));
        assert_eq!(journal.outbox(3).expect("it is readable"), None);
        let mut reader = JournalReader::of(&path);
        let mut later = |epoch| reader.outbox(epoch).expect("it is readable");
        assert_eq!([later(1), later(0)], [Some(outbox(1, 1)), None]);
        assert_eq!([later(3), later(2)], [None, None], "it has gone past the end");
        journal.append(&outbox(3, 1)).expect("it is the next");
        assert_eq!(later(3), Some(outbox(3, 1)));
        let read = |epochs| Journal::read(&path, epochs).expect("it is readable");
        assert_eq!(read(1..3), [outbox(1, 1), outbox(2, 1)]);
        assert_eq!(read(7..9), []);
    }
}
