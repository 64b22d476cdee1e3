//! When whose family is shown.

use super::logs::BirthRecords;
use crate::app::ancestry_text::AncestryText;
use crate::archipelago::{Champion, Report};
use crate::evolution::{Fitness, Id};
use crate::runs::subject::Subject;
use crate::view::{Family, Pace};

/// Shows, whenever a slot of the film opens, the family of the best champion that there is in its generation, once
/// all islands have come so far: whoever films, the families are the same.
pub struct Ancestry<P> {
    ancestry_text: AncestryText<P>,
    pace: Pace,
    births: BirthRecords,
    /// The champions of each island: generation, who, and how good.
    champions: Vec<Vec<(u32, Id, Fitness)>>,
    /// The generations of each island that are known.
    known: Vec<u32>,
    /// The next slot.
    slot: u32,
    shown: Option<Id>,
}

impl<P: Subject> Ancestry<P> {
    /// Knows nobody.
    pub fn new(
        ancestry_text: AncestryText<P>,
        births: BirthRecords,
        islands: u32,
        pace: Pace,
    ) -> Self {
        Self {
            ancestry_text,
            pace,
            births,
            champions: vec![Vec::new(); islands as usize],
            known: vec![0; islands as usize],
            slot: 0,
            shown: None,
        }
    }

    /// Takes in a generation of an island.
    pub fn learn(&mut self, report: &Report, champion: Option<&Champion<P::Gene>>) {
        let island = report.island as usize;
        if let Some(champion) = champion {
            let (id, standing) = (champion.individual.id, champion.individual.fitness);
            self.champions[island].push((champion.generation, id, standing));
        }
        self.known[island] = report.generation + 1;
    }

    /// The next family to show, with its film time in seconds and its generation; call until there is none. When
    /// the run is over, so is the film, with the family of its best.
    pub fn next(&mut self, is_over: bool) -> Option<(f64, u32, Family)> {
        let known = self.known.iter().copied().min().unwrap_or(0);
        loop {
            let slot = self.slot;
            let generation = slot.saturating_mul(self.pace.generations_per_slot);
            let is_last = is_over && generation >= known && known > 0;
            if generation >= known && !is_last {
                return None;
            }
            self.slot = if is_last { u32::MAX } else { slot + 1 };
            let generation = generation.min(known - 1);
            let start_s = f64::from(slot) * self.pace.slot_s;
            let best = self.best(generation).filter(|&best| Some(best) != self.shown);
            if let (Some(id), true) = (best, slot < u32::MAX) {
                self.shown = Some(id);
                let family = self.ancestry_text.family(&self.births, id);
                return Some((start_s, generation, family));
            }
            if is_last || slot == u32::MAX {
                return None;
            }
        }
    }

    /// The best champion of a generation, of equal ones that of the first island.
    fn best(&self, generation: u32) -> Option<Id> {
        let reigning = self.champions.iter().filter_map(|champions| {
            champions.iter().rev().find(|(since, ..)| *since <= generation)
        });
        let best = reigning.reduce(|best, next| if next.2 > best.2 { next } else { best });
        best.map(|&(_, id, _)| id)
    }
}
