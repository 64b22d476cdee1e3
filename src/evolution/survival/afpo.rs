//! Age-fitness Pareto optimisation (Schmidt & Lipson 2010): the young compete with the young, so that what is new has
//! time to become good. Parents are picked at random, and a random newcomer comes with each generation.

use super::scheme::Scheme;
use crate::evolution::individual::Individual;
use crate::evolution::population::Population;
use crate::evolution::problem::Problem;
use crate::rng::Stream;
use rand::RngExt;
use std::cmp::Reverse;

/// [`pareto`] tournaments, with one random newcomer a generation.
#[derive(Debug, Clone, Copy)]
pub struct Afpo;

impl Scheme for Afpo {
    fn survivors<P: Problem>(
        self,
        _: &P,
        old: &[Individual<P::Gene>],
        brood: Population<P::Gene>,
        _: usize,
        rng: &mut Stream,
    ) -> Population<P::Gene> {
        pareto(old, brood, rng)
    }

    fn has_elites(self) -> bool {
        false
    }

    fn forgets(self) -> bool {
        false
    }

    fn newcomers(self) -> usize {
        1
    }
}

/// As many of the old population and its offspring as the old one has. Age is counted from the birth of the oldest
/// ancestor.
///
/// Pareto tournaments decide: of two drawn at random, one that the other is better and younger than dies, until as many
/// are left as there may be. Of two that are equal in age or fitness the other one decides; of two that are equal in both,
/// who was there first counts as the better one. In the paper a population may grow beyond its size while nobody is
/// worse than anybody; here the least fit of them die then.
pub fn pareto<G: Clone>(
    old: &[Individual<G>],
    brood: Population<G>,
    rng: &mut Stream,
) -> Population<G> {
    let mut living: Vec<Individual<G>> = old.iter().cloned().chain(brood).collect();
    let front = front(&living);
    if front.len() >= old.len() {
        return front.into_iter().take(old.len()).map(|index| living[index].clone()).collect();
    }
    while living.len() > old.len() {
        let mut draw = || rng.random_range(0..living.len());
        let (one, other) = (draw(), draw());
        let (first, second) = (one.min(other), one.max(other));
        if first == second {
            continue;
        }
        // Of equals the first one stays.
        if is_no_worse(&living[first], &living[second]) {
            living.remove(second);
        } else if is_no_worse(&living[second], &living[first]) {
            living.remove(first);
        }
    }
    living
}

/// Whether one is neither less fit nor older than another.
fn is_no_worse<G>(one: &Individual<G>, other: &Individual<G>) -> bool {
    one.fitness >= other.fitness && one.origin >= other.origin
}

/// The indices of those that nobody dominates, the fittest first.
fn front<G>(all: &[Individual<G>]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..all.len()).collect();
    order.sort_by_key(|&index| (Reverse(all[index].fitness), Reverse(all[index].origin)));
    // Whoever comes later is no fitter, and has to be younger.
    let mut youngest = None;
    order.retain(|&index| {
        let is_younger = youngest.is_none_or(|youngest| all[index].origin > youngest);
        if is_younger {
            youngest = Some(all[index].origin);
        }
        is_younger
    });
    order
}
