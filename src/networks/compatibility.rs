//! How far two genomes are apart: δ of the paper (equation 1).

use super::genome::Genome;

/// What differences count.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coefficients {
    /// A gene that only one of the genomes has. The paper tells disjoint from excess genes, by the order of its counter,
    /// and gives both the same weight in all its experiments (c₁ = c₂); markings without an order cannot tell them apart.
    pub unmatched: f64,
    /// The mean difference of the weights of links that both have: c₃.
    pub weight: f64,
}

/// Genomes of fewer links than this count as one of length 1 (N = 1).
const SMALL: usize = 20;

impl Coefficients {
    /// Those of most of the paper's experiments.
    pub const USUAL: Self = Self { unmatched: 1.0, weight: 0.4 };
    /// Those of its large population, for double poles without velocities.
    pub const LARGE: Self = Self { unmatched: 1.0, weight: 3.0 };

    /// δ of two genomes, 0 if they are equal, and without a bound. Genes are links here, since neurons follow from them.
    pub fn distance(self, a: &Genome, b: &Genome) -> f64 {
        let (mut matching, mut differences) = (0_usize, 0.0);
        let mut others = b.links.iter().peekable();
        for link in &a.links {
            while others.next_if(|other| other.marking() < link.marking()).is_some() {}
            if let Some(other) = others.next_if(|other| other.marking() == link.marking()) {
                matching += 1;
                differences += (link.weight - other.weight).abs();
            }
        }
        let unmatched = a.links.len() + b.links.len() - 2 * matching;
        let longer = a.links.len().max(b.links.len());
        let length = if longer < SMALL { 1.0 } else { longer as f64 };
        let mean = if matching == 0 { 0.0 } else { differences / matching as f64 };
        self.unmatched * unmatched as f64 / length + self.weight * mean
    }
}
