//! What may differ from one trial of a body to the next: whoever depends on it has not learnt to walk.
//!
//! A gait that is tried in one world fits that world: its friction, the way its bodies begin, the errors of its solver.
//! Robots that were evolved in simulators without noise fail outside of them for that reason (Jakobi, Husbands and
//! Harvey 1995). So the same body is tried in worlds that differ by more than what is known of them.
//!
//! The `index`-th perturbation is the same for all bodies, wherever and whenever they are tried: it is drawn from an
//! address that holds nothing but its index.

use crate::rng::{Purpose, Source, Stream};
use nalgebra::Vector3;
use rand::RngExt;
use std::f64::consts::{PI, TAU};

/// Friction of the ground differs by at most this share.
const FRICTION_SHARE: f64 = 0.25;
/// The strength of motors differs by at most this share, all of a body alike.
const TORQUE_SHARE: f64 = 0.2;
/// On a terrain a body is turned by at most this angle, in radians: there the ways differ, and who faces the hill in
/// one trial and turns its back on it in the next cannot know where to go.
const TERRAIN_YAW_RAD: f64 = 0.2;
/// The greatest push, in m/s.
const PUSH_M_S_MAX: f64 = 0.3;
/// The shares of the scored time between which a push comes. In its second half, since what is pushed and rolls on for
/// less than half of the time gains nothing by it: a score is at most twice what is left without its best half.
const PUSH_SHARES: [f64; 2] = [0.5, 0.9];
/// The shares of the usual number of steps a second between which it is: an error of a solver that pays is another one
/// with other steps.
const RATE_SHARES: [f64; 2] = [5.0 / 6.0, 5.0 / 4.0];

/// What differs from the trial as it is defined.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Perturbation {
    /// Friction between ground and body, times what it usually is.
    pub friction: f64,
    /// The greatest torque of every motor, times its own.
    pub torque: f64,
    /// The body is turned about the vertical by this angle before it leans, in radians: so it leans to another side.
    pub yaw_rad: f64,
    /// The whole body gets this velocity on top of its own at a moment of the scored time, in m/s.
    pub push_m_s: Vector3<f64>,
    /// That moment, as a share of the scored time.
    pub push_share: f64,
}

impl Perturbation {
    /// Nothing differs.
    pub const NONE: Self = Self {
        friction: 1.0,
        torque: 1.0,
        yaw_rad: 0.0,
        push_m_s: Vector3::new(0.0, 0.0, 0.0),
        push_share: 0.0,
    };

    /// The `index`-th one, and the share of the usual steps a second that a trial has with it.
    pub(super) fn draw(index: u32) -> (Self, f64) {
        let rng = &mut Source { seed: 0, island: 0 }.stream(0, index, Purpose::Perturbation);
        let friction = 1.0 + between([-FRICTION_SHARE, FRICTION_SHARE], rng);
        let torque = 1.0 + between([-TORQUE_SHARE, TORQUE_SHARE], rng);
        let yaw_rad = between([0.0, TAU], rng);
        let direction_rad = between([0.0, TAU], rng);
        let speed_m_s = between([0.0, PUSH_M_S_MAX], rng);
        let push_share = between(PUSH_SHARES, rng);
        let (sin, cos) = libm::sincos(direction_rad);
        let push_m_s = Vector3::new(cos, sin, 0.0) * speed_m_s;
        let drawn = Self { friction, torque, yaw_rad, push_m_s, push_share };
        (drawn, between(RATE_SHARES, rng))
    }

    /// The same, but the circle of yaws is that of [`TERRAIN_YAW_RAD`] to either side.
    pub(super) fn facing_ahead(self) -> Self {
        Self { yaw_rad: (self.yaw_rad / PI - 1.0) * TERRAIN_YAW_RAD, ..self }
    }
}

fn between([from, to]: [f64; 2], rng: &mut Stream) -> f64 {
    from + (to - from) * rng.random::<f64>()
}
