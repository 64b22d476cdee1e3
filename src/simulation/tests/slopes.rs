//! Bodies on slopes, against walls and over them: what mechanics says, in every engine.

use super::super::perturbation::Perturbation;
use super::super::start::Start;
use super::super::terrain::Terrain;
use super::super::trial::Trial;
use super::super::{Engine, simulate};
use super::bodies::{ball, ridden, sled};
use super::lab::Lab;
use super::{GRAVITY_M_S2, TRIAL};
use crate::creature::{Creature, Inertia};
use crate::simulation::failure::Failure;
use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use std::sync::Arc;

/// The coefficient of friction between a terrain and a link.
const GRIP: f64 = 1.0;

/// A plane of 40 m × 40 m that rises by `slope` towards the north.
fn ramp(slope: f64) -> Trial {
    let heights_m = (0..81 * 81).map(|i| slope * 0.5 * ((i / 81) as f64 - 40.0)).collect();
    let ramp = Terrain::new([81, 81], 0.5, heights_m, [0.3, 0.2]).unwrap();
    // What lies on it with its bottom 0.1 m below its middle.
    let above_m = 0.101 * libm::hypot(1.0, slope);
    Trial { start: Start::RootAt(above_m), ..TRIAL.on(Arc::new(ramp)) }
}

/// A body that lies on a ramp.
fn lying(mut creature: Creature, slope: f64) -> Creature {
    let tilt = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), libm::atan(slope));
    creature.morphology.root_rotation = tilt * creature.morphology.root_rotation;
    creature
}

/// How much farther a body gets down a ramp in the second second from a time on than in the first one, in metres: its
/// speed then is not known, but the change of it is.
fn speeding_up_m(engine: Engine, creature: &Creature, trial: Trial, from_s: f64) -> f64 {
    let mut lab = Lab::new(engine, creature, trial);
    lab.run(from_s);
    let [first_m, second_m] = [(); 2].map(|()| {
        let from_m = lab.centre_of_mass();
        lab.run(1.0);
        (lab.centre_of_mass() - from_m).norm()
    });
    second_m - first_m
}

#[test]
fn a_box_stays_on_a_slope_that_is_less_steep_than_its_friction() {
    for engine in Engine::ALL {
        for creature in [sled().build(), ridden()] {
            let mut lab = Lab::new(engine, &lying(creature, 0.8 * GRIP), ramp(0.8 * GRIP));
            lab.run(1.0);
            let start_m = lab.centre_of_mass();
            lab.run(3.0);
            let crept_m = (lab.centre_of_mass() - start_m).norm();
            assert!(crept_m < 0.005, "{engine}: {crept_m} m");
        }
    }
}

#[test]
fn a_box_slides_down_a_steeper_slope_as_fast_as_friction_lets_it() {
    for engine in Engine::ALL {
        for (creature, slope) in
            [(sled().build(), 1.2), (sled().build(), 1.6), (ridden(), 1.2), (ridden(), 1.6)]
        {
            let gain_m = speeding_up_m(engine, &lying(creature, slope), ramp(slope), 0.3);
            let steepness = libm::atan(slope);
            let down_m_s2 = GRAVITY_M_S2 * (libm::sin(steepness) - GRIP * libm::cos(steepness));
            let error = gain_m / down_m_s2 - 1.0;
            assert!(error.abs() < 0.02, "{engine}: {error} on {slope}");
        }
    }
}

#[test]
fn perturbed_friction_is_times_that_of_the_terrain() {
    let slope = 1.2;
    for engine in Engine::ALL {
        for friction in [0.75, 1.1, 1.25] {
            let perturbation = Perturbation { friction, ..Perturbation::NONE };
            let trial = Trial { perturbation, ..ramp(slope) };
            let gain_m = speeding_up_m(engine, &lying(sled().build(), slope), trial, 0.3);
            let steepness = libm::atan(slope);
            let held = GRIP * friction * libm::cos(steepness);
            let down_m_s2 = GRAVITY_M_S2 * (libm::sin(steepness) - held).max(0.0);
            let error_m = gain_m - down_m_s2;
            assert!(error_m.abs() < 0.06, "{engine}: {error_m} m at {friction} of the friction");
        }
    }
}

#[test]
fn a_ball_rolls_down_a_slope_without_slipping() {
    let slope = 0.3;
    let ball = ball(0.1);
    for engine in Engine::ALL {
        let gain_m = speeding_up_m(engine, &ball, ramp(slope), 0.2);
        let down_m_s2 = GRAVITY_M_S2 * libm::sin(libm::atan(slope)) / 1.4;
        let error = gain_m / down_m_s2 - 1.0;
        assert!(error.abs() < 0.01, "{engine}: {error}");
    }
}

#[test]
fn a_ball_that_runs_into_a_slope_neither_sinks_in_nor_is_thrown_up() {
    const RADIUS_M: f64 = 0.15;
    const SPEED_M_S: f64 = 3.0;
    let ball = ball(RADIUS_M);
    for way in [Vector3::x(), -Vector3::x(), Vector3::y(), -Vector3::y()] {
        let ahead_m = |i: i32| -> f64 {
            let at_m = Vector3::new(f64::from(i % 41 - 20), f64::from(i / 41 - 20), 0.0) * 0.5;
            at_m.dot(&way).max(0.0)
        };
        let start_m = way * -0.6 + way.cross(&Vector3::z()) * 0.1;
        let heights_m = (0..41 * 41).map(ahead_m).collect();
        let terrain =
            Arc::new(Terrain::new([41, 41], 0.5, heights_m, [start_m.x, start_m.y]).unwrap());
        for engine in Engine::ALL {
            let trial = Trial { start: Start::RootAt(RADIUS_M), ..TRIAL.on(Arc::clone(&terrain)) };
            let mut lab = Lab::new(engine, &ball, trial);
            lab.run(0.1);
            lab.world.kick(way * SPEED_M_S, Vector3::zeros());
            let (mut deepest_m, mut highest_m) = (0.0_f64, 0.0_f64);
            for _ in 0..480 {
                lab.step();
                let at_m = lab.centre_of_mass();
                let over_slope_m = (at_m.z - at_m.dot(&way)) * std::f64::consts::FRAC_1_SQRT_2;
                deepest_m = deepest_m.max(RADIUS_M - over_slope_m.min(at_m.z));
                highest_m = highest_m.max(at_m.z - RADIUS_M);
            }
            assert!(deepest_m < 0.015, "{engine}: {deepest_m} m deep towards {way}");
            let allowed_m = SPEED_M_S * SPEED_M_S / (2.0 * GRAVITY_M_S2);
            assert!(highest_m < allowed_m, "{engine}: {highest_m} m high towards {way}");
            assert!(highest_m > 0.02, "{engine}: {highest_m} m high towards {way}");
        }
    }
}

#[test]
fn what_slides_over_edges_between_triangles_does_not_stumble() {
    for engine in Engine::ALL {
        let mut lab = Lab::new(engine, &sled().build(), ramp(0.0));
        lab.run(0.5);
        let start_m = lab.centre_of_mass();
        lab.world.kick(Vector3::new(4.8, 3.6, 0.0), Vector3::zeros());
        let mut highest_m = start_m.z;
        for _ in 0..480 {
            lab.step();
            highest_m = highest_m.max(lab.centre_of_mass().z);
        }
        let slid_m = (lab.centre_of_mass() - start_m).xy().norm();
        let error = slid_m / (36.0 / (2.0 * GRIP * GRAVITY_M_S2)) - 1.0;
        assert!(error.abs() < 0.02, "{engine}: {error}");
        assert!(highest_m - start_m.z < 0.01, "{engine}: {}", highest_m - start_m.z);
    }
}

/// A level arena of 4 m × 4 m.
fn arena(start_m: [f64; 2]) -> Trial {
    let level = Terrain::new([9, 9], 0.5, vec![0.0; 81], start_m).unwrap();
    TRIAL.on(Arc::new(level))
}

#[test]
fn a_wall_stops_what_runs_into_it() {
    for engine in Engine::ALL {
        for way in [Vector3::x(), -Vector3::x(), Vector3::y(), -Vector3::y()] {
            let mut lab = Lab::new(engine, &sled().build(), arena([0.1, -0.1]));
            lab.run(0.2);
            lab.world.kick(way * 6.0, Vector3::zeros());
            let mut farthest_m = 0.0_f64;
            for _ in 0..240 {
                lab.step();
                farthest_m = farthest_m.max(lab.centre_of_mass().dot(&way));
            }
            let half_m = if way.x == 0.0 { 0.2 } else { 0.25 };
            let gap_m = 2.0 - half_m - farthest_m;
            assert!((-0.03..0.2).contains(&gap_m), "{engine}: {gap_m} m from a wall at {way}");
        }
    }
}

#[test]
fn a_box_rests_on_a_wall_and_falls_off_it_when_it_is_pushed() {
    for engine in Engine::ALL {
        let mut lab = Lab::new(engine, &sled().build(), arena([1.7, 0.0]));
        // Up, and over the wall, which is a metre high.
        lab.world.kick(Vector3::z() * 5.0, Vector3::zeros());
        lab.run(0.5);
        lab.world.kick(Vector3::x() * 2.5, Vector3::zeros());
        lab.run(0.25);
        lab.world.halt();
        lab.run(0.5);
        let on_it_m = lab.centre_of_mass();
        assert!((on_it_m.z - 1.1).abs() < 0.03, "{engine}: {on_it_m}");
        assert!(on_it_m.x > 2.0, "{engine}: {on_it_m}");
        lab.world.kick(Vector3::new(-4.0, 0.0, 1.0), Vector3::zeros());
        lab.run(1.5);
        let below_m = lab.centre_of_mass();
        assert!(below_m.z < 0.3 && below_m.x < 1.9, "{engine}: {below_m}");
    }
}

#[test]
fn who_begins_beside_a_cliff_and_rolls_away_from_it_is_no_athlete() {
    // It falls gently towards the south; in the north-east corner there is a cliff of five metres.
    let height_m = |column: usize, row: usize| {
        0.15 * row as f64 + if column > 13 && row > 12 { 5.0 } else { 0.0 }
    };
    let heights_m = (0..21 * 21).map(|i| height_m(i % 21, i / 21)).collect();
    let terrain = Terrain::new([21, 21], 0.5, heights_m, [1.2, 1.6]).unwrap();
    let ball = ball(0.25);
    // It touches neither the cliff nor the ground, and the cliff is within its reach.
    let start = Start::RootAt(0.27);
    let trial = Trial { start, scored_s: 3.0, ..TRIAL.on(Arc::new(terrain)) };
    for engine in Engine::ALL {
        let measured = simulate(&ball, &trial, engine);
        let rolled_m = measured.map(|it| (it.centre_last_m - it.centre_first_m).y);
        assert!(rolled_m.is_ok_and(|it| it < -1.0), "{engine}: {rolled_m:?}");
    }
}

/// A box whose mass is beside it.
fn lopsided(by_m: f64) -> Creature {
    let mut body = sled().build();
    body.morphology.links[0].inertia = Some(Inertia {
        centre_m: Vector3::x() * by_m,
        about_centre_kg_m2: Matrix3::identity() * 0.02,
    });
    body
}

#[test]
fn who_is_beyond_the_walls_is_not_scored() {
    let beside = Trial { scored_s: 1.0, ..arena([1.7, 0.0]) };
    for engine in Engine::ALL {
        let within = simulate(&lopsided(0.0), &beside, engine).map(|it| it.heights_m.len());
        assert_eq!(within, Ok(11), "{engine}");
        let beyond = simulate(&lopsided(0.6), &beside, engine);
        assert_eq!(beyond.unwrap_err(), Failure::Launched, "{engine}");
    }
}
