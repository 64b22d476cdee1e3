//! Plays a controller's motors on a body.

use super::assembly::Assembly;
use super::trial::Trial;
use super::world::World;
use crate::creature::{Controller, Motor};

/// The motors of one body, each with the part that it drives and the phase that it is at, in radians.
pub struct Actuators {
    motors: Vec<(usize, Motor, f64)>,
    period_s: f64,
}

impl Actuators {
    /// Motors before their first update.
    pub fn new(controller: &Controller, assembly: &Assembly) -> Self {
        let links = controller.motors.iter().zip(&assembly.places);
        let motors = links.filter_map(|(motor, place)| {
            let motor = (*motor)?;
            Some((place.part, motor, motor.phase_start_rad))
        });
        Self { motors: motors.collect(), period_s: controller.period_s }
    }

    /// Steps from one motor update to the next.
    pub fn control_steps(&self, trial: &Trial) -> u32 {
        trial.steps_in(self.period_s)
    }

    /// One motor update: advances each phase and sets each hinge's target speed.
    pub fn update(&mut self, world: &mut impl World) {
        for (part, motor, phase_rad) in &mut self.motors {
            *phase_rad = motor.advance(*phase_rad);
            world.drive(*part, motor.target_rad_s(*phase_rad));
        }
    }
}
