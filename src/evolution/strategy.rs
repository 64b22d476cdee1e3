//! How one island's population evolves.

use super::selection::Selection;
use super::survival::Survival;
use super::variation::Variation;
use crate::choice;
use serde::{Deserialize, Serialize};
use std::ops::RangeInclusive;

/// How one island's population evolves.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Strategy {
    /// Individuals, at least 2.
    pub population: usize,
    /// How many of the best live on unchanged, fewer than `population`.
    pub elites: usize,
    /// Where offspring come from.
    pub reproduction: Reproduction,
    /// How parents are picked.
    pub selection: Selection,
    /// How offspring differ from them.
    pub variation: Variation,
    /// Who lives on.
    pub survival: Survival,
    /// What changes the variation from one generation to the next.
    pub adaptation: Adaptation,
    /// Whether each island has rates of its own: see [`Strategy::on`].
    pub heterogeneous: bool,
}

impl Default for Strategy {
    fn default() -> Self {
        Self {
            population: 24,
            elites: 2,
            reproduction: Reproduction::Parents,
            selection: Selection::Tournament { size: 3 },
            variation: Variation::default(),
            survival: Survival::Generational,
            adaptation: Adaptation::None,
            heterogeneous: false,
        }
    }
}

/// Where offspring come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Reproduction {
    /// Parents that are selected, recombined and mutated.
    Parents,
    /// Nowhere: each is a random genome.
    Random,
    /// Samples of a distribution that learns: [`super::cma`].
    CmaEs,
}

/// What changes the variation from one generation to the next.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, strum::Display, strum::VariantArray,
)]
#[strum(serialize_all = "kebab-case")]
#[serde(rename_all = "kebab-case")]
pub enum Adaptation {
    /// Nothing.
    None,
    /// The amount of point mutation grows while more than a fifth of the offspring are better than their mother, and
    /// shrinks while fewer are: Rechenberg's rule (1973).
    OneFifth,
}

choice::one_of!("adaptation", Adaptation);

/// The crossover rates of heterogeneous islands, and the factors of their point rate.
const RATES: ([f64; 3], [f64; 3]) = ([0.3, 0.6, 1.0], [1.0, 0.1, 10.0]);

impl Strategy {
    /// The strategy of one island, where the amount of point mutation is multiplied by what it has learned so far.
    ///
    /// Heterogeneous islands share out all pairs of three crossover rates (0.3, 0.6, 1) and three point rates (a tenth
    /// of the usual one, it, and ten times it), so that nobody has to know the best one: the distributed GA with
    /// distributed parameters (Miki, Hiroyasu, Kaneko & Hatanaka 1999). Nine islands have every pair.
    pub fn on(&self, island: u32, amount_scale: f64) -> Strategy {
        let mut variation = self.variation;
        if self.heterogeneous {
            let (crossover, point) = (island % 3, (island + island / 3) % 3);
            variation.crossover_rate = RATES.0[crossover as usize];
            variation.point_rate = (variation.point_rate * RATES.1[point as usize]).min(1.0);
        }
        variation.point_amount = (variation.point_amount * amount_scale).min(1.0);
        Strategy { variation, ..*self }
    }

    /// Offspring of a generation; where there are species, the most that there can be.
    pub fn brood(&self) -> usize {
        self.population - if self.survival.has_elites() { self.elites } else { 0 }
    }

    /// The distance from which on individuals are of different species, where parents have offspring in such.
    pub fn species_radius(&self) -> Option<f64> {
        self.survival.species_radius().filter(|_| self.reproduction == Reproduction::Parents)
    }

    /// How many individuals a population may have.
    pub fn sizes(&self) -> RangeInclusive<usize> {
        self.survival.sizes(self.population)
    }
}
