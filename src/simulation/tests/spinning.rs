//! What spins flat on the ground slows down by its friction times the distance from its axis of what it stands on.

use super::super::Engine;
use super::super::trial::GRIP;
use super::bodies::{SLED_M, sled, wheel};
use super::lab::Lab;
use super::{GRAVITY_M_S2, TRIAL};
use crate::creature::Creature;
use nalgebra::{UnitQuaternion, Vector3};

const SPIN_RAD_S: f64 = 12.0;
const SECONDS: f64 = 0.3;

/// How much of its speed it loses, as a part of what friction takes, less 1; and how far it gets, in metres.
fn error(engine: Engine, mut body: Creature, arm_m: f64) -> (f64, f64) {
    body.morphology.root_rotation = UnitQuaternion::identity();
    let link = &body.morphology.links[0];
    let torque_nm = GRIP * link.mass_kg * GRAVITY_M_S2 * arm_m;
    let mut lab = Lab::new(engine, &body, TRIAL);
    lab.run(0.5);
    let start_m = lab.centre_of_mass();
    lab.world.kick(Vector3::zeros(), Vector3::z() * SPIN_RAD_S);
    lab.run(0.1);
    let spin = lab.motion().spin.z;
    lab.run(SECONDS);
    let lost = spin - lab.motion().spin.z;
    let error = lost / (torque_nm * (SECONDS + lab.step_s())) - 1.0;
    (error, (lab.centre_of_mass() - start_m).norm())
}

#[test]
fn what_spins_flat_on_the_ground_slows_as_friction_says_and_stays_in_its_place() {
    let corners_m = libm::hypot(SLED_M[0], SLED_M[1]);
    for engine in Engine::ALL {
        for (body, arm_m) in [(sled().build(), corners_m), (wheel(0.3, 0.1), 0.3)] {
            let (error, moved_m) = error(engine, body, arm_m);
            assert!(error.abs() < 0.005, "{engine}: {error} with {arm_m} m");
            assert!(moved_m < 1e-3, "{engine}: {moved_m} m with {arm_m} m");
        }
    }
}
