//! An island's process: evolve, exchange, record.

mod panics;
mod patience;

use crate::app::args::cli::IslandArgs;
use crate::app::console::{Stopwatch, say};
use crate::app::processes::parent_link::{FINISHED, READY, StopSignal, tell};
use crate::archipelago::{Action, Archipelago, Arrival, ExchangeMode, Outbox, Protocol, Step};
use crate::runs::Failure;
use crate::runs::catalogue::Visitor;
use crate::runs::config::Config;
use crate::runs::seeds;
use crate::runs::subject::Subject;
use crate::store::{Journal, JournalReader, Logbook, Restored, RunDir};
use crate::transport::{Exchange, TICK};
use panics::Panics;
use patience::Patience;
use std::collections::BTreeMap;
use std::fmt::Display;

/// Runs one island of the run in a folder.
///
/// # Errors
/// If its files or its shared memory fail it.
pub fn run(args: &IslandArgs) -> Result<(), Failure> {
    let stop_signal = StopSignal::from_parent(args.parent)?;
    let dir = RunDir::at(&args.dir);
    let config = Config::of_run(&dir)?;
    config.visit(Start { args, dir: &dir, config: &config, stop_signal })
}

/// An island that is to evolve some problem.
struct Start<'a> {
    args: &'a IslandArgs,
    dir: &'a RunDir,
    config: &'a Config,
    stop_signal: StopSignal,
}

impl Visitor for Start<'_> {
    type Output = Result<(), Failure>;

    fn visit<P: Subject>(self, problem: P) -> Result<(), Failure> {
        let Self { args, dir, config, stop_signal } = self;
        let archipelago = config.archipelago();
        // Before any thread makes a file: opening changes the umask for a moment.
        let exchange = Exchange::open(&config.domain()?, &archipelago, args.index)?;
        rayon::ThreadPoolBuilder::new()
            .num_threads(args.threads)
            .build_global()
            .map_err(|error| Failure::failed(format!("cannot start threads: {error}")))?;
        let Restored { logbook, island, arrivals, warnings } =
            Logbook::open(dir, &archipelago, args.index, &config.settings())?;
        for warning in warnings {
            say(&format!("warning: {warning}"));
        }
        let founders = seeds::of_run(dir, config, &problem)?;
        let saved = island.as_ref().map(|island| island.generation);
        let protocol =
            Protocol::begin(&problem, &archipelago, args.index, config.generations, island);
        let protocol = protocol.with_founders(founders).with_record(arrivals);
        let mut process = IslandProcess {
            config,
            archipelago: &archipelago,
            problem: &problem,
            protocol,
            exchange,
            logbook,
            stop_signal,
            patience: Patience::new(),
            panics: Panics::of(dir),
            generation_began: Stopwatch::start(),
            told: Told::default(),
            saved,
            refused: BTreeMap::new(),
            journals: BTreeMap::new(),
        };
        process.catch_up(dir)?;
        process.evolve(dir)
    }
}

/// An island and what connects it to the world: its neighbours, its files and its launcher.
struct IslandProcess<'a, P: Subject> {
    config: &'a Config,
    archipelago: &'a Archipelago,
    problem: &'a P,
    protocol: Protocol<'a, P>,
    exchange: Exchange<P::Gene>,
    logbook: Logbook<P::Gene>,
    stop_signal: StopSignal,
    patience: Patience,
    panics: Panics<'a>,
    generation_began: Stopwatch,
    told: Told,
    /// The generation of its newest checkpoint.
    saved: Option<u32>,
    /// Batches that were refused, by the island that they came as.
    refused: BTreeMap<u32, u64>,
    /// The journals of neighbours from which was read what an earlier life took in.
    journals: BTreeMap<u32, JournalReader<P::Gene>>,
}

/// What an island has told its launcher, once each.
#[derive(Default)]
struct Told {
    ready: bool,
    finished: bool,
}

impl<P: Subject> IslandProcess<'_, P> {
    /// Takes up where its predecessor died: sends again what may have been lost on the way out, and reads in the
    /// neighbours' journals what may have been lost on the way in, since they may be busy, stopped or dead.
    fn catch_up(&mut self, dir: &RunDir) -> Result<(), Failure> {
        let Some(island) = self.protocol.island() else { return Ok(()) };
        let window = self.exchange.history();
        let migration = &self.archipelago.migration;
        if migration.exchange == ExchangeMode::Async {
            return self.send_since(self.logbook.epochs().saturating_sub(window));
        }
        let next = migration.next_immigration(island.generation);
        for source in self.archipelago.in_neighbours(island.index) {
            let journal = dir.migrations(source);
            match Journal::read(&journal, next..next.saturating_add(window)) {
                Ok(outboxes) => {
                    outboxes.into_iter().for_each(|outbox| self.take_in(source, outbox))
                }
                // It is the neighbour that cannot do without its journal. What is missing is asked for.
                Err(error) => say(&format!("warning: {error}")),
            }
        }
        self.send_since(self.logbook.epochs().saturating_sub(window))
    }

    /// Evolves until all is done, and serves the neighbours until the launcher wants it to stop.
    fn evolve(&mut self, dir: &RunDir) -> Result<(), Failure> {
        let clock = Stopwatch::start();
        while !self.stop_signal.is_raised() {
            self.receive();
            self.answer()?;
            self.tell_ready();
            match self.protocol.advance(clock.elapsed()) {
                Action::Evolved(step) => self.conclude(&step)?,
                Action::Ask { sources, epoch } => self.ask(&sources, epoch),
                Action::Record(arrivals) => self.logbook.record_arrivals(&arrivals)?,
                Action::Recall(outboxes) => self.recall(dir, &outboxes)?,
                Action::Wait => self.wait()?,
                Action::Arrived => self.rest()?,
            }
        }
        self.save()
    }

    /// Tells the launcher that it can evolve the next generation, as soon as it can.
    fn tell_ready(&mut self) {
        if self.told.ready || self.protocol.waits_for().is_some() {
            return;
        }
        self.told.ready = true;
        let generation = self.protocol.island().map(|island| island.generation.to_string());
        tell(&format!("{READY}{}", generation.as_deref().unwrap_or("nothing")));
    }

    /// A generation was evolved: what it came to is recorded, sent, and saved where that is due.
    fn conclude(&mut self, step: &Step<P::Gene>) -> Result<(), Failure> {
        let seconds = std::mem::replace(&mut self.generation_began, Stopwatch::start()).seconds();
        self.patience.learn(seconds);
        self.record(step, seconds)?;
        self.panics.keep(self.problem, step);
        let Config { checkpoint_interval, generations, .. } = *self.config;
        let generation = step.island.generation;
        match generation.is_multiple_of(checkpoint_interval) || generation == generations {
            true => self.save(),
            false => Ok(()),
        }
    }

    /// Reads in the neighbours' journals what an earlier life took in. What is not there its sender has yet to
    /// evolve again.
    fn recall(&mut self, dir: &RunDir, outboxes: &[(u32, u32)]) -> Result<(), Failure> {
        let mut found = false;
        for &(source, epoch) in outboxes {
            let new = || JournalReader::of(dir.migrations(source));
            let outbox = self.journals.entry(source).or_insert_with(new).outbox(epoch)?;
            if let Some(outbox) = outbox.filter(|it| it.fits(self.archipelago, source)) {
                self.protocol.recall(outbox);
                found = true;
            }
        }
        if found { Ok(()) } else { self.wait() }
    }

    fn ask(&self, sources: &[u32], epoch: u32) {
        sources.iter().for_each(|&source| self.exchange.request(source, epoch));
    }

    fn wait(&mut self) -> Result<(), Failure> {
        self.patience.wait(self.protocol.waits_for());
        self.exchange.wait(TICK)?;
        Ok(())
    }

    /// All is evolved: the launcher is told, and neighbours may still ask.
    fn rest(&mut self) -> Result<(), Failure> {
        if !std::mem::replace(&mut self.told.finished, true) {
            tell(FINISHED);
        }
        self.exchange.wait(TICK)?;
        Ok(())
    }

    /// Takes in what arrived.
    fn receive(&mut self) {
        let received = self.exchange.receive();
        for outbox in received.outboxes {
            self.take_in(outbox.island, outbox);
        }
        for (source, rejection) in received.rejected {
            self.refuse(source, &rejection);
        }
    }

    fn take_in(&mut self, source: u32, outbox: Outbox<P::Gene>) {
        if !outbox.fits(self.archipelago, source) {
            return self.refuse(source, &"it has an individual that cannot be in it");
        }
        let epoch = outbox.epoch;
        let epochs = self.config.generations / self.archipelago.migration.interval;
        // Where nobody waits it would be taken in, and nobody could evolve it again.
        if self.archipelago.migration.exchange == ExchangeMode::Async && epoch >= epochs {
            return self.refuse(source, &"it is of an epoch after the end of the run");
        }
        let arrival = self.protocol.receive(outbox);
        // A neighbour that is far ahead is no liar. One that is soon after the end may be of a run that was to
        // be longer.
        if arrival == Arrival::TooEarly && epoch >= epochs {
            self.refuse(source, &"it is of an epoch long after the end of the run");
        }
    }

    fn refuse(&mut self, source: u32, reason: &dyn Display) {
        let count = self.refused.entry(source).or_default();
        *count += 1;
        // Whoever sends such things may send many.
        if count.is_power_of_two() {
            say(&format!(
                "warning: refused {count} batch(es) of migrants that came as island {source}'s: {reason}"
            ));
        }
    }

    /// Sends again what a neighbour asks for.
    fn answer(&mut self) -> Result<(), Failure> {
        self.exchange.requests().map_or(Ok(()), |epoch| self.send_since(epoch))
    }

    fn send_since(&self, epoch: u32) -> Result<(), Failure> {
        for epoch in epoch..self.logbook.epochs() {
            let Some(outbox) = self.logbook.outbox(epoch)? else { break };
            // What nobody has room for is asked for again.
            if self.exchange.publish(&outbox)? == 0 {
                break;
            }
        }
        Ok(())
    }

    /// Records a generation and sends what it has to send: first what must not be lost, then the word of it.
    fn record(&mut self, step: &Step<P::Gene>, seconds: f64) -> Result<(), Failure> {
        self.logbook.record(step, seconds)?;
        if let Some(outbox) = &step.outbox {
            self.exchange.publish(outbox)?;
        }
        self.exchange.report(&step.report, seconds, step.champion.as_ref())?;
        Ok(())
    }

    /// Saves the island as it is, unless it is saved already.
    fn save(&mut self) -> Result<(), Failure> {
        let Some(island) = self.protocol.island() else { return Ok(()) };
        if self.saved != Some(island.generation) {
            self.logbook.save(island)?;
            self.saved = Some(island.generation);
        }
        Ok(())
    }
}
