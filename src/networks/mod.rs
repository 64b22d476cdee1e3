//! Networks that grow: NEAT (Stanley & Miikkulainen, *Evolving Neural Networks through Augmenting Topologies*, 2002)
//! and the functions of CPPNs (Stanley 2007).
//!
//! Read in this order: a [`Genome`] is a list of [`Neuron`]s and a list of [`Link`]s between them, and travels as
//! [`Gene`]s; [`marking`] says which genes of two genomes mean the same; [`start`] makes first genomes, [`mutation`]
//! grows them, [`crossover`] recombines two and [`compatibility`] says how far they are apart; a [`Network`] is what a
//! genome becomes, and [`Function`] what its neurons do.
//!
//! Architecture invariant: pure. Nothing here knows a problem, a population, a file or a counter: a marking is a
//! function of what was done, so that the same innovation has the same marking on every island, machine and day.

pub mod compatibility;
pub mod crossover;
pub mod function;
pub mod gene;
pub mod genome;
pub mod marking;
pub mod mutation;
pub mod network;
pub mod start;

#[cfg(test)]
mod tests;

pub use compatibility::Coefficients;
pub use function::Function;
pub use gene::{Gene, Link, Neuron, WEIGHT_MAX};
pub use genome::{Genome, Misgrown};
pub use marking::Sockets;
pub use mutation::Growth;
pub use network::{Network, Wiring};
pub use start::Start;
