//! A brain for tests alone that feels its joints: it shows that senses come in and commands go out.

use super::mind::Mind;
use super::senses::Senses;

/// Drives every joint towards an angle, the faster the farther it is away.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reflex {
    /// The angle, in radians.
    pub angle_rad: f64,
    /// Target speed for each radian that it is away, in 1/s.
    pub gain_per_s: f64,
    /// A link that touches something holds still.
    pub stops_at_touch: bool,
}

impl Mind for Reflex {
    fn feels(&self) -> bool {
        true
    }

    fn command(&mut self, senses: &Senses, targets_rad_s: &mut [f64]) {
        let links = senses.joints.iter().zip(&senses.touches).zip(targets_rad_s);
        for ((joint, touches), target_rad_s) in links {
            let stops = self.stops_at_touch && *touches;
            let away_rad = self.angle_rad - joint.angle_rad;
            *target_rad_s = if stops { 0.0 } else { self.gain_per_s * away_rad };
        }
    }
}
