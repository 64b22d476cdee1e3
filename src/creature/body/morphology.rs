//! The body: rigid links in a tree of joints.

use super::shape::Shape;
use nalgebra::{Isometry3, Matrix3, Translation3, UnitQuaternion, Vector3};

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
    /// Mass in kilograms.
    pub mass_kg: f64,
    /// How its mass is spread; none if evenly over the solid, as in every body that was grown from genes.
    pub inertia: Option<Inertia>,
    /// What holds it to its parent; none for the root.
    pub joint: Option<Joint>,
}

/// A mass that is spread otherwise than evenly over a solid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Inertia {
    /// The centre of mass in the link's frame, in metres.
    pub centre_m: Vector3<f64>,
    /// Moments of inertia about that centre, along the link's axes, in kg·m².
    pub about_centre_kg_m2: Matrix3<f64>,
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

impl Link {
    /// The centre of mass in the link's frame, in metres.
    pub fn centre_m(&self) -> Vector3<f64> {
        self.inertia.map_or_else(Vector3::zeros, |inertia| inertia.centre_m)
    }

    /// Moments of inertia about the centre of mass, along the link's axes, in kg·m².
    pub fn inertia_kg_m2(&self) -> Matrix3<f64> {
        match &self.inertia {
            None => Matrix3::from_diagonal(&self.shape.inertia_kg_m2(self.mass_kg)),
            Some(inertia) => inertia.about_centre_kg_m2,
        }
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

    /// How high the body is at rest, in metres.
    pub fn height_m(&self) -> f64 {
        let tops = self.links.iter().zip(self.rest_poses()).map(|(link, pose)| {
            pose.translation.z + link.shape.reach_m(&pose.rotation, &Vector3::z())
        });
        tops.fold(0.0, f64::max) - self.lowest_m()
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
