//! Where a body begins.

use std::f64::consts::TAU;

/// Where a body begins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Start {
    /// With its root this high, in metres.
    RootAt(f64),
    /// With its lowest point this high, in metres.
    LowestAt(f64),
    /// With its lowest point this high, in metres, and all of it leaning by [`LEAN_RAD`].
    LeaningAt(f64),
}

/// How far a body leans that begins so, in radians: 5°. What stands on feet rights itself; what was only balanced
/// (a tower on its point, a wheel with its weight on top) comes down while it settles, not while it is scored.
pub const LEAN_RAD: f64 = TAU / 72.0;
