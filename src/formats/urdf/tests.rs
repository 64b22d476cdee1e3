//! What is written and read as URDF.

use super::*;
use crate::creature::{Creature, Gene, JointKind, Profile, Shape, express};
use expect_test::{Expect, expect};
use nalgebra::{Isometry3, Point3, Translation3, Vector3, vector};

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
          <islands version="1" control-period="0.016666666666666666">
            <root rotation="0 0.7071067811865475 0 0.7071067811865476"/>
            <motor joint="joint_1" waveform="sine" amplitude="2" phase-start="0" phase-step="0.07199483164476608"/>
            <pose joint="joint_1" joint-in-parent="0.5 0 0 0 0 0 1" link-in-joint="0 0 0.75 0 0 0 1"/>
          </islands>
        </robot>
    "#]]
    .assert_eq(&written(&simple(), r#"my "walker" <1> & co"#));
}

/// A robot with these elements.
fn robot(elements: &str) -> String {
    format!(r#"<robot name="other">{elements}</robot>"#)
}

fn link(name: &str, inside: &str) -> String {
    format!(r#"<link name="{name}">{inside}</link>"#)
}

fn joint(kind: &str, parent: &str, child: &str, inside: &str) -> String {
    format!(
        r#"<joint name="{parent}-{child}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>{inside}</joint>"#
    )
}

fn solid(shape: &str) -> String {
    format!(
        r#"<inertial><mass value="2"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
        <collision><geometry>{shape}</geometry></collision>"#
    )
}

const BALL: &str = r#"<sphere radius="0.5"/>"#;

#[test]
fn a_file_that_is_read_and_written_again_is_the_same_file() {
    let file = written(&simple(), "again");
    let body = read(&file).unwrap();
    assert_eq!((body.creature.clone(), body.notes), (simple(), vec![]));
    assert_eq!(body.name, "again");
    assert_eq!(body.link_names, ["link_0", "link_1"]);
    assert_eq!(written(&body.creature, "again"), file);
}

#[test]
fn who_changes_a_standard_element_is_believed_over_the_exact_pose() {
    let file = written(&simple(), "changed");
    let moved = file.replace(" 0 -0.5\" rpy", " 0 -0.75\" rpy");
    assert_ne!(moved, file);
    let joint = |file: &str| read(file).unwrap().creature.morphology.links[1].joint.clone();
    let off = joint(&file).unwrap().parent_from_joint.inverse()
        * joint(&moved).unwrap().parent_from_joint;
    assert!((off.translation.vector.norm() - 0.25).abs() < 1e-12);
}

#[test]
fn a_link_of_several_solids_has_its_mass_once_and_its_joints_where_they_were() {
    let two = r#"<inertial><origin xyz="0 0 0.5"/><mass value="3"/><inertia ixx="2" iyy="2" izz="1"/></inertial>
        <collision><origin xyz="0 0 1"/><geometry><box size="1 1 1"/></geometry></collision>
        <collision><origin rpy="0 0.5 0"/><geometry><capsule radius="0.1" length="0.5"/></geometry></collision>"#;
    let file = robot(
        &[
            link("trunk", two),
            link("ball", &solid(BALL)),
            joint("continuous", "trunk", "ball", r#"<origin xyz="4 0 0"/><axis xyz="-2 0 0"/>"#),
        ]
        .concat(),
    );
    let body = read(&file).unwrap();
    let links = &body.creature.morphology.links;
    assert_eq!(body.link_names, ["trunk", "trunk", "ball"]);
    assert_eq!(links.iter().map(|link| link.mass_kg).collect::<Vec<_>>(), [3.0, 0.0, 2.0]);
    assert_eq!(links[0].centre_m(), vector![0.0, 0.0, -0.5]);
    let rest = body.creature.morphology.rest_poses();
    let at = |i: usize| rest[i] * Point3::origin() - rest[0] * Point3::origin();
    assert!((at(1) - vector![0.0, 0.0, -1.0]).norm() < 1e-12);
    assert!((at(2) - vector![4.0, 0.0, -1.0]).norm() < 1e-12);
    let Some(hinge) = &links[2].joint else { panic!("it has one") };
    assert_eq!(hinge.kind, JointKind::Revolute(-Vector3::x()));
    // The ball's inertia is not a ball's.
    assert_eq!(links[2].inertia_kg_m2(), nalgebra::Matrix3::identity());
}

#[test]
fn frames_without_a_solid_become_one_with_what_they_are_fixed_to() {
    let weight = r#"<inertial><mass value="2"/><inertia ixx="1" iyy="1" izz="1"/></inertial>"#;
    let file = robot(
        &[
            link("world", ""),
            link("ball", &solid(BALL)),
            link("sensor", weight),
            link("tip", &solid(BALL)),
            joint("fixed", "world", "ball", r#"<origin xyz="0 0 7" rpy="0 0.5 0"/>"#),
            joint("fixed", "ball", "sensor", r#"<origin xyz="0 0 1"/>"#),
            joint(
                "revolute",
                "sensor",
                "tip",
                r#"<origin xyz="0 0 1"/><limit effort="1" velocity="1"/>"#,
            ),
        ]
        .concat(),
    );
    let body = read(&file).unwrap();
    let links = &body.creature.morphology.links;
    assert_eq!((body.link_names.len(), links[0].mass_kg), (2, 4.0));
    assert_eq!(links[0].centre_m(), vector![0.0, 0.0, 0.5]);
    // Two kilograms each half a metre from their middle, and their own.
    let expected = vector![3.0, 3.0, 2.0];
    assert!((links[0].inertia_kg_m2().diagonal() - expected).norm() < 1e-12);
    let hinge = links[1].joint.as_ref().unwrap();
    let expected: Isometry3<f64> = Translation3::new(0.0, 0.0, 2.0).into();
    assert!((hinge.parent_from_joint.inverse() * expected).translation.vector.norm() < 1e-12);
    expect![[r#"
        1 joint(s) turn without the limits that they have there
        1 hinge(s) without a motor, since the file does not say how they are driven"#]]
    .assert_eq(&body.notes.join("\n"));
}

fn refused(files: &[String], expected: Expect) {
    let errors = files.iter().map(|file| read(file).unwrap_err().to_string());
    expected.assert_eq(&errors.collect::<Vec<_>>().join("\n"));
}

#[test]
fn what_is_no_urdf_or_no_body_is_refused_with_a_sentence() {
    let ball = |name: &str| link(name, &solid(BALL));
    let turns = |parent, child| joint("continuous", parent, child, "");
    refused(
        &[
            String::new(),
            "<robot>".to_owned(),
            "<mujoco/>".to_owned(),
            robot(""),
            robot(&[ball("a"), ball("a")].concat()),
            robot(&[ball("a"), ball("b")].concat()),
            robot(&[ball("a"), turns("a", "b")].concat()),
            robot(&[ball("a"), ball("b"), turns("a", "b"), turns("b", "a")].concat()),
            robot(&[ball("a"), ball("b"), ball("c"), turns("b", "c"), turns("c", "b")].concat()),
            robot(&[ball("a"), ball("b"), turns("a", "b"), turns("a", "b")].concat()),
            robot(&[ball("a"), link("b", ""), turns("a", "b")].concat()),
            robot(&link("a", &format!("<collision><geometry>{BALL}</geometry></collision>"))),
            robot(&link("a", "")),
            robot(&(0..=LINKS_MAX).map(|i| ball(&i.to_string())).collect::<String>()),
        ],
        expect![[r#"
            it is no XML: the document does not have a root node
            it is no XML: the root node was opened but never closed
            its root element is <mujoco>: give a URDF, whose root element is <robot>
            the links do not make one tree: there is no link
            line 2: there are two links called "a"
            the links do not make one tree: neither "a" nor "b" has a parent
            line 2: there is no link called "b"
            the links do not make one tree: every link has a parent
            the links do not make one tree: 2 links hang on one another in a ring
            line 3: there are two joints called "a-b"
            link "b" has no <collision> or <visual> that it could be made of: give it one, or fix it to its parent
            link "a" moves by itself but has no mass: give it an <inertial> with one
            link "a" has no <collision> or <visual> that it could be made of: give it one, or fix it to its parent
            it has more than 512 links: give a body with fewer"#]],
    );
}

#[test]
fn what_is_not_supported_is_refused_by_name() {
    let ball = |name: &str| link(name, &solid(BALL));
    let pair = |joint: String| robot(&[ball("a"), ball("b"), joint].concat());
    refused(
        &[
            robot(&link("a", &solid(r#"<mesh filename="a.stl"/>"#))),
            robot(&link("a", "<collision/>")),
            robot(&link("a", "<collision><geometry/></collision>")),
            robot(&link("a", &solid(r#"<box size="1 2"/>"#))),
            robot(&link("a", &solid(r#"<box size="1 2 -1"/>"#))),
            robot(&link("a", &solid(r#"<sphere radius="NaN"/>"#))),
            robot(&link("a", &solid(r#"<cylinder radius="1"/>"#))),
            robot(&link("a", r#"<inertial><mass value="-1"/></inertial>"#)),
            pair(joint("prismatic", "a", "b", "")),
            pair(joint("continuous", "a", "b", r#"<axis xyz="0 0 0"/>"#)),
            pair(joint("continuous", "a", "b", r#"<origin xyz="0 inf 0"/>"#)),
            pair(joint("continuous", "a", "b", r#"<mimic joint="c"/>"#)),
            pair(r#"<joint name="j" type="fixed"><parent link="a"/></joint>"#.to_owned()),
            r#"<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:macro name="x"/></robot>"#.to_owned(),
            robot(&[ball("a"), r#"<islands control-period="0"/>"#.to_owned()].concat()),
            robot(&[ball("a"), r#"<islands control-period="1"><motor joint="x" waveform="sine" amplitude="1" phase-start="0" phase-step="0"/></islands>"#.to_owned()].concat()),
        ],
        expect![[r#"
            line 2: a <mesh> is not supported: use boxes, cylinders, spheres and capsules in <collision>
            line 1: <collision> has no <geometry>
            line 1: <geometry> has no shape
            line 2: size="1 2" is wrong: write its numbers, with spaces between them
            line 2: size="1 2 -1" is wrong: write three sides longer than zero, in metres
            line 2: radius="NaN" is wrong: write a number
            line 2: <cylinder> has no length
            line 1: value="-1" is wrong: write a mass of zero or more
            line 3: a joint of type "prismatic" is not supported: its joints may be fixed, revolute or continuous
            line 3: xyz="0 0 0" is wrong: write a direction
            line 3: xyz="0 inf 0" is wrong: write its numbers, with spaces between them
            line 3: a joint that follows another is not supported: remove its <mimic>
            line 3: <joint> has no child
            line 1: xacro is not supported: expand the file with xacro first
            line 2: control-period="0" is wrong: write seconds from 0.001 to 10
            line 2: there is no joint called "x""#]],
    );
}

#[test]
fn a_file_of_a_million_nested_elements_is_refused_and_harms_nobody() {
    for count in [1_000, 100_000, 1_000_000] {
        let opened = "<a>".repeat(count);
        assert!(matches!(read(&robot(&opened)), Err(UrdfError::Xml(_))), "{count}");
        assert!(read(&robot(&(opened + &"</a>".repeat(count)))).is_err(), "{count}");
    }
}
