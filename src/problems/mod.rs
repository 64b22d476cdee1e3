//! What can be evolved.
//!
//! [`locomotion`] evolves creatures that move.

pub mod locomotion;

pub use locomotion::{Locomotion, Task};
