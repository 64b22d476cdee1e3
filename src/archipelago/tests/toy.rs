//! A problem that evolves in microseconds, and with it an archipelago.

use crate::archipelago::{Archipelago, Migration, Topology};
use crate::evolution::{Evaluation, Gene, Hurdles, Problem, Selection, Strategy, Variation};
use crate::rng::Stream;
use bytemuck::{Pod, Zeroable};
use rand::RngExt;
use serde::{Deserialize, Serialize};

/// An archipelago of this many islands, for the toy.
pub fn archipelago(islands: u32, seed: u64, migration: Migration) -> Archipelago {
    let variation = Variation {
        crossover_rate: 0.7,
        point_rate: 0.2,
        point_amount: 1.0,
        shrink_rate: 0.1,
        grow_rate: 0.2,
        genes_max: 12,
        ..Variation::default()
    };
    let strategy = Strategy {
        population: 5,
        elites: 1,
        selection: Selection::Tournament { size: 2 },
        variation,
        ..Strategy::default()
    };
    Archipelago { islands, seed, topology: Topology::Ring, migration, strategy }
}

/// As many ones as possible, the later the better: few individuals are worth the same, so that hardly an
/// immigrant goes without effect.
pub struct Toy;

/// 0 or 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, Pod, Zeroable)]
#[repr(transparent)]
pub struct Bit(pub u8);

impl Gene for Bit {
    const WIRE_NAME: &'static str = "islands.tests.Bit.v1";

    fn is_valid(&self) -> bool {
        self.0 < 2
    }
}

impl Problem for Toy {
    type Gene = Bit;

    fn random_gene(&self, rng: &mut Stream) -> Bit {
        Bit(rng.random_range(0..2))
    }

    fn random_genome(&self, rng: &mut Stream) -> Vec<Bit> {
        (0..3).map(|_| self.random_gene(rng)).collect()
    }

    fn mutate_gene(&self, gene: &mut Bit, variation: &Variation, rng: &mut Stream) {
        if rng.random_bool(variation.point_rate) {
            gene.0 ^= 1;
        }
    }

    fn distance(&self, a: &[Bit], b: &[Bit]) -> f64 {
        let differing = a.iter().zip(b).filter(|(a, b)| a != b).count();
        differing as f64 / a.len().min(b.len()).max(1) as f64
    }

    fn evaluate(&self, genome: &[Bit]) -> Evaluation {
        let worth = |(place, bit): (usize, &Bit)| u32::from(bit.0) * (16 + place as u32);
        Evaluation::scored(genome.iter().enumerate().map(worth).sum::<u32>().into())
    }

    fn features(&self, genome: &[Bit]) -> [f64; 2] {
        let ones = genome.iter().filter(|bit| bit.0 == 1).count();
        [genome.len() as f64 / 12.0, ones as f64 / 12.0]
    }

    // A pool of threads would take far longer than the work.
    fn estimate_batch(&self, genomes: &[&[Bit]], _: &Hurdles) -> Vec<Evaluation> {
        genomes.iter().map(|genome| self.evaluate(genome)).collect()
    }
}
