//! To keep moving: the length of the path of the centre of mass, the lectures' later fitness.

use super::definition::Definition;
use super::walk;
use crate::problems::progress;

pub const DEFINITION: Definition = Definition {
    aim: "keep moving",
    score: |measured| progress::travelled_m(&measured.track_m, measured.extent_m),
    ..walk::DEFINITION
};
