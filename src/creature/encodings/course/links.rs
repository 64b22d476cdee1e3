//! From a tree of decoded genes to links and joints.

use super::expansion::Copy;
use super::profile::Profile;
use super::traits::{SolidKind, Traits};
use crate::creature::body::{Joint, JointKind, Link, Morphology, Shape};
use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3, vector};
use std::f64::consts::{FRAC_PI_2, PI};

/// Gives a tree of decoded genes a body.
pub fn build(traits: &[Traits], tree: &[Copy], profile: Profile) -> Morphology {
    let mut links: Vec<Link> = Vec::with_capacity(tree.len());
    for copy in tree {
        let traits = &traits[copy.gene];
        let shape = solid(traits);
        let joint = copy.parent.map(|parent| Joint {
            parent,
            parent_from_joint: attachment(traits, copy.sibling, &links[parent].shape, profile),
            joint_from_link: match profile {
                // The joint is at the limb's end, so that the limb swings as one.
                Profile::Native => Translation3::new(0.0, 0.0, traits.length_m / 2.0).into(),
                Profile::Lecture | Profile::Coursework => Isometry3::identity(),
            },
            kind: if traits.is_revolute {
                JointKind::Revolute(traits.axis)
            } else {
                JointKind::Fixed
            },
        });
        let mass_kg = shape.volume_m3() * traits.density_kg_m3;
        links.push(Link { shape, mass_kg, inertia: None, joint });
    }
    let root_rotation = match profile {
        // Lying, so that copies about the root's long axis stand on both sides of a trunk.
        Profile::Native => UnitQuaternion::from_axis_angle(&Vector3::y_axis(), FRAC_PI_2),
        Profile::Lecture | Profile::Coursework => UnitQuaternion::identity(),
    };
    Morphology { links, root_rotation }
}

fn solid(traits: &Traits) -> Shape {
    let Traits { radius_m, length_m, .. } = *traits;
    match traits.solid {
        SolidKind::Cylinder => Shape::Cylinder { radius_m, length_m },
        SolidKind::Cuboid => {
            Shape::Cuboid { half_extents_m: vector![radius_m, radius_m, length_m / 2.0] }
        }
    }
}

/// The joint's frame in the parent's. In the course's terms a URDF origin (fixed-axis roll, pitch, yaw)
/// whose roll is multiplied by the sibling index. In the native ones a point on the parent's surface, with
/// z straight out from the centre, tilted by the pitch and turned by the yaw; the roll turns it all about
/// the parent's z axis.
fn attachment(traits: &Traits, sibling: u32, parent: &Shape, profile: Profile) -> Isometry3<f64> {
    let [roll, pitch, yaw] = traits.rpy_rad_of_copy(sibling);
    match profile {
        Profile::Lecture | Profile::Coursework => Isometry3::from_parts(
            Translation3::from(traits.origin),
            UnitQuaternion::from_euler_angles(roll, pitch, yaw),
        ),
        Profile::Native => {
            let about_trunk = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), roll);
            let point = parent.surface_m(&(about_trunk * traits.origin));
            let outwards = UnitQuaternion::rotation_between(&Vector3::z(), &point)
                .unwrap_or_else(|| UnitQuaternion::from_axis_angle(&Vector3::x_axis(), PI));
            let tilt = UnitQuaternion::from_axis_angle(&Vector3::y_axis(), pitch);
            let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), yaw);
            Isometry3::from_parts(Translation3::from(point), outwards * tilt * turn)
        }
    }
}
