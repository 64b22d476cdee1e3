//! MAP-Elites (Mouret & Clune 2015): a map of what is possible, with the best that is known in each of its cells.

use crate::evolution::individual::Individual;
use crate::evolution::population::Population;
use crate::evolution::problem::Problem;
use std::collections::BTreeMap;

/// The most cells along a feature.
pub const BINS_MAX: u32 = 64;

/// The best individual of each cell, the first of equal ones, in the order of the cells. What could not be scored has
/// no place, unless there is nothing else: then the first of all is the whole map.
pub fn fill<P: Problem>(
    problem: &P,
    bins: u32,
    all: impl IntoIterator<Item = Individual<P::Gene>>,
) -> Population<P::Gene> {
    let mut map: BTreeMap<[u32; 2], Individual<P::Gene>> = BTreeMap::new();
    let mut failed = None;
    for one in all {
        if one.fitness.finite().is_none() {
            failed.get_or_insert(one);
            continue;
        }
        let place = cell(problem.features(&one.genome), bins);
        match map.get(&place) {
            Some(elite) if elite.fitness >= one.fitness => {}
            _ => drop(map.insert(place, one)),
        }
    }
    match map.is_empty() {
        true => failed.into_iter().collect(),
        false => map.into_values().collect(),
    }
}

/// The cell of a pair of features, each from 0 to 1.
pub fn cell(features: [f64; 2], bins: u32) -> [u32; 2] {
    // What is no number is in the first cell.
    features.map(|feature| ((feature * f64::from(bins)) as u32).min(bins - 1))
}
