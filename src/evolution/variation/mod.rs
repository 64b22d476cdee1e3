//! How offspring differ from their parents.
//!
//! [`operators`] lists the operators and their rates, [`sequences`] has those on genomes, [`values`] those on the numbers
//! that genes are made of.

pub mod operators;
pub mod sequences;
pub mod values;

pub use operators::{Crossover, Mutation, Variation, happens};

use super::gene::Gene;
use crate::rng::Stream;
use rand::RngExt;
use sequences::Layout;

/// Recombines two genomes as `variation` says.
pub fn recombine<G: Gene>(
    a: &[G],
    b: &[G],
    layout: Layout,
    variation: &Variation,
    rng: &mut Stream,
) -> Vec<G> {
    let Variation { crossover, genes_max, .. } = *variation;
    let genes_max = if layout == Layout::Fixed { usize::MAX } else { genes_max };
    match crossover {
        Crossover::OnePoint => sequences::one_point_crossover(a, b, layout, genes_max, rng),
        Crossover::TwoPoint => sequences::two_point_crossover(a, b, layout, genes_max, rng),
        Crossover::Uniform => {
            sequences::gene_by_gene(a, b, |a, b| if rng.random() { *b } else { *a })
        }
        Crossover::Blend { .. } | Crossover::Sbx { .. } => {
            sequences::gene_by_gene(a, b, |a, b| number_by_number(a, b, crossover, rng))
        }
    }
}

/// Mutates a genome as `variation` says: each gene and, where genomes may be of any length, how many there are.
pub fn mutate<G>(
    genome: &mut Vec<G>,
    layout: Layout,
    variation: &Variation,
    rng: &mut Stream,
    mutate_gene: impl Fn(&mut G, &mut Stream),
    random_gene: impl Fn(&mut Stream) -> G,
    duplicate: impl Fn(&mut Vec<G>, &mut Stream),
) {
    genome.iter_mut().for_each(|gene| mutate_gene(gene, rng));
    if layout == Layout::Fixed {
        return;
    }
    let Variation { shrink_rate, grow_rate, duplicate_rate, genes_max, .. } = *variation;
    sequences::shrink(genome, shrink_rate, rng);
    sequences::grow(genome, grow_rate, genes_max, rng, random_gene);
    if happens(duplicate_rate, rng) {
        duplicate(genome, rng);
    }
}

fn number_by_number<G: Gene>(a: &G, b: &G, crossover: Crossover, rng: &mut Stream) -> G {
    let mut child = *a;
    if child.values().is_empty() {
        return if rng.random() { *b } else { *a };
    }
    values::recombine(child.values_mut(), b.values(), crossover, rng);
    child
}
