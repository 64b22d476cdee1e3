//! What is perturbed in a trial does what it says, in every engine.

use super::super::assembly::Assembly;
use super::super::perturbation::Perturbation;
use super::super::start::Start;
use super::super::trial::{GRIP, Guards, Trial};
use super::super::{Engine, Measurement, simulate};
use super::bodies::{Body, Hinge, limbs, sled};
use super::lab::Lab;
use super::{GRAVITY_M_S2, SPACE, TRIAL};
use crate::creature::Creature;
use nalgebra::{Isometry3, UnitQuaternion, Vector3};

const PUSH: Vector3<f64> = Vector3::new(0.2, -0.15, 0.0);

fn perturbed(trial: Trial, perturbation: Perturbation) -> Trial {
    Trial { perturbation, ..trial }
}

#[test]
fn what_slides_gets_as_far_as_the_perturbed_friction_allows() {
    for engine in Engine::ALL {
        for friction in [0.75, 1.0, 1.25] {
            let trial = perturbed(TRIAL, Perturbation { friction, ..Perturbation::NONE });
            let mut lab = Lab::new(engine, &sled().build(), trial);
            lab.run(0.5);
            let start_m = lab.centre_of_mass();
            lab.world.kick(Vector3::x() * 2.0, Vector3::zeros());
            lab.run(2.0);
            let slid_m = (lab.centre_of_mass() - start_m).xy().norm();
            let allowed_m = 2.0 * 2.0 / (2.0 * GRIP * friction * GRAVITY_M_S2);
            let error = slid_m / allowed_m - 1.0;
            assert!(error.abs() < 0.01, "{engine}: {error} at {friction} of the usual friction");
        }
    }
}

#[test]
fn a_push_gives_a_body_that_moves_anyhow_its_mass_times_the_velocity_and_turns_nothing() {
    for engine in Engine::ALL {
        for body in [sled().build(), limbs(3.0)] {
            let mass_kg: f64 = body.morphology.links.iter().map(|link| link.mass_kg).sum();
            let mut lab = Lab::new(engine, &body, SPACE);
            lab.world.kick(Vector3::new(0.1, 0.2, 0.3), Vector3::new(0.5, 0.0, 0.2));
            (1..lab.parts()).for_each(|part| lab.world.drive(part, 2.0));
            lab.run(0.2);
            let before = lab.motion();
            let body = lab.assembly.bodies[0].clone();
            lab.world.push(&body, PUSH);
            let after = lab.motion();
            let wrong = after.momentum - before.momentum - mass_kg * PUSH;
            assert!(wrong.norm() < 0.001 * mass_kg * PUSH.norm(), "{engine}: {wrong}");
            let turned = (after.spin - before.spin).norm() / before.spin.norm();
            assert!(turned < 0.002, "{engine}: {turned}");
        }
    }
}

/// A trunk, and a flywheel on top of it.
fn flywheel() -> Creature {
    let hinge = Hinge {
        parent: 0,
        parent_from_hinge: Isometry3::translation(0.0, 0.0, 0.1),
        centre_m: Vector3::z() * 0.1,
        axis: Vector3::z(),
        torque_nm_max: 0.05,
    };
    Body::of([0.3, 0.3, 0.1], 20.0).with([0.2, 0.2, 0.05], 2.0, hinge).build()
}

#[test]
fn a_motor_that_gives_all_that_it_has_speeds_up_its_hinge_by_the_perturbed_torque() {
    for engine in Engine::ALL {
        let turned_rad = |torque| {
            let trial = perturbed(SPACE, Perturbation { torque, ..Perturbation::NONE });
            let mut lab = Lab::new(engine, &flywheel(), trial);
            lab.world.drive(1, 100.0);
            lab.run(1.0);
            (lab.pose(0).rotation.inverse() * lab.pose(1).rotation).angle()
        };
        let usual_rad = turned_rad(1.0);
        assert!((0.3..2.0).contains(&usual_rad), "{engine}: {usual_rad}");
        for torque in [0.8, 1.2] {
            let share = turned_rad(torque) / usual_rad;
            assert!((share - torque).abs() < 0.01, "{engine}: {share} with {torque} of the torque");
        }
    }
}

#[test]
fn a_body_that_is_turned_begins_turned_and_leans_to_another_of_its_sides() {
    let yaw_rad = 1.3;
    let yaw = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), yaw_rad);
    let body = limbs(3.0);
    for start in [Start::LowestAt(0.1), Start::LeaningAt(0.1)] {
        let trial = Trial { start, ..TRIAL };
        let usual = Assembly::new(&body, &trial);
        let turned = perturbed(trial, Perturbation { yaw_rad, ..Perturbation::NONE });
        let turned = Assembly::new(&body, &turned);
        let rotation = |assembly: &Assembly| assembly.parts[0].world_from_part.rotation;
        let away = rotation(&turned).angle_to(&(yaw * rotation(&usual)));
        match start {
            Start::LeaningAt(_) => {
                assert!(away > 0.05, "{away}");
                let lean = rotation(&turned) * yaw.inverse();
                assert!(lean.angle_to(&rotation(&usual)) < 1e-9);
            }
            _ => assert!(away < 1e-9, "{away}"),
        }
    }
}

#[test]
fn a_body_falls_as_fast_at_all_steps() {
    for engine in Engine::ALL {
        for steps_per_s in [200, 240, 300] {
            let trial = Trial { steps_per_s, start: Start::RootAt(9.0), ..TRIAL };
            let mut lab = Lab::new(engine, &sled().build(), trial);
            lab.run(1.0);
            let fallen_m = 9.0 - lab.centre_of_mass().z;
            let error = fallen_m / (GRAVITY_M_S2 / 2.0) - 1.0;
            assert!(error.abs() < 0.006, "{engine}: {error} at {steps_per_s} Hz");
        }
    }
}

fn try_out(engine: Engine, perturbation: Perturbation) -> Measurement {
    let trial = Trial { settle_s: 0.5, scored_s: 4.0, guards: Guards::ALL, ..TRIAL };
    let measured = simulate(&sled().build(), &perturbed(trial, perturbation), engine);
    measured.unwrap_or_else(|outcome| panic!("{engine}: {outcome}"))
}

#[test]
fn a_push_in_a_trial_comes_at_its_moment_and_is_no_momentum_out_of_nothing() {
    for engine in Engine::ALL {
        for friction in [0.75, 1.25] {
            let pushed =
                Perturbation { friction, push_m_s: PUSH, push_share: 0.6, ..Perturbation::NONE };
            let track_m = try_out(engine, pushed).track_m;
            // 24 of 40 tenths of a second have passed.
            assert!((track_m[24] - track_m[0]).norm() < 1e-3, "{engine}");
            let slid_m = track_m[40] - track_m[24];
            let allowed_m = PUSH.norm_squared() / (2.0 * GRIP * friction * GRAVITY_M_S2);
            // So short a slide is a tenth more or less, by the step that it begins and ends in.
            let error = slid_m.norm() / allowed_m - 1.0;
            assert!(error.abs() < 0.1, "{engine}: {error}");
            assert!(slid_m.normalize().dot(&PUSH.xy().normalize()) > 0.999, "{engine}: {slid_m}");
        }
    }
}
