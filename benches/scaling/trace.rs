//! What every part of some generations takes, measured on one thread: what is computed in processor time, so that
//! others who use the machine count less, and what waits for the disk by the clock.

use crate::program;
use islands::archipelago::{Archipelago, Step, lockstep};
use islands::creature::Gene;
use islands::evolution::{Evaluation, Hurdles, Problem};
use islands::problems::Locomotion;
use islands::rng::Stream;
use islands::runs::config::Config;
use islands::store::{Logbook, RunDir};
use std::sync::{LazyLock, Mutex};
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
        let problem = Timed { problem: config.locomotion(), batch: Mutex::default() };
        let mut islands: Vec<Vec<Generation>> = logbooks.iter().map(|_| Vec::new()).collect();
        let mut began_s = processor_s();
        lockstep::run(&problem, &archipelago, config.generations, |step| {
            let step_s = processor_s() - began_s;
            let Batch { jobs, whole_s } = problem.take_batch();
            let index = step.island.index as usize;
            let files_s = write(&mut logbooks[index], step);
            islands[index].push(Generation { jobs, phases_s: step_s - whole_s, files_s });
            began_s = processor_s();
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

/// What this thread has used of a processor, to some hundredths of a millisecond; by the clock where the kernel does
/// not tell.
fn processor_s() -> f64 {
    static BEGAN: LazyLock<Instant> = LazyLock::new(Instant::now);
    // The kernel brings its books up to date when a thread offers its place to others.
    std::thread::yield_now();
    let statistics = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let used_ns = statistics.and_then(|text| text.split_whitespace().next()?.parse::<f64>().ok());
    used_ns.map_or_else(|| BEGAN.elapsed().as_secs_f64(), |ns| ns / 1e9)
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
    batch: Mutex<Batch>,
}

/// What was evaluated since it was last asked for.
#[derive(Default)]
struct Batch {
    jobs: Vec<Job>,
    /// What it all took, the taking of time included.
    whole_s: f64,
}

impl Timed {
    fn take_batch(&self) -> Batch {
        std::mem::take(&mut *self.batch.lock().expect("there is one thread"))
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

    fn distance(&self, a: &[Gene], b: &[Gene]) -> f64 {
        self.problem.distance(a, b)
    }

    fn evaluate(&self, genome: &[Gene]) -> Evaluation {
        self.estimate(genome, &Hurdles::NONE)
    }

    fn estimate(&self, genome: &[Gene], hurdles: &Hurdles) -> Evaluation {
        let began_s = processor_s();
        let evaluation = self.problem.estimate(genome, hurdles);
        let seconds = processor_s() - began_s;
        let job = Job { estimate: self.problem.cost(genome), seconds };
        self.batch.lock().expect("there is one thread").jobs.push(job);
        evaluation
    }

    fn estimate_batch(&self, genomes: &[&[Gene]], hurdles: &Hurdles) -> Vec<Evaluation> {
        let began_s = processor_s();
        let evaluations = genomes.iter().map(|genome| self.estimate(genome, hurdles)).collect();
        let whole_s = processor_s() - began_s;
        self.batch.lock().expect("there is one thread").whole_s += whole_s;
        evaluations
    }
}
