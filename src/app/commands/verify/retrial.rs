//! Simulating again what was scored, which must get the same fitness to the last bit.

use super::check::{Check, counted};
use crate::app::console::{Stopwatch, say};
use crate::evolution::{Fitness, Gene};
use crate::runs::config::Config;
use crate::runs::subject::Subject;
use crate::work_queue;
use indicatif::{ProgressBar, ProgressStyle};
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::{self, Display, Formatter};
use std::io::IsTerminal;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Lines are so far apart where there is no terminal, in seconds.
const LINE_EVERY_S: f64 = 5.0;

/// That somebody is as good as a file says.
#[derive(Debug, Clone, Copy)]
pub struct Claim<'a, G> {
    /// Who: a champion, a resident or a migrant.
    pub who: &'static str,
    /// On which island.
    pub island: u32,
    /// In which generation.
    pub generation: u32,
    /// The genome.
    pub genome: &'a [G],
    /// What it is said to be worth…
    pub fitness: Fitness,
    /// … by this measure.
    pub by: Measure,
}

/// What somebody's worth is measured by.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Measure {
    /// The whole score.
    Whole,
    /// The whole score, or an estimate of who did not get over a hurdle.
    Estimate,
    /// Trials that nobody was selected on.
    Fresh,
}

/// Somebody who is not as good as a file says.
#[derive(Debug, Serialize)]
pub struct Mismatch {
    who: &'static str,
    island: u32,
    generation: u32,
    /// The fitness in the file; the most negative number if it says that there was no score.
    recorded: f64,
    /// What it gets; none if no such genome can have lived in the run.
    found: Option<f64>,
}

impl Display for Mismatch {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self { who, island, generation, recorded, found } = self;
        write!(f, "a {who} of island {island}, generation {generation}, is recorded with ")?;
        write!(f, "{}, but ", number(*recorded))?;
        match found {
            Some(found) => write!(f, "gets {}", number(*found)),
            None => write!(f, "has a genome that cannot have lived in this run"),
        }
    }
}

/// A saturated fitness as people can compare it to the last bit.
fn number(saturated: f64) -> String {
    if saturated == f64::MIN { "no score".to_owned() } else { saturated.to_string() }
}

/// What came of simulating again.
#[derive(Debug)]
pub struct Retrial {
    /// Different genomes that were simulated.
    pub simulated: usize,
    /// Who has another fitness.
    pub mismatches: Vec<Mismatch>,
}

impl Retrial {
    /// The row of the table.
    pub fn check(&self) -> Check {
        let mut check = Check::of("simulations").checked(counted(self.simulated, "genome"));
        self.mismatches.iter().for_each(|mismatch| check.damaged(mismatch));
        check
    }
}

/// Simulates on the threads of the current rayon pool, equal genomes once.
pub fn retry<P: Subject>(claims: &[Claim<P::Gene>], config: &Config, problem: &P) -> Retrial {
    let claims_to_try = claims.iter().filter(|claim| may_have_lived(claim.genome, config));
    let trials: BTreeMap<Key, &Claim<P::Gene>> =
        claims_to_try.map(|claim| (key(claim), claim)).collect();
    let found = evaluate(trials, problem);
    let mismatch = |claim: &Claim<P::Gene>| {
        let Claim { who, island, generation, fitness: recorded, .. } = *claim;
        let found = found.get(&key(claim)).map(Vec::as_slice).unwrap_or_default();
        let bits = |fitness: Fitness| fitness.get().to_bits();
        let is_right = found.iter().any(|&found| bits(found) == bits(recorded));
        (!is_right).then(|| Mismatch {
            who,
            island,
            generation,
            recorded: recorded.saturated(),
            found: found.last().copied().map(Fitness::saturated),
        })
    };
    let mismatches = claims.iter().filter_map(mismatch).collect();
    let genomes: BTreeSet<&[u8]> = found.keys().map(|&(_, genome)| genome).collect();
    Retrial { simulated: genomes.len(), mismatches }
}

/// Whether an individual of the run can have had this genome.
fn may_have_lived<G: Gene>(genome: &[G], config: &Config) -> bool {
    (1..=config.max_genes).contains(&genome.len()) && genome.iter().all(G::is_valid)
}

/// The fitness of each genome, or all that it may have: the whole score is the last.
fn evaluate<'a, P: Subject>(
    trials: BTreeMap<Key<'a>, &Claim<P::Gene>>,
    problem: &P,
) -> BTreeMap<Key<'a>, Vec<Fitness>> {
    let trials: Vec<_> = trials.into_iter().collect();
    let meter = Meter::new(trials.len());
    let costs: Vec<u64> = trials.iter().map(|(_, claim)| problem.cost(claim.genome)).collect();
    let found = work_queue::dearest_first(&costs, |index| {
        let (key, claim) = trials[index];
        let found = match claim.by {
            Measure::Whole => vec![problem.evaluate(claim.genome).fitness],
            Measure::Estimate => problem.possible_scores(claim.genome),
            Measure::Fresh => problem.validate(claim.genome).into_iter().collect(),
        };
        meter.tick();
        (key, found)
    });
    meter.finish();
    found.into_iter().collect()
}

/// What is simulated once. Equal genomes have equal bytes.
type Key<'a> = (Measure, &'a [u8]);

fn key<'a, G: Gene>(claim: &Claim<'a, G>) -> Key<'a> {
    (claim.by, bytemuck::cast_slice(claim.genome))
}

/// How far it has come: a bar on a terminal, now and then a line elsewhere.
struct Meter {
    genomes: usize,
    done: AtomicUsize,
    bar: Option<ProgressBar>,
    last_line: Mutex<Stopwatch>,
}

impl Meter {
    fn new(genomes: usize) -> Self {
        let style = ProgressStyle::with_template(
            "simulating again {bar:30.cyan/blue} {pos}/{len} {elapsed_precise}",
        )
        .unwrap_or_else(|_| ProgressStyle::default_bar());
        let bar = std::io::stderr()
            .is_terminal()
            .then(|| ProgressBar::new(genomes as u64).with_style(style));
        let last_line = Mutex::new(Stopwatch::start());
        Self { genomes, done: AtomicUsize::new(0), bar, last_line }
    }

    fn tick(&self) {
        let done = self.done.fetch_add(1, Ordering::Relaxed) + 1;
        if let Some(bar) = &self.bar {
            return bar.inc(1);
        }
        // Who finds it taken leaves the line to another thread.
        let Ok(mut last_line) = self.last_line.try_lock() else { return };
        if last_line.seconds() >= LINE_EVERY_S {
            *last_line = Stopwatch::start();
            say(&format!("simulated {done} of {} again", counted(self.genomes, "genome")));
        }
    }

    fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}
