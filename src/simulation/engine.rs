//! Which engine moves a body.

use crate::choice;
use serde::{Deserialize, Serialize};

/// A physics engine.
#[derive(
    Debug,
    Clone,
    Copy,
    PartialEq,
    Eq,
    PartialOrd,
    Ord,
    Default,
    Serialize,
    Deserialize,
    strum::Display,
    strum::VariantArray,
)]
#[strum(serialize_all = "kebab-case")]
#[serde(rename_all = "kebab-case")]
pub enum Engine {
    /// rapier's multibodies.
    Rapier,
    /// Our own articulated-body stepper: ten times as fast, for bodies such as these.
    #[default]
    Featherstone,
}

impl Engine {
    /// The one that shares no line of code with this one, and so none of its faults.
    pub fn other(self) -> Self {
        match self {
            Engine::Rapier => Engine::Featherstone,
            Engine::Featherstone => Engine::Rapier,
        }
    }
}

choice::one_of!("engine", Engine);
