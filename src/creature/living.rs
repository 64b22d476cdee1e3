//! What evolves and moves: a body with what moves it.

use super::body::Morphology;
use super::brain::Controller;

/// A body and what moves it.
#[derive(Debug, Clone, PartialEq)]
pub struct Creature {
    /// The body.
    pub morphology: Morphology,
    /// What moves it.
    pub controller: Controller,
}
