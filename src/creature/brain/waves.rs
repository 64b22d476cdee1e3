//! The brain that feels nothing: each motor's target speed follows a wave.

use super::mind::{Mind, Motor};
use super::senses::Senses;
use std::f64::consts::TAU;

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

/// Waves under way.
pub struct Waves {
    /// Each link's motor, and the phase that it is at, in radians.
    motors: Vec<Option<(Motor, f64)>>,
}

impl Waves {
    /// Waves before their first update.
    pub fn new(motors: &[Option<Motor>]) -> Self {
        let begin = |motor: &Option<Motor>| motor.map(|motor| (motor, motor.phase_start_rad));
        Self { motors: motors.iter().map(begin).collect() }
    }
}

impl Mind for Waves {
    fn feels(&self) -> bool {
        false
    }

    fn command(&mut self, _: &Senses, targets_rad_s: &mut [f64]) {
        for (motor, target_rad_s) in self.motors.iter_mut().zip(targets_rad_s) {
            if let Some((motor, phase_rad)) = motor {
                *phase_rad = motor.advance(*phase_rad);
                *target_rad_s = motor.target_rad_s(*phase_rad);
            }
        }
    }
}
