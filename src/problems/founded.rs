//! A problem whose islands do not all begin at random.

use crate::evolution::variation::sequences::Layout;
use crate::evolution::{Evaluation, Fitness, Hurdles, Problem, Variation};
use crate::rng::Stream;

/// A problem with genomes to begin with; all else is as in the problem itself.
#[derive(Debug, Clone, PartialEq)]
pub struct Founded<P: Problem> {
    /// The problem.
    pub problem: P,
    /// The genomes to begin with, in their order: each island begins with as many of them as its population has room
    /// for, the next island with those that follow, and from the first one again after the last.
    pub founders: Vec<Vec<P::Gene>>,
}

impl<P: Problem> Problem for Founded<P> {
    type Gene = P::Gene;

    fn founder(&self, island: u32, index: usize, population: usize) -> Option<Vec<P::Gene>> {
        let share = population.min(self.founders.len());
        let place =
            || (island as usize).wrapping_mul(share).wrapping_add(index) % self.founders.len();
        (index < share).then(|| self.founders[place()].clone())
    }

    fn random_gene(&self, rng: &mut Stream) -> P::Gene {
        self.problem.random_gene(rng)
    }

    fn random_genome(&self, rng: &mut Stream) -> Vec<P::Gene> {
        self.problem.random_genome(rng)
    }

    fn layout(&self) -> Layout {
        self.problem.layout()
    }

    fn mutate_gene(&self, gene: &mut P::Gene, variation: &Variation, rng: &mut Stream) {
        self.problem.mutate_gene(gene, variation, rng);
    }

    fn duplicate(&self, genome: &mut Vec<P::Gene>, genes_max: usize, rng: &mut Stream) {
        self.problem.duplicate(genome, genes_max, rng);
    }

    fn features(&self, genome: &[P::Gene]) -> [f64; 2] {
        self.problem.features(genome)
    }

    fn feature_names(&self) -> [&'static str; 2] {
        self.problem.feature_names()
    }

    fn distance(&self, a: &[P::Gene], b: &[P::Gene]) -> f64 {
        self.problem.distance(a, b)
    }

    fn evaluate(&self, genome: &[P::Gene]) -> Evaluation {
        self.problem.evaluate(genome)
    }

    fn crossover(
        &self,
        a: &[P::Gene],
        b: &[P::Gene],
        variation: &Variation,
        rng: &mut Stream,
    ) -> Vec<P::Gene> {
        self.problem.crossover(a, b, variation, rng)
    }

    fn mutate(&self, genome: &mut Vec<P::Gene>, variation: &Variation, rng: &mut Stream) {
        self.problem.mutate(genome, variation, rng);
    }

    fn estimate(&self, genome: &[P::Gene], hurdles: &Hurdles) -> Evaluation {
        self.problem.estimate(genome, hurdles)
    }

    fn has_estimates(&self) -> bool {
        self.problem.has_estimates()
    }

    fn possible_scores(&self, genome: &[P::Gene]) -> Vec<Fitness> {
        self.problem.possible_scores(genome)
    }

    fn validate(&self, genome: &[P::Gene]) -> Option<Fitness> {
        self.problem.validate(genome)
    }

    fn cost(&self, genome: &[P::Gene]) -> u64 {
        self.problem.cost(genome)
    }

    fn estimate_batch(&self, genomes: &[&[P::Gene]], hurdles: &Hurdles) -> Vec<Evaluation> {
        self.problem.estimate_batch(genomes, hurdles)
    }

    fn unit(&self) -> &'static str {
        self.problem.unit()
    }

    fn show(&self, fitness: Fitness) -> String {
        self.problem.show(fitness)
    }
}
