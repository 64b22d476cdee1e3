//! Crossover by markings (section 3.2 of the paper).

use super::gene::{Link, Neuron};
use super::genome::Genome;
use crate::rng::Stream;
use rand::RngExt;

/// A gene that is disabled in a parent is disabled in the child with this probability.
const STAYS_DISABLED: f64 = 0.75;

/// The child of two parents of whom `mother` is the fitter one: what both have is taken from either at random, what only
/// she has is hers, and what only he has is left out.
///
/// In the paper the disjoint and excess genes of equally fit parents are inherited at random. Here, as in the program
/// that its results were made with, one of them counts as the fitter: the caller says which.
pub fn cross(mother: &Genome, father: &Genome, rng: &mut Stream) -> Genome {
    let neuron = |own: &Neuron| {
        let other = father.neuron(own.marking);
        *other.filter(|_| rng.random()).unwrap_or(own)
    };
    let neurons = mother.neurons.iter().map(neuron).collect();
    let links =
        mother.links.iter().map(|own| link(own, father.link(own.from, own.to), rng)).collect();
    Genome { neurons, links }
}

fn link(own: &Link, other: Option<&Link>, rng: &mut Stream) -> Link {
    let chosen = *other.filter(|_| rng.random()).unwrap_or(own);
    let is_in_use = own.enabled && other.is_none_or(|other| other.enabled);
    let enabled = is_in_use || rng.random::<f64>() >= STAYS_DISABLED;
    Link { enabled, ..chosen }
}
