//! What moves a body: a motor in each revolute joint, driven by a wave.

use super::waveform::Waveform;
use std::f64::consts::TAU;

/// The motors of a body.
#[derive(Debug, Clone, PartialEq)]
pub struct Controller {
    /// The time between two motor updates, in seconds.
    pub period_s: f64,
    /// The motor of each link's joint, by link; none for the root and for fixed joints.
    pub motors: Vec<Option<Motor>>,
}

/// A motor: it drives its hinge towards a speed that follows a wave.
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

impl Motor {
    /// The phase after one more update.
    pub fn advance(&self, phase_rad: f64) -> f64 {
        (phase_rad + self.phase_step_rad) % TAU
    }

    /// The speed to aim at, in rad/s.
    pub fn target_rad_s(&self, phase_rad: f64) -> f64 {
        self.amplitude_rad_s * self.waveform.at(phase_rad)
    }
}
