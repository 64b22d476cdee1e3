//! Bodies in motion: a trial under an engine.
//!
//! A [`Trial`] says how a body is tried and [`assembly`] what physics sees of it. An [`Engine`] moves it through
//! the [`world`], [`Engine::Rapier`] or [`Engine::Featherstone`]. [`actuator`] plays its motors,
//! [`stability`] ends what has blown up, [`trajectory`] is what can be seen of it. [`simulate`] runs it and
//! returns what was measured; what of that is worth how much is for a task to say.

pub mod actuator;
pub mod assembly;
pub mod engine;
mod featherstone;
mod rapier;
pub mod stability;
pub mod trajectory;
pub mod trial;
pub mod world;

pub use engine::Engine;
pub use trajectory::{Pose, Trajectory};
pub use trial::{Start, Trial};

use crate::creature::Creature;
use crate::evolution::Outcome;
use actuator::Actuators;
use assembly::Assembly;
use featherstone::FeatherstoneWorld;
use nalgebra::{Vector2, Vector3};
use rapier::RapierWorld;
use stability::{Guard, Ledger};
use world::World;

/// What was measured in a trial that ran to its end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measurement {
    /// The root's position after the very first step, in metres.
    pub root_first_m: Vector3<f64>,
    /// The root's position at the end, in metres.
    pub root_last_m: Vector3<f64>,
    /// The centre of mass when scoring began, in metres.
    pub centre_first_m: Vector3<f64>,
    /// The centre of mass at the end, in metres.
    pub centre_last_m: Vector3<f64>,
    /// The length of the horizontal path of the centre of mass while scoring, in metres, from positions
    /// 0.1 s apart: trembling in place is not travelling.
    pub path_m: f64,
}

/// Tries a creature.
///
/// # Errors
/// If the body blows up, how.
pub fn simulate(
    creature: &Creature,
    trial: &Trial,
    engine: Engine,
) -> Result<Measurement, Outcome> {
    run(creature, trial, engine, &mut ())
}

/// Tries a creature and films it: the same simulation, bit for bit, whether filmed or not. A trial that
/// blows up ends the film where it did.
pub fn film(
    creature: &Creature,
    trial: &Trial,
    engine: Engine,
) -> (Result<Measurement, Outcome>, Trajectory) {
    let every = trial.steps_in(1.0 / trajectory::FRAMES_PER_S);
    let trajectory = Trajectory::new(creature, trial.settle_s);
    let mut camera = Camera { trajectory, every, trial };
    let result = run(creature, trial, engine, &mut camera);
    (result, camera.trajectory)
}

/// Who watches a trial.
trait Observer {
    /// Sees the world after a step; step 0 is the beginning.
    fn observe(&mut self, step: u32, world: &impl World, assembly: &Assembly);
}

impl Observer for () {
    fn observe(&mut self, _: u32, _: &impl World, _: &Assembly) {}
}

struct Camera<'a> {
    trajectory: Trajectory,
    every: u32,
    trial: &'a Trial,
}

impl Observer for Camera<'_> {
    fn observe(&mut self, step: u32, world: &impl World, assembly: &Assembly) {
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
) -> Result<Measurement, Outcome> {
    let assembly = Assembly::new(creature, trial);
    match engine {
        Engine::Rapier => {
            Attempt::new(RapierWorld::new(&assembly, trial), &assembly, creature, observer)
                .run(creature, trial)
        }
        Engine::Featherstone => {
            Attempt::new(FeatherstoneWorld::new(&assembly, trial), &assembly, creature, observer)
                .run(creature, trial)
        }
    }
}

/// Positions that the path is measured from are this far apart, in seconds.
const PATH_SAMPLE_S: f64 = 0.1;

/// A trial under way.
struct Attempt<'a, W, O> {
    world: W,
    assembly: &'a Assembly,
    guard: Guard,
    step: u32,
    root_first_m: Vector3<f64>,
    observer: &'a mut O,
}

impl<'a, W: World, O: Observer> Attempt<'a, W, O> {
    fn new(world: W, assembly: &'a Assembly, creature: &Creature, observer: &'a mut O) -> Self {
        let guard = Guard::new(assembly, creature);
        let root_first_m = world::root_position(&world, assembly);
        observer.observe(0, &world, assembly);
        Self { world, assembly, guard, step: 0, root_first_m, observer }
    }

    fn run(mut self, creature: &Creature, trial: &Trial) -> Result<Measurement, Outcome> {
        for _ in 0..trial.steps_in_exactly(trial.settle_s) {
            self.advance()?;
        }
        let centre_first_m = self.centre_of_mass();
        let path_steps = trial.steps_in(PATH_SAMPLE_S);
        let mut path = Path::from(centre_first_m);
        let mut ledger = Ledger::new(trial, path_steps, centre_first_m);
        let control_steps = trial.steps_in(creature.controller.period_s);
        let mut actuators = Actuators::new(&creature.controller, self.assembly);
        for scored in 0..trial.steps_in_exactly(trial.scored_s) {
            self.advance()?;
            if scored.is_multiple_of(control_steps) {
                self.check()?;
                actuators.update(&mut self.world);
            }
            if (scored + 1).is_multiple_of(path_steps) {
                let centre_m = self.centre_of_mass();
                path.extend_to(centre_m);
                if trial.keeps_ledger {
                    ledger.enter(centre_m)?;
                }
            }
        }
        self.check()?;
        Ok(Measurement {
            root_first_m: self.root_first_m,
            root_last_m: world::root_position(&self.world, self.assembly),
            centre_first_m,
            centre_last_m: self.centre_of_mass(),
            path_m: path.length_m,
        })
    }

    fn advance(&mut self) -> Result<(), Outcome> {
        self.world.step()?;
        self.step += 1;
        if self.step == 1 {
            self.root_first_m = world::root_position(&self.world, self.assembly);
        }
        self.observer.observe(self.step, &self.world, self.assembly);
        Ok(())
    }

    fn check(&self) -> Result<(), Outcome> {
        self.guard.check(&self.world, self.assembly.parts.len())
    }

    fn centre_of_mass(&self) -> Vector3<f64> {
        world::centre_of_mass(&self.world, self.assembly)
    }
}

/// A horizontal path, measured as it is walked.
struct Path {
    at: Vector2<f64>,
    length_m: f64,
}

impl From<Vector3<f64>> for Path {
    fn from(start: Vector3<f64>) -> Self {
        Self { at: start.xy(), length_m: 0.0 }
    }
}

impl Path {
    fn extend_to(&mut self, position: Vector3<f64>) {
        self.length_m += (position.xy() - self.at).norm();
        self.at = position.xy();
    }
}
