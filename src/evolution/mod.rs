//! The genetic algorithm: genomes in, better genomes out.
//!
//! Read in this order: a [`Problem`] says what a genome is and how good it is ([`Fitness`]); an [`Individual`] is an
//! evaluated genome with a parentage, a [`Population`] an ordered list of them; [`Selection`] picks parents,
//! [`variation`] recombines and mutates, [`survival`] decides who stays; [`generation`] has these phases,
//! [`Strategy`] says which of each, and [`memory`] is what an island learns on the way. [`hurdles`] say how far an
//! evaluation has to go.
//!
//! Architecture invariant: pure. Nothing here knows a creature, a clock, a file or a process, and every
//! stochastic function takes the stream it draws from.

pub mod cma;
pub mod fitness;
pub mod founders;
pub mod gene;
pub mod generation;
pub mod hurdles;
pub mod individual;
pub mod learned;
pub mod memory;
pub mod outcome;
pub mod population;
pub mod problem;
pub mod selection;
pub mod strategy;
pub mod survival;
pub mod variation;

#[cfg(test)]
mod tests;

pub use fitness::{Evaluation, Fitness};
pub use founders::Founders;
pub use gene::Gene;
pub use hurdles::{Hurdles, LOOKS};
pub use individual::{Id, Individual};
pub use learned::Learned;
pub use memory::Memory;
pub use outcome::{Failure, Outcome, Outcomes};
pub use population::{Population, Spread, Statistics};
pub use problem::Problem;
pub use selection::Selection;
pub use strategy::{Adaptation, Reproduction, Strategy};
pub use survival::Survival;
pub use variation::{Crossover, Mutation, Variation};
