//! One island, and its step as a pure function.

use super::Archipelago;
use super::lineage::Births;
use super::migration::{self, Outbox};
use crate::evolution::generation::{self, Brood, Effort, Moment};
use crate::evolution::population::{Population, best};
use crate::evolution::survival::species::Species;
use crate::evolution::{Fitness, Founders, Gene, Hurdles, Individual, Memory, Problem, Statistics};
use crate::rng::{Purpose, Source, Stream};
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
    /// What it has learned.
    pub memory: Memory,
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
    /// Species that its population has at its end, where it is divided into such; else 0.
    // In files an entry of a log has it after all else: those of before there were species end there.
    #[serde(skip)]
    pub species: u32,
}

/// A champion of an island, better than all before it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(bound = "G: Gene")]
pub struct Champion<G> {
    /// The generation in which it became the champion.
    pub generation: u32,
    /// The champion.
    pub individual: Individual<G>,
    /// What it is worth on trials that it was not selected on: see [`Problem::validate`].
    pub validated: Option<Fitness>,
}

impl<G: Gene> Champion<G> {
    fn crown<P: Problem<Gene = G>>(
        problem: &P,
        individual: &Individual<G>,
        generation: u32,
    ) -> Self {
        let validated = problem.validate(&individual.genome);
        Self { generation, individual: individual.clone(), validated }
    }
}

/// What comes out of a step.
#[derive(Debug, Clone, PartialEq)]
pub struct Step<G> {
    /// The island after the generation.
    pub island: Island<G>,
    /// What it sends, at the end of an epoch.
    pub outbox: Option<Outbox<G>>,
    /// Who was born.
    pub births: Births,
    /// What the generation was like.
    pub report: Report,
    /// [`Island::champion`], if it is a new one.
    pub champion: Option<Champion<G>>,
    /// The genomes whose evaluation panicked.
    pub panicked: Vec<Vec<G>>,
}

/// Generation 0 of an island: founders and random genomes, evaluated.
pub fn genesis<P: Problem>(
    problem: &P,
    founders: &Founders<P::Gene>,
    archipelago: &Archipelago,
    island: u32,
) -> Step<P::Gene> {
    let source = archipelago.source(island);
    let offspring = generation::genesis(problem, founders, &archipelago.strategy, source);
    let Brood { mut population, effort, panicked } =
        generation::evaluate(problem, offspring, &[], &Hurdles::LAST);
    generation::judge_best(problem, &mut population);
    let births = Births::of(0, &Memory::default(), &population);
    let memory = Memory::first(problem, &population, &archipelago.strategy);
    let survival = archipelago.strategy.survival;
    let population = match survival.has_cells() {
        true => survival.survivors(problem, &[], population, 0, &mut fate(source, 0)),
        false => population,
    };
    let champion = best(&population).expect("a population is never empty").clone();
    let report = Report {
        island,
        generation: 0,
        statistics: Statistics::of(problem, &population),
        effort,
        immigrants: 0,
        species: memory.species().map_or(0, Species::count) as u32,
    };
    let crowned = Champion::crown(problem, &champion, 0);
    let island = Island { index: island, generation: 0, population, champion, effort, memory };
    Step { island, outbox: None, births, report, champion: Some(crowned), panicked }
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
    let Island { index, generation, population, champion, effort: spent, memory } = island;
    let generation = generation + 1;
    let moment = Moment { source: archipelago.source(index), generation };
    let strategy = &strategy.on(index, memory.amount_scale);

    let before = if memory.species().is_some() { population.clone() } else { Vec::new() };
    let population = take_in(problem, population, immigrants, archipelago, moment);
    let memory = memory.with_immigrants(problem, &before, &population, strategy, moment.here());
    let offspring = generation::reproduce(problem, &population, &memory, strategy, moment);
    let hurdles = Hurdles::of(&population, strategy.survival.forgets());
    let Brood { population: brood, effort, panicked } =
        generation::evaluate(problem, offspring, &population, &hurdles);
    let births = Births::of(generation, &memory, &brood);
    let mut sampling = moment.source.stream(generation, u32::MAX, Purpose::Sampling);
    let memory = memory.after(&population, &brood, strategy, &mut sampling);
    let next = generation::succeed(problem, &population, brood, &memory, strategy, moment);
    let memory = memory.with_heirs(problem, &population, &next, strategy, moment.here());
    let contender =
        [best(&population), best(&next)].into_iter().flatten().max_by_key(|i| i.fitness);
    let better = contender.filter(|contender| contender.fitness > champion.fitness);
    let crowned = better.map(|better| Champion::crown(problem, better, generation));
    let champion = crowned.as_ref().map_or(champion, |crowned| crowned.individual.clone());
    let outbox = migration
        .emigration(generation)
        .map(|epoch| migration::emigrate(problem, &next, &champion, migration, moment, epoch));
    let report = Report {
        island: index,
        generation,
        statistics: Statistics::of(problem, &next),
        effort,
        immigrants: immigrants.iter().map(|outbox| outbox.migrants.len() as u32).sum(),
        species: memory.species().map_or(0, Species::count) as u32,
    };
    let island =
        Island { index, generation, population: next, champion, effort: spent.and(effort), memory };
    Step { island, outbox, births, report, champion: crowned, panicked }
}

/// The randomness of who survives a generation.
fn fate(source: Source, generation: u32) -> Stream {
    source.stream(generation, u32::MAX, Purpose::Survival)
}

/// Phase: takes immigrants in. Where there are cells they compete for them like everybody else.
fn take_in<P: Problem>(
    problem: &P,
    population: Population<P::Gene>,
    immigrants: &[Outbox<P::Gene>],
    archipelago: &Archipelago,
    moment: Moment,
) -> Population<P::Gene> {
    let survival = archipelago.strategy.survival;
    match survival.has_cells() {
        true => {
            let migrants = migration::in_order(immigrants).cloned().collect();
            let mut fate = fate(moment.source, moment.generation);
            survival.survivors(problem, &population, migrants, 0, &mut fate)
        }
        false => {
            migration::immigrate(problem, population, immigrants, &archipelago.migration, moment)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::Migration;
    use super::super::tests::toy::{Bit, Toy, archipelago};
    use super::*;
    use crate::evolution::{Fitness, Id};

    #[test]
    fn where_nothing_is_varied_nobody_is_evaluated_whether_elite_offspring_or_immigrant() {
        let migration = Migration { interval: 1, migrants: 1, lag: 0, ..Migration::default() };
        let mut archipelago = archipelago(2, 7, migration);
        let rates = &mut archipelago.strategy.variation;
        (rates.crossover_rate, rates.point_rate) = (0.0, 0.0);
        (rates.shrink_rate, rates.grow_rate) = (0.0, 0.0);
        let first = genesis(&Toy, &Founders::NONE, &archipelago, 0).island;
        // Its score is none that an evaluation would give it.
        let immigrant = Individual {
            id: Id { island: 1, generation: 0, index: 0 },
            parents: [None; 2],
            origin: 0,
            genome: vec![Bit(1); 9],
            fitness: Fitness::new(1e6),
        };
        let outbox = Outbox { island: 1, epoch: 0, migrants: vec![immigrant.clone()] };
        let Step { report, island, .. } = step(first, &[outbox], &Toy, &archipelago);
        assert_eq!(report.effort, Effort { reused: 4, ..Effort::default() });
        assert_eq!(report.immigrants, 1);
        assert_eq!(island.population[0], immigrant, "it is the elite");
        let copies = island.population.iter().filter(|it| it.genome == immigrant.genome);
        assert!(copies.clone().count() > 1, "it has offspring");
        assert!(copies.into_iter().all(|copy| copy.fitness == immigrant.fitness));
    }
}
