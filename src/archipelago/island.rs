//! One island, and its step as a pure function.

use super::Archipelago;
use super::migration::{self, Outbox};
use crate::evolution::generation::{self, Effort, Moment};
use crate::evolution::population::{Population, best};
use crate::evolution::{Gene, Id, Individual, Problem, Statistics};
use serde::{Deserialize, Serialize};

/// The whole state of an island between two generations.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(bound = "G: Gene")]
pub struct Island<G> {
    /// Which island this is, from 0.
    pub index: u32,
    /// The generation that its population is.
    pub generation: u32,
    /// Its individuals.
    pub population: Population<G>,
    /// The best individual that ever lived here, immigrants included.
    pub champion: Individual<G>,
    /// What all its evaluations so far cost.
    pub effort: Effort,
}

/// Why something is no state of an island.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum Misfit {
    /// It is another island's.
    #[error("it is another island's")]
    Index,
    /// Its population is not of the size that the run has.
    #[error("it has not as many individuals as a population has")]
    Size,
    /// A genome is empty or too long.
    #[error("it has a genome that is empty or too long")]
    Length,
    /// A gene may not be used.
    #[error("it has a gene that is not valid")]
    Gene,
    /// Someone's or their parent's birthplace does not exist, or did not by then.
    #[error("it has an individual from nowhere")]
    Lineage,
    /// Someone is better than the champion.
    #[error("its champion is not the best")]
    Champion,
    /// There are not as many evaluations as ended somehow.
    #[error("its evaluations do not add up")]
    Effort,
}

impl<G: Gene> Island<G> {
    /// Whether this can be a state of island `index` of `archipelago`: ask this of what was read from a file.
    ///
    /// # Errors
    /// The first reason that is found why it cannot.
    pub fn fits(&self, archipelago: &Archipelago, index: u32) -> Result<(), Misfit> {
        let Island { population, champion, effort, .. } = self;
        require(self.index == index && index < archipelago.islands, Misfit::Index)?;
        require(population.len() == archipelago.strategy.population, Misfit::Size)?;
        for individual in population.iter().chain([champion]) {
            possible(individual, archipelago, self.generation)?;
        }
        require(population.iter().all(|i| i.fitness <= champion.fitness), Misfit::Champion)?;
        let born = (u64::from(self.generation) + 1).saturating_mul(population.len() as u64);
        let tried = effort.evaluations.checked_add(effort.reused);
        let ended = effort.outcomes.iter().try_fold(0_u64, |sum, &count| sum.checked_add(count));
        require(ended == Some(effort.evaluations), Misfit::Effort)?;
        require(tried.is_some_and(|tried| tried <= born), Misfit::Effort)
    }
}

/// Whether there can be such an individual in a run by the end of `generation`.
pub(super) fn possible<G: Gene>(
    individual: &Individual<G>,
    run: &Archipelago,
    generation: u32,
) -> Result<(), Misfit> {
    let Individual { id, parents, genome, .. } = individual;
    let lengths = 1..=run.strategy.variation.genes_max;
    let exists = |id: &Id| id.island < run.islands && id.generation <= generation;
    require(lengths.contains(&genome.len()), Misfit::Length)?;
    require(genome.iter().all(Gene::is_valid), Misfit::Gene)?;
    require(parents.iter().flatten().chain([id]).all(exists), Misfit::Lineage)
}

fn require(condition: bool, otherwise: Misfit) -> Result<(), Misfit> {
    if condition { Ok(()) } else { Err(otherwise) }
}

/// What one generation of one island was like: a row of the metrics.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Report {
    /// The island.
    pub island: u32,
    /// The generation.
    pub generation: u32,
    /// The population at its end.
    pub statistics: Statistics,
    /// What it cost.
    pub effort: Effort,
    /// Immigrants that were in its outboxes.
    pub immigrants: u32,
}

/// What comes out of a step.
#[derive(Debug, Clone, PartialEq)]
pub struct Step<G> {
    /// The island after the generation.
    pub island: Island<G>,
    /// What it sends, at the end of an epoch.
    pub outbox: Option<Outbox<G>>,
    /// What the generation was like.
    pub report: Report,
    /// Whether [`Island::champion`] is a new one.
    pub new_champion: bool,
}

/// Generation 0 of an island: random genomes, evaluated.
pub fn genesis<P: Problem>(problem: &P, archipelago: &Archipelago, island: u32) -> Step<P::Gene> {
    let source = archipelago.source(island);
    let offspring = generation::genesis(problem, &archipelago.strategy, source);
    let (population, effort) = generation::evaluate(problem, offspring, &[]);
    let champion = best(&population).expect("a population has at least two individuals").clone();
    let report = Report {
        island,
        generation: 0,
        statistics: Statistics::of(problem, &population),
        effort,
        immigrants: 0,
    };
    let island = Island { index: island, generation: 0, population, champion, effort };
    Step { island, outbox: None, report, new_champion: true }
}

/// The next generation of an island. `immigrants` are the outboxes that
/// [`Migration::immigration`](super::Migration::immigration) names for it, in any order.
///
/// A generation ends with every individual evaluated, so that what it sends and what is saved of it
/// needs no evaluation ever again.
pub fn step<P: Problem>(
    island: Island<P::Gene>,
    immigrants: &[Outbox<P::Gene>],
    problem: &P,
    archipelago: &Archipelago,
) -> Step<P::Gene> {
    let Archipelago { strategy, migration, .. } = archipelago;
    let Island { index, generation, population, champion, effort: spent } = island;
    let generation = generation + 1;
    let moment = Moment { source: archipelago.source(index), generation };

    let population = migration::immigrate::<P>(population, immigrants);
    let couples = generation::select(&population, strategy, moment);
    let offspring = generation::vary(problem, &population, &couples, strategy, moment);
    let (offspring, effort) = generation::evaluate(problem, offspring, &population);
    let next = generation::survive(&population, offspring, strategy);
    let outbox = migration
        .emigration(generation)
        .map(|epoch| migration::emigrate(&next, migration, index, epoch));

    let contender =
        [best(&population), best(&next)].into_iter().flatten().max_by_key(|i| i.fitness);
    let better = contender.filter(|contender| contender.fitness > champion.fitness).cloned();
    let new_champion = better.is_some();
    let report = Report {
        island: index,
        generation,
        statistics: Statistics::of(problem, &next),
        effort,
        immigrants: immigrants.iter().map(|outbox| outbox.migrants.len() as u32).sum(),
    };
    let island = Island {
        index,
        generation,
        population: next,
        champion: better.unwrap_or(champion),
        effort: spent.and(effort),
    };
    Step { island, outbox, report, new_champion }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::archipelago::tests::toy::{Bit, Toy, archipelago};
    use crate::archipelago::{Migration, lockstep};
    use crate::evolution::Fitness;

    const GENERATION: u32 = 6;

    fn run() -> Archipelago {
        archipelago(3, 1, Migration { interval: 2, migrants: 1, lag: 0 })
    }

    #[test]
    fn a_state_that_was_evolved_fits_its_island_and_no_other() {
        let islands = lockstep::run(&Toy, &run(), GENERATION, |step| {
            assert_eq!(step.island.fits(&run(), step.island.index), Ok(()));
        });
        assert_eq!(islands[1].fits(&run(), 2), Err(Misfit::Index));
        let fewer = Archipelago { islands: 1, ..run() };
        assert_eq!(islands[1].fits(&fewer, 1), Err(Misfit::Index));
    }

    #[test]
    fn a_state_that_breaks_a_rule_is_refused() {
        type Break = fn(&mut Island<Bit>);
        let rules: [(Misfit, Break); 14] = [
            (Misfit::Size, |i| drop(i.population.pop())),
            (Misfit::Size, |i| i.population.push(i.champion.clone())),
            (Misfit::Length, |i| i.population[1].genome.clear()),
            (Misfit::Length, |i| i.champion.genome = vec![Bit(0); 99]),
            (Misfit::Gene, |i| i.population[1].genome[0] = Bit(2)),
            (Misfit::Gene, |i| i.champion.genome[0] = Bit(2)),
            (Misfit::Lineage, |i| i.population[0].id.island = 3),
            (Misfit::Lineage, |i| i.population[0].id.generation = GENERATION + 1),
            (Misfit::Lineage, |i| i.champion.id.generation = GENERATION + 1),
            (Misfit::Lineage, |i| i.champion.parents[1] = Some(Id { island: 3, ..i.champion.id })),
            (Misfit::Champion, |i| i.population[2].fitness = Fitness::new(999.0)),
            (Misfit::Champion, |i| i.champion.fitness = Fitness::WORST),
            (Misfit::Effort, |i| i.effort.evaluations += 1),
            (Misfit::Effort, |i| i.effort.outcomes = [u64::MAX; 7]),
        ];
        let islands = lockstep::run(&Toy, &run(), GENERATION, |_| ());
        for (number, (misfit, break_rule)) in rules.into_iter().enumerate() {
            let mut island = islands[1].clone();
            break_rule(&mut island);
            assert_eq!(island.fits(&run(), 1), Err(misfit), "rule {number}");
        }
    }
}
