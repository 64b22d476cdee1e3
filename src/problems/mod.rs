//! What can be evolved.
//!
//! [`locomotion`] evolves creatures that move; [`progress`] says how far one got, [`robustness`] what several trials
//! come to, [`founded`] begins with given genomes.

pub mod founded;
pub mod locomotion;
pub mod progress;
pub mod robustness;

pub use founded::Founded;
pub use locomotion::{Locomotion, Task};
pub use robustness::{RobustBy, Robustness};
