//! What the numbers of a gene mean: three dialects of one encoding.

use crate::choice;
use serde::{Deserialize, Serialize};

/// The most links that profile `coursework` builds; it never cuts a body, but refuses larger ones.
pub const COURSEWORK_LINKS_MAX: usize = 512;

/// A reading of the gene table, [`PARAMETERS`](super::PARAMETERS).
#[derive(
    Debug,
    Clone,
    Copy,
    PartialEq,
    Eq,
    Default,
    Serialize,
    Deserialize,
    strum::Display,
    strum::VariantArray,
)]
#[strum(serialize_all = "kebab-case")]
#[serde(rename_all = "kebab-case")]
pub enum Profile {
    /// The lecture's parameters with ranges in which bodies can really walk.
    #[default]
    Native,
    /// Every parameter of the lectures alive.
    Lecture,
    /// The course program to the letter, dead parameters included.
    Coursework,
}

impl Profile {
    /// The time between two motor updates, in seconds.
    ///
    /// The course updates every 24 of 240 steps; that is too coarse for a stride of half a second.
    pub fn control_period_s(self) -> f64 {
        match self {
            Profile::Native => 1.0 / 60.0,
            Profile::Lecture | Profile::Coursework => 0.1,
        }
    }

    /// Whether bodies are cut to a number of links rather than refused.
    pub fn is_cut(self) -> bool {
        self != Profile::Coursework
    }
}

choice::one_of!("profile", Profile);
