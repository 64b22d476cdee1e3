//! What is new of an island, kept until the film has a row for it: in a long run not every generation has one.

use super::logs::Sighting;
use crate::archipelago::Champion;
use crate::evolution::Gene;
use crate::view::Mood;

/// An island without a better champion for so many generations stagnates.
const STAGNANT: u32 = 5;

/// What is to be told of an island since the last time.
pub struct News<G> {
    /// The generation that it has come to.
    pub generation: u32,
    /// Who came from elsewhere.
    pub immigrants: u32,
    /// The exchanges in which they came.
    pub exchanges: u32,
    /// The newest champion, if there is a new one.
    pub champion: Option<Champion<G>>,
    /// How many there were.
    pub champions: u32,
    /// How it fares, if that has changed.
    pub mood: Option<Mood>,
    /// The generation of its newest champion.
    reigns_since: u32,
}

impl<G: Gene> News<G> {
    /// Nothing new.
    pub fn none() -> Self {
        Self {
            generation: 0,
            immigrants: 0,
            exchanges: 0,
            champion: None,
            champions: 0,
            mood: None,
            reigns_since: 0,
        }
    }

    /// Takes in a generation.
    pub fn learn(&mut self, sighting: &Sighting<G>) {
        let Sighting { report, champion } = sighting;
        self.generation = report.generation;
        self.immigrants = self.immigrants.saturating_add(report.immigrants);
        self.exchanges += u32::from(report.immigrants > 0);
        match champion {
            Some(champion) => {
                let is_foreign = champion.individual.id.island != report.island;
                self.mood = Some(if is_foreign { Mood::IsConquered } else { Mood::Improves });
                self.champion = Some(champion.clone());
                self.champions += 1;
                self.reigns_since = report.generation;
            }
            None if report.generation == self.reigns_since + STAGNANT => {
                self.mood = Some(Mood::Stagnates);
            }
            None => {}
        }
    }

    /// What there is, which is then no news any more.
    pub fn take(&mut self) -> Self {
        let Self { generation, reigns_since, .. } = *self;
        std::mem::replace(self, Self { generation, reigns_since, ..Self::none() })
    }
}
