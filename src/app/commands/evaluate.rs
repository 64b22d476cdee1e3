//! `islands evaluate`: scores genomes and bodies.

use crate::app::args::cli::EvaluateArgs;
use crate::app::args::terrain_args;
use crate::app::console::{Stopwatch, print};
use crate::app::genomes::Specimen;
use crate::creature::Encoding;
use crate::evolution::{Evaluation, Problem};
use crate::problems::{Locomotion, Validation};
use crate::runs::catalogue::Visitor;
use crate::runs::config::{Config, THREADS_MAX};
use crate::runs::kind::Kind;
use crate::runs::subject::Subject;
use crate::runs::{Failure, genome_files};
use crate::work_queue::dearest_first;
use serde::Serialize;
use std::path::PathBuf;

/// The most that everything is evaluated.
const REPEAT_MAX: usize = 1_000_000;
/// The most fresh trials.
const TRIALS_MAX: u32 = 100_000;

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
    /// What it gets on trials that nobody is selected on, if that was asked for.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    validation: Vec<Validation>,
}

/// Scores the genomes and bodies in the files that are named.
///
/// # Errors
/// If one cannot be read.
pub fn run(args: &EvaluateArgs) -> Result<(), Failure> {
    if !(1..=TRIALS_MAX).contains(&args.trials.unwrap_or(1)) {
        return Err(Failure::usage(format!("--trials must be from 1 to {TRIALS_MAX}")));
    }
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
    let read = |path: &PathBuf| Specimen::read(path, &problem.encoding, &args.changes);
    let specimens: Vec<_> = args.genomes.iter().map(read).collect::<Result<_, _>>()?;
    let fresh = |specimen: &Specimen<_>, trials| match specimen {
        Specimen::Genome(genome) => problem.fresh(genome, Some(trials)),
        Specimen::Body(body) => problem.validate_in_each(&body.creature, trials),
    };
    judge(args, &config, &problem, &specimens, |batch| try_out(&problem, batch), fresh)
}

/// Scores creatures, the dearest first.
fn try_out<E: Encoding>(
    problem: &Locomotion<E>,
    specimens: &[&Specimen<E::Gene>],
) -> Vec<Evaluation> {
    let cost = |specimen: &&Specimen<E::Gene>| match specimen {
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
            genome_files::read_for(&problem, path, &[]).map_err(|reason| {
                Failure::usage(format!("cannot use {}: {reason}", path.display()))
            })
        };
        let genomes: Vec<Vec<_>> = self.args.genomes.iter().map(read).collect::<Result<_, _>>()?;
        if self.args.trials.is_some() {
            return Err(Failure::usage(format!(
                "--trials means nothing to {}",
                self.config.problem
            )));
        }
        let evaluate = |batch: &[&Vec<_>]| {
            let batch: Vec<_> = batch.iter().map(|genome| genome.as_slice()).collect();
            problem.evaluate_batch(&batch)
        };
        judge(self.args, self.config, &problem, &genomes, evaluate, |_, _| Vec::new())
    }
}

fn judge<P: Subject, T: Sync>(
    args: &EvaluateArgs,
    config: &Config,
    problem: &P,
    specimens: &[T],
    evaluate: impl Fn(&[&T]) -> Vec<Evaluation> + Sync + Send,
    fresh: impl Fn(&T, u32) -> Vec<Validation> + Sync + Send,
) -> Result<(), Failure> {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(args.threads.unwrap_or(0))
        .build()
        .map_err(|error| Failure::failed(format!("cannot start threads: {error}")))?;
    let batch: Vec<&T> = std::iter::repeat_n(specimens, args.repeat).flatten().collect();

    let watch = Stopwatch::start();
    let evaluations = pool.install(|| evaluate(&batch));
    let wall_seconds = watch.seconds();
    let trials = args.trials.unwrap_or(0);
    let validations: Vec<Vec<Validation>> = match trials {
        0 => vec![Vec::new(); specimens.len()],
        _ => pool.install(|| specimens.iter().map(|specimen| fresh(specimen, trials)).collect()),
    };

    let a_second = |count: f64| count / wall_seconds.max(1e-9);
    let is_walker = config.problem == Kind::Creatures;
    let whole = evaluations.iter().filter(|e| e.fitness.finite().is_some()).count();
    let steps = whole as f64 * config.locomotion().steps() as f64;
    let scores = Scores {
        problem: config.problem,
        task: is_walker.then(|| config.task.to_string()),
        profile: is_walker.then(|| config.profile.to_string()),
        genomes: args.genomes.iter().zip(&evaluations).zip(&validations).map(score).collect(),
        evaluations: evaluations.len(),
        threads: pool.current_num_threads(),
        wall_seconds,
        evaluations_per_second: a_second(evaluations.len() as f64),
        steps_per_second: is_walker.then(|| a_second(steps)),
    };
    for ((path, evaluation), validation) in args.genomes.iter().zip(&evaluations).zip(&validations)
    {
        let Evaluation { fitness, outcome } = *evaluation;
        print(&format!("{:>12}  {outcome:<10}  {}", problem.show(fitness), path.display()));
        for one in validation {
            print(&format!("{:>14}{}", "", one.in_words(problem.unit())));
        }
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
        let usual = Config::default_for(self.settings.wish());
        let scales = self.changes.scales();
        let mut config = self.settings.over(Config { scales, ..usual });
        terrain_args::find(&mut config, &self.terrain, None)?;
        config.check()?;
        Ok(config)
    }
}

fn score(((path, evaluation), validation): ((&PathBuf, &Evaluation), &Vec<Validation>)) -> Score {
    Score {
        genome: path.clone(),
        fitness: evaluation.fitness.saturated(),
        outcome: evaluation.outcome.to_string(),
        validation: validation.clone(),
    }
}
