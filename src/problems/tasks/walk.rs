//! To get away: the horizontal displacement of the centre of mass after settling, if it keeps on.

use super::definition::Definition;
use crate::problems::progress;
use crate::simulation::{Ground, Guards, Medium, Perturbation, Start, Trial};

pub const DEFINITION: Definition = Definition {
    aim: "get away",
    unit: "m",
    trial,
    long_steps_per_s: Some(120),
    is_pushed: true,
    score: |measured| progress::away_m(&measured.track_m),
};

pub fn trial() -> Trial {
    Trial {
        // What rapier needs. There 240 Hz changed the scores that 480 gave no more than 960 did (rank correlation
        // 0.78 both), 120 more (0.72), and gave bodies eight times as much momentum out of nothing, half of what
        // the ledger refuses.
        steps_per_s: 240,
        perturbation: Perturbation::NONE,
        gravity_m_s2: 9.81,
        ground: Ground::Plane,
        medium: Medium::Void,
        // Low, since a body that falls far bounces, and one that lands on a light root flies off.
        start: Start::LeaningAt(0.1),
        settle_s: 0.5,
        scored_s: 8.0,
        guards: Guards::ALL,
        others: Vec::new(),
    }
}
