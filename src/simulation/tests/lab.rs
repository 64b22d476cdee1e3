//! A world that can be measured.

use super::super::Engine;
use super::super::assembly::Assembly;
use super::super::featherstone::{FeatherstoneWorld, Relief};
use super::super::rapier::RapierWorld;
use super::super::terrain::Ground;
use super::super::trial::Trial;
use super::super::world::{self, Stepper};
use crate::creature::Creature;
use nalgebra::{Isometry3, Point3, Vector3};
use std::sync::Arc;

/// A body in an engine's world.
pub struct Lab {
    pub world: Box<dyn Stepper>,
    pub assembly: Assembly,
    trial: Trial,
}

/// What a body did in a step, from the poses before and after it: so every engine is measured alike, whatever
/// velocities it believes in. All is said of the middle of the step.
pub struct Motion {
    /// Mass times velocity, in kg·m/s.
    pub momentum: Vector3<f64>,
    /// Angular momentum about the centre of mass, in kg·m²/s.
    pub spin: Vector3<f64>,
    /// Kinetic and potential energy of each part, in joules.
    pub energies_j: Vec<f64>,
}

impl Lab {
    pub fn new(engine: Engine, creature: &Creature, trial: Trial) -> Self {
        let assembly = Assembly::new(creature, &trial);
        let world: Box<dyn Stepper> = match (engine, &trial.ground) {
            (Engine::Rapier, _) => Box::new(RapierWorld::new(&assembly, &trial)),
            (Engine::Featherstone, Ground::Plane) => {
                Box::new(FeatherstoneWorld::new(&assembly, &trial))
            }
            (Engine::Featherstone, Ground::Terrain(terrain)) => {
                Box::new(FeatherstoneWorld::on(Relief(Arc::clone(terrain)), &assembly, &trial))
            }
        };
        Self { world, assembly, trial }
    }

    /// The length of a step in seconds.
    pub fn step_s(&self) -> f64 {
        self.trial.time_s(1)
    }

    pub fn step(&mut self) {
        self.world.step().expect("all stays finite");
    }

    pub fn run(&mut self, seconds: f64) {
        (0..self.trial.steps_in_exactly(seconds)).for_each(|_| self.step());
    }

    pub fn parts(&self) -> usize {
        self.assembly.parts.len()
    }

    pub fn pose(&self, part: usize) -> Isometry3<f64> {
        self.world.world_from_part(part)
    }

    pub fn centre_of_mass(&self) -> Vector3<f64> {
        world::centre_of_mass(&*self.world, &self.assembly, &self.assembly.bodies[0])
    }

    fn centre_of(&self, part: usize) -> Vector3<f64> {
        (self.pose(part) * Point3::from(self.assembly.parts[part].centre_m)).coords
    }

    /// Steps once, and measures what happened.
    pub fn motion(&mut self) -> Motion {
        let parts = 0..self.assembly.parts.len();
        let places = |lab: &Self| -> Vec<_> {
            parts.clone().map(|part| (lab.centre_of(part), lab.pose(part).rotation)).collect()
        };
        let (before, centre_before_m) = (places(self), self.centre_of_mass());
        self.step();
        let (after, centre_after_m) = (places(self), self.centre_of_mass());
        let centre_m = (centre_before_m + centre_after_m) / 2.0;
        let (mut momentum, mut spin, mut energies_j) =
            (Vector3::zeros(), Vector3::zeros(), Vec::new());
        for (part, (before, after)) in self.assembly.parts.iter().zip(before.iter().zip(&after)) {
            let place_m = (before.0 + after.0) / 2.0;
            let velocity_m_s = (after.0 - before.0) / self.step_s();
            let turn_rad_s = (after.1 * before.1.inverse()).scaled_axis() / self.step_s();
            let axes = before.1.slerp(&after.1, 0.5).to_rotation_matrix();
            let own_momentum = part.mass_kg * velocity_m_s;
            let own_spin = axes * part.inertia_kg_m2 * axes.transpose() * turn_rad_s;
            momentum += own_momentum;
            spin += own_spin + (place_m - centre_m).cross(&own_momentum);
            let kinetic_j = (own_momentum.dot(&velocity_m_s) + own_spin.dot(&turn_rad_s)) / 2.0;
            energies_j.push(kinetic_j + part.mass_kg * self.trial.gravity_m_s2 * place_m.z);
        }
        Motion { momentum, spin, energies_j }
    }
}
