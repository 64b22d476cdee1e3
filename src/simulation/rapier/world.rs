//! Bodies in rapier's world.

use super::convert::{self, from_rapier, to_rapier};
use super::scene::Scene;
use super::solid::collider;
use super::surface;
use crate::simulation::assembly::{Assembly, Hinge, Member, Part};
use crate::simulation::failure::Failure;
use crate::simulation::trial::Trial;
use crate::simulation::world::{Stepper, World};
use nalgebra::{Isometry3, Vector3};
use rapier3d::prelude as rapier;

/// How eagerly a motor corrects its speed, in N·m·s/rad: so large that only its greatest torque limits it.
const MOTOR_GAIN: f32 = 1e6;

/// Bodies in rapier's world.
pub struct RapierWorld {
    scene: Scene,
    /// The rigid body of each part, and its joint if it has a hinge.
    parts: Vec<(rapier::RigidBodyHandle, Option<rapier::MultibodyJointHandle>)>,
    bodies: Vec<Member>,
    /// Whether forces were applied that act in the next step only.
    is_forced: bool,
}

impl RapierWorld {
    /// Puts a body into a fresh world.
    pub fn new(assembly: &Assembly, trial: &Trial) -> Self {
        Self::of_several(assembly, trial, false)
    }

    /// Puts bodies into a fresh world, where they may collide with each other.
    pub fn of_several(assembly: &Assembly, trial: &Trial, collide: bool) -> Self {
        let bodies = assembly.bodies.clone();
        let mut world =
            Self { scene: Scene::new(trial), parts: Vec::new(), bodies, is_forced: false };
        for (index, body) in assembly.bodies.iter().enumerate() {
            let groups = surface::of_body(index, collide);
            for part in &assembly.parts[body.parts.clone()] {
                let rigid_body = world.insert(part, groups);
                let joint = part.hinge.as_ref().map(|hinge| world.join(hinge, rigid_body));
                world.parts.push((rigid_body, joint));
            }
        }
        world.free_of_hidden_forces();
        world
    }

    fn insert(
        &mut self,
        part: &Part,
        groups: rapier::InteractionGroups,
    ) -> rapier::RigidBodyHandle {
        let pose = to_rapier(&part.world_from_part);
        let builder = rapier::RigidBodyBuilder::dynamic().pose(pose).can_sleep(false);
        let rigid_body = self.scene.world.insert_body(builder);
        for solid in &part.solids {
            self.scene.world.insert_collider(collider(solid, groups), Some(rigid_body));
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
        for index in 0..self.bodies.len() {
            if let Some(multibody) = self.multibody(index) {
                multibody.set_self_contacts_enabled(false);
                multibody.damping_mut().fill(0.0);
            }
        }
    }

    /// The multibody of a body, if it has joints: any of them leads to it.
    fn multibody(&mut self, body: usize) -> Option<&mut rapier::Multibody> {
        let parts = self.bodies[body].parts.clone();
        let joint = self.parts[parts].iter().find_map(|(_, joint)| *joint)?;
        Some(self.scene.world.multibody_joints.get_mut(joint)?.0)
    }

    /// Takes away the forces that acted in a step.
    fn forget_forces(&mut self) {
        if std::mem::take(&mut self.is_forced) {
            for (rigid_body, _) in &self.parts {
                let rigid_body = &mut self.scene.world.bodies[*rigid_body];
                rigid_body.reset_forces(false);
                rigid_body.reset_torques(false);
            }
        }
    }

    fn rigid_body(&self, part: usize) -> &rapier::RigidBody {
        &self.scene.world.bodies[self.parts[part].0]
    }
}

impl Stepper for RapierWorld {
    fn step(&mut self) -> Result<(), Failure> {
        self.scene.world.step();
        self.forget_forces();
        let is_sound = self.scene.world.quarantine().is_empty();
        if is_sound { Ok(()) } else { Err(Failure::NotFinite) }
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
        for index in 0..self.bodies.len() {
            if let Some(multibody) = self.multibody(index) {
                multibody.generalized_velocity_mut().fill(0.0);
            }
        }
        for (rigid_body, _) in &self.parts {
            let rigid_body = &mut self.scene.world.bodies[*rigid_body];
            rigid_body.set_linvel(rapier::Vector::ZERO, false);
            rigid_body.set_angvel(rapier::Vector::ZERO, false);
        }
    }

    fn push(&mut self, body: &Member, velocity_m_s: Vector3<f64>) {
        let index = self.bodies.iter().position(|it| it == body);
        if let Some(multibody) = index.and_then(|index| self.multibody(index)) {
            // The root's first; all others are relative to it.
            let mut velocities = multibody.generalized_velocity_mut();
            let mut root = velocities.rows_mut(0, 3);
            root += velocity_m_s.cast::<f32>();
        }
        for (rigid_body, _) in &self.parts[body.parts.clone()] {
            let rigid_body = &mut self.scene.world.bodies[*rigid_body];
            let pushed = rigid_body.linvel() + convert::vector(&velocity_m_s);
            rigid_body.set_linvel(pushed, false);
        }
    }

    fn apply(&mut self, part: usize, force_n: Vector3<f64>, torque_nm: Vector3<f64>) {
        let rigid_body = &mut self.scene.world.bodies[self.parts[part].0];
        rigid_body.add_force(convert::vector(&force_n), false);
        rigid_body.add_torque(convert::vector(&torque_nm), false);
        self.is_forced = true;
    }

    fn world_from_part(&self, part: usize) -> Isometry3<f64> {
        from_rapier(self.rigid_body(part).position())
    }

    fn velocity_m_s(&self, part: usize) -> Vector3<f64> {
        Vector3::from(self.rigid_body(part).linvel().to_array()).cast()
    }

    fn turn_rad_s(&self, part: usize) -> Vector3<f64> {
        Vector3::from(self.rigid_body(part).angvel().to_array()).cast()
    }

    fn touches(&self, part: usize) -> bool {
        let narrow_phase = &self.scene.world.narrow_phase;
        let mut pairs = self
            .rigid_body(part)
            .colliders()
            .iter()
            .flat_map(|collider| narrow_phase.contact_pairs_with(*collider));
        pairs.any(|pair| pair.total_impulse_magnitude() > 0.0)
    }

    #[cfg(test)]
    fn kick(&mut self, velocity_m_s: Vector3<f64>, turn_rad_s: Vector3<f64>) {
        let [v, w] = [velocity_m_s, turn_rad_s].map(|it| it.cast::<f32>());
        match self.multibody(0) {
            Some(multibody) => {
                let root = [v.x, v.y, v.z, w.x, w.y, w.z];
                let mut velocities = multibody.generalized_velocity_mut();
                velocities.rows_mut(0, root.len()).copy_from_slice(&root);
            }
            None => {
                let root = &mut self.scene.world.bodies[self.parts[0].0];
                root.set_linvel(rapier::Vector::new(v.x, v.y, v.z), true);
                root.set_angvel(rapier::Vector::new(w.x, w.y, w.z), true);
            }
        }
    }
}
