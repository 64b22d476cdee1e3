//! A creature and what lies about in its world.

use super::exploits::body::{Body, Drive, cuboid};
use islands::creature::{Creature, Shape, Waveform};
use islands::problems::{Locomotion, Task};
use islands::simulation::{Engine, Other, Trial, check, simulate};
use nalgebra::{Vector3, vector};
use std::sync::Arc;

/// A heavy trunk with an arm that goes round above the ground.
fn sweeper() -> Creature {
    let sweep = Drive {
        waveform: Waveform::Pulse,
        amplitude_rad_s: 2.0,
        cycles_per_s: 0.0,
        start: 0.0,
        torque_nm_max: 60.0,
    };
    let hinge_m = vector![0.3, 0.0, 0.0];
    Body::of(cuboid(0.6, 0.6, 0.2))
        .hinged(0, cuboid(0.1, 0.8, 0.1), vector![0.3, -0.45, 0.0], (hinge_m, Vector3::z()), sweep)
        .done()
}

/// A walk with a ball beside the start, within the arm's reach.
fn beside_a_ball() -> Trial {
    let creature = Arc::new(Body::of(Shape::Sphere { radius_m: 0.12 }).done());
    let ball = Other { creature, offset_m: vector![0.85, 0.0, 0.0], yaw_rad: 0.0 };
    Trial { others: vec![ball], ..Task::Walk.trial() }
}

#[test]
fn a_body_pushes_what_lies_about_where_bodies_collide_and_both_are_measured_and_filmed() {
    let (sweeper, trial) = (sweeper(), beside_a_ball());
    let gone_m = |engine| {
        let measured = simulate(&sweeper, &trial, engine).unwrap();
        let [ball] = &measured.others[..] else { panic!("there is one other") };
        (ball.centre_last_m - ball.centre_first_m).xy().norm()
    };
    let [pushed_m, passed_m] = [Engine::Rapier, Engine::Featherstone].map(gone_m);
    assert!(pushed_m > passed_m + 0.3, "{pushed_m} m, {passed_m} m");

    let problem = Locomotion::single(Engine::Rapier);
    let (evaluation, film) = problem.film_trial(&sweeper, &trial);
    let expected = simulate(&sweeper, &trial, Engine::Rapier).map(|it| Task::Walk.score(&it));
    assert_eq!(evaluation.fitness.finite(), expected.ok());
    assert_eq!((film.bodies.as_slice(), film.shapes.len()), (&[2, 1][..], 3));
    let [first, last] = [0, film.poses.len() - 1]
        .map(|frame| Vector3::from(film.poses[frame][2].position_m.map(f64::from)));
    assert!((last - first).norm() > 0.3, "it is seen to be pushed");
}

#[test]
fn an_engine_in_which_bodies_do_not_collide_judges_no_trial_in_which_they_should() {
    let (sweeper, trial) = (sweeper(), beside_a_ball());
    assert!(check(Engine::Rapier, &trial).is_ok());
    let refused = check(Engine::Featherstone, &trial).unwrap_err().to_string();
    assert!(refused.starts_with("bodies do not collide in featherstone: choose engine rapier"));
    assert!(Engine::ALL.iter().all(|engine| check(*engine, &Task::Walk.trial()).is_ok()));

    let own = Locomotion::single(Engine::Rapier);
    let judged = Locomotion { judged: true, ..own.clone() };
    let [score, judged] = [&own, &judged].map(|it| it.film_trial(&sweeper, &trial).0);
    assert_eq!(judged, score);
}
