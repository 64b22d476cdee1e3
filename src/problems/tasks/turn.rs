//! To turn about the vertical, on the spot or in a circle: by as many turns as the part of the body that turns least.
//!
//! All parts must go round, the same way: a windmill's stand and its mill, or a rotor and what it pushes off from, do
//! not. One event gains nothing, as in all tasks ([`progress::kept`]).

use super::definition::Definition;
use super::walk;
use crate::problems::progress;
use crate::simulation::{Measurement, Poses};
use nalgebra::UnitQuaternion;
use std::f64::consts::TAU;

pub const DEFINITION: Definition =
    Definition { aim: "turn about the vertical", unit: "turns", score: turns, ..walk::DEFINITION };

/// The turns that every part keeps, to the side that is worth more.
fn turns(measured: &Measurement) -> f64 {
    let to_side = |side: f64| {
        let kept = (0..measured.poses.parts())
            .map(|part| progress::kept(&course(&measured.poses, part, side)));
        kept.reduce(f64::min).unwrap_or(0.0)
    };
    to_side(1.0).max(to_side(-1.0)).max(0.0)
}

/// How far a part has turned to a side at each moment, in turns.
fn course(poses: &Poses, part: usize, side: f64) -> Vec<f64> {
    let mut turned = 0.0;
    let moments = poses.moments().map(|parts| parts[part].rotation);
    let steps = moments.clone().zip(moments.skip(1)).map(|(from, to)| {
        turned += side * about_vertical_rad(&from, &to) / TAU;
        turned
    });
    std::iter::once(0.0).chain(steps).collect()
}

/// The vertical component of the shortest rotation from one attitude to another, in radians.
fn about_vertical_rad(from: &UnitQuaternion<f64>, to: &UnitQuaternion<f64>) -> f64 {
    let turn = to * from.inverse();
    // Of the two quaternions of a rotation the one that turns by less than half a turn.
    let sign = if turn.w < 0.0 { -1.0 } else { 1.0 };
    let sin_half = turn.imag().norm();
    if sin_half == 0.0 {
        return 0.0;
    }
    sign * turn.k / sin_half * 2.0 * libm::atan2(sin_half, sign * turn.w)
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Isometry3, Vector3, vector};

    /// What a body is worth whose parts are turned by these rotation vectors, in turns, at a time in seconds.
    fn worth<const N: usize>(turned: impl Fn(f64) -> [Vector3<f64>; N]) -> f64 {
        let pose = |turns: Vector3<f64>| {
            let rotation = UnitQuaternion::from_scaled_axis(turns * TAU);
            Isometry3::from_parts(Vector3::zeros().into(), rotation)
        };
        let mut poses = Poses::new(N, 81);
        for i in 0..=80 {
            poses.push(turned(f64::from(i) * 0.1).map(pose).into_iter());
        }
        let measured = Measurement {
            root_first_m: Vector3::zeros(),
            root_last_m: Vector3::zeros(),
            centre_first_m: Vector3::zeros(),
            centre_last_m: Vector3::zeros(),
            path_m: 0.0,
            track_m: Vec::new(),
            heights_m: Vec::new(),
            poses,
            extent_m: 1.0,
            others: Vec::new(),
        };
        turns(&measured)
    }

    fn up(turns: f64) -> Vector3<f64> {
        Vector3::z() * turns
    }

    #[test]
    fn a_body_that_goes_round_steadily_gets_its_turns_to_either_side() {
        for side in [1.0, -1.0] {
            let found = worth(|t| [up(side * 0.4 * t), up(side * (0.3 * t + 0.1))]);
            assert!((found - 2.4).abs() < 1e-9, "{found}");
        }
    }

    #[test]
    fn what_not_all_of_a_body_does_is_worth_nothing() {
        assert_eq!(worth(|t| [up(0.0), up(0.9 * t)]), 0.0);
        assert_eq!(worth(|t| [up(-0.2 * t), up(0.9 * t)]), 0.0);
    }

    #[test]
    fn what_rolls_tumbles_or_shakes_does_not_turn() {
        assert!(worth(|t| [vector![0.8 * t, 0.0, 0.0]]) < 1e-9);
        assert!(worth(|t| [vector![0.3 * t, 0.4 * t, 0.0]]) < 1e-9);
        assert!(worth(|t| [up(0.1 * libm::sin(9.0 * t))]) < 0.1);
    }

    #[test]
    fn one_spin_is_worth_nothing_whenever_it_comes() {
        for start in 0..=40 {
            let spin = |t: f64| [up((t - 0.1 * f64::from(start)).clamp(0.0, 4.0))];
            assert!(worth(spin) < 1e-9);
        }
    }
}
