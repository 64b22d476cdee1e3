//! Generational replacement with elitism (De Jong 1975): all but the best make room for the offspring.

use super::scheme::Scheme;
use crate::evolution::individual::Individual;
use crate::evolution::population::{Population, elite};
use crate::evolution::problem::Problem;
use crate::rng::Stream;

/// The offspring replace all but the elites.
#[derive(Debug, Clone, Copy)]
pub struct Generational;

/// The same, but of equally good ones the youngest counts as the best.
#[derive(Debug, Clone, Copy)]
pub struct Drifting;

impl Scheme for Generational {}

impl Scheme for Drifting {
    fn survivors<P: Problem>(
        self,
        _: &P,
        old: &[Individual<P::Gene>],
        brood: Population<P::Gene>,
        elites: usize,
        _: &mut Stream,
    ) -> Population<P::Gene> {
        brood.into_iter().chain(elite(old, elites)).collect()
    }
}
