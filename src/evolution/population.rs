//! A list of individuals and what can be said of it.

use super::fitness::Fitness;
use super::individual::Individual;
use super::problem::Problem;
use serde::{Deserialize, Serialize};
use std::cmp::Reverse;

/// The individuals of one island, in a fixed order: index and order are part of a run's digest.
pub type Population<G> = Vec<Individual<G>>;

/// Indices of `population` from the best to the worst; equal ones in the order of their index.
pub fn ranking<G>(population: &[Individual<G>]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..population.len()).collect();
    order.sort_by_key(|&i| Reverse(population[i].fitness));
    order
}

/// Copies of the best of a population, the best first; of equal ones the first.
pub fn elite<G: Clone>(
    population: &[Individual<G>],
    elites: usize,
) -> impl Iterator<Item = Individual<G>> {
    ranking(population).into_iter().take(elites).map(|index| population[index].clone())
}

/// The best individual, the first of equal ones; none in an empty population.
pub fn best<G>(population: &[Individual<G>]) -> Option<&Individual<G>> {
    population.iter().reduce(|best, other| if other.fitness > best.fitness { other } else { best })
}

/// What a row of the metrics says of a population.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Statistics {
    /// The best fitness.
    pub best: Fitness,
    /// The mean over those that could be scored.
    pub mean: Fitness,
    /// The median of all, failures counted as worst; the upper one of an even number.
    pub median: Fitness,
    /// The mean distance of two genomes, from 0 (all equal) to 1.
    pub diversity: f64,
    /// The mean distance of two phenotypes in the plane of [`Problem::features`], as a share of its diagonal.
    pub phenotype_diversity: f64,
    /// How the scores are spread.
    pub spread: Spread,
}

/// A histogram of the scores of a population; failures are in none of its bars.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Spread {
    /// Where the first bar begins: the smallest score.
    pub low: f64,
    /// Where the last bar ends: the largest score.
    pub high: f64,
    /// How many scores lie in each of so many equal parts of that range.
    pub counts: [u32; SPREAD_BARS],
}

/// The most individuals whose distances are measured.
const REPRESENTATIVES_MAX: usize = 64;

/// Bars of a [`Spread`].
pub const SPREAD_BARS: usize = 16;

impl Spread {
    /// Counts scores, which must be finite.
    pub fn of(scores: &[f64]) -> Self {
        let low = scores.iter().copied().reduce(f64::min).unwrap_or(0.0);
        let high = scores.iter().copied().reduce(f64::max).unwrap_or(0.0);
        let mut counts = [0; SPREAD_BARS];
        for score in scores {
            // Equal scores divide zero by zero, and are all in the first bar.
            let bar = ((score - low) / (high - low) * SPREAD_BARS as f64) as usize;
            counts[bar.min(SPREAD_BARS - 1)] += 1;
        }
        Self { low, high, counts }
    }
}

impl Statistics {
    /// Describes `population`. An empty one is worst in everything.
    pub fn of<P: Problem>(problem: &P, population: &[Individual<P::Gene>]) -> Self {
        let mut fitness: Vec<Fitness> = population.iter().map(|i| i.fitness).collect();
        fitness.sort_unstable();
        let scores: Vec<f64> = fitness.iter().filter_map(|f| f.finite()).collect();
        let at = |i: usize| fitness.get(i).copied().unwrap_or(Fitness::WORST);
        Self {
            best: at(fitness.len().saturating_sub(1)),
            mean: mean(&scores),
            median: at(fitness.len() / 2),
            diversity: diversity(problem, population),
            phenotype_diversity: phenotype_diversity(problem, population),
            spread: Spread::of(&scores),
        }
    }
}

fn mean(scores: &[f64]) -> Fitness {
    // No score at all divides zero by zero, which Fitness::new turns into WORST.
    Fitness::new(scores.iter().sum::<f64>() / scores.len() as f64)
}

fn diversity<P: Problem>(problem: &P, population: &[Individual<P::Gene>]) -> f64 {
    let few: Vec<_> = representatives(population).map(|one| &one.genome).collect();
    mean_of_pairs(&few, |a, b| problem.distance(a, b))
}

fn phenotype_diversity<P: Problem>(problem: &P, population: &[Individual<P::Gene>]) -> f64 {
    let few: Vec<_> =
        representatives(population).map(|one| problem.features(&one.genome)).collect();
    let distance = |a: &[f64; 2], b: &[f64; 2]| libm::hypot(a[0] - b[0], a[1] - b[1]);
    mean_of_pairs(&few, distance) / std::f64::consts::SQRT_2
}

/// All of a small population, and of a large one as many, taken evenly: pairs grow with the square.
fn representatives<G>(population: &[Individual<G>]) -> impl Iterator<Item = &Individual<G>> {
    let count = population.len().min(REPRESENTATIVES_MAX);
    (0..count).map(move |i| &population[i * population.len() / count])
}

/// The mean of a function over all pairs of different items; 0 without any.
pub fn mean_of_pairs<T>(all: &[T], distance: impl Fn(&T, &T) -> f64) -> f64 {
    let mut sum = 0.0;
    let mut pairs = 0.0;
    for (i, a) in all.iter().enumerate() {
        for b in &all[i + 1..] {
            sum += distance(a, b);
            pairs += 1.0;
        }
    }
    if pairs > 0.0 { sum / pairs } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_score_is_in_one_bar_of_the_spread() {
        let spread = Spread::of(&[0.0, 0.0, 1.0, 16.0]);
        assert_eq!((spread.low, spread.high), (0.0, 16.0));
        assert_eq!((spread.counts[0], spread.counts[1], spread.counts[15]), (2, 1, 1));
        assert_eq!(Spread::of(&[3.0; 5]).counts[0], 5);
        assert_eq!(Spread::of(&[]).counts, [0; SPREAD_BARS]);
    }

    #[test]
    fn means_are_over_those_that_were_scored() {
        assert_eq!(mean(&[1.0, 2.0]), Fitness::new(1.5));
        assert_eq!(mean(&[]), Fitness::WORST);
    }
}
