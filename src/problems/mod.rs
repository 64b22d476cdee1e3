//! What can be evolved.
//!
//! [`locomotion`] evolves creatures that move; [`progress`] says how far one got.

pub mod locomotion;
pub mod progress;

pub use locomotion::{Locomotion, Task};
