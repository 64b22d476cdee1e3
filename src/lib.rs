//! An island-model genetic algorithm that evolves virtual creatures.

pub mod rng;

pub mod evolution;

pub mod creature;

pub mod archipelago;

pub mod simulation;

pub mod problems;

pub mod formats;

#[cfg(feature = "view")]
pub mod view;
