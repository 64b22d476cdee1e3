//! What must hold of an island's files if they are what a run left.
//!
//! Checksums show what was damaged by chance. These rules show what was changed and given a right checksum, as far
//! as that can be seen without evolving the whole run again.

use crate::archipelago::arrivals::check_record;
use crate::archipelago::{
    Archipelago, Arrivals, Birth, Births, Champion, Emigrants, ExchangeMode, Graph, Island, Outbox,
    Report,
};
use crate::evolution::generation::Effort;
use crate::evolution::population::best;
use crate::evolution::{Fitness, Gene, Id, Memory, Reproduction};
use crate::runs::config::Config;
use crate::runs::subject::Subject;
use crate::store::{Checkpoint, Entry};
use std::ops::RangeInclusive;

/// The run that the files must be of.
pub struct Terms<'a> {
    /// Its configuration, checked.
    pub config: &'a Config,
    /// Whether it has come to its end: then its logs are complete.
    pub finished: bool,
    /// Whether its champions were tried on fresh trials.
    pub is_validated: bool,
    /// Whether offspring may have estimates instead of whole scores.
    pub has_estimates: bool,
    archipelago: Archipelago,
    graph: Graph,
    settings: String,
}

impl<'a> Terms<'a> {
    /// The terms of a run that was launched.
    pub fn new<P: Subject>(config: &'a Config, finished: bool, problem: &P) -> Self {
        let (is_validated, has_estimates) = (P::HAS_BODIES, problem.has_estimates());
        let (archipelago, settings) = (config.archipelago(), config.settings_of(config.version()));
        let graph = archipelago.graph();
        Self { config, finished, is_validated, has_estimates, archipelago, graph, settings }
    }

    /// Whether this version of the program made it; another one may write the same otherwise.
    pub fn is_of_this_version(&self) -> bool {
        self.config.version() == env!("CARGO_PKG_VERSION")
    }

    /// How many records a log may have that has `of(g)` of them after generation g: all of a finished run, else
    /// at least those that the island's state needs.
    pub fn span<G>(
        &self,
        state: Option<&Island<G>>,
        of: impl Fn(usize) -> usize,
    ) -> RangeInclusive<usize> {
        let all = of(self.config.generations as usize);
        match self.finished {
            true => all..=all,
            false => state.map_or(0, |state| of(state.generation as usize))..=all,
        }
    }

    /// What must hold of a checkpoint, but for its place and its checksum.
    pub fn state<G: Gene>(&self, checkpoint: &Checkpoint<G>) -> Result<(), String> {
        let Checkpoint { settings, island } = checkpoint;
        let generations = self.config.generations;
        if *settings != self.settings {
            return Err("it was saved under other settings than those in run.toml".to_owned());
        }
        if island.generation > generations {
            return Err(format!("the run ends with generation {generations}"));
        }
        island.fits(&self.archipelago, island.index).map_err(|misfit| misfit.to_string())
    }

    /// What must hold of an island's reports.
    pub fn reports<G>(
        &self,
        island: u32,
        entries: &[Entry],
        state: Option<&Island<G>>,
    ) -> Result<(), String> {
        for (generation, entry) in (0..).zip(entries) {
            self.report(island, generation, entry)
                .map_err(|reason| format!("the report of generation {generation} {reason}"))?;
        }
        let Some(state) = state else { return Ok(()) };
        let lived = &entries[..entries.len().min(state.generation as usize + 1)];
        let Some(last) = lived.last() else { return Ok(()) };
        let effort =
            lived.iter().fold(Effort::default(), |sum, entry| sum.and(entry.report.effort));
        let best = best(&state.population).map(|best| best.fitness);
        if effort != state.effort || best != Some(last.report.statistics.best) {
            let generation = state.generation;
            return Err(format!("it disagrees with the checkpoint of generation {generation}"));
        }
        Ok(())
    }

    fn report(&self, island: u32, generation: u32, entry: &Entry) -> Result<(), String> {
        let report = &entry.report;
        let wrong = |reason: &str| Err(reason.to_owned());
        if (report.island, report.generation) != (island, generation) {
            return wrong("is of another island or generation");
        }
        let broods = self.broods(generation);
        let Effort { evaluations, reused, outcomes } = report.effort;
        let ended = outcomes.total();
        let tried = evaluations.checked_add(reused).and_then(|it| usize::try_from(it).ok());
        if !tried.is_some_and(|tried| broods.contains(&tried)) || ended != Some(evaluations) {
            return wrong("counts evaluations that cannot have been");
        }
        let senders = self.graph.in_neighbours(island).len();
        let immigrants = match self.archipelago.migration.immigration(generation) {
            // What arrived is on record.
            _ if self.is_async() => report.immigrants as usize,
            Some(_) => senders * self.archipelago.migration.migrants,
            None => 0,
        };
        let found = report.immigrants as usize;
        if found > immigrants || (!self.is_map() && found < immigrants) {
            return wrong("counts immigrants that cannot have been");
        }
        if !entry.seconds.is_finite() || entry.seconds < 0.0 {
            return wrong("took no time that there is");
        }
        Ok(())
    }

    /// What must hold of those who were born on an island.
    pub fn lineages<G>(
        &self,
        island: u32,
        lineages: &[Births],
        entries: &[Entry],
        state: Option<&Island<G>>,
    ) -> Result<(), String> {
        for (generation, births) in (0..).zip(lineages) {
            self.births([island, generation], births, entries.get(generation as usize))
                .map_err(|reason| format!("what it says of generation {generation} {reason}"))?;
        }
        let Some(state) = state else { return Ok(()) };
        let travels = self.has_estimates
            && self.archipelago.migration.migrants > 0
            && self.archipelago.islands > 1;
        let mut natives = state.population.iter().filter(|one| one.id.island == state.index);
        let is_right = natives.all(|one| {
            let births = lineages.get(one.id.generation as usize);
            let birth = births.and_then(|births| births.births.get(one.id.index as usize));
            // Who has been away has come home with a whole score instead of an estimate.
            let is_right = |birth: &Birth| {
                birth.parents == one.parents && (birth.fitness == one.fitness || travels)
            };
            birth.is_some_and(is_right)
        });
        match is_right {
            true => Ok(()),
            false => {
                Err(format!("it disagrees with the checkpoint of generation {}", state.generation))
            }
        }
    }

    fn births(
        &self,
        [island, generation]: [u32; 2],
        found: &Births,
        entry: Option<&Entry>,
    ) -> Result<(), String> {
        let wrong = |reason: &str| Err(reason.to_owned());
        let Config { population, islands, .. } = *self.config;
        let adaptation = self.archipelago.strategy.adaptation;
        let is_scale = Memory::is_scale(found.amount_scale, adaptation);
        let has_size = self.broods(generation).contains(&found.births.len());
        if found.generation != generation || !has_size || !is_scale {
            return wrong("is of another generation or size");
        }
        let is_older =
            |id: Id| id.generation < generation || (self.is_async() && id.island != island);
        let lived =
            |id: Id| is_older(id) && id.island < islands && (id.index as usize) < population;
        let can_be = |birth: &Birth| match birth.parents {
            [None, None] => generation == 0 || self.has_newcomers(),
            [Some(mother), None] => lived(mother),
            [Some(mother), Some(father)] => lived(mother) && lived(father),
            [None, Some(_)] => false,
        };
        if !found.births.iter().all(can_be) {
            return wrong("names parents that cannot have been");
        }
        let best = found.births.iter().map(|birth| birth.fitness).max();
        let Some(lived) = entry.map(|entry| entry.report.statistics.best) else { return Ok(()) };
        if best > Some(lived) || (!self.keeps_some() && best != Some(lived)) {
            return wrong("disagrees with its report");
        }
        Ok(())
    }

    /// What must hold of an island's champions.
    pub fn champions<G: Gene>(
        &self,
        champions: &[Champion<G>],
        entries: &[Entry],
        state: Option<&Island<G>>,
    ) -> Result<(), String> {
        if champions.first().is_some_and(|first| first.generation != 0) {
            return Err("its first champion is not of generation 0".to_owned());
        }
        let is_validated = self.is_validated;
        if champions.iter().any(|champion| champion.validated.is_some() != is_validated) {
            return Err(match is_validated {
                true => "it has a champion that was not tried on fresh trials".to_owned(),
                false => "it has a champion that was tried on fresh trials, as none of this run is"
                    .to_owned(),
            });
        }
        for pair in champions.windows(2) {
            let [before, after] = [&pair[0], &pair[1]];
            let is_later = after.generation > before.generation;
            if !is_later || after.individual.fitness <= before.individual.fitness {
                return Err(format!(
                    "the champion of generation {} is followed by one that is not later and better",
                    before.generation
                ));
            }
        }
        let Some(state) = state else { return Ok(()) };
        let reigning = reign(champions, state.generation).map(|champion| &champion.individual);
        if reigning != Some(&state.champion) {
            return Err(format!(
                "it lacks the champion in the checkpoint of generation {}",
                state.generation
            ));
        }
        let mut lived = entries.iter().take(state.generation as usize + 1);
        lived.try_for_each(|entry| self.reigns_rightly(champions, entry))
    }

    /// A champion is at least as good as everybody who lived; where elites live on, the best of the population
    /// is as good as it. Without them an immigrant may be better for a moment and leave no such offspring.
    fn reigns_rightly<G: Gene>(
        &self,
        champions: &[Champion<G>],
        entry: &Entry,
    ) -> Result<(), String> {
        let generation = entry.report.generation;
        let best = entry.report.statistics.best;
        let champion =
            reign(champions, generation).map_or(Fitness::WORST, |reign| reign.individual.fitness);
        if champion < best || (self.keeps_its_best() && champion > best) {
            return Err(format!("it disagrees with the report of generation {generation}"));
        }
        Ok(())
    }

    /// How many can be born in a generation: where there are species, fewer by those whose champions live on.
    fn broods(&self, generation: u32) -> RangeInclusive<usize> {
        let strategy = &self.archipelago.strategy;
        match generation {
            0 => strategy.population..=strategy.population,
            _ if strategy.species_radius().is_some() => 0..=strategy.brood(),
            _ => strategy.brood()..=strategy.brood(),
        }
    }

    /// Whether the population is a map, which may have fewer individuals than are to be sent.
    fn is_map(&self) -> bool {
        self.archipelago.strategy.survival.has_cells()
    }

    /// Whether somebody without parents may be born after generation 0.
    fn has_newcomers(&self) -> bool {
        let strategy = &self.archipelago.strategy;
        strategy.survival.newcomers() > 0 || strategy.reproduction != Reproduction::Parents
    }

    /// Whether somebody of a population lives on.
    fn keeps_some(&self) -> bool {
        self.keeps_its_best() || self.archipelago.strategy.species_radius().is_some()
    }

    /// Whether the best of a population lives on.
    fn keeps_its_best(&self) -> bool {
        let strategy = &self.archipelago.strategy;
        let is_steady = !strategy.survival.has_elites();
        strategy.species_radius().is_none() && (strategy.elites > 0 || is_steady)
    }

    /// Whether its islands do not wait for each other.
    pub fn is_async(&self) -> bool {
        self.config.exchange == ExchangeMode::Async
    }

    /// Whether offspring are drawn from a distribution, so that nobody descends from anybody.
    pub fn is_drawn(&self) -> bool {
        self.archipelago.strategy.reproduction == Reproduction::CmaEs
    }

    /// What must hold of the record of what an island took in, but for the senders' journals.
    pub fn arrivals(
        &self,
        island: u32,
        record: &[Arrivals],
        entries: &[Entry],
    ) -> Result<(), String> {
        check_record(record, &self.archipelago, island)?;
        for entry in entries {
            let Report { generation, immigrants, .. } = entry.report;
            let epoch = self.archipelago.migration.beginning(generation);
            let arrivals = epoch.and_then(|epoch| record.get(epoch as usize));
            let outboxes = arrivals.map_or(0, |arrivals| arrivals.taken.len());
            let sent = outboxes * self.archipelago.migration.migrants;
            let found = immigrants as usize;
            if found > sent || (!self.is_map() && found < sent) {
                return Err(format!("it disagrees with the report of generation {generation}"));
            }
        }
        Ok(())
    }

    /// How many epochs an island has begun by the end of a generation.
    pub fn begun(&self, generation: usize) -> usize {
        generation.div_ceil(self.config.migration_interval as usize)
    }

    /// How many outboxes an island has sent by the end of a generation.
    pub fn epochs(&self, generation: usize) -> usize {
        generation / self.config.migration_interval as usize
    }

    /// What must hold of an island's journal.
    pub fn outboxes<G: Gene>(
        &self,
        island: u32,
        outboxes: &[Outbox<G>],
        entries: &[Entry],
    ) -> Result<(), String> {
        for (epoch, outbox) in (0..).zip(outboxes) {
            let wrong = |reason: &str| Err(format!("the outbox of epoch {epoch} {reason}"));
            if (outbox.island, outbox.epoch) != (island, epoch) {
                return wrong("is of another island or epoch");
            }
            let fitness: Vec<Fitness> = outbox.migrants.iter().map(|m| m.fitness).collect();
            let are_in_order = fitness.is_sorted_by(|a, b| a >= b);
            let can_be_sent = outbox.fits(&self.archipelago, island);
            let are_all = fitness.len() == self.archipelago.migration.migrants || self.is_map();
            if !are_all || !are_in_order || !can_be_sent {
                return wrong("holds migrants that cannot have been sent");
            }
            let generation = (epoch as usize + 1) * self.config.migration_interval as usize;
            let best = entries.get(generation).map(|entry| entry.report.statistics.best);
            let sends_the_best = self.config.emigrants == Emigrants::Best;
            // Whoever else is sent may turn out to be better than its estimate, or, without elites, worse.
            let is_right = |first: Fitness, best: Fitness| match self.has_estimates {
                true => !self.keeps_its_best() || first >= best,
                false => first == best,
            };
            if let (Some(best), Some(&first)) = (best, fitness.first())
                && sends_the_best
                && !is_right(first, best)
            {
                return wrong(&format!("disagrees with the report of generation {generation}"));
            }
        }
        Ok(())
    }
}

/// The champion at the end of a generation; they must be in order.
fn reign<G>(champions: &[Champion<G>], generation: u32) -> Option<&Champion<G>> {
    let after = champions.partition_point(|champion| champion.generation <= generation);
    champions[..after].last()
}
