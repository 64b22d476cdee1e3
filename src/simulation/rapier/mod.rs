//! rapier's multibodies, in reduced coordinates: the engine that our own one is judged by.
//!
//! Joints of rapier's multibodies cannot drift apart, as its impulse joints do under random bodies.
//!
//! Architecture invariants: this alone imports rapier; every trial builds a fresh world, since a world that was
//! used before gives other bits; all is f64 up to this border and f32 within it.

mod field;
mod scene;

pub use field::Field;

use super::assembly::{Assembly, Hinge, Part, Solid};
use super::trial::Trial;
use super::world::{Stepper, World};
use crate::creature::{Inertia, Shape};
use crate::evolution::Outcome;
use nalgebra::{Isometry3, Quaternion, UnitQuaternion, Vector3};
use rapier3d::prelude as rapier;
use scene::Scene;
use std::f64::consts::FRAC_PI_2;

/// How eagerly a motor corrects its speed, in N·m·s/rad: so large that only its greatest torque limits it.
const MOTOR_GAIN: f32 = 1e6;

/// A body in rapier's world.
pub struct RapierWorld {
    scene: Scene,
    /// The rigid body of each part, and its joint if it has a hinge.
    parts: Vec<(rapier::RigidBodyHandle, Option<rapier::MultibodyJointHandle>)>,
}

impl RapierWorld {
    /// Puts a body into a fresh world.
    pub fn new(assembly: &Assembly, trial: &Trial) -> Self {
        let mut world = Self { scene: Scene::new(trial), parts: Vec::new() };
        for part in &assembly.parts {
            let rigid_body = world.insert(part);
            let joint = part.hinge.as_ref().map(|hinge| world.join(hinge, rigid_body));
            world.parts.push((rigid_body, joint));
        }
        world.free_of_hidden_forces();
        world
    }

    fn insert(&mut self, part: &Part) -> rapier::RigidBodyHandle {
        let pose = to_rapier(&part.world_from_part);
        let builder = rapier::RigidBodyBuilder::dynamic().pose(pose).can_sleep(false);
        let rigid_body = self.scene.world.insert_body(builder);
        for solid in &part.solids {
            self.scene.world.insert_collider(collider(solid), Some(rigid_body));
        }
        rigid_body
    }

    fn join(
        &mut self,
        hinge: &Hinge,
        rigid_body: rapier::RigidBodyHandle,
    ) -> rapier::MultibodyJointHandle {
        let joint = rapier::GenericJointBuilder::new(rapier::JointAxesMask::LOCKED_REVOLUTE_AXES)
            .local_frame1(to_rapier(&hinge.parent_from_hinge))
            .local_frame2(to_rapier(&hinge.part_from_hinge))
            .motor_velocity(rapier::JointAxis::AngX, 0.0, MOTOR_GAIN)
            .motor_max_force(rapier::JointAxis::AngX, hinge.torque_nm_max as f32)
            .contacts_enabled(false);
        let (parent, _) = self.parts[hinge.parent];
        self.scene
            .world
            .insert_multibody_joint(parent, rigid_body, joint)
            .expect("a new rigid body closes no loop")
    }

    /// Takes away the damping that rapier gives to angular degrees of freedom, the free root's included:
    /// nothing but motors, gravity and the ground acts on a body.
    fn free_of_hidden_forces(&mut self) {
        let Some(joint) = self.joint() else { return };
        if let Some((multibody, _)) = self.scene.world.multibody_joints.get_mut(joint) {
            multibody.set_self_contacts_enabled(false);
            multibody.damping_mut().fill(0.0);
        }
    }

    /// A joint of the body: any of them leads to the one multibody.
    fn joint(&self) -> Option<rapier::MultibodyJointHandle> {
        self.parts.iter().find_map(|(_, joint)| *joint)
    }

    fn rigid_body(&self, part: usize) -> &rapier::RigidBody {
        &self.scene.world.bodies[self.parts[part].0]
    }
}

impl Stepper for RapierWorld {
    fn step(&mut self) -> Result<(), Outcome> {
        self.scene.world.step();
        let is_sound = self.scene.world.quarantine().is_empty();
        if is_sound { Ok(()) } else { Err(Outcome::NotFinite) }
    }
}

impl World for RapierWorld {
    fn drive(&mut self, part: usize, target_rad_s: f64) {
        let Some(joint) = self.parts[part].1 else { return };
        let Some((multibody, id)) = self.scene.world.multibody_joints.get_mut(joint) else {
            return;
        };
        if let Some(link) = multibody.link_mut(id) {
            let target_rad_s = target_rad_s as f32;
            link.joint.data.set_motor_velocity(rapier::JointAxis::AngX, target_rad_s, MOTOR_GAIN);
        }
    }

    fn halt(&mut self) {
        if let Some((multibody, _)) =
            self.joint().and_then(|joint| self.scene.world.multibody_joints.get_mut(joint))
        {
            multibody.generalized_velocity_mut().fill(0.0);
        }
        for (rigid_body, _) in &self.parts {
            let rigid_body = &mut self.scene.world.bodies[*rigid_body];
            rigid_body.set_linvel(rapier::Vector::ZERO, false);
            rigid_body.set_angvel(rapier::Vector::ZERO, false);
        }
    }

    fn push(&mut self, velocity_m_s: Vector3<f64>) {
        let velocity_m_s = velocity_m_s.cast::<f32>();
        if let Some((multibody, _)) =
            self.joint().and_then(|joint| self.scene.world.multibody_joints.get_mut(joint))
        {
            // The root's first; all others are relative to it.
            let mut velocities = multibody.generalized_velocity_mut();
            let mut root = velocities.rows_mut(0, 3);
            root += velocity_m_s;
        }
        for (rigid_body, _) in &self.parts {
            let rigid_body = &mut self.scene.world.bodies[*rigid_body];
            let [x, y, z] = velocity_m_s.into();
            let pushed = rigid_body.linvel() + rapier::Vector::new(x, y, z);
            rigid_body.set_linvel(pushed, false);
        }
    }

    fn world_from_part(&self, part: usize) -> Isometry3<f64> {
        from_rapier(self.rigid_body(part).position())
    }

    fn velocity_m_s(&self, part: usize) -> Vector3<f64> {
        Vector3::from(self.rigid_body(part).linvel().to_array()).cast()
    }

    #[cfg(test)]
    fn kick(&mut self, velocity_m_s: Vector3<f64>, turn_rad_s: Vector3<f64>) {
        let [v, w] = [velocity_m_s, turn_rad_s].map(|it| it.cast::<f32>());
        let joint = self.joint();
        let rapier::PhysicsWorld { bodies, multibody_joints, .. } = &mut self.scene.world;
        match joint {
            Some(joint) => {
                let (multibody, _) = multibody_joints.get_mut(joint).expect("it was inserted");
                let root = [v.x, v.y, v.z, w.x, w.y, w.z];
                let mut velocities = multibody.generalized_velocity_mut();
                velocities.rows_mut(0, root.len()).copy_from_slice(&root);
            }
            None => {
                let root = &mut bodies[self.parts[0].0];
                root.set_linvel(rapier::Vector::new(v.x, v.y, v.z), true);
                root.set_angvel(rapier::Vector::new(w.x, w.y, w.z), true);
            }
        }
    }
}

fn collider(solid: &Solid) -> rapier::ColliderBuilder {
    let (builder, solid_from_collider) = match solid.shape {
        Shape::Cylinder { radius_m, length_m } => (
            rapier::ColliderBuilder::cylinder((length_m / 2.0) as f32, radius_m as f32),
            // rapier's cylinders run along y, ours along z.
            Isometry3::rotation(Vector3::x() * FRAC_PI_2),
        ),
        Shape::Cuboid { half_extents_m: half } => (
            rapier::ColliderBuilder::cuboid(half.x as f32, half.y as f32, half.z as f32),
            Isometry3::identity(),
        ),
        Shape::Sphere { radius_m } => {
            (rapier::ColliderBuilder::ball(radius_m as f32), Isometry3::identity())
        }
        Shape::Capsule { radius_m, length_m } => (
            rapier::ColliderBuilder::capsule_z((length_m / 2.0) as f32, radius_m as f32),
            Isometry3::identity(),
        ),
    };
    let pose = to_rapier(&(solid.part_from_solid * solid_from_collider));
    let collider = Scene::link_collider(builder).position(pose);
    match &solid.inertia {
        None => collider.mass(solid.mass_kg as f32),
        Some(inertia) => {
            collider.mass_properties(mass_properties(solid.mass_kg, inertia, &solid_from_collider))
        }
    }
}

fn mass_properties(
    mass_kg: f64,
    inertia: &Inertia,
    solid_from_collider: &Isometry3<f64>,
) -> rapier::MassProperties {
    let centre_m = solid_from_collider.inverse_transform_point(&inertia.centre_m.into());
    let axes = solid_from_collider.rotation.to_rotation_matrix();
    let moments = axes.transpose() * inertia.about_centre_kg_m2 * axes;
    let column = |i| {
        let column = moments.column(i).into_owned().cast::<f32>();
        rapier::Vector::new(column.x, column.y, column.z)
    };
    rapier::MassProperties::with_inertia_matrix(
        rapier::Vector::new(centre_m.x as f32, centre_m.y as f32, centre_m.z as f32),
        mass_kg as f32,
        rapier::Matrix::from_cols(column(0), column(1), column(2)),
    )
}

fn to_rapier(pose: &Isometry3<f64>) -> rapier::Pose {
    let t = pose.translation.vector.cast::<f32>();
    let r = pose.rotation.coords.cast::<f32>();
    rapier::Pose::from_parts(
        rapier::Vector::new(t.x, t.y, t.z),
        rapier::Rotation::from_xyzw(r.x, r.y, r.z, r.w).normalize(),
    )
}

fn from_rapier(pose: &rapier::Pose) -> Isometry3<f64> {
    let translation = Vector3::from(pose.translation.to_array()).cast::<f64>();
    let [x, y, z, w] = pose.rotation.to_array().map(f64::from);
    Isometry3::from_parts(
        translation.into(),
        UnitQuaternion::new_normalize(Quaternion::new(w, x, y, z)),
    )
}
