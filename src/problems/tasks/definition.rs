//! What a task is.

use crate::simulation::{Measurement, Trial};

/// All that there is to say of a task.
pub struct Definition {
    /// The aim in a few words, as `--help` lists it behind the name.
    pub aim: &'static str,
    /// The unit of the score.
    pub unit: &'static str,
    /// How bodies are tried in any engine: the ground, which is also what is drawn, the start, the times, and the
    /// guards against what no body does.
    pub trial: fn() -> Trial,
    /// Steps a second in an engine that [takes long steps](crate::simulation::Engine::takes_long_steps); none if it needs as
    /// many as others.
    pub long_steps_per_s: Option<u32>,
    /// Whether perturbed trials push the body. They must not where a push would be a free gain.
    pub is_pushed: bool,
    /// What a measurement is worth, in the unit; at least 0 for a body that does nothing.
    pub score: fn(&Measurement) -> f64,
}
