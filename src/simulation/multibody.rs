//! A creature's body in the world, in reduced coordinates.
//!
//! Joints of rapier's multibodies cannot drift apart, as its impulse joints do under random bodies. Links
//! that a fixed joint holds together are one rigid body: there is nothing to solve between them.

use super::scene::{Scene, Start, Trial};
use super::trajectory::Pose;
use crate::creature::{Creature, Joint, JointKind, Morphology, Shape};
use nalgebra::{Isometry3, UnitQuaternion, Vector3};
use rapier3d::prelude as rapier;
use std::f64::consts::FRAC_PI_2;

/// How eagerly a motor corrects its speed, in N·m·s/rad: so large that only its greatest torque limits it.
pub(super) const MOTOR_GAIN: f32 = 1e6;

/// A body in a scene.
pub struct Body {
    /// Where each link is: a rigid body and the link's place in it.
    links: Vec<Place>,
    /// Every rigid body once, the root's first.
    pub(super) rigid_bodies: Vec<rapier::RigidBodyHandle>,
    /// The joint of each link that has a hinge.
    pub(super) hinges: Vec<Option<rapier::MultibodyJointHandle>>,
}

#[derive(Clone, Copy)]
struct Place {
    rigid_body: rapier::RigidBodyHandle,
    rigid_body_from_link: Isometry3<f64>,
}

impl Place {
    fn pose(&self, scene: &Scene) -> rapier::Pose {
        scene.world.bodies[self.rigid_body].position() * to_rapier(&self.rigid_body_from_link)
    }
}

impl Body {
    /// Puts a creature into a scene.
    pub fn build(scene: &mut Scene, creature: &Creature, trial: &Trial) -> Self {
        let morphology = &creature.morphology;
        let height_m = match trial.start {
            Start::RootAt(height_m) => height_m,
            Start::LowestAt(height_m) => height_m - morphology.lowest_m(),
        };
        let lift = nalgebra::Translation3::new(0.0, 0.0, height_m);
        let mut body = Self { links: Vec::new(), rigid_bodies: Vec::new(), hinges: Vec::new() };
        for (index, (link, rest)) in
            morphology.links.iter().zip(morphology.rest_poses()).enumerate()
        {
            let place = match &link.joint {
                Some(Joint { parent, kind: JointKind::Fixed, .. }) => body.merged(*parent, link),
                Some(_) => body.separate(scene, lift * rest, Isometry3::identity()),
                None => body.separate(scene, lift * rest, from_root_centre(morphology)),
            };
            body.links.push(place);
            body.add_solid(scene, place, &link.shape, link.mass_kg);
            let motor = creature.controller.motors[index];
            let hinge = link.joint.as_ref().and_then(|joint| {
                let JointKind::Revolute(axis) = joint.kind else { return None };
                let torque_nm_max = motor.map_or(0.0, |motor| motor.torque_nm_max);
                Some(body.add_hinge(scene, place, joint, &axis, torque_nm_max))
            });
            body.hinges.push(hinge);
        }
        body.free_of_hidden_forces(scene);
        body
    }

    /// The pose of every link.
    pub fn poses(&self, scene: &Scene) -> Vec<Pose> {
        let pose = |place: &Place| {
            let pose = place.pose(scene);
            Pose {
                position_m: pose.translation.to_array(),
                rotation_xyzw: pose.rotation.normalize().to_array(),
            }
        };
        self.links.iter().map(pose).collect()
    }

    /// The position of the root link, in metres.
    pub fn root_position(&self, scene: &Scene) -> Vector3<f64> {
        from_rapier(self.links[0].pose(scene).translation)
    }

    /// The centre of mass of the whole body, in metres.
    pub fn centre_of_mass(&self, scene: &Scene) -> Vector3<f64> {
        let mut moment = Vector3::zeros();
        let mut mass_kg = 0.0;
        for &handle in &self.rigid_bodies {
            let rigid_body = &scene.world.bodies[handle];
            let m = f64::from(rigid_body.mass());
            moment += m * from_rapier(rigid_body.center_of_mass());
            mass_kg += m;
        }
        moment / mass_kg
    }

    fn merged(&self, parent: usize, link: &crate::creature::Link) -> Place {
        let Place { rigid_body, rigid_body_from_link: rigid_body_from_parent } = self.links[parent];
        let joint = link.joint.as_ref().expect("only a link with a joint is merged");
        let parent_from_link = joint.parent_from_joint * joint.joint_from_link;
        Place { rigid_body, rigid_body_from_link: rigid_body_from_parent * parent_from_link }
    }

    fn separate(
        &mut self,
        scene: &mut Scene,
        world_from_link: Isometry3<f64>,
        rigid_body_from_link: Isometry3<f64>,
    ) -> Place {
        let pose = to_rapier(&(world_from_link * rigid_body_from_link.inverse()));
        let builder = rapier::RigidBodyBuilder::dynamic().pose(pose).can_sleep(false);
        let rigid_body = scene.world.insert_body(builder);
        self.rigid_bodies.push(rigid_body);
        Place { rigid_body, rigid_body_from_link }
    }

    fn add_solid(&self, scene: &mut Scene, place: Place, shape: &Shape, mass_kg: f64) {
        let (builder, link_from_solid) = match *shape {
            Shape::Cylinder { radius_m, length_m } => (
                rapier::ColliderBuilder::cylinder((length_m / 2.0) as f32, radius_m as f32),
                // rapier's cylinders run along y, ours along z.
                Isometry3::rotation(Vector3::x() * FRAC_PI_2),
            ),
            Shape::Cuboid { half_extents_m: half } => (
                rapier::ColliderBuilder::cuboid(half.x as f32, half.y as f32, half.z as f32),
                Isometry3::identity(),
            ),
        };
        let pose = place.rigid_body_from_link * link_from_solid;
        let collider =
            Scene::link_collider(builder).mass(mass_kg as f32).position(to_rapier(&pose));
        scene.world.insert_collider(collider, Some(place.rigid_body));
    }

    fn add_hinge(
        &self,
        scene: &mut Scene,
        place: Place,
        joint: &Joint,
        axis: &Vector3<f64>,
        torque_nm_max: f64,
    ) -> rapier::MultibodyJointHandle {
        let parent = self.links[joint.parent];
        // rapier's hinge turns about the x axis of the joint's frame.
        let to_axis = UnitQuaternion::rotation_between(&Vector3::x(), axis)
            .expect("a hinge's axis is a positive unit axis, never -x");
        let parent_from_hinge = parent.rigid_body_from_link * joint.parent_from_joint * to_axis;
        let link_from_hinge = joint.joint_from_link.inverse() * to_axis;
        let hinge = rapier::GenericJointBuilder::new(rapier::JointAxesMask::LOCKED_REVOLUTE_AXES)
            .local_frame1(to_rapier(&parent_from_hinge))
            .local_frame2(to_rapier(&link_from_hinge))
            .motor_velocity(rapier::JointAxis::AngX, 0.0, MOTOR_GAIN)
            .motor_max_force(rapier::JointAxis::AngX, torque_nm_max as f32)
            .contacts_enabled(false);
        scene
            .world
            .insert_multibody_joint(parent.rigid_body, place.rigid_body, hinge)
            .expect("a new rigid body closes no loop")
    }

    /// Takes away the damping that rapier gives to angular degrees of freedom, the free root's included:
    /// nothing but motors, gravity and the ground acts on a body.
    fn free_of_hidden_forces(&self, scene: &mut Scene) {
        for hinge in self.hinges.iter().flatten().take(1) {
            if let Some((multibody, _)) = scene.world.multibody_joints.get_mut(*hinge) {
                multibody.set_self_contacts_enabled(false);
                multibody.damping_mut().fill(0.0);
            }
        }
    }
}

/// The root link's frame in that of its rigid body, whose origin is the centre of mass of all that is fixed to
/// the root. rapier moves a multibody's free root by the velocity of its centre of mass but turns it about its
/// origin: with the two apart a body that turns travels by itself.
fn from_root_centre(morphology: &Morphology) -> Isometry3<f64> {
    let mut root_from_link: Vec<Option<Isometry3<f64>>> = Vec::new();
    let (mut moment, mut mass_kg) = (Vector3::zeros(), 0.0);
    for link in &morphology.links {
        let pose = match &link.joint {
            None => Some(Isometry3::identity()),
            Some(joint) if joint.kind == JointKind::Fixed => root_from_link[joint.parent]
                .map(|parent| parent * joint.parent_from_joint * joint.joint_from_link),
            Some(_) => None,
        };
        if let Some(pose) = pose {
            moment += link.mass_kg * pose.translation.vector;
            mass_kg += link.mass_kg;
        }
        root_from_link.push(pose);
    }
    nalgebra::Translation3::from(-moment / mass_kg).into()
}

fn to_rapier(pose: &Isometry3<f64>) -> rapier::Pose {
    let t = pose.translation.vector;
    let r = pose.rotation.coords;
    rapier::Pose::from_parts(
        rapier::Vector::new(t.x as f32, t.y as f32, t.z as f32),
        rapier::Rotation::from_xyzw(r.x as f32, r.y as f32, r.z as f32, r.w as f32).normalize(),
    )
}

fn from_rapier(vector: rapier::Vector) -> Vector3<f64> {
    Vector3::new(f64::from(vector.x), f64::from(vector.y), f64::from(vector.z))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::creature::gene::PARAMETER_COUNT;
    use crate::creature::{Gene, Profile, express};
    use crate::simulation::simulate;

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
        let trial = Trial {
            steps_per_s: 240,
            gravity_m_s2: 0.0,
            start: Start::RootAt(10.0),
            settle_s: 0.0,
            scored_s: 4.0,
            keeps_ledger: true,
        };
        let measured = simulate(&creature, &trial).unwrap();
        assert!((measured.root_last_m - measured.root_first_m).norm() > 0.01, "{measured:?}");
        assert!((measured.centre_last_m - measured.centre_first_m).norm() < 0.01, "{measured:?}");
    }
}
