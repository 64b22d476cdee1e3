//! What can be evolved.
//!
//! [`locomotion`] evolves creatures that move; [`progress`] says how far one got, [`founded`] begins with given
//! genomes.

pub mod founded;
pub mod locomotion;
pub mod progress;

pub use founded::Founded;
pub use locomotion::{Locomotion, Task};
