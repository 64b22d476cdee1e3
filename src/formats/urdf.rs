//! Bodies as URDF, the Unified Robot Description Format of ROS, for other simulators.
//!
//! Links and joints are called `link_0`, `joint_1` and so on by their place in the body, so that names are unique.
//! URDF wants a link's frame to be its joint's, so the solids have an origin of their own within it; the
//! root's is turned as the body stands at the start. A motor's strength and top speed are the limit of its
//! joint. What URDF has no words for is left out: the motor's wave, friction, and that links of
//! one body do not collide.

use crate::creature::{Controller, Joint, JointKind, Link, Morphology, Motor, Shape};
use nalgebra::{Isometry3, Translation3, Vector3};
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
            let motor = controller.motors[index].as_ref();
            write_joint(index, joint, &origin, motor, &mut output)?;
        }
    }
    writeln!(output, "</robot>")
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
    let (origin, shape, mass_kg) = (Origin(origin), Geometry(&link.shape), link.mass_kg);
    let inertia = link.shape.inertia_kg_m2(mass_kg);
    let (x, y, z) = (inertia.x, inertia.y, inertia.z);
    writeln!(
        output,
        r#"  <link name="link_{index}">
    <inertial>
      {origin}
      <mass value="{mass_kg}"/>
      <inertia ixx="{x}" ixy="0" ixz="0" iyy="{y}" iyz="0" izz="{z}"/>
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
    motor: Option<&Motor>,
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
        let effort = motor.map_or(0.0, |motor| motor.torque_nm_max);
        let velocity = motor.map_or(0.0, |motor| motor.amplitude_rad_s);
        writeln!(output, r#"    <axis xyz="{}"/>"#, Triple(&axis))?;
        writeln!(output, r#"    <limit effort="{effort}" velocity="{velocity}"/>"#)?;
    }
    writeln!(output, "  </joint>")
}

/// A frame as URDF places it: fixed-axis roll, pitch and yaw.
struct Origin<'a>(&'a Isometry3<f64>);

impl Display for Origin<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let rpy = super::rotation::roll_pitch_yaw_rad(&self.0.rotation).into();
        let xyz = &self.0.translation.vector;
        write!(f, r#"<origin xyz="{}" rpy="{}"/>"#, Triple(xyz), Triple(&rpy))
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

struct Triple<'a>(&'a Vector3<f64>);

impl Display for Triple<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let (x, y, z) = (self.0.x, self.0.y, self.0.z);
        write!(f, "{x} {y} {z}")
    }
}

/// Text within an attribute of XML.
struct Escaped<'a>(&'a str);

impl Display for Escaped<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        self.0.chars().try_for_each(|c| match c {
            '&' => f.write_str("&amp;"),
            '<' => f.write_str("&lt;"),
            '>' => f.write_str("&gt;"),
            '"' => f.write_str("&quot;"),
            // XML has no words for other control characters.
            c if c.is_control() => f.write_str(" "),
            c => write!(f, "{c}"),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::creature::{Creature, Gene, Profile, express};
    use crate::evolution::Problem;
    use crate::problems::Locomotion;
    use crate::rng::{Purpose, Source};
    use expect_test::expect;

    fn written(creature: &Creature, name: &str) -> String {
        let mut bytes = Vec::new();
        write(&creature.morphology, &creature.controller, name, &mut bytes).unwrap();
        String::from_utf8(bytes).unwrap()
    }

    /// A tube of one metre with a flat box under it that swings by its end.
    fn simple() -> Creature {
        let mut genome = [Gene([0.25; 17]), Gene([0.25; 17])];
        genome[1].0[0] = 0.75;
        let mut creature = express(&genome, Profile::Native, 2).unwrap();
        let links = &mut creature.morphology.links;
        links[0].shape = Shape::Cylinder { radius_m: 0.5, length_m: 1.0 };
        links[0].mass_kg = 6.0;
        links[1].shape = Shape::Cuboid { half_extents_m: Vector3::new(0.25, 0.5, 0.75) };
        links[1].mass_kg = 3.0;
        let joint = links[1].joint.as_mut().unwrap();
        joint.parent_from_joint = Translation3::new(0.5, 0.0, 0.0).into();
        joint.joint_from_link = Translation3::new(0.0, 0.0, 0.75).into();
        creature.controller.motors[1].as_mut().unwrap().torque_nm_max = 40.0;
        creature
    }

    #[test]
    fn a_link_stands_at_its_joint_and_its_solid_beside_it() {
        expect![[r#"
            <?xml version="1.0" encoding="utf-8"?>
            <robot name="my &quot;walker&quot; &lt;1&gt; &amp; co">
              <link name="link_0">
                <inertial>
                  <origin xyz="0 0 0" rpy="0 1.5707963267948963 0"/>
                  <mass value="6"/>
                  <inertia ixx="0.8749999999999999" ixy="0" ixz="0" iyy="0.8749999999999999" iyz="0" izz="0.75"/>
                </inertial>
                <visual>
                  <origin xyz="0 0 0" rpy="0 1.5707963267948963 0"/>
                  <geometry><cylinder radius="0.5" length="1"/></geometry>
                </visual>
                <collision>
                  <origin xyz="0 0 0" rpy="0 1.5707963267948963 0"/>
                  <geometry><cylinder radius="0.5" length="1"/></geometry>
                </collision>
              </link>
              <link name="link_1">
                <inertial>
                  <origin xyz="0 0 0.75" rpy="0 0 0"/>
                  <mass value="3"/>
                  <inertia ixx="0.8125" ixy="0" ixz="0" iyy="0.625" iyz="0" izz="0.3125"/>
                </inertial>
                <visual>
                  <origin xyz="0 0 0.75" rpy="0 0 0"/>
                  <geometry><box size="0.5 1 1.5"/></geometry>
                </visual>
                <collision>
                  <origin xyz="0 0 0.75" rpy="0 0 0"/>
                  <geometry><box size="0.5 1 1.5"/></geometry>
                </collision>
              </link>
              <joint name="joint_1" type="continuous">
                <origin xyz="0.00000000000000011102230246251565 0 -0.5" rpy="0 1.5707963267948963 0"/>
                <parent link="link_0"/>
                <child link="link_1"/>
                <axis xyz="1 0 0"/>
                <limit effort="40" velocity="2"/>
              </joint>
            </robot>
        "#]]
        .assert_eq(&written(&simple(), r#"my "walker" <1> & co"#));
    }

    /// The value of an attribute in one line of the file.
    fn attribute<'a>(line: &'a str, name: &str) -> &'a str {
        let (_, rest) = line.split_once(&format!(r#"{name}=""#)).unwrap();
        rest.split_once('"').unwrap().0
    }

    fn origin(line: &str) -> Isometry3<f64> {
        let numbers = |name| -> Vec<f64> {
            attribute(line, name).split(' ').map(|number| number.parse().unwrap()).collect()
        };
        let (xyz, rpy) = (numbers("xyz"), numbers("rpy"));
        Isometry3::from_parts(
            Translation3::new(xyz[0], xyz[1], xyz[2]),
            nalgebra::UnitQuaternion::from_euler_angles(rpy[0], rpy[1], rpy[2]),
        )
    }

    /// Where each link's solid is, as a reader of the file finds it.
    fn poses(urdf: &str) -> Vec<Isometry3<f64>> {
        let lines: Vec<&str> = urdf.lines().collect();
        let index = |line| attribute(line, "link").strip_prefix("link_").unwrap().parse::<usize>();
        let (mut frames, mut solids) = (vec![Isometry3::identity()], Vec::new());
        for (i, line) in lines.iter().enumerate() {
            if line.contains("<visual>") {
                solids.push(origin(lines[i + 1]));
            } else if line.contains("<joint ") {
                frames.push(frames[index(lines[i + 2]).unwrap()] * origin(lines[i + 1]));
            }
        }
        frames.iter().zip(&solids).map(|(frame, solid)| frame * solid).collect()
    }

    #[test]
    fn the_frames_of_the_file_lead_to_where_the_links_are_at_rest() {
        for (profile, index) in Profile::ALL.into_iter().cycle().zip(0..90) {
            let problem = Locomotion { profile, ..Locomotion::default() };
            let mut rng = Source { seed: 5, island: 0 }.stream(0, index, Purpose::Genesis);
            let creature = problem.express(&problem.random_genome(&mut rng)).unwrap();
            let rest = creature.morphology.rest_poses();
            let found = poses(&written(&creature, "random"));
            assert_eq!(found.len(), rest.len());
            for (found, rest) in found.iter().zip(&rest) {
                let off = rest.inverse() * found;
                assert!(off.translation.vector.norm() < 1e-12, "{profile} {index}");
                assert!(off.rotation.vector().norm() < 1e-12, "{profile} {index}");
            }
        }
    }
}
