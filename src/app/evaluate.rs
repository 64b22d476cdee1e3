//! `islands evaluate`: scores genomes.

use super::cli::EvaluateArgs;
use super::config::THREADS_MAX;
use super::console::{Stopwatch, print};
use super::{Failure, genomes};
use crate::creature::Gene;
use crate::evolution::{Evaluation, Problem};
use serde::Serialize;
use std::path::PathBuf;

/// The most that everything is evaluated.
const REPEAT_MAX: usize = 1_000_000;

#[derive(Serialize)]
struct Scores {
    task: String,
    profile: String,
    genomes: Vec<Score>,
    evaluations: usize,
    threads: usize,
    wall_seconds: f64,
    evaluations_per_second: f64,
    /// Simulation steps of trials that ran to their end; of settling, which lasts as long as it takes, one round.
    steps_per_second: f64,
}

#[derive(Serialize)]
struct Score {
    genome: PathBuf,
    fitness: f64,
    outcome: String,
}

/// Scores the genomes in the files that are named.
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
    let problem = args.trial.problem()?;
    let read = |path: &PathBuf| genomes::read(path, &args.trial.read.changes);
    let genomes: Vec<Vec<Gene>> = args.genomes.iter().map(read).collect::<Result<_, _>>()?;
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(args.threads.unwrap_or(0))
        .build()
        .map_err(|error| Failure::failed(format!("cannot start threads: {error}")))?;
    let batch: Vec<&[Gene]> =
        std::iter::repeat_n(&genomes, args.repeat).flatten().map(Vec::as_slice).collect();

    let watch = Stopwatch::start();
    let evaluations = pool.install(|| problem.evaluate_batch(&batch));
    let wall_seconds = watch.seconds();

    let whole = evaluations.iter().filter(|e| e.fitness.finite().is_some()).count();
    let steps = whole as f64 * problem.steps() as f64;
    let scores = Scores {
        task: args.trial.task.to_string(),
        profile: args.trial.read.profile.to_string(),
        genomes: args.genomes.iter().zip(&evaluations).map(score).collect(),
        evaluations: evaluations.len(),
        threads: pool.current_num_threads(),
        wall_seconds,
        evaluations_per_second: evaluations.len() as f64 / wall_seconds.max(1e-9),
        steps_per_second: steps / wall_seconds.max(1e-9),
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

fn score((path, evaluation): (&PathBuf, &Evaluation)) -> Score {
    Score {
        genome: path.clone(),
        fitness: evaluation.fitness.saturated(),
        outcome: evaluation.outcome.to_string(),
    }
}
