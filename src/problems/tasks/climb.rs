//! To get up the course's mountain, or another terrain: the height that the lowest point gained and kept.

use super::definition::Definition;
use super::walk;
use crate::problems::progress;
use crate::simulation::terrain::mountain;

pub const DEFINITION: Definition = Definition {
    aim: "get up the course's mountain",
    trial: || walk::trial().on(mountain()),
    long_steps_per_s: None,
    score: |measured| progress::climbed_m(&measured.heights_m),
    ..walk::DEFINITION
};
