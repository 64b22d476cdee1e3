//! What a scheme of survival may change of a generation.

use crate::evolution::individual::Individual;
use crate::evolution::population::{Population, elite};
use crate::evolution::problem::Problem;
use crate::evolution::selection::Selection;
use crate::rng::Stream;
use std::ops::RangeInclusive;

/// All that a scheme of survival changes of a generation. What it does not say is as with generational replacement.
pub trait Scheme: Copy {
    /// The next population: `old` is the one whose offspring `brood` is. The best `elites` of the old one live on, and
    /// come first. The stream is drawn from by those that leave it to chance who dies.
    fn survivors<P: Problem>(
        self,
        _problem: &P,
        old: &[Individual<P::Gene>],
        brood: Population<P::Gene>,
        elites: usize,
        _rng: &mut Stream,
    ) -> Population<P::Gene> {
        elite(old, elites).chain(brood).collect()
    }

    /// The parents of each of so many offspring, two indices into the population. `selection` is how parents are picked
    /// where the scheme leaves it open: where it is survival that selects, they are picked at random. A stream comes for
    /// each offspring.
    fn couples<P: Problem>(
        self,
        _problem: &P,
        population: &[Individual<P::Gene>],
        selection: Selection,
        offspring: usize,
        stream: impl Fn(usize) -> Stream,
    ) -> Vec<[usize; 2]> {
        let at_random = Selection::Tournament { size: 1 };
        let selection = if self.has_selection() { selection } else { at_random };
        let fitness: Vec<_> = population.iter().map(|one| one.fitness).collect();
        selection.prepare(&fitness).couples(offspring, stream)
    }

    /// Whether the best of the old population are kept as elites, and parents are picked by selection. Elsewhere it is
    /// survival that selects: the old population lives on as far as the new one is no better.
    fn has_elites(self) -> bool {
        true
    }

    /// Whether selection picks parents.
    fn has_selection(self) -> bool {
        self.has_elites()
    }

    /// The distance from which on individuals are of different species, where a population is divided into such.
    fn species_radius(self) -> Option<f64> {
        None
    }

    /// How parents are picked if nothing is said, where it is not as usual.
    fn usual_selection(self) -> Option<Selection> {
        None
    }

    /// Offspring of a generation that have no parents, but a random genome.
    fn newcomers(self) -> usize {
        0
    }

    /// Whether individuals have cells that they compete for at any time, founders and immigrants, too.
    fn has_cells(self) -> bool {
        false
    }

    /// How many individuals there may be, where there is room for so many.
    fn sizes(self, population: usize) -> RangeInclusive<usize> {
        population..=population
    }

    /// Whether each generation makes room for the next and is told by fitness alone, so that an estimate of somebody's
    /// fitness changes nothing for long.
    fn forgets(self) -> bool {
        true
    }
}
