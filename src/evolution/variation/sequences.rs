//! Operators on sequences of genes, whatever a gene is.

use super::operators::happens;
use crate::rng::Stream;
use rand::RngExt;

/// Whether parents' genes in the same place mean the same, so that a child must have as many.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Layout {
    /// All genomes are equally long, and each place has its meaning.
    Fixed,
    /// Genomes are of any length.
    Free,
}

/// One-point crossover (Holland 1975): a head of `a` followed by a tail of `b`. Where genomes are of any length the
/// two are cut independently, after Smith's LS-1 (1980). The child is never empty, at most `genes_max` long, and
/// begins with the first gene of `a`; where places have a meaning and there are two, it has genes of both.
pub fn one_point_crossover<G: Clone>(
    a: &[G],
    b: &[G],
    layout: Layout,
    genes_max: usize,
    rng: &mut Stream,
) -> Vec<G> {
    if let Some(child) = only_parent(a, b, genes_max) {
        return child;
    }
    let (head, tail) = match layout {
        Layout::Fixed => {
            let head = if a.len() < 2 { 1 } else { rng.random_range(1..a.len()) };
            (head, head.min(b.len()))
        }
        Layout::Free => (rng.random_range(1..=a.len()), rng.random_range(0..=b.len())),
    };
    a[..head].iter().chain(&b[tail..]).take(genes_max).cloned().collect()
}

/// Two-point crossover (De Jong 1975): `a` with a part replaced by one of `b`. Where genomes are of any length the two
/// parts are chosen independently and either may be empty. The child is never empty, at most `genes_max` long, and
/// begins with the first gene of `a`.
pub fn two_point_crossover<G: Clone>(
    a: &[G],
    b: &[G],
    layout: Layout,
    genes_max: usize,
    rng: &mut Stream,
) -> Vec<G> {
    if let Some(child) = only_parent(a, b, genes_max) {
        return child;
    }
    let mut part = |from: usize, length: usize| {
        let (one, other) = (rng.random_range(from..=length), rng.random_range(from..=length));
        (one.min(other), one.max(other))
    };
    let (head, rest) = part(1, a.len());
    let (begin, end) = match layout {
        Layout::Fixed => (head.min(b.len()), rest.min(b.len())),
        Layout::Free => part(0, b.len()),
    };
    let genes = a[..head].iter().chain(&b[begin..end]).chain(&a[rest..]);
    genes.take(genes_max).cloned().collect()
}

/// The child of two parents of whom one has no genes: the other one.
fn only_parent<G: Clone>(a: &[G], b: &[G], genes_max: usize) -> Option<Vec<G>> {
    let is_it = a.is_empty() || b.is_empty();
    is_it.then(|| a.iter().chain(b).take(genes_max).cloned().collect())
}

/// Gene by gene, `with` makes the child's of the parents' in the same place; what only `a` has stays, so that the child
/// is as long as `a`.
pub fn gene_by_gene<G: Clone>(a: &[G], b: &[G], mut with: impl FnMut(&G, &G) -> G) -> Vec<G> {
    let shared = a.iter().zip(b).map(|(a, b)| with(a, b));
    let (shared, length): (Vec<G>, usize) = (shared.collect(), a.len().min(b.len()));
    shared.into_iter().chain(a[length..].iter().cloned()).collect()
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::{Purpose, Source};
    use std::collections::BTreeSet;

    const A: [i32; 5] = [1, 2, 3, 4, 5];
    const B: [i32; 5] = [11, 12, 13, 14, 15];

    fn stream(index: u32) -> Stream {
        Source { seed: 5, island: 0 }.stream(0, index, Purpose::Mutation)
    }

    #[test]
    fn crossover_joins_a_head_of_one_parent_to_a_tail_of_the_other() {
        let (a, b) = (&A[..3], &B);
        let mut lengths = BTreeSet::new();
        for index in 0..500 {
            let child = one_point_crossover(a, b, Layout::Free, 6, &mut stream(index));
            let head = child.iter().take_while(|&&gene| gene < 10).count();
            assert!(head >= 1 && child[..head] == a[..head], "{child:?}");
            let tail = &child[head..];
            assert!(tail.is_empty() || b.windows(tail.len()).any(|run| run == tail), "{child:?}");
            lengths.insert(child.len());
        }
        assert_eq!(lengths, (1..=6).collect());
    }

    #[test]
    fn where_places_have_a_meaning_every_gene_stays_in_its_place() {
        let mut children = BTreeSet::new();
        for index in 0..500 {
            let rng = &mut stream(index);
            let child = match index % 3 {
                0 => one_point_crossover(&A, &B, Layout::Fixed, 5, rng),
                1 => two_point_crossover(&A, &B, Layout::Fixed, 5, rng),
                _ => gene_by_gene(&A, &B, |&a, &b| if rng.random() { a } else { b }),
            };
            assert_eq!(child.iter().map(|gene| gene % 10).collect::<Vec<_>>(), A, "{child:?}");
            children.insert((index % 3, child));
        }
        let kinds = [0, 1, 2].map(|kind| children.iter().filter(|child| child.0 == kind).count());
        assert_eq!(kinds, [4, 11, 32], "every child that there can be");
    }

    #[test]
    fn two_point_crossover_replaces_a_part_by_one_of_any_length() {
        let mut lengths = BTreeSet::new();
        for index in 0..2_000 {
            let child = two_point_crossover(&A[..3], &B, Layout::Free, 7, &mut stream(index));
            assert_eq!(child[0], 1);
            let own: Vec<_> = child.iter().filter(|&&gene| gene < 10).collect();
            assert!(own.is_sorted() && child.len() <= 7, "{child:?}");
            lengths.insert(child.len());
        }
        assert_eq!(lengths, (1..=7).collect());
    }

    #[test]
    fn a_child_made_gene_by_gene_is_as_long_as_its_mother() {
        assert_eq!(gene_by_gene(&A, &B[..2], |_, &b| b), [11, 12, 3, 4, 5]);
        assert_eq!(gene_by_gene(&A[..2], &B, |_, &b| b), [11, 12]);
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
