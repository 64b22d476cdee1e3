//! Randomness with an address.
//!
//! Every draw in a run comes from a stream that is derived from where and why it is drawn: the run's
//! seed, the island, the generation, the individual's index and a purpose. No generator state is ever
//! saved or shared, so no order of execution can matter: threads, processes, crashes and resumes all
//! draw the same numbers.
//!
//! Architecture invariant: this is the only place that makes a generator, and nothing here reads
//! entropy, a clock or a global.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

/// The generator that every stochastic function of the crate takes.
///
/// ChaCha with 8 rounds (Bernstein 2008): portable, of cryptographic structure, and with a 256-bit key
/// that holds a whole address, so that two addresses can never share a stream.
pub type Stream = ChaCha8Rng;

/// What a stream is drawn for. The discriminants are part of every golden digest: never reorder.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub enum Purpose {
    /// The genome of an individual of generation 0.
    Genesis = 0,
    /// The parents of an offspring.
    Selection = 1,
    /// The recombination of two parents.
    Crossover = 2,
    /// The mutation of an offspring.
    Mutation = 3,
    /// What is drawn from a distribution that learns, and where that begins again.
    Sampling = 4,
    /// Who lives on, where chance decides it.
    Survival = 5,
    /// Where a benchmark has its optimum: drawn once, for all runs alike.
    Instance = 16,
    /// What differs in a trial: drawn for a trial's index alone, for all runs alike.
    Perturbation = 20,
    /// The individuals that an island sends.
    Emigration = 8,
    /// The residents that immigrants replace.
    Immigration = 9,
    /// Who sends to whom, which is not drawn on any island.
    Topology = 10,
    /// The rocks of a terrain, which no run's seed decides.
    Terrain = 12,
}

/// The address of one island's randomness: everything but generation, index and purpose.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Source {
    /// The seed of the run.
    pub seed: u64,
    /// The island that draws.
    pub island: u32,
}

impl Source {
    /// The stream of individual `index` in `generation` for `purpose`.
    pub fn stream(self, generation: u32, index: u32, purpose: Purpose) -> Stream {
        let mut key = [0_u8; 32];
        key[..8].copy_from_slice(&self.seed.to_le_bytes());
        key[8..12].copy_from_slice(&self.island.to_le_bytes());
        key[12..16].copy_from_slice(&generation.to_le_bytes());
        key[16..20].copy_from_slice(&index.to_le_bytes());
        key[20..24].copy_from_slice(&(purpose as u32).to_le_bytes());
        key[24..].copy_from_slice(b"islands1");
        Stream::from_seed(key)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::RngExt;

    #[test]
    fn an_address_fixes_its_stream_and_every_part_of_it_matters() {
        let source = Source { seed: 7, island: 1 };
        let draw = |source: Source, generation, index, purpose| -> u64 {
            source.stream(generation, index, purpose).random()
        };
        let here = draw(source, 3, 4, Purpose::Mutation);
        assert_eq!(here, draw(source, 3, 4, Purpose::Mutation));
        for elsewhere in [
            draw(Source { seed: 8, ..source }, 3, 4, Purpose::Mutation),
            draw(Source { island: 2, ..source }, 3, 4, Purpose::Mutation),
            draw(source, 4, 4, Purpose::Mutation),
            draw(source, 3, 5, Purpose::Mutation),
            draw(source, 3, 4, Purpose::Crossover),
        ] {
            assert_ne!(here, elsewhere);
        }
    }
}
