//! All that an island leaves on disk, and how it finds its way back from there.
//!
//! The order of writing is what makes any moment a good one to die: first a generation's champion, births
//! and report and the outbox that it sends, each durable before the next, then the checkpoint that needs them. So a
//! checkpoint never knows more than the logs, and what the logs know beyond it is evolved again, the same. Where
//! islands do not wait for each other, what they took in is recorded before a generation is evolved with it.

use super::checkpoint::Checkpoint;
use super::entry::Entry;
use super::{Checkpoints, Journal, RecordLog, RunDir, StoreError};
use crate::archipelago::arrivals::check_record;
use crate::archipelago::{
    Archipelago, Arrivals, Births, Champion, ExchangeMode, Island, Outbox, Step,
};
use crate::evolution::Gene;
use std::path::Path;

/// An island's files, open for writing; nobody else writes them.
#[derive(Debug)]
pub struct Logbook<G> {
    settings: String,
    checkpoints: Checkpoints,
    journal: Journal<G>,
    champions: RecordLog<Champion<G>>,
    lineages: RecordLog<Births>,
    reports: RecordLog<Entry>,
    /// What it took in, where that is recorded.
    arrivals: Option<RecordLog<Arrivals>>,
}

/// What an island begins with.
#[derive(Debug)]
pub struct Restored<G> {
    /// Its files, cut back to where it begins.
    pub logbook: Logbook<G>,
    /// The state that it goes on from; none if it begins from the seed.
    pub island: Option<Island<G>>,
    /// All that it ever took in, where that is recorded, which it may have yet to evolve with again.
    pub arrivals: Vec<Arrivals>,
    /// What was damaged, a sentence each.
    pub warnings: Vec<String>,
}

impl<G: Gene> Logbook<G> {
    /// Opens the files of island `index` of the run in `dir` and finds the newest state that is whole and that
    /// the logs know all about. Without one the island begins from the seed, and comes to the same.
    ///
    /// # Errors
    /// If a file cannot be opened, a checkpoint is of another version or of other settings, or the record of what it
    /// took in lacks what it has evolved with: then it cannot come to the same again.
    pub fn open(
        dir: &RunDir,
        archipelago: &Archipelago,
        index: u32,
        settings: &str,
    ) -> Result<Restored<G>, StoreError> {
        let journal = Journal::open(&dir.migrations(index))?;
        let (arrivals, recorded) = open_arrivals(dir, archipelago, index, journal.epochs())?;
        let mut logbook = Self {
            settings: settings.to_owned(),
            checkpoints: Checkpoints::of(dir, index),
            journal,
            arrivals,
            champions: RecordLog::open(&dir.champions(index))?,
            lineages: RecordLog::open(&dir.lineages(index))?,
            reports: RecordLog::open(&dir.reports(index))?,
        };
        let (island, warnings) = logbook.newest_state(archipelago)?;
        if let Some(island) = &island {
            logbook.checkpoints.remove_older_than(island.generation)?;
        }
        logbook.cut_back_to(island.as_ref().map(|island| island.generation))?;
        Ok(Restored { logbook, island, arrivals: recorded, warnings })
    }

    /// Records a generation, and journals the outbox that it sends, which may be sent only then.
    ///
    /// # Errors
    /// If the disk is full or gone, or an epoch that is evolved again comes out otherwise.
    pub fn record(&mut self, step: &Step<G>, seconds: f64) -> Result<(), StoreError> {
        step.champion.iter().try_for_each(|champion| self.champions.append(champion))?;
        self.lineages.append(&step.births)?;
        self.reports.append(&Entry { report: step.report, seconds })?;
        step.outbox.iter().try_for_each(|outbox| self.journal.append(outbox))
    }

    /// Records what the island takes in: do this before it is evolved with.
    ///
    /// # Errors
    /// If the disk is full or gone.
    pub fn record_arrivals(&mut self, arrivals: &Arrivals) -> Result<(), StoreError> {
        self.arrivals.iter_mut().try_for_each(|log| log.append(arrivals))
    }

    /// Saves a state whose generation was recorded.
    ///
    /// # Errors
    /// If the disk is full or gone.
    pub fn save(&self, island: &Island<G>) -> Result<(), StoreError> {
        let (settings, island) = (self.settings.clone(), island.clone());
        self.checkpoints.save(&Checkpoint { settings, island })
    }

    /// The epochs that were sent so far: those below this one.
    pub fn epochs(&self) -> u32 {
        self.journal.epochs()
    }

    /// What was sent at the end of an epoch.
    ///
    /// # Errors
    /// If the journal cannot be read.
    pub fn outbox(&self, epoch: u32) -> Result<Option<Outbox<G>>, StoreError> {
        self.journal.outbox(epoch)
    }

    /// The newest state that is sound, and what is wrong with those that are not.
    fn newest_state(
        &self,
        archipelago: &Archipelago,
    ) -> Result<(Option<Island<G>>, Vec<String>), StoreError> {
        let mut warnings = Vec::new();
        for (path, checkpoint) in self.checkpoints.load()? {
            let island = checkpoint.and_then(|found| self.sound(&path, found, archipelago));
            match island {
                Ok(island) => return Ok((Some(island), warnings)),
                Err(error @ (StoreError::Version { .. } | StoreError::Foreign { .. })) => {
                    return Err(error);
                }
                Err(error) => warnings.push(error.to_string()),
            }
        }
        // Who died over its first generation has a report of it and no checkpoint: nothing is lost.
        if !warnings.is_empty() || self.reports.len() > 1 {
            warnings.push("no checkpoint is of use: it starts again from the seed".to_owned());
        }
        Ok((None, warnings))
    }

    /// The state of a checkpoint, if it is one of this island and the logs know all that led to it.
    fn sound(
        &self,
        path: &Path,
        checkpoint: Checkpoint<G>,
        archipelago: &Archipelago,
    ) -> Result<Island<G>, StoreError> {
        let Checkpoint { settings, island } = checkpoint;
        if settings != self.settings {
            return Err(StoreError::Foreign { path: path.to_owned() });
        }
        let damaged = |reason: String| StoreError::damaged(path, reason);
        island.fits(archipelago, island.index).map_err(|misfit| damaged(misfit.to_string()))?;
        let generation = island.generation;
        let lacks = |log: &str| {
            Err(damaged(format!(
                "it is whole, but the island's {log} do not reach generation {generation}"
            )))
        };
        if self.reports.len() <= generation as usize {
            return lacks("reports");
        }
        if self.lineages.len() <= generation as usize {
            return lacks("lineages");
        }
        if self.journal.epochs() < generation / archipelago.migration.interval {
            return lacks("migrations");
        }
        let begun = archipelago.migration.begun(generation) as usize;
        if self.arrivals.as_ref().is_some_and(|log| log.len() < begun) {
            return lacks("arrivals");
        }
        let champion = self.champions.last_that(|champion| champion.generation <= generation)?;
        match champion {
            Some((_, champion)) if champion.individual == island.champion => Ok(island),
            _ => lacks("champions"),
        }
    }

    /// Cuts off what was recorded after a generation, or everything but the journal: what was sent was sent,
    /// and will come out the same.
    fn cut_back_to(&mut self, generation: Option<u32>) -> Result<(), StoreError> {
        let is_kept = |of: u32| generation.is_some_and(|generation| of <= generation);
        let champions = self.champions.last_that(|champion| is_kept(champion.generation))?;
        self.champions.truncate(champions.map_or(0, |(last, _)| last + 1))?;
        let generations = generation.map_or(0, |generation| generation as usize + 1);
        self.lineages.truncate(generations)?;
        self.reports.truncate(generations)
    }
}

/// Opens what an island took in, where that is recorded, and reads it. It must reach as far as what the island has
/// sent, or it is left as it is: somebody may be able to mend it.
fn open_arrivals(
    dir: &RunDir,
    archipelago: &Archipelago,
    index: u32,
    sent: u32,
) -> Result<(Option<RecordLog<Arrivals>>, Vec<Arrivals>), StoreError> {
    if archipelago.migration.exchange == ExchangeMode::Sync {
        return Ok((None, Vec::new()));
    }
    let path = dir.arrivals(index);
    let recorded = RecordLog::<Arrivals>::read(&path)?.records;
    let damaged = |reason: String| StoreError::damaged(&path, reason);
    check_record(&recorded, archipelago, index).map_err(damaged)?;
    if recorded.len() < sent as usize {
        return Err(damaged(format!(
            "it does not say what epoch {} took in, which the island has sent already: it cannot be evolved again",
            recorded.len()
        )));
    }
    Ok((Some(RecordLog::open(&path)?), recorded))
}
