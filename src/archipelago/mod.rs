//! Many islands: who is whose neighbour, what travels when, and how one island steps.
//!
//! [`algorithm`] says what searches; [`topology`], [`migration`] and [`policy`] say who sends what when; [`island`]
//! is one island's step, a pure function; [`inbox`] is the receiving end of the exchange protocol, [`arrivals`] that
//! of an exchange in which nobody waits, and [`protocol`] the whole of it as an island sees it: state machines without
//! a channel, a clock or a file; [`lineage`] says who descends from whom; [`soundness`] says what of a file can be
//! believed; [`lockstep`] runs a whole archipelago in one process, and is the reference that the processes must
//! equal to the last bit; [`digest`] is the number in which "equal" is checked.
//!
//! Architecture invariant: pure, like [`crate::evolution`]. Whether migrants travel through shared memory,
//! a file or a variable is not known here.

pub mod algorithm;
pub mod arrivals;
pub mod digest;
pub mod inbox;
pub mod island;
pub mod lineage;
pub mod lockstep;
pub mod migration;
pub mod policy;
pub mod protocol;
pub mod soundness;
pub mod topology;

#[cfg(test)]
mod tests;

pub use algorithm::Algorithm;
pub use arrivals::Arrivals;
pub use digest::Digest;
pub use inbox::{Arrival, Inbox};
pub use island::{Champion, Island, Report, Step};
pub use lineage::{Birth, Births, Descent, Lineage};
pub use migration::{Migration, Outbox};
pub use policy::{Emigrants, ExchangeMode, Replacement};
pub use protocol::{Action, Protocol};
pub use soundness::Misfit;
pub use topology::{Graph, Topology};

use crate::evolution::Strategy;
use crate::rng::Source;
use serde::{Deserialize, Serialize};

/// All that decides the result of a run besides the problem.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Archipelago {
    /// Number of islands, at least 1.
    pub islands: u32,
    /// The seed of all randomness.
    pub seed: u64,
    /// Who sends to whom.
    pub topology: Topology,
    /// What is sent when.
    pub migration: Migration,
    /// How each island evolves.
    pub strategy: Strategy,
}

impl Archipelago {
    /// The randomness of one island.
    pub fn source(&self, island: u32) -> Source {
        Source { seed: self.seed, island }
    }

    /// Who sends to whom. It takes time to make: who asks for many islands keeps it.
    pub fn graph(&self) -> Graph {
        self.topology.graph(self.islands, self.seed)
    }

    /// Whom `island` receives from.
    pub fn in_neighbours(&self, island: u32) -> Vec<u32> {
        self.graph().in_neighbours(island).to_vec()
    }

    /// Whom `island` sends to.
    pub fn out_neighbours(&self, island: u32) -> Vec<u32> {
        self.graph().out_neighbours(island).to_vec()
    }
}
