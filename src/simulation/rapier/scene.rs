//! The world that bodies are put into: a ground, gravity, a clock.

use super::super::terrain::Ground;
use super::super::trial::{FRICTION, Trial};
use super::{field, surface};
use rapier3d::prelude::*;

/// A world with a ground.
pub struct Scene {
    pub(super) world: PhysicsWorld,
}

impl Scene {
    /// A world without a body yet.
    pub fn new(trial: &Trial) -> Self {
        let mut world = PhysicsWorld::new();
        world.gravity = Vector::new(0.0, 0.0, -trial.gravity_m_s2 as f32);
        world.integration_parameters = IntegrationParameters {
            dt: 1.0 / trial.steps_per_s as f32,
            // Each iteration is a whole substep: one at a small time step is as sound as four, and three
            // times faster.
            num_solver_iterations: 1,
            // Sweeps over motors and contacts within it. Motor rows begin each step from nothing: with one sweep they
            // miss their targets, and evolution finds bodies that walk by what is left (tests/physics/exploits). Six strong
            // motors in a row miss by 0.13 rad/s with one, by 0.06, 0.02, 0.003 and 0.0002 with 2, 4, 8 and 16.
            num_internal_pgs_iterations: 8,
            max_ccd_substeps: 0,
            ..IntegrationParameters::default()
        };
        let grounds = match &trial.ground {
            Ground::Terrain(terrain) => field::colliders(terrain),
            Ground::Plane => {
                let plane = ColliderBuilder::halfspace(nalgebra::Unit::new_unchecked(Vector::Z));
                vec![surface::collider(plane, surface::of_ground())]
            }
        };
        let friction = FRICTION * trial.perturbation.friction * trial.ground.roughness();
        for ground in grounds {
            world.insert_collider(ground.friction(friction as f32), None);
        }
        Self { world }
    }
}
