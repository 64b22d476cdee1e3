//! rapier's multibodies, in reduced coordinates: the engine that our own one is judged by.
//!
//! Joints of rapier's multibodies cannot drift apart, as its impulse joints do under random bodies.
//!
//! Architecture invariants: this alone imports rapier; every trial builds a fresh world, since a world that was
//! used before gives other bits; all is f64 up to this border and f32 within it.

mod convert;
mod field;
mod scene;
mod solid;
mod surface;
mod world;

pub use world::RapierWorld;
