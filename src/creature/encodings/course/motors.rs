//! From a tree of decoded genes to motors and the waves that they follow.

use super::expansion::Copy;
use super::profile::Profile;
use super::traits::Traits;
use crate::creature::body::{JointKind, Morphology};
use crate::creature::brain::{Controller, Motor, Wave};
use std::f64::consts::PI;

/// The torque of every motor in the course, in newton metres.
const COURSE_TORQUE_NM: f64 = 5.0;

/// Torque of a native motor for each square metre of the smaller cross-section of the parts that it joins, in
/// newton metres. That strength grows with cross-section is Sims' rule (1994); the figure lets a limb of
/// 0.1 m radius (126 N·m) lift a trunk of water's density and its own length.
const STRENGTH_NM_PER_M2: f64 = 4000.0;

/// Gives each revolute joint of a body its motor, and the motor its wave.
pub fn build(
    traits: &[Traits],
    tree: &[Copy],
    morphology: &Morphology,
    profile: Profile,
) -> Controller {
    let driven = tree.iter().zip(&morphology.links).map(|(copy, link)| {
        let joint = link.joint.as_ref()?;
        let JointKind::Revolute(_) = joint.kind else { return None };
        let traits = &traits[copy.gene];
        let parent = &morphology.links[joint.parent];
        let wave = Wave {
            waveform: traits.waveform,
            amplitude_rad_s: traits.amplitude_rad_s,
            phase_start_rad: match profile {
                Profile::Native if copy.sibling % 2 == 1 => PI,
                _ => 0.0,
            },
            phase_step_rad: traits.phase_step_rad,
        };
        let motor = Motor {
            torque_nm_max: match profile {
                Profile::Native => {
                    let section =
                        link.shape.cross_section_m2().min(parent.shape.cross_section_m2());
                    STRENGTH_NM_PER_M2 * section
                }
                Profile::Lecture | Profile::Coursework => COURSE_TORQUE_NM,
            },
        };
        Some((motor, wave))
    });
    Controller::of_waves(profile.control_period_s(), driven)
}
