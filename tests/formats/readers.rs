//! What is exported as URDF is valid for others: urdf-rs, a reader with its own rules, finds the same body in it.

use crate::formats::course::{FIXTURES, fixture};
use crate::physics::bodies::{creature, locomotion, written};
use islands::creature::{Course, Creature, Joint, JointKind, Link, Profile, Shape};
use islands::evolution::Problem;
use islands::formats::genome_csv;
use nalgebra::{Isometry3, Matrix3, Translation3, UnitQuaternion, Vector3};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use std::collections::{BTreeMap, BTreeSet};
use urdf_rs::{Geometry, JointType, Pose, Robot};

/// Poses and inertias differ by no more than this, relative to the size of the body: URDF has angles for rotations.
const NEAR: f64 = 1e-8;

#[test]
fn urdf_rs_finds_the_body_of_every_genome_of_the_course() {
    for i in 0..FIXTURES {
        let genome =
            genome_csv::read(&Course::DEFAULT, fixture(&format!("genome_{i}.csv")).as_bytes())
                .unwrap();
        for profile in Profile::ALL {
            let creature = creature(profile, &genome.genome);
            assert_found_alike(&creature, &format!("genome {i} as {profile}"));
        }
    }
}

#[test]
fn urdf_rs_finds_the_bodies_of_a_hundred_random_genomes_of_each_profile() {
    let mut rng = ChaCha8Rng::seed_from_u64(61);
    for profile in Profile::ALL {
        let mut bodies = 0;
        for index in 0.. {
            let problem = locomotion(profile, 1 + index % 6);
            // What is larger than the profile builds has no body.
            let Ok(creature) = problem.express(&problem.random_genome(&mut rng)) else { continue };
            assert_found_alike(&creature, &format!("random genome {index} as {profile}"));
            bodies += 1;
            if bodies == 100 {
                break;
            }
        }
    }
}

fn assert_found_alike(creature: &Creature, whose: &str) {
    let file = written(creature);
    // Only in a file of this version it checks sizes and limits.
    let strict = file.replacen("<robot ", r#"<robot version="1.2" "#, 1);
    urdf_rs::read_from_string(&strict).unwrap_or_else(|error| panic!("{whose}: {error}"));
    let robot = urdf_rs::read_from_string(&file).unwrap();
    let world_from_link = rest_frames(&robot);
    let Creature { morphology, controller } = creature;
    assert_eq!(robot.links.len(), morphology.links.len(), "{whose}");
    let rest = morphology.rest_poses();
    let size_m = 1.0 + morphology.extent_m();
    for (index, link) in morphology.links.iter().enumerate() {
        let whose = format!("link {index} of {whose}");
        let found = &robot.links[index];
        assert_same_link(
            found,
            &world_from_link[found.name.as_str()],
            link,
            &rest[index],
            size_m,
            &whose,
        );
        if let Some(joint) = &link.joint {
            let found = &robot.joints[index - 1];
            let ends = [&found.parent.link, &found.child.link];
            assert_eq!(ends, [joint.parent, index].map(|end| &robot.links[end].name), "{whose}");
            let torque_nm = controller.motors[index].map(|motor| motor.torque_nm_max);
            let speed_rad_s = controller.wave(index).map(|wave| wave.amplitude_rad_s);
            let drive = [torque_nm, speed_rad_s].map(Option::unwrap_or_default);
            assert_same_joint(found, joint, drive, &whose);
            let [found, own] = [
                world_from_link[found.child.link.as_str()],
                rest[joint.parent] * joint.parent_from_joint,
            ];
            assert_near(&found, &own, size_m, &whose);
        }
    }
}

/// Where every link's frame is at rest, by its name. Names are unique, and the joints make one tree of the links.
fn rest_frames(robot: &Robot) -> BTreeMap<&str, Isometry3<f64>> {
    let joints: BTreeSet<&str> = robot.joints.iter().map(|joint| joint.name.as_str()).collect();
    assert_eq!(joints.len(), robot.joints.len(), "names of joints are unique");
    let mut frames = BTreeMap::from([(robot.links[0].name.as_str(), Isometry3::identity())]);
    for joint in &robot.joints {
        let frame = frames[joint.parent.link.as_str()] * pose(&joint.origin);
        let other = frames.insert(&joint.child.link, frame);
        assert_eq!(other, None, "a link has one parent");
    }
    let links: BTreeSet<&str> = robot.links.iter().map(|link| link.name.as_str()).collect();
    assert_eq!(links.len(), robot.links.len(), "names of links are unique");
    assert!(links.iter().eq(frames.keys()), "every link hangs on the root");
    frames
}

fn assert_same_link(
    found: &urdf_rs::Link,
    world_from_frame: &Isometry3<f64>,
    link: &Link,
    world_from_link: &Isometry3<f64>,
    size_m: f64,
    whose: &str,
) {
    let ([visual], [collision]) = (found.visual.as_slice(), found.collision.as_slice()) else {
        panic!("{whose} is seen and touched as one solid each");
    };
    for (geometry, origin) in
        [(&visual.geometry, &visual.origin), (&collision.geometry, &collision.origin)]
    {
        assert_eq!(shape(geometry), link.shape, "{whose}");
        assert_near(&(world_from_frame * pose(origin)), world_from_link, size_m, whose);
    }
    let inertial = &found.inertial;
    assert_eq!(inertial.mass.value, link.mass_kg, "{whose}");
    assert!(link.mass_kg > 0.0, "{whose}");
    let world_from_centre = world_from_frame * pose(&inertial.origin);
    let own = world_from_link * Translation3::from(link.centre_m());
    assert_near(&world_from_centre, &own, size_m, whose);
    let urdf_rs::Inertia { ixx, ixy, ixz, iyy, iyz, izz } = inertial.inertia;
    let moments = Matrix3::new(ixx, ixy, ixz, ixy, iyy, iyz, ixz, iyz, izz);
    let own = turned(&link.inertia_kg_m2(), &world_from_link.rotation);
    let off = turned(&moments, &world_from_centre.rotation) - own;
    assert!(off.amax() <= NEAR * own.amax(), "{whose}: {off}");
}

fn assert_same_joint(found: &urdf_rs::Joint, joint: &Joint, drive: [f64; 2], whose: &str) {
    let urdf_rs::JointLimit { lower, upper, effort, velocity, .. } = found.limit;
    assert!(lower <= upper, "{whose}");
    assert_eq!([effort, velocity], drive, "{whose}");
    match joint.kind {
        JointKind::Fixed => assert_eq!(found.joint_type, JointType::Fixed, "{whose}"),
        JointKind::Revolute(axis) => {
            assert_eq!(found.joint_type, JointType::Continuous, "{whose}");
            assert_eq!(Vector3::from(*found.axis.xyz), axis, "{whose}");
        }
    }
}

fn assert_near(found: &Isometry3<f64>, own: &Isometry3<f64>, size_m: f64, whose: &str) {
    let off_m = (found.translation.vector - own.translation.vector).norm();
    let off_rad = found.rotation.angle_to(&own.rotation);
    assert!(off_m <= NEAR * size_m && off_rad <= NEAR, "{whose}: {off_m} m, {off_rad} rad");
}

/// An inertia along the axes of the world.
fn turned(moments: &Matrix3<f64>, world_from_axes: &UnitQuaternion<f64>) -> Matrix3<f64> {
    let axes = world_from_axes.to_rotation_matrix();
    axes * moments * axes.transpose()
}

fn pose(Pose { xyz, rpy: angles }: &Pose) -> Isometry3<f64> {
    let [roll, pitch, yaw] = **angles;
    let rotation = UnitQuaternion::from_euler_angles(roll, pitch, yaw);
    Isometry3::from_parts(Vector3::from(**xyz).into(), rotation)
}

fn shape(geometry: &Geometry) -> Shape {
    match *geometry {
        Geometry::Box { size } => Shape::Cuboid { half_extents_m: Vector3::from(*size) / 2.0 },
        Geometry::Cylinder { radius, length } => {
            Shape::Cylinder { radius_m: radius, length_m: length }
        }
        Geometry::Sphere { radius } => Shape::Sphere { radius_m: radius },
        Geometry::Capsule { radius, length } => {
            Shape::Capsule { radius_m: radius, length_m: length }
        }
        Geometry::Mesh { .. } => panic!("there are no meshes"),
    }
}
