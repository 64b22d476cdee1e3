//! The brain that feels nothing: each motor's target speed follows a wave.

use super::mind::Mind;
use super::senses::Senses;
use super::waveform::Waveform;
use std::f64::consts::TAU;

/// The wave that a motor's target speed follows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wave {
    /// Its form.
    pub waveform: Waveform,
    /// The largest target speed, in rad/s.
    pub amplitude_rad_s: f64,
    /// The phase before the first update, in radians.
    pub phase_start_rad: f64,
    /// Phase gained at each update, in radians.
    pub phase_step_rad: f64,
}

impl Wave {
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
    /// Each link's wave, and the phase that it is at, in radians.
    waves: Vec<Option<(Wave, f64)>>,
}

impl Waves {
    /// Waves before their first update.
    pub fn new(waves: &[Option<Wave>]) -> Self {
        let begin = |wave: &Option<Wave>| wave.map(|wave| (wave, wave.phase_start_rad));
        Self { waves: waves.iter().map(begin).collect() }
    }
}

impl Mind for Waves {
    fn feels(&self) -> bool {
        false
    }

    fn command(&mut self, _: &Senses, targets_rad_s: &mut [f64]) {
        for (wave, target_rad_s) in self.waves.iter_mut().zip(targets_rad_s) {
            if let Some((wave, phase_rad)) = wave {
                *phase_rad = wave.advance(*phase_rad);
                *target_rad_s = wave.target_rad_s(*phase_rad);
            }
        }
    }
}
