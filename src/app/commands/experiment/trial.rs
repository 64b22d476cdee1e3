//! One run of an experiment, in this process.

use crate::archipelago::{Digest, Island, Report, Step, lockstep};
use crate::evolution::population::mean_of_pairs;
use crate::evolution::{Fitness, Founders, Gene};
use crate::runs::catalogue::Visitor;
use crate::runs::config::Config;
use crate::runs::kept::Candidates;
use crate::runs::subject::Subject;
use crate::runs::summary::lowest_mean;
use serde::{Deserialize, Serialize};

/// A run that is ended by its evaluations ends as well after so many generations in which there was none: there will
/// be none.
const IDLE_MAX: u32 = 1_000;

/// What a run came to.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Trial {
    /// The digest of all final populations: that of `islands run` with as many generations.
    pub digest: String,
    /// The unit of fitness.
    pub unit: String,
    /// What the best champion is worth on fresh trials, in the engine that gives it less, where there are engines.
    pub validated: Option<f64>,
    /// The mean distance of two islands' champions, from 0 (all equal) to 1; none of a single island.
    pub apart: Option<f64>,
    /// Every generation, from 0.
    pub curve: Vec<Point>,
}

/// What a run was like after a generation, all islands together.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Point {
    /// The generation.
    pub generation: u32,
    /// Evaluations so far.
    pub evaluations: u64,
    /// The best fitness so far; none if nothing could be scored.
    pub best: Option<f64>,
    /// The mean of the islands' mean fitness; none if nothing could be scored.
    pub mean: Option<f64>,
    /// The mean of the islands' diversity, from 0 to 1.
    pub diversity: f64,
}

impl Trial {
    /// The last generation.
    pub fn end(&self) -> Point {
        *self.curve.last().expect("a run has a generation 0")
    }

    /// What it is compared by: what the best is worth on fresh trials, or where there are none its fitness; negative
    /// infinity if nothing could be scored.
    pub fn worth(&self) -> f64 {
        self.validated.or(self.end().best).unwrap_or(f64::NEG_INFINITY)
    }

    /// How many evaluations there had been after the first generation whose best was at least `target`.
    pub fn evaluations_to(&self, target: f64) -> Option<u64> {
        let reached = |point: &&Point| point.best.is_some_and(|best| best >= target);
        self.curve.iter().find(reached).map(|point| point.evaluations)
    }
}

/// Runs a configuration to its last generation, or to the first by which there were so many evaluations. None if it
/// was stopped, which is looked for after each generation.
pub fn run_one(
    config: &Config,
    evaluations: Option<u64>,
    is_stopped: impl Fn() -> bool,
) -> Option<Trial> {
    config.visit(Evolve { config, evaluations, is_stopped })
}

struct Evolve<'a, S> {
    config: &'a Config,
    evaluations: Option<u64>,
    is_stopped: S,
}

impl<S: Fn() -> bool> Visitor for Evolve<'_, S> {
    type Output = Option<Trial>;

    fn visit<P: Subject>(self, problem: P) -> Option<Trial> {
        evolve(&problem, self.config, self.evaluations, self.is_stopped)
    }
}

fn evolve<P: Subject>(
    problem: &P,
    config: &Config,
    evaluations: Option<u64>,
    is_stopped: impl Fn() -> bool,
) -> Option<Trial> {
    let mut record = Record::of(config.islands);
    let mut budget = Budget { evaluations, spent: 0, idle: 0 };
    let mut stopped = false;
    let islands = lockstep::run_until(
        problem,
        &Founders::NONE,
        &config.archipelago(),
        config.generations,
        |step| record.observe(step),
        |islands| {
            stopped = is_stopped();
            stopped || budget.is_spent(islands)
        },
    );
    let digest = Digest::of(&islands).to_string();
    let unit = problem.unit().to_owned();
    if stopped {
        return None;
    }
    let (_, best) = record.candidates.kept(problem)?;
    let validated = lowest_mean(&problem.fresh(&best.genome, None));
    let champions = islands.iter().map(|island| &island.champion);
    let genomes: Vec<&[P::Gene]> = champions.map(|champion| champion.genome.as_slice()).collect();
    let apart = mean_of_pairs(&genomes, |a, b| problem.distance(a, b));
    let apart = (genomes.len() > 1).then_some(apart);
    Some(Trial { digest, unit, validated, apart, curve: record.curve })
}

/// What a run may spend.
struct Budget {
    evaluations: Option<u64>,
    spent: u64,
    /// Generations since there was an evaluation.
    idle: u32,
}

impl Budget {
    fn is_spent<G>(&mut self, islands: &[Island<G>]) -> bool {
        let Some(evaluations) = self.evaluations else { return false };
        let spent = islands.iter().map(|island| island.effort.evaluations).sum();
        self.idle = if spent > self.spent { 0 } else { self.idle + 1 };
        self.spent = spent;
        spent >= evaluations || self.idle >= IDLE_MAX
    }
}

/// Turns what islands report into a curve.
struct Record<G> {
    islands: usize,
    /// Of all champions that each island has had so far.
    candidates: Candidates<G>,
    /// Of the islands that have done the present generation.
    reports: Vec<Report>,
    evaluations: u64,
    best: Fitness,
    curve: Vec<Point>,
}

impl<G: Gene> Record<G> {
    fn of(islands: u32) -> Self {
        Self {
            islands: islands as usize,
            candidates: Candidates::none(),
            reports: Vec::new(),
            evaluations: 0,
            best: Fitness::WORST,
            curve: Vec::new(),
        }
    }

    fn observe(&mut self, step: &Step<G>) {
        if let Some(champion) = step.champion.as_ref() {
            self.candidates.see(step.report.island, &champion.individual);
        }
        self.best = self.best.max(step.island.champion.fitness);
        self.evaluations += step.report.effort.evaluations;
        self.reports.push(step.report);
        if self.reports.len() == self.islands {
            self.close(step.report.generation);
        }
    }

    fn close(&mut self, generation: u32) {
        let statistics = self.reports.iter().map(|report| report.statistics);
        let means: Vec<f64> = statistics.clone().filter_map(|it| it.mean.finite()).collect();
        let mean = (!means.is_empty()).then(|| means.iter().sum::<f64>() / means.len() as f64);
        let diversity = statistics.map(|it| it.diversity).sum::<f64>() / self.islands as f64;
        let (evaluations, best) = (self.evaluations, self.best.finite());
        self.curve.push(Point { generation, evaluations, best, mean, diversity });
        self.reports.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulation::Engine;

    fn config() -> Config {
        Config {
            islands: 2,
            population: 4,
            genes: 1,
            elites: 1,
            point_rate: 0.5,
            generations: 3,
            seed: Some(3),
            engine: Engine::Featherstone,
            ..Config::default()
        }
    }

    #[test]
    fn a_run_ends_with_the_first_generation_that_reaches_its_budget() {
        let whole = run_one(&config(), None, || false).expect("nobody stops it");
        assert_eq!(
            whole.curve.iter().map(|point| point.generation).collect::<Vec<_>>(),
            [0, 1, 2, 3]
        );
        assert_eq!(whole.curve[0].evaluations, 8);
        let budget = whole.curve[1].evaluations;
        assert!(budget > 9);
        for (evaluations, generation) in [(1, 0), (budget - 1, 1), (budget, 1), (budget + 1, 2)] {
            let cut = run_one(&config(), Some(evaluations), || false).expect("nobody stops it");
            assert_eq!(cut.curve, whole.curve[..=generation], "{evaluations}");
        }
        let same = run_one(&config(), Some(1_000_000), || false).expect("nobody stops it");
        assert_eq!(same, whole);
    }

    #[test]
    fn a_run_that_has_nothing_to_evaluate_any_more_ends() {
        let config = Config {
            generations: 1_000_000,
            crossover_rate: 0.0,
            point_rate: 0.0,
            shrink_rate: 0.0,
            grow_rate: 0.0,
            ..config()
        };
        let trial = run_one(&config, Some(100), || false).expect("nobody stops it");
        assert_eq!(trial.end().evaluations, 8);
        assert_eq!(trial.end().generation, IDLE_MAX);
    }

    #[test]
    fn a_run_that_is_stopped_comes_to_nothing() {
        assert_eq!(run_one(&config(), None, || true), None);
    }

    #[test]
    fn the_best_only_rises_and_a_target_is_reached_with_the_first_generation_as_good() {
        let config = Config { elites: 0, generations: 16, ..config() };
        let trial = run_one(&config, None, || false).expect("nobody stops it");
        assert!(trial.curve.is_sorted_by_key(|point| point.best));
        assert!(!trial.curve.is_sorted_by_key(|point| point.mean), "there is worse, too");
        assert!(trial.curve.iter().all(|point| point.best > point.mean));
        let second = trial.curve[1];
        let reached = trial.evaluations_to(second.best.expect("something was scored"));
        let first = trial.curve.iter().find(|point| point.best == second.best);
        assert_eq!(reached, first.map(|point| point.evaluations));
        assert_eq!(trial.evaluations_to(1e9), None);
    }
}
