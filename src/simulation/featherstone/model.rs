//! What of a body does not change while it moves.

use super::super::assembly::{Assembly, Part, Solid};
use crate::creature::Shape;
use nalgebra::{Isometry3, Matrix3, Vector3};

/// A body, ready to be moved.
#[derive(Debug, Clone)]
pub struct Model {
    /// The links, in the order of the assembly's parts: the root first, every parent before its children.
    pub links: Vec<Link>,
    /// All that can touch the ground.
    pub solids: Vec<Surface>,
}

/// A rigid part. Its frame is that of its hinge, so that the hinge turns about its x axis through its origin; the
/// root's is the part's own, with the centre of mass at the origin.
#[derive(Debug, Clone)]
pub struct Link {
    /// The parent's index; the root is its own.
    pub parent: usize,
    /// The hinge's frame in the parent's, when the hinge is at rest.
    pub parent_from_rest: Matrix3<f64>,
    /// The hinge's origin in the parent's frame, in metres.
    pub hinge_m: Vector3<f64>,
    /// The centre of mass in the link's frame, in metres.
    pub centre_m: Vector3<f64>,
    /// The mass, in kilograms.
    pub mass_kg: f64,
    /// The rotational inertia about the centre of mass, along the link's axes, in kg·m².
    pub inertia_kg_m2: Matrix3<f64>,
    /// Whether it has a hinge that anything drives.
    pub has_motor: bool,
    /// The assembly's frame of the part in the link's.
    pub link_from_part: Isometry3<f64>,
}

/// A solid of a link, in the link's frame.
#[derive(Debug, Clone)]
pub struct Surface {
    /// The link's index.
    pub link: usize,
    /// The solid's centre, in metres.
    pub centre_m: Vector3<f64>,
    /// The solid's axes, in its own order x, y, z.
    pub axes: Matrix3<f64>,
    /// Half its size along its axes, in metres.
    pub half_m: Vector3<f64>,
    /// What it touches with.
    pub outline: Outline,
    /// No point of it is further from its centre, in metres.
    pub reach_m: f64,
}

/// What a solid touches the ground with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outline {
    /// Corners.
    Corners,
    /// Rims about its z axis.
    Rims,
    /// One half sphere or two, so far round the ends of its z axis as its x axis is long.
    Ends(usize),
}

impl Model {
    /// Takes a body apart.
    pub fn new(assembly: &Assembly) -> Self {
        let links = assembly.parts.iter().map(|part| Link::new(part, &assembly.parts)).collect();
        let parts = assembly.parts.iter().enumerate();
        let solids = parts.flat_map(|(link, part)| {
            let link_from_part = link_from_part(part);
            part.solids.iter().map(move |solid| Surface::new(link, &link_from_part, solid))
        });
        Self { links, solids: solids.collect() }
    }
}

impl Link {
    fn new(part: &Part, parts: &[Part]) -> Self {
        let link_from_part = link_from_part(part);
        let turn = link_from_part.rotation.to_rotation_matrix();
        let parent_from_rest = part.hinge.map_or(Isometry3::identity(), |hinge| {
            self::link_from_part(&parts[hinge.parent]) * hinge.parent_from_hinge
        });
        Self {
            parent: part.hinge.map_or(0, |hinge| hinge.parent),
            parent_from_rest: *parent_from_rest.rotation.to_rotation_matrix().matrix(),
            hinge_m: parent_from_rest.translation.vector,
            centre_m: (link_from_part * nalgebra::Point3::from(part.centre_m)).coords,
            mass_kg: part.mass_kg,
            inertia_kg_m2: turn.matrix() * part.inertia_kg_m2 * turn.matrix().transpose(),
            has_motor: part.hinge.is_some_and(|hinge| hinge.torque_nm_max > 0.0),
            link_from_part,
        }
    }
}

fn link_from_part(part: &Part) -> Isometry3<f64> {
    part.hinge.map_or(Isometry3::identity(), |hinge| hinge.part_from_hinge.inverse())
}

impl Surface {
    fn new(link: usize, link_from_part: &Isometry3<f64>, solid: &Solid) -> Self {
        let pose = link_from_part * solid.part_from_solid;
        let half_m = solid.shape.half_extents_m();
        let outline = match solid.shape {
            Shape::Cuboid { .. } => Outline::Corners,
            Shape::Cylinder { .. } => Outline::Rims,
            Shape::Sphere { .. } => Outline::Ends(1),
            Shape::Capsule { .. } => Outline::Ends(2),
        };
        Self {
            link,
            centre_m: pose.translation.vector,
            axes: *pose.rotation.to_rotation_matrix().matrix(),
            half_m,
            outline,
            reach_m: solid.shape.farthest_m(),
        }
    }
}
