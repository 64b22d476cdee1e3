//! What is shown of a champion.

use crate::creature::{Controller, Morphology};
use crate::simulation::trajectory::Trajectory;

/// What is shown of a champion.
#[derive(Debug, Clone, PartialEq)]
pub struct Clip {
    /// The lane that it is shown in: in a run its island's.
    pub lane: u32,
    /// Whose colour it has: an island's.
    pub hue: u32,
    /// The generation in which it appeared.
    pub generation: u32,
    /// What stands above it.
    pub label: String,
    /// What stands above it where many are seen at once.
    pub short_label: String,
    /// Its body.
    pub morphology: Morphology,
    /// What moves it.
    pub controller: Controller,
    /// How it moves.
    pub trajectory: Trajectory,
}
