//! Fitness sharing (Goldberg & Richardson 1987): who lives in a crowd shares its fitness with it.

use super::scheme::Scheme;
use crate::evolution::fitness::Fitness;
use crate::evolution::individual::Individual;
use crate::evolution::problem::Problem;
use crate::evolution::selection::Selection;
use crate::rng::Stream;

/// Generational replacement, where parents are picked by their [`shared`] fitness.
#[derive(Debug, Clone, Copy)]
pub struct Sharing {
    /// The distance from which on two individuals share nothing, above 0, at most 1.
    pub radius: f64,
}

impl Scheme for Sharing {
    fn couples<P: Problem>(
        self,
        problem: &P,
        population: &[Individual<P::Gene>],
        selection: Selection,
        offspring: usize,
        stream: impl Fn(usize) -> Stream,
    ) -> Vec<[usize; 2]> {
        selection.prepare(&shared(problem, population, self.radius)).couples(offspring, stream)
    }

    /// With tournaments the niches come and go (Oei, Goldberg & Chang 1991).
    fn usual_selection(self) -> Option<Selection> {
        Some(Selection::Sus)
    }

    fn forgets(self) -> bool {
        false
    }
}

/// The fitness by which parents are picked: how far it is above the least of the population, divided by the size of the
/// niche. Every other individual adds to the niche the more, the nearer it is, and nothing from `radius` on.
pub fn shared<P: Problem>(
    problem: &P,
    population: &[Individual<P::Gene>],
    radius: f64,
) -> Vec<Fitness> {
    let scores = population.iter().filter_map(|one| one.fitness.finite());
    let least = scores.fold(f64::INFINITY, f64::min);
    let niche = |one: &Individual<P::Gene>| -> f64 {
        let distance = |other: &Individual<_>| problem.distance(&one.genome, &other.genome);
        population.iter().map(|other| (1.0 - distance(other) / radius).max(0.0)).sum()
    };
    let share = |one: &Individual<P::Gene>| match one.fitness.finite() {
        // One's own share of the niche is 1. Halved, so that no pair of scores overflows.
        Some(score) => Fitness::new((score / 2.0 - least / 2.0) / niche(one).max(1.0)),
        None => Fitness::WORST,
    };
    population.iter().map(share).collect()
}
