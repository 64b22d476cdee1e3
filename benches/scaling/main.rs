//! How well cores are used, and how well 16 and 64 of them would be.
//!
//! What this machine can show is measured: `islands evaluate` over threads, and whole runs over islands and threads,
//! in turns, so that whatever else the machine does hits all of them; the median of the rounds counts. For more cores
//! than there are, [`trace`] measures on one thread what every single evaluation and every other part of a generation
//! takes, and [`model`] says how long islands and threads would take for them. The same model is set beside the
//! measured runs, so that everybody can see how far to trust it. The machine should have nothing else to do: the model
//! knows no competition.
//!
//! `cargo bench --bench scaling`

#![expect(clippy::print_stdout, reason = "the tables are what it is for")]
#![expect(clippy::disallowed_methods, reason = "a bench reads the clock")]

mod model;
#[path = "../program.rs"]
mod program;
mod tables;
mod trace;

use islands::evolution::Problem;
use islands::formats::genome_csv;
use islands::rng::{Purpose, Source};
use islands::runs::config::Config;
use std::collections::BTreeMap;
use std::fs::File;
use std::path::Path;
use trace::Trace;

const SEED: u64 = 7;
const THREADS: [usize; 3] = [1, 2, 4];
/// Islands, threads and lag of whole runs. No island has less than one thread.
const RUNS: [(u32, usize, u32); 7] =
    [(1, 1, 1), (1, 2, 1), (1, 4, 1), (2, 2, 1), (2, 4, 1), (4, 4, 1), (4, 4, 0)];

/// How much is measured.
struct Budget {
    rounds: usize,
    /// Genomes of `islands evaluate`, each evaluated twice.
    genomes: u32,
    /// How many of [`RUNS`].
    runs: usize,
    /// What they have in common.
    run: Config,
    /// What the projection is made from.
    projection: Config,
}

impl Budget {
    fn whole() -> Self {
        let projection = Config { seed: Some(SEED), generations: 6, ..Config::default() };
        let run =
            Config { population: 12, generations: 3, migration_interval: 1, ..projection.clone() };
        Self { rounds: 3, genomes: 24, runs: RUNS.len(), run, projection }
    }

    /// As criterion's benches have it: everything once, to see that it works.
    fn trial() -> Self {
        let Self { run, projection, .. } = Self::whole();
        let run = Config { population: 3, genes: 1, generations: 2, ..run };
        let projection =
            Config { islands: 2, population: 3, genes: 1, generations: 2, ..projection };
        Self { rounds: 1, genomes: 2, runs: 2, run, projection }
    }
}

fn main() {
    let is_trial = std::env::args().any(|argument| argument == "--test");
    let budget = if is_trial { Budget::trial() } else { Budget::whole() };
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let threads: Vec<usize> = THREADS.into_iter().filter(|&threads| threads <= cores).collect();
    let runs: Vec<_> =
        RUNS[..budget.runs].iter().copied().filter(|&(_, threads, _)| threads <= cores).collect();

    let folder = program::folder();
    let files = write_genomes(folder.path(), &budget);
    let mut speeds: Vec<Vec<f64>> = threads.iter().map(|_| Vec::new()).collect();
    let mut walls_s: Vec<Vec<f64>> = runs.iter().map(|_| Vec::new()).collect();
    for _ in 0..budget.rounds {
        for (speeds, &threads) in speeds.iter_mut().zip(&threads) {
            speeds.push(evaluate(&files, threads));
        }
        for (walls_s, &run) in walls_s.iter_mut().zip(&runs) {
            walls_s.push(wall_s(run, &budget));
        }
    }
    let mut traces: BTreeMap<(u32, u32), Trace> = BTreeMap::new();
    for &run @ (islands, _, lag) in &runs {
        let measure = || Trace::measure(config(run, &budget));
        traces.entry((islands, lag)).or_insert_with(measure);
    }
    tables::evaluate(&threads, &speeds);
    tables::runs(&runs, &walls_s, &traces);
    let trace = Trace::measure(budget.projection);
    tables::parts(&trace);
    tables::sharing(&trace);
    tables::projection(&trace);
}

/// The files of random genomes, as the first generation of a run has them.
fn write_genomes(folder: &Path, budget: &Budget) -> Vec<String> {
    let problem = budget.projection.locomotion();
    let source = Source { seed: SEED, island: 0 };
    let write = |index: u32| {
        let genome = problem.random_genome(&mut source.stream(0, index, Purpose::Genesis));
        let path = folder.join(format!("{index}.csv"));
        let file = File::create(&path).expect("the folder is writable");
        genome_csv::write(&genome, file).expect("the disk has room");
        path.to_str().expect("a temporary folder's name is text").to_owned()
    };
    (0..budget.genomes).map(write).collect()
}

/// Evaluations a second of `islands evaluate`.
fn evaluate(files: &[String], threads: usize) -> f64 {
    let mut arguments = vec!["evaluate".to_owned(), "--json".to_owned(), "--repeat=2".to_owned()];
    arguments.push(format!("--threads={threads}"));
    arguments.extend_from_slice(files);
    program::number(&program::json(&arguments), "evaluations_per_second")
}

fn config((islands, threads, migration_lag): (u32, usize, u32), budget: &Budget) -> Config {
    Config { islands, threads: Some(threads), migration_lag, ..budget.run.clone() }
}

/// How long a run's slowest island evolves, in seconds.
fn wall_s(run: (u32, usize, u32), budget: &Budget) -> f64 {
    let folder = program::folder();
    let path = folder.path().join("config.toml");
    std::fs::write(&path, config(run, budget).to_toml()).expect("the folder is writable");
    let summary = program::run(&[format!("--config={}", path.display())]);
    program::number(&summary, "wall_seconds")
}
