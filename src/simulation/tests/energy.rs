//! What nothing drives gains no energy.

use super::super::Engine;
use super::bodies::{Body, Hinge, limbs};
use super::lab::Lab;
use super::{GRAVITY_M_S2, SPACE, TRIAL};
use crate::creature::Creature;
use nalgebra::{Isometry3, Vector3};

const SECONDS: u32 = 10;

/// Single precision and the length of a step are worth this part of the energy that moves to and fro.
const TOLERANCE: f64 = 0.005;

/// Three rods of 1 kg and half a metre, held out sideways; they swing within what they hang on.
fn chain() -> Creature {
    let hinge = |parent, at_m: [f64; 2]| Hinge {
        parent,
        parent_from_hinge: Isometry3::translation(at_m[0], 0.0, at_m[1]),
        centre_m: Vector3::x() * 0.25,
        axis: Vector3::y(),
        torque_nm_max: 0.0,
    };
    let rod = [0.25, 0.05, 0.08];
    Body::of([1.0; 3], 1e4)
        .with(rod, 1.0, hinge(0, [0.0, 0.9]))
        .with(rod, 1.0, hinge(1, [0.25, 0.0]))
        .with(rod, 1.0, hinge(2, [0.25, 0.0]))
        .build()
}

/// The most that the energy of the parts from `first` on ever rises above what it was, in joules.
fn gain_j(lab: &mut Lab, first: usize) -> f64 {
    let energy_j = |lab: &mut Lab| lab.motion().energies_j[first..].iter().sum::<f64>();
    let start_j = energy_j(lab);
    let steps = (f64::from(SECONDS) / lab.step_s()) as u32;
    (0..steps).map(|_| energy_j(lab) - start_j).fold(f64::NEG_INFINITY, f64::max)
}

#[test]
fn the_energy_of_a_chain_that_swings_freely_never_grows() {
    for engine in Engine::ALL {
        let mut lab = Lab::new(engine, &chain(), TRIAL);
        // What it has when it hangs down, less what it has when it is held out.
        let swing_j = 3.0 * GRAVITY_M_S2 * 0.75;
        let gain_j = gain_j(&mut lab, 1);
        assert!(gain_j < TOLERANCE * swing_j, "{engine}: {gain_j} of {swing_j} J");
    }
}

#[test]
fn the_energy_of_a_body_that_tumbles_freely_never_grows() {
    for engine in Engine::ALL {
        let mut lab = Lab::new(engine, &limbs(0.0), SPACE);
        lab.world.kick(Vector3::zeros(), Vector3::new(1.0, 2.0, -1.5));
        let start_j: f64 = lab.motion().energies_j.iter().sum();
        let gain_j = gain_j(&mut lab, 0);
        assert!(gain_j < TOLERANCE * start_j, "{engine}: {gain_j} of {start_j} J");
    }
}
