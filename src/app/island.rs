//! An island's process: evolve, exchange, record.

use super::Failure;
use super::cli::IslandArgs;
use super::config::Config;
use super::console::{Stopwatch, say};
use super::kinship::{Ear, FINISHED, tell};
use crate::archipelago::island::{Step, genesis, step};
use crate::archipelago::{Archipelago, Inbox, Island, Outbox};
use crate::evolution::Problem;
use crate::store::{Logbook, RunDir};
use crate::transport::{Domain, Exchange, TICK};
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
    let restored = Logbook::open(&dir, &archipelago, args.index, &config.settings())?;
    for warning in &restored.warnings {
        say(&format!("warning: {warning}"));
    }
    let inbox = Inbox::new(archipelago.in_neighbours(args.index), 0);
    let problem = config.problem();
    let mut shore = Shore { exchange, inbox, logbook: restored.logbook, ear };
    evolve(&problem, &archipelago, args.index, config.generations, &mut shore, restored.island)
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
    shore: &mut Shore<P>,
    restored: Option<Island<P::Gene>>,
) -> Result<(), Failure> {
    let watch = Stopwatch::start();
    let mut island = match restored {
        Some(island) => island,
        None => {
            let first = genesis(problem, archipelago, index);
            shore.record(&first, watch)?;
            first.island
        }
    };
    while island.generation < generations {
        let watch = Stopwatch::start();
        let epoch = archipelago.migration.immigration(island.generation + 1);
        let Some(immigrants) = shore.await_immigrants(epoch)? else { break };
        let next = step(island, &immigrants, problem, archipelago);
        shore.record(&next, watch)?;
        island = next.island;
        shore.answer()?;
    }
    if island.generation == generations {
        tell(FINISHED);
    }
    shore.serve_until_stopped()
}

/// Where an island meets the world: its neighbours, its files and its launcher.
struct Shore<P: Problem> {
    exchange: Exchange<P::Gene>,
    inbox: Inbox<P::Gene>,
    logbook: Logbook<P::Gene>,
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
            for epoch in epoch..self.logbook.epochs() {
                let Some(outbox) = self.logbook.outbox(epoch)? else { break };
                // Those that nobody has room for are asked for again.
                if self.exchange.publish(&outbox)? == 0 {
                    break;
                }
            }
        }
        Ok(())
    }

    /// Records a generation and sends what it has to send: first what must not be lost, then the word of it.
    fn record(&mut self, step: &Step<P::Gene>, watch: Stopwatch) -> Result<(), Failure> {
        let seconds = watch.seconds();
        let champion = step.new_champion.then_some(&step.island.champion);
        self.logbook.record(step, seconds)?;
        if let Some(outbox) = &step.outbox {
            self.exchange.publish(outbox)?;
        }
        self.logbook.save(&step.island)?;
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
