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
    run(creature, trial, |_, _| {})
}

/// Tries a creature and films it: the same simulation, bit for bit, whether filmed or not. A trial that
/// blows up ends the film where it did.
///
/// # Errors
/// None: a film of a failure is a film.
pub fn film(creature: &Creature, trial: &Trial) -> (Result<Measurement, Outcome>, Trajectory) {
    let mut trajectory = Trajectory::new(creature, trial.settle_s);
    let every = trial.steps_in(1.0 / trajectory::FRAMES_PER_S);
    let result = run(creature, trial, |step, body| {
        if step.is_multiple_of(every) {
            trajectory.push(trial.time_s(step), body.poses());
        }
    });
    (result, trajectory)
}

/// Positions that the path is measured from are this far apart, in seconds.
const PATH_SAMPLE_S: f64 = 0.1;

fn run(
    creature: &Creature,
    trial: &Trial,
    mut observe: impl FnMut(u32, &View<'_>),
) -> Result<Measurement, Outcome> {
    let mut scene = Scene::new(trial);
    let body = Body::build(&mut scene, creature, trial);
    let mut actuators = Actuators::new(&creature.controller);
    let guard = Guard::new(&body, &scene, creature);
    observe(0, &View { body: &body, scene: &scene });

    let control_steps = trial.steps_in(creature.controller.period_s);
    let path_steps = trial.steps_in(PATH_SAMPLE_S);
    let settle_steps = trial.steps_in_exactly(trial.settle_s);
    let steps = settle_steps + trial.steps_in_exactly(trial.scored_s);

    let mut root_first_m = body.root_position(&scene);
    let mut centre_first_m = body.centre_of_mass(&scene);
    let mut path = Path::from(centre_first_m);
    let mut ledger = Ledger::new(trial, path_steps, centre_first_m);
    for step in 1..=steps {
        scene.step();
        guard.check_step(&scene)?;
        if step == 1 {
            root_first_m = body.root_position(&scene);
        }
        if step == settle_steps {
            centre_first_m = body.centre_of_mass(&scene);
            path = Path::from(centre_first_m);
            ledger = Ledger::new(trial, path_steps, centre_first_m);
        }
        let scored = step.checked_sub(settle_steps + 1);
        if scored.is_some_and(|scored| scored.is_multiple_of(control_steps)) {
            guard.check_body(&body, &scene)?;
            actuators.update(&body, &mut scene);
        }
        if scored.is_some_and(|scored| (scored + 1).is_multiple_of(path_steps)) {
            let centre_m = body.centre_of_mass(&scene);
            path.extend_to(centre_m);
            ledger.enter(centre_m)?;
        }
        observe(step, &View { body: &body, scene: &scene });
    }
    guard.check_body(&body, &scene)?;
    Ok(Measurement {
        root_first_m,
        root_last_m: body.root_position(&scene),
        centre_first_m,
        centre_last_m: body.centre_of_mass(&scene),
        path_m: path.length_m,
    })
}

/// What an observer of a trial sees.
struct View<'a> {
    body: &'a Body,
    scene: &'a Scene,
}

impl View<'_> {
    fn poses(&self) -> Vec<Pose> {
        self.body.poses(self.scene)
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
