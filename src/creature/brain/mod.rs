//! What moves bodies.

pub mod controller;
pub mod waveform;

pub use controller::{Controller, Motor};
pub use waveform::Waveform;
