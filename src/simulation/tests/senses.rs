//! Senses come in, commands go out, and a medium pushes, in every engine as textbooks say.

use super::super::medium::Medium;
use super::super::trial::Trial;
use super::super::{Engine, feels, simulate};
use super::bodies::{Body, Hinge, SLED_M, limbs, ridden, sled};
use super::lab::Lab;
use super::{SPACE, TRIAL};
use crate::creature::brain::{Brain, Reflex, Senses};
use crate::creature::{Creature, Shape};
use nalgebra::{Isometry3, Vector3};

/// Two boxes, joined by a hinge with a motor that nothing stops.
fn elbow() -> Creature {
    let hinge = Hinge {
        parent: 0,
        parent_from_hinge: Isometry3::translation(0.25, 0.0, 0.0),
        centre_m: Vector3::x() * 0.25,
        axis: Vector3::y(),
        torque_nm_max: 500.0,
    };
    Body::of([0.25, 0.05, 0.05], 1.0).with([0.25, 0.05, 0.05], 1.0, hinge).build()
}

fn felt(lab: &Lab) -> Senses {
    feels::senses(&*lab.world, &lab.assembly, &lab.assembly.bodies[0])
}

#[test]
fn what_a_medium_pushes_gains_half_the_acceleration_times_the_square_of_the_time() {
    let acceleration_m_s2 = Vector3::new(0.5, -0.2, 0.1);
    let medium = Medium::Stream(acceleration_m_s2);
    let trial = Trial { medium, scored_s: 2.0, ..SPACE };
    for engine in Engine::ALL {
        for body in [sled().build(), limbs(0.0)] {
            let measured = simulate(&body, &trial, engine).unwrap();
            let moved_m = measured.centre_last_m - measured.centre_first_m;
            let expected_m = acceleration_m_s2 * (2.0 * 2.0 / 2.0);
            assert!(
                (moved_m - expected_m).norm() < 0.01 * expected_m.norm(),
                "{engine}: {moved_m}"
            );
        }
    }
}

#[test]
fn a_force_on_one_part_gives_the_body_its_momentum_and_no_more() {
    let force_n = Vector3::new(3.0, -1.0, 2.0);
    for engine in Engine::ALL {
        let mut lab = Lab::new(engine, &limbs(0.0), SPACE);
        for _ in 0..48 {
            lab.world.apply(2, force_n, Vector3::zeros());
            lab.step();
        }
        // It acts in no further step.
        let momentum = lab.motion().momentum;
        let expected = force_n * (48.0 * lab.step_s());
        assert!((momentum - expected).norm() < 0.01 * expected.norm(), "{engine}: {momentum}");
    }
}

#[test]
fn a_torque_turns_a_box_by_its_inertia() {
    let inertia = Shape::Cuboid { half_extents_m: SLED_M.into() }.inertia_kg_m2(2.0);
    for engine in Engine::ALL {
        let mut lab = Lab::new(engine, &sled().build(), SPACE);
        for _ in 0..240 {
            lab.world.apply(0, Vector3::zeros(), Vector3::z() * 0.05);
            lab.step();
        }
        let (_, _, yaw_rad) = lab.pose(0).rotation.euler_angles();
        let expected_rad = 0.05 / inertia.z / 2.0;
        assert!((yaw_rad - expected_rad).abs() < 0.01 * expected_rad, "{engine}: {yaw_rad}");
        let rate_rad_s = lab.world.turn_rad_s(0).z;
        assert!((rate_rad_s - 2.0 * expected_rad).abs() < 0.02 * expected_rad, "{engine}");
    }
}

#[test]
fn a_joint_feels_how_far_it_has_turned_and_how_fast_it_turns() {
    for engine in Engine::ALL {
        let mut lab = Lab::new(engine, &elbow(), SPACE);
        assert_eq!(felt(&lab).joints[1], Default::default(), "{engine}: at rest it feels nothing");
        lab.world.drive(1, 2.0);
        lab.run(0.5);
        let joints = felt(&lab).joints;
        assert_eq!(joints[0], Default::default());
        let (angle_rad, rate_rad_s) = (joints[1].angle_rad, joints[1].rate_rad_s);
        assert!((angle_rad - 1.0).abs() < 0.02, "{engine}: {angle_rad} rad");
        assert!((rate_rad_s - 2.0).abs() < 0.02, "{engine}: {rate_rad_s} rad/s");
        // A quarter of a turn beyond half a turn is three quarters of a turn back.
        lab.run(1.5);
        let angle_rad = felt(&lab).joints[1].angle_rad;
        assert!((angle_rad - (4.0 - std::f64::consts::TAU)).abs() < 0.05, "{engine}: {angle_rad}");
    }
}

#[test]
fn a_body_feels_where_it_touches_the_ground() {
    for engine in Engine::ALL {
        let mut lab = Lab::new(engine, &ridden(), TRIAL);
        lab.run(0.5);
        assert_eq!(felt(&lab).touches, [true, false], "{engine}");
        let mut lab = Lab::new(engine, &ridden(), SPACE);
        lab.run(0.1);
        assert_eq!(felt(&lab).touches, [false, false], "{engine}");
    }
}

/// A motor that is told half of the way ten times a second has half of the way left each time.
#[test]
fn a_brain_that_feels_its_joints_brings_them_where_it_wants_them() {
    let mut body = elbow();
    let reflex = Reflex { angle_rad: 0.5, gain_per_s: 5.0, stops_at_touch: true };
    body.controller.brain = Brain::Reflex(reflex);
    for engine in Engine::ALL {
        let trial = Trial { scored_s: 0.8, ..SPACE };
        let measured = simulate(&body, &trial, engine).unwrap();
        for (moment, poses) in (0..).zip(measured.poses.moments()).skip(1) {
            let bent = poses[0].rotation.inverse() * poses[1].rotation;
            let left_rad = 0.5 - bent.angle();
            // A command takes effect a step after the moment that is measured.
            let expected_rad = 0.5 * libm::exp2(f64::from(1 - moment)) * (1.0 - 0.5 * 23.0 / 24.0);
            assert!((left_rad - expected_rad).abs() < 0.005, "{engine}: {left_rad} at {moment}");
        }
    }
}

/// The same body lies on the ground, feels that, and holds still.
#[test]
fn a_brain_that_feels_the_ground_can_stop_there() {
    let mut body = elbow();
    body.controller.brain =
        Brain::Reflex(Reflex { angle_rad: 0.5, gain_per_s: 5.0, stops_at_touch: true });
    for engine in Engine::ALL {
        let trial = Trial { settle_s: 0.5, scored_s: 0.8, ..TRIAL };
        let measured = simulate(&body, &trial, engine).unwrap();
        let last = measured.poses.moments().next_back().unwrap();
        let bent_rad = (last[0].rotation.inverse() * last[1].rotation).angle();
        assert!(bent_rad < 0.01, "{engine}: {bent_rad} rad");
    }
}
