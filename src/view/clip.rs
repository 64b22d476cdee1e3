//! What is shown of a champion.

use crate::creature::Creature;
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
    /// Its body and what moves it.
    pub creature: Creature,
    /// Who and what else is in its world, as many in every clip of a film.
    pub others: Vec<Creature>,
    /// How all of them move, the champion first.
    pub trajectory: Trajectory,
}
