//! Genomes that are all of one length: what is common to their problems.

use crate::evolution::{Evaluation, Gene, Outcome};

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
