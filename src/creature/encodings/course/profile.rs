//! What the numbers of a gene mean: three dialects of one encoding.

use crate::choice;
use serde::{Deserialize, Serialize};

/// The most links that profile `coursework` builds; it never cuts a body, but refuses larger ones.
pub const COURSEWORK_LINKS_MAX: usize = 512;

/// A reading of the gene table, [`PARAMETERS`](super::PARAMETERS).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
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
    /// Every profile.
    pub const ALL: [Profile; 3] = [Profile::Native, Profile::Lecture, Profile::Coursework];

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

impl std::fmt::Display for Profile {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Profile::Native => "native",
            Profile::Lecture => "lecture",
            Profile::Coursework => "coursework",
        })
    }
}

impl std::str::FromStr for Profile {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        choice::named("profile", &Profile::ALL, text)
    }
}
