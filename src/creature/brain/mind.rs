//! What a brain does, and what it commands.

use super::senses::Senses;

/// A brain at work, with its state.
pub trait Mind {
    /// Whether it makes use of senses. One that does not is given none, which costs less.
    fn feels(&self) -> bool;

    /// One control update: the speed that each link's motor has to aim at from now on, in rad/s, in `targets_rad_s`, by
    /// link. What is said of a link without a motor is ignored.
    fn command(&mut self, senses: &Senses, targets_rad_s: &mut [f64]);
}

/// A motor: it drives its hinge towards the speed that a brain commands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motor {
    /// The largest torque that it can exert, in newton metres.
    pub torque_nm_max: f64,
}
