//! Bodies that no genome makes, put together by hand.

use crate::creature::{Controller, Creature, Joint, JointKind, Link, Morphology, Motor, Shape};
use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};
use std::f64::consts::FRAC_PI_2;

/// A body of boxes that is being put together.
pub struct Body(Creature);

/// A hinge between a new box and one that is there.
pub struct Hinge {
    pub parent: usize,
    /// Its place in the parent's frame; the box is turned like it.
    pub parent_from_hinge: Isometry3<f64>,
    /// The box's centre in its frame.
    pub centre_m: Vector3<f64>,
    pub axis: Vector3<f64>,
    /// The strength of its motor, which does not turn unless it is driven; 0 turns freely.
    pub torque_nm_max: f64,
}

impl Body {
    /// A body of one box, given half its size.
    pub fn of(half_extents_m: [f64; 3], mass_kg: f64) -> Self {
        Self(Creature {
            morphology: Morphology {
                links: vec![cuboid(half_extents_m, mass_kg, None)],
                root_rotation: UnitQuaternion::identity(),
            },
            controller: Controller::of_waves(0.1, [None]),
        })
    }

    /// Adds a box on a hinge.
    pub fn with(mut self, half_extents_m: [f64; 3], mass_kg: f64, hinge: Hinge) -> Self {
        let joint = Joint {
            parent: hinge.parent,
            parent_from_joint: hinge.parent_from_hinge,
            joint_from_link: Translation3::from(hinge.centre_m).into(),
            kind: JointKind::Revolute(hinge.axis),
        };
        let motor = Motor { torque_nm_max: hinge.torque_nm_max };
        self.0.morphology.links.push(cuboid(half_extents_m, mass_kg, Some(joint)));
        self.0.controller.motors.push(Some(motor));
        self
    }

    pub fn build(self) -> Creature {
        self.0
    }
}

fn cuboid(half_extents_m: [f64; 3], mass_kg: f64, joint: Option<Joint>) -> Link {
    Link {
        shape: Shape::Cuboid { half_extents_m: half_extents_m.into() },
        mass_kg,
        inertia: None,
        joint,
    }
}

/// Half the size of a [`sled`].
pub const SLED_M: [f64; 3] = [0.25, 0.2, 0.1];

/// A flat box to slide on.
pub fn sled() -> Body {
    Body::of(SLED_M, 2.0)
}

/// A ball.
pub fn ball(radius_m: f64) -> Creature {
    of_shape(Shape::Sphere { radius_m })
}

/// A wheel that rolls along x: a cylinder that lies along y.
pub fn wheel(radius_m: f64, length_m: f64) -> Creature {
    let mut wheel = of_shape(Shape::Cylinder { radius_m, length_m });
    let lying = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), FRAC_PI_2);
    wheel.morphology.root_rotation = lying;
    wheel
}

/// A body of one solid of 2 kg.
fn of_shape(shape: Shape) -> Creature {
    let mut creature = sled().build();
    creature.morphology.links[0].shape = shape;
    creature
}

/// A sled with a rider, who is free to turn, so that it is jointed.
pub fn ridden() -> Creature {
    let saddle = Hinge {
        parent: 0,
        parent_from_hinge: Isometry3::translation(0.0, 0.0, 0.1),
        centre_m: Vector3::z() * 0.1,
        axis: Vector3::z(),
        torque_nm_max: 0.0,
    };
    sled().with([0.1; 3], 1.0, saddle).build()
}

/// A trunk with two limbs, one of which has a limb of its own; hinges about all three axes.
pub fn limbs(torque_nm_max: f64) -> Creature {
    let hinge = |parent, at_m: [f64; 3], centre_m: [f64; 3], axis| Hinge {
        parent,
        parent_from_hinge: Isometry3::from(Translation3::from(at_m)),
        centre_m: centre_m.into(),
        axis,
        torque_nm_max,
    };
    let (x, y, z) = (Vector3::x(), Vector3::y(), Vector3::z());
    Body::of([0.3, 0.2, 0.1], 5.0)
        .with([0.2, 0.05, 0.05], 1.0, hinge(0, [0.3, 0.1, 0.0], [0.2, 0.0, 0.0], y))
        .with([0.15, 0.05, 0.04], 0.5, hinge(1, [0.2, 0.0, 0.0], [0.15, 0.0, 0.0], z))
        .with([0.05, 0.2, 0.05], 1.0, hinge(0, [-0.2, 0.2, 0.0], [0.0, 0.2, 0.0], x))
        .build()
}
