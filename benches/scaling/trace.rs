//! What every part of some generations takes, measured on one thread.

use crate::program;
use islands::app::config::Config;
use islands::archipelago::{Archipelago, Step, lockstep};
use islands::creature::Gene;
use islands::evolution::{Evaluation, Problem};
use islands::problems::Locomotion;
use islands::rng::Stream;
use islands::store::{Logbook, RunDir};
use std::sync::Mutex;
use std::time::Instant;

/// An evaluation.
#[derive(Clone, Copy)]
pub struct Job {
    /// What the problem estimates that it costs, in its own unit.
    pub estimate: u64,
    /// What it took.
    pub seconds: f64,
}

/// A generation of an island.
pub struct Generation {
    /// Its evaluations, in the order in which they are asked for.
    pub jobs: Vec<Job>,
    /// The other phases: to immigrate, select, vary, survive, emigrate, and describe the population.
    pub phases_s: f64,
    /// To record it in the logs, journal what it sends, and save a checkpoint, all of it durable.
    pub files_s: f64,
}

impl Generation {
    /// What cannot be shared out among threads.
    pub fn serial_s(&self) -> f64 {
        self.phases_s + self.files_s
    }

    /// What its evaluations take one after the other.
    pub fn work_s(&self) -> f64 {
        self.jobs.iter().map(|job| job.seconds).sum()
    }
}

/// What the generations of an archipelago take.
pub struct Trace {
    /// Whose.
    pub archipelago: Archipelago,
    /// Its generations after the first one.
    pub generations: u32,
    /// The generations of each island, from generation 0.
    pub islands: Vec<Vec<Generation>>,
}

impl Trace {
    /// Evolves an archipelago on one thread, with the files of a run, and a clock in hand.
    pub fn measure(config: Config) -> Self {
        let archipelago = config.archipelago();
        let folder = program::folder();
        let dir = RunDir::at(folder.path().join("run"));
        // The folder is a run's for as long as it is claimed.
        let claim = dir.create().expect("the folder is writable");
        claim.make_folders(config.islands).expect("the folder is writable");
        let mut logbooks = logbooks(&config, &dir);
        let problem = Timed { problem: config.problem(), jobs: Mutex::default() };
        let mut islands: Vec<Vec<Generation>> = logbooks.iter().map(|_| Vec::new()).collect();
        let mut began = Instant::now();
        lockstep::run(&problem, &archipelago, config.generations, |step| {
            let step_s = began.elapsed().as_secs_f64();
            let jobs = problem.take_jobs();
            let index = step.island.index as usize;
            let files_s = write(&mut logbooks[index], step);
            let mut generation = Generation { jobs, phases_s: 0.0, files_s };
            generation.phases_s = step_s - generation.work_s();
            islands[index].push(generation);
            began = Instant::now();
        });
        drop(claim);
        Self { archipelago, generations: config.generations, islands }
    }

    /// All that was measured.
    pub fn all(&self) -> impl Iterator<Item = &Generation> + Clone {
        self.islands.iter().flatten()
    }
}

fn logbooks(config: &Config, dir: &RunDir) -> Vec<Logbook<Gene>> {
    let (archipelago, settings) = (config.archipelago(), config.settings());
    let open = |island| Logbook::open(dir, &archipelago, island, &settings);
    (0..config.islands).map(|island| open(island).expect("they are new").logbook).collect()
}

/// Does with a generation what an island's process does, and returns what that takes, in seconds.
fn write(logbook: &mut Logbook<Gene>, step: &Step<Gene>) -> f64 {
    let began = Instant::now();
    logbook.record(step, 0.0).expect("the disk has room");
    logbook.save(&step.island).expect("the disk has room");
    began.elapsed().as_secs_f64()
}

/// Locomotion, one evaluation after the other.
struct Timed {
    problem: Locomotion,
    jobs: Mutex<Vec<Job>>,
}

impl Timed {
    fn take_jobs(&self) -> Vec<Job> {
        std::mem::take(&mut *self.jobs.lock().expect("there is one thread"))
    }
}

impl Problem for Timed {
    type Gene = Gene;

    fn random_gene(&self, rng: &mut Stream) -> Gene {
        self.problem.random_gene(rng)
    }

    fn random_genome(&self, rng: &mut Stream) -> Vec<Gene> {
        self.problem.random_genome(rng)
    }

    fn mutate_gene(&self, gene: &mut Gene, rate: f64, amount: f64, rng: &mut Stream) {
        self.problem.mutate_gene(gene, rate, amount, rng);
    }

    fn distance(&self, a: &[Gene], b: &[Gene]) -> f64 {
        self.problem.distance(a, b)
    }

    fn evaluate(&self, genome: &[Gene]) -> Evaluation {
        let began = Instant::now();
        let evaluation = self.problem.evaluate(genome);
        let seconds = began.elapsed().as_secs_f64();
        let job = Job { estimate: self.problem.cost(genome), seconds };
        self.jobs.lock().expect("there is one thread").push(job);
        evaluation
    }

    fn evaluate_batch(&self, genomes: &[&[Gene]]) -> Vec<Evaluation> {
        genomes.iter().map(|genome| self.evaluate(genome)).collect()
    }
}
