//! What moves a body: a motor in each revolute joint, and a brain that commands them.

#[cfg(test)]
use super::reflex::Reflex;
use super::senses::Senses;
use super::waveform::Waveform;
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

/// A brain at work, with its state.
pub trait Mind {
    /// Whether it makes use of senses. One that does not is given none, which costs less.
    fn feels(&self) -> bool;

    /// One control update: the speed that each link's motor has to aim at from now on, in rad/s, in `targets_rad_s`, by
    /// link. What is said of a link without a motor is ignored.
    fn command(&mut self, senses: &Senses, targets_rad_s: &mut [f64]);
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

/// A motor: it drives its hinge towards a speed. Its wave is what [`Brain::Waves`] commands it by.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motor {
    /// The form of the wave.
    pub waveform: Waveform,
    /// The largest target speed, in rad/s.
    pub amplitude_rad_s: f64,
    /// The phase before the first update, in radians.
    pub phase_start_rad: f64,
    /// Phase gained at each update, in radians.
    pub phase_step_rad: f64,
    /// The largest torque that it can exert, in newton metres.
    pub torque_nm_max: f64,
}
