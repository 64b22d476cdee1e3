//! A gene decoded: numbers with names and units.

use super::gene::Gene;
use super::profile::Profile;
use super::scales::Reading;
use crate::creature::brain::Waveform;
use nalgebra::{Vector3, vector};
use std::f64::consts::PI;

/// The kind of a link's solid.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SolidKind {
    /// Round about the z axis.
    Cylinder,
    /// Square about the z axis.
    Cuboid,
}

/// One gene, decoded.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Traits {
    /// The kind of the link's solid.
    pub solid: SolidKind,
    /// Extent along z, in metres.
    pub length_m: f64,
    /// Radius, or half the side of a box, in metres.
    pub radius_m: f64,
    /// How often the link and all it carries are built.
    pub copies: u32,
    /// Density in kg/m³.
    pub density_kg_m3: f64,
    /// Whether the joint to the parent can move.
    pub is_revolute: bool,
    /// Which earlier link is the parent, as a share of the way through them.
    pub parent_share: f64,
    /// The hinge's axis, a unit vector of the joint's frame.
    pub axis: Vector3<f64>,
    /// Roll (before it is multiplied by the sibling index), pitch and yaw, in radians.
    pub rpy_rad: [f64; 3],
    /// Where the joint is on the parent; see the gene table for the unit.
    pub origin: Vector3<f64>,
    /// How the target speed changes with the phase.
    pub waveform: Waveform,
    /// The largest target speed, in rad/s.
    pub amplitude_rad_s: f64,
    /// Phase gained at each motor update, in radians.
    pub phase_step_rad: f64,
}

impl Traits {
    /// Roll, pitch and yaw of the copy with this sibling index, in radians: the roll is multiplied by it.
    pub fn rpy_rad_of_copy(&self, sibling: u32) -> [f64; 3] {
        let [roll, pitch, yaw] = self.rpy_rad;
        [roll * f64::from(sibling), pitch, yaw]
    }
}

impl Reading {
    /// Decodes a gene.
    pub fn decode(&self, gene: &Gene) -> Traits {
        let value = |i| self.value(gene, i);
        let profile = self.profile;
        Traits {
            solid: profile.solid(value(0)),
            length_m: value(1),
            radius_m: value(2),
            copies: self.copies(value(3)),
            density_kg_m3: value(4),
            is_revolute: profile == Profile::Coursework || value(5) < 0.5,
            parent_share: value(6),
            axis: axis(value(7)),
            rpy_rad: [value(8), value(9), value(10)],
            origin: vector![value(11), value(12), value(13)],
            waveform: profile.waveform(value(14)),
            amplitude_rad_s: if profile == Profile::Coursework { 1.0 } else { value(15) },
            phase_step_rad: match profile {
                Profile::Native => 2.0 * PI * value(16) * profile.control_period_s(),
                Profile::Lecture | Profile::Coursework => value(16),
            },
        }
    }

    fn copies(&self, value: f64) -> u32 {
        // Rounding may reach the excluded end of the range: it means one copy less.
        let most = self.used(3).to.ceil() as u32 - 1;
        (value as u32).clamp(1, most.max(1))
    }
}

impl Profile {
    /// Decodes a gene by the gene table.
    pub fn decode(self, gene: &Gene) -> Traits {
        Reading::from(self).decode(gene)
    }

    fn solid(self, value: f64) -> SolidKind {
        if self == Profile::Coursework || value < 0.5 {
            SolidKind::Cylinder
        } else {
            SolidKind::Cuboid
        }
    }

    fn waveform(self, value: f64) -> Waveform {
        match self {
            Profile::Coursework if value <= 0.5 => Waveform::Pulse,
            Profile::Coursework => Waveform::Sine,
            Profile::Lecture | Profile::Native if value < 1.0 / 3.0 => Waveform::Sine,
            Profile::Lecture | Profile::Native if value < 2.0 / 3.0 => Waveform::Pulse,
            Profile::Lecture | Profile::Native => Waveform::Ramp,
        }
    }
}

fn axis(value: f64) -> Vector3<f64> {
    if value <= 0.33 {
        Vector3::x()
    } else if value <= 0.66 {
        Vector3::y()
    } else {
        Vector3::z()
    }
}

#[cfg(test)]
mod tests {
    use super::super::gene::{PARAMETER_COUNT, VALUE_MAX};
    use super::super::parameters::PARAMETERS;
    use super::*;

    #[test]
    fn the_ends_of_every_range_decode_to_something_within_it() {
        for profile in Profile::ALL {
            let least = profile.decode(&Gene([0.0; PARAMETER_COUNT]));
            let most = profile.decode(&Gene([VALUE_MAX; PARAMETER_COUNT]));
            assert_eq!(least.copies, 1);
            assert_eq!(most.copies, if profile == Profile::Lecture { 4 } else { 3 });
            assert_eq!(least.axis, Vector3::x());
            assert_eq!(most.axis, Vector3::z());
        }
    }

    #[test]
    fn every_parameter_of_the_living_profiles_changes_the_decoded_traits() {
        for profile in [Profile::Native, Profile::Lecture] {
            let base = Gene([0.1; PARAMETER_COUNT]);
            for (i, parameter) in PARAMETERS.iter().enumerate() {
                let mut other = base;
                other.0[i] = 0.9;
                assert_ne!(profile.decode(&base), profile.decode(&other), "{}", parameter.name);
            }
        }
    }
}
