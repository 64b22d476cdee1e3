//! The body: rigid links in a tree of joints.

use super::expansion::Copy;
use super::profile::Profile;
use super::traits::{SolidKind, Traits};
use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3, vector};
use std::f64::consts::{FRAC_PI_2, PI};

/// A body, its root first and every parent before its children.
#[derive(Debug, Clone, PartialEq)]
pub struct Morphology {
    /// The links.
    pub links: Vec<Link>,
    /// How the root stands in the world before it is put on the ground.
    pub root_rotation: UnitQuaternion<f64>,
}

/// A rigid part of a body.
#[derive(Debug, Clone, PartialEq)]
pub struct Link {
    /// Its solid, centred on its frame.
    pub shape: Shape,
    /// Mass in kilograms, spread evenly over the solid.
    pub mass_kg: f64,
    /// What holds it to its parent; none for the root.
    pub joint: Option<Joint>,
}

/// The solid of a link, centred on the link's frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Shape {
    /// A cylinder along the link's z axis.
    Cylinder {
        /// Radius in metres.
        radius_m: f64,
        /// Length in metres.
        length_m: f64,
    },
    /// A box.
    Cuboid {
        /// Half its size along the link's x, y and z axes, in metres.
        half_extents_m: Vector3<f64>,
    },
}

/// A joint between a link and its parent.
#[derive(Debug, Clone, PartialEq)]
pub struct Joint {
    /// The parent's index.
    pub parent: usize,
    /// The joint's frame in the parent's.
    pub parent_from_joint: Isometry3<f64>,
    /// The link's frame in the joint's, at rest.
    pub joint_from_link: Isometry3<f64>,
    /// How it moves.
    pub kind: JointKind,
}

/// How a joint moves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum JointKind {
    /// Not at all.
    Fixed,
    /// It turns without limit about this unit vector of the joint's frame.
    Revolute(Vector3<f64>),
}

impl Shape {
    /// Volume in cubic metres.
    pub fn volume_m3(&self) -> f64 {
        match self {
            Shape::Cylinder { length_m, .. } => self.cross_section_m2() * length_m,
            Shape::Cuboid { half_extents_m } => self.cross_section_m2() * 2.0 * half_extents_m.z,
        }
    }

    /// Area of the cut across the link's z axis, in square metres.
    pub fn cross_section_m2(&self) -> f64 {
        match self {
            Shape::Cylinder { radius_m, .. } => PI * (radius_m * radius_m),
            Shape::Cuboid { half_extents_m } => 4.0 * half_extents_m.x * half_extents_m.y,
        }
    }

    /// Moments of inertia about the link's axes, for a mass spread evenly over the solid, in kg·m².
    pub fn inertia_kg_m2(&self, mass_kg: f64) -> Vector3<f64> {
        match *self {
            Shape::Cylinder { radius_m, length_m } => {
                let about_z = radius_m * radius_m / 2.0;
                let across = about_z / 2.0 + length_m * length_m / 12.0;
                mass_kg * vector![across, across, about_z]
            }
            Shape::Cuboid { half_extents_m } => {
                let square = half_extents_m.component_mul(&half_extents_m) / 3.0;
                mass_kg * vector![square.y + square.z, square.x + square.z, square.x + square.y]
            }
        }
    }

    /// Half the size of the smallest box around the solid, along the link's axes, in metres.
    pub fn half_extents_m(&self) -> Vector3<f64> {
        match *self {
            Shape::Cylinder { radius_m, length_m } => vector![radius_m, radius_m, length_m / 2.0],
            Shape::Cuboid { half_extents_m } => half_extents_m,
        }
    }

    /// How far the solid reaches from its centre along a world direction, given its rotation, in metres.
    pub fn reach_m(&self, rotation: &UnitQuaternion<f64>, direction: &Vector3<f64>) -> f64 {
        let local = rotation.inverse_transform_vector(direction);
        let half = self.half_extents_m();
        match self {
            Shape::Cylinder { radius_m, .. } => {
                radius_m * libm::hypot(local.x, local.y) + half.z * local.z.abs()
            }
            Shape::Cuboid { .. } => half.dot(&local.abs()),
        }
    }

    /// Where a ray from the centre leaves the solid, in metres, where `direction` is measured in half
    /// extents; for a direction of zero the end of the z axis.
    fn surface_m(&self, direction: &Vector3<f64>) -> Vector3<f64> {
        let longest = direction.amax();
        let cube = if longest > 0.0 { direction / longest } else { Vector3::z() };
        let unit = match self {
            Shape::Cuboid { .. } => cube,
            // Squeezes the square cross-section of the cube into the circle of the cylinder.
            Shape::Cylinder { .. } => match libm::hypot(cube.x, cube.y) {
                0.0 => cube,
                round => {
                    let square = cube.x.abs().max(cube.y.abs());
                    vector![cube.x * square / round, cube.y * square / round, cube.z]
                }
            },
        };
        unit.component_mul(&self.half_extents_m())
    }
}

impl Morphology {
    /// The pose of every link with all joints at rest and the root at the origin.
    pub fn rest_poses(&self) -> Vec<Isometry3<f64>> {
        let mut poses: Vec<Isometry3<f64>> = Vec::with_capacity(self.links.len());
        for link in &self.links {
            poses.push(match &link.joint {
                None => Isometry3::from_parts(Translation3::identity(), self.root_rotation),
                Some(joint) => {
                    poses[joint.parent] * joint.parent_from_joint * joint.joint_from_link
                }
            });
        }
        poses
    }

    /// The height of the body's lowest point above its root at rest, in metres; negative or zero.
    pub fn lowest_m(&self) -> f64 {
        let bottoms = self.links.iter().zip(self.rest_poses()).map(|(link, pose)| {
            pose.translation.z - link.shape.reach_m(&pose.rotation, &Vector3::z())
        });
        bottoms.fold(0.0, f64::min)
    }

    /// The largest distance of a link's centre from the root at rest, plus that link's own half diagonal, in
    /// metres: how far the body reaches.
    pub fn extent_m(&self) -> f64 {
        let reach = self.links.iter().zip(self.rest_poses()).map(|(link, pose)| {
            pose.translation.vector.norm() + link.shape.half_extents_m().norm()
        });
        reach.fold(0.0, f64::max)
    }
}

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
        links.push(Link { shape, mass_kg: shape.volume_m3() * traits.density_kg_m3, joint });
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ray_from_the_centre_ends_on_the_solid() {
        let cylinder = Shape::Cylinder { radius_m: 0.5, length_m: 4.0 };
        let on_wall = cylinder.surface_m(&vector![1.0, 1.0, 0.0]);
        assert!((libm::hypot(on_wall.x, on_wall.y) - 0.5).abs() < 1e-12);
        assert_eq!(cylinder.surface_m(&vector![0.0, 0.0, -0.3]), vector![0.0, 0.0, -2.0]);
        assert_eq!(cylinder.surface_m(&Vector3::zeros()), vector![0.0, 0.0, 2.0]);
        let cuboid = Shape::Cuboid { half_extents_m: vector![1.0, 2.0, 3.0] };
        assert_eq!(cuboid.surface_m(&vector![0.1, 0.2, -0.05]), vector![0.5, 2.0, -0.75]);
    }

    #[test]
    fn a_cylinder_and_a_cuboid_resist_turning_as_solids_of_their_mass_do() {
        let cylinder = Shape::Cylinder { radius_m: 2.0, length_m: 6.0 };
        assert_eq!(cylinder.inertia_kg_m2(3.0), vector![12.0, 12.0, 6.0]);
        let cuboid = Shape::Cuboid { half_extents_m: vector![3.0, 3.0, 6.0] };
        assert_eq!(cuboid.inertia_kg_m2(2.0), vector![30.0, 30.0, 12.0]);
    }

    #[test]
    fn volume_and_reach_are_those_of_the_solid() {
        let cylinder = Shape::Cylinder { radius_m: 0.5, length_m: 2.0 };
        assert!((cylinder.volume_m3() - PI / 2.0).abs() < 1e-12);
        let lying = UnitQuaternion::from_axis_angle(&Vector3::y_axis(), FRAC_PI_2);
        assert!((cylinder.reach_m(&lying, &Vector3::z()) - 0.5).abs() < 1e-12);
        assert!((cylinder.reach_m(&lying, &Vector3::x()) - 1.0).abs() < 1e-12);
    }
}
