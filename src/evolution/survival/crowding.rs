//! Deterministic crowding (Mahfoud 1995): offspring compete with who is most like them, so that niches persist.

use crate::evolution::individual::Individual;
use crate::evolution::population::Population;
use crate::evolution::problem::Problem;

/// Each offspring, in order, replaces whoever stands in the place of the parent that is more like it, if it is
/// better; of equally like parents, the first.
pub fn crowd<P: Problem>(
    problem: &P,
    old: &[Individual<P::Gene>],
    brood: Population<P::Gene>,
) -> Population<P::Gene> {
    let mut next = old.to_vec();
    for child in brood {
        let places = child.parents.iter().flatten();
        let places = places.filter_map(|parent| old.iter().position(|one| one.id == *parent));
        let distance = |&place: &usize| problem.distance(&child.genome, &old[place].genome);
        let nearest = places.min_by(|a, b| distance(a).total_cmp(&distance(b)));
        if let Some(place) = nearest.filter(|&place| child.fitness > next[place].fitness) {
            next[place] = child;
        }
    }
    next
}
