//! Deterministic crowding (Mahfoud 1995): everybody becomes a parent once, whatever its fitness, and offspring compete
//! with the parent that they are most like, so that niches persist.
//!
//! Two parents have two children. In the paper those are the two halves of one crossover; here each is bred like any
//! other offspring, one with either parent as its mother.

use super::scheme::Scheme;
use crate::evolution::individual::Individual;
use crate::evolution::population::Population;
use crate::evolution::problem::Problem;
use crate::evolution::selection::Selection;
use crate::rng::Stream;
use rand::seq::SliceRandom;

/// An offspring replaces the parent that is more like it, if it is better.
#[derive(Debug, Clone, Copy)]
pub struct Crowding;

impl Scheme for Crowding {
    fn survivors<P: Problem>(
        self,
        problem: &P,
        old: &[Individual<P::Gene>],
        brood: Population<P::Gene>,
        _: usize,
        _: &mut Stream,
    ) -> Population<P::Gene> {
        crowd(problem, old, brood)
    }

    fn couples<P: Problem>(
        self,
        _: &P,
        population: &[Individual<P::Gene>],
        _: Selection,
        _: usize,
        stream: impl Fn(usize) -> Stream,
    ) -> Vec<[usize; 2]> {
        couples(population.len(), &mut stream(0))
    }

    fn has_elites(self) -> bool {
        false
    }

    fn forgets(self) -> bool {
        false
    }
}

/// The parents of as many offspring as there are individuals: pairs at random, each twice, one way round and the other.
/// Of an odd number one is left, and is its own mate.
pub fn couples(individuals: usize, rng: &mut Stream) -> Vec<[usize; 2]> {
    let mut all: Vec<usize> = (0..individuals).collect();
    all.shuffle(rng);
    let family = |pair: &[usize]| match *pair {
        [one, other] => vec![[one, other], [other, one]],
        _ => pair.iter().map(|&alone| [alone, alone]).collect(),
    };
    all.chunks(2).flat_map(family).collect()
}

/// Each offspring replaces a parent if it is better: of the two ways in which two children can face their parents,
/// that in which they are more like them.
pub fn crowd<P: Problem>(
    problem: &P,
    old: &[Individual<P::Gene>],
    brood: Population<P::Gene>,
) -> Population<P::Gene> {
    let mut next = old.to_vec();
    for family in brood.chunks(2) {
        for (child, place) in family.iter().zip(rivals(problem, old, family)) {
            if let Some(place) = place.filter(|&place| child.fitness > next[place].fitness) {
                next[place] = child.clone();
            }
        }
    }
    next
}

/// The places of the parents that the children of a couple compete with, which are their mothers'.
fn rivals<P: Problem>(
    problem: &P,
    old: &[Individual<P::Gene>],
    family: &[Individual<P::Gene>],
) -> Vec<Option<usize>> {
    let place = |child: &Individual<P::Gene>| {
        child.parents[0].and_then(|mother| old.iter().position(|one| one.id == mother))
    };
    let mut places: Vec<Option<usize>> = family.iter().map(place).collect();
    if let ([one, other], [Some(first), Some(second)]) = (family, &places[..]) {
        let distance = |child: &Individual<P::Gene>, place: usize| {
            problem.distance(&child.genome, &old[place].genome)
        };
        let straight = distance(one, *first) + distance(other, *second);
        let crosswise = distance(one, *second) + distance(other, *first);
        if crosswise < straight {
            places.reverse();
        }
    }
    places
}
