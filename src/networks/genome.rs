//! A genome taken apart: hidden neurons and links, each list in the order of its markings.

use super::gene::{Gene, Link, Neuron, Part};
use super::marking::{Marking, Sockets, is_hidden};
use std::collections::{BTreeMap, BTreeSet};

/// A genome: inputs, bias and outputs are the same in all of a problem and not said.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Genome {
    /// Its hidden neurons, sorted by their markings, none twice.
    pub neurons: Vec<Neuron>,
    /// Its links, sorted by their markings, none twice.
    pub links: Vec<Link>,
}

/// Why something is no genome of a problem.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum Misgrown {
    /// A gene is none.
    #[error("it has a gene that is neither a neuron nor a link")]
    Gene,
    /// A neuron or link is there twice or in the wrong place.
    #[error("its neurons or links are not in the order of their markings, each once")]
    Order,
    /// A link joins what is not there or what cannot be joined.
    #[error("it has a link that leads nowhere or comes from nowhere")]
    Link,
    /// Links lead back to where they come from, where they must not.
    #[error("it has a circle of links")]
    Circle,
}

impl Genome {
    /// Takes genes apart.
    ///
    /// # Errors
    /// If they cannot be a genome for these sockets.
    pub fn of_genes(genes: &[Gene], sockets: Sockets) -> Result<Self, Misgrown> {
        let mut genome = Self::default();
        for gene in genes {
            match gene.part().ok_or(Misgrown::Gene)? {
                Part::Neuron(_) if !genome.links.is_empty() => return Err(Misgrown::Order),
                Part::Neuron(neuron) => genome.neurons.push(neuron),
                Part::Link(link) => genome.links.push(link),
            }
        }
        genome.check(sockets)?;
        Ok(genome)
    }

    /// The genes that say the same.
    pub fn genes(&self) -> Vec<Gene> {
        let neurons = self.neurons.iter().map(|neuron| Gene::from(Part::Neuron(*neuron)));
        neurons.chain(self.links.iter().map(|link| Gene::from(Part::Link(*link)))).collect()
    }

    fn check(&self, sockets: Sockets) -> Result<(), Misgrown> {
        let is_rising = self.neurons.is_sorted_by(|a, b| a.marking < b.marking)
            && self.links.is_sorted_by(|a, b| a.marking() < b.marking());
        require(is_rising, Misgrown::Order)?;
        require(self.neurons.iter().all(|it| is_hidden(it.marking)), Misgrown::Link)?;
        let exists = |marking: Marking| match is_hidden(marking) {
            true => self.neuron(marking).is_some(),
            false => marking < sockets.len() as Marking,
        };
        let joins =
            |link: &Link| exists(link.from) && exists(link.to) && sockets.is_target(link.to);
        require(self.links.iter().all(joins), Misgrown::Link)
    }

    /// The hidden neuron with a marking.
    pub fn neuron(&self, marking: Marking) -> Option<&Neuron> {
        let place = self.neurons.binary_search_by_key(&marking, |it| it.marking).ok()?;
        self.neurons.get(place)
    }

    /// The link between two neurons.
    pub fn link(&self, from: Marking, to: Marking) -> Option<&Link> {
        let place = self.links.binary_search_by_key(&(from, to), Link::marking).ok()?;
        self.links.get(place)
    }

    /// Adds a neuron that is not there yet.
    pub fn add_neuron(&mut self, neuron: Neuron) {
        let place = self.neurons.partition_point(|it| it.marking < neuron.marking);
        self.neurons.insert(place, neuron);
    }

    /// Adds a link that is not there yet.
    pub fn add_link(&mut self, link: Link) {
        let place = self.links.partition_point(|it| it.marking() < link.marking());
        self.links.insert(place, link);
    }

    /// How many genes it has.
    pub fn len(&self) -> usize {
        self.neurons.len() + self.links.len()
    }

    /// Whether it has no gene at all.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The neurons that are reached from one, itself included, over links in use or not.
    pub fn reached_from(&self, start: Marking) -> BTreeSet<Marking> {
        let (mut reached, mut open) = (BTreeSet::new(), vec![start]);
        while let Some(marking) = open.pop() {
            if reached.insert(marking) {
                let first = self.links.partition_point(|link| link.from < marking);
                let own = self.links[first..].iter().take_while(|link| link.from == marking);
                open.extend(own.map(|link| link.to));
            }
        }
        reached
    }

    /// All neurons that links lead to, in an order in which every link leads forwards; none if there is a circle.
    pub fn forwards(&self, sockets: Sockets) -> Option<Vec<Marking>> {
        let targets = || sockets.outputs().chain(self.neurons.iter().map(|it| it.marking));
        let mut missing: BTreeMap<Marking, usize> = targets().map(|it| (it, 0)).collect();
        for link in &self.links {
            if missing.contains_key(&link.from) {
                *missing.entry(link.to).or_default() += 1;
            }
        }
        let mut order: Vec<Marking> = targets().filter(|it| missing[it] == 0).collect();
        let mut next = 0;
        while let Some(&marking) = order.get(next) {
            next += 1;
            let first = self.links.partition_point(|link| link.from < marking);
            for link in self.links[first..].iter().take_while(|link| link.from == marking) {
                let left = missing.entry(link.to).or_default();
                *left -= 1;
                if *left == 0 {
                    order.push(link.to);
                }
            }
        }
        (order.len() == missing.len()).then_some(order)
    }
}

fn require(condition: bool, otherwise: Misgrown) -> Result<(), Misgrown> {
    if condition { Ok(()) } else { Err(otherwise) }
}
