//! What genomes are made of.

use bytemuck::Pod;
use serde::{Serialize, de::DeserializeOwned};
use std::fmt::Debug;

/// What a genome is a sequence of: plain data that may cross a process boundary as it lies in memory.
pub trait Gene: Pod + PartialEq + Debug + Send + Sync + Serialize + DeserializeOwned {
    /// The name under which genes of this layout travel; change it when the layout changes.
    const WIRE_NAME: &'static str;

    /// Whether a gene that came from a file or another process may be used.
    fn is_valid(&self) -> bool;

    /// The real numbers that it is made of, each from 0 to [`VALUE_MAX`](super::variation::values::VALUE_MAX), always
    /// as many; none if it is made of something else.
    fn values(&self) -> &[f64] {
        &[]
    }

    /// The same, to be changed.
    fn values_mut(&mut self) -> &mut [f64] {
        &mut []
    }
}
