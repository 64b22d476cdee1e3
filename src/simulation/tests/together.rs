//! Several bodies in one world.

use super::super::trial::Trial;
use super::super::{Engine, Entrant, Measurement, Meeting, Trajectory, film_together, simulate};
use super::TRIAL;
use super::bodies::{SLED_M, limbs, ridden, sled};
use crate::creature::Creature;
use nalgebra::Vector3;

fn standing() -> Trial {
    Trial { settle_s: 0.5, scored_s: 1.0, ..TRIAL }
}

fn at(creature: &Creature, x_m: f64, z_m: f64) -> Entrant<'_> {
    Entrant { offset_m: Vector3::new(x_m, 0.0, z_m), ..Entrant::alone(creature) }
}

fn tried(entrants: &[Entrant], meeting: Meeting, engine: Engine) -> (Vec<Measurement>, Trajectory) {
    let (measured, film) = film_together(entrants, &standing(), meeting, engine).unwrap();
    (measured.unwrap(), film)
}

#[test]
fn bodies_far_apart_do_what_they_do_alone() {
    let (a, b) = (limbs(20.0), ridden());
    for engine in Engine::ALL {
        let entrants = [at(&a, 0.0, 0.0), at(&b, 5.0, 0.0)];
        let (together, film) = tried(&entrants, Meeting::Pass, engine);
        let alone: Vec<Measurement> =
            entrants.iter().flat_map(|it| tried(&[*it], Meeting::Pass, engine).0).collect();
        assert_eq!(simulate(&a, &standing(), engine).unwrap(), alone[0], "{engine}");
        for (found, alone) in together.iter().zip(&alone) {
            let away_m = (found.centre_last_m - alone.centre_last_m).norm();
            assert!(away_m < 1e-3, "{engine}: {away_m} m");
            assert!(found.centre_last_m.z < 0.4, "{engine}: it fell and stands");
        }
        if engine == Engine::Featherstone {
            assert_eq!(together, alone, "the same bits");
        }
        assert_eq!((film.bodies.as_slice(), film.shapes.len()), (&[4, 2][..], 6));
        assert!(film.poses.iter().all(|frame| frame.len() == 6));
        let apart_m = film.poses[0][4].position_m[0] - film.poses[0][0].position_m[0];
        assert!((apart_m - 5.0).abs() < 1e-4, "{apart_m}");
    }
}

#[test]
fn a_box_falls_onto_another_one_where_bodies_collide_and_through_it_where_not() {
    let body = sled().build();
    let pile = [at(&body, 0.0, 0.0), at(&body, 0.02, 0.4)];
    let heights = |meeting, engine| {
        let (measured, _) = tried(&pile, meeting, engine);
        [0, 1].map(|index: usize| measured[index].centre_last_m.z)
    };
    let half_m = SLED_M[2];
    for engine in Engine::ALL {
        let passed = heights(Meeting::Pass, engine);
        assert!(passed.iter().all(|z| (z - half_m).abs() < 0.005), "{engine}: {passed:?}");
    }
    let [low, high] = heights(Meeting::Collide, Engine::Rapier);
    assert!((low - half_m).abs() < 0.005 && (high - 3.0 * half_m).abs() < 0.01, "{low}, {high}");
}

#[test]
fn an_engine_whose_bodies_cannot_collide_says_so() {
    let body = sled().build();
    let refused =
        film_together(&[at(&body, 0.0, 0.0)], &standing(), Meeting::Collide, Engine::Featherstone);
    expect_test::expect![[
        "bodies do not collide in featherstone: choose engine rapier, or let them pass through each other"
    ]]
    .assert_eq(&refused.unwrap_err().to_string());
}
