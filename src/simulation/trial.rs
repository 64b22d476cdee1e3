//! How a body is tried, and the constants of the world that it is tried in.

use super::measurement::TRACK_SAMPLE_S;
use super::medium::Medium;
use super::perturbation::Perturbation;
use super::start::Start;
use super::terrain::{Ground, Terrain};
use crate::creature::Creature;
use nalgebra::Vector3;
use std::sync::Arc;

/// How a body is tried.
#[derive(Debug, Clone, PartialEq)]
pub struct Trial {
    /// Steps a second.
    pub steps_per_s: u32,
    /// What differs from the usual.
    pub perturbation: Perturbation,
    /// Acceleration of gravity, downwards, in m/s².
    pub gravity_m_s2: f64,
    /// What the body stands on.
    pub ground: Ground,
    /// What is around it.
    pub medium: Medium,
    /// Where the body begins.
    pub start: Start,
    /// A round of settling before scoring, in seconds; motors hold still meanwhile. There are as many rounds as it
    /// takes to come to rest, see [`settling`](super::settling), and none if this is 0.
    pub settle_s: f64,
    /// Time that is scored, in seconds.
    pub scored_s: f64,
    /// What it is refused for.
    pub guards: Guards,
    /// Who and what else is in its world: they and the body push each other in an engine in which bodies collide, and
    /// pass through each other in another one.
    pub others: Vec<Other>,
}

/// A creature in the world of the one that is tried, or a box that lies about.
#[derive(Debug, Clone, PartialEq)]
pub struct Other {
    /// Who.
    pub creature: Arc<Creature>,
    /// How far from the trial's start it begins, in metres.
    pub offset_m: Vector3<f64>,
    /// By what it is turned about the vertical, in radians.
    pub yaw_rad: f64,
}

/// What a body is refused for in a trial, because no body does it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Guards {
    /// A part is faster than this, in m/s.
    pub speed_m_s_max: f64,
    /// A part is higher above the ground than a jump explains.
    pub refuses_launches: bool,
    /// The body gains momentum out of nothing.
    pub keeps_ledger: bool,
}

impl Guards {
    /// All of them.
    pub const ALL: Self =
        Self { speed_m_s_max: SPEED_M_S_MAX, refuses_launches: true, keeps_ledger: true };
}

/// No healthy link is ever this fast, in m/s: the 99th percentile of random bodies is 6 to 7.
const SPEED_M_S_MAX: f64 = 50.0;

/// Friction of a plane and of every link; their product acts between them. From the course.
pub const FRICTION: f64 = 0.5;

/// The usual coefficient of friction between a plane and a link.
pub const GRIP: f64 = FRICTION * FRICTION;

impl Trial {
    /// The same trial on a terrain, where no ledger can be kept: see [`Ledger`](super::stability::Ledger).
    pub fn on(self, terrain: Arc<Terrain>) -> Self {
        let guards = Guards { keeps_ledger: false, ..self.guards };
        Self { ground: Ground::Terrain(terrain), guards, ..self }
    }

    /// The creatures among [`Trial::others`].
    pub fn other_creatures(&self) -> Vec<Creature> {
        self.others.iter().map(|other| Creature::clone(&other.creature)).collect()
    }

    /// The simulated time after a number of steps, in seconds.
    pub fn time_s(&self, step: u32) -> f64 {
        f64::from(step) / f64::from(self.steps_per_s)
    }

    /// The steps of a trial that runs to its end, with one round of settling: as many as a film shows.
    pub fn steps(&self) -> u32 {
        self.steps_in_exactly(self.settle_s) + self.steps_in_exactly(self.scored_s)
    }

    /// The coefficient of friction between the ground and a link.
    pub fn grip(&self) -> f64 {
        GRIP * self.perturbation.friction * self.ground.roughness()
    }

    /// The nearest number of steps to a period, at least 1.
    pub(super) fn steps_in(&self, period_s: f64) -> u32 {
        self.steps_in_exactly(period_s).max(1)
    }

    /// Positions on the track after the first.
    pub(super) fn samples(&self) -> usize {
        (self.steps_in_exactly(self.scored_s) / self.sample_steps()) as usize
    }

    /// Steps from one position on the track to the next.
    pub(super) fn sample_steps(&self) -> u32 {
        self.steps_in(TRACK_SAMPLE_S)
    }

    pub(super) fn steps_in_exactly(&self, period_s: f64) -> u32 {
        (period_s * f64::from(self.steps_per_s)).round() as u32
    }
}
