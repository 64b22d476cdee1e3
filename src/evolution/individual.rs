//! A genome with a history.

use super::fitness::Fitness;
use serde::{Deserialize, Serialize};

/// The birthplace of an individual, unique in a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct Id {
    /// The island where it was born.
    pub island: u32,
    /// The generation in which it was born.
    pub generation: u32,
    /// Its place among those born with it.
    pub index: u32,
}

impl std::fmt::Display for Id {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}.{}.{}", self.island, self.generation, self.index)
    }
}

/// An evaluated genome and where it comes from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Individual<G> {
    /// Where and when it was born; it keeps this when it migrates or survives.
    pub id: Id,
    /// Whom it comes from: nobody if it is random, one where crossover did not happen, else two.
    pub parents: [Option<Id>; 2],
    /// The generation in which its oldest ancestor was born: its age is counted from there.
    pub origin: u32,
    /// Its genes.
    pub genome: Vec<G>,
    /// What they are worth.
    pub fitness: Fitness,
}
