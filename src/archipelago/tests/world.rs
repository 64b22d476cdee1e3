//! Islands that live, die and are born again on a sea, in virtual time.

use super::sea::{Sea, Weather};
use super::toy::{Bit, Toy};
use crate::archipelago::arrivals::check_record;
use crate::archipelago::{Action, Archipelago, Arrival, Arrivals, Island, Outbox, Protocol, Step};
use crate::rng::Stream;
use rand::RngExt;
use std::collections::{BTreeMap, VecDeque};
use std::time::Duration;

/// All that is drawn about a world before it begins.
#[derive(Debug, Clone)]
pub struct Schedule {
    pub archipelago: Archipelago,
    pub generations: u32,
    pub weather: Weather,
    /// Generations between two checkpoints.
    pub checkpoint_interval: u32,
    /// Epochs that a reborn island sends again unasked.
    pub history: usize,
    /// The window of each inbox, in epochs.
    pub window: u32,
    /// Probability to die before each effect.
    pub death: f64,
    /// Deaths after which there are no more.
    pub deaths_max: u32,
    /// Probability of each other island to die along.
    pub contagion: f64,
    /// Probability of each checkpoint to be damaged when it is needed.
    pub damage: f64,
    /// The most that an effect, an evaluation or a wait takes, in ms.
    pub pause_ms_max: u64,
}

/// How often what happened: a world in which nothing happens proves nothing.
pub type Tally = BTreeMap<&'static str, u64>;

/// A world in virtual time.
pub struct World<'a> {
    schedule: &'a Schedule,
    rng: Stream,
    hosts: Vec<Host<'a>>,
    outboxes: Sea<Outbox<Bit>>,
    requests: Sea<u32>,
    deaths_left: u32,
    pub tally: Tally,
}

/// A place for an island: what is durable there, and the process if there is one.
#[derive(Default)]
struct Host<'a> {
    journal: Vec<Outbox<Bit>>,
    record: Vec<Arrivals>,
    checkpoints: BTreeMap<u32, Island<Bit>>,
    process: Option<Process<'a>>,
    acts_at: Duration,
}

/// What dies.
struct Process<'a> {
    protocol: Protocol<'a, Toy>,
    effects: VecDeque<Effect>,
    has_arrived: bool,
}

/// What a process does to the world, one at a time: between any two it may die.
enum Effect {
    Record(Arrivals),
    Append(Outbox<Bit>),
    Save(Island<Bit>),
    Send(Outbox<Bit>),
    SendAgain(Outbox<Bit>),
    Ask(u32, u32),
}

impl<'a> World<'a> {
    pub fn new(schedule: &'a Schedule, rng: Stream) -> Self {
        Self {
            schedule,
            rng,
            hosts: (0..schedule.archipelago.islands).map(|_| Host::default()).collect(),
            outboxes: Sea::new(schedule.weather),
            requests: Sea::new(schedule.weather),
            deaths_left: schedule.deaths_max,
            tally: Tally::new(),
        }
    }

    /// Lets time go by until all islands have arrived, and returns them as their files have them; none if
    /// they have not by `deadline`.
    pub fn run(&mut self, deadline: Duration) -> Option<Vec<Island<Bit>>> {
        while !self.hosts.iter().all(Host::is_done) {
            let next = (0..self.hosts.len()).min_by_key(|&i| self.hosts[i].acts_at)?;
            let now = self.hosts[next].acts_at;
            if now > deadline {
                return None;
            }
            if self.strikes(next as u32) {
                self.kill(next as u32, now);
            } else {
                self.act(next as u32, now);
                self.hosts[next].acts_at = now + self.pause();
            }
        }
        self.hosts.iter().map(|host| host.checkpoints.values().last().cloned()).collect()
    }

    /// What each island recorded of what it took in.
    pub fn records(&self) -> Vec<Vec<Arrivals>> {
        self.hosts.iter().map(|host| host.record.clone()).collect()
    }

    fn pause(&mut self) -> Duration {
        Duration::from_micros(self.rng.random_range(1..=1_000 * self.schedule.pause_ms_max))
    }

    fn count(&mut self, what: &'static str) {
        *self.tally.entry(what).or_default() += 1;
    }

    fn strikes(&mut self, island: u32) -> bool {
        let lives = self.hosts[island as usize].process.is_some();
        lives && self.deaths_left > 0 && self.rng.random_bool(self.schedule.death)
    }

    fn kill(&mut self, first: u32, now: Duration) {
        self.deaths_left -= 1;
        for island in 0..self.schedule.archipelago.islands {
            if island != first && !self.rng.random_bool(self.schedule.contagion) {
                continue;
            }
            let Some(process) = self.hosts[island as usize].process.take() else { continue };
            self.count(process.last_words());
            if island != first {
                self.count("died together with another");
            }
            self.outboxes.bury(island, &mut self.rng);
            self.requests.bury(island, &mut self.rng);
            self.hosts[island as usize].acts_at = now + 5 * self.pause();
        }
    }

    fn act(&mut self, island: u32, now: Duration) {
        let Some(process) = &mut self.hosts[island as usize].process else {
            return self.bear(island);
        };
        match process.effects.pop_front() {
            Some(effect) => self.perform(island, effect, now),
            None => self.look(island, now),
        }
    }

    /// Begins from the newest checkpoint that is whole.
    fn bear(&mut self, island: u32) {
        let Schedule { archipelago, generations, window, history, damage, .. } = self.schedule;
        let host = &mut self.hosts[island as usize];
        let kept = host.checkpoints.len();
        while !host.checkpoints.is_empty() && self.rng.random_bool(*damage) {
            host.checkpoints.pop_last();
        }
        let saved = host.checkpoints.values().last().cloned();
        assert!(saved.iter().all(|saved| saved.fits(archipelago, island) == Ok(())));
        let unsent = host.journal.len().saturating_sub(*history);
        let effects = host.journal[unsent..].iter().cloned().map(Effect::SendAgain).collect();
        let from_seed = saved.is_none();
        let protocol = Protocol::begin(&Toy, archipelago, island, *generations, saved);
        assert_eq!(check_record(&host.record, archipelago, island), Ok(()));
        let protocol = protocol.with_window(*window).with_record(host.record.clone());
        host.process = Some(Process { protocol, effects, has_arrived: false });
        match kept {
            0 => {}
            _ if from_seed => self.count("born from the seed again"),
            2 if self.hosts[island as usize].checkpoints.len() == 1 => {
                self.count("born from the older checkpoint");
            }
            _ => self.count("born from a checkpoint"),
        }
    }

    /// One turn of an island's loop: receive, advance, answer.
    fn look(&mut self, island: u32, now: Duration) {
        let arrived = self.outboxes.collect(now, island);
        let asked = self.requests.collect(now, island).into_iter().min();
        let Host { journal, process, .. } = &mut self.hosts[island as usize];
        let process = process.as_mut().expect("only the living look");
        let arrivals: Vec<Arrival> =
            arrived.into_iter().map(|outbox| process.protocol.receive(outbox)).collect();
        let action = process.protocol.advance(now);
        match action {
            Action::Recall(outboxes) => return self.recall(island, &outboxes),
            Action::Record(arrivals) => process.effects.push_back(Effect::Record(arrivals)),
            Action::Evolved(step) => process.has_evolved(*step, self.schedule),
            Action::Ask { sources, epoch } => {
                process.effects.extend(sources.into_iter().map(|from| Effect::Ask(from, epoch)));
            }
            Action::Wait => assert!(process.protocol.waits_for().is_some()),
            Action::Arrived => process.has_arrived = true,
        }
        let since = asked.map_or(journal.len(), |epoch| journal.len().min(epoch as usize));
        process.effects.extend(journal[since..].iter().cloned().map(Effect::SendAgain));
        for arrival in arrivals {
            self.count(match arrival {
                Arrival::Kept => "got what was kept",
                Arrival::Duplicate => "got a duplicate",
                Arrival::Stale => "got a stale epoch",
                Arrival::TooEarly => "got an epoch too early",
                Arrival::Stranger => unreachable!("nobody writes to whom it does not know"),
            });
        }
    }

    /// Reads in the others' journals what an earlier life took in.
    fn recall(&mut self, island: u32, outboxes: &[(u32, u32)]) {
        self.count("took in again what it had recorded");
        for &(source, epoch) in outboxes {
            let outbox = self.hosts[source as usize].journal[epoch as usize].clone();
            let process = self.hosts[island as usize].process.as_mut();
            process.expect("only the living recall").protocol.recall(outbox);
        }
    }

    fn perform(&mut self, island: u32, effect: Effect, now: Duration) {
        match effect {
            Effect::Record(arrivals) => {
                self.count(match arrivals.taken.is_empty() {
                    true => "began an epoch with nothing",
                    false => "began an epoch with immigrants",
                });
                self.hosts[island as usize].record.push(arrivals);
            }
            Effect::Append(outbox) => self.hosts[island as usize].append(outbox),
            Effect::Save(state) => self.hosts[island as usize].save(state),
            Effect::Send(outbox) | Effect::SendAgain(outbox) => {
                for to in self.schedule.archipelago.out_neighbours(island) {
                    self.outboxes.send(now, [island, to], &outbox, &mut self.rng);
                }
            }
            Effect::Ask(source, epoch) => {
                self.count("asked");
                self.requests.send(now, [island, source], &epoch, &mut self.rng);
            }
        }
    }
}

impl Host<'_> {
    fn is_done(&self) -> bool {
        self.process.as_ref().is_some_and(|p| p.has_arrived && p.effects.is_empty())
    }

    fn append(&mut self, outbox: Outbox<Bit>) {
        let epoch = outbox.epoch as usize;
        assert!(epoch <= self.journal.len(), "the journal misses epochs before {epoch}");
        match self.journal.get(epoch) {
            Some(before) => assert_eq!(*before, outbox, "an epoch was evolved differently"),
            None => self.journal.push(outbox),
        }
    }

    fn save(&mut self, state: Island<Bit>) {
        self.checkpoints.insert(state.generation, state);
        while self.checkpoints.len() > 2 {
            self.checkpoints.pop_first();
        }
    }
}

impl Process<'_> {
    fn has_evolved(&mut self, step: Step<Bit>, schedule: &Schedule) {
        assert_eq!(self.protocol.island(), Some(&step.island));
        let generation = step.island.generation;
        let is_last = generation == schedule.generations;
        let is_due = is_last || generation.is_multiple_of(schedule.checkpoint_interval);
        self.effects.extend(step.outbox.clone().map(Effect::Append));
        self.effects.extend(is_due.then_some(Effect::Save(step.island)));
        self.effects.extend(step.outbox.map(Effect::Send));
    }

    /// What it was about to do when it died.
    fn last_words(&self) -> &'static str {
        match self.effects.front() {
            Some(Effect::Record(_)) => "died before it recorded what it took in",
            Some(Effect::Append(_)) => "died before it wrote its journal",
            Some(Effect::Save(_)) => "died before it saved itself",
            Some(Effect::Send(_)) => "died before it sent",
            Some(Effect::SendAgain(_)) => "died before it sent again",
            Some(Effect::Ask(..)) => "died before it asked",
            None if self.has_arrived => "died at its destination",
            None if self.protocol.waits_for().is_some() => "died while it waited",
            None => "died between two generations",
        }
    }
}
