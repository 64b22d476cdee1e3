//! The champion that a run keeps, of all that its islands had.
//!
//! Who has the highest score of thousands is also the luckiest. So those with the highest scores are tried once more,
//! where nobody was selected: kept is who is best by the lower of the two scores. That is a pure function of the
//! champions, whoever asks and whenever.

use super::subject::Subject;
use crate::evolution::{Fitness, Individual};
use std::cmp::Reverse;

/// No more champions are tried once more: each costs as much as a dozen evaluations.
const CANDIDATES_MAX: usize = 16;

/// The champion that is kept: the first of equal ones. Each comes with whatever the caller knows it by.
///
/// Nobody's score rises by being tried once more. So down the ranking by score, all is said as soon as one holds as much
/// as the next one has.
pub fn kept<'a, P: Subject, T>(
    problem: &P,
    champions: impl IntoIterator<Item = (T, &'a Individual<P::Gene>)>,
) -> Option<T>
where
    P::Gene: 'a,
{
    let mut ranking: Vec<_> = champions.into_iter().collect();
    ranking.sort_by_key(|(_, champion)| Reverse(champion.fitness));
    // Migrants are champions on several islands.
    ranking.dedup_by(|(_, next), (_, one)| one.genome == next.genome);
    let mut kept: Option<(Fitness, T)> = None;
    for (name, champion) in ranking.into_iter().take(CANDIDATES_MAX) {
        if kept.as_ref().is_some_and(|(best, _)| *best >= champion.fitness) {
            break;
        }
        let found = problem.tried_once_more(&champion.genome).unwrap_or(Fitness::HIGHEST);
        let holds = champion.fitness.min(found);
        if kept.as_ref().is_none_or(|(best, _)| holds > *best) {
            kept = Some((holds, name));
        }
    }
    kept.map(|(_, name)| name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::creature::{Course, Gene};
    use crate::evolution::{Id, Problem};
    use crate::problems::{Locomotion, RobustBy, Robustness, Validation};
    use crate::rng::{Purpose, Source};
    use crate::simulation::Engine;

    fn champion(problem: &Locomotion, index: u32) -> Individual<Gene> {
        let source = Source { seed: 5, island: 0 };
        let genome = problem.random_genome(&mut source.stream(0, index, Purpose::Genesis));
        let fitness = problem.evaluate(&genome).fitness;
        let id = Id { island: 0, generation: 0, index };
        Individual { id, parents: [None; 2], origin: 0, genome, fitness }
    }

    fn found(problem: &Locomotion, champions: &[Individual<Gene>]) -> Option<usize> {
        kept(problem, champions.iter().enumerate())
    }

    #[test]
    fn kept_is_who_is_best_in_both_engines() {
        let mut problem =
            Locomotion { encoding: Course { genes: 3, ..Course::DEFAULT }, ..Locomotion::DEFAULT };
        problem.robustness = Robustness { trials: 2, by: RobustBy::Mean };
        let mut champions: Vec<_> = (0..8).map(|index| champion(&problem, index)).collect();
        champions[3].fitness = Fitness::new(9.0);
        let holds = |one: &Individual<Gene>| {
            let creature = problem.express(&one.genome).unwrap();
            let usual = Locomotion { engine: Engine::Rapier, ..problem.clone() }.trial();
            let other = [8, 9].map(|index| {
                let trial = usual.perturbed(index);
                crate::simulation::simulate(&creature, &trial, Engine::Rapier)
                    .map(|measured| problem.task.score(&measured))
            });
            one.fitness.min(Fitness::new(Validation::of(Engine::Rapier, &other).mean))
        };
        let best = champions.iter().map(holds).max();
        let kept = found(&problem, &champions).unwrap();
        assert_eq!(Some(holds(&champions[kept])), best);
        assert_ne!(kept, 3, "the luckiest");
    }

    #[test]
    fn without_another_trial_the_first_of_the_highest_scores_is_kept() {
        let problem = Locomotion::single(Engine::Featherstone);
        let mut champions: Vec<_> = (0..4).map(|index| champion(&problem, index)).collect();
        champions.iter_mut().for_each(|one| one.fitness = Fitness::new(1.0));
        champions[0].fitness = Fitness::WORST;
        assert_eq!(found(&problem, &champions), Some(1));
        assert_eq!(found(&problem, &champions[..1]), Some(0));
        assert_eq!(found(&problem, &[]), None);
    }
}
