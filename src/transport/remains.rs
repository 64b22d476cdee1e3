//! What crashed runs have left behind.

use super::TransportError;
use super::claim::{Claim, Found};
use super::shared_memory::SharedMemory;
use std::path::PathBuf;
use std::thread;
use std::time::Duration;

/// How often, and after which pause, to look whether a claim is free: one that is only being looked at is
/// held for some microseconds.
const LOOKS: usize = 10;
const PAUSE: Duration = Duration::from_millis(5);

/// What a run has left behind whose launcher was killed.
#[derive(Debug)]
pub struct Remains {
    /// The run's id.
    pub run_id: u64,
    /// Its folder, if there is one.
    pub folder: Option<PathBuf>,
    /// How many objects it has in shared memory.
    pub objects: usize,
    /// The memory that these take, in bytes.
    pub bytes: u64,
    memory: SharedMemory,
}

/// What came of a removal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Removal {
    /// Nothing is left.
    Done,
    /// Somebody holds the run, and it was left alone: a launcher has started it again, or somebody else is
    /// removing it.
    Held,
    /// Somebody else has removed it meanwhile.
    Gone,
}

impl Remains {
    /// Removes all that there is by now of the run, if its launcher is still dead.
    ///
    /// # Errors
    /// If something cannot be removed. It can be found again then.
    pub fn remove(self) -> Result<Removal, TransportError> {
        for _ in 0..LOOKS {
            match Claim::take_over(&self.memory, self.run_id) {
                Found::Abandoned(claim) => return claim.remove().map(|()| Removal::Done),
                Found::Gone => return Ok(Removal::Gone),
                Found::Held => thread::sleep(PAUSE),
            }
        }
        Ok(Removal::Held)
    }

    fn of(claim: &Claim, memory: &SharedMemory, run_id: u64) -> Self {
        let objects = memory.objects(run_id);
        Self {
            run_id,
            folder: claim.folder().map(PathBuf::from),
            objects: objects.len(),
            bytes: objects.iter().map(|object| object.bytes).sum(),
            memory: memory.clone(),
        }
    }
}

/// What dead launchers have left behind, in the order of run ids.
pub fn abandoned(memory: &SharedMemory) -> Vec<Remains> {
    let runs = memory.claimed().into_iter();
    let remains = runs.filter_map(|run_id| match Claim::take_over(memory, run_id) {
        Found::Abandoned(claim) => Some(Remains::of(&claim, memory, run_id)),
        Found::Held | Found::Gone => None,
    });
    remains.collect()
}
