//! Trials of one body abreast, as many at a time as the processor has lanes.
//!
//! Each has its own steps and comes to its end on its own; the next one takes its place. What a trial comes to has the
//! same bits whatever went beside it, on whatever processor.

use super::assembly::Assembly;
use super::attempt::Attempt;
use super::engine::Engine;
use super::featherstone::{FeatherstoneWorld, Footing, Plane, Relief};
use super::lanes::width::{Alone, Avx2, Avx512, Width, avx2, avx512};
use super::measurement::Measurement;
use super::run::simulate;
use super::terrain::Ground;
use super::trial::Trial;
use crate::creature::Creature;
use crate::simulation::failure::Failure;
use std::sync::{Arc, OnceLock};

/// How many trials go at a time.
#[derive(Debug, Clone, Copy)]
pub enum Abreast {
    /// One, on any processor.
    One,
    /// Four, with AVX2.
    Four(Avx2),
    /// Eight, with AVX-512.
    Eight(Avx512),
}

impl Abreast {
    /// Every number that this machine's processor serves, the best one last.
    pub fn here() -> Vec<Self> {
        let wide = [avx2().map(Abreast::Four), avx512().map(Abreast::Eight)];
        [Abreast::One].into_iter().chain(wide.into_iter().flatten()).collect()
    }

    /// The best for this machine's processor. With debug assertions it is one, so that golden runs of a debug build
    /// hold the narrowest against the widest of the release build.
    pub fn of_this_machine() -> Self {
        static FOUND: OnceLock<Abreast> = OnceLock::new();
        *FOUND.get_or_init(|| match Self::here().pop() {
            Some(best) if !cfg!(debug_assertions) => best,
            _ => Abreast::One,
        })
    }

    /// So many trials.
    pub fn lanes(self) -> usize {
        match self {
            Abreast::One => 1,
            Abreast::Four(_) => 4,
            Abreast::Eight(_) => 8,
        }
    }
}

/// So many trials on a ground are best given to [`simulate_each`] at a time.
pub fn at_a_time(engine: Engine, ground: &Ground) -> usize {
    match (engine, ground) {
        (Engine::Featherstone, Ground::Plane) => Abreast::of_this_machine().lanes(),
        _ => 1,
    }
}

/// Tries a creature in each of some trials on the same ground, and returns what was measured in their order.
pub fn simulate_each(
    creature: &Creature,
    trials: &[Trial],
    engine: Engine,
) -> Vec<Result<Measurement, Failure>> {
    let one_by_one = || trials.iter().map(|trial| simulate(creature, trial, engine)).collect();
    match engine {
        Engine::Rapier => one_by_one(),
        Engine::Featherstone if trials.iter().any(|trial| !trial.others.is_empty()) => one_by_one(),
        Engine::Featherstone if trials.len() == 1 => {
            simulate_abreast(creature, trials, Abreast::One)
        }
        Engine::Featherstone => simulate_abreast(creature, trials, Abreast::of_this_machine()),
    }
}

/// Tries a creature alone in our own engine, with so many trials at a time; on a terrain with one, since there more are no
/// faster.
pub fn simulate_abreast(
    creature: &Creature,
    trials: &[Trial],
    abreast: Abreast,
) -> Vec<Result<Measurement, Failure>> {
    match (trials.first().map(|trial| &trial.ground), abreast) {
        (None, _) => Vec::new(),
        (Some(Ground::Terrain(terrain)), _) => {
            Batch::new(Alone, Relief(Arc::clone(terrain)), creature, trials).run()
        }
        (Some(Ground::Plane), Abreast::One) => Batch::new(Alone, Plane, creature, trials).run(),
        (Some(Ground::Plane), Abreast::Four(avx2)) => {
            Batch::new(avx2, Plane, creature, trials).run()
        }
        (Some(Ground::Plane), Abreast::Eight(avx512)) => {
            Batch::new(avx512, Plane, creature, trials).run()
        }
    }
}

/// Trials under way.
struct Batch<'a, G: Footing<W>, W: Width> {
    creature: &'a Creature,
    trials: &'a [Trial],
    /// The first trial that was not begun yet.
    next: usize,
    worlds: FeatherstoneWorld<G, W>,
    /// Which trial goes on in each world.
    attempts: Vec<Option<(usize, Attempt<'a>)>>,
    results: Vec<Option<Result<Measurement, Failure>>>,
}

impl<'a, G: Footing<W>, W: Width> Batch<'a, G, W> {
    fn new(width: W, footing: G, creature: &'a Creature, trials: &'a [Trial]) -> Self {
        let assembly = Assembly::new(creature, &trials[0]);
        let mut batch = Self {
            creature,
            trials,
            next: 0,
            worlds: FeatherstoneWorld::empty(width, footing, &assembly, &trials[0]),
            attempts: (0..W::LANES).map(|_| None).collect(),
            results: trials.iter().map(|_| None).collect(),
        };
        (0..W::LANES).for_each(|lane| batch.begin(lane));
        batch
    }

    /// Begins the next trial in a world, if there is one left.
    fn begin(&mut self, lane: usize) {
        let Some(trial) = self.trials.get(self.next) else {
            self.worlds.take(lane);
            return;
        };
        let assembly = Assembly::new(self.creature, trial);
        self.worlds.put(lane, &assembly, trial);
        let world = self.worlds.lane(lane);
        let attempt = Attempt::new(&world, assembly, &[self.creature], trial, &mut ());
        self.attempts[lane] = Some((self.next, attempt));
        self.next += 1;
    }

    fn run(mut self) -> Vec<Result<Measurement, Failure>> {
        while self.attempts.iter().any(Option::is_some) {
            self.prepare();
            self.worlds.step_all();
            (0..W::LANES).for_each(|lane| self.go_on(lane));
        }
        let results = self.results.into_iter();
        results.map(|result| result.expect("every trial came to its end")).collect()
    }

    fn prepare(&mut self) {
        for (lane, attempt) in self.attempts.iter().enumerate() {
            if let Some((_, attempt)) = attempt {
                attempt.prepare(&mut self.worlds.lane(lane));
            }
        }
    }

    fn go_on(&mut self, lane: usize) {
        let Some((index, attempt)) = &mut self.attempts[lane] else { return };
        let mut world = self.worlds.lane(lane);
        let stepped = world.check();
        if let Some(result) = attempt.go_on(stepped, &mut world, &mut ()) {
            self.results[*index] = Some(result.map(Measurement::of_first));
            self.attempts[lane] = None;
            self.begin(lane);
        }
    }
}
