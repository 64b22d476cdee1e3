//! What moves a body: a motor in each revolute joint, and a brain that commands them.

use super::mind::{Mind, Motor};
#[cfg(test)]
use super::reflex::Reflex;
use super::waves::Waves;

/// The motors of a body, and what commands them.
#[derive(Debug, Clone, PartialEq)]
pub struct Controller {
    /// The control period: the time between two commands, in seconds.
    pub period_s: f64,
    /// The motor of each link's joint, by link; none for the root and for fixed joints.
    pub motors: Vec<Option<Motor>>,
    /// What commands them.
    pub brain: Brain,
}

/// What commands the motors of a body.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum Brain {
    /// Each motor follows a wave of its own, whatever the body feels.
    #[default]
    Waves,
    /// Motors that hold an angle, by what the joints feel.
    #[cfg(test)]
    Reflex(Reflex),
}

impl Controller {
    /// The brain before its first update.
    pub fn awake(&self) -> Box<dyn Mind + Send> {
        match &self.brain {
            Brain::Waves => Box::new(Waves::new(&self.motors)),
            #[cfg(test)]
            Brain::Reflex(reflex) => Box::new(*reflex),
        }
    }
}
