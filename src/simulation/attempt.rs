//! A trial under way: what happens to the bodies after each step, until it has come to its end.

use super::assembly::Assembly;
use super::measurement::Measurement;
use super::medium::Medium;
use super::scored::Scored;
use super::settling::{self, Calm};
use super::stability::Guard;
use super::surroundings;
use super::trial::Trial;
use super::world::{self, World};
use crate::creature::Creature;
use crate::simulation::failure::Failure;
use nalgebra::Vector3;

/// Who watches a trial.
pub trait Observer {
    /// Sees the world after a step; step 0 is a beginning, and what was seen before is not to be kept.
    fn observe(&mut self, step: u32, world: &impl World, assembly: &Assembly);
}

impl Observer for () {
    fn observe(&mut self, _: u32, _: &impl World, _: &Assembly) {}
}

/// A trial under way.
pub struct Attempt<'a> {
    creatures: Vec<&'a Creature>,
    trial: &'a Trial,
    assembly: Assembly,
    /// Of each body.
    guards: Vec<Guard>,
    /// Steps since the last beginning.
    step: u32,
    /// Where each root was after the very first step.
    roots_first_m: Vec<Vector3<f64>>,
    phase: Phase,
}

enum Phase {
    Settling { round: u32, calm: Calm },
    Scored { steps: u32, bodies: Vec<Scored> },
}

impl<'a> Attempt<'a> {
    /// A trial before its first step, of the creatures that an assembly is of.
    pub fn new(
        world: &impl World,
        assembly: Assembly,
        creatures: &[&'a Creature],
        trial: &'a Trial,
        observer: &mut impl Observer,
    ) -> Self {
        observer.observe(0, world, &assembly);
        let bodies = creatures.iter().zip(&assembly.bodies);
        let guard =
            |(creature, body): (&&Creature, _)| Guard::new(&assembly, body, creature, trial);
        let guards = bodies.map(guard).collect();
        let mut attempt = Self {
            creatures: creatures.to_vec(),
            trial,
            assembly,
            guards,
            step: 0,
            roots_first_m: Vec::new(),
            phase: Phase::Settling { round: 1, calm: Calm::new(trial) },
        };
        if trial.steps_in_exactly(trial.settle_s) == 0 {
            attempt.begin_scoring(world);
        }
        attempt
    }

    /// Lets the medium act before a step.
    pub fn prepare(&self, world: &mut impl World) {
        if self.trial.medium != Medium::Void {
            surroundings::act(self.trial.medium, world, &self.assembly);
        }
    }

    /// Goes on after a step; at the end, what was measured of each body or why it could not be.
    pub fn go_on(
        &mut self,
        stepped: Result<(), Failure>,
        world: &mut impl World,
        observer: &mut impl Observer,
    ) -> Option<Result<Vec<Measurement>, Failure>> {
        self.follow(stepped, world, observer).transpose()
    }

    fn follow(
        &mut self,
        stepped: Result<(), Failure>,
        world: &mut impl World,
        observer: &mut impl Observer,
    ) -> Result<Option<Vec<Measurement>>, Failure> {
        stepped?;
        self.step += 1;
        if self.roots_first_m.is_empty() {
            let bodies = self.assembly.bodies.iter();
            let root = |body| world::root_position(world, &self.assembly, body);
            self.roots_first_m = bodies.map(root).collect();
        }
        observer.observe(self.step, world, &self.assembly);
        match &self.phase {
            Phase::Settling { .. } => {
                self.settle(world, observer)?;
                Ok(None)
            }
            Phase::Scored { .. } => {
                let is_over = self.score(world)?;
                Ok(is_over.then(|| self.measurements(world)))
            }
        }
    }

    /// Lets the bodies come to rest. A film shows the last round.
    fn settle(
        &mut self,
        world: &mut impl World,
        observer: &mut impl Observer,
    ) -> Result<(), Failure> {
        let Phase::Settling { round, calm } = &mut self.phase else { return Ok(()) };
        calm.observe(world, self.assembly.parts.len());
        if self.step < self.trial.steps_in_exactly(self.trial.settle_s) {
            return Ok(());
        }
        let (round, is_rest) = (*round, calm.is_rest());
        for (guard, body) in self.guards.iter().zip(&self.assembly.bodies) {
            guard.check(world, &self.assembly, body)?;
        }
        if is_rest || round == settling::ROUNDS_MAX {
            world.halt();
            self.begin_scoring(world);
        } else {
            self.phase = Phase::Settling { round: round + 1, calm: Calm::new(self.trial) };
            self.step = 0;
            observer.observe(0, world, &self.assembly);
        }
        Ok(())
    }

    fn begin_scoring(&mut self, world: &impl World) {
        let bodies = self.creatures.iter().zip(&self.assembly.bodies);
        let scored = bodies
            .map(|(creature, body)| Scored::new(world, &self.assembly, body, creature, self.trial));
        self.phase = Phase::Scored { steps: 0, bodies: scored.collect() };
    }

    /// Goes on after a step that is scored; whether it was the last.
    fn score(&mut self, world: &mut impl World) -> Result<bool, Failure> {
        let Phase::Scored { steps, bodies } = &mut self.phase else { return Ok(false) };
        for ((scored, guard), body) in
            bodies.iter_mut().zip(&self.guards).zip(&self.assembly.bodies)
        {
            scored.follow(*steps, self.trial, guard, &self.assembly, body, world)?;
        }
        *steps += 1;
        Ok(*steps == self.trial.steps_in_exactly(self.trial.scored_s))
    }

    fn measurements(&mut self, world: &impl World) -> Vec<Measurement> {
        let Phase::Scored { bodies: scored, .. } = &mut self.phase else { return Vec::new() };
        let measurement = |(index, scored): (usize, &mut Scored)| {
            let (body, root_first_m) = (&self.assembly.bodies[index], self.roots_first_m[index]);
            scored.measurement(world, &self.assembly, body, root_first_m, self.creatures[index])
        };
        scored.iter_mut().enumerate().map(measurement).collect()
    }
}
