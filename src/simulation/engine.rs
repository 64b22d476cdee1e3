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
    /// The one in which a trial of bodies such as these takes least time.
    pub const FASTEST: Self = Engine::Featherstone;

    /// The one that judges what evolved in this one: it shares no line of code with it, and so none of its faults.
    pub fn judge(self) -> Self {
        match self {
            Engine::Rapier => Engine::Featherstone,
            Engine::Featherstone => Engine::Rapier,
        }
    }

    /// Whether it is as exact as others with fewer steps a second.
    pub fn takes_long_steps(self) -> bool {
        match self {
            Engine::Rapier => false,
            Engine::Featherstone => true,
        }
    }

    /// Whether bodies in one world can collide.
    pub fn lets_bodies_collide(self) -> bool {
        match self {
            Engine::Rapier => true,
            Engine::Featherstone => false,
        }
    }
}

choice::one_of!("engine", Engine);
