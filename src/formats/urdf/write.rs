//! Writing a body as URDF.

use super::super::rotation::roll_pitch_yaw_rad;
use super::super::xml::{Escaped, Pose, Quaternion, Triple};
use super::EXTENSION;
use crate::creature::{Controller, Joint, JointKind, Link, Morphology, Shape, Wave};
use nalgebra::{Isometry3, Matrix3, Translation3};
use std::fmt::{self, Display, Formatter};
use std::io::{self, Write};

/// Writes a body as a robot called `name`.
///
/// # Errors
/// If the output cannot be written.
pub fn write(
    morphology: &Morphology,
    controller: &Controller,
    name: &str,
    mut output: impl Write,
) -> io::Result<()> {
    writeln!(output, r#"<?xml version="1.0" encoding="utf-8"?>"#)?;
    writeln!(output, r#"<robot name="{}">"#, Escaped(name))?;
    for (index, link) in morphology.links.iter().enumerate() {
        write_link(index, link, &frame_from_link(morphology, index), &mut output)?;
        if let Some(joint) = &link.joint {
            let origin = frame_from_link(morphology, joint.parent) * joint.parent_from_joint;
            write_joint(index, joint, &origin, controller, &mut output)?;
        }
    }
    write_extension(morphology, controller, &mut output)?;
    writeln!(output, "</robot>")
}

/// What only this crate reads: the motors' waves, and the poses to the last bit, which angles cannot say.
fn write_extension(
    morphology: &Morphology,
    controller: &Controller,
    output: &mut impl Write,
) -> io::Result<()> {
    writeln!(output, r#"  <{EXTENSION} version="1" control-period="{}">"#, controller.period_s)?;
    writeln!(output, r#"    <root rotation="{}"/>"#, Quaternion(&morphology.root_rotation))?;
    for (index, link) in morphology.links.iter().enumerate() {
        if let Some(wave) = controller.wave(index) {
            write_wave(index, wave, output)?;
        }
        if let Some(Joint { parent_from_joint, joint_from_link, .. }) = &link.joint {
            let (parent, link) = (Pose(parent_from_joint), Pose(joint_from_link));
            writeln!(
                output,
                r#"    <pose joint="joint_{index}" joint-in-parent="{parent}" link-in-joint="{link}"/>"#
            )?;
        }
    }
    writeln!(output, "  </{EXTENSION}>")
}

fn write_wave(index: usize, wave: &Wave, output: &mut impl Write) -> io::Result<()> {
    let Wave { waveform, amplitude_rad_s, phase_start_rad, phase_step_rad } = wave;
    writeln!(
        output,
        r#"    <motor joint="joint_{index}" waveform="{waveform}" amplitude="{amplitude_rad_s}" phase-start="{phase_start_rad}" phase-step="{phase_step_rad}"/>"#
    )
}

/// The link as this crate places it, in the frame that URDF gives it.
fn frame_from_link(morphology: &Morphology, index: usize) -> Isometry3<f64> {
    match &morphology.links[index].joint {
        None => Isometry3::from_parts(Translation3::identity(), morphology.root_rotation),
        Some(joint) => joint.joint_from_link,
    }
}

fn write_link(
    index: usize,
    link: &Link,
    origin: &Isometry3<f64>,
    output: &mut impl Write,
) -> io::Result<()> {
    let centre_m = link.centre_m();
    let inertial = Origin(&(origin * Translation3::from(centre_m)));
    let (origin, shape, mass_kg) = (Origin(origin), Geometry(&link.shape), link.mass_kg);
    let inertia = Moments(&link.inertia_kg_m2());
    writeln!(
        output,
        r#"  <link name="link_{index}">
    <inertial>
      {inertial}
      <mass value="{mass_kg}"/>
      {inertia}
    </inertial>
    <visual>
      {origin}
      <geometry>{shape}</geometry>
    </visual>
    <collision>
      {origin}
      <geometry>{shape}</geometry>
    </collision>
  </link>"#
    )
}

fn write_joint(
    index: usize,
    joint: &Joint,
    origin: &Isometry3<f64>,
    controller: &Controller,
    output: &mut impl Write,
) -> io::Result<()> {
    let (parent, origin) = (joint.parent, Origin(origin));
    let kind = match joint.kind {
        JointKind::Fixed => "fixed",
        JointKind::Revolute(_) => "continuous",
    };
    writeln!(
        output,
        r#"  <joint name="joint_{index}" type="{kind}">
    {origin}
    <parent link="link_{parent}"/>
    <child link="link_{index}"/>"#
    )?;
    if let JointKind::Revolute(axis) = joint.kind {
        let effort = controller.motors[index].map_or(0.0, |motor| motor.torque_nm_max);
        let velocity = controller.wave(index).map_or(0.0, |wave| wave.amplitude_rad_s);
        writeln!(output, r#"    <axis xyz="{}"/>"#, Triple(&axis))?;
        writeln!(output, r#"    <limit effort="{effort}" velocity="{velocity}"/>"#)?;
    }
    writeln!(output, "  </joint>")
}

/// A frame as URDF places it: fixed-axis roll, pitch and yaw.
struct Origin<'a>(&'a Isometry3<f64>);

impl Display for Origin<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let rpy = roll_pitch_yaw_rad(&self.0.rotation).into();
        let xyz = &self.0.translation.vector;
        write!(f, r#"<origin xyz="{}" rpy="{}"/>"#, Triple(xyz), Triple(&rpy))
    }
}

struct Moments<'a>(&'a Matrix3<f64>);

impl Display for Moments<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let m = self.0;
        write!(f, r#"<inertia ixx="{}" ixy="{}" ixz="{}" "#, m.m11, m.m12, m.m13)?;
        write!(f, r#"iyy="{}" iyz="{}" izz="{}"/>"#, m.m22, m.m23, m.m33)
    }
}

struct Geometry<'a>(&'a Shape);

impl Display for Geometry<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self.0 {
            Shape::Cylinder { radius_m, length_m } => {
                write!(f, r#"<cylinder radius="{radius_m}" length="{length_m}"/>"#)
            }
            Shape::Cuboid { half_extents_m } => {
                write!(f, r#"<box size="{}"/>"#, Triple(&(half_extents_m * 2.0)))
            }
            Shape::Sphere { radius_m } => write!(f, r#"<sphere radius="{radius_m}"/>"#),
            Shape::Capsule { radius_m, length_m } => {
                write!(f, r#"<capsule radius="{radius_m}" length="{length_m}"/>"#)
            }
        }
    }
}
