//! Trials from their beginning to their end.

use super::assembly::{Assembly, Entrant};
use super::attempt::{Attempt, Observer};
use super::engine::Engine;
use super::featherstone::{FeatherstoneWorld, Relief, Separate};
use super::measurement::Measurement;
use super::rapier::RapierWorld;
use super::terrain::Ground;
use super::trajectory::{FRAMES_PER_S, Trajectory};
use super::trial::Trial;
use super::world::{self, Stepper, World};
use crate::creature::Creature;
use crate::simulation::failure::Failure;
use std::sync::Arc;

/// Tries a creature.
///
/// # Errors
/// If the body blows up, how.
pub fn simulate(
    creature: &Creature,
    trial: &Trial,
    engine: Engine,
) -> Result<Measurement, Failure> {
    run(creature, trial, engine, &mut ())
}

/// Tries a creature and films it: the same simulation, bit for bit, whether filmed or not. A trial that
/// blows up ends the film where it did.
pub fn film(
    creature: &Creature,
    trial: &Trial,
    engine: Engine,
) -> (Result<Measurement, Failure>, Trajectory) {
    let mut camera = Camera::new(&Entrant::all(creature, trial), trial);
    let result = run(creature, trial, engine, &mut camera);
    (result, camera.trajectory)
}

/// What several bodies do to each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Meeting {
    /// They pass through each other: each does what it does alone.
    Pass,
    /// They collide.
    Collide,
}

/// Whether an engine can do a trial as it is meant.
///
/// # Errors
/// If there is something to collide with, and it lets no bodies collide.
pub fn check(engine: Engine, trial: &Trial) -> Result<(), CannotCollide> {
    match trial.others.is_empty() || engine.lets_bodies_collide() {
        true => Ok(()),
        false => Err(CannotCollide { engine }),
    }
}

/// An engine cannot do what is asked of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error(
    "bodies do not collide in {engine}: choose engine {}, or let them pass through each other",
    colliding()
)]
pub struct CannotCollide {
    /// The engine.
    pub engine: Engine,
}

/// The engines in which bodies collide, by name.
fn colliding() -> String {
    let engines = Engine::ALL.into_iter().filter(|engine| engine.lets_bodies_collide());
    engines.map(|engine| engine.to_string()).collect::<Vec<_>>().join(" or ")
}

/// Tries several bodies in one world, and none of the trial's others, and films them; the measurements are in their order. The first body that blows
/// up ends the trial for all. Bodies that collide push each other, so that no ledger of their momentum is kept.
///
/// # Errors
/// If the engine lets no bodies collide and these shall.
pub fn film_together(
    entrants: &[Entrant],
    trial: &Trial,
    meeting: Meeting,
    engine: Engine,
) -> Result<(Result<Vec<Measurement>, Failure>, Trajectory), CannotCollide> {
    let collide = meeting == Meeting::Collide;
    if collide && !engine.lets_bodies_collide() {
        return Err(CannotCollide { engine });
    }
    let mut camera = Camera::new(entrants, trial);
    let result = run_together(entrants, trial, meeting, engine, &mut camera);
    Ok((result, camera.trajectory))
}

fn run_together(
    entrants: &[Entrant],
    trial: &Trial,
    meeting: Meeting,
    engine: Engine,
    observer: &mut impl Observer,
) -> Result<Vec<Measurement>, Failure> {
    let collide = meeting == Meeting::Collide;
    let mut trial = trial.clone();
    trial.guards.keeps_ledger &= !collide;
    let assembly = Assembly::together(entrants, &trial);
    let creatures: Vec<&Creature> = entrants.iter().map(|entrant| entrant.creature).collect();
    match (engine, &trial.ground) {
        (Engine::Rapier, _) => {
            let world = RapierWorld::of_several(&assembly, &trial, collide);
            run_in(world, assembly, &creatures, &trial, observer)
        }
        (Engine::Featherstone, Ground::Plane) => {
            let world = Separate::new(&assembly, |body| FeatherstoneWorld::new(body, &trial));
            run_in(world, assembly, &creatures, &trial, observer)
        }
        (Engine::Featherstone, Ground::Terrain(terrain)) => {
            let on =
                |body: &Assembly| FeatherstoneWorld::on(Relief(Arc::clone(terrain)), body, &trial);
            let world = Separate::new(&assembly, on);
            run_in(world, assembly, &creatures, &trial, observer)
        }
    }
}

struct Camera<'a> {
    trajectory: Trajectory,
    every: u32,
    trial: &'a Trial,
}

impl<'a> Camera<'a> {
    fn new(entrants: &[Entrant], trial: &'a Trial) -> Self {
        let bodies = entrants.iter().map(|entrant| entrant.creature);
        let trajectory = Trajectory::new(bodies, trial.settle_s, trial.ground.clone());
        Self { trajectory, every: trial.steps_in(1.0 / FRAMES_PER_S), trial }
    }
}

impl Observer for Camera<'_> {
    fn observe(&mut self, step: u32, world: &impl World, assembly: &Assembly) {
        if step == 0 {
            self.trajectory.clear();
        }
        if step.is_multiple_of(self.every) {
            self.trajectory.push(self.trial.time_s(step), world::poses(world, assembly));
        }
    }
}

fn run(
    creature: &Creature,
    trial: &Trial,
    engine: Engine,
    observer: &mut impl Observer,
) -> Result<Measurement, Failure> {
    if !trial.others.is_empty() {
        let meeting = if engine.lets_bodies_collide() { Meeting::Collide } else { Meeting::Pass };
        let entrants = Entrant::all(creature, trial);
        let measured = run_together(&entrants, trial, meeting, engine, observer);
        return measured.map(Measurement::of_first);
    }
    let assembly = Assembly::new(creature, trial);
    let creatures = [creature];
    let measured = match (engine, &trial.ground) {
        (Engine::Rapier, _) => {
            run_in(RapierWorld::new(&assembly, trial), assembly, &creatures, trial, observer)
        }
        (Engine::Featherstone, Ground::Plane) => {
            run_in(FeatherstoneWorld::new(&assembly, trial), assembly, &creatures, trial, observer)
        }
        (Engine::Featherstone, Ground::Terrain(terrain)) => {
            let world = FeatherstoneWorld::on(Relief(Arc::clone(terrain)), &assembly, trial);
            run_in(world, assembly, &creatures, trial, observer)
        }
    };
    measured.map(Measurement::of_first)
}

fn run_in(
    mut world: impl Stepper,
    assembly: Assembly,
    creatures: &[&Creature],
    trial: &Trial,
    observer: &mut impl Observer,
) -> Result<Vec<Measurement>, Failure> {
    let mut attempt = Attempt::new(&world, assembly, creatures, trial, observer);
    loop {
        attempt.prepare(&mut world);
        let stepped = world.step();
        if let Some(result) = attempt.go_on(stepped, &mut world, observer) {
            return result;
        }
    }
}
