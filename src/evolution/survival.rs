//! Who lives on.

use super::individual::Individual;
use super::population::{Population, ranking};

/// Generational replacement with elitism (De Jong 1975): the best `elites` of the old population,
/// unchanged and first, then the offspring.
pub fn elitist<G: Clone>(
    old: &[Individual<G>],
    offspring: Population<G>,
    elites: usize,
) -> Population<G> {
    let survivors = ranking(old).into_iter().take(elites).map(|i| old[i].clone());
    survivors.chain(offspring).collect()
}
