//! What rolls on the level keeps rolling: nothing brakes a rigid ball or wheel.

use super::super::Engine;
use super::TRIAL;
use super::bodies::{ball, wheel};
use super::lab::Lab;
use crate::creature::Creature;
use nalgebra::{UnitQuaternion, Vector3};

/// How much of its speed it has lost after three seconds, and how far it has turned aside, in radians.
fn changes(
    engine: Engine,
    mut body: Creature,
    radius_m: f64,
    speed_m_s: f64,
    way_rad: f64,
) -> (f64, f64) {
    let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), way_rad);
    body.morphology.root_rotation = turn * body.morphology.root_rotation;
    let way = turn * Vector3::x();
    let mut lab = Lab::new(engine, &body, TRIAL);
    lab.run(0.2);
    lab.world.kick(way * speed_m_s, Vector3::z().cross(&way) * (speed_m_s / radius_m));
    lab.run(3.0);
    let before_m = lab.centre_of_mass();
    lab.run(0.1);
    let velocity_m_s = (lab.centre_of_mass() - before_m) / 0.1;
    (1.0 - velocity_m_s.dot(&way) / speed_m_s, velocity_m_s.cross(&way).norm() / speed_m_s)
}

/// In single precision rapier's wheels turn aside by up to 2°.
#[test]
fn balls_and_wheels_that_roll_on_the_level_keep_their_speed_and_their_way() {
    for engine in Engine::ALL {
        for (radius_m, speed_m_s) in [(0.06, 0.5), (0.06, 1.5), (0.15, 3.0), (0.4, 4.0)] {
            for way_rad in [0.0, 0.4, 2.5] {
                for (name, body, aside_max) in
                    [("ball", ball(radius_m), 1e-3), ("wheel", wheel(radius_m, 0.1), 0.04)]
                {
                    let (lost, aside_rad) = changes(engine, body, radius_m, speed_m_s, way_rad);
                    let what = format!("{engine}: a {name} of {radius_m} m at {speed_m_s} m/s");
                    assert!(lost.abs() < 1e-3, "{what} loses {lost}");
                    assert!(aside_rad < aside_max, "{what} turns by {aside_rad} rad");
                }
            }
        }
    }
}
