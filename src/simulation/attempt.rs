//! A trial under way: what happens to a body after each step, until it has come to its end.

use super::Measurement;
use super::actuator::Actuators;
use super::assembly::Assembly;
use super::settling::{self, Calm};
use super::stability::{Guard, Ledger};
use super::terrain::Ground;
use super::trial::Trial;
use super::world::{self, World};
use crate::creature::Creature;
use crate::evolution::Outcome;
use nalgebra::{Isometry3, Vector2, Vector3};

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
    creature: &'a Creature,
    trial: Trial,
    assembly: Assembly,
    guard: Guard,
    /// Steps since the last beginning.
    step: u32,
    root_first_m: Option<Vector3<f64>>,
    phase: Phase,
}

enum Phase {
    Settling { round: u32, calm: Calm },
    Scored(Box<Scored>),
}

/// The part of a trial that is scored.
struct Scored {
    steps: u32,
    centre_first_m: Vector3<f64>,
    track_m: Vec<Vector2<f64>>,
    heights_m: Vec<f64>,
    poses: Vec<Vec<Isometry3<f64>>>,
    ledger: Ledger,
    actuators: Actuators,
}

impl<'a> Attempt<'a> {
    /// A trial before its first step.
    pub fn new(
        world: &impl World,
        assembly: Assembly,
        creature: &'a Creature,
        trial: &Trial,
        observer: &mut impl Observer,
    ) -> Self {
        observer.observe(0, world, &assembly);
        let phase = match trial.steps_in_exactly(trial.settle_s) {
            0 => Phase::Scored(Box::new(Scored::new(world, &assembly, creature, trial))),
            _ => Phase::Settling { round: 1, calm: Calm::new(trial) },
        };
        let guard = Guard::new(&assembly, creature, trial);
        let root_first_m = None;
        Self { creature, trial: *trial, assembly, guard, step: 0, root_first_m, phase }
    }

    /// Goes on after a step; at the end, what was measured or why it could not be.
    pub fn go_on(
        &mut self,
        stepped: Result<(), Outcome>,
        world: &mut impl World,
        observer: &mut impl Observer,
    ) -> Option<Result<Measurement, Outcome>> {
        self.follow(stepped, world, observer).transpose()
    }

    fn follow(
        &mut self,
        stepped: Result<(), Outcome>,
        world: &mut impl World,
        observer: &mut impl Observer,
    ) -> Result<Option<Measurement>, Outcome> {
        stepped?;
        self.step += 1;
        if self.root_first_m.is_none() {
            self.root_first_m = Some(world::root_position(world, &self.assembly));
        }
        observer.observe(self.step, world, &self.assembly);
        match &mut self.phase {
            Phase::Settling { .. } => {
                self.settle(world, observer)?;
                Ok(None)
            }
            Phase::Scored(scored) => {
                let is_over = scored.follow(&self.trial, &self.guard, &self.assembly, world)?;
                Ok(is_over.then(|| self.measurement(world)))
            }
        }
    }

    /// Lets the body come to rest. A film shows the last round.
    fn settle(
        &mut self,
        world: &mut impl World,
        observer: &mut impl Observer,
    ) -> Result<(), Outcome> {
        let Phase::Settling { round, calm } = &mut self.phase else { return Ok(()) };
        calm.observe(world, self.assembly.parts.len());
        if self.step < self.trial.steps_in_exactly(self.trial.settle_s) {
            return Ok(());
        }
        check(&self.guard, &self.assembly, &self.trial, world)?;
        if calm.is_rest() || *round == settling::ROUNDS_MAX {
            world.halt();
            let scored = Scored::new(world, &self.assembly, self.creature, &self.trial);
            self.phase = Phase::Scored(Box::new(scored));
        } else {
            self.phase = Phase::Settling { round: *round + 1, calm: Calm::new(&self.trial) };
            self.step = 0;
            observer.observe(0, world, &self.assembly);
        }
        Ok(())
    }

    fn measurement(&mut self, world: &impl World) -> Measurement {
        let Phase::Scored(scored) = &mut self.phase else { unreachable!("it was scored") };
        let track_m = std::mem::take(&mut scored.track_m);
        Measurement {
            root_first_m: self.root_first_m.unwrap_or_default(),
            root_last_m: world::root_position(world, &self.assembly),
            centre_first_m: scored.centre_first_m,
            centre_last_m: world::centre_of_mass(world, &self.assembly),
            path_m: track_m.windows(2).map(|leg| (leg[1] - leg[0]).norm()).sum(),
            track_m,
            heights_m: std::mem::take(&mut scored.heights_m),
            poses: std::mem::take(&mut scored.poses),
            extent_m: self.creature.morphology.extent_m(),
        }
    }
}

impl Scored {
    fn new(world: &impl World, assembly: &Assembly, creature: &Creature, trial: &Trial) -> Self {
        let poses = world::part_poses(world, assembly);
        let centre_first_m = world::centre_of(&poses, assembly);
        let mut track_m = Vec::with_capacity(trial.samples() + 1);
        track_m.push(centre_first_m.xy());
        let (sample_steps, standing) = (trial.sample_steps(), Vector3::zeros());
        let heights_m = height_m(&poses, assembly, trial.ground, &centre_first_m);
        Self {
            steps: 0,
            centre_first_m,
            track_m,
            heights_m: heights_m.into_iter().collect(),
            poses: vec![poses],
            ledger: Ledger::new(trial, sample_steps, centre_first_m, standing),
            actuators: Actuators::new(&creature.controller, assembly),
        }
    }

    /// Goes on after a step; whether it was the last.
    fn follow(
        &mut self,
        trial: &Trial,
        guard: &Guard,
        assembly: &Assembly,
        world: &mut impl World,
    ) -> Result<bool, Outcome> {
        if self.steps.is_multiple_of(self.actuators.control_steps(trial)) {
            check(guard, assembly, trial, world)?;
            self.actuators.update(world);
        }
        self.steps += 1;
        if self.steps.is_multiple_of(trial.sample_steps()) {
            self.sample(trial, assembly, world)?;
        }
        if self.steps == trial.push_step() {
            world.push(trial.perturbation.push_m_s);
            self.ledger.enter_push(trial.perturbation.push_m_s);
        }
        let is_over = self.steps == trial.steps_in_exactly(trial.scored_s);
        if is_over {
            check(guard, assembly, trial, world)?;
        }
        Ok(is_over)
    }

    /// Takes a position on the track.
    fn sample(
        &mut self,
        trial: &Trial,
        assembly: &Assembly,
        world: &impl World,
    ) -> Result<(), Outcome> {
        let poses = world::part_poses(world, assembly);
        let centre_m = world::centre_of(&poses, assembly);
        self.track_m.push(centre_m.xy());
        self.heights_m.extend(height_m(&poses, assembly, trial.ground, &centre_m));
        self.poses.push(poses);
        if trial.guards.keeps_ledger { self.ledger.enter(centre_m) } else { Ok(()) }
    }
}

fn check(
    guard: &Guard,
    assembly: &Assembly,
    trial: &Trial,
    world: &impl World,
) -> Result<(), Outcome> {
    guard.check(world, assembly.parts.len())?;
    match trial.ground {
        Ground::Plane => Ok(()),
        Ground::Terrain(_) => guard.check_place(&world::centre_of_mass(world, assembly)),
    }
}

/// How high the body is on a terrain, given its centre of mass.
fn height_m(
    poses: &[Isometry3<f64>],
    assembly: &Assembly,
    ground: Ground,
    centre_m: &Vector3<f64>,
) -> Option<f64> {
    let below_m = ground.terrain()?.height_m(centre_m.x, centre_m.y);
    Some(world::lowest_m(poses, assembly).min(below_m))
}
