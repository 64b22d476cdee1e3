//! A list of individuals and what can be said of it.

use super::fitness::Fitness;
use super::individual::Individual;
use super::problem::Problem;
use std::cmp::Reverse;

/// The individuals of one island, in a fixed order: index and order are part of a run's digest.
pub type Population<G> = Vec<Individual<G>>;

/// Indices of `population` from the best to the worst; equal ones in the order of their index.
pub fn ranking<G>(population: &[Individual<G>]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..population.len()).collect();
    order.sort_by_key(|&i| Reverse(population[i].fitness));
    order
}

/// The best individual, the first of equal ones; none in an empty population.
pub fn best<G>(population: &[Individual<G>]) -> Option<&Individual<G>> {
    population.iter().reduce(|best, other| if other.fitness > best.fitness { other } else { best })
}

/// What a row of the metrics says of a population.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Statistics {
    /// The best fitness.
    pub best: Fitness,
    /// The mean over those that could be scored.
    pub mean: Fitness,
    /// The median of all, failures counted as worst; the upper one of an even number.
    pub median: Fitness,
    /// The mean distance of two individuals, from 0 (all equal) to 1.
    pub diversity: f64,
}

impl Statistics {
    /// Describes `population`. An empty one is worst in everything.
    pub fn of<P: Problem>(problem: &P, population: &[Individual<P::Gene>]) -> Self {
        let mut fitness: Vec<Fitness> = population.iter().map(|i| i.fitness).collect();
        fitness.sort_unstable();
        let at = |i: usize| fitness.get(i).copied().unwrap_or(Fitness::WORST);
        Self {
            best: at(fitness.len().saturating_sub(1)),
            mean: mean(fitness.iter().filter_map(|f| f.finite())),
            median: at(fitness.len() / 2),
            diversity: diversity(problem, population),
        }
    }
}

fn mean(values: impl Iterator<Item = f64>) -> Fitness {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
    // No value at all divides zero by zero, which Fitness::new turns into WORST.
    Fitness::new(sum / count)
}

fn diversity<P: Problem>(problem: &P, population: &[Individual<P::Gene>]) -> f64 {
    let mut sum = 0.0;
    let mut pairs = 0.0;
    for (i, a) in population.iter().enumerate() {
        for b in &population[i + 1..] {
            sum += problem.distance(&a.genome, &b.genome);
            pairs += 1.0;
        }
    }
    if pairs > 0.0 { sum / pairs } else { 0.0 }
}
