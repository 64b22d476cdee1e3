//! Many runs at a time, each on a thread of its own.

use super::trial::{Trial, run_one};
use crate::app::console::Stopwatch;
use crate::app::processes::parent_link::StopSignal;
use crate::runs::Failure;
use crate::runs::config::Config;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{Sender, channel};

/// A run that has to be done.
#[derive(Debug, Clone, PartialEq)]
pub struct Job {
    /// Which setting it is of.
    pub setting: usize,
    /// Its seed.
    pub seed: u64,
    /// All of it.
    pub config: Config,
}

/// Does all runs that are not stopped by `stop`, so many at a time, and hands each to `receive` as it finishes, with the
/// seconds that it took.
///
/// # Errors
/// What `receive` says, which ends all; or if there can be no threads.
pub fn work_off(
    jobs: &[Job],
    evaluations: Option<u64>,
    threads: usize,
    stop: &StopSignal,
    mut receive: impl FnMut(&Job, Trial, f64) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let (halted, begun) = (AtomicBool::new(false), AtomicUsize::new(0));
    let workers = Workers { jobs, evaluations, stop, halted: &halted, begun: &begun };
    let pools: Vec<_> = (0..threads.min(jobs.len())).map(|_| lonely()).collect::<Result<_, _>>()?;
    std::thread::scope(|scope| {
        let (sender, finished) = channel();
        for pool in pools {
            let sender = sender.clone();
            scope.spawn(move || pool.install(|| workers.work(&sender)));
        }
        drop(sender);
        let mut outcome = Ok(());
        for (job, trial, seconds) in finished {
            if outcome.is_ok() {
                outcome = receive(&jobs[job], trial, seconds);
                halted.store(outcome.is_err(), Ordering::Relaxed);
            }
        }
        outcome
    })
}

/// A pool of one thread: a run that waits for its evaluations must not take up another run meanwhile.
fn lonely() -> Result<rayon::ThreadPool, Failure> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    pool.map_err(|error| Failure::failed(format!("cannot start threads: {error}")))
}

#[derive(Clone, Copy)]
struct Workers<'a> {
    jobs: &'a [Job],
    evaluations: Option<u64>,
    stop: &'a StopSignal,
    halted: &'a AtomicBool,
    begun: &'a AtomicUsize,
}

impl Workers<'_> {
    fn work(self, sender: &Sender<(usize, Trial, f64)>) {
        let is_stopped = || self.stop.is_raised() || self.halted.load(Ordering::Relaxed);
        while !is_stopped() {
            let index = self.begun.fetch_add(1, Ordering::Relaxed);
            let Some(job) = self.jobs.get(index) else { return };
            let watch = Stopwatch::start();
            let Some(trial) = run_one(&job.config, self.evaluations, is_stopped) else { return };
            if sender.send((index, trial, watch.seconds())).is_err() {
                return;
            }
        }
    }
}
