//! What is to be solved.

use super::fitness::{Evaluation, Fitness};
use super::hurdles::Hurdles;
use super::sharing;
use super::variation::sequences::Layout;
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

    /// The real numbers that it is made of, each from 0 to [`VALUE_MAX`](variation::values::VALUE_MAX), always as many;
    /// none if it is made of something else.
    fn values(&self) -> &[f64] {
        &[]
    }

    /// The same, to be changed.
    fn values_mut(&mut self) -> &mut [f64] {
        &mut []
    }
}

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

    /// The genome that individual `index` of generation 0 of an island with so many individuals has to have; none if a
    /// random one. It is no longer than genomes may be.
    fn founder(&self, _island: u32, _index: usize, _population: usize) -> Option<Vec<Self::Gene>> {
        None
    }

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

    /// All scores that a genome can have on an island, its estimates and, last, its whole score.
    fn possible_scores(&self, genome: &[Self::Gene]) -> Vec<Fitness> {
        vec![self.evaluate(genome).fitness]
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
        variation::recombine(self, a, b, variation, rng)
    }

    /// Mutates a genome.
    fn mutate(&self, genome: &mut Vec<Self::Gene>, variation: &Variation, rng: &mut Stream) {
        variation::mutate(self, genome, variation, rng);
    }

    /// What a genome is like besides being good: two numbers from 0 to 1, by which phenotypes are told apart and laid
    /// out on a map. By default all are alike.
    fn features(&self, _genome: &[Self::Gene]) -> [f64; 2] {
        [0.0; 2]
    }

    /// What the two features are called.
    fn feature_names(&self) -> [&'static str; 2] {
        ["first", "second"]
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
        sharing::dearest_first(&costs, |index| self.estimate(genomes[index], hurdles))
    }

    /// Scores many genomes wholly.
    fn evaluate_batch(&self, genomes: &[&[Self::Gene]]) -> Vec<Evaluation> {
        self.estimate_batch(genomes, &Hurdles::NONE)
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
