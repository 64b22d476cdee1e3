//! The engine of record: rapier's multibodies, in reduced coordinates.
//!
//! Joints of rapier's multibodies cannot drift apart, as its impulse joints do under random bodies.
//!
//! Architecture invariants: this alone imports rapier; every trial builds a fresh world, since a world that was
//! used before gives other bits; all is f64 up to this border and f32 within it.

mod scene;

use super::assembly::{Assembly, Hinge, Part, Solid};
use super::trial::Trial;
use super::world::World;
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
        let Some(joint) = self.parts.iter().find_map(|(_, joint)| *joint) else { return };
        if let Some((multibody, _)) = self.scene.world.multibody_joints.get_mut(joint) {
            multibody.set_self_contacts_enabled(false);
            multibody.damping_mut().fill(0.0);
        }
    }

    fn rigid_body(&self, part: usize) -> &rapier::RigidBody {
        &self.scene.world.bodies[self.parts[part].0]
    }
}

impl World for RapierWorld {
    fn step(&mut self) -> Result<(), Outcome> {
        self.scene.world.step();
        let is_sound = self.scene.world.quarantine().is_empty();
        if is_sound { Ok(()) } else { Err(Outcome::NotFinite) }
    }

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

    fn world_from_part(&self, part: usize) -> Isometry3<f64> {
        from_rapier(self.rigid_body(part).position())
    }

    fn velocity_m_s(&self, part: usize) -> Vector3<f64> {
        Vector3::from(self.rigid_body(part).linvel().to_array()).cast()
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

#[cfg(test)]
mod tests {
    use super::super::stability::Ledger;
    use super::super::trial::Start;
    use super::super::world::centre_of_mass;
    use super::super::{Engine, simulate};
    use super::*;
    use crate::creature::gene::PARAMETER_COUNT;
    use crate::creature::{Gene, Profile, express};

    const TRIAL: Trial = Trial {
        steps_per_s: 240,
        gravity_m_s2: 9.81,
        start: Start::LowestAt(0.0),
        settle_s: 0.0,
        scored_s: 2.0,
        keeps_ledger: true,
    };

    /// Pushes a log that lies on the ground and enters what it does.
    fn pushed(pushes_m_s: &[f32]) -> Result<(), Outcome> {
        let log = express(&[Gene([0.5; PARAMETER_COUNT])], Profile::Native, 1).unwrap();
        let log = Assembly::new(&log, &TRIAL);
        let mut world = RapierWorld::new(&log, &TRIAL);
        let mut ledger = Ledger::new(&TRIAL, 24, centre_of_mass(&world, &log));
        for &push_m_s in pushes_m_s {
            let rigid_body = &mut world.scene.world.bodies[world.parts[0].0];
            let push = rapier::Vector::new(push_m_s, 0.0, 0.0);
            rigid_body.set_linvel(rigid_body.linvel() + push, true);
            for _ in 0..5 {
                (0..24).try_for_each(|_| world.step())?;
                ledger.enter(centre_of_mass(&world, &log))?;
            }
        }
        Ok(())
    }

    #[test]
    fn a_body_that_slides_to_a_halt_has_accounted_for_its_momentum() {
        assert_eq!(pushed(&[3.0, 0.0, 0.0, 0.0]), Ok(()));
    }

    /// What other engines are held against too, in `tests/engines`.
    #[test]
    fn a_box_that_is_pushed_slides_as_far_as_friction_lets_it() {
        let log = express(&[Gene([0.5; PARAMETER_COUNT])], Profile::Native, 1).unwrap();
        let log = Assembly::new(&log, &TRIAL);
        let mut world = RapierWorld::new(&log, &TRIAL);
        let push = rapier::Vector::new(3.0, 0.0, 0.0);
        world.scene.world.bodies[world.parts[0].0].set_linvel(push, true);
        let from = centre_of_mass(&world, &log);
        (0..480).try_for_each(|_| world.step()).unwrap();
        let slid_m = (centre_of_mass(&world, &log) - from).norm();
        let expected_m = 3.0 * 3.0 / (2.0 * 0.25 * TRIAL.gravity_m_s2);
        assert!((slid_m / expected_m - 1.0).abs() < 0.02, "{slid_m} m");
    }

    #[test]
    fn a_push_from_nowhere_is_found() {
        assert_eq!(pushed(&[3.0, 0.0, 0.7, 0.0]), Err(Outcome::Unphysical));
    }

    #[test]
    fn nothing_that_a_body_does_in_empty_space_moves_its_centre_of_mass() {
        let (root, mut fixed, mut limb) = (
            Gene([0.5; PARAMETER_COUNT]),
            Gene([0.7; PARAMETER_COUNT]),
            Gene([0.3; PARAMETER_COUNT]),
        );
        (fixed.0[5], fixed.0[6]) = (0.9, 0.0);
        (limb.0[5], limb.0[6], limb.0[15]) = (0.1, 0.0, 0.9);
        let creature = express(&[root, fixed, limb], Profile::Native, 8).unwrap();
        let start = Start::RootAt(10.0);
        let trial = Trial { gravity_m_s2: 0.0, start, scored_s: 4.0, ..TRIAL };
        let measured = simulate(&creature, &trial, Engine::Rapier).unwrap();
        assert!((measured.root_last_m - measured.root_first_m).norm() > 0.01, "{measured:?}");
        assert!((measured.centre_last_m - measured.centre_first_m).norm() < 0.01, "{measured:?}");
    }
}
