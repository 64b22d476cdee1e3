//! One body in the part of a trial that is scored.

use super::assembly::{Assembly, Member};
use super::feels;
use super::measurement::{Measurement, Poses};
use super::stability::{Guard, Ledger};
use super::terrain::Ground;
use super::trial::Trial;
use super::world::{self, World};
use crate::creature::Creature;
use crate::creature::brain::{Mind, Senses};
use crate::simulation::failure::Failure;
use nalgebra::{Isometry3, Vector2, Vector3};

/// One body while it is scored.
pub struct Scored {
    centre_first_m: Vector3<f64>,
    track_m: Vec<Vector2<f64>>,
    heights_m: Vec<f64>,
    poses: Poses,
    ledger: Ledger,
    mind: Box<dyn Mind + Send>,
    /// Steps from one control update to the next.
    control_steps: u32,
    /// The links that have motors, each with the part that it drives.
    driven: Vec<(usize, usize)>,
    /// What the mind commands, by link.
    targets_rad_s: Vec<f64>,
}

impl Scored {
    /// A body when scoring begins.
    pub fn new(
        world: &impl World,
        assembly: &Assembly,
        body: &Member,
        creature: &Creature,
        trial: &Trial,
    ) -> Self {
        let parts = &assembly.parts[body.parts.clone()];
        let moments = trial.samples() + 1;
        let mut poses = Poses::new(parts.len(), moments);
        let now = poses.push(world::part_poses(world, body));
        let centre_first_m = world::centre_of(now, parts);
        let mut track_m = Vec::with_capacity(moments);
        track_m.push(centre_first_m.xy());
        let (sample_steps, standing) = (trial.sample_steps(), Vector3::zeros());
        let heights_m = height_m(now, assembly, body, &trial.ground, &centre_first_m);
        let controller = &creature.controller;
        let links = controller.motors.iter().zip(&assembly.places[body.links.clone()]).enumerate();
        let driven = links.filter_map(|(link, (motor, place))| motor.map(|_| (link, place.part)));
        Self {
            centre_first_m,
            track_m,
            heights_m: heights_m.into_iter().collect(),
            poses,
            ledger: Ledger::new(trial, sample_steps, centre_first_m, standing),
            mind: controller.awake(),
            control_steps: trial.steps_in(controller.period_s),
            driven: driven.collect(),
            targets_rad_s: vec![0.0; body.links.len()],
        }
    }

    /// Goes on after a step, before which there were so many that were scored.
    pub fn follow(
        &mut self,
        steps: u32,
        trial: &Trial,
        guard: &Guard,
        assembly: &Assembly,
        body: &Member,
        world: &mut impl World,
    ) -> Result<(), Failure> {
        if steps.is_multiple_of(self.control_steps) {
            guard.check(world, assembly, body)?;
            self.command(assembly, body, world);
        }
        let steps = steps + 1;
        if steps.is_multiple_of(trial.sample_steps()) {
            self.sample(trial, assembly, body, world)?;
        }
        if steps == trial.push_step() {
            world.push(body, trial.perturbation.push_m_s);
            self.ledger.enter_push(trial.perturbation.push_m_s);
        }
        let is_over = steps == trial.steps_in_exactly(trial.scored_s);
        if is_over { guard.check(world, assembly, body) } else { Ok(()) }
    }

    /// One control update: senses in, commands out.
    fn command(&mut self, assembly: &Assembly, body: &Member, world: &mut impl World) {
        let senses = match self.mind.feels() {
            true => feels::senses(world, assembly, body),
            false => Senses::default(),
        };
        self.mind.command(&senses, &mut self.targets_rad_s);
        for &(link, part) in &self.driven {
            world.drive(part, self.targets_rad_s[link]);
        }
    }

    /// Takes a position on the track.
    fn sample(
        &mut self,
        trial: &Trial,
        assembly: &Assembly,
        body: &Member,
        world: &impl World,
    ) -> Result<(), Failure> {
        let poses = self.poses.push(world::part_poses(world, body));
        let centre_m = world::centre_of(poses, &assembly.parts[body.parts.clone()]);
        self.track_m.push(centre_m.xy());
        self.heights_m.extend(height_m(poses, assembly, body, &trial.ground, &centre_m));
        if trial.guards.keeps_ledger { self.ledger.enter(centre_m) } else { Ok(()) }
    }

    /// What was measured in the end.
    pub fn measurement(
        &mut self,
        world: &impl World,
        assembly: &Assembly,
        body: &Member,
        root_first_m: Vector3<f64>,
        creature: &Creature,
    ) -> Measurement {
        let track_m = std::mem::take(&mut self.track_m);
        Measurement {
            root_first_m,
            root_last_m: world::root_position(world, assembly, body),
            centre_first_m: self.centre_first_m,
            centre_last_m: world::centre_of_mass(world, assembly, body),
            path_m: track_m.windows(2).map(|leg| (leg[1] - leg[0]).norm()).sum(),
            track_m,
            heights_m: std::mem::take(&mut self.heights_m),
            poses: std::mem::replace(&mut self.poses, Poses::new(body.parts.len(), 0)),
            extent_m: creature.morphology.extent_m(),
            others: Vec::new(),
        }
    }
}

/// How high a body is on a terrain, given where its parts and its centre of mass are.
fn height_m(
    poses: &[Isometry3<f64>],
    assembly: &Assembly,
    body: &Member,
    ground: &Ground,
    centre_m: &Vector3<f64>,
) -> Option<f64> {
    let below_m = ground.terrain()?.height_m(centre_m.x, centre_m.y);
    Some(world::lowest_m(poses, &assembly.parts[body.parts.clone()]).min(below_m))
}
