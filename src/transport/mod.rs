//! Elites and reports between processes, through shared memory: nothing is serialised, and a genome is
//! written once.
//!
//! What travels is one sample for each outbox or report: a slice of genes, and a header that says whose they
//! are ([`wire`]). A process that is killed therefore never leaves half an outbox visible.
//!
//! | service | from | to | when full |
//! |---|---|---|---|
//! | `outboxes/<i>` | island i | its out-neighbours | not delivered to whom it does not fit |
//! | `requests/<i>` | island i's out-neighbours | island i | the oldest is forgotten |
//! | `wakeup/<i>` | island i's neighbours | island i | one is as good as many |
//! | `reports` | all islands | launcher, and one who watches by hand | the oldest is forgotten |
//!
//! A [`Domain`] keeps a run apart from all others. The launcher's [`ServiceHost`] creates the services, holds
//! them open while islands come and go, cleans up after the dead and leaves nothing behind; what a killed
//! launcher leaves ([`Domain::abandoned`]), the next one removes. An island opens an [`Exchange`]; who wants
//! to watch opens a [`ReportReader`], and there is room for one besides the launcher.
//!
//! Below these, from the ground: `names` says what everything of a run is called, `shared_memory` finds it, a
//! `claim` says whose it is, and `remains` is what is there without a living launcher; `wire` is what travels,
//! and `limits` what of it is believed; `services` lists the services, `files` sees to it that they can be open,
//! `ports` opens their ends, and `dead_nodes` gives free what dead islands held.
//!
//! # How it is meant to be used
//!
//! Channels may lose, repeat and reorder. What makes the exchange exact is that every outbox has an epoch,
//! that its sender keeps it, and that the receiver asks for what it misses:
//!
//! - An island appends each outbox to its journal before it calls [`Exchange::publish`]. When it starts it
//!   publishes the last [`Exchange::history`] epochs of its journal again.
//! - To take in an epoch it calls [`Exchange::receive`] and hands all outboxes to an
//!   [`Inbox`](crate::archipelago::Inbox), which keeps what is early and drops what came twice, until
//!   [`take`](crate::archipelago::Inbox::take) yields the epoch. Meanwhile it calls [`Exchange::wait`], tick by
//!   tick.
//! - After 200 ms without progress it calls [`Exchange::request`] for every source that
//!   [`missing`](crate::archipelago::Inbox::missing) names, with the missing epoch.
//! - At every tick, at the end of every generation, and after its last one until it is told to stop, it asks
//!   [`Exchange::requests`], and publishes its journal again from the epoch that it names.
//! - The launcher waits for a child that has died, calls [`ServiceHost::cleanup_dead_nodes`], and starts the
//!   next one.
//!
//! Where islands do not wait for each other ([`ExchangeMode::Async`](crate::archipelago::ExchangeMode)) nothing is
//! asked for: the newest outboxes push older ones out.
//!
//! Architecture invariants: this is the only importer of iceoryx2. Nothing here decides a result: time-outs,
//! losses and repetitions change when something arrives, never what. Nothing received is believed before it
//! was checked.

mod claim;
mod dead_nodes;
mod domain;
mod exchange;
mod files;
mod limits;
mod names;
mod ports;
mod remains;
mod report_reader;
mod service_host;
mod services;
mod shared_memory;
#[cfg(test)]
#[expect(clippy::disallowed_methods, reason = "a test may give up after a while")]
mod tests;
pub mod wire;

pub use domain::Domain;
pub use exchange::{Exchange, Received, TICK};
pub use limits::{Limits, Rejection, Sighting};
pub use remains::{Remains, Removal};
pub use report_reader::ReportReader;
pub use service_host::ServiceHost;

use std::fmt::Display;
use std::io;
use std::path::{Path, PathBuf};

/// What can go wrong with shared memory.
#[derive(Debug, thiserror::Error)]
pub enum TransportError {
    /// There is not enough of it.
    #[error(
        "the run needs up to {needed_mib} MiB of shared memory, but {path} has only {free_mib} MiB free: \
         enlarge it (mount -o remount,size=… {path}; docker run --shm-size=…), or take fewer islands, \
         migrants or genes"
    )]
    NoSpace {
        /// Where it was looked for.
        path: &'static str,
        /// What the run needs, in MiB.
        needed_mib: u64,
        /// What there is, in MiB.
        free_mib: u64,
    },
    /// An outbox cannot hold so many.
    #[error("{migrants} migrants do not fit in one outbox: take {max} at most")]
    TooManyMigrants {
        /// How many were asked for.
        migrants: usize,
        /// How many fit.
        max: usize,
    },
    /// Too many islands are neighbours.
    #[error(
        "the topology has {edges} edges, and {max} is the most: each takes open files and shared memory; take fewer \
         islands or a sparser topology, such as torus, hypercube or random-regular:3"
    )]
    TooManyEdges {
        /// The edges that it has.
        edges: usize,
        /// The edges that it may have.
        max: usize,
    },
    /// A process may not have so many files open.
    #[error(
        "a process of this run may have up to {needed} files open, and the system lets it have {limit}: raise that \
         (ulimit -Hn), or take fewer islands or a sparser topology"
    )]
    TooManyFiles {
        /// How many a process of the run needs at most.
        needed: u64,
        /// How many it may have.
        limit: u64,
    },
    /// A text that is no run id.
    #[error("“{text}” is no run id: it must be a hexadecimal number of at most 16 digits")]
    RunId {
        /// The text.
        text: String,
    },
    /// A folder or an object could not be made or removed.
    #[error("{}: {source}; make sure that this user may write there", path.display())]
    Folder {
        /// The folder or object.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// Something could not be created.
    #[error(
        "could not set up {what} in shared memory ({cause}): make sure that this user may write in \
         /dev/shm and the folder for temporary files, and may have enough files open (ulimit -n)"
    )]
    Setup {
        /// What could not be created.
        what: String,
        /// The reason.
        cause: String,
    },
    /// Something that should be there could not be opened.
    #[error(
        "could not open the run's {what} ({cause}): make sure that its launcher is running, as the same \
         user and from the same build"
    )]
    Open {
        /// What could not be opened.
        what: String,
        /// The reason.
        cause: String,
    },
    /// Something of one's own breaks the rules for what may travel.
    #[error(
        "this cannot be sent, since {reason}: it is a bug of the problem or its genome's variation"
    )]
    Unsendable {
        /// The rule that it breaks.
        reason: Rejection,
    },
    /// A sender's reserved memory is exhausted or broken.
    #[error("no shared memory is left to send from ({cause}): restart this island")]
    Memory {
        /// The reason.
        cause: String,
    },
    /// Waiting for a neighbour's call failed.
    #[error("could not wait for the neighbours ({cause}): restart this island")]
    Wait {
        /// The reason.
        cause: String,
    },
    /// What dead islands held is still held.
    #[error(
        "could not clean up after {dead} dead process(es), whose places may stay taken: restart the run"
    )]
    Cleanup {
        /// How many.
        dead: u64,
    },
}

impl TransportError {
    fn setup(what: &str, cause: impl Display) -> Self {
        Self::Setup { what: what.to_owned(), cause: cause.to_string() }
    }

    fn open(what: &str, cause: impl Display) -> Self {
        Self::Open { what: what.to_owned(), cause: cause.to_string() }
    }

    fn unsendable(reason: Rejection) -> Self {
        Self::Unsendable { reason }
    }

    fn folder(path: &Path, source: io::Error) -> Self {
        Self::Folder { path: path.to_owned(), source }
    }
}
