//! How long a run would take on other cores, from what was measured on one.
//!
//! A generation g of island i takes
//!
//! ```text
//! d(i, g) = s(i, g) + M(i, g)
//! ```
//!
//! where s is its measured serial part, and M the end of its list schedule (Graham 1966): t threads, each taking the
//! next of the measured evaluations as soon as it is free, in some [`Order`]. An island begins a generation when the
//! one before it has ended, and, where immigrants are due, when the last of its in-neighbours n has ended the epoch e
//! that they come from, with interval I and e as [`Migration::immigration`](islands::archipelago::Migration) has it:
//!
//! ```text
//! b(i, g) = max(b(i, g-1) + d(i, g-1), max over n of b(n, (e+1) I) + d(n, (e+1) I))
//! ```
//!
//! The run ends with its last island. Its speed-up is over one core that does the same, and its efficiency the
//! speed-up by the number of cores. Amdahl's bound knows no waiting and shares the evaluations out to the last crumb:
//! d(i, g) = s(i, g) + w(i, g) / t, where w is what the evaluations take together, and nobody waits for the last.
//!
//! Where more islands or generations are asked for than were measured, island i is like the measured island i modulo
//! their number, and goes through its generations again and again, those of the same model each from another start.
//! So small and large islands stay what they are. What is left out: caches, memory and clock rates that cores share.

use crate::trace::{Generation, Job, Trace};
use islands::archipelago::{Archipelago, Migration};
use std::cmp::Reverse;

/// In which order a batch is begun.
#[derive(Clone, Copy, PartialEq)]
pub enum Order {
    /// As it was asked for: by the bytes of the genomes, which know nothing of their costs.
    Arbitrary,
    /// The dearest first, by estimate: what the program does.
    Estimated,
    /// The dearest first, as if it were known what each costs.
    Known,
}

/// A run that nobody has run.
#[derive(Clone, Copy)]
pub struct Plan {
    pub islands: u32,
    /// Threads of each island.
    pub threads: usize,
    pub generations: u32,
    pub migration: Migration,
    pub order: Order,
}

/// What comes of it.
pub struct Outcome {
    /// How long it takes.
    pub wall_s: f64,
    /// How long one core would take.
    pub one_core_s: f64,
    /// How long it takes by Amdahl's law.
    pub amdahl_s: f64,
    /// How long all its islands wait for immigrants, together.
    pub waited_s: f64,
}

impl Outcome {
    /// The share of the run that an island waits for immigrants, on average, in percent.
    pub fn waits(&self, islands: u32) -> f64 {
        self.waited_s / self.wall_s / f64::from(islands) * 100.0
    }
}

/// When the last thread is done with a batch.
pub fn makespan_s(jobs: &[Job], threads: usize, order: Order) -> f64 {
    let mut queue = jobs.to_vec();
    match order {
        Order::Arbitrary => {}
        Order::Estimated => queue.sort_by_key(|job| Reverse(job.estimate)),
        Order::Known => queue.sort_by(|a, b| b.seconds.total_cmp(&a.seconds)),
    }
    let mut free_s = vec![0.0_f64; threads];
    for job in queue {
        let next = free_s.iter_mut().min_by(|a, b| a.total_cmp(b));
        *next.expect("there is a thread") += job.seconds;
    }
    free_s.into_iter().fold(0.0, f64::max)
}

impl Plan {
    /// The run that was measured, on so many threads an island.
    pub fn of(trace: &Trace, threads: usize) -> Self {
        let Trace { archipelago: Archipelago { islands, migration, .. }, generations, .. } = *trace;
        Self { islands, threads, generations, migration, order: Order::Estimated }
    }

    /// Runs it in the model.
    pub fn run(self, trace: &Trace) -> Outcome {
        let archipelago = Archipelago { islands: self.islands, ..trace.archipelago };
        let mut ends_s: Vec<Vec<f64>> = Vec::new();
        let mut waited_s = 0.0;
        let islands = 0..self.islands as usize;
        for generation in 0..=self.generations {
            let epoch = self.migration.immigration(generation);
            let sent = epoch.map(|epoch| ((epoch + 1) * self.migration.interval) as usize);
            let end_s = |island: usize| {
                let free_s = ends_s.last().map_or(0.0, |ends_s| ends_s[island]);
                let sources = archipelago.in_neighbours(island as u32).into_iter();
                let come_s = sources.filter_map(|source| Some(ends_s[sent?][source as usize]));
                let began_s = come_s.fold(free_s, f64::max);
                waited_s += began_s - free_s;
                let generation = like(trace, island, generation as usize);
                began_s
                    + generation.serial_s()
                    + makespan_s(&generation.jobs, self.threads, self.order)
            };
            let ends = islands.clone().map(end_s).collect();
            ends_s.push(ends);
        }
        let wall_s = ends_s.last().into_iter().flatten().copied().fold(0.0, f64::max);
        let sum_s = |threads: f64| -> f64 {
            let all =
                islands.clone().flat_map(|i| (0..=self.generations as usize).map(move |g| (i, g)));
            all.map(|(i, g)| like(trace, i, g))
                .map(|it| it.serial_s() + it.work_s() / threads)
                .sum()
        };
        Outcome {
            wall_s,
            one_core_s: sum_s(1.0),
            amdahl_s: sum_s(self.threads as f64) / f64::from(self.islands),
            waited_s,
        }
    }

    /// How many cores it keeps busy while nothing waits.
    pub fn cores(self) -> f64 {
        f64::from(self.islands) * self.threads as f64
    }
}

/// The measured generation that stands for one of a run that may be larger.
fn like(trace: &Trace, island: usize, generation: usize) -> &Generation {
    let measured = &trace.islands[island % trace.islands.len()];
    let shift = island / trace.islands.len();
    match generation.checked_sub(1) {
        // A random generation is like no other.
        None => &measured[0],
        Some(later) => &measured[1 + (later + shift) % (measured.len() - 1)],
    }
}
