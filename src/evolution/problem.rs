//! What is to be solved.

use super::fitness::{Evaluation, Fitness};
use super::gene::Gene;
use super::hurdles::Hurdles;
use super::variation::sequences::Layout;
use super::variation::{self, Variation};
use crate::rng::Stream;
use crate::work_queue;

/// A problem to evolve solutions for: the one open trait of the crate.
///
/// A genome is a `[Self::Gene]`. Evaluation must be a pure function of the genome: the same genome gets
/// the same fitness bits wherever and whenever it is evaluated.
pub trait Problem: Sync + Sized {
    /// One gene.
    type Gene: Gene;

    /// Draws a gene.
    fn random_gene(&self, rng: &mut Stream) -> Self::Gene;

    /// Draws the genome of an individual of generation 0.
    fn random_genome(&self, rng: &mut Stream) -> Vec<Self::Gene>;

    /// Whether each place of a genome has its meaning, so that all have the length of a random one.
    fn layout(&self) -> Layout {
        Layout::Free
    }

    /// Changes a gene by point mutation: each of its values as `variation` says.
    fn mutate_gene(&self, gene: &mut Self::Gene, variation: &Variation, rng: &mut Stream) {
        variation::values::mutate(gene.values_mut(), variation, rng);
    }

    /// Repeats a part of a genome within it, if it can and that leaves at most `genes_max` genes: by default it
    /// cannot.
    fn duplicate(&self, _genome: &mut Vec<Self::Gene>, _genes_max: usize, _rng: &mut Stream) {}

    /// How different two genomes are, from 0 (equal) to 1 (nothing in common).
    fn distance(&self, a: &[Self::Gene], b: &[Self::Gene]) -> f64;

    /// How different two genomes are where species are told apart by it, 0 if they are equal, and without a bound: by
    /// default the distance.
    fn compatibility(&self, a: &[Self::Gene], b: &[Self::Gene]) -> f64 {
        self.distance(a, b)
    }

    /// Scores a genome.
    fn evaluate(&self, genome: &[Self::Gene]) -> Evaluation;

    /// Scores a genome as far as it gets over the hurdles. Who gets over all of them has the score of
    /// [`Problem::evaluate`], others an estimate that is not above the hurdle that they failed at. By default nobody is
    /// estimated.
    fn estimate(&self, genome: &[Self::Gene], _hurdles: &Hurdles) -> Evaluation {
        self.evaluate(genome)
    }

    /// Whether some of the scores that [`Problem::estimate`] gives are estimates.
    fn has_estimates(&self) -> bool {
        false
    }

    /// What a champion is worth on trials that it was not selected on, where there are such. It decides nothing.
    fn validate(&self, _genome: &[Self::Gene]) -> Option<Fitness> {
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
        variation::recombine(a, b, self.layout(), variation, rng)
    }

    /// Mutates a genome as `variation` says: its values and, where it may be of any length, its genes.
    fn mutate(&self, genome: &mut Vec<Self::Gene>, variation: &Variation, rng: &mut Stream) {
        let mutate_gene = |gene: &mut _, rng: &mut Stream| self.mutate_gene(gene, variation, rng);
        let random_gene = |rng: &mut Stream| self.random_gene(rng);
        let duplicate = |genome: &mut Vec<_>, rng: &mut Stream| {
            self.duplicate(genome, variation.genes_max, rng);
        };
        let layout = self.layout();
        variation::mutate(genome, layout, variation, rng, mutate_gene, random_gene, duplicate);
    }

    /// What a genome is like besides being good: two numbers from 0 to 1, by which phenotypes are told apart and laid
    /// out on a map. By default all are alike.
    fn features(&self, _genome: &[Self::Gene]) -> [f64; 2] {
        [0.0; 2]
    }

    /// Estimates what evaluating a genome costs, in any unit. It decides in which order a batch is begun, and so how
    /// long that takes, but no result.
    fn cost(&self, _genome: &[Self::Gene]) -> u64 {
        1
    }

    /// Scores many genomes, as far as they get over the hurdles, on the threads of the current rayon pool, the dearest
    /// first; results are in the order given.
    fn estimate_batch(&self, genomes: &[&[Self::Gene]], hurdles: &Hurdles) -> Vec<Evaluation> {
        let costs: Vec<u64> = genomes.iter().map(|genome| self.cost(genome)).collect();
        work_queue::dearest_first(&costs, |index| self.estimate(genomes[index], hurdles))
    }

    /// Scores many genomes wholly.
    fn evaluate_batch(&self, genomes: &[&[Self::Gene]]) -> Vec<Evaluation> {
        self.estimate_batch(genomes, &Hurdles::NONE)
    }
}
