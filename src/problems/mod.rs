//! What can be evolved.
//!
//! [`locomotion`] evolves creatures that move; [`founded`] begins with given genomes.

pub mod founded;
pub mod locomotion;

pub use founded::Founded;
pub use locomotion::{Locomotion, Task};
