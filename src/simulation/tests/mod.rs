//! What textbooks say of bodies in motion, asked of every engine.
//!
//! Tolerances are those of the method, not of the figures that were found: a step of 1/240 s and single precision
//! are worth a thousandth in most of these. Where an engine is further off, the test says why that may be.

mod bodies;
mod energy;
mod fall;
mod flight;
mod hinge;
mod lab;
mod ledger;
mod motors;
mod pendulum;
mod perturbed;
mod rolling;
mod senses;
mod sliding;
mod slopes;
mod spinning;
mod together;

use super::medium::Medium;
use super::perturbation::Perturbation;
use super::start::Start;
use super::terrain::Ground;
use super::trial::{Guards, Trial};

/// Acceleration of gravity in these tests, in m/s².
const GRAVITY_M_S2: f64 = 10.0;

/// A body that stands on the ground. The tests step by themselves, so that its times mean nothing.
const TRIAL: Trial = trial(GRAVITY_M_S2, Start::LowestAt(0.0));

/// A body on which nothing acts: without gravity, and out of the ground's reach.
const SPACE: Trial = trial(0.0, Start::RootAt(4.0));

const fn trial(gravity_m_s2: f64, start: Start) -> Trial {
    Trial {
        steps_per_s: 240,
        perturbation: Perturbation::NONE,
        gravity_m_s2,
        ground: Ground::Plane,
        medium: Medium::Void,
        start,
        settle_s: 0.0,
        scored_s: 0.0,
        guards: Guards { keeps_ledger: false, ..Guards::ALL },
        others: Vec::new(),
    }
}
