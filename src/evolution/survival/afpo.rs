//! Age-fitness Pareto optimisation (Schmidt & Lipson 2010): the young compete with the young, so that what is new has
//! time to become good.

use crate::evolution::individual::Individual;
use crate::evolution::population::Population;
use std::cmp::Reverse;

/// The best of the old population and its offspring, as many as the old one has: first those that nobody is both
/// better and younger than, then those that nobody else is, and so on; in each such front the fittest first. Age is
/// counted from the birth of the oldest ancestor; of two that are equal in both, the one that was there first counts as
/// the better one.
pub fn pareto<G: Clone>(old: &[Individual<G>], brood: Population<G>) -> Population<G> {
    let mut all: Vec<Individual<G>> = old.iter().cloned().chain(brood).collect();
    all.sort_by_key(|one| (Reverse(one.fitness), Reverse(one.origin)));
    // The youngest of each front so far: whoever comes later is no fitter, and has to be younger to be in it.
    let mut youngest: Vec<u32> = Vec::new();
    let mut ranked: Vec<(usize, Individual<G>)> = Vec::with_capacity(all.len());
    for one in all {
        let front = youngest.iter().position(|&origin| one.origin > origin);
        let front = front.unwrap_or(youngest.len());
        match youngest.get_mut(front) {
            Some(origin) => *origin = one.origin,
            None => youngest.push(one.origin),
        }
        ranked.push((front, one));
    }
    ranked.sort_by_key(|(front, _)| *front);
    ranked.into_iter().map(|(_, one)| one).take(old.len()).collect()
}
