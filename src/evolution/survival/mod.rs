//! Who lives on.

pub mod afpo;
pub mod crowding;
pub mod map_elites;
pub mod niching;

use super::individual::Individual;
use super::population::{Population, ranking};
use super::problem::Problem;
use crate::choice;
use crate::rng::Stream;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// How the next population is made of the old one and its offspring.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub enum Survival {
    /// [`elitist`]: the offspring replace all but the elites.
    Generational,
    /// The same, but of equally good ones the youngest counts as the best: what changes nothing stays, so that search
    /// drifts over what is flat (Kimura 1968; plateaus of a (1 + λ): Jansen & Wegener 2001).
    Drifting,
    /// As generational, but parents are picked by their [`niching::shared`] fitness.
    Sharing {
        /// The distance from which on two individuals share nothing, above 0, at most 1.
        radius: f64,
    },
    /// [`crowding::crowd`]: an offspring replaces the parent that is more like it, if it is better.
    Crowding,
    /// [`afpo::pareto`]: age-fitness Pareto optimisation, with one random newcomer a generation.
    Afpo,
    /// [`map_elites::fill`]: the population is the best of each cell of a map of features.
    MapElites {
        /// Cells along each of the two features, 2 to [`map_elites::BINS_MAX`].
        bins: u32,
    },
}

impl fmt::Display for Survival {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Survival::Generational => write!(f, "generational"),
            Survival::Drifting => write!(f, "drifting"),
            Survival::Sharing { radius } => write!(f, "sharing:{radius}"),
            Survival::Crowding => write!(f, "crowding"),
            Survival::Afpo => write!(f, "afpo"),
            Survival::MapElites { bins } => write!(f, "map-elites:{bins}"),
        }
    }
}

impl FromStr for Survival {
    type Err = String;

    /// Reads what `Display` writes; without its number a scheme takes its usual one.
    fn from_str(text: &str) -> Result<Self, String> {
        let scheme = choice::Scheme::of(text);
        match scheme.name {
            "generational" => scheme.plain(Survival::Generational),
            "drifting" => scheme.plain(Survival::Drifting),
            "sharing" => Ok(Survival::Sharing { radius: scheme.number(0.1, 1e-6, 1.0)? }),
            "crowding" => scheme.plain(Survival::Crowding),
            "afpo" => scheme.plain(Survival::Afpo),
            "map-elites" => {
                Ok(Survival::MapElites { bins: scheme.whole(8, 2, map_elites::BINS_MAX)? })
            }
            _ => Err(scheme.unknown(
                "survival",
                "generational, drifting, sharing:0.1, crowding, afpo or map-elites:8",
            )),
        }
    }
}

choice::as_text!(Survival);

impl Survival {
    /// The next population: `old` is the one whose offspring `brood` is. The stream is drawn from by those that leave it
    /// to chance who dies.
    pub fn survivors<P: Problem>(
        self,
        problem: &P,
        old: &[Individual<P::Gene>],
        brood: Population<P::Gene>,
        elites: usize,
        rng: &mut Stream,
    ) -> Population<P::Gene> {
        match self {
            Survival::Generational | Survival::Sharing { .. } => elitist(old, brood, elites),
            Survival::Drifting => brood.into_iter().chain(elite(old, elites)).collect(),
            Survival::Crowding => crowding::crowd(problem, old, brood),
            Survival::Afpo => afpo::pareto(old, brood, rng),
            Survival::MapElites { bins } => {
                map_elites::fill(problem, bins, old.iter().cloned().chain(brood))
            }
        }
    }

    /// Whether the best of the old population are kept as elites. Elsewhere all of it lives on as far as the new one is no
    /// better.
    pub fn has_elites(self) -> bool {
        !matches!(self, Survival::Crowding | Survival::Afpo | Survival::MapElites { .. })
    }

    /// Whether parents are picked as [`Selection`](super::Selection) says. Elsewhere it is survival that selects.
    pub fn selects_parents(self) -> bool {
        self.has_elites()
    }
}

/// Generational replacement with elitism (De Jong 1975): the best `elites` of the old population,
/// unchanged and first, then the offspring.
pub fn elitist<G: Clone>(
    old: &[Individual<G>],
    offspring: Population<G>,
    elites: usize,
) -> Population<G> {
    elite(old, elites).chain(offspring).collect()
}

/// The best of a population; of equal ones the first.
fn elite<G: Clone>(
    population: &[Individual<G>],
    elites: usize,
) -> impl Iterator<Item = Individual<G>> {
    ranking(population).into_iter().take(elites).map(|index| population[index].clone())
}

#[cfg(test)]
mod tests;
