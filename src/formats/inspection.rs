//! What a genome became: its links, joints and motors, as JSON.
//!
//! For profile `coursework` these are exactly the keys in which the course's bodies are written down, names
//! included: from 12 genes on they can collide, so tell links apart by their place. The other profiles add keys
//! and take none away.

use crate::creature::{
    Copy, Creature, Development, Joint, JointKind, Motor, Profile, Traits, Wave, Waveform,
};
use serde::Serialize;
use std::f64::consts::TAU;
use std::io::{self, Write};

/// A creature, in the form that is written.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Inspection {
    /// Where the genome comes from.
    pub source: String,
    /// How it was read.
    pub profile: Profile,
    /// What other profiles than `coursework` add.
    #[serde(flatten)]
    pub more: Option<MoreOfBody>,
    /// The links, the root first and every parent before its children.
    pub links: Vec<LinkInspection>,
}

/// What other profiles than `coursework` add to a body.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MoreOfBody {
    /// The time between two motor updates, in seconds.
    pub control_period_s: f64,
    /// Roll, pitch and yaw of the root at the start, in radians.
    pub root_rpy: [f64; 3],
}

/// A link.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LinkInspection {
    /// The name that the course gives it.
    pub name: String,
    /// Its parent's name; none for the root.
    pub parent: Option<String>,
    /// 1 for the root; for others 2 and up, counted over all copies on the same parent.
    pub sibling_index: u32,
    /// Extent along z, in metres.
    pub length: f64,
    /// Radius, or half the side of a box, in metres.
    pub radius: f64,
    /// Mass in kilograms.
    pub mass: f64,
    /// What other profiles than `coursework` add.
    #[serde(flatten)]
    pub more: Option<MoreOfLink>,
    /// What holds it to its parent; none for the root.
    pub joint: Option<JointInspection>,
    /// What drives its joint; none for the root and for fixed joints.
    pub motor: Option<MotorInspection>,
}

/// What other profiles than `coursework` add to a link.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MoreOfLink {
    /// The gene that it is a copy of, from 0.
    pub gene: usize,
    /// Its parent's place among the links, from 0.
    pub parent_index: Option<usize>,
    /// `cylinder` or `box`, as [`Shape::name`](crate::creature::Shape::name) says.
    pub shape: &'static str,
}

/// A joint.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct JointInspection {
    /// The axis that it turns about, in its own frame; of no effect if it is fixed.
    pub axis: [f64; 3],
    /// Roll, pitch and yaw of the joint's frame in the parent link's, in radians.
    pub origin_rpy: [f64; 3],
    /// Where it is in the parent link's frame, in metres.
    pub origin_xyz: [f64; 3],
    /// What other profiles than `coursework` add.
    #[serde(flatten)]
    pub more: Option<MoreOfJoint>,
}

/// What other profiles than `coursework` add to a joint.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MoreOfJoint {
    /// `revolute` or `fixed`.
    #[serde(rename = "type")]
    pub kind: &'static str,
    /// The link's centre in the joint's frame, in metres; the link's axes are the joint's.
    pub link_xyz: [f64; 3],
}

/// A motor.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MotorInspection {
    /// The form of its wave.
    pub waveform: Waveform,
    /// Phase gained at each update, in radians.
    pub freq: f64,
    /// What other profiles than `coursework` add.
    #[serde(flatten)]
    pub more: Option<MoreOfMotor>,
}

/// What other profiles than `coursework` add to a motor.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MoreOfMotor {
    /// Cycles a second.
    pub freq_hz: f64,
    /// The largest target speed, in rad/s.
    pub amplitude_rad_s: f64,
    /// The phase before the first update, in radians.
    pub phase_start_rad: f64,
    /// The largest torque, in newton metres.
    pub torque_nm_max: f64,
}

impl Inspection {
    /// Inspects a genome as it developed in `profile`.
    pub fn new(development: &Development, profile: Profile, source: impl Into<String>) -> Self {
        let creature = development.creature();
        let root_rotation = &creature.morphology.root_rotation;
        Self {
            source: source.into(),
            profile,
            more: in_full(profile).then_some(MoreOfBody {
                control_period_s: creature.controller.period_s,
                root_rpy: super::rotation::roll_pitch_yaw_rad(root_rotation),
            }),
            links: (0..development.tree.len())
                .map(|index| link(development, &creature, profile, index))
                .collect(),
        }
    }

    /// Writes it as JSON, indented.
    ///
    /// # Errors
    /// If the output cannot be written.
    pub fn write(&self, mut output: impl Write) -> io::Result<()> {
        serde_json::to_writer_pretty(&mut output, self)?;
        output.write_all(b"\n")
    }
}

fn in_full(profile: Profile) -> bool {
    profile != Profile::Coursework
}

fn link(
    development: &Development,
    creature: &Creature,
    profile: Profile,
    index: usize,
) -> LinkInspection {
    let copy = &development.tree[index];
    let traits = &development.traits[copy.gene];
    let link = &creature.morphology.links[index];
    let controller = &creature.controller;
    let driven = controller.motors[index].as_ref().zip(controller.wave(index));
    LinkInspection {
        name: copy.name(index),
        parent: copy.parent.map(|parent| development.tree[parent].name(parent)),
        sibling_index: copy.sibling,
        length: traits.length_m,
        radius: traits.radius_m,
        mass: link.mass_kg,
        more: in_full(profile).then_some(MoreOfLink {
            gene: copy.gene,
            parent_index: copy.parent,
            shape: link.shape.name(),
        }),
        joint: link.joint.as_ref().map(|joint| self::joint(joint, copy, traits, profile)),
        motor: driven.map(|(motor, wave)| self::motor(motor, wave, controller.period_s, profile)),
    }
}

fn joint(joint: &Joint, copy: &Copy, traits: &Traits, profile: Profile) -> JointInspection {
    JointInspection {
        axis: traits.axis.into(),
        origin_rpy: match profile {
            // A native joint is placed by its parent's surface; its genes' angles are no rotation of its own.
            Profile::Native => {
                super::rotation::roll_pitch_yaw_rad(&joint.parent_from_joint.rotation)
            }
            Profile::Lecture | Profile::Coursework => traits.rpy_rad_of_copy(copy.sibling),
        },
        origin_xyz: joint.parent_from_joint.translation.vector.into(),
        more: in_full(profile).then_some(MoreOfJoint {
            kind: match joint.kind {
                JointKind::Fixed => "fixed",
                JointKind::Revolute(_) => "revolute",
            },
            link_xyz: joint.joint_from_link.translation.vector.into(),
        }),
    }
}

fn motor(motor: &Motor, wave: &Wave, period_s: f64, profile: Profile) -> MotorInspection {
    MotorInspection {
        waveform: wave.waveform,
        freq: wave.phase_step_rad,
        more: in_full(profile).then_some(MoreOfMotor {
            freq_hz: wave.phase_step_rad / (TAU * period_s),
            amplitude_rad_s: wave.amplitude_rad_s,
            phase_start_rad: wave.phase_start_rad,
            torque_nm_max: motor.torque_nm_max,
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::creature::Course;
    use crate::creature::develop;
    use crate::evolution::Problem;
    use crate::problems::Locomotion;
    use crate::rng::{Purpose, Source};
    use serde_json::Value;

    fn inspected(profile: Profile, index: u32) -> Value {
        let problem =
            Locomotion { encoding: Course { profile, ..Course::DEFAULT }, ..Locomotion::default() };
        let mut rng = Source { seed: 3, island: 0 }.stream(0, index, Purpose::Genesis);
        let genome = problem.random_genome(&mut rng);
        let development = develop(&genome, profile, problem.encoding.links_max).unwrap();
        serde_json::to_value(Inspection::new(&development, profile, "random")).unwrap()
    }

    fn keys(value: &Value) -> Vec<&str> {
        value.as_object().unwrap().keys().map(String::as_str).collect()
    }

    fn moving(inspection: &Value) -> Option<&Value> {
        inspection["links"].as_array()?.iter().find(|link| !link["motor"].is_null())
    }

    #[test]
    fn other_profiles_add_keys_to_those_of_coursework_and_take_none_away() {
        let course = inspected(Profile::Coursework, 0);
        for profile in [Profile::Native, Profile::Lecture] {
            let other = (0..).map(|i| inspected(profile, i)).find(|i| moving(i).is_some()).unwrap();
            let (a, b) = (moving(&course).unwrap(), moving(&other).unwrap());
            let pairs = [(&course, &other), (a, b)];
            let parts = ["joint", "motor"].map(|part| (&a[part], &b[part]));
            for (less, more) in pairs.into_iter().chain(parts) {
                assert!(keys(less).iter().all(|key| keys(more).contains(key)));
                assert!(keys(less).len() < keys(more).len());
            }
        }
    }

    #[test]
    fn every_number_is_a_number() {
        fn check(key: &str, value: &Value) {
            match value {
                // What is no number is written as null.
                Value::Null => assert!(["parent", "parent_index", "joint", "motor"].contains(&key)),
                Value::Array(values) => values.iter().for_each(|value| check("", value)),
                Value::Object(map) => map.iter().for_each(|(key, value)| check(key, value)),
                _ => (),
            }
        }
        for profile in Profile::ALL {
            (0..100).for_each(|index| check("", &inspected(profile, index)));
        }
    }

    #[test]
    fn a_native_frequency_is_given_in_hertz_too() {
        let native = (0..).map(|i| inspected(Profile::Native, i)).find(|i| moving(i).is_some());
        let motor = moving(native.as_ref().unwrap()).unwrap()["motor"].clone();
        let (step, hertz) = (motor["freq"].as_f64().unwrap(), motor["freq_hz"].as_f64().unwrap());
        assert!((step * 60.0 / TAU - hertz).abs() < 1e-12);
        assert!((0.25..2.0).contains(&hertz));
    }
}
