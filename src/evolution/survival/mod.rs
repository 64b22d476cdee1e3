//! Who lives on: each [scheme](scheme::Scheme) is a file, and all that it changes of a generation is in it. Here they
//! are listed, by the names that they are chosen by.

pub mod afpo;
pub mod crowding;
pub mod elitist;
pub mod map_elites;
pub mod scheme;
pub mod sharing;
pub mod species;

use super::individual::Individual;
use super::population::Population;
use super::problem::Problem;
use super::selection::Selection;
use crate::choice;
use crate::rng::Stream;
use scheme::Scheme;
use serde::{Deserialize, Serialize};
use std::ops::RangeInclusive;
use std::str::FromStr;
use strum::EnumCount;

/// How the next population is made of the old one and its offspring.
#[derive(
    Debug, Clone, Copy, PartialEq, Serialize, Deserialize, strum::Display, strum::EnumCount,
)]
#[strum(serialize_all = "kebab-case")]
#[serde(try_from = "String", into = "String")]
pub enum Survival {
    /// [`elitist::Generational`]: the offspring replace all but the elites.
    Generational,
    /// The same, but of equally good ones the youngest counts as the best: what changes nothing stays, so that search
    /// drifts over what is flat (Kimura 1968; plateaus of a (1 + λ): Jansen & Wegener 2001).
    Drifting,
    /// As generational, but parents are picked by their [`sharing::shared`] fitness.
    #[strum(to_string = "sharing:{radius}")]
    Sharing {
        /// The distance from which on two individuals share nothing, above 0, at most 1.
        radius: f64,
    },
    /// [`species::Species`]: who is alike shares its fitness, and the best of each large species lives on.
    #[strum(to_string = "species:{radius}")]
    Species {
        /// The distance ([`Problem::compatibility`]) from which on two individuals are of different species, above 0.
        radius: f64,
    },
    /// [`crowding::crowd`]: an offspring replaces the parent that is more like it, if it is better.
    Crowding,
    /// [`afpo::pareto`]: age-fitness Pareto optimisation, with one random newcomer a generation.
    Afpo,
    /// [`map_elites::fill`]: the population is the best of each cell of a map of features.
    #[strum(to_string = "map-elites:{bins}")]
    MapElites {
        /// Cells along each of the two features, 2 to [`map_elites::BINS_MAX`].
        bins: u32,
    },
}

impl FromStr for Survival {
    type Err = String;

    /// Reads what `Display` writes; without its number a scheme takes its usual one.
    fn from_str(text: &str) -> Result<Self, String> {
        let (usual, scheme) = choice::Scheme::of("survival", &Self::USUAL, text)?;
        match usual {
            Survival::Sharing { radius } => {
                Ok(Survival::Sharing { radius: scheme.number(radius, 1e-6, 1.0)? })
            }
            Survival::Species { radius } => {
                Ok(Survival::Species { radius: scheme.number(radius, 1e-6, 1e6)? })
            }
            Survival::MapElites { bins } => {
                Ok(Survival::MapElites { bins: scheme.whole(bins, 2, map_elites::BINS_MAX)? })
            }
            plain => scheme.plain(plain),
        }
    }
}

choice::as_text!(Survival);

/// Does something with the scheme that is chosen.
macro_rules! with {
    ($survival:expr, $scheme:ident => $done:expr) => {
        match $survival {
            Survival::Generational => with!(@ $scheme = elitist::Generational => $done),
            Survival::Drifting => with!(@ $scheme = elitist::Drifting => $done),
            Survival::Sharing { radius } => with!(@ $scheme = sharing::Sharing { radius } => $done),
            Survival::Species { radius } => with!(@ $scheme = species::Divided { radius } => $done),
            Survival::Crowding => with!(@ $scheme = crowding::Crowding => $done),
            Survival::Afpo => with!(@ $scheme = afpo::Afpo => $done),
            Survival::MapElites { bins } => with!(@ $scheme = map_elites::MapElites { bins } => $done),
        }
    };
    (@ $scheme:ident = $chosen:expr => $done:expr) => {{
        let $scheme = $chosen;
        $done
    }};
}

impl Survival {
    /// One of every kind, with its usual number.
    pub const USUAL: [Survival; Survival::COUNT] = [
        Survival::Generational,
        Survival::Drifting,
        Survival::Sharing { radius: 0.1 },
        Survival::Species { radius: 3.0 },
        Survival::Crowding,
        Survival::Afpo,
        Survival::MapElites { bins: 8 },
    ];

    /// The next population: [`Scheme::survivors`].
    pub fn survivors<P: Problem>(
        self,
        problem: &P,
        old: &[Individual<P::Gene>],
        brood: Population<P::Gene>,
        elites: usize,
        rng: &mut Stream,
    ) -> Population<P::Gene> {
        with!(self, scheme => scheme.survivors(problem, old, brood, elites, rng))
    }

    /// The parents of each of so many offspring: [`Scheme::couples`].
    pub fn couples<P: Problem>(
        self,
        problem: &P,
        population: &[Individual<P::Gene>],
        selection: Selection,
        offspring: usize,
        stream: impl Fn(usize) -> Stream,
    ) -> Vec<[usize; 2]> {
        with!(self, scheme => scheme.couples(problem, population, selection, offspring, stream))
    }

    /// Whether there are elites, and parents are picked by selection: [`Scheme::has_elites`].
    pub fn has_elites(self) -> bool {
        with!(self, scheme => scheme.has_elites())
    }

    /// Whether selection picks parents: [`Scheme::has_selection`].
    pub fn has_selection(self) -> bool {
        with!(self, scheme => scheme.has_selection())
    }

    /// The distance from which on individuals are of different species: [`Scheme::species_radius`].
    pub fn species_radius(self) -> Option<f64> {
        with!(self, scheme => scheme.species_radius())
    }

    /// How parents are picked if nothing is said: [`Scheme::usual_selection`].
    pub fn usual_selection(self) -> Option<Selection> {
        with!(self, scheme => scheme.usual_selection())
    }

    /// Offspring of a generation without parents: [`Scheme::newcomers`].
    pub fn newcomers(self) -> usize {
        with!(self, scheme => scheme.newcomers())
    }

    /// Whether individuals compete for cells: [`Scheme::has_cells`].
    pub fn has_cells(self) -> bool {
        with!(self, scheme => scheme.has_cells())
    }

    /// How many individuals there may be: [`Scheme::sizes`].
    pub fn sizes(self, population: usize) -> RangeInclusive<usize> {
        with!(self, scheme => scheme.sizes(population))
    }

    /// Whether an estimate of somebody's fitness changes nothing for long: [`Scheme::forgets`].
    pub fn forgets(self) -> bool {
        with!(self, scheme => scheme.forgets())
    }
}

#[cfg(test)]
mod tests;
