//! What moves a body: a motor in each revolute joint, and a brain that commands them.

use super::mind::{Mind, Motor};
#[cfg(test)]
use super::reflex::Reflex;
use super::waves::{Wave, Waves};

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
#[derive(Debug, Clone, PartialEq)]
pub enum Brain {
    /// Each motor follows a wave of its own, by link, whatever the body feels.
    Waves(Vec<Option<Wave>>),
    /// Motors that hold an angle, by what the joints feel.
    #[cfg(test)]
    Reflex(Reflex),
}

impl Controller {
    /// Motors that each follow a wave, by link.
    pub fn of_waves(
        period_s: f64,
        driven: impl IntoIterator<Item = Option<(Motor, Wave)>>,
    ) -> Self {
        let (motors, waves) = driven.into_iter().map(Option::unzip).unzip();
        Self { period_s, motors, brain: Brain::Waves(waves) }
    }

    /// The wave that a link's motor follows, if it follows one.
    pub fn wave(&self, link: usize) -> Option<&Wave> {
        match &self.brain {
            Brain::Waves(waves) => waves.get(link)?.as_ref(),
            #[cfg(test)]
            Brain::Reflex(_) => None,
        }
    }

    /// The brain before its first update.
    pub fn awake(&self) -> Box<dyn Mind + Send> {
        match &self.brain {
            Brain::Waves(waves) => Box::new(Waves::new(waves)),
            #[cfg(test)]
            Brain::Reflex(reflex) => Box::new(*reflex),
        }
    }
}
