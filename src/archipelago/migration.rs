//! What travels between islands, and when.
//!
//! With interval I, epoch k is generations kI + 1 to (k + 1)I. It begins by taking in the outboxes of epoch
//! k - 1 - L of every in-neighbour, where there is one, and ends by sending outbox k. With a lag L of 1 or
//! more an island evolves on while its neighbours' migrants are under way. Where islands do not wait for each other,
//! an epoch begins by taking in what has arrived, of whatever epoch.

use super::policy::{Emigrants, ExchangeMode, Replacement};
use crate::evolution::generation::Moment;
use crate::evolution::population::{Population, ranking};
use crate::evolution::{Fitness, Individual, Problem};
use crate::rng::{Purpose, Stream};
use serde::{Deserialize, Serialize};
use std::cmp::Reverse;

/// The most individuals that one outbox can carry.
pub const MIGRANTS_MAX: usize = 32;

/// What islands exchange, when and how much.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Migration {
    /// Generations between two exchanges, at least 1.
    pub interval: u32,
    /// Individuals that an island sends at each exchange, at most [`MIGRANTS_MAX`].
    pub migrants: usize,
    /// Epochs by which immigrants are older than they could be, where islands wait for each other.
    pub lag: u32,
    /// Who is sent.
    pub emigrants: Emigrants,
    /// Whom immigrants replace.
    pub replacement: Replacement,
    /// Whether islands wait for each other.
    pub exchange: ExchangeMode,
}

impl Default for Migration {
    fn default() -> Self {
        Self {
            interval: 5,
            migrants: 2,
            lag: 1,
            emigrants: Emigrants::Best,
            replacement: Replacement::Worst,
            exchange: ExchangeMode::Sync,
        }
    }
}

impl Migration {
    /// The epoch that begins with `generation`, if any.
    pub fn beginning(&self, generation: u32) -> Option<u32> {
        let before = generation.checked_sub(1)?;
        before.is_multiple_of(self.interval).then_some(before / self.interval)
    }

    /// The epochs that have begun by the end of `generation`: those below this one.
    pub fn begun(&self, generation: u32) -> u32 {
        generation.div_ceil(self.interval)
    }

    /// The epoch whose outboxes are taken in at the beginning of `generation`, if any, where islands wait for each
    /// other.
    pub fn immigration(&self, generation: u32) -> Option<u32> {
        self.beginning(generation)?.checked_sub(1 + self.lag)
    }

    /// The first epoch that an island whose `generation` is behind it will take in from then on.
    pub fn next_immigration(&self, generation: u32) -> u32 {
        self.begun(generation).saturating_sub(1).saturating_sub(self.lag)
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
    /// Copies of some of its individuals, the best first.
    pub migrants: Vec<Individual<G>>,
}

/// Phase: the outbox of an epoch, copies of some of the population at the end of a generation. They travel with whole
/// scores, as their island's champion has one: an estimate of one island would be a lie on another one.
pub fn emigrate<P: Problem>(
    problem: &P,
    population: &[Individual<P::Gene>],
    champion: &Individual<P::Gene>,
    migration: &Migration,
    moment: Moment,
    epoch: u32,
) -> Outbox<P::Gene> {
    let draw = |slot| stream(moment, slot, Purpose::Emigration);
    let chosen = migration.emigrants.choose(&ranking(population), migration.migrants, draw);
    let is_champion = |index: usize| population[index].genome == champion.genome;
    let is_whole = |index: &usize| !problem.has_estimates() || is_champion(*index);
    let (whole, others): (Vec<usize>, Vec<usize>) = chosen.into_iter().partition(is_whole);
    let genomes: Vec<&[P::Gene]> =
        others.iter().map(|&index| population[index].genome.as_slice()).collect();
    let scores = problem.evaluate_batch(&genomes);
    let scores = scores.into_iter().map(|score| score.fitness);
    let known = |index| if is_champion(index) { champion } else { &population[index] }.fitness;
    let whole = whole.into_iter().map(|index| (index, known(index)));
    let migrants = whole.chain(others.into_iter().zip(scores));
    let with =
        |(index, fitness): (usize, Fitness)| Individual { fitness, ..population[index].clone() };
    let mut migrants: Vec<_> = migrants.map(with).collect();
    migrants.sort_by_key(|migrant| Reverse(migrant.fitness));
    Outbox { island: moment.source.island, epoch, migrants }
}

/// Phase: takes immigrants in at the beginning of a generation. Each replaces whom the policy says, if anybody; one
/// whose genome lives here already is turned away. They count [`in_order`], so that the result does not depend on which
/// arrived first.
pub fn immigrate<P: Problem>(
    problem: &P,
    mut population: Population<P::Gene>,
    outboxes: &[Outbox<P::Gene>],
    migration: &Migration,
    moment: Moment,
) -> Population<P::Gene> {
    for (number, migrant) in (0..).zip(in_order(outboxes)) {
        if population.iter().any(|resident| resident.genome == migrant.genome) {
            continue;
        }
        let mut rng = stream(moment, number, Purpose::Immigration);
        let replaced = migration.replacement.whom(problem, &population, migrant, &mut rng);
        if let Some(replaced) = replaced {
            population[replaced] = migrant.clone();
        }
    }
    population
}

/// All migrants of outboxes, in the order in which they count: of their senders.
pub fn in_order<G>(outboxes: &[Outbox<G>]) -> impl Iterator<Item = &Individual<G>> {
    let mut outboxes: Vec<&Outbox<G>> = outboxes.iter().collect();
    outboxes.sort_by_key(|outbox| outbox.island);
    outboxes.into_iter().flat_map(|outbox| &outbox.migrants)
}

fn stream(Moment { source, generation }: Moment, index: u32, purpose: Purpose) -> Stream {
    source.stream(generation, index, purpose)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn epochs_follow_the_protocol() {
        let migration = Migration::default();
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
            let migration = Migration { interval, lag, ..Migration::default() };
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
