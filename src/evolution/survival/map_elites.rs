//! MAP-Elites (Mouret & Clune 2015): a map of what is possible, with the best that is known in each of its cells.

use super::scheme::Scheme;
use crate::evolution::individual::Individual;
use crate::evolution::population::Population;
use crate::evolution::problem::Problem;
use crate::rng::Stream;
use std::collections::BTreeMap;
use std::ops::RangeInclusive;

/// The most cells along a feature.
pub const BINS_MAX: u32 = 64;

/// The population is the best of each cell of a map of features: see [`fill`].
#[derive(Debug, Clone, Copy)]
pub struct MapElites {
    /// Cells along each of the two features, 2 to [`BINS_MAX`].
    pub bins: u32,
}

impl Scheme for MapElites {
    fn survivors<P: Problem>(
        self,
        problem: &P,
        old: &[Individual<P::Gene>],
        brood: Population<P::Gene>,
        _: usize,
        _: &mut Stream,
    ) -> Population<P::Gene> {
        fill(problem, self.bins, old.iter().cloned().chain(brood))
    }

    fn has_elites(self) -> bool {
        false
    }

    fn forgets(self) -> bool {
        false
    }

    fn has_cells(self) -> bool {
        true
    }

    /// As many as cells are filled.
    fn sizes(self, _: usize) -> RangeInclusive<usize> {
        1..=(self.bins * self.bins) as usize
    }
}

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
