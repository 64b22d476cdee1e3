//! Coming to rest before a body is scored: what it falls, rolls or swings by itself is none of its doing.
//!
//! After Sims (1994), who let a creature settle until its height had reached a stable minimum, so that none could
//! win by falling over. A fixed time does not do: of 400 random native bodies every second one still moves a part at
//! more than 0.05 m/s a second after the start, every tenth at more than 1.4 m/s, and got up to 1.3 m away without a
//! motor, when evolved bodies walked 3. So settling goes on in rounds until a body is at rest, and what is left then
//! of its speed is taken away: a wheel that would roll for ever begins from a standstill, too.

use super::trial::Trial;
use super::world::World;

/// The most rounds of settling. A body that has not come to rest then is scored as it is, from a standstill: rapier's
/// wheels know no rolling friction, and something always trembles.
pub const ROUNDS_MAX: u32 = 10;

/// A body whose parts are all slower than this is at rest, in m/s.
const REST_M_S: f64 = 0.05;
/// … if they are for so long at the end of a round, in seconds: what swings stands still at its turning points.
const REST_S: f64 = 0.1;

/// How long a body has been calm.
pub struct Calm {
    steps: u32,
    rest_steps: u32,
}

impl Calm {
    /// A body that has not been looked at.
    pub fn new(trial: &Trial) -> Self {
        Self { steps: 0, rest_steps: trial.steps_in(REST_S) }
    }

    /// Looks at every part after a step.
    pub fn observe(&mut self, world: &impl World, parts: usize) {
        let is_slow = |part| world.velocity_m_s(part).norm() < REST_M_S;
        self.steps = if (0..parts).all(is_slow) { self.steps + 1 } else { 0 };
    }

    /// Whether the body is at rest.
    pub fn is_rest(&self) -> bool {
        self.steps >= self.rest_steps
    }
}
