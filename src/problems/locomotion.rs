//! Creatures that move: a genome is worth how far its body gets.

use super::robustness::{RobustBy, Robustness};
use super::tasks::Task;
use crate::creature::gene::PARAMETER_COUNT;
use crate::creature::{self, Creature, ExpressionError, Gene, Profile, Reading, Scales, genome};
use crate::evolution::{self, Evaluation, Fitness, Hurdles, Outcome, Problem};
use crate::rng::Stream;
use crate::simulation::{self, Engine, Terrain, Trajectory, Trial};
use rand::RngExt;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// The height of a body from which on bodies count as equally high, in metres.
pub const HEIGHT_MAX_M: f64 = 3.0;

/// The problem of locomotion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Locomotion {
    /// How genes are read.
    pub profile: Profile,
    /// Scales of profile `coursework` that were changed.
    pub scales: Scales,
    /// What the bodies have to do.
    pub task: Task,
    /// Genes of a random genome, at least 1.
    pub genes: usize,
    /// The most links of a body, for profiles that cut.
    pub links_max: usize,
    /// What moves the bodies.
    pub engine: Engine,
    /// How often they are tried.
    pub robustness: Robustness,
    /// Whether who gets over all hurdles is judged by the other engine, too, whose score counts if it does not confirm
    /// the own one.
    pub judged: bool,
    /// What they stand on, if it is another ground than the task's.
    pub terrain: Option<&'static Terrain>,
}

impl Default for Locomotion {
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl Locomotion {
    /// What a run solves if nothing else is said.
    pub const DEFAULT: Self = Self {
        profile: Profile::Native,
        scales: Scales::NONE,
        task: Task::Walk,
        genes: 4,
        links_max: 16,
        engine: Engine::Featherstone,
        robustness: Robustness { trials: 8, by: RobustBy::Quartile },
        judged: false,
        terrain: None,
    };

    /// One trial as it is in an engine, which nobody judges.
    pub const fn single(engine: Engine) -> Self {
        Self { engine, robustness: Robustness::NONE, ..Self::DEFAULT }
    }

    /// How bodies are tried.
    pub fn trial(&self) -> Trial {
        let trial = self.task.trial_in(self.engine);
        self.terrain.map_or(trial, |terrain| trial.on(terrain))
    }

    /// How genes are read.
    pub fn reading(&self) -> Reading {
        Reading { profile: self.profile, scales: self.scales }
    }

    /// Expresses a genome.
    ///
    /// # Errors
    /// If it is empty or describes more than the profile builds.
    pub fn express(&self, genome: &[Gene]) -> Result<Creature, ExpressionError> {
        creature::express(genome, self.reading(), self.links_max)
    }

    /// Evaluates a genome and films it; the evaluation is the one that [`Problem::evaluate`] gives. The film is of that
    /// of its trials whose score is nearest to what all of them come to.
    ///
    /// # Errors
    /// If the genome cannot be expressed.
    pub fn film(&self, genome: &[Gene]) -> Result<(Evaluation, Trajectory), ExpressionError> {
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

    /// The body that is scored for a genome.
    fn grow(&self, genome: &[Gene]) -> Result<Creature, Outcome> {
        let mut values = genome.iter().flat_map(|gene| gene.0);
        if !values.all(f64::is_finite) {
            return Err(Outcome::NotFinite);
        }
        if !genome.iter().all(evolution::Gene::is_valid) {
            return Err(Outcome::TooLarge);
        }
        self.express(genome).map_err(|_| Outcome::TooLarge)
    }
}

impl evolution::Gene for Gene {
    const WIRE_NAME: &'static str = "islands.creature.gene.v1";

    fn is_valid(&self) -> bool {
        self.0.iter().all(|value| (0.0..1.0).contains(value))
    }

    fn values(&self) -> &[f64] {
        &self.0
    }

    fn values_mut(&mut self) -> &mut [f64] {
        &mut self.0
    }
}

impl Problem for Locomotion {
    type Gene = Gene;

    fn random_gene(&self, rng: &mut Stream) -> Gene {
        Gene(std::array::from_fn(|_| rng.random()))
    }

    fn random_genome(&self, rng: &mut Stream) -> Vec<Gene> {
        (0..self.genes).map(|_| self.random_gene(rng)).collect()
    }

    /// Appends a copy of a limb, with all that it carries, to whom the limb is on: a new gene for each of the old ones,
    /// as they are but for who their parents are.
    fn duplicate(&self, genome: &mut Vec<Gene>, genes_max: usize, rng: &mut Stream) {
        if genome.len() > 1 {
            let limb = rng.random_range(1..genome.len());
            genome::duplicate(genome, limb, genes_max);
        }
    }

    /// How many links its body has, of those that it may have, and how high it stands at rest, of [`HEIGHT_MAX_M`].
    fn features(&self, genome: &[Gene]) -> [f64; 2] {
        let expressed = catch_unwind(AssertUnwindSafe(|| self.express(genome)));
        let Some(creature) = expressed.ok().and_then(Result::ok) else { return [0.0; 2] };
        let links = creature.morphology.links.len() as f64 / self.links_max.max(1) as f64;
        [links.min(1.0), (creature.morphology.height_m() / HEIGHT_MAX_M).min(1.0)]
    }

    fn feature_names(&self) -> [&'static str; 2] {
        ["links", "height"]
    }

    /// The mean absolute difference of the values of genes in the same place; a gene that only one of them has
    /// counts as wholly different.
    fn distance(&self, a: &[Gene], b: &[Gene]) -> f64 {
        let shared: f64 = a.iter().zip(b).map(|(a, b)| gene_distance(a, b)).sum();
        let longer = a.len().max(b.len());
        if longer == 0 {
            return 0.0;
        }
        (shared + a.len().abs_diff(b.len()) as f64) / longer as f64
    }

    fn evaluate(&self, genome: &[Gene]) -> Evaluation {
        self.estimate(genome, &Hurdles::NONE)
    }

    fn estimate(&self, genome: &[Gene], hurdles: &Hurdles) -> Evaluation {
        let tried = catch_unwind(AssertUnwindSafe(|| {
            self.score(&self.grow(genome)?, &self.trial(), hurdles)
        }));
        evaluation(tried.unwrap_or(Err(Outcome::Panicked)))
    }

    fn has_estimates(&self) -> bool {
        self.judged || self.robustness.is_wanted()
    }

    fn possible_scores(&self, genome: &[Gene]) -> Vec<Fitness> {
        let possible = || self.grow(genome).map(|creature| self.possible(&creature));
        let tried = catch_unwind(AssertUnwindSafe(possible));
        tried.ok().and_then(Result::ok).unwrap_or_else(|| vec![Fitness::WORST])
    }

    /// The mean of half of the usual fresh trials, in our own engine, which takes a tenth of rapier's time.
    fn validate(&self, genome: &[Gene]) -> Option<Fitness> {
        let Ok(creature) = self.express(genome) else { return Some(Fitness::WORST) };
        let trials = self.fresh_trials() / 2;
        let found = self.validate_body(&creature, Engine::Featherstone, trials);
        Some(Fitness::new(found.mean))
    }

    /// Links times steps, of trials that run to their end; what cannot be expressed costs nothing.
    fn cost(&self, genome: &[Gene]) -> u64 {
        // Whatever evaluating a genome contains must not come out here.
        let links = catch_unwind(|| creature::count_links(genome, self.reading(), self.links_max));
        let links = links.ok().and_then(Result::ok).unwrap_or(0);
        links as u64 * self.steps()
    }

    fn unit(&self) -> &'static str {
        self.task.unit()
    }
}

fn evaluation(result: Result<f64, Outcome>) -> Evaluation {
    result.map_or_else(Evaluation::failed, Evaluation::scored)
}

fn gene_distance(a: &Gene, b: &Gene) -> f64 {
    a.0.iter().zip(&b.0).map(|(a, b)| (a - b).abs()).sum::<f64>() / PARAMETER_COUNT as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::creature::gene::VALUE_MAX;
    use crate::evolution::Variation;
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
            let problem = Locomotion { profile, task, genes, links_max: 7, ..problem() };
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
        let coursework = Locomotion { profile: Profile::Coursework, ..problem() };
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
