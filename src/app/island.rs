//! An island's process: evolve, exchange, record.

use super::Failure;
use super::cli::IslandArgs;
use super::config::Config;
use super::console::{Stopwatch, say};
use super::kinship::{Ear, FINISHED, tell};
use crate::archipelago::island::{Step, genesis, step};
use crate::archipelago::{Archipelago, Inbox, Outbox};
use crate::evolution::{Individual, Problem};
use crate::formats::metrics;
use crate::store::{Journal, RecordLog, RunDir, StoreError, checkpoint};
use crate::transport::{Domain, Exchange, TICK};
use std::fs::File;
use std::time::Duration;

/// Without an outbox for so long, an island asks for it again.
const PATIENCE: Duration = Duration::from_millis(200);

/// Runs one island of the run in a folder.
///
/// # Errors
/// If its files or its shared memory fail it.
pub fn run(args: &IslandArgs) -> Result<(), Failure> {
    let ear = Ear::to(args.parent)?;
    let dir = RunDir::at(&args.dir);
    let config = Config::read(&dir.config())?;
    let archipelago = config.archipelago();
    // Before any thread makes a file: opening changes the umask for a moment.
    let exchange = Exchange::open(&domain(&config)?, &archipelago, args.index)?;
    rayon::ThreadPoolBuilder::new()
        .num_threads(args.threads)
        .build_global()
        .map_err(|error| Failure::failed(format!("cannot start threads: {error}")))?;
    let records = Records::open(&dir, args.index)?;
    let inbox = Inbox::new(archipelago.in_neighbours(args.index), 0);
    let problem = config.problem();
    let mut shore = Shore { exchange, inbox, records, ear };
    evolve(&problem, &archipelago, args.index, config.generations, &dir, &mut shore)
}

/// The shared memory of a run.
pub fn domain(config: &Config) -> Result<Domain, Failure> {
    let launch = config.launch.as_ref();
    let launch = launch.ok_or_else(|| Failure::usage("this run was never launched"))?;
    Ok(launch.run_id.parse::<Domain>()?)
}

fn evolve<P: Problem>(
    problem: &P,
    archipelago: &Archipelago,
    index: u32,
    generations: u32,
    dir: &RunDir,
    shore: &mut Shore<P>,
) -> Result<(), Failure> {
    let watch = Stopwatch::start();
    let first = genesis(problem, archipelago, index);
    shore.record(&first, watch)?;
    let mut island = first.island;
    while island.generation < generations {
        let watch = Stopwatch::start();
        let epoch = archipelago.migration.immigration(island.generation + 1);
        let Some(immigrants) = shore.await_immigrants(epoch)? else { break };
        let next = step(island, &immigrants, problem, archipelago);
        shore.record(&next, watch)?;
        island = next.island;
        shore.answer()?;
    }
    checkpoint::save(&dir.checkpoint(index, island.generation), &island)?;
    if island.generation == generations {
        tell(FINISHED);
    }
    shore.serve_until_stopped()
}

/// Where an island meets the world: its neighbours, its files and its launcher.
struct Shore<P: Problem> {
    exchange: Exchange<P::Gene>,
    inbox: Inbox<P::Gene>,
    records: Records<P>,
    ear: Ear,
}

impl<P: Problem> Shore<P> {
    /// The outboxes of an epoch, once all are here; none if the launcher wants to stop before.
    fn await_immigrants(
        &mut self,
        epoch: Option<u32>,
    ) -> Result<Option<Vec<Outbox<P::Gene>>>, Failure> {
        let Some(epoch) = epoch else {
            return Ok((!self.ear.heard_stop()).then(Vec::new));
        };
        let mut waiting = Stopwatch::start();
        loop {
            if self.ear.heard_stop() {
                return Ok(None);
            }
            if self.receive() {
                waiting = Stopwatch::start();
            }
            if let Some(immigrants) = self.inbox.take(epoch) {
                return Ok(Some(immigrants));
            }
            if waiting.elapsed() > PATIENCE {
                for source in self.inbox.missing(epoch) {
                    self.exchange.request(source, epoch);
                }
                waiting = Stopwatch::start();
            }
            self.answer()?;
            self.exchange.wait(TICK)?;
        }
    }

    /// Takes in what arrived; whether anything new was there.
    fn receive(&mut self) -> bool {
        let received = self.exchange.receive();
        for (source, rejection) in received.rejected {
            say(&format!("warning: refused migrants that came as island {source}'s: {rejection}"));
        }
        let accept = |outbox| self.inbox.accept(outbox) == crate::archipelago::Arrival::Kept;
        received.outboxes.into_iter().map(accept).filter(|&new| new).count() > 0
    }

    /// Sends again what a neighbour asks for.
    fn answer(&mut self) -> Result<(), Failure> {
        if let Some(epoch) = self.exchange.requests() {
            for outbox in self.records.journal.since(epoch)? {
                self.exchange.publish(&outbox)?;
            }
        }
        Ok(())
    }

    /// Records a generation and sends what it has to send: first what must not be lost, then the word of it.
    fn record(&mut self, step: &Step<P::Gene>, watch: Stopwatch) -> Result<(), Failure> {
        let seconds = watch.seconds();
        let champion = step.new_champion.then_some(&step.island.champion);
        self.records.record(step, champion, seconds)?;
        if let Some(outbox) = &step.outbox {
            self.records.journal.append(outbox)?;
            self.exchange.publish(outbox)?;
        }
        self.exchange.report(&step.report, seconds, champion)?;
        Ok(())
    }

    /// Neighbours may still need what this island sent.
    fn serve_until_stopped(&mut self) -> Result<(), Failure> {
        while !self.ear.heard_stop() {
            self.answer()?;
            self.exchange.wait(TICK)?;
        }
        Ok(())
    }
}

/// The files that an island alone writes.
struct Records<P: Problem> {
    journal: Journal<P::Gene>,
    champions: RecordLog<(u32, Individual<P::Gene>)>,
    metrics: File,
    metrics_path: std::path::PathBuf,
}

impl<P: Problem> Records<P> {
    fn open(dir: &RunDir, island: u32) -> Result<Self, Failure> {
        let metrics_path = dir.island_metrics(island);
        let metrics = File::create(&metrics_path).map_err(|source| StoreError::Io {
            action: "write",
            path: metrics_path.clone(),
            source,
        })?;
        Ok(Self {
            journal: Journal::open(&dir.migrations(island))?,
            champions: RecordLog::open(&dir.champions(island))?,
            metrics,
            metrics_path,
        })
    }

    fn record(
        &mut self,
        step: &Step<P::Gene>,
        champion: Option<&Individual<P::Gene>>,
        seconds: f64,
    ) -> Result<(), Failure> {
        let generation = step.report.generation;
        if let Some(champion) = champion {
            self.champions.append(&(generation, champion.clone()))?;
        }
        let row = metrics::Row::new(&step.report, seconds);
        metrics::write(&[row], generation == 0, &self.metrics)
            .and_then(|()| self.metrics.sync_data())
            .map_err(|source| {
                let path = self.metrics_path.clone();
                StoreError::Io { action: "append to", path, source }.into()
            })
    }
}
