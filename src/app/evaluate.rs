//! `islands evaluate`: scores genomes and bodies.

use super::catalogue::{Kind, Visitor};
use super::cli::{EvaluateArgs, TrialArgs};
use super::config::{Config, THREADS_MAX};
use super::console::{Stopwatch, print};
use super::genomes::Specimen;
use super::subject::Subject;
use super::{Failure, genomes, terrains};
use crate::evolution::sharing::dearest_first;
use crate::evolution::{Evaluation, Problem};
use crate::problems::Locomotion;
use serde::Serialize;
use std::path::PathBuf;

/// The most that everything is evaluated.
const REPEAT_MAX: usize = 1_000_000;

#[derive(Serialize)]
struct Scores {
    problem: Kind,
    #[serde(skip_serializing_if = "Option::is_none")]
    task: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    profile: Option<String>,
    genomes: Vec<Score>,
    evaluations: usize,
    threads: usize,
    wall_seconds: f64,
    evaluations_per_second: f64,
    /// Simulation steps of trials that ran to their end; of settling, which lasts as long as it takes, one round.
    #[serde(skip_serializing_if = "Option::is_none")]
    steps_per_second: Option<f64>,
}

#[derive(Serialize)]
struct Score {
    genome: PathBuf,
    fitness: f64,
    outcome: String,
}

/// Scores the genomes and bodies in the files that are named.
///
/// # Errors
/// If one cannot be read.
pub fn run(args: &EvaluateArgs) -> Result<(), Failure> {
    let threads_fit = (1..=THREADS_MAX).contains(&args.threads.unwrap_or(1));
    if !threads_fit || !(1..=REPEAT_MAX).contains(&args.repeat) {
        return Err(Failure::usage(format!(
            "--threads and --repeat must be at least 1, and at most {THREADS_MAX} and {REPEAT_MAX}"
        )));
    }
    let config = args.config()?;
    if config.problem != Kind::Creatures {
        return config.visit(Examiner { args, config: &config });
    }
    let problem = config.locomotion();
    let read = |path: &PathBuf| Specimen::read(path, &args.trial.read.changes);
    let specimens: Vec<_> = args.genomes.iter().map(read).collect::<Result<_, _>>()?;
    judge(args, &config, &problem, &specimens, |batch| try_out(&problem, batch))
}

/// Scores creatures, the dearest first.
fn try_out(problem: &Locomotion, specimens: &[&Specimen]) -> Vec<Evaluation> {
    let cost = |specimen: &&Specimen| match specimen {
        Specimen::Genome(genome) => problem.cost(genome),
        Specimen::Body(body) => body.link_names.len() as u64 * problem.steps(),
    };
    let costs: Vec<u64> = specimens.iter().map(cost).collect();
    dearest_first(&costs, |index| match specimens[index] {
        Specimen::Genome(genome) => problem.evaluate(genome),
        Specimen::Body(body) => problem.evaluate_body(&body.creature),
    })
}

/// Scores what has no body.
struct Examiner<'a> {
    args: &'a EvaluateArgs,
    config: &'a Config,
}

impl Visitor for Examiner<'_> {
    type Output = Result<(), Failure>;

    fn visit<P: Subject>(self, problem: P) -> Result<(), Failure> {
        let read = |path: &PathBuf| {
            genomes::read_for(&problem, path, &[]).map_err(|reason| {
                Failure::usage(format!("cannot use {}: {reason}", path.display()))
            })
        };
        let genomes: Vec<Vec<_>> = self.args.genomes.iter().map(read).collect::<Result<_, _>>()?;
        judge(self.args, self.config, &problem, &genomes, |batch| {
            let batch: Vec<_> = batch.iter().map(|genome| genome.as_slice()).collect();
            problem.evaluate_batch(&batch)
        })
    }
}

fn judge<P: Subject, T: Sync>(
    args: &EvaluateArgs,
    config: &Config,
    problem: &P,
    specimens: &[T],
    evaluate: impl Fn(&[&T]) -> Vec<Evaluation> + Sync,
) -> Result<(), Failure> {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(args.threads.unwrap_or(0))
        .build()
        .map_err(|error| Failure::failed(format!("cannot start threads: {error}")))?;
    let batch: Vec<&T> = std::iter::repeat_n(specimens, args.repeat).flatten().collect();

    let watch = Stopwatch::start();
    let evaluations = pool.install(|| evaluate(&batch));
    let wall_seconds = watch.seconds();

    let a_second = |count: f64| count / wall_seconds.max(1e-9);
    let is_walker = config.problem == Kind::Creatures;
    let whole = evaluations.iter().filter(|e| e.fitness.finite().is_some()).count();
    let steps = whole as f64 * config.locomotion().steps() as f64;
    let scores = Scores {
        problem: config.problem,
        task: is_walker.then(|| args.trial.task.to_string()),
        profile: is_walker.then(|| args.trial.read.profile.to_string()),
        genomes: args.genomes.iter().zip(&evaluations).map(score).collect(),
        evaluations: evaluations.len(),
        threads: pool.current_num_threads(),
        wall_seconds,
        evaluations_per_second: a_second(evaluations.len() as f64),
        steps_per_second: is_walker.then(|| a_second(steps)),
    };
    for (path, evaluation) in args.genomes.iter().zip(&evaluations) {
        let Evaluation { fitness, outcome } = *evaluation;
        print(&format!("{:>12}  {outcome:<10}  {}", problem.show(fitness), path.display()));
    }
    if args.json {
        print(
            &serde_json::to_string(&scores).expect("scores are plain data, their numbers finite"),
        );
    } else if args.repeat > 1 {
        print(&format!("{:.1} evaluations a second", scores.evaluations_per_second));
    }
    Ok(())
}

impl EvaluateArgs {
    /// The configuration of a run whose genomes these may be.
    fn config(&self) -> Result<Config, Failure> {
        let TrialArgs { task, read, engine, robustness, robust_by, max_links, terrain } =
            &self.trial;
        let usual = Config::default_for(self.problem.wish());
        let mut config = Config {
            task: *task,
            profile: read.profile,
            scales: read.changes.scales(),
            engine: *engine,
            robustness: *robustness,
            robust_by: *robust_by,
            max_links: *max_links,
            ..self.problem.over(usual)
        };
        terrains::find(&mut config, terrain, None)?;
        config.check()?;
        Ok(config)
    }
}

fn score((path, evaluation): (&PathBuf, &Evaluation)) -> Score {
    Score {
        genome: path.clone(),
        fitness: evaluation.fitness.saturated(),
        outcome: evaluation.outcome.to_string(),
    }
}
