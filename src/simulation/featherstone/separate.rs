//! Several bodies that pass through each other: a world for each, so that each has the same bits as alone.

use crate::simulation::assembly::{Assembly, Member};
use crate::simulation::failure::Failure;
use crate::simulation::world::{Stepper, World};
use nalgebra::{Isometry3, Vector3};

/// A world for each body of an assembly.
pub struct Separate<S> {
    worlds: Vec<S>,
    /// Which world each part is in, and its number there.
    parts: Vec<(usize, usize)>,
}

impl<S: Stepper> Separate<S> {
    /// Puts each body into a world of its own.
    pub fn new(assembly: &Assembly, world: impl Fn(&Assembly) -> S) -> Self {
        let bodies = || assembly.bodies.iter().enumerate();
        let numbered =
            |(index, body): (usize, &Member)| (0..body.parts.len()).map(move |part| (index, part));
        Self {
            worlds: bodies().map(|(_, body)| world(&assembly.alone(body))).collect(),
            parts: bodies().flat_map(numbered).collect(),
        }
    }

    fn of(&self, part: usize) -> (&S, usize) {
        let (world, part) = self.parts[part];
        (&self.worlds[world], part)
    }

    fn of_mut(&mut self, part: usize) -> (&mut S, usize) {
        let (world, part) = self.parts[part];
        (&mut self.worlds[world], part)
    }
}

impl<S: Stepper> Stepper for Separate<S> {
    fn step(&mut self) -> Result<(), Failure> {
        self.worlds.iter_mut().try_for_each(Stepper::step)
    }
}

impl<S: Stepper> World for Separate<S> {
    fn drive(&mut self, part: usize, target_rad_s: f64) {
        let (world, part) = self.of_mut(part);
        world.drive(part, target_rad_s);
    }

    fn halt(&mut self) {
        self.worlds.iter_mut().for_each(World::halt);
    }

    fn push(&mut self, body: &Member, velocity_m_s: Vector3<f64>) {
        let (world, _) = self.of_mut(body.parts.start);
        world.push(body, velocity_m_s);
    }

    fn apply(&mut self, part: usize, force_n: Vector3<f64>, torque_nm: Vector3<f64>) {
        let (world, part) = self.of_mut(part);
        world.apply(part, force_n, torque_nm);
    }

    fn world_from_part(&self, part: usize) -> Isometry3<f64> {
        let (world, part) = self.of(part);
        world.world_from_part(part)
    }

    fn position_m(&self, part: usize) -> Vector3<f64> {
        let (world, part) = self.of(part);
        world.position_m(part)
    }

    fn velocity_m_s(&self, part: usize) -> Vector3<f64> {
        let (world, part) = self.of(part);
        world.velocity_m_s(part)
    }

    fn turn_rad_s(&self, part: usize) -> Vector3<f64> {
        let (world, part) = self.of(part);
        world.turn_rad_s(part)
    }

    fn touches(&self, part: usize) -> bool {
        let (world, part) = self.of(part);
        world.touches(part)
    }

    #[cfg(test)]
    fn kick(&mut self, velocity_m_s: Vector3<f64>, turn_rad_s: Vector3<f64>) {
        self.worlds[0].kick(velocity_m_s, turn_rad_s);
    }
}
