//! Creatures that move: a genome is worth how far its body gets.

use super::robustness::{RobustBy, Robustness};
use super::tasks::Task;
use crate::creature::Creature;
use crate::creature::encodings::{Course, Encoding, ExpressionError};
use crate::evolution::variation::sequences::Layout;
use crate::evolution::{self, Evaluation, Fitness, Hurdles, Outcome, Problem, Variation};
use crate::rng::Stream;
use crate::simulation::{self, CannotCollide, Engine, Terrain, Trajectory, Trial};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;

/// The height of a body from which on bodies count as equally high, in metres.
pub const HEIGHT_MAX_M: f64 = 3.0;

/// The problem of locomotion, over any encoding.
#[derive(Debug, Clone, PartialEq)]
pub struct Locomotion<E = Course> {
    /// How genes become creatures.
    pub encoding: E,
    /// What the bodies have to do.
    pub task: Task,
    /// What moves the bodies.
    pub engine: Engine,
    /// How often they are tried.
    pub robustness: Robustness,
    /// Whether who gets over all hurdles is judged by the other engine, too, whose score counts if it does not confirm
    /// the own one.
    pub judged: bool,
    /// What they stand on, if it is another ground than the task's.
    pub terrain: Option<Arc<Terrain>>,
}

impl Default for Locomotion {
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl Locomotion {
    /// What a run solves if nothing else is said.
    pub const DEFAULT: Self = Self {
        encoding: Course::DEFAULT,
        task: Task::Walk,
        engine: Engine::FASTEST,
        robustness: Robustness { trials: 8, by: RobustBy::Quartile },
        judged: false,
        terrain: None,
    };

    /// One trial as it is in an engine, which nobody judges.
    pub const fn single(engine: Engine) -> Self {
        Self { engine, robustness: Robustness::NONE, ..Self::DEFAULT }
    }
}

impl<E: Encoding> Locomotion<E> {
    /// How bodies are tried.
    pub fn trial(&self) -> Trial {
        let trial = self.task.trial_in(self.engine);
        match &self.terrain {
            None => trial,
            Some(terrain) => trial.on(Arc::clone(terrain)),
        }
    }

    /// Whether its engine can do its trials.
    ///
    /// # Errors
    /// If there is something to collide with, and the engine lets no bodies collide.
    pub fn check(&self) -> Result<(), CannotCollide> {
        simulation::check(self.engine, &self.trial())
    }

    /// Expresses a genome.
    ///
    /// # Errors
    /// If it is empty or describes more than the encoding builds.
    pub fn express(&self, genome: &[E::Gene]) -> Result<Creature, ExpressionError> {
        self.encoding.express(genome)
    }

    /// Evaluates a genome and films it; the evaluation is the one that [`Problem::evaluate`] gives. The film is of that
    /// of its trials whose score is nearest to what all of them come to.
    ///
    /// # Errors
    /// If the genome cannot be expressed.
    pub fn film(&self, genome: &[E::Gene]) -> Result<(Evaluation, Trajectory), ExpressionError> {
        Ok(self.film_body(&self.express(genome)?))
    }

    /// Evaluates a body and films it, as it is with a genome.
    pub fn film_body(&self, creature: &Creature) -> (Evaluation, Trajectory) {
        self.film_trial(creature, &self.trial())
    }

    /// Evaluates a body in another trial than the task's, or in its perturbations, and films it.
    pub fn film_trial(&self, creature: &Creature, trial: &Trial) -> (Evaluation, Trajectory) {
        let (score, typical) = self.typical(creature, trial);
        let (_, trajectory) = simulation::film(creature, &typical, self.engine);
        (evaluation(score), trajectory)
    }

    /// Evaluates a body, as [`Problem::evaluate`] does with the genome that it was grown from.
    pub fn evaluate_body(&self, creature: &Creature) -> Evaluation {
        let score = || self.score(creature, &self.trial(), &Hurdles::NONE);
        evaluation(catch_unwind(AssertUnwindSafe(score)).unwrap_or(Err(Outcome::Panicked)))
    }

    /// Simulation steps of a genome's usual trials, if they run to their end; of settling, which lasts as long as it
    /// takes, one round.
    pub fn steps(&self) -> u64 {
        let trials = self.trials(self.trial()).take(self.robustness.trials.max(1) as usize);
        trials.map(|trial| u64::from(trial.steps())).sum()
    }

    /// All scores that a genome can have on an island, its estimates and, last, its whole score.
    pub fn possible_scores(&self, genome: &[E::Gene]) -> Vec<Fitness> {
        let possible = || self.grow(genome).map(|creature| self.possible(&creature));
        let tried = catch_unwind(AssertUnwindSafe(possible));
        tried.ok().and_then(Result::ok).unwrap_or_else(|| vec![Fitness::WORST])
    }

    /// The body that is scored for a genome.
    fn grow(&self, genome: &[E::Gene]) -> Result<Creature, Outcome> {
        let mut values = genome.iter().flat_map(evolution::Gene::values);
        if !values.all(|value| value.is_finite()) {
            return Err(Outcome::NotFinite);
        }
        if !genome.iter().all(evolution::Gene::is_valid) {
            return Err(Outcome::TooLarge);
        }
        self.express(genome).map_err(|_| Outcome::TooLarge)
    }
}

impl<E: Encoding> Problem for Locomotion<E> {
    type Gene = E::Gene;

    fn random_gene(&self, rng: &mut Stream) -> E::Gene {
        self.encoding.random_gene(rng)
    }

    fn random_genome(&self, rng: &mut Stream) -> Vec<E::Gene> {
        self.encoding.random_genome(rng)
    }

    fn layout(&self) -> Layout {
        self.encoding.layout()
    }

    fn mutate_gene(&self, gene: &mut E::Gene, variation: &Variation, rng: &mut Stream) {
        self.encoding.mutate_gene(gene, variation, rng);
    }

    fn duplicate(&self, genome: &mut Vec<E::Gene>, genes_max: usize, rng: &mut Stream) {
        self.encoding.duplicate(genome, genes_max, rng);
    }

    fn crossover(
        &self,
        a: &[E::Gene],
        b: &[E::Gene],
        variation: &Variation,
        rng: &mut Stream,
    ) -> Vec<E::Gene> {
        self.encoding.crossover(a, b, variation, rng)
    }

    fn mutate(&self, genome: &mut Vec<E::Gene>, variation: &Variation, rng: &mut Stream) {
        self.encoding.mutate(genome, variation, rng);
    }

    /// How many links its body has, of those that it may have, and how high it stands at rest, of [`HEIGHT_MAX_M`].
    fn features(&self, genome: &[E::Gene]) -> [f64; 2] {
        let expressed = catch_unwind(AssertUnwindSafe(|| self.express(genome)));
        let Some(creature) = expressed.ok().and_then(Result::ok) else { return [0.0; 2] };
        let links = creature.morphology.links.len() as f64 / self.encoding.links_max() as f64;
        [links.min(1.0), (creature.morphology.height_m() / HEIGHT_MAX_M).min(1.0)]
    }

    fn distance(&self, a: &[E::Gene], b: &[E::Gene]) -> f64 {
        self.encoding.distance(a, b)
    }

    fn evaluate(&self, genome: &[E::Gene]) -> Evaluation {
        self.estimate(genome, &Hurdles::NONE)
    }

    fn estimate(&self, genome: &[E::Gene], hurdles: &Hurdles) -> Evaluation {
        let tried = catch_unwind(AssertUnwindSafe(|| {
            self.score(&self.grow(genome)?, &self.trial(), hurdles)
        }));
        evaluation(tried.unwrap_or(Err(Outcome::Panicked)))
    }

    fn has_estimates(&self) -> bool {
        self.judged || self.robustness.is_wanted()
    }

    /// The mean of half of the usual fresh trials, in the fastest engine that can do them.
    fn validate(&self, genome: &[E::Gene]) -> Option<Fitness> {
        let Ok(creature) = self.express(genome) else { return Some(Fitness::WORST) };
        let trials = self.fresh_trials() / 2;
        let can_do = simulation::check(Engine::FASTEST, &self.trial()).is_ok();
        let engine = if can_do { Engine::FASTEST } else { self.engine };
        let found = self.validate_body(&creature, engine, trials);
        Some(Fitness::new(found.mean))
    }

    /// Links times steps, of trials that run to their end; what cannot be expressed costs nothing.
    fn cost(&self, genome: &[E::Gene]) -> u64 {
        // Whatever evaluating a genome contains must not come out here.
        let links = catch_unwind(AssertUnwindSafe(|| self.encoding.count_links(genome)));
        let links = links.ok().and_then(Result::ok).unwrap_or(0);
        links as u64 * self.steps()
    }
}

fn evaluation(result: Result<f64, Outcome>) -> Evaluation {
    result.map_or_else(Evaluation::failed, Evaluation::scored)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::creature::encodings::course::{PARAMETER_COUNT, VALUE_MAX};
    use crate::creature::{Gene, Profile};
    use crate::rng::{Purpose, Source};

    fn problem() -> Locomotion {
        Locomotion::single(Engine::Featherstone)
    }

    fn stream(index: u32) -> Stream {
        Source { seed: 11, island: 0 }.stream(0, index, Purpose::Mutation)
    }

    #[test]
    fn point_mutation_honours_its_rate_and_its_amount() {
        let variation = Variation { point_rate: 0.2, point_amount: 0.05, ..Variation::default() };
        let mut changed = 0.0;
        for index in 0..1_000 {
            let mut gene = Gene([0.5; PARAMETER_COUNT]);
            problem().mutate_gene(&mut gene, &variation, &mut stream(index));
            assert!(gene.0.iter().all(|value| (value - 0.5).abs() <= 0.05));
            changed += gene.0.iter().filter(|&&value| value != 0.5).count() as f64 / 17_000.0;
        }
        assert!((changed - 0.2_f64).abs() < 0.02, "{changed}");
    }

    #[test]
    fn a_genome_costs_its_links_times_the_steps() {
        for index in 0..39 {
            let (profile, task) = (Profile::ALL[index % 3], Task::ALL[index / 3 % 3]);
            let genes = 1 + index / 3;
            let encoding = Course { profile, genes, links_max: 7, ..Course::DEFAULT };
            let problem = Locomotion { encoding, task, ..problem() };
            let genome = problem.random_genome(&mut stream(index as u32));
            let links = problem.express(&genome).map_or(0, |it| it.morphology.links.len());
            let steps = task.trial_in(problem.engine).steps() as usize;
            assert_eq!(problem.cost(&genome), (links * steps) as u64);
        }
    }

    #[test]
    fn a_genome_that_is_refused_costs_nothing() {
        let mut gene = Gene([0.5; PARAMETER_COUNT]);
        // Its link is built twice on the one before it.
        (gene.0[3], gene.0[6]) = (0.4, VALUE_MAX);
        let encoding = Course { profile: Profile::Coursework, ..Course::DEFAULT };
        let coursework = Locomotion { encoding, ..problem() };
        let steps = u64::from(coursework.trial().steps());
        assert_eq!([8, 10].map(|genes| coursework.cost(&vec![gene; genes])), [255 * steps, 0]);
        assert_eq!(problem().cost(&[]), 0);
    }

    #[test]
    fn mutation_never_leaves_the_range() {
        let variation = Variation { point_rate: 1.0, point_amount: 1.0, ..Variation::default() };
        for (index, start) in [(0, 0.0), (1, VALUE_MAX), (2, 0.5)] {
            let mut gene = Gene([start; PARAMETER_COUNT]);
            for _ in 0..200 {
                problem().mutate_gene(&mut gene, &variation, &mut stream(index));
                assert!(evolution::Gene::is_valid(&gene), "{gene:?}");
            }
        }
    }

    #[test]
    fn distance_is_zero_for_equals_and_grows_with_values_and_length() {
        let (low, high) = ([Gene([0.0; 17])], [Gene([0.5; 17])]);
        assert_eq!(problem().distance(&low, &low), 0.0);
        assert_eq!(problem().distance(&low, &high), 0.5);
        assert_eq!(problem().distance(&low, &[low[0], low[0]]), 0.5);
    }
}
