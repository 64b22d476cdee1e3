//! What a trial needs of an engine, and what can be said of a body in any of them.

use super::assembly::Assembly;
use super::trajectory::Pose;
use crate::evolution::Outcome;
use nalgebra::{Isometry3, Point3, Vector3};

/// A world that goes on by itself.
pub trait Stepper: World {
    /// Advances by one step.
    ///
    /// # Errors
    /// If the engine met a number that is none.
    fn step(&mut self) -> Result<(), Outcome>;
}

/// A body on the ground, under one of the engines. Parts are those of its [`Assembly`], by their index.
pub trait World {
    /// Sets the speed that the motor of a part's hinge aims at, in rad/s.
    fn drive(&mut self, part: usize, target_rad_s: f64);

    /// Takes all speed from the body: it stands still where it is.
    fn halt(&mut self);

    /// Gives the whole body a velocity on top of its own, in m/s: every part the same.
    fn push(&mut self, velocity_m_s: Vector3<f64>);

    /// Where a part is.
    fn world_from_part(&self, part: usize) -> Isometry3<f64>;

    /// Where a part's origin is, in metres.
    fn position_m(&self, part: usize) -> Vector3<f64> {
        self.world_from_part(part).translation.vector
    }

    /// The velocity of a part's centre of mass, in m/s.
    fn velocity_m_s(&self, part: usize) -> Vector3<f64>;

    /// Moves the whole body from rest as if it were rigid: its root's centre of mass by a velocity in m/s, and
    /// itself about that point by one in rad/s. No trial does this, but what physics says of it can be tested.
    #[cfg(test)]
    fn kick(&mut self, velocity_m_s: Vector3<f64>, turn_rad_s: Vector3<f64>);
}

/// Where every part is.
pub fn part_poses(world: &(impl World + ?Sized), assembly: &Assembly) -> Vec<Isometry3<f64>> {
    (0..assembly.parts.len()).map(|part| world.world_from_part(part)).collect()
}

/// The centre of mass of the whole body, in metres.
pub fn centre_of_mass(world: &(impl World + ?Sized), assembly: &Assembly) -> Vector3<f64> {
    centre_of(&part_poses(world, assembly), assembly)
}

/// The centre of mass of a body whose parts are in these places, in metres.
pub fn centre_of(poses: &[Isometry3<f64>], assembly: &Assembly) -> Vector3<f64> {
    let parts = assembly.parts.iter().zip(poses);
    let (moment, mass_kg) =
        parts.fold((Vector3::zeros(), 0.0), |(moment, mass_kg), (part, world_from_part)| {
            let centre_m = world_from_part * Point3::from(part.centre_m);
            (moment + part.mass_kg * centre_m.coords, mass_kg + part.mass_kg)
        });
    moment / mass_kg
}

/// The height of the lowest point of a body whose parts are in these places, in metres.
pub fn lowest_m(poses: &[Isometry3<f64>], assembly: &Assembly) -> f64 {
    let parts = assembly.parts.iter().zip(poses);
    let bottoms = parts.flat_map(|(part, world_from_part)| {
        part.solids.iter().map(move |solid| {
            let pose = world_from_part * solid.part_from_solid;
            pose.translation.z - solid.shape.reach_m(&pose.rotation, &Vector3::z())
        })
    });
    bottoms.fold(f64::INFINITY, f64::min)
}

/// The position of the root link, in metres.
pub fn root_position(world: &(impl World + ?Sized), assembly: &Assembly) -> Vector3<f64> {
    link_pose(world, assembly, 0).translation.vector
}

/// The pose of every link.
pub fn poses(world: &(impl World + ?Sized), assembly: &Assembly) -> Vec<Pose> {
    let pose = |link| {
        let pose = link_pose(world, assembly, link);
        let rotation = pose.rotation.cast::<f32>();
        Pose {
            position_m: pose.translation.vector.cast::<f32>().into(),
            rotation_xyzw: rotation.into_inner().normalize().coords.into(),
        }
    };
    (0..assembly.places.len()).map(pose).collect()
}

fn link_pose(world: &(impl World + ?Sized), assembly: &Assembly, link: usize) -> Isometry3<f64> {
    let place = &assembly.places[link];
    world.world_from_part(place.part) * place.part_from_link
}
