//! The champion that a run keeps, of all that its islands had.
//!
//! Who has the highest score of thousands is also the luckiest. So those with the highest scores are tried once more,
//! where nobody was selected: kept is who is best by the lower of the two scores. That is a pure function of the
//! champions, whoever asks and whenever.

use super::subject::Subject;
use crate::evolution::{Fitness, Gene, Individual};

/// No more champions are tried once more: each costs as much as a dozen evaluations.
const CANDIDATES_MAX: usize = 16;

/// Those who may be kept, of all champions that were seen. It holds no more than it needs, however many there were.
#[derive(Debug, Clone, PartialEq)]
pub struct Candidates<G> {
    /// With their islands, the best first; of equal ones who was seen first.
    ranking: Vec<(u32, Individual<G>)>,
}

impl<G: Gene> Candidates<G> {
    /// Nobody was seen.
    pub fn none() -> Self {
        Self { ranking: Vec::new() }
    }

    /// Sees a champion of an island. Migrants are champions on several: who is there already is no further candidate.
    pub fn see(&mut self, island: u32, champion: &Individual<G>) {
        let place = self.ranking.partition_point(|(_, one)| one.fitness >= champion.fitness);
        let is_same = |(_, one): &(u32, Individual<G>)| one.genome == champion.genome;
        if place == CANDIDATES_MAX || self.ranking[..place].iter().any(is_same) {
            return;
        }
        if let Some(lower) = self.ranking[place..].iter().position(is_same) {
            self.ranking.remove(place + lower);
        }
        self.ranking.insert(place, (island, champion.clone()));
        self.ranking.truncate(CANDIDATES_MAX);
    }

    /// Whether nobody was seen.
    pub fn is_empty(&self) -> bool {
        self.ranking.is_empty()
    }

    /// The highest score.
    pub fn highest(&self) -> Fitness {
        self.ranking.first().map_or(Fitness::WORST, |(_, one)| one.fitness)
    }

    /// The champion that is kept, the first of equal ones, and its island.
    ///
    /// Nobody's score rises by being tried once more. So down the ranking by score, all is said as soon as one holds as
    /// much as the next one has.
    pub fn kept<P: Subject<Gene = G>>(self, problem: &P) -> Option<(u32, Individual<G>)> {
        let mut kept: Option<(Fitness, (u32, Individual<G>))> = None;
        for (island, champion) in self.ranking {
            if kept.as_ref().is_some_and(|(best, _)| *best >= champion.fitness) {
                break;
            }
            let found = problem.tried_once_more(&champion.genome).unwrap_or(Fitness::HIGHEST);
            let holds = champion.fitness.min(found);
            if kept.as_ref().is_none_or(|(best, _)| holds > *best) {
                kept = Some((holds, (island, champion)));
            }
        }
        kept.map(|(_, one)| one)
    }
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
        let one = champion_of(problem, index);
        Individual { fitness: problem.evaluate(&one.genome).fitness, ..one }
    }

    fn champion_of(problem: &Locomotion, index: u32) -> Individual<Gene> {
        let source = Source { seed: 5, island: 0 };
        let genome = problem.random_genome(&mut source.stream(0, index, Purpose::Genesis));
        let id = Id { island: 0, generation: 0, index };
        Individual { id, parents: [None; 2], origin: 0, genome, fitness: Fitness::WORST }
    }

    fn seen(champions: &[Individual<Gene>]) -> Candidates<Gene> {
        let mut candidates = Candidates::none();
        (0..).zip(champions).for_each(|(place, one)| candidates.see(place, one));
        candidates
    }

    fn found(problem: &Locomotion, champions: &[Individual<Gene>]) -> Option<usize> {
        seen(champions).kept(problem).map(|(place, _)| place as usize)
    }

    #[test]
    fn candidates_are_the_best_however_many_were_seen_and_each_genome_once() {
        let problem = Locomotion::single(Engine::Featherstone);
        let named = |index: u32| {
            let score = f64::from(index * 37 % 101);
            Individual { fitness: Fitness::new(score), ..champion_of(&problem, index) }
        };
        let all: Vec<_> = (0..100).map(named).collect();
        let mut sorted: Vec<u32> = (0..100).collect();
        sorted.sort_by_key(|&place| std::cmp::Reverse(all[place as usize].fitness));
        let candidates = seen(&all);
        let places: Vec<u32> = candidates.ranking.iter().map(|(place, _)| *place).collect();
        assert_eq!(places, sorted[..CANDIDATES_MAX]);
        let twice: Vec<_> = all.iter().chain(&all).cloned().collect();
        assert_eq!(seen(&twice), candidates);
        let mut better = candidates.ranking[3].1.clone();
        better.fitness = Fitness::new(200.0);
        let mut raised = candidates.clone();
        raised.see(7, &better);
        assert_eq!(raised.ranking[0], (7, better));
        assert_eq!(raised.ranking.len(), CANDIDATES_MAX);
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
