//! The genetic algorithm: genomes in, better genomes out.
//!
//! Read in this order: a [`Problem`] says what a genome is and how good it is ([`Fitness`]); an
//! [`Individual`] is an evaluated genome with a parentage, a [`Population`] an ordered list of them;
//! [`Selection`] picks parents, [`variation`] recombines and mutates, [`survival`] decides who stays, and
//! [`generation`] strings these phases together; [`sharing`] deals evaluations out to threads.
//!
//! Architecture invariant: pure. Nothing here knows a creature, a clock, a file or a process, and every
//! stochastic function takes the stream it draws from.

pub mod fitness;
pub mod generation;
pub mod individual;
pub mod population;
pub mod problem;
pub mod selection;
pub mod sharing;
pub mod survival;
pub mod variation;

#[cfg(test)]
mod tests;

pub use fitness::{Evaluation, Fitness, Outcome};
pub use generation::Strategy;
pub use individual::{Id, Individual};
pub use population::{Population, Spread, Statistics};
pub use problem::{Gene, Problem};
pub use selection::Selection;
pub use variation::Variation;
