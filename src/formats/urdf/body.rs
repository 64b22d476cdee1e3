//! From the elements of a URDF to a body.

use super::LINKS_MAX;
use super::error::{UrdfError, shortened};
use super::motors;
use super::read::{Inertial, JointElement, LinkElement, Robot};
use super::tree::Tree;
use crate::creature::{Creature, Inertia, Joint, JointKind, Link, Morphology};
use nalgebra::{Isometry3, Matrix3, Point3, UnitQuaternion, Vector3};

/// A body that was read.
#[derive(Debug, Clone, PartialEq)]
pub struct ReadBody {
    /// Its name.
    pub name: String,
    /// The body and its motors.
    pub creature: Creature,
    /// The name that the file gives to each link; further solids of a link have their first one's.
    pub link_names: Vec<String>,
    /// What of the file does not count here, a sentence each.
    pub notes: Vec<String>,
}

/// Puts a body together.
///
/// # Errors
/// If there is none that could be simulated.
pub fn build(robot: &Robot) -> Result<ReadBody, UrdfError> {
    let tree = Tree::of(robot)?;
    let mut builder = Builder::new(robot, &tree);
    builder.add_root()?;
    let Builder { root_rotation, links, names, joints, odd_inertias, .. } = builder;
    let mut morphology = Morphology { root_rotation, links };
    require_masses(&morphology, &names)?;
    motors::set_exactly(&mut morphology, robot, &joints);
    let controller = motors::controller(robot, &joints)?;
    let notes = notes(robot, odd_inertias);
    let creature = Creature { morphology, controller };
    Ok(ReadBody { name: robot.name.clone(), creature, link_names: names, notes })
}

/// What of a file does not count here.
fn notes(robot: &Robot, odd_inertias: usize) -> Vec<String> {
    let joints = |is: fn(&&JointElement) -> bool| robot.joints.iter().filter(is).count();
    let seen = robot.links.iter().filter(|link| link.only_visual && !link.solids.is_empty());
    let moving = joints(|joint| joint.kind != JointKind::Fixed);
    let all = [
        (joints(|joint| joint.is_limited), "joint(s) turn without the limits that they have there"),
        (joints(|joint| joint.is_damped), "joint(s) turn without damping and friction"),
        (seen.count(), "link(s) without <collision> are as solid as they look"),
        (odd_inertias, "inertia(s) that no solid can have: their masses are spread evenly"),
        (
            if robot.extension.is_none() { moving } else { 0 },
            "hinge(s) without a motor, since the file does not say how they are driven",
        ),
    ];
    let told = all.into_iter().filter(|&(count, _)| count > 0);
    told.map(|(count, what)| format!("{count} {what}")).collect()
}

/// A frame of the file: of which link it is a frame, and where in that link's own one.
#[derive(Clone, Copy)]
struct Frame {
    link: usize,
    link_from_frame: Isometry3<f64>,
}

struct Builder<'a> {
    robot: &'a Robot,
    tree: &'a Tree,
    root_rotation: UnitQuaternion<f64>,
    links: Vec<Link>,
    names: Vec<String>,
    /// The element of each link's joint; none for the root and for further solids.
    joints: Vec<Option<usize>>,
    odd_inertias: usize,
}

impl<'a> Builder<'a> {
    fn new(robot: &'a Robot, tree: &'a Tree) -> Self {
        Self {
            robot,
            tree,
            root_rotation: UnitQuaternion::identity(),
            links: Vec::new(),
            names: Vec::new(),
            joints: Vec::new(),
            odd_inertias: 0,
        }
    }

    /// Builds the body from its root: the first link that is solid, where those above it, which are only frames,
    /// are fixed to it.
    fn add_root(&mut self) -> Result<(), UrdfError> {
        let mut above = Vec::new();
        let (mut at, mut world_from_at) = (self.tree.root, Isometry3::identity());
        while self.robot.links[at].solids.is_empty() {
            let fixed =
                |&&(joint, _): &&(usize, usize)| self.robot.joints[joint].kind == JointKind::Fixed;
            let next = self.tree.children[at].iter().find(fixed);
            let &(joint, child) =
                next.ok_or_else(|| UrdfError::Shapeless(shortened(&self.robot.links[at].name)))?;
            above.push((at, world_from_at, child));
            world_from_at *= self.robot.joints[joint].origin;
            at = child;
        }
        let frame = self.add_solids(at, None)?;
        self.root_rotation = (world_from_at * frame.link_from_frame.inverse()).rotation;
        self.add_children(at, frame, None)?;
        for (dummy, world_from_dummy, way) in above {
            let link_from_frame =
                frame.link_from_frame * world_from_at.inverse() * world_from_dummy;
            let frame = Frame { link: 0, link_from_frame };
            self.add_mass(dummy, frame);
            self.add_children(dummy, frame, Some(way))?;
        }
        Ok(())
    }

    fn add_children(
        &mut self,
        link: usize,
        frame: Frame,
        but: Option<usize>,
    ) -> Result<(), UrdfError> {
        let tree = self.tree;
        for &(joint, child) in tree.children[link].iter().filter(|(_, child)| Some(*child) != but) {
            let child_frame = self.add(joint, child, frame)?;
            self.add_children(child, child_frame, None)?;
        }
        Ok(())
    }

    fn add(&mut self, joint: usize, child: usize, parent: Frame) -> Result<Frame, UrdfError> {
        let JointElement { origin, kind, .. } = &self.robot.joints[joint];
        let parent_from_joint = parent.link_from_frame * origin;
        if !self.robot.links[child].solids.is_empty() {
            return self.add_solids(child, Some((joint, parent.link, parent_from_joint)));
        }
        match kind {
            JointKind::Fixed => {
                let frame = Frame { link: parent.link, link_from_frame: parent_from_joint };
                self.add_mass(child, frame);
                Ok(frame)
            }
            JointKind::Revolute(_) => {
                Err(UrdfError::Shapeless(shortened(&self.robot.links[child].name)))
            }
        }
    }

    /// Adds a link with all its solids; the first one has its joint and its mass.
    fn add_solids(
        &mut self,
        element: usize,
        joint: Option<(usize, usize, Isometry3<f64>)>,
    ) -> Result<Frame, UrdfError> {
        let first = self.links.len();
        let robot = self.robot;
        let LinkElement { name, inertial, solids, .. } = &robot.links[element];
        if first + solids.len() > LINKS_MAX {
            return Err(UrdfError::TooLarge);
        }
        let (frame_from_first, _) = solids[0];
        for (index, &(frame_from_solid, shape)) in solids.iter().enumerate() {
            let joint = match (index, joint) {
                (0, None) => None,
                (0, Some((element, parent, parent_from_joint))) => Some(Joint {
                    parent,
                    parent_from_joint,
                    joint_from_link: frame_from_first,
                    kind: robot.joints[element].kind,
                }),
                _ => Some(Joint {
                    parent: first,
                    parent_from_joint: frame_from_first.inverse() * frame_from_solid,
                    joint_from_link: Isometry3::identity(),
                    kind: JointKind::Fixed,
                }),
            };
            self.links.push(Link { shape, mass_kg: 0.0, inertia: None, joint });
            self.names.push(name.clone());
        }
        self.joints.push(joint.map(|(element, ..)| element));
        self.joints.resize(self.links.len(), None);
        let frame = Frame { link: first, link_from_frame: frame_from_first.inverse() };
        if let Some(inertial) = inertial {
            self.weigh(frame, inertial, solids.len() == 1);
        }
        Ok(frame)
    }

    /// Gives a link what the file says of its mass.
    fn weigh(&mut self, frame: Frame, inertial: &Inertial, is_all: bool) {
        let link = &mut self.links[frame.link];
        link.mass_kg = inertial.mass_kg;
        let even = Matrix3::from_diagonal(&link.shape.inertia_kg_m2(link.mass_kg));
        let Some(given) = in_link(frame, inertial) else {
            self.odd_inertias += usize::from(link.mass_kg > 0.0);
            return;
        };
        let (size_m, most) = (link.shape.farthest_m(), even.amax());
        let is_even = given.centre_m.norm() <= SAME * size_m
            && (given.about_centre_kg_m2 - even).amax() <= SAME * most;
        link.inertia = (!is_all || !is_even).then_some(given);
    }

    /// Lumps the mass of something that has no solid of its own with that of the link that it is fixed to.
    fn add_mass(&mut self, element: usize, frame: Frame) {
        let Some(inertial) = &self.robot.links[element].inertial else { return };
        if inertial.mass_kg <= 0.0 {
            return;
        }
        let about_centre_kg_m2 = Matrix3::zeros();
        let point = Inertia {
            centre_m: (frame.link_from_frame * Point3::from(inertial.origin.translation.vector))
                .coords,
            about_centre_kg_m2,
        };
        let more = in_link(frame, inertial).unwrap_or(point);
        let link = &mut self.links[frame.link];
        let own = Inertia { centre_m: link.centre_m(), about_centre_kg_m2: link.inertia_kg_m2() };
        let mass_kg = link.mass_kg + inertial.mass_kg;
        let centre_m = (link.mass_kg * own.centre_m + inertial.mass_kg * more.centre_m) / mass_kg;
        let moved = |mass_kg: f64, one: &Inertia| {
            let arm = one.centre_m - centre_m;
            let offset = Matrix3::identity() * arm.norm_squared() - arm * arm.transpose();
            one.about_centre_kg_m2 + mass_kg * offset
        };
        let about_centre_kg_m2 = moved(link.mass_kg, &own) + moved(inertial.mass_kg, &more);
        link.mass_kg = mass_kg;
        link.inertia = Some(Inertia { centre_m, about_centre_kg_m2 });
    }
}

/// What is so near, relatively, is the same.
const SAME: f64 = 1e-9;

/// An inertia in its link's frame; none if no solid can have it.
fn in_link(frame: Frame, inertial: &Inertial) -> Option<Inertia> {
    let link_from_inertia = frame.link_from_frame * inertial.origin;
    let axes = link_from_inertia.rotation.to_rotation_matrix();
    let about_centre_kg_m2 = axes * inertial.moments_kg_m2 * axes.transpose();
    let is_possible = inertial.moments_kg_m2.symmetric_eigenvalues().iter().all(|&m| m > 0.0);
    let centre_m: Vector3<f64> = link_from_inertia.translation.vector;
    is_possible.then_some(Inertia { centre_m, about_centre_kg_m2 })
}

/// Every part that moves by itself needs a mass.
fn require_masses(morphology: &Morphology, names: &[String]) -> Result<(), UrdfError> {
    let mut part = Vec::new();
    let mut masses_kg = vec![0.0; morphology.links.len()];
    for (index, link) in morphology.links.iter().enumerate() {
        part.push(match &link.joint {
            Some(Joint { parent, kind: JointKind::Fixed, .. }) => part[*parent],
            _ => index,
        });
        masses_kg[part[index]] += link.mass_kg;
    }
    match (0..part.len()).find(|&i| part[i] == i && masses_kg[i] <= 0.0) {
        None => Ok(()),
        Some(massless) => Err(UrdfError::Massless(shortened(&names[massless]))),
    }
}
