//! The exchange protocol under thousands of seeded schedules of loss, delay and death, in virtual time.

mod product;
mod schemes;
mod sea;
pub mod toy;
mod world;

use super::inbox::WINDOW;
use super::protocol::PATIENCE;
use super::{
    Action, Archipelago, Arrival, Digest, ExchangeMode, Migration, Outbox, Protocol, lockstep,
};
use crate::evolution::Founders;
use crate::rng::{Purpose, Source, Stream};
use rand::RngExt;
use rand::seq::IndexedRandom;
use rayon::prelude::*;
use sea::Weather;
use std::time::Duration;
use toy::{Bit, Toy, archipelago};
use world::{Schedule, Tally, World};

/// The variable that asks for another number of schedules than the usual.
const SCHEDULES: &str = "ISLANDS_SCHEDULES";
const SCHEDULES_USUAL: u64 = 10_000;
/// In virtual time; the slowest of 200,000 schedules takes less than a tenth of it.
const DEADLINE: Duration = Duration::from_secs(600);

/// What must happen among the schedules, or they do not try what they are for.
const HAPPENINGS: [&str; 17] = [
    "asked",
    "born from a checkpoint",
    "born from the older checkpoint",
    "born from the seed again",
    "died at its destination",
    "died before it asked",
    "died before it saved itself",
    "died before it sent",
    "died before it sent again",
    "died before it wrote its journal",
    "died between two generations",
    "died together with another",
    "died while it waited",
    "got a duplicate",
    "got a stale epoch",
    "got an epoch too early",
    "got what was kept",
];

/// The same where nobody waits.
const HAPPENINGS_ASYNC: [&str; 11] = [
    "began an epoch with immigrants",
    "began an epoch with nothing",
    "born from a checkpoint",
    "born from the seed again",
    "died at its destination",
    "died before it recorded what it took in",
    "died before it saved itself",
    "died before it sent",
    "died before it wrote its journal",
    "died between two generations",
    "took in again what it had recorded",
];

#[test]
fn whatever_is_lost_and_whoever_dies_a_voyage_ends_in_the_bits_of_the_reference() {
    let asked = std::env::var(SCHEDULES).ok();
    let schedules = asked.map_or(SCHEDULES_USUAL, |n| n.parse().expect("a number of schedules"));
    let drawn = |seed| try_schedule(seed, |_| ());
    assert_all_happened(
        &(0..schedules).into_par_iter().map(drawn).reduce(Tally::new, add),
        &HAPPENINGS,
        schedules,
    );
}

#[test]
fn where_nobody_waits_whoever_dies_a_voyage_ends_in_the_bits_that_the_records_lead_to() {
    let schedules = SCHEDULES_USUAL;
    let drawn = |seed| {
        try_schedule(seed, |schedule| schedule.archipelago.migration.exchange = ExchangeMode::Async)
    };
    assert_all_happened(
        &(0..schedules).into_par_iter().map(drawn).reduce(Tally::new, add),
        &HAPPENINGS_ASYNC,
        schedules,
    );
}

fn assert_all_happened(tally: &Tally, happenings: &[&str], schedules: u64) {
    for happening in happenings {
        let often = tally.get(happening).copied().unwrap_or(0);
        assert!(often >= schedules / 100, "{happening}: hardly ever, in {tally:#?}");
    }
    eprintln!("{schedules} schedules: {tally:#?}");
}

/// Tries the schedule that a seed draws, changed, and returns what happened in it.
fn try_schedule(seed: u64, change: impl Fn(&mut Schedule)) -> Tally {
    let _name = NameOnPanic(seed);
    let mut rng = Source { seed, island: 0 }.stream(0, 0, Purpose::Genesis);
    let mut schedule = draw(&mut rng);
    change(&mut schedule);
    let mut world = World::new(&schedule, rng);
    let islands = world.run(DEADLINE).expect("every protocol ends");
    let Schedule { archipelago, generations, .. } = &schedule;
    let reference = match archipelago.migration.exchange {
        ExchangeMode::Sync => lockstep::run(&Toy, archipelago, *generations, |_| ()),
        ExchangeMode::Async => {
            let records = world.records();
            lockstep::replay(&Toy, &Founders::NONE, archipelago, *generations, &records, |_| ())
                .unwrap()
        }
    };
    assert_eq!(Digest::of(&islands), Digest::of(&reference), "{schedule:#?}");
    assert_eq!(islands, reference, "{schedule:#?}");
    world.tally
}

/// Says which schedule it was that failed, wherever it did.
struct NameOnPanic(u64);

impl Drop for NameOnPanic {
    fn drop(&mut self) {
        if std::thread::panicking() {
            eprintln!("schedule {} failed", self.0);
        }
    }
}

fn add(mut sum: Tally, more: Tally) -> Tally {
    for (what, often) in more {
        *sum.entry(what).or_default() += often;
    }
    sum
}

fn draw(rng: &mut Stream) -> Schedule {
    let migration = Migration {
        interval: rng.random_range(1..=4),
        migrants: rng.random_range(0..=3),
        lag: rng.random_range(0..=3),
        ..Migration::default()
    };
    let islands = rng.random_range(1..=5);
    Schedule {
        archipelago: archipelago(islands, rng.random_range(0..1_000), migration),
        generations: rng.random_range(0..=20),
        weather: Weather {
            loss: one_of(rng, [0.0, 0.1, 0.6]),
            repetition: one_of(rng, [0.0, 0.1, 0.6]),
            delay_ms_max: one_of(rng, [0, 5, 300]),
            room: one_of(rng, [1, 2, 8, 64]),
        },
        checkpoint_interval: rng.random_range(1..=4),
        history: rng.random_range(0..=8),
        window: one_of(rng, [1, 3, WINDOW]),
        death: one_of(rng, [0.0, 0.02, 0.2]),
        deaths_max: rng.random_range(0..=20),
        contagion: one_of(rng, [0.0, 0.2, 0.8]),
        damage: one_of(rng, [0.0, 0.2, 0.7]),
        pause_ms_max: one_of(rng, [5, 50]),
    }
}

fn one_of<T: Copy, const N: usize>(rng: &mut Stream, choices: [T; N]) -> T {
    *choices.choose(rng).expect("there is something to choose from")
}

/// A pair that exchanges after every generation, without a lag.
fn pair() -> Archipelago {
    archipelago(2, 1, Migration { interval: 1, migrants: 1, lag: 0, ..Migration::default() })
}

fn outbox(epoch: u32) -> Outbox<Bit> {
    Outbox { island: 0, epoch, migrants: Vec::new() }
}

fn ask(epoch: u32) -> Action<Bit> {
    Action::Ask { sources: vec![0], epoch }
}

#[test]
fn an_island_asks_when_its_patience_is_at_an_end_and_again_each_time() {
    let pair = pair();
    let mut protocol = Protocol::begin(&Toy, &pair, 1, 9, None);
    assert_eq!((protocol.island(), protocol.waits_for()), (None, None));
    let start = Duration::from_secs(77);
    let early = PATIENCE - Duration::from_nanos(1);
    for generation in [0, 1] {
        let Action::Evolved(step) = protocol.advance(start) else { panic!("it need not wait") };
        assert_eq!(step.report.generation, generation);
    }
    assert_eq!(protocol.waits_for(), Some((0, vec![0])));
    assert_eq!(protocol.advance(start), Action::Wait);
    assert_eq!(protocol.advance(start + early), Action::Wait);
    assert_eq!(protocol.receive(outbox(1)), Arrival::Kept);
    assert_eq!(protocol.advance(start + PATIENCE), ask(0), "another epoch is no help");
    assert_eq!(protocol.advance(start + PATIENCE + early), Action::Wait);
    assert_eq!(protocol.advance(start + 2 * PATIENCE), ask(0));
    assert_eq!(protocol.receive(outbox(0)), Arrival::Kept);
    for _ in [0, 1] {
        assert!(matches!(protocol.advance(start + 3 * PATIENCE), Action::Evolved(_)));
    }
    assert_eq!(protocol.advance(start + 9 * PATIENCE), Action::Wait, "each wait begins anew");
}

#[test]
fn a_reborn_island_asks_at_once_but_only_once() {
    let pair = pair();
    let saved = lockstep::run(&Toy, &pair, 5, |_| ()).pop();
    let mut protocol = Protocol::begin(&Toy, &pair, 1, 9, saved);
    assert_eq!(protocol.receive(outbox(3)), Arrival::Stale);
    assert_eq!(protocol.advance(Duration::ZERO), ask(4));
    assert_eq!(protocol.advance(Duration::ZERO), Action::Wait);
}

#[test]
fn an_island_that_has_arrived_stays_there() {
    let pair = pair();
    let saved = lockstep::run(&Toy, &pair, 5, |_| ()).pop();
    for generations in [4, 5] {
        let mut protocol = Protocol::begin(&Toy, &pair, 1, generations, saved.clone());
        assert_eq!(protocol.advance(Duration::ZERO), Action::Arrived);
        assert_eq!((protocol.island(), protocol.waits_for()), (saved.as_ref(), None));
    }
}
