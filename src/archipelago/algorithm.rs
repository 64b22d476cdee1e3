//! The genetic algorithm, and simpler or other ones to compare it with.

use super::{Archipelago, Migration};
use crate::choice;
use crate::evolution::{Reproduction, Selection, Strategy, Survival, Variation};
use serde::{Deserialize, Serialize};

/// What searches. All of them count evaluations alike, but have not quite as many in a generation: they are compared
/// at an equal number of evaluations.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, strum::Display, strum::VariantArray,
)]
#[strum(serialize_all = "kebab-case")]
#[serde(rename_all = "kebab-case")]
pub enum Algorithm {
    /// The genetic algorithm on islands.
    Ga,
    /// Random search: every genome is a random one.
    Random,
    /// A hill climber on each island: all offspring are mutants of the best so far, an evolution strategy (1 + λ)
    /// (Rechenberg 1973) with the islands' mutation. Who is as good as the best takes its place, so that it can cross
    /// what is flat.
    HillClimb,
    /// CMA-ES on each island: see [`crate::evolution::cma`].
    CmaEs,
    /// The genetic algorithm on a single island that has as many individuals as all islands together.
    Panmictic,
}

impl Algorithm {
    /// Whether it is a genetic algorithm: with survival and exchange.
    pub fn is_genetic(self) -> bool {
        matches!(self, Algorithm::Ga | Algorithm::Panmictic)
    }

    /// Whether offspring are mutants of somebody.
    pub fn mutates(self) -> bool {
        self.is_genetic() || self == Algorithm::HillClimb
    }

    /// Whether there are several islands that exchange migrants, and may differ in how they search.
    pub fn has_islands(self) -> bool {
        self == Algorithm::Ga
    }

    /// The archipelago on which this algorithm searches, where the settings are those of another one. What it has no
    /// use for, such as migration between climbers, is off.
    pub fn on(self, archipelago: Archipelago) -> Archipelago {
        let Archipelago { strategy, migration, .. } = archipelago;
        let alone = Migration { migrants: 0, ..migration };
        let with = |strategy| Archipelago { strategy, migration: alone, ..archipelago };
        let (survival, heterogeneous) = (Survival::Generational, false);
        match self {
            Algorithm::Ga | Algorithm::Panmictic => archipelago,
            Algorithm::Random => {
                let reproduction = Reproduction::Random;
                with(Strategy { reproduction, survival, elites: 1, heterogeneous, ..strategy })
            }
            Algorithm::HillClimb => {
                let variation = Variation { crossover_rate: 0.0, ..strategy.variation };
                // However few that are, the best is among them.
                let selection = Selection::Truncation { fraction: 0.0 };
                with(Strategy {
                    selection,
                    variation,
                    survival: Survival::Drifting,
                    elites: 1,
                    heterogeneous,
                    ..strategy
                })
            }
            Algorithm::CmaEs => {
                let reproduction = Reproduction::CmaEs;
                with(Strategy { reproduction, survival, elites: 0, heterogeneous, ..strategy })
            }
        }
    }
}

choice::one_of!("algorithm", Algorithm);
