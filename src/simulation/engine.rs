//! Which engine moves a body.

use crate::choice;
use serde::{Deserialize, Serialize};

/// A physics engine.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Engine {
    /// rapier's multibodies.
    Rapier,
    /// Our own articulated-body stepper: ten times as fast, for bodies such as these.
    #[default]
    Featherstone,
}

impl Engine {
    /// Every engine.
    pub const ALL: [Engine; 2] = [Engine::Rapier, Engine::Featherstone];

    /// The one that shares no line of code with this one, and so none of its faults.
    pub fn other(self) -> Self {
        match self {
            Engine::Rapier => Engine::Featherstone,
            Engine::Featherstone => Engine::Rapier,
        }
    }
}

impl std::fmt::Display for Engine {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Engine::Rapier => "rapier",
            Engine::Featherstone => "featherstone",
        })
    }
}

impl std::str::FromStr for Engine {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        choice::named("engine", &Engine::ALL, text)
    }
}
