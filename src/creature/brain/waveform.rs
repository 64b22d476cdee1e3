//! The waves that drive motors.

use crate::choice;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// The form of a wave over one cycle, from -1 to 1.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, strum::Display, strum::VariantArray,
)]
#[strum(serialize_all = "kebab-case")]
#[serde(rename_all = "kebab-case")]
pub enum Waveform {
    /// The sine of the phase.
    Sine,
    /// 1 for the first half of the cycle, then -1.
    Pulse,
    /// Rises evenly from -1 to 1, then falls back at once.
    Ramp,
}

impl Waveform {
    /// The wave's value at a phase from 0 (included) to 2π (excluded).
    pub fn at(self, phase_rad: f64) -> f64 {
        match self {
            Waveform::Sine => libm::sin(phase_rad),
            Waveform::Pulse if phase_rad < PI => 1.0,
            Waveform::Pulse => -1.0,
            Waveform::Ramp => phase_rad / PI - 1.0,
        }
    }
}

choice::one_of!("waveform", Waveform);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn waves_run_from_minus_one_to_one() {
        assert_eq!(Waveform::Sine.at(0.0), 0.0);
        assert_eq!(Waveform::Pulse.at(0.0), 1.0);
        assert_eq!(Waveform::Pulse.at(PI), -1.0);
        assert_eq!(Waveform::Ramp.at(0.0), -1.0);
        assert_eq!(Waveform::Ramp.at(PI), 0.0);
    }
}
