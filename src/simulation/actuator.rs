//! Plays a controller's motors on a body.

use super::multibody::{Body, MOTOR_GAIN};
use super::scene::Scene;
use crate::creature::Controller;
use rapier3d::prelude::JointAxis;

/// The motors of one body and the phases that they are at, in radians.
pub struct Actuators<'a> {
    controller: &'a Controller,
    phases_rad: Vec<f64>,
}

impl<'a> Actuators<'a> {
    /// Motors before their first update.
    pub fn new(controller: &'a Controller) -> Self {
        let start = controller.motors.iter().map(|m| m.map_or(0.0, |m| m.phase_start_rad));
        Self { controller, phases_rad: start.collect() }
    }

    /// One motor update: advances each phase and sets each hinge's target speed.
    pub fn update(&mut self, body: &Body, scene: &mut Scene) {
        let motors = self.controller.motors.iter().zip(&mut self.phases_rad).zip(&body.hinges);
        for ((motor, phase_rad), hinge) in motors {
            let (Some(motor), Some(hinge)) = (motor, hinge) else { continue };
            *phase_rad = motor.advance(*phase_rad);
            let target_rad_s = motor.target_rad_s(*phase_rad) as f32;
            let Some((multibody, id)) = scene.world.multibody_joints.get_mut(*hinge) else {
                continue;
            };
            if let Some(link) = multibody.link_mut(id) {
                link.joint.data.set_motor_velocity(JointAxis::AngX, target_rad_s, MOTOR_GAIN);
            }
        }
    }
}
