//! Creatures as physics sees them: rigid parts in trees of hinges.
//!
//! Links that fixed joints hold together are one part: there is nothing to solve between them.

use super::perturbation::Perturbation;
use super::start::{LEAN_RAD, Start};
use super::terrain::Ground;
use super::trial::{Other, Trial};
use crate::creature::{Creature, Inertia, Joint, JointKind, Link, Morphology, Shape};
use nalgebra::{Isometry3, Matrix3, Point3, Translation3, Unit, UnitQuaternion, Vector3};
use std::f64::consts::PI;
use std::ops::Range;

/// A body put together, or several, at the places where their trial begins.
#[derive(Debug, Clone, PartialEq)]
pub struct Assembly {
    /// The rigid parts, body by body, of each the root first and every parent before its children.
    pub parts: Vec<Part>,
    /// Where each link is, body by body.
    pub places: Vec<Place>,
    /// Which of them are whose.
    pub bodies: Vec<Member>,
}

/// One of the bodies of an assembly.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Member {
    /// Its parts.
    pub parts: Range<usize>,
    /// Its links.
    pub links: Range<usize>,
}

/// A creature that takes part in a trial, or a box that lies about.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Entrant<'a> {
    /// Who.
    pub creature: &'a Creature,
    /// How far from the trial's start it begins, in metres.
    pub offset_m: Vector3<f64>,
    /// By what it is turned about the vertical, in radians.
    pub yaw_rad: f64,
}

impl<'a> Entrant<'a> {
    /// One that begins at the trial's start.
    pub fn alone(creature: &'a Creature) -> Self {
        Self { creature, offset_m: Vector3::zeros(), yaw_rad: 0.0 }
    }

    /// The creature that a trial is of, and the others in its world.
    pub fn all(creature: &'a Creature, trial: &'a Trial) -> Vec<Self> {
        let others = trial.others.iter().map(|Other { creature, offset_m, yaw_rad }| Self {
            creature,
            offset_m: *offset_m,
            yaw_rad: *yaw_rad,
        });
        [Self::alone(creature)].into_iter().chain(others).collect()
    }
}

/// A rigid part.
#[derive(Debug, Clone, PartialEq)]
pub struct Part {
    /// Where it is when the trial begins.
    pub world_from_part: Isometry3<f64>,
    /// What it consists of.
    pub solids: Vec<Solid>,
    /// Its mass, in kilograms.
    pub mass_kg: f64,
    /// Its centre of mass in its own frame, in metres; the root's is its origin.
    pub centre_m: Vector3<f64>,
    /// Its inertia about the centre of mass, along its own axes, in kg·m².
    pub inertia_kg_m2: Matrix3<f64>,
    /// What holds it to its parent; none for the root.
    pub hinge: Option<Hinge>,
}

/// One solid of a part.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Solid {
    /// Its form.
    pub shape: Shape,
    /// Its mass in kilograms.
    pub mass_kg: f64,
    /// How its mass is spread, in its own frame; none if evenly.
    pub inertia: Option<Inertia>,
    /// Its frame in the part's.
    pub part_from_solid: Isometry3<f64>,
}

/// A hinge with a motor. It turns about the x axis of its frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hinge {
    /// The parent part's index.
    pub parent: usize,
    /// The hinge's frame in the parent's.
    pub parent_from_hinge: Isometry3<f64>,
    /// The hinge's frame in that of the part, the same place at rest.
    pub part_from_hinge: Isometry3<f64>,
    /// The largest torque of its motor, in newton metres.
    pub torque_nm_max: f64,
}

/// Where a link is: its part and its frame there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// The part's index.
    pub part: usize,
    /// The link's frame in the part's.
    pub part_from_link: Isometry3<f64>,
}

impl Assembly {
    /// Puts a creature together for a trial.
    pub fn new(creature: &Creature, trial: &Trial) -> Self {
        Self::of(&Entrant::alone(creature), trial)
    }

    /// Puts creatures together that are in one trial.
    pub fn together(entrants: &[Entrant], trial: &Trial) -> Self {
        let mut all = Self { parts: Vec::new(), places: Vec::new(), bodies: Vec::new() };
        for entrant in entrants {
            let (parts, links) = (all.parts.len(), all.places.len());
            let body = Self::of(entrant, trial).counted_from(parts as isize);
            all.parts.extend(body.parts);
            all.places.extend(body.places);
            all.bodies
                .push(Member { parts: parts..all.parts.len(), links: links..all.places.len() });
        }
        all
    }

    /// One of the bodies by itself.
    pub fn alone(&self, body: &Member) -> Self {
        let (parts, places) = (&self.parts[body.parts.clone()], &self.places[body.links.clone()]);
        let bodies = vec![Member { parts: 0..parts.len(), links: 0..places.len() }];
        let alone = Self { parts: parts.to_vec(), places: places.to_vec(), bodies };
        alone.counted_from(-(body.parts.start as isize))
    }

    /// The same where parts have numbers so much higher.
    fn counted_from(mut self, first: isize) -> Self {
        let shift = |part: &mut usize| *part = part.wrapping_add_signed(first);
        let hinges = self.parts.iter_mut().filter_map(|part| part.hinge.as_mut());
        hinges.for_each(|hinge| shift(&mut hinge.parent));
        self.places.iter_mut().for_each(|place| shift(&mut place.part));
        self
    }

    fn of(entrant: &Entrant, trial: &Trial) -> Self {
        let creature = entrant.creature;
        let mut morphology = creature.morphology.clone();
        let Perturbation { torque, yaw_rad, .. } = trial.perturbation;
        let yaw_rad = yaw_rad + entrant.yaw_rad;
        if yaw_rad != 0.0 {
            let yaw = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), yaw_rad);
            morphology.root_rotation = yaw * morphology.root_rotation;
        }
        if let Start::LeaningAt(_) = trial.start {
            morphology.root_rotation = lean() * morphology.root_rotation;
        }
        let mut assembly = Self { parts: Vec::new(), places: Vec::new(), bodies: Vec::new() };
        for (index, (link, rest)) in
            morphology.links.iter().zip(morphology.rest_poses()).enumerate()
        {
            let torque_nm_max = creature.controller.motors[index].map_or(0.0, |m| m.torque_nm_max);
            assembly.add(link, rest, torque * torque_nm_max);
        }
        for part in &mut assembly.parts {
            part.weigh();
        }
        assembly.centre_root();
        let start = Translation3::from(root_start_m(&morphology, trial, entrant.offset_m));
        for part in &mut assembly.parts {
            part.world_from_part = start * part.world_from_part;
        }
        let (parts, links) = (0..assembly.parts.len(), 0..assembly.places.len());
        assembly.bodies.push(Member { parts, links });
        assembly
    }

    fn add(&mut self, link: &Link, rest: Isometry3<f64>, torque_nm_max: f64) {
        let place = match &link.joint {
            Some(Joint { parent, parent_from_joint, joint_from_link, kind: JointKind::Fixed }) => {
                let Place { part, part_from_link: part_from_parent } = self.places[*parent];
                Place {
                    part,
                    part_from_link: part_from_parent * parent_from_joint * joint_from_link,
                }
            }
            joint => {
                let hinge = joint.as_ref().map(|joint| self.hinge(joint, torque_nm_max));
                self.parts.push(Part::at(rest, hinge));
                Place { part: self.parts.len() - 1, part_from_link: Isometry3::identity() }
            }
        };
        self.places.push(place);
        self.parts[place.part].solids.push(Solid {
            shape: link.shape,
            mass_kg: link.mass_kg,
            inertia: link.inertia,
            part_from_solid: place.part_from_link,
        });
    }

    fn hinge(&self, joint: &Joint, torque_nm_max: f64) -> Hinge {
        let Joint { parent, parent_from_joint, joint_from_link, kind } = joint;
        let JointKind::Revolute(axis) = kind else { unreachable!("fixed links are merged") };
        // Of the half turns that lead to -x one is as good as another.
        let to_axis = UnitQuaternion::rotation_between(&Vector3::x(), axis)
            .unwrap_or_else(|| UnitQuaternion::from_axis_angle(&Vector3::z_axis(), PI));
        let Place { part, part_from_link } = self.places[*parent];
        Hinge {
            parent: part,
            parent_from_hinge: part_from_link * parent_from_joint * to_axis,
            part_from_hinge: joint_from_link.inverse() * to_axis,
            torque_nm_max,
        }
    }

    /// Moves the root's frame to its centre of mass, which is where rapier's multibodies need it: they move a free
    /// root by the velocity of its centre of mass but turn it about its origin, and with the two apart a body that
    /// turns travels by itself.
    fn centre_root(&mut self) {
        let centre_m = self.parts[0].centre_m;
        let new_from_old = Isometry3::from(Translation3::from(-centre_m));
        let root = &mut self.parts[0];
        root.world_from_part *= new_from_old.inverse();
        root.centre_m = Vector3::zeros();
        for solid in &mut root.solids {
            solid.part_from_solid = new_from_old * solid.part_from_solid;
        }
        let places = self.places.iter_mut().filter(|place| place.part == 0);
        places.for_each(|place| place.part_from_link = new_from_old * place.part_from_link);
        let hinges = self.parts.iter_mut().filter_map(|part| part.hinge.as_mut());
        for hinge in hinges.filter(|hinge| hinge.parent == 0) {
            hinge.parent_from_hinge = new_from_old * hinge.parent_from_hinge;
        }
    }
}

/// Where the root begins, in metres.
fn root_start_m(morphology: &Morphology, trial: &Trial, offset_m: Vector3<f64>) -> Vector3<f64> {
    let height_m = match (&trial.ground, trial.start) {
        (Ground::Terrain(terrain), start) => {
            return terrain.root_start_m(morphology, start, offset_m);
        }
        (Ground::Plane, Start::RootAt(height_m)) => height_m,
        (Ground::Plane, Start::LowestAt(height_m) | Start::LeaningAt(height_m)) => {
            height_m - morphology.lowest_m()
        }
    };
    Vector3::z() * height_m + offset_m
}

/// A lean that is neither along a body's axes nor halfway between them.
fn lean() -> UnitQuaternion<f64> {
    let axis = Unit::new_normalize(Vector3::new(1.0, 0.6, 0.0));
    UnitQuaternion::from_axis_angle(&axis, LEAN_RAD)
}

impl Part {
    fn at(world_from_part: Isometry3<f64>, hinge: Option<Hinge>) -> Self {
        Self {
            world_from_part,
            solids: Vec::new(),
            mass_kg: 0.0,
            centre_m: Vector3::zeros(),
            inertia_kg_m2: Matrix3::zeros(),
            hinge,
        }
    }

    /// Adds up what the solids weigh, by the parallel-axis theorem.
    fn weigh(&mut self) {
        self.mass_kg = self.solids.iter().map(|solid| solid.mass_kg).sum();
        let moment = |solid: &Solid| solid.mass_kg * solid.centre_m();
        self.centre_m = self.solids.iter().map(moment).sum::<Vector3<f64>>() / self.mass_kg;
        self.inertia_kg_m2 = self.solids.iter().map(|s| s.inertia_about(&self.centre_m)).sum();
    }
}

impl Solid {
    /// Its centre of mass in the part's frame, in metres.
    fn centre_m(&self) -> Vector3<f64> {
        match &self.inertia {
            None => self.part_from_solid.translation.vector,
            Some(inertia) => (self.part_from_solid * Point3::from(inertia.centre_m)).coords,
        }
    }

    fn inertia_about(&self, point_m: &Vector3<f64>) -> Matrix3<f64> {
        let axes = self.part_from_solid.rotation.to_rotation_matrix();
        let own = match &self.inertia {
            None => Matrix3::from_diagonal(&self.shape.inertia_kg_m2(self.mass_kg)),
            Some(inertia) => inertia.about_centre_kg_m2,
        };
        let arm = self.centre_m() - point_m;
        let offset = Matrix3::identity() * arm.norm_squared() - arm * arm.transpose();
        axes * own * axes.transpose() + self.mass_kg * offset
    }
}
