//! How offspring differ from their parents: free functions on sequences of genes.

use crate::rng::Stream;
use rand::RngExt;
use serde::{Deserialize, Serialize};

/// How often and how much genomes are varied.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Variation {
    /// Probability that an offspring has two parents, 0 to 1; else it starts as a copy of one.
    pub crossover_rate: f64,
    /// Probability of each value of each gene to be changed by point mutation, 0 to 1.
    pub point_rate: f64,
    /// The most by which point mutation changes a value, as a share of its range, 0 to 1.
    pub point_amount: f64,
    /// Probability of an offspring to lose a gene, 0 to 1.
    pub shrink_rate: f64,
    /// Probability of an offspring to gain a random gene, 0 to 1.
    pub grow_rate: f64,
    /// No genome gets longer than this, in genes, at least 1.
    pub genes_max: usize,
}

/// One-point crossover of unequal lengths, after the variable-length crossover of Smith's LS-1 (1980):
/// a head of `a` followed by a tail of `b`, cut independently, never empty, at most `genes_max` long.
pub fn one_point_crossover<G: Clone>(
    a: &[G],
    b: &[G],
    genes_max: usize,
    rng: &mut Stream,
) -> Vec<G> {
    if a.is_empty() || b.is_empty() {
        return a.iter().chain(b).take(genes_max).cloned().collect();
    }
    // A head of at least one gene: the child is never empty and keeps the root of its first parent.
    let head = rng.random_range(1..=a.len());
    let tail = rng.random_range(0..=b.len());
    a[..head].iter().chain(&b[tail..]).take(genes_max).cloned().collect()
}

/// Point mutation: hands each gene to `mutate_gene`, which changes its values at its own rate.
pub fn point<G>(
    genome: &mut [G],
    rng: &mut Stream,
    mut mutate_gene: impl FnMut(&mut G, &mut Stream),
) {
    for gene in genome {
        mutate_gene(gene, rng);
    }
}

/// With probability `rate` removes one gene, but never the last one.
pub fn shrink<G>(genome: &mut Vec<G>, rate: f64, rng: &mut Stream) {
    if happens(rate, rng) && genome.len() > 1 {
        genome.remove(rng.random_range(0..genome.len()));
    }
}

/// With probability `rate` appends a gene, unless there are `genes_max` already.
pub fn grow<G>(
    genome: &mut Vec<G>,
    rate: f64,
    genes_max: usize,
    rng: &mut Stream,
    random_gene: impl FnOnce(&mut Stream) -> G,
) {
    if happens(rate, rng) && genome.len() < genes_max {
        genome.push(random_gene(rng));
    }
}

/// Whether an event of this probability happens; 0 never does, 1 always.
pub fn happens(probability: f64, rng: &mut Stream) -> bool {
    rng.random::<f64>() < probability
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::{Purpose, Source};

    fn stream(index: u32) -> Stream {
        Source { seed: 5, island: 0 }.stream(0, index, Purpose::Mutation)
    }

    #[test]
    fn crossover_joins_a_head_of_one_parent_to_a_tail_of_the_other() {
        let (a, b) = ([1, 2, 3], [11, 12, 13, 14, 15]);
        let mut lengths = std::collections::BTreeSet::new();
        for index in 0..500 {
            let child = one_point_crossover(&a, &b, 6, &mut stream(index));
            let head = child.iter().take_while(|&&gene| gene < 10).count();
            assert!(head >= 1 && child[..head] == a[..head], "{child:?}");
            let tail = &child[head..];
            assert!(tail.is_empty() || b.windows(tail.len()).any(|run| run == tail), "{child:?}");
            lengths.insert(child.len());
        }
        assert_eq!(lengths, (1..=6).collect());
    }

    #[test]
    fn rates_are_honoured() {
        let (mut shrunk, mut grown) = (0, 0);
        for index in 0..4_000 {
            let mut genome = vec![0; 4];
            shrink(&mut genome, 0.25, &mut stream(index));
            shrunk += usize::from(genome.len() == 3);
            let mut genome = vec![0; 4];
            grow(&mut genome, 0.1, 9, &mut stream(index), |_| 1);
            grown += usize::from(genome == [0, 0, 0, 0, 1]);
        }
        assert!((900..1_100).contains(&shrunk), "{shrunk}");
        assert!((340..460).contains(&grown), "{grown}");
    }

    #[test]
    fn a_genome_never_vanishes_and_never_outgrows_its_bound() {
        let mut genome = vec![0];
        shrink(&mut genome, 1.0, &mut stream(0));
        assert_eq!(genome, [0]);
        for index in 0..10 {
            grow(&mut genome, 1.0, 3, &mut stream(index), |_| 1);
        }
        assert_eq!(genome, [0, 1, 1]);
    }
}
