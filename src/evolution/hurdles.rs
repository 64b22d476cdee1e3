//! How far an evaluation has to go: racing (Maron & Moore 1994), with hurdles that are part of an island's state.
//!
//! A score that holds is dear: many trials, maybe a second engine. Most offspring need none of that to be known as no
//! better than those who are there, and only who would be the best needs all of it. So an evaluation may end early,
//! with an estimate, where the whole score would change nothing that matters: who is the best of its island, and so
//! its champion. Who travels gets a whole score then.
//!
//! What is above all hurdles has its whole score, which is a pure function of the genome. Hurdles are functions of the
//! residents, so that an evolution in other processes or on other threads has the same ones.

use super::fitness::Fitness;
use super::individual::Individual;

/// What a genome has to get over to be tried further.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hurdles {
    /// Who is below these after a first, a second and a third look is not tried further: a quarter, half and three
    /// quarters of the residents are worse than the hurdles.
    pub looks: [Fitness; LOOKS],
    /// Who is not above this after that, which the best of the residents is, needs no more to be known as no better.
    pub best: Fitness,
}

/// So many looks are taken at a genome before it gets its whole score.
pub const LOOKS: usize = 3;

impl Hurdles {
    /// None: everything gets its whole score.
    pub const NONE: Self = Self { looks: [Fitness::WORST; LOOKS], best: Fitness::WORST };

    /// Nobody can become the best, and everybody gets over all looks.
    pub const LAST: Self = Self { best: Fitness::HIGHEST, ..Self::NONE };

    /// Those of the offspring of some residents.
    ///
    /// Looks decide only where each generation makes room for the next
    /// ([`Survival::forgets`](super::Survival::forgets)): elsewhere an estimate could stay.
    pub fn of<G>(residents: &[Individual<G>], forgets: bool) -> Self {
        let mut fitness: Vec<Fitness> = residents.iter().map(|one| one.fitness).collect();
        fitness.sort_unstable();
        let or_none = |hurdle: Option<&Fitness>| hurdle.copied().unwrap_or(Fitness::WORST);
        let looks = match forgets {
            true => std::array::from_fn(|look| {
                or_none(fitness.get(fitness.len() * (look + 1) / (LOOKS + 1)))
            }),
            false => [Fitness::WORST; LOOKS],
        };
        Self { looks, best: or_none(fitness.last()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolution::{Id, Survival};

    fn residents(scores: &[f64]) -> Vec<Individual<f64>> {
        let id = Id { island: 0, generation: 0, index: 0 };
        let one = |&score: &f64| Individual {
            id,
            parents: [None; 2],
            origin: 0,
            genome: Vec::new(),
            fitness: Fitness::new(score),
        };
        scores.iter().map(one).collect()
    }

    #[test]
    fn quarters_of_the_residents_fail_at_the_looks_and_none_is_above_the_last_hurdle() {
        let residents = residents(&[3.0, 9.0, 1.0, 7.0, f64::NAN, 5.0, 4.0, 6.0]);
        let hurdles = Hurdles::of(&residents, true);
        let looks = [3.0, 5.0, 7.0].map(Fitness::new);
        assert_eq!(hurdles, Hurdles { looks, best: Fitness::new(9.0) });
    }

    #[test]
    fn where_residents_stay_no_look_decides() {
        let hurdles = Hurdles::of(&residents(&[3.0, 9.0, 1.0]), Survival::Crowding.forgets());
        assert_eq!(hurdles, Hurdles { best: Fitness::new(9.0), ..Hurdles::NONE });
        assert_eq!(Hurdles::of(&residents(&[]), false), Hurdles::NONE);
    }
}
