//! The number that two runs are compared by.

use super::island::Island;
use crate::evolution::Gene;
use std::fmt;

/// A BLAKE3 hash over every island's final population: its size, then of each individual the number of
/// genes, the genes' bytes and the fitness bits, in order. All integers are little-endian.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Digest(blake3::Hash);

impl Digest {
    /// The digest of these islands, which must be in the order of their index.
    pub fn of<G: Gene>(islands: &[Island<G>]) -> Self {
        let mut hasher = blake3::Hasher::new();
        for island in islands {
            hasher.update(&(island.population.len() as u64).to_le_bytes());
            for individual in &island.population {
                hasher.update(&(individual.genome.len() as u64).to_le_bytes());
                hasher.update(bytemuck::cast_slice(&individual.genome));
                hasher.update(&individual.fitness.get().to_bits().to_le_bytes());
            }
        }
        Self(hasher.finalize())
    }
}

impl fmt::Display for Digest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.to_hex().fmt(f)
    }
}
