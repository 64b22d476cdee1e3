//! An island-model genetic algorithm that evolves virtual creatures.

pub mod rng;

pub mod evolution;

pub mod archipelago;

pub mod transport;
