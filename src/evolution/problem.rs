//! What is to be solved.

use super::fitness::{Evaluation, Fitness};
use super::sharing;
use super::variation::{self, Variation};
use crate::rng::Stream;
use bytemuck::Pod;
use serde::{Serialize, de::DeserializeOwned};
use std::fmt::Debug;

/// What a genome is a sequence of: plain data that may cross a process boundary as it lies in memory.
pub trait Gene: Pod + PartialEq + Debug + Send + Sync + Serialize + DeserializeOwned {
    /// The name under which genes of this layout travel; change it when the layout changes.
    const WIRE_NAME: &'static str;

    /// Whether a gene that came from a file or another process may be used.
    fn is_valid(&self) -> bool;
}

/// A problem to evolve solutions for: the one open trait of the crate.
///
/// A genome is a `[Self::Gene]`. Evaluation must be a pure function of the genome: the same genome gets
/// the same fitness bits wherever and whenever it is evaluated.
pub trait Problem: Sync {
    /// One gene.
    type Gene: Gene;

    /// Draws a gene.
    fn random_gene(&self, rng: &mut Stream) -> Self::Gene;

    /// Draws the genome of an individual of generation 0.
    fn random_genome(&self, rng: &mut Stream) -> Vec<Self::Gene>;

    /// Changes a gene by a point mutation: each value with probability `rate`, by at most `amount`.
    fn mutate_gene(&self, gene: &mut Self::Gene, rate: f64, amount: f64, rng: &mut Stream);

    /// How different two genomes are, from 0 (equal) to 1 (nothing in common).
    fn distance(&self, a: &[Self::Gene], b: &[Self::Gene]) -> f64;

    /// Scores a genome.
    fn evaluate(&self, genome: &[Self::Gene]) -> Evaluation;

    /// Scores a champion once more by a slower and more trusted judge than [`Problem::evaluate`], where there is one. It
    /// decides nothing of what evolves, but which champion a run keeps.
    fn confirm(&self, _genome: &[Self::Gene]) -> Option<Evaluation> {
        None
    }

    /// Recombines two genomes.
    fn crossover(
        &self,
        a: &[Self::Gene],
        b: &[Self::Gene],
        variation: &Variation,
        rng: &mut Stream,
    ) -> Vec<Self::Gene> {
        variation::one_point_crossover(a, b, variation.genes_max, rng)
    }

    /// Mutates a genome: by default point, shrink and grow mutation, in this order.
    fn mutate(&self, genome: &mut Vec<Self::Gene>, variation: &Variation, rng: &mut Stream) {
        variation::point(genome, rng, |gene, rng| {
            self.mutate_gene(gene, variation.point_rate, variation.point_amount, rng);
        });
        variation::shrink(genome, variation.shrink_rate, rng);
        variation::grow(genome, variation.grow_rate, variation.genes_max, rng, |rng| {
            self.random_gene(rng)
        });
    }

    /// Estimates what evaluating a genome costs, in any unit. It decides in which order a batch is begun, and so how
    /// long that takes, but no result.
    fn cost(&self, _genome: &[Self::Gene]) -> u64 {
        1
    }

    /// Scores many genomes on the threads of the current rayon pool, the dearest first; results are in the order
    /// given.
    fn evaluate_batch(&self, genomes: &[&[Self::Gene]]) -> Vec<Evaluation> {
        let costs: Vec<u64> = genomes.iter().map(|genome| self.cost(genome)).collect();
        sharing::dearest_first(&costs, |index| self.evaluate(genomes[index]))
    }

    /// The unit of the fitness, for labels.
    fn unit(&self) -> &'static str {
        ""
    }

    /// A fitness as people read it.
    fn show(&self, fitness: Fitness) -> String {
        match fitness.finite() {
            Some(score) => format!("{score:.3} {}", self.unit()).trim_end().to_owned(),
            None => "failed".to_owned(),
        }
    }
}
