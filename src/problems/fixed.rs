//! Genomes that are all of one length: what is theirs in variation, and what is common to their problems.

use crate::evolution::{Evaluation, Gene, Outcome};
use crate::rng::Stream;
use rand::RngExt;

/// One-point crossover (Holland 1975): the head of `a` and the tail of `b`, cut at the same place, so that the child is
/// as long as `a`. Neither part is empty where there are two genes.
pub fn crossover<G: Gene>(a: &[G], b: &[G], rng: &mut Stream) -> Vec<G> {
    // Only what another program wrote has genomes of different lengths.
    let shared = a.len().min(b.len());
    let cut = if shared < 2 { shared } else { rng.random_range(1..shared) };
    a[..cut].iter().chain(&b[cut..shared]).chain(&a[shared..]).copied().collect()
}

/// The mean difference of the genes in the same place, each from 0 to 1; one that only one of them has counts as
/// wholly different.
pub fn distance<G: Gene>(a: &[G], b: &[G], difference: impl Fn(&G, &G) -> f64) -> f64 {
    let shared: f64 = a.iter().zip(b).map(|(a, b)| difference(a, b)).sum();
    let longer = a.len().max(b.len()).max(1);
    (shared + a.len().abs_diff(b.len()) as f64) / longer as f64
}

/// What a genome scores, unless it has another length than it must or a gene that may not be used.
pub fn evaluate<G: Gene>(
    genome: &[G],
    length: usize,
    score: impl FnOnce(&[G]) -> f64,
) -> Evaluation {
    let is_sound = genome.len() == length && genome.iter().all(Gene::is_valid);
    if is_sound { Evaluation::scored(score(genome)) } else { Evaluation::failed(Outcome::TooLarge) }
}

#[cfg(test)]
mod tests {
    use super::super::bits::Bit;
    use super::*;
    use crate::rng::{Purpose, Source};

    #[test]
    fn a_child_is_as_long_as_its_parents_and_has_each_gene_in_its_place() {
        let (a, b) = (vec![Bit(0); 7], vec![Bit(1); 7]);
        let mut cuts = std::collections::BTreeSet::new();
        for index in 0..200 {
            let mut rng = Source { seed: 3, island: 0 }.stream(0, index, Purpose::Crossover);
            let child = crossover(&a, &b, &mut rng);
            let cut = child.iter().filter(|bit| **bit == Bit(0)).count();
            assert_eq!(child, [&a[..cut], &b[cut..]].concat());
            cuts.insert(cut);
        }
        assert_eq!(cuts, (1..7).collect());
    }

    #[test]
    fn parents_of_one_gene_or_of_different_lengths_have_a_child_all_the_same() {
        let mut rng = Source { seed: 3, island: 0 }.stream(0, 0, Purpose::Crossover);
        assert_eq!(crossover(&[Bit(0)], &[Bit(1)], &mut rng), [Bit(0)]);
        assert_eq!(crossover::<Bit>(&[], &[], &mut rng), []);
        assert_eq!(crossover(&[Bit(0); 5], &[Bit(1)], &mut rng).len(), 5);
    }
}
