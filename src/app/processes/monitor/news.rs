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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::archipelago::Report;
    use crate::creature;
    use crate::evolution::generation::Effort;
    use crate::evolution::population::Statistics;
    use crate::evolution::{Fitness, Id, Individual, Spread};

    /// A generation of island 1 with so many immigrants, and a new champion that was born on an island if there is one.
    fn sighting(
        generation: u32,
        immigrants: u32,
        born_on: Option<u32>,
    ) -> Sighting<creature::Gene> {
        let statistics = Statistics {
            best: Fitness::new(1.0),
            mean: Fitness::new(0.5),
            median: Fitness::new(0.5),
            diversity: 0.5,
            phenotype_diversity: 0.5,
            spread: Spread::of(&[]),
        };
        let report = Report {
            island: 1,
            generation,
            statistics,
            effort: Effort::default(),
            immigrants,
            species: 0,
        };
        let champion = born_on.map(|island| Champion {
            generation,
            individual: Individual {
                id: Id { island, generation, index: 0 },
                parents: [None; 2],
                origin: 0,
                genome: Vec::new(),
                fitness: Fitness::new(1.0),
            },
            validated: None,
        });
        Sighting { report, champion }
    }

    #[test]
    fn what_is_not_told_at_once_is_counted_until_it_is() {
        let mut news = News::none();
        for (generation, immigrants, born_on) in
            [(0, 0, Some(1)), (1, 2, None), (2, 0, Some(0)), (3, 3, Some(1)), (4, 0, None)]
        {
            news.learn(&sighting(generation, immigrants, born_on));
        }
        let told = news.take();
        assert_eq!((told.generation, told.immigrants, told.exchanges), (4, 5, 2));
        assert_eq!((told.champions, told.champion.map(|it| it.generation)), (3, Some(3)));
        assert_eq!(told.mood, Some(Mood::Improves));
        let nothing = news.take();
        assert_eq!((nothing.generation, nothing.immigrants, nothing.exchanges), (4, 0, 0));
        assert!(nothing.champion.is_none() && nothing.champions == 0 && nothing.mood.is_none());
        (5..=8).for_each(|generation| news.learn(&sighting(generation, 0, None)));
        assert_eq!(news.take().mood, Some(Mood::Stagnates), "five generations after the champion");
        news.learn(&sighting(9, 0, Some(0)));
        assert_eq!(news.take().mood, Some(Mood::IsConquered));
    }
}
