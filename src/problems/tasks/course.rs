//! The course program's set-up and measure: dropped from 2.5 m, the distance of the root in space. It counts the fall,
//! and is here for comparison.

use super::definition::Definition;
use super::walk;
use crate::simulation::{Guards, Start, Trial};

pub const DEFINITION: Definition = Definition {
    aim: "as the course program measures",
    unit: "m",
    trial,
    long_steps_per_s: None,
    // Distance is all that counts, however it came about.
    is_pushed: false,
    score: |measured| (measured.root_last_m - measured.root_first_m).norm(),
};

fn trial() -> Trial {
    Trial {
        gravity_m_s2: 10.0,
        start: Start::RootAt(2.5),
        settle_s: 0.0,
        scored_s: 10.0,
        // The course refuses nobody for its momentum, and a comparison must not either.
        guards: Guards { keeps_ledger: false, ..Guards::ALL },
        ..walk::trial()
    }
}
