//! How genomes change and grow, as the paper says it (section 4.1 and figure 3).

use super::function::Function;
use super::gene::{Link, Neuron, WEIGHT_MAX};
use super::genome::Genome;
use super::marking::{Marking, Sockets, of_split};
use crate::rng::Stream;
use rand::RngExt;
use rand::seq::IndexedRandom;

/// Of the weights of a genome that changes, the share that is perturbed; the others get a new value.
const PERTURBED: f64 = 0.9;

/// How often and how much a genome changes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Growth<'a> {
    /// Probability of the weights of a genome to change.
    pub weights_rate: f64,
    /// A weight is perturbed uniformly by at most this, and a new one is at most this; up to twice [`WEIGHT_MAX`].
    pub weight_step: f64,
    /// Probability of a link to be split by a new neuron.
    pub neuron_rate: f64,
    /// Probability of a new link.
    pub link_rate: f64,
    /// What new neurons may do.
    pub functions: &'a [Function],
    /// Whether no circle of links may be made.
    pub is_acyclic: bool,
    /// No genome grows beyond so many genes.
    pub genes_max: usize,
}

impl Growth<'_> {
    /// Mutates a genome: first its weights, then its structure, so that what is new works as it was made.
    pub fn mutate(&self, genome: &mut Genome, sockets: Sockets, rng: &mut Stream) {
        if happens(self.weights_rate, rng) {
            self.change_weights(genome, rng);
        }
        if happens(self.neuron_rate, rng) && genome.len() + 3 <= self.genes_max {
            self.split_a_link(genome, rng);
        }
        if happens(self.link_rate, rng) && genome.len() < self.genes_max {
            self.add_a_link(genome, sockets, rng);
        }
    }

    fn change_weights(&self, genome: &mut Genome, rng: &mut Stream) {
        for link in &mut genome.links {
            let is_perturbed = happens(PERTURBED, rng);
            let drawn = self.weight(rng);
            let weight = if is_perturbed { link.weight + drawn } else { drawn };
            link.weight = weight.clamp(-WEIGHT_MAX, WEIGHT_MAX);
        }
    }

    fn weight(&self, rng: &mut Stream) -> f64 {
        rng.random_range(-1.0..=1.0) * self.weight_step
    }

    /// A link in use is disabled, and a new neuron put in its place: the link into it has weight 1, the one out of it
    /// the weight of the old one.
    pub fn split_a_link(&self, genome: &mut Genome, rng: &mut Stream) {
        let in_use: Vec<usize> =
            (0..genome.links.len()).filter(|&place| genome.links[place].enabled).collect();
        let Some(&place) = in_use.choose(rng) else { return };
        let Some(&function) = self.functions.choose(rng) else { return };
        let old = &mut genome.links[place];
        old.enabled = false;
        let Link { from, to, weight, .. } = *old;
        let marking = (0..)
            .map(|nth| of_split(from, to, nth))
            .find(|&marking| genome.neuron(marking).is_none())
            .expect("a genome has fewer neurons than there are numbers");
        genome.add_neuron(Neuron { marking, function });
        genome.add_link(Link { from, to: marking, weight: 1.0, enabled: true });
        genome.add_link(Link { from: marking, to, weight, enabled: true });
    }

    /// Two neurons that no link joins in this direction are joined, if there are such, with a random weight.
    pub fn add_a_link(&self, genome: &mut Genome, sockets: Sockets, rng: &mut Stream) {
        let Some(&(from, to)) = self.joins(genome, sockets).choose(rng) else { return };
        let weight = self.weight(rng).clamp(-WEIGHT_MAX, WEIGHT_MAX);
        genome.add_link(Link { from, to, weight, enabled: true });
    }

    /// All pairs of neurons that can be joined.
    fn joins(&self, genome: &Genome, sockets: Sockets) -> Vec<(Marking, Marking)> {
        let hidden = || genome.neurons.iter().map(|neuron| neuron.marking);
        let mut joins = Vec::new();
        for to in sockets.outputs().chain(hidden()) {
            let downstream = self.is_acyclic.then(|| genome.reached_from(to));
            let leads_back = |from| downstream.as_ref().is_some_and(|all| all.contains(&from));
            for from in sockets.sources().chain(sockets.outputs()).chain(hidden()) {
                if genome.link(from, to).is_none() && !leads_back(from) {
                    joins.push((from, to));
                }
            }
        }
        joins
    }
}

fn happens(probability: f64, rng: &mut Stream) -> bool {
    rng.random::<f64>() < probability
}
