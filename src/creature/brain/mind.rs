//! What a brain does, and what it commands.

use super::senses::Senses;
use super::waveform::Waveform;

/// A brain at work, with its state.
pub trait Mind {
    /// Whether it makes use of senses. One that does not is given none, which costs less.
    fn feels(&self) -> bool;

    /// One control update: the speed that each link's motor has to aim at from now on, in rad/s, in `targets_rad_s`, by
    /// link. What is said of a link without a motor is ignored.
    fn command(&mut self, senses: &Senses, targets_rad_s: &mut [f64]);
}

/// A motor: it drives its hinge towards a speed. Its wave is what [`Brain::Waves`](super::Brain::Waves) commands it by.
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
