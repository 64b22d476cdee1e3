//! The genomes that evolution begins with.

use super::function::Function;
use super::gene::{Link, Neuron};
use super::genome::Genome;
use super::marking::{self, Sockets};
use crate::choice;
use crate::rng::Stream;
use rand::RngExt;
use serde::{Deserialize, Serialize};
use std::str::FromStr;
use strum::EnumCount;

/// Weights of first genomes are uniform from minus this to this.
const WEIGHT: f64 = 1.0;
/// The most hidden neurons of a first genome.
const HIDDEN_MAX: u32 = 64;
/// Hidden neurons of a first genome if nothing is said, as in the paper's ablations.
const NEURONS_USUAL: u32 = 10;

/// What first genomes look like.
#[derive(
    Debug,
    Clone,
    Copy,
    PartialEq,
    Eq,
    Default,
    Serialize,
    Deserialize,
    strum::Display,
    strum::EnumCount,
)]
#[strum(serialize_all = "kebab-case")]
#[serde(try_from = "String", into = "String")]
pub enum Start {
    /// Every input and the bias are linked to every output, and nothing is hidden: NEAT's.
    #[default]
    Minimal,
    /// A layer of so many hidden neurons, linked from every input and the bias, and to every output.
    #[strum(to_string = "layer:{neurons}")]
    Layer {
        /// Hidden neurons, at least 1.
        neurons: u32,
    },
    /// One to so many hidden neurons, and each forward link with a probability of one half.
    #[strum(to_string = "random:{neurons}")]
    Random {
        /// Hidden neurons at most, at least 1.
        neurons: u32,
    },
}

impl Start {
    /// One of every kind, with its usual number.
    pub const USUAL: [Start; Start::COUNT] = [
        Start::Minimal,
        Start::Layer { neurons: NEURONS_USUAL },
        Start::Random { neurons: NEURONS_USUAL },
    ];

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

impl FromStr for Start {
    type Err = String;

    /// Reads what `Display` writes; without its number a start has the usual one.
    fn from_str(text: &str) -> Result<Self, String> {
        let (usual, scheme) = choice::Scheme::of("start", &Self::USUAL, text)?;
        match usual {
            Start::Layer { neurons } => {
                Ok(Start::Layer { neurons: scheme.whole(neurons, 1, HIDDEN_MAX)? })
            }
            Start::Random { neurons } => {
                Ok(Start::Random { neurons: scheme.whole(neurons, 1, HIDDEN_MAX)? })
            }
            plain => scheme.plain(plain),
        }
    }
}

choice::as_text!(Start);
