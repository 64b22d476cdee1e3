//! Bodies in motion: a trial under an engine.
//!
//! A [`Trial`] says how a body is tried and [`assembly`] what physics sees of it. An [`Engine`] moves it through
//! the [`world`], [`Engine::Rapier`] or [`Engine::Featherstone`]. [`actuator`] plays its motors, [`settling`] brings
//! it to rest on the [`terrain`] before it is scored, [`stability`] ends what has blown up, [`trajectory`] is what can
//! be seen of it. [`perturbation`] says what may differ from one trial of a body to the next. [`simulate`] runs it and
//! returns what was measured; what of that is worth how much is for a task to say. An attempt is a trial under way,
//! and several of one body go abreast, which is faster and changes no bit.

mod abreast;
pub mod actuator;
pub mod assembly;
mod attempt;
pub mod engine;
mod featherstone;
mod lanes;
pub mod lattice;
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
pub use trial::{Guards, Start, Trial};

use crate::creature::Creature;
use crate::evolution::Outcome;
pub use abreast::{Abreast, at_a_time, simulate_abreast, simulate_each};
use assembly::Assembly;
use attempt::{Attempt, Observer};
use featherstone::{FeatherstoneWorld, Relief};
use nalgebra::{Isometry3, Vector2, Vector3};
use rapier::RapierWorld;
use world::{Stepper, World};

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
    /// Where every part was at the same moments: a list a moment, in the order of the body's [`assembly`].
    pub poses: Vec<Vec<Isometry3<f64>>>,
    /// How far the body reaches from its root at rest, in metres.
    pub extent_m: f64,
}

/// Positions on the track of the centre of mass are this far apart, in seconds.
pub const TRACK_SAMPLE_S: f64 = 0.1;

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
            run_in(RapierWorld::new(&assembly, trial), assembly, creature, trial, observer)
        }
        (Engine::Featherstone, Ground::Plane) => {
            run_in(FeatherstoneWorld::new(&assembly, trial), assembly, creature, trial, observer)
        }
        (Engine::Featherstone, Ground::Terrain(terrain)) => {
            let world = FeatherstoneWorld::on(Relief(terrain), &assembly, trial);
            run_in(world, assembly, creature, trial, observer)
        }
    }
}

fn run_in(
    mut world: impl Stepper,
    assembly: Assembly,
    creature: &Creature,
    trial: &Trial,
    observer: &mut impl Observer,
) -> Result<Measurement, Outcome> {
    let mut attempt = Attempt::new(&world, assembly, creature, trial, observer);
    loop {
        let stepped = world.step();
        if let Some(result) = attempt.go_on(stepped, &mut world, observer) {
            return result;
        }
    }
}
