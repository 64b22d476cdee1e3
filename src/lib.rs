//! An island-model genetic algorithm that evolves virtual creatures.

pub mod rng;

pub mod creature;
pub mod evolution;

pub mod archipelago;
pub mod simulation;

pub mod problems;

pub mod formats;
pub mod store;
pub mod transport;
#[cfg(feature = "view")]
pub mod view;

pub mod app;
