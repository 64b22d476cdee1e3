//! Bodies in motion: a trial under an engine.
//!
//! A [`Trial`] says how a body is tried and [`assembly`] what physics sees of it. An [`Engine`] moves it through
//! the [`world`], [`Engine::Rapier`] or [`Engine::Featherstone`]. [`actuator`] plays its motors, [`settling`] brings
//! it to rest on the [`terrain`] before it is scored, [`stability`] ends what has blown up, [`trajectory`] is what can
//! be seen of it. [`perturbation`] says what may differ from one trial of a body to the next. [`simulate`] runs it and
//! returns what was measured; what of that is worth how much is for a task to say.

pub mod actuator;
pub mod assembly;
pub mod engine;
mod featherstone;
pub mod perturbation;
mod rapier;
pub mod settling;
pub mod stability;
pub mod terrain;
#[cfg(test)]
mod tests;
pub mod trajectory;
pub mod trial;
pub mod world;

pub use engine::Engine;
pub use perturbation::Perturbation;
pub use terrain::{Ground, Terrain};
pub use trajectory::{Pose, Trajectory};
pub use trial::{Start, Trial};

use crate::creature::Creature;
use crate::evolution::Outcome;
use actuator::Actuators;
use assembly::Assembly;
use featherstone::{FeatherstoneWorld, Relief};
use nalgebra::{Vector2, Vector3};
use rapier::RapierWorld;
use settling::Calm;
use stability::{Guard, Ledger};
use world::World;

/// What was measured in a trial that ran to its end.
#[derive(Debug, Clone, PartialEq)]
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
    /// 0.1 s apart.
    pub path_m: f64,
    /// Where the centre of mass was above the ground, in metres: when scoring began, and every
    /// [`TRACK_SAMPLE_S`] since.
    pub track_m: Vec<Vector2<f64>>,
    /// On a terrain, the height of the body's lowest point at the same moments, but at most that of the ground below
    /// its centre of mass, in metres: what is in the air, or leans on a wall, is no higher than what it is above.
    pub heights_m: Vec<f64>,
    /// How far the body reaches from its root at rest, in metres.
    pub extent_m: f64,
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
    let trajectory = Trajectory::new(creature, trial.settle_s, trial.ground);
    let mut camera = Camera { trajectory, every, trial };
    let result = run(creature, trial, engine, &mut camera);
    (result, camera.trajectory)
}

/// Who watches a trial.
trait Observer {
    /// Sees the world after a step; step 0 is a beginning, and what was seen before is not to be kept.
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
) -> Result<Measurement, Outcome> {
    let assembly = Assembly::new(creature, trial);
    match (engine, trial.ground) {
        (Engine::Rapier, _) => {
            let world = RapierWorld::new(&assembly, trial);
            Attempt::new(world, &assembly, creature, trial, observer).run(creature, trial)
        }
        (Engine::Featherstone, Ground::Plane) => {
            let world = FeatherstoneWorld::new(&assembly, trial);
            Attempt::new(world, &assembly, creature, trial, observer).run(creature, trial)
        }
        (Engine::Featherstone, Ground::Terrain(terrain)) => {
            let world = FeatherstoneWorld::on(Relief(terrain), &assembly, trial);
            Attempt::new(world, &assembly, creature, trial, observer).run(creature, trial)
        }
    }
}

/// Positions on the track of the centre of mass are this far apart, in seconds.
pub const TRACK_SAMPLE_S: f64 = 0.1;

/// A trial under way.
struct Attempt<'a, W, O> {
    world: W,
    assembly: &'a Assembly,
    ground: Ground,
    guard: Guard,
    step: u32,
    root_first_m: Option<Vector3<f64>>,
    observer: &'a mut O,
}

impl<'a, W: World, O: Observer> Attempt<'a, W, O> {
    fn new(
        world: W,
        assembly: &'a Assembly,
        creature: &Creature,
        trial: &Trial,
        observer: &'a mut O,
    ) -> Self {
        let ground = trial.ground;
        let guard = Guard::new(assembly, creature, ground);
        observer.observe(0, &world, assembly);
        Self { world, assembly, ground, guard, step: 0, root_first_m: None, observer }
    }

    fn run(mut self, creature: &Creature, trial: &Trial) -> Result<Measurement, Outcome> {
        self.settle(trial)?;
        let centre_first_m = self.centre_of_mass();
        let (sample_steps, push_step) = (trial.sample_steps(), trial.push_step());
        let mut track_m = Vec::with_capacity(trial.samples() + 1);
        track_m.push(centre_first_m.xy());
        let mut heights_m = Vec::new();
        heights_m.extend(self.height_m(&centre_first_m));
        let mut ledger = Ledger::new(trial, sample_steps, centre_first_m, Vector3::zeros());
        let control_steps = trial.steps_in(creature.controller.period_s);
        let mut actuators = Actuators::new(&creature.controller, self.assembly);
        for scored in 0..trial.steps_in_exactly(trial.scored_s) {
            self.advance()?;
            if scored.is_multiple_of(control_steps) {
                self.check()?;
                actuators.update(&mut self.world);
            }
            if (scored + 1).is_multiple_of(sample_steps) {
                let centre_m = self.centre_of_mass();
                track_m.push(centre_m.xy());
                heights_m.extend(self.height_m(&centre_m));
                if trial.keeps_ledger {
                    ledger.enter(centre_m)?;
                }
            }
            if scored + 1 == push_step {
                self.world.push(trial.perturbation.push_m_s);
                ledger.enter_push(trial.perturbation.push_m_s);
            }
        }
        self.check()?;
        Ok(Measurement {
            root_first_m: self.root_first_m.unwrap_or_default(),
            root_last_m: world::root_position(&self.world, self.assembly),
            centre_first_m,
            centre_last_m: self.centre_of_mass(),
            path_m: track_m.windows(2).map(|leg| (leg[1] - leg[0]).norm()).sum(),
            track_m,
            heights_m,
            extent_m: creature.morphology.extent_m(),
        })
    }

    /// Lets the body come to rest. A film shows the last round.
    fn settle(&mut self, trial: &Trial) -> Result<(), Outcome> {
        let steps = trial.steps_in_exactly(trial.settle_s);
        if steps == 0 {
            return Ok(());
        }
        for _ in 0..settling::ROUNDS_MAX {
            self.step = 0;
            self.observer.observe(0, &self.world, self.assembly);
            let mut calm = Calm::new(trial);
            for _ in 0..steps {
                self.advance()?;
                calm.observe(&self.world, self.assembly.parts.len());
            }
            self.check()?;
            if calm.is_rest() {
                break;
            }
        }
        self.world.halt();
        Ok(())
    }

    fn advance(&mut self) -> Result<(), Outcome> {
        self.world.step()?;
        self.step += 1;
        if self.root_first_m.is_none() {
            self.root_first_m = Some(world::root_position(&self.world, self.assembly));
        }
        self.observer.observe(self.step, &self.world, self.assembly);
        Ok(())
    }

    fn check(&self) -> Result<(), Outcome> {
        self.guard.check(&self.world, self.assembly.parts.len())?;
        match self.ground {
            Ground::Plane => Ok(()),
            Ground::Terrain(_) => self.guard.check_place(&self.centre_of_mass()),
        }
    }

    /// How high the body is on a terrain, given its centre of mass.
    fn height_m(&self, centre_m: &Vector3<f64>) -> Option<f64> {
        let below_m = self.ground.terrain()?.height_m(centre_m.x, centre_m.y);
        Some(world::lowest_m(&self.world, self.assembly).min(below_m))
    }

    fn centre_of_mass(&self) -> Vector3<f64> {
        world::centre_of_mass(&self.world, self.assembly)
    }
}
