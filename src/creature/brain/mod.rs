//! Brains: senses in, commands out, once a control period.
//!
//! A [`Controller`] is what a body has of a brain: its motors, the control period, and which [`Brain`] commands the
//! motors. `Brain::awake` makes it a [`Mind`], which has a state and lives as long as a trial. [`senses`] say what a
//! mind may know and [`waves`] is the brain that needs to know nothing. A further brain is a file and a line of
//! [`Brain`].

pub mod controller;
pub mod mind;
#[cfg(test)]
mod reflex;
pub mod senses;
pub mod waveform;
pub mod waves;

pub use controller::{Brain, Controller};
pub use mind::{Mind, Motor};
#[cfg(test)]
pub use reflex::Reflex;
pub use senses::{JointSense, Senses};
pub use waveform::Waveform;
pub use waves::Wave;
