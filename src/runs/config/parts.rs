//! What a configuration is made into.

use crate::archipelago::migration::Migration;
use crate::archipelago::{Archipelago, Topology};
use crate::evolution::Strategy;
use crate::problems::Locomotion;

/// What a configuration is made into: whose fields are the settings that say so.
#[derive(Debug, Clone)]
pub struct Parts {
    /// What decides the result of the run, but for the problem.
    pub archipelago: Archipelago,
    /// The problem, where creatures are evolved.
    pub locomotion: Locomotion,
}

impl Parts {
    /// What they are if nothing is said.
    pub fn usual() -> Self {
        let (migration, strategy) = (Migration::default(), Strategy::default());
        let topology = Topology::Ring;
        Self {
            archipelago: Archipelago { islands: 4, seed: 0, topology, migration, strategy },
            locomotion: Locomotion::DEFAULT,
        }
    }
}
