//! A gene as it travels: a neuron or a link, both in a record of one size.

use super::function::Function;
use super::marking::Marking;
use bytemuck::{Pod, Zeroable};
use serde::{Deserialize, Serialize};

/// What a record holds: [`Gene::kind`].
const NEURON: u32 = 1;
const LINK: u32 = 2;
const DISABLED_LINK: u32 = 3;

/// A hidden neuron or a link. Fields that its kind does not have are 0, so that equal genes have equal bytes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, Pod, Zeroable)]
#[repr(C)]
pub struct Gene {
    /// The marking of a neuron, or of the neuron that a link comes from.
    from: u64,
    /// The marking of the neuron that a link leads to.
    to: u64,
    /// The weight of a link.
    weight: f64,
    /// Neuron, link or disabled link.
    kind: u32,
    /// The function of a neuron.
    function: u32,
}

/// No weight is larger than this, or smaller than minus this.
pub const WEIGHT_MAX: f64 = 8.0;

/// A hidden neuron.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Neuron {
    /// Its name in every genome: see [`super::marking`].
    pub marking: Marking,
    /// What it does.
    pub function: Function,
}

/// A link. The neurons that it joins are its marking.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Link {
    /// The neuron that it comes from.
    pub from: Marking,
    /// The neuron that it leads to.
    pub to: Marking,
    /// What it multiplies by, at most [`WEIGHT_MAX`] either way.
    pub weight: f64,
    /// Whether it is in use.
    pub enabled: bool,
}

impl Link {
    /// What it is known by in every genome.
    pub fn marking(&self) -> (Marking, Marking) {
        (self.from, self.to)
    }
}

/// What a gene says.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Part {
    /// A hidden neuron.
    Neuron(Neuron),
    /// A link.
    Link(Link),
}

impl Gene {
    /// What it says; none if it is no gene that evolution makes.
    pub fn part(&self) -> Option<Part> {
        let Gene { from, to, weight, kind, function } = *self;
        let part = match kind {
            NEURON => {
                Part::Neuron(Neuron { marking: from, function: Function::of_code(function)? })
            }
            LINK | DISABLED_LINK => Part::Link(Link { from, to, weight, enabled: kind == LINK }),
            _ => return None,
        };
        let is_canonical = bytemuck::bytes_of(&Gene::from(part)) == bytemuck::bytes_of(self);
        (is_canonical && (-WEIGHT_MAX..=WEIGHT_MAX).contains(&weight)).then_some(part)
    }
}

impl From<Part> for Gene {
    fn from(part: Part) -> Self {
        match part {
            Part::Neuron(Neuron { marking, function }) => {
                Gene { from: marking, to: 0, weight: 0.0, kind: NEURON, function: function as u32 }
            }
            Part::Link(Link { from, to, weight, enabled }) => {
                let kind = if enabled { LINK } else { DISABLED_LINK };
                Gene { from, to, weight, kind, function: 0 }
            }
        }
    }
}
