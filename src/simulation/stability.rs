//! Guards against what no body does: a solver that blows up must not pass for an athlete.

use super::multibody::Body;
use super::scene::Scene;
use crate::creature::Creature;
use crate::evolution::Outcome;

/// No healthy link is ever this fast, in m/s: the 99th percentile of random bodies is 6 to 7.
const SPEED_MAX_M_S: f32 = 50.0;

/// A link may rise above where it began by this many body lengths…
const RISE_MAX_EXTENTS: f64 = 2.0;
/// … and this much, in metres.
const RISE_MAX_M: f64 = 1.0;

/// The bounds of one body.
pub struct Guard {
    height_max_m: f32,
}

impl Guard {
    /// The bounds of a body that was just put into its scene.
    pub fn new(body: &Body, scene: &Scene, creature: &Creature) -> Self {
        let heights = body.rigid_bodies.iter().map(|&b| scene.world.bodies[b].translation().z);
        let start_m = heights.fold(f32::NEG_INFINITY, f32::max);
        let rise_m = RISE_MAX_EXTENTS * creature.morphology.extent_m() + RISE_MAX_M;
        Self { height_max_m: start_m + rise_m as f32 }
    }

    /// The cheap check of every step: whether rapier met a number that is none.
    pub fn check_step(&self, scene: &Scene) -> Result<(), Outcome> {
        if scene.world.quarantine().is_empty() { Ok(()) } else { Err(Outcome::NotFinite) }
    }

    /// Looks at every rigid body.
    pub fn check_body(&self, body: &Body, scene: &Scene) -> Result<(), Outcome> {
        for &handle in &body.rigid_bodies {
            let rigid_body = &scene.world.bodies[handle];
            let (position, velocity) = (rigid_body.translation(), rigid_body.linvel());
            if !(position.is_finite() && velocity.is_finite()) {
                return Err(Outcome::NotFinite);
            }
            if velocity.length_squared() > SPEED_MAX_M_S * SPEED_MAX_M_S {
                return Err(Outcome::TooFast);
            }
            if position.z > self.height_max_m {
                return Err(Outcome::Launched);
            }
        }
        Ok(())
    }
}
