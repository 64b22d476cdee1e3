//! Chaos: everything that can die dies, at random moments, and the run ends in the same bits.
//!
//! `ISLANDS_CHAOS_ROUNDS=100 cargo test --release chaos -- --nocapture` takes longer and says what it did.

#![expect(clippy::print_stdout, reason = "what a long round did is worth knowing")]

use crate::support::{Running, World, checkpoints, is_alive, stop, try_signal, until};
use islands::rng::Stream;
use islands::store::RunDir;
use rand::{RngExt, SeedableRng};
use std::fmt;
use std::fs;
use std::thread::sleep;
use std::time::Duration;

const ROUNDS: &str = "ISLANDS_CHAOS_ROUNDS";
const ISLANDS: u32 = 4;
const RUN: &str = "--n 4 --seed 43 --population 5 --robustness 0 --generations 14 --genes 2 --migration-interval 2";
/// Blows in a round; then the run may come to its end.
const BLOWS: usize = 14;

#[test]
fn a_run_under_a_hail_of_blows_ends_in_the_same_bits() {
    let rounds = std::env::var(ROUNDS).map_or(3, |rounds| rounds.parse().unwrap());
    let expected = World::new().digest("undisturbed", RUN);
    let mut sum = Tally::default();
    for round in 0..rounds {
        let mut chaos = Chaos::new(round);
        let digest = chaos.live_through();
        assert_eq!(digest, expected, "round {round}: {}", chaos.tally);
        sum.add(&chaos.tally);
        println!("round {round}: {}", chaos.tally);
    }
    println!("{rounds} rounds: {sum}");
    assert!(rounds == 0 || sum.kills() > 0);
}

/// What was done.
#[derive(Default)]
struct Tally {
    islands: u32,
    monitors: u32,
    launchers: u32,
    stops: u32,
    damages: u32,
}

impl Tally {
    fn kills(&self) -> u32 {
        self.islands + self.monitors + self.launchers
    }

    fn add(&mut self, other: &Tally) {
        self.islands += other.islands;
        self.monitors += other.monitors;
        self.launchers += other.launchers;
        self.stops += other.stops;
        self.damages += other.damages;
    }
}

impl fmt::Display for Tally {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{} kills ({} of islands, {} of monitors, {} of launchers), {} stops, {} damaged checkpoints",
            self.kills(),
            self.islands,
            self.monitors,
            self.launchers,
            self.stops,
            self.damages
        )
    }
}

struct Chaos {
    world: World,
    rng: Stream,
    run: Option<Running>,
    tally: Tally,
}

impl Chaos {
    fn new(round: u64) -> Self {
        let rng = Stream::seed_from_u64(round);
        Self { world: World::new(), rng, run: None, tally: Tally::default() }
    }

    /// Lives through a round, and returns the digest that the run has in the end.
    fn live_through(&mut self) -> String {
        self.run = Some(self.world.start(&format!("--out run --json --quiet {RUN}")));
        until("the run has begun", || self.dir().config().exists());
        for _ in 0..BLOWS {
            sleep(Duration::from_millis(self.rng.random_range(0..250)));
            if !self.run.as_ref().is_some_and(Running::is_alive) {
                break;
            }
            self.strike();
        }
        let ending = self.run.take().unwrap().wait();
        assert_eq!(ending.code, Some(0), "{ending:?}\n{}", self.world.read("run/run.log"));
        self.world.assert_left_nothing();
        let verified = self.world.islands("verify run");
        assert_eq!(verified.code, Some(0), "{verified:?}");
        ending.json()["digest"].as_str().unwrap().to_owned()
    }

    fn strike(&mut self) {
        match self.rng.random_range(0..100) {
            0..45 => self.kill_island(),
            45..55 => self.kill_neighbours(),
            55..65 => self.kill_monitor(),
            65..80 => self.kill_launcher(),
            80..90 => self.stop_island(),
            _ => self.damage_checkpoint(),
        }
    }

    fn dir(&self) -> RunDir {
        RunDir::at(self.world.path("run"))
    }

    fn any_island(&mut self) -> u32 {
        self.rng.random_range(0..ISLANDS)
    }

    fn find(&self, argument: &str) -> Option<u32> {
        self.run.as_ref().and_then(|run| run.find_child(argument))
    }

    fn kill_child(&mut self, argument: &str) -> u32 {
        u32::from(self.find(argument).is_some_and(|pid| try_signal(pid, "KILL")))
    }

    fn kill_island(&mut self) {
        let island = self.any_island();
        self.tally.islands += self.kill_child(&format!("--index={island}"));
    }

    fn kill_neighbours(&mut self) {
        let island = self.any_island();
        for island in [island, (island + 1) % ISLANDS] {
            self.tally.islands += self.kill_child(&format!("--index={island}"));
        }
    }

    fn kill_monitor(&mut self) {
        self.tally.monitors += self.kill_child("monitor");
    }

    fn kill_launcher(&mut self) {
        let run = self.run.take().unwrap();
        let children = run.children();
        run.signal("KILL");
        let ending = run.wait();
        until("nobody outlives the launcher", || children.iter().all(|&pid| !is_alive(pid)));
        // It may just have come to its end.
        self.tally.launchers += u32::from(ending.code.is_none());
        self.run = Some(self.world.start("resume run --json --quiet"));
    }

    fn stop_island(&mut self) {
        let island = self.any_island();
        let Some(pid) = self.find(&format!("--index={island}")) else { return };
        self.tally.stops += u32::from(stop(pid));
        sleep(Duration::from_millis(self.rng.random_range(0..300)));
        try_signal(pid, "CONT");
    }

    /// Cuts off a part of an island's newest checkpoint, or of both that it has, and kills the island over it.
    fn damage_checkpoint(&mut self) {
        let island = self.any_island();
        let Some(pid) = self.find(&format!("--index={island}")) else { return };
        // A stopped island does not write another one meanwhile, and has not come to its end.
        if !stop(pid) {
            return;
        }
        let harmed = self.rng.random_range(1..=2);
        for checkpoint in checkpoints(&self.dir(), island).into_iter().take(harmed) {
            let bytes = fs::read(&checkpoint).unwrap();
            let cut = self.rng.random_range(0..bytes.len().max(1));
            fs::write(&checkpoint, &bytes[..cut]).unwrap();
            self.tally.damages += 1;
        }
        self.tally.islands += u32::from(try_signal(pid, "KILL"));
    }
}
