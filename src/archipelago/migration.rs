//! What travels between islands, and when.
//!
//! With interval I, epoch k is generations kI + 1 to (k + 1)I. It begins by taking in the outboxes of epoch
//! k - 1 - L of every in-neighbour, where there is one, and ends by sending outbox k. With a lag L of 1 or
//! more an island evolves on while its neighbours' migrants are under way.

use crate::evolution::population::{Population, ranking};
use crate::evolution::{Individual, Problem};
use serde::{Deserialize, Serialize};
use std::cmp::Reverse;

/// The most individuals that one outbox can carry.
pub const MIGRANTS_MAX: usize = 32;

/// When and how much islands exchange.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Migration {
    /// Generations between two exchanges, at least 1.
    pub interval: u32,
    /// Individuals that an island sends at each exchange, at most [`MIGRANTS_MAX`].
    pub migrants: usize,
    /// Epochs by which immigrants are older than they could be.
    pub lag: u32,
}

impl Migration {
    /// The epoch whose outboxes are taken in at the beginning of `generation`, if any.
    pub fn immigration(&self, generation: u32) -> Option<u32> {
        let before = generation.checked_sub(1)?;
        let begins = before.is_multiple_of(self.interval);
        begins.then_some(before / self.interval)?.checked_sub(1 + self.lag)
    }

    /// The first epoch that an island whose `generation` is behind it will take in from then on.
    pub fn next_immigration(&self, generation: u32) -> u32 {
        let next_to_begin = generation.div_ceil(self.interval);
        next_to_begin.saturating_sub(1).saturating_sub(self.lag)
    }

    /// The epoch whose outbox is sent at the end of `generation`, if any.
    pub fn emigration(&self, generation: u32) -> Option<u32> {
        let ends = generation.is_multiple_of(self.interval);
        ends.then_some(generation / self.interval)?.checked_sub(1)
    }
}

/// What one island sends at the end of one epoch, to all its out-neighbours alike.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Outbox<G> {
    /// The sender.
    pub island: u32,
    /// The epoch that it ends.
    pub epoch: u32,
    /// Copies of its best individuals, the best first.
    pub migrants: Vec<Individual<G>>,
}

/// Phase: the outbox of an epoch, copies of the best of the population.
pub fn emigrate<G: Clone>(
    population: &[Individual<G>],
    migration: &Migration,
    island: u32,
    epoch: u32,
) -> Outbox<G> {
    let best = ranking(population).into_iter().take(migration.migrants);
    Outbox { island, epoch, migrants: best.map(|i| population[i].clone()).collect() }
}

/// Phase: takes immigrants in. Each replaces the worst individual there is, if it is better; one whose
/// genome lives here already is turned away. Outboxes count in the order of their senders, so that the
/// result does not depend on which arrived first.
pub fn immigrate<P: Problem>(
    mut population: Population<P::Gene>,
    outboxes: &[Outbox<P::Gene>],
) -> Population<P::Gene> {
    let mut outboxes: Vec<&Outbox<P::Gene>> = outboxes.iter().collect();
    outboxes.sort_by_key(|outbox| outbox.island);
    for migrant in outboxes.into_iter().flat_map(|outbox| &outbox.migrants) {
        let Some(worst) = worst(&population) else { break };
        let known = population.iter().any(|resident| resident.genome == migrant.genome);
        if !known && migrant.fitness > population[worst].fitness {
            population[worst] = migrant.clone();
        }
    }
    population
}

/// The worst individual, the last of equal ones.
fn worst<G>(population: &[Individual<G>]) -> Option<usize> {
    (0..population.len()).min_by_key(|&i| (population[i].fitness, Reverse(i)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn epochs_follow_the_protocol() {
        let migration = Migration { interval: 5, migrants: 2, lag: 1 };
        // Epoch k is generations 5k + 1 to 5k + 5.
        let sent: Vec<_> =
            (0..=15).filter_map(|g| migration.emigration(g).map(|e| (g, e))).collect();
        assert_eq!(sent, [(5, 0), (10, 1), (15, 2)]);
        let taken: Vec<_> =
            (0..=21).filter_map(|g| migration.immigration(g).map(|e| (g, e))).collect();
        assert_eq!(taken, [(11, 0), (16, 1), (21, 2)]);
        let eager = Migration { lag: 0, ..migration };
        assert_eq!(eager.immigration(6), Some(0));
    }

    #[test]
    fn the_next_epoch_to_be_taken_in_is_the_one_that_the_generations_to_come_name_first() {
        for (interval, lag) in (1..=6).flat_map(|interval| (0..=4).map(move |lag| (interval, lag)))
        {
            let migration = Migration { interval, migrants: 2, lag };
            for generation in 0..100 {
                let first = (generation + 1..).find_map(|later| migration.immigration(later));
                assert_eq!(
                    Some(migration.next_immigration(generation)),
                    first,
                    "after generation {generation} of {migration:?}"
                );
            }
        }
    }
}
