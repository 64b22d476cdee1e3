//! Bodies as MJCF, for MuJoCo: the body above a ground like ours, with a velocity actuator a motor.
//!
//! A link is a body in its parent's, fixed or on a hinge. Nothing but link and ground collide. MuJoCo takes the
//! larger of two frictions where we take the product, so both have the product. It has no words for the motors' waves:
//! `custom` holds them as texts, `motor_<i>`: waveform, amplitude in rad/s, first phase and phase gained at each
//! update in radians; `control_period` is the seconds between updates.

use super::xml::{Escaped, Triple};
use crate::creature::{Creature, Joint, JointKind, Link, Morphology, Motor, Shape, Wave};
use crate::problems::Task;
use crate::simulation::trial::GRIP;
use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, Vector3};
use std::fmt::{self, Display, Formatter};
use std::io::{self, Write};

/// The body begins with its lowest point so high, in metres, as in our trials.
const LOWEST_M: f64 = 0.1;

/// Writes a body as a model called `name`.
///
/// # Errors
/// If the output cannot be written.
pub fn write(creature: &Creature, name: &str, mut output: impl Write) -> io::Result<()> {
    let Creature { morphology, controller } = creature;
    let trial = Task::Walk.trial();
    writeln!(
        output,
        r#"<?xml version="1.0" encoding="utf-8"?>
<mujoco model="{name}">
  <compiler angle="radian" autolimits="true" inertiafromgeom="false"/>
  <option timestep="{timestep}" gravity="0 0 -{gravity}" integrator="implicitfast" cone="elliptic"/>
  <default>
    <geom contype="1" conaffinity="0" condim="3" friction="{GRIP} 0 0" rgba="0.8 0.5 0.3 1"/>
  </default>
  <custom>
    <numeric name="control_period" data="{period_s}"/>"#,
        name = Escaped(name),
        timestep = trial.time_s(1),
        gravity = trial.gravity_m_s2,
        period_s = controller.period_s,
    )?;
    for index in 0..morphology.links.len() {
        if let Some(wave) = controller.wave(index) {
            write_wave(index, wave, &mut output)?;
        }
    }
    writeln!(
        output,
        r#"  </custom>
  <worldbody>
    <light pos="0 0 5" directional="true"/>
    <geom name="ground" type="plane" size="0 0 1" contype="0" conaffinity="1" rgba="0.6 0.7 0.6 1"/>"#
    )?;
    Bodies { morphology, output: &mut output }.write(0, 4)?;
    writeln!(output, "  </worldbody>\n  <actuator>")?;
    for (index, motor) in controller.motors.iter().enumerate() {
        if let Some(motor) = motor {
            write_actuator(morphology, index, motor, &mut output)?;
        }
    }
    writeln!(output, "  </actuator>\n</mujoco>")
}

fn write_wave(index: usize, wave: &Wave, output: &mut impl Write) -> io::Result<()> {
    let Wave { waveform, amplitude_rad_s, phase_start_rad, phase_step_rad } = wave;
    writeln!(
        output,
        r#"    <text name="motor_{index}" data="{waveform} {amplitude_rad_s} {phase_start_rad} {phase_step_rad}"/>"#
    )
}

/// A motor that has no torque is none; MuJoCo would take a range from 0 to 0 for none at all.
fn write_actuator(
    morphology: &Morphology,
    index: usize,
    motor: &Motor,
    output: &mut impl Write,
) -> io::Result<()> {
    let torque = motor.torque_nm_max;
    if torque <= 0.0 {
        return Ok(());
    }
    // As stiff as can be: one that is stiffer, and at the bound of its torque, would overshoot within a step.
    let gain = swung_inertia_kg_m2(morphology, index) * f64::from(Task::Walk.trial().steps_per_s);
    writeln!(
        output,
        r#"    <velocity name="motor_{index}" joint="joint_{index}" kv="{gain}" forcerange="-{torque} {torque}"/>"#
    )
}

struct Bodies<'a, W> {
    morphology: &'a Morphology,
    output: &'a mut W,
}

impl<W: Write> Bodies<'_, W> {
    /// Writes a link and all that hangs on it.
    fn write(&mut self, index: usize, indent: usize) -> io::Result<()> {
        let (morphology, space) = (self.morphology, " ".repeat(indent));
        let link = &morphology.links[index];
        let place = Place(place(morphology, index));
        writeln!(self.output, r#"{space}<body name="link_{index}" {place}>"#)?;
        self.write_joint(index, link, &space)?;
        if link.mass_kg > 0.0 {
            writeln!(self.output, "{space}  {}", Inertial(link))?;
        }
        writeln!(
            self.output,
            r#"{space}  <geom name="solid_{index}" {}/>"#,
            Geometry(&link.shape)
        )?;
        for (child, other) in morphology.links.iter().enumerate().skip(index + 1) {
            if other.joint.as_ref().is_some_and(|joint| joint.parent == index) {
                self.write(child, indent + 2)?;
            }
        }
        writeln!(self.output, "{space}</body>")
    }

    fn write_joint(&mut self, index: usize, link: &Link, space: &str) -> io::Result<()> {
        match &link.joint {
            None => writeln!(self.output, r#"{space}  <freejoint name="root"/>"#),
            Some(Joint { kind: JointKind::Fixed, .. }) => Ok(()),
            Some(Joint { joint_from_link, kind: JointKind::Revolute(axis), .. }) => {
                let link_from_joint = joint_from_link.inverse();
                let (point, axis) = (link_from_joint.translation.vector, link_from_joint * axis);
                let (point, axis) = (Triple(&point), Triple(&axis));
                writeln!(
                    self.output,
                    r#"{space}  <joint name="joint_{index}" type="hinge" pos="{point}" axis="{axis}"/>"#
                )
            }
        }
    }
}

/// Where a link is in its parent, or the root in the world.
fn place(morphology: &Morphology, index: usize) -> Isometry3<f64> {
    match &morphology.links[index].joint {
        None => Isometry3::from_parts(
            Translation3::new(0.0, 0.0, LOWEST_M - morphology.lowest_m()),
            morphology.root_rotation,
        ),
        Some(joint) => joint.parent_from_joint * joint.joint_from_link,
    }
}

/// What a hinge's motor turns, in kg·m²: the inertia about the hinge of all that hangs on it against that of all
/// the rest, at rest.
fn swung_inertia_kg_m2(morphology: &Morphology, hinge: usize) -> f64 {
    let poses = morphology.rest_poses();
    let Some(Joint { joint_from_link, kind: JointKind::Revolute(axis), .. }) =
        &morphology.links[hinge].joint
    else {
        return 0.0;
    };
    let world_from_joint = poses[hinge] * joint_from_link.inverse();
    let (point, axis) = (world_from_joint.translation.vector, world_from_joint * axis);
    let mut hangs = vec![false; morphology.links.len()];
    let (mut swung, mut rest) = (0.0, 0.0);
    for (index, (link, pose)) in morphology.links.iter().zip(&poses).enumerate() {
        hangs[index] = index == hinge || link.joint.as_ref().is_some_and(|j| hangs[j.parent]);
        let about = about_axis_kg_m2(link, pose, &point, &axis);
        *(if hangs[index] { &mut swung } else { &mut rest }) += about;
    }
    swung * rest / (swung + rest)
}

fn about_axis_kg_m2(
    link: &Link,
    pose: &Isometry3<f64>,
    point: &Vector3<f64>,
    axis: &Vector3<f64>,
) -> f64 {
    let local = pose.inverse_transform_vector(axis);
    let arm = (pose * Point3::from(link.centre_m())).coords - point;
    local.dot(&(link.inertia_kg_m2() * local)) + link.mass_kg * arm.cross(axis).norm_squared()
}

struct Place(Isometry3<f64>);

impl Display for Place {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let (point, rotation) = (Triple(&self.0.translation.vector), Rotation(&self.0.rotation));
        write!(f, r#"pos="{point}" quat="{rotation}""#)
    }
}

/// A rotation as MuJoCo writes it: w first.
struct Rotation<'a>(&'a UnitQuaternion<f64>);

impl Display for Rotation<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let c = &self.0.coords;
        write!(f, "{} {} {} {}", c.w, c.x, c.y, c.z)
    }
}

struct Inertial<'a>(&'a Link);

impl Display for Inertial<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let (centre, mass_kg) = (self.0.centre_m(), self.0.mass_kg);
        write!(f, r#"<inertial pos="{}" mass="{mass_kg}" "#, Triple(&centre))?;
        let m = self.0.inertia_kg_m2();
        match self.0.inertia {
            None => write!(f, r#"diaginertia="{}"/>"#, Triple(&m.diagonal())),
            Some(_) => write!(
                f,
                r#"fullinertia="{} {} {} {} {} {}"/>"#,
                m.m11, m.m22, m.m33, m.m12, m.m13, m.m23
            ),
        }
    }
}

struct Geometry<'a>(&'a Shape);

impl Display for Geometry<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, r#"type="{}" "#, self.0.name())?;
        match self.0 {
            Shape::Cylinder { radius_m, length_m } | Shape::Capsule { radius_m, length_m } => {
                write!(f, r#"size="{radius_m} {}""#, length_m / 2.0)
            }
            Shape::Cuboid { half_extents_m } => write!(f, r#"size="{}""#, Triple(half_extents_m)),
            Shape::Sphere { radius_m } => write!(f, r#"size="{radius_m}""#),
        }
    }
}
