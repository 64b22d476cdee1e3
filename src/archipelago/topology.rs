//! Who sends migrants to whom.

use crate::choice;
use serde::{Deserialize, Serialize};

/// The directed graph of migration.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Topology {
    /// Island i sends to island i + 1, the last one to the first.
    Ring,
}

impl Topology {
    /// Every topology.
    pub const ALL: [Topology; 1] = [Topology::Ring];

    /// Whom `island` of `islands` sends to, ascending; never itself.
    pub fn out_neighbours(self, island: u32, islands: u32) -> Vec<u32> {
        match self {
            Topology::Ring if islands < 2 => Vec::new(),
            Topology::Ring => vec![(island + 1) % islands],
        }
    }

    /// Whom `island` of `islands` receives from, ascending: by definition those that send to it.
    pub fn in_neighbours(self, island: u32, islands: u32) -> Vec<u32> {
        (0..islands)
            .filter(|&other| self.out_neighbours(other, islands).contains(&island))
            .collect()
    }
}

impl std::fmt::Display for Topology {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Topology::Ring => "ring",
        })
    }
}

impl std::str::FromStr for Topology {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        choice::named("topology", &Topology::ALL, text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ring_goes_round_and_a_single_island_has_no_neighbour() {
        assert_eq!(Topology::Ring.out_neighbours(3, 4), [0]);
        assert_eq!(Topology::Ring.in_neighbours(0, 4), [3]);
        assert_eq!(Topology::Ring.in_neighbours(1, 2), [0]);
        assert!(Topology::Ring.out_neighbours(0, 1).is_empty());
        assert!(Topology::Ring.in_neighbours(0, 1).is_empty());
    }
}
