//! What the islands of a run have written down, read while they write on.

use crate::app::console::say;
use crate::archipelago::{Birth, Births, Champion, Descent, Report};
use crate::evolution::{Gene, Id};
use crate::store::{Entry, Index, RunDir, StoreError, Tail};
use std::cell::RefCell;
use std::path::PathBuf;

/// A generation of an island.
#[derive(Debug, Clone, PartialEq)]
pub struct Sighting<G> {
    /// What it was like.
    pub report: Report,
    /// The champion, if it is a new one.
    pub champion: Option<Champion<G>>,
}

/// The logs of all islands.
#[derive(Debug)]
pub struct Logs<G> {
    islands: Vec<Island<G>>,
}

impl<G: Gene> Logs<G> {
    /// The logs of a run of so many islands, from their beginning.
    pub fn of(dir: &RunDir, islands: u32) -> Self {
        Self { islands: (0..islands).map(|index| Island::of(dir, index)).collect() }
    }

    /// The next generation of each island that has one to show and is not ahead of another one that has; none
    /// if nothing is there by now. So the islands' films grow evenly, and those that are behind go first.
    pub fn next_round(&mut self) -> Vec<Sighting<G>> {
        self.islands.iter_mut().for_each(Island::look);
        let generation =
            |island: &Island<G>| island.next.as_ref().map(|next| next.report.generation);
        let first = self.islands.iter().filter_map(generation).min();
        let those = self.islands.iter_mut().filter(|island| generation(island) == first);
        those.filter_map(Island::take).collect()
    }

    /// How many generations of each island were taken.
    pub fn shown(&self) -> impl Iterator<Item = u32> + '_ {
        self.islands.iter().map(|island| island.generation)
    }
}

/// Who was born of whom, as the islands wrote it down: looked up there when it is asked for, since nobody could keep all
/// births of a long run in memory. What cannot be read is not known.
#[derive(Debug)]
pub struct BirthRecords(Vec<RefCell<Index<Births>>>);

impl BirthRecords {
    /// Those of a run of so many islands.
    pub fn of(dir: &RunDir, islands: u32) -> Self {
        Self((0..islands).map(|island| RefCell::new(Index::of(dir.lineages(island)))).collect())
    }
}

impl Descent for BirthRecords {
    fn recorded(&self, id: Id) -> Option<Birth> {
        let mut births = self.0.get(id.island as usize)?.borrow_mut();
        let births = births.get(id.generation as usize).ok()??;
        births.births.get(id.index as usize).copied()
    }
}

/// The logs of an island.
#[derive(Debug)]
struct Island<G> {
    index: u32,
    /// Where its reports lie.
    path: PathBuf,
    reports: Tail<Entry>,
    champions: Tail<Champion<G>>,
    /// A champion whose generation was not reported yet.
    coming: Option<Champion<G>>,
    /// What was read and not taken.
    next: Option<Sighting<G>>,
    /// The generations that were taken.
    generation: u32,
    is_damaged: bool,
}

impl<G: Gene> Island<G> {
    fn of(dir: &RunDir, index: u32) -> Self {
        Self {
            index,
            path: dir.reports(index),
            reports: Tail::of(dir.reports(index)),
            champions: Tail::of(dir.champions(index)),
            coming: None,
            next: None,
            generation: 0,
            is_damaged: false,
        }
    }

    /// Reads the next generation, if it is there. The film goes on without an island whose log makes no sense.
    fn look(&mut self) {
        if self.next.is_some() || self.is_damaged {
            return;
        }
        match self.read() {
            Ok(next) => self.next = next,
            Err(error) => {
                self.is_damaged = true;
                say(&format!(
                    "warning: {error}; the film shows island {} up to there only",
                    self.index
                ));
            }
        }
    }

    fn read(&mut self) -> Result<Option<Sighting<G>>, StoreError> {
        let Some(Entry { report, .. }) = self.reports.next_record()? else { return Ok(None) };
        if (report.island, report.generation) != (self.index, self.generation) {
            let reason = format!(
                "after {} generations it has generation {} of island {}",
                self.generation, report.generation, report.island
            );
            return Err(StoreError::Damaged { path: self.path.clone(), reason });
        }
        // A generation's champion is written before its report.
        let mut champion = None;
        loop {
            self.coming = match self.coming.take() {
                None => self.champions.next_record()?,
                coming => coming,
            };
            if self.coming.as_ref().is_none_or(|coming| coming.generation > report.generation) {
                if champion.is_none() && report.generation == 0 {
                    let reason = "it has no champion of generation 0".to_owned();
                    return Err(StoreError::Damaged {
                        path: self.champions.path().to_owned(),
                        reason,
                    });
                }
                return Ok(Some(Sighting { report, champion }));
            }
            champion = self.coming.take();
        }
    }

    fn take(&mut self) -> Option<Sighting<G>> {
        let next = self.next.take()?;
        self.generation += 1;
        Some(next)
    }
}
