//! Whether what was read from a file can be of this run: a checksum only says that it is as somebody wrote it,
//! and evolution relies on more.

use super::{Archipelago, ExchangeMode, Island, Outbox};
use crate::evolution::{Gene, Id, Individual};

/// Why something is no state of an island.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum Misfit {
    /// It is another island's.
    #[error("it is another island's")]
    Index,
    /// Its population is not of the size that the run has.
    #[error("its population has the wrong size")]
    Size,
    /// A genome is empty or too long.
    #[error("it has a genome that is empty or too long")]
    Length,
    /// A gene may not be used.
    #[error("it has a gene that is not valid")]
    Gene,
    /// Someone's or their parent's birthplace does not exist, or did not by then.
    #[error("it has an individual that was born nowhere")]
    Lineage,
    /// Someone is better than the champion.
    #[error("its champion is not the best")]
    Champion,
    /// What it has learned cannot be.
    #[error("what it has learned is impossible")]
    Memory,
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
        require(archipelago.strategy.sizes().contains(&population.len()), Misfit::Size)?;
        require(
            self.memory.is_sound(&archipelago.strategy, population, self.generation),
            Misfit::Memory,
        )?;
        for individual in population.iter().chain([champion]) {
            possible(individual, archipelago, index, self.generation)?;
        }
        require(population.iter().all(|i| i.fitness <= champion.fitness), Misfit::Champion)?;
        let born =
            (u64::from(self.generation) + 1).saturating_mul(archipelago.strategy.population as u64);
        let tried = effort.evaluations.checked_add(effort.reused);
        let ended = effort.outcomes.total();
        require(ended == Some(effort.evaluations), Misfit::Effort)?;
        require(tried.is_some_and(|tried| tried <= born), Misfit::Effort)
    }
}

impl<G: Gene> Outbox<G> {
    /// Whether island `source` of `archipelago` can have sent this: ask this of what was read from a file.
    pub fn fits(&self, archipelago: &Archipelago, source: u32) -> bool {
        let interval = archipelago.migration.interval;
        let generation = self.epoch.saturating_add(1).saturating_mul(interval);
        self.island == source
            && self.migrants.len() <= archipelago.migration.migrants
            && self
                .migrants
                .iter()
                .all(|migrant| possible(migrant, archipelago, source, generation).is_ok())
    }
}

/// Whether there can be such an individual on an island by the end of `generation`. Where islands do not wait for each
/// other, who came from elsewhere may be of any generation.
fn possible<G: Gene>(
    individual: &Individual<G>,
    run: &Archipelago,
    index: u32,
    generation: u32,
) -> Result<(), Misfit> {
    let Individual { id, parents, origin, genome, .. } = individual;
    let lengths = 1..=run.strategy.variation.genes_max;
    let is_async = run.migration.exchange == ExchangeMode::Async;
    let was_born = |id: &Id| id.generation <= generation || (is_async && id.island != index);
    let exists = |id: &Id| id.island < run.islands && was_born(id);
    require(lengths.contains(&genome.len()), Misfit::Length)?;
    require(genome.iter().all(Gene::is_valid), Misfit::Gene)?;
    require(*origin <= id.generation, Misfit::Lineage)?;
    require(parents.iter().flatten().chain([id]).all(exists), Misfit::Lineage)
}

fn require(condition: bool, otherwise: Misfit) -> Result<(), Misfit> {
    if condition { Ok(()) } else { Err(otherwise) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::archipelago::tests::toy::{Bit, Toy, archipelago};
    use crate::archipelago::{Migration, lockstep};
    use crate::evolution::cma::Cma;
    use crate::evolution::{Fitness, Learned};

    const GENERATION: u32 = 6;

    fn run() -> Archipelago {
        archipelago(3, 1, Migration { interval: 2, migrants: 1, lag: 0, ..Migration::default() })
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
        let rules: [(Misfit, Break); 18] = [
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
            (Misfit::Lineage, |i| i.champion.origin = i.champion.id.generation + 1),
            (Misfit::Memory, |i| i.memory.amount_scale = f64::NAN),
            (Misfit::Memory, |i| i.memory.learned = Learned::Cma(Box::new(Cma::about(vec![0.5])))),
            (Misfit::Champion, |i| i.population[2].fitness = Fitness::new(999.0)),
            (Misfit::Champion, |i| i.champion.fitness = Fitness::WORST),
            (Misfit::Effort, |i| i.effort.evaluations += 1),
            (Misfit::Effort, |i| i.effort.outcomes = [u64::MAX; 7].into()),
            (Misfit::Effort, |i| i.effort.reused = u64::MAX),
        ];
        let islands = lockstep::run(&Toy, &run(), GENERATION, |_| ());
        for (number, (misfit, break_rule)) in rules.into_iter().enumerate() {
            let mut island = islands[1].clone();
            break_rule(&mut island);
            assert_eq!(island.fits(&run(), 1), Err(misfit), "rule {number}");
        }
    }

    #[test]
    fn an_outbox_that_was_sent_fits_its_sender_and_one_that_breaks_a_rule_does_not() {
        let mut sent = Vec::new();
        lockstep::run(&Toy, &run(), GENERATION, |step| sent.extend(step.outbox.clone()));
        assert!(!sent.is_empty() && sent.iter().all(|outbox| outbox.fits(&run(), outbox.island)));
        type Break = fn(&mut Outbox<Bit>);
        let rules: [Break; 5] = [
            |o| o.island += 1,
            |o| o.migrants.push(o.migrants[0].clone()),
            |o| o.migrants[0].genome[0] = Bit(2),
            |o| o.migrants[0].id.generation = 3 + 2 * o.epoch,
            |o| o.migrants[0].id.island = 3,
        ];
        for break_rule in rules {
            let mut outbox = sent[1].clone();
            break_rule(&mut outbox);
            assert!(!outbox.fits(&run(), sent[1].island), "{outbox:?}");
        }
    }
}
