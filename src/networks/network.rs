//! What a genome becomes: neurons that work.

use super::function::Function;
use super::genome::{Genome, Misgrown};
use super::marking::{Marking, Sockets};
use std::collections::BTreeMap;

/// How a network works.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Wiring {
    /// Links lead forwards, and a signal passes through all of them at once.
    FeedForward,
    /// Links may lead anywhere, and a signal passes one link at a time, so that a network remembers.
    Recurrent,
}

/// A network that is ready to work. It is made once, and works without allocating.
#[derive(Debug, Clone)]
pub struct Network {
    wiring: Wiring,
    inputs: usize,
    outputs: usize,
    /// Neurons that compute, in the order in which they do, which is that of their places where it does not matter.
    neurons: Vec<Working>,
    /// The links of all neurons, those of each in a row: where each comes from and its weight.
    links: Vec<(u32, f64)>,
    /// What every neuron gives: inputs, bias, outputs, hidden ones.
    values: Vec<f64>,
    /// What they will give, where all change at once.
    next: Vec<f64>,
}

#[derive(Debug, Clone, Copy)]
struct Working {
    place: u32,
    function: Function,
    /// The first of its links, and the first that is not its any more.
    links: [u32; 2],
}

impl Network {
    /// Builds a network whose outputs do what `output` says.
    ///
    /// # Errors
    /// If it has a circle of links and its wiring allows none.
    pub fn new(
        genome: &Genome,
        sockets: Sockets,
        wiring: Wiring,
        output: Function,
    ) -> Result<Self, Misgrown> {
        let hidden = || genome.neurons.iter().map(|neuron| (neuron.marking, neuron.function));
        let all = sockets.outputs().map(|marking| (marking, output)).chain(hidden());
        let functions: BTreeMap<Marking, Function> = all.clone().collect();
        let order: Vec<Marking> = match wiring {
            Wiring::FeedForward => genome.forwards(sockets).ok_or(Misgrown::Circle)?,
            Wiring::Recurrent => all.clone().map(|(marking, _)| marking).collect(),
        };
        let known = sockets.sources().chain(all.map(|(marking, _)| marking));
        let places: BTreeMap<Marking, u32> = known.zip(0..).collect();
        let mut arriving: BTreeMap<Marking, Vec<(u32, f64)>> = BTreeMap::new();
        for link in genome.links.iter().filter(|link| link.enabled) {
            let from = *places.get(&link.from).ok_or(Misgrown::Link)?;
            arriving.entry(link.to).or_default().push((from, link.weight));
        }
        let (mut neurons, mut links) = (Vec::new(), Vec::new());
        for marking in order {
            let first = links.len() as u32;
            links.extend(arriving.remove(&marking).unwrap_or_default());
            let links = [first, links.len() as u32];
            neurons.push(Working { place: places[&marking], function: functions[&marking], links });
        }
        let mut network = Self {
            wiring,
            inputs: sockets.inputs as usize,
            outputs: sockets.outputs as usize,
            neurons,
            links,
            values: vec![0.0; places.len()],
            next: vec![0.0; places.len()],
        };
        network.forget();
        Ok(network)
    }

    /// Makes it as it was when it was built.
    pub fn forget(&mut self) {
        self.values.fill(0.0);
        self.values[self.inputs] = 1.0;
        self.next.copy_from_slice(&self.values);
    }

    /// Puts numbers in, as many as there are inputs, lets it work once, and returns what comes out.
    pub fn step(&mut self, inputs: &[f64]) -> &[f64] {
        let given = inputs.len().min(self.inputs);
        self.values[..given].copy_from_slice(&inputs[..given]);
        match self.wiring {
            Wiring::FeedForward => {
                for neuron in &self.neurons {
                    self.values[neuron.place as usize] = neuron.of(&self.links, &self.values);
                }
            }
            Wiring::Recurrent => {
                self.next[..given].copy_from_slice(&inputs[..given]);
                for neuron in &self.neurons {
                    self.next[neuron.place as usize] = neuron.of(&self.links, &self.values);
                }
                std::mem::swap(&mut self.values, &mut self.next);
            }
        }
        let first = self.inputs + 1;
        &self.values[first..first + self.outputs]
    }

    /// How many links are in use.
    pub fn links(&self) -> usize {
        self.links.len()
    }

    /// What every neuron gave last: inputs, bias, outputs, then hidden ones in the order of their markings.
    pub fn values(&self) -> &[f64] {
        &self.values
    }
}

impl Working {
    fn of(&self, links: &[(u32, f64)], values: &[f64]) -> f64 {
        let own = &links[self.links[0] as usize..self.links[1] as usize];
        let sum = own.iter().fold(0.0, |sum, &(from, weight)| sum + values[from as usize] * weight);
        self.function.at(sum)
    }
}
