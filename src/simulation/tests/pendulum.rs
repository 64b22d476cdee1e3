//! A pendulum keeps its exact period, and swings as far as it did.

use super::super::Engine;
use super::bodies::{Body, Hinge};
use super::lab::Lab;
use super::{GRAVITY_M_S2, TRIAL};
use crate::creature::Creature;
use nalgebra::{Isometry3, Translation3, Vector3};
use std::f64::consts::{PI, TAU};

const LENGTH_M: f64 = 1.0;
const RADIUS_M: f64 = 0.05;
const SWING_S: f64 = 20.0;
/// The amplitude is the largest angle in so long a time, more than a period.
const WINDOW_S: f64 = 2.0;

/// A rod of 1 kg that swings within what it hangs on: links of a body do not touch. That is so heavy that it stands
/// still.
fn pendulum(angle_rad: f64) -> Creature {
    let hung = Isometry3::rotation(Vector3::y() * (PI - angle_rad));
    let hinge = Hinge {
        parent: 0,
        parent_from_hinge: Translation3::new(0.0, 0.0, 0.8) * hung,
        centre_m: Vector3::z() * (LENGTH_M / 2.0),
        axis: Vector3::y(),
        torque_nm_max: 0.0,
    };
    Body::of([1.0; 3], 1e4).with([RADIUS_M, RADIUS_M, LENGTH_M / 2.0], 1.0, hinge).build()
}

/// The period of a physical pendulum, 4 √(l/g) K(sin(θ/2)), its complete elliptic integral by the
/// arithmetic-geometric mean: 2π √(l/g) / agm(1, cos(θ/2)).
fn period_s(angle_rad: f64) -> f64 {
    let arm_m = LENGTH_M / 2.0;
    let inertia = (4.0 * RADIUS_M * RADIUS_M + LENGTH_M * LENGTH_M) / 12.0 + arm_m * arm_m;
    let (mut a, mut b) = (1.0, libm::cos(angle_rad / 2.0));
    for _ in 0..8 {
        (a, b) = ((a + b) / 2.0, f64::sqrt(a * b));
    }
    TAU * f64::sqrt(inertia / (arm_m * GRAVITY_M_S2)) / a
}

/// Its angle after each step, and the length of a step in seconds.
fn swing(engine: Engine, angle_rad: f64) -> (Vec<f64>, f64) {
    let mut lab = Lab::new(engine, &pendulum(angle_rad), TRIAL);
    let steps = (SWING_S / lab.step_s()).round() as usize;
    let angles = (0..steps).map(|_| {
        lab.step();
        let rod = lab.pose(1).rotation * Vector3::z();
        libm::atan2(rod.x, -rod.z)
    });
    (angles.collect(), lab.step_s())
}

/// The mean of its periods, in steps: from the first time that it passes the lowest point forwards to the last.
fn mean_period(angles: &[f64]) -> f64 {
    let pairs = angles.windows(2).enumerate().filter(|(_, pair)| pair[0] < 0.0 && pair[1] >= 0.0);
    let passages: Vec<f64> =
        pairs.map(|(step, pair)| step as f64 + pair[0] / (pair[0] - pair[1])).collect();
    let (first, last) = (passages[0], passages[passages.len() - 1]);
    (last - first) / (passages.len() - 1) as f64
}

#[test]
fn the_exact_period_is_the_one_that_other_engines_were_held_against() {
    assert!((period_s(0.1) - 1.62535).abs() < 5e-6, "{}", period_s(0.1));
}

#[test]
fn a_pendulum_keeps_its_period_to_a_thousandth_and_its_amplitude_to_a_hundredth() {
    for engine in Engine::ALL {
        for angle_rad in [0.1, 1.0] {
            let (angles, step_s) = swing(engine, angle_rad);
            let error = mean_period(&angles) * step_s / period_s(angle_rad) - 1.0;
            let window = (WINDOW_S / step_s) as usize;
            let amplitude = |angles: &[f64]| angles.iter().copied().fold(0.0, f64::max);
            let kept = amplitude(&angles[angles.len() - window..]) / angle_rad;
            assert!(error.abs() < 1e-3, "{engine}: {error} of the period of {angle_rad} rad");
            assert!((kept - 1.0).abs() < 1e-2, "{engine}: {kept} of the amplitude {angle_rad} rad");
        }
    }
}
