//! The genomes that evolution begins with.

use super::function::Function;
use super::gene::{Link, Neuron};
use super::genome::Genome;
use super::marking::{self, Sockets};
use crate::choice;
use crate::rng::Stream;
use rand::RngExt;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// Weights of first genomes are uniform from minus this to this.
const WEIGHT: f64 = 1.0;
/// The most hidden neurons of a first genome.
const HIDDEN_MAX: u32 = 64;

/// What first genomes look like.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub enum Start {
    /// Every input and the bias are linked to every output, and nothing is hidden: NEAT's.
    #[default]
    Minimal,
    /// A layer of so many hidden neurons, linked from every input and the bias, and to every output.
    Layer {
        /// Hidden neurons, at least 1.
        neurons: u32,
    },
    /// One to so many hidden neurons, and each forward link with a probability of one half.
    Random {
        /// Hidden neurons at most, at least 1.
        neurons: u32,
    },
}

impl Start {
    /// The most genes that a first genome has.
    pub fn genes_max(self, sockets: Sockets) -> usize {
        let (sources, outputs) = (sockets.sources().count(), sockets.outputs().count());
        let of_layer = |neurons: u32| neurons as usize * (1 + sources + outputs);
        match self {
            Start::Minimal => sources * outputs,
            Start::Layer { neurons } => of_layer(neurons),
            Start::Random { neurons } => of_layer(neurons) + sources * outputs,
        }
    }

    /// Draws a genome.
    pub fn genome(self, sockets: Sockets, hidden: &[Function], rng: &mut Stream) -> Genome {
        let neurons = match self {
            Start::Minimal => 0,
            Start::Layer { neurons } => neurons,
            Start::Random { neurons } => rng.random_range(1..=neurons.max(1)),
        };
        let mut genome = Genome::default();
        let layer: Vec<_> = (0..u64::from(neurons)).map(marking::of_first).collect();
        for &marking in &layer {
            let function = hidden[rng.random_range(0..hidden.len())];
            genome.add_neuron(Neuron { marking, function });
        }
        let mut joins: Vec<_> = match self {
            Start::Layer { .. } => Vec::new(),
            _ => sockets
                .sources()
                .flat_map(|from| sockets.outputs().map(move |to| (from, to)))
                .collect(),
        };
        for &neuron in &layer {
            joins.extend(sockets.sources().map(|from| (from, neuron)));
            joins.extend(sockets.outputs().map(|to| (neuron, to)));
        }
        for (number, (from, to)) in joins.into_iter().enumerate() {
            let is_random = matches!(self, Start::Random { .. });
            // The first one is always there: a genome is never empty.
            if !is_random || rng.random_bool(0.5) || number == 0 {
                let weight = rng.random_range(-WEIGHT..=WEIGHT);
                genome.add_link(Link { from, to, weight, enabled: true });
            }
        }
        genome
    }
}

impl fmt::Display for Start {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Start::Minimal => write!(f, "minimal"),
            Start::Layer { neurons } => write!(f, "layer:{neurons}"),
            Start::Random { neurons } => write!(f, "random:{neurons}"),
        }
    }
}

impl FromStr for Start {
    type Err = String;

    /// Reads what `Display` writes; without its number a start has 10 neurons, as in the paper's ablations.
    fn from_str(text: &str) -> Result<Self, String> {
        let scheme = choice::Scheme::of(text);
        match scheme.name {
            "minimal" => scheme.plain(Start::Minimal),
            "layer" => Ok(Start::Layer { neurons: scheme.whole(10, 1, HIDDEN_MAX)? }),
            "random" => Ok(Start::Random { neurons: scheme.whole(10, 1, HIDDEN_MAX)? }),
            _ => Err(scheme.unknown("start", "minimal, layer:10 or random:10")),
        }
    }
}

choice::as_text!(Start);
