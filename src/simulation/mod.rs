//! Bodies in motion: a trial in rapier.
//!
//! A [`Trial`] says how a body is tried: [`scene`] is the world it is put into, [`multibody`] its body there,
//! [`actuator`] plays its motors, [`stability`] ends what has blown up, [`trajectory`] is what can be seen of
//! it. [`simulate`] runs it and returns what was measured; what of that is worth how much is for a task to say.
//!
//! Architecture invariants: this alone imports rapier; every trial builds a fresh world, since a world that was
//! used before gives other bits; all is f64 up to this border and f32 within it.

pub mod actuator;
pub mod multibody;
pub mod scene;
pub mod stability;
pub mod trajectory;

pub use scene::{Start, Trial};
pub use trajectory::{Pose, Trajectory};

use crate::creature::Creature;
use crate::evolution::Outcome;
use actuator::Actuators;
use multibody::Body;
use nalgebra::{Vector2, Vector3};
use scene::Scene;
use stability::{Guard, Ledger};

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
pub fn simulate(creature: &Creature, trial: &Trial) -> Result<Measurement, Outcome> {
    run(creature, trial, |_, _, _| {})
}

/// Tries a creature and films it: the same simulation, bit for bit, whether filmed or not. A trial that
/// blows up ends the film where it did.
pub fn film(creature: &Creature, trial: &Trial) -> (Result<Measurement, Outcome>, Trajectory) {
    let mut trajectory = Trajectory::new(creature, trial.settle_s);
    let every = trial.steps_in(1.0 / trajectory::FRAMES_PER_S);
    let result = run(creature, trial, |step, body, scene| {
        if step.is_multiple_of(every) {
            trajectory.push(trial.time_s(step), body.poses(scene));
        }
    });
    (result, trajectory)
}

/// Positions that the path is measured from are this far apart, in seconds.
const PATH_SAMPLE_S: f64 = 0.1;

fn run(
    creature: &Creature,
    trial: &Trial,
    observe: impl FnMut(u32, &Body, &Scene),
) -> Result<Measurement, Outcome> {
    let mut attempt = Attempt::new(creature, trial, observe);
    for _ in 0..trial.steps_in_exactly(trial.settle_s) {
        attempt.advance()?;
    }
    let centre_first_m = attempt.centre_of_mass();
    let path_steps = trial.steps_in(PATH_SAMPLE_S);
    let mut path = Path::from(centre_first_m);
    let mut ledger = Ledger::new(trial, path_steps, centre_first_m);
    let control_steps = trial.steps_in(creature.controller.period_s);
    let mut actuators = Actuators::new(&creature.controller);
    for scored in 0..trial.steps_in_exactly(trial.scored_s) {
        attempt.advance()?;
        if scored.is_multiple_of(control_steps) {
            attempt.check()?;
            actuators.update(&attempt.body, &mut attempt.scene);
        }
        if (scored + 1).is_multiple_of(path_steps) {
            let centre_m = attempt.centre_of_mass();
            path.extend_to(centre_m);
            if trial.keeps_ledger {
                ledger.enter(centre_m)?;
            }
        }
    }
    attempt.check()?;
    Ok(Measurement {
        root_first_m: attempt.root_first_m,
        root_last_m: attempt.body.root_position(&attempt.scene),
        centre_first_m,
        centre_last_m: attempt.centre_of_mass(),
        path_m: path.length_m,
    })
}

/// A trial under way.
struct Attempt<F> {
    scene: Scene,
    body: Body,
    guard: Guard,
    step: u32,
    root_first_m: Vector3<f64>,
    observe: F,
}

impl<F: FnMut(u32, &Body, &Scene)> Attempt<F> {
    fn new(creature: &Creature, trial: &Trial, mut observe: F) -> Self {
        let mut scene = Scene::new(trial);
        let body = Body::build(&mut scene, creature, trial);
        let guard = Guard::new(&body, &scene, creature);
        let root_first_m = body.root_position(&scene);
        observe(0, &body, &scene);
        Self { scene, body, guard, step: 0, root_first_m, observe }
    }

    fn advance(&mut self) -> Result<(), Outcome> {
        self.scene.step();
        self.step += 1;
        self.guard.check_step(&self.scene)?;
        if self.step == 1 {
            self.root_first_m = self.body.root_position(&self.scene);
        }
        (self.observe)(self.step, &self.body, &self.scene);
        Ok(())
    }

    fn check(&self) -> Result<(), Outcome> {
        self.guard.check_body(&self.body, &self.scene)
    }

    fn centre_of_mass(&self) -> Vector3<f64> {
        self.body.centre_of_mass(&self.scene)
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
