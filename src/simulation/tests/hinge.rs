//! A driven hinge gains speed as its torque allows, until it has the speed that it aims at.

use super::super::Engine;
use super::SPACE;
use super::bodies::{Body, Hinge};
use super::lab::Lab;
use crate::creature::Creature;
use nalgebra::{Isometry3, Vector3};

const TORQUE_NM: f64 = 0.4;
const TARGET_RAD_S: f64 = 3.0;

/// Two boxes that turn against each other, each about its centre, so that nothing else moves.
fn rotor() -> Creature {
    let hinge = Hinge {
        parent: 0,
        parent_from_hinge: Isometry3::translation(0.0, 0.5, 0.0),
        centre_m: Vector3::zeros(),
        axis: Vector3::y(),
        torque_nm_max: TORQUE_NM,
    };
    Body::of([0.3, 0.2, 0.1], 5.0).with([0.3, 0.05, 0.2], 2.0, hinge).build()
}

/// What the torque accelerates: the two moments of inertia about the axis, one against the other.
fn inertia_kg_m2(rotor: &Creature) -> f64 {
    let links = rotor.morphology.links.iter();
    let inverse: f64 = links.map(|link| 1.0 / link.shape.inertia_kg_m2(link.mass_kg).y).sum();
    1.0 / inverse
}

#[test]
fn a_hinge_gains_speed_by_torque_over_inertia_and_no_more_than_it_aims_at() {
    let rotor = rotor();
    let gain_rad_s2 = TORQUE_NM / inertia_kg_m2(&rotor);
    let reached_s = TARGET_RAD_S / gain_rad_s2;
    for engine in Engine::ALL {
        for direction in [1.0, -1.0] {
            let mut lab = Lab::new(engine, &rotor, SPACE);
            lab.world.drive(1, direction * TARGET_RAD_S);
            let angle = |lab: &Lab| lab.pose(0).rotation.inverse() * lab.pose(1).rotation;
            let mut time_s = 0.0;
            while time_s < 2.0 * reached_s {
                let before = angle(&lab);
                lab.step();
                time_s += lab.step_s();
                let turned_rad = (angle(&lab) * before.inverse()).scaled_axis().y;
                let speed_rad_s = direction * turned_rad / lab.step_s();
                let expected_rad_s = TARGET_RAD_S.min(gain_rad_s2 * time_s);
                let error = (speed_rad_s - expected_rad_s).abs() / TARGET_RAD_S;
                assert!(error < 2e-3, "{engine}: {speed_rad_s} rad/s after {time_s} s");
            }
            assert!(time_s > 0.5, "it took many steps");
        }
    }
}

#[test]
fn a_motor_lifts_what_its_torque_can_lift_and_nothing_heavier() {
    // An arm of 2 kg, held out: its weight pulls with 2 kg · 10 m/s² · 0.4 m = 8 N·m.
    let lifted = |engine, torque_nm_max| {
        let hinge = Hinge {
            parent: 0,
            parent_from_hinge: Isometry3::translation(0.0, 0.0, 0.5),
            centre_m: Vector3::x() * 0.4,
            axis: Vector3::y(),
            torque_nm_max,
        };
        let creature = Body::of([1.0; 3], 1000.0).with([0.4, 0.05, 0.05], 2.0, hinge).build();
        let mut lab = Lab::new(engine, &creature, super::TRIAL);
        // To turn +x upwards is to turn backwards about +y.
        lab.world.drive(1, -1.0);
        let start_m = lab.pose(1).translation.z;
        lab.run(0.5);
        lab.pose(1).translation.z - start_m
    };
    for engine in Engine::ALL {
        let (weak_m, strong_m) = (lifted(engine, 7.6), lifted(engine, 8.4));
        assert!(weak_m < -0.02, "{engine}: {weak_m}");
        assert!(strong_m > 0.02, "{engine}: {strong_m}");
    }
}
