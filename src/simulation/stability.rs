//! Guards against what no body does: a solver that blows up must not pass for an athlete.

use super::multibody::Body;
use super::scene::{FRICTION, Scene, Trial};
use crate::creature::Creature;
use crate::evolution::Outcome;
use nalgebra::Vector3;

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

/// Speed that a body may gain out of nothing in a trial, in m/s. At 240 Hz 1,000 random bodies gained at most 0.024
/// (99 % of them 0.008) and three evolved champions 0.035. Bodies that turn about another point than their centre of
/// mass, the worst fault found so far, gained up to 23, every tenth body more than 0.6.
const EXCESS_MAX_M_S: f64 = 0.1;

/// The ledger of a body's momentum.
///
/// Gravity and Coulomb friction are all that acts on a body from outside, so at any moment the acceleration of
/// its centre of mass obeys |a_h| ≤ µ (a_z + g), whatever its motors do. An average over time keeps this true.
/// The change of the mean velocity from one period of length T to the next is such an average, so it needs
/// nothing but the positions that the score is made of: |Δv_h| ≤ µ (Δv_z + g T). What is above is the solver's.
#[derive(Debug, Clone)]
pub struct Ledger {
    period_s: f64,
    gravity_m_s2: f64,
    position_m: Vector3<f64>,
    velocity_m_s: Option<Vector3<f64>>,
    excess_m_s: f64,
}

impl Ledger {
    /// A ledger of positions that many steps apart, the first of them given.
    pub fn new(trial: &Trial, steps: u32, position_m: Vector3<f64>) -> Self {
        Self {
            period_s: trial.time_s(steps),
            gravity_m_s2: trial.gravity_m_s2,
            position_m,
            velocity_m_s: None,
            excess_m_s: 0.0,
        }
    }

    /// Enters the next position of the centre of mass.
    pub fn enter(&mut self, position_m: Vector3<f64>) -> Result<(), Outcome> {
        let velocity_m_s = (position_m - self.position_m) / self.period_s;
        if let Some(before_m_s) = self.velocity_m_s {
            let change_m_s = velocity_m_s - before_m_s;
            let support_m_s = change_m_s.z + self.gravity_m_s2 * self.period_s;
            let grip_m_s = f64::from(FRICTION * FRICTION) * support_m_s;
            self.excess_m_s += (change_m_s.xy().norm() - grip_m_s).max(0.0);
        }
        (self.position_m, self.velocity_m_s) = (position_m, Some(velocity_m_s));
        if self.excess_m_s > EXCESS_MAX_M_S { Err(Outcome::Unphysical) } else { Ok(()) }
    }
}

#[cfg(test)]
mod tests {
    use super::super::scene::Start;
    use super::*;
    use crate::creature::gene::PARAMETER_COUNT;
    use crate::creature::{Gene, Profile, express};
    use rapier3d::prelude::Vector;

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
        let mut scene = Scene::new(&TRIAL);
        let body = Body::build(&mut scene, &log, &TRIAL);
        let mut ledger = Ledger::new(&TRIAL, 24, body.centre_of_mass(&scene));
        for &push_m_s in pushes_m_s {
            let log = &mut scene.world.bodies[body.rigid_bodies[0]];
            log.set_linvel(log.linvel() + Vector::new(push_m_s, 0.0, 0.0), true);
            for _ in 0..5 {
                (0..24).for_each(|_| scene.step());
                ledger.enter(body.centre_of_mass(&scene))?;
            }
        }
        Ok(())
    }

    #[test]
    fn a_body_that_slides_to_a_halt_has_accounted_for_its_momentum() {
        assert_eq!(pushed(&[3.0, 0.0, 0.0, 0.0]), Ok(()));
    }

    #[test]
    fn a_push_from_nowhere_is_found() {
        assert_eq!(pushed(&[3.0, 0.0, 0.7, 0.0]), Err(Outcome::Unphysical));
    }

    #[test]
    fn a_jump_that_takes_its_grip_from_the_ground_is_no_push() {
        let mut ledger = Ledger::new(&TRIAL, 24, Vector3::zeros());
        let (fall_m, hop_m) = (-9.81 * 0.01, 0.05);
        ledger.enter(Vector3::zeros()).unwrap();
        assert_eq!(ledger.enter(Vector3::new(0.03, 0.0, hop_m)), Ok(()));
        let falling = Vector3::new(0.06, 0.0, 2.0 * hop_m + fall_m);
        assert_eq!(ledger.clone().enter(falling), Ok(()));
        assert_eq!(ledger.enter(falling + Vector3::x() * 0.02), Err(Outcome::Unphysical));
    }
}
