//! The gene: 17 numbers from 0 (included) to 1 (excluded).

use bytemuck::{Pod, Zeroable};
use serde::{Deserialize, Serialize};

/// Numbers in a gene.
pub const PARAMETER_COUNT: usize = 17;

/// The largest value of a parameter: the largest number below 1.
pub const VALUE_MAX: f64 = 1.0 - f64::EPSILON / 2.0;

/// One gene: a link, the joint that holds it to its parent, and the motor in that joint. What each number is for says
/// [`PARAMETERS`](super::PARAMETERS).
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable, Serialize, Deserialize)]
#[repr(transparent)]
pub struct Gene(pub [f64; PARAMETER_COUNT]);

impl crate::evolution::Gene for Gene {
    const WIRE_NAME: &'static str = "islands.creature.gene.v1";

    fn is_valid(&self) -> bool {
        self.0.iter().all(|value| (0.0..1.0).contains(value))
    }

    fn values(&self) -> &[f64] {
        &self.0
    }

    fn values_mut(&mut self) -> &mut [f64] {
        &mut self.0
    }
}
