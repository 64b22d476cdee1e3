//! What a trial needs of an engine (step, sense, apply forces), and what can be said of a body in any of them.

use super::assembly::{Assembly, Member, Part};
use super::trajectory::Pose;
use crate::simulation::failure::Failure;
use nalgebra::{Isometry3, Point3, Vector3};

/// A world that goes on by itself.
pub trait Stepper: World {
    /// Advances by one step.
    ///
    /// # Errors
    /// If the engine met a number that is none.
    fn step(&mut self) -> Result<(), Failure>;
}

/// A body on the ground, or several, under one of the engines. Parts are those of its [`Assembly`], by their index.
pub trait World {
    /// Sets the speed that the motor of a part's hinge aims at, in rad/s.
    fn drive(&mut self, part: usize, target_rad_s: f64);

    /// Takes all speed from every body: they stand still where they are.
    fn halt(&mut self);

    /// Gives a whole body a velocity on top of its own, in m/s: every part of it the same.
    fn push(&mut self, body: &Member, velocity_m_s: Vector3<f64>);

    /// Lets a force act on a part, at its centre of mass, in newtons, and a torque, in newton metres, both along the
    /// world's axes: during the next step, beside all that acted before.
    fn apply(&mut self, part: usize, force_n: Vector3<f64>, torque_nm: Vector3<f64>);

    /// Where a part is.
    fn world_from_part(&self, part: usize) -> Isometry3<f64>;

    /// Where a part's origin is, in metres.
    fn position_m(&self, part: usize) -> Vector3<f64> {
        self.world_from_part(part).translation.vector
    }

    /// The velocity of a part's centre of mass, in m/s.
    fn velocity_m_s(&self, part: usize) -> Vector3<f64>;

    /// The angular velocity of a part along the world's axes, in rad/s.
    fn turn_rad_s(&self, part: usize) -> Vector3<f64>;

    /// Whether something that is not of its body pushed a part in the last step.
    fn touches(&self, part: usize) -> bool;

    /// Moves the whole body from rest as if it were rigid: its root's centre of mass by a velocity in m/s, and
    /// itself about that point by one in rad/s. No trial does this, but what physics says of it can be tested.
    #[cfg(test)]
    fn kick(&mut self, velocity_m_s: Vector3<f64>, turn_rad_s: Vector3<f64>);
}

/// Where every part of a body is.
pub fn part_poses(
    world: &(impl World + ?Sized),
    body: &Member,
) -> impl Iterator<Item = Isometry3<f64>> {
    body.parts.clone().map(|part| world.world_from_part(part))
}

/// The centre of mass of a whole body, in metres.
pub fn centre_of_mass(
    world: &(impl World + ?Sized),
    assembly: &Assembly,
    body: &Member,
) -> Vector3<f64> {
    let poses: Vec<_> = part_poses(world, body).collect();
    centre_of(&poses, &assembly.parts[body.parts.clone()])
}

/// The centre of mass of parts that are in these places, in metres.
pub fn centre_of(poses: &[Isometry3<f64>], parts: &[Part]) -> Vector3<f64> {
    let placed = parts.iter().zip(poses);
    let (moment, mass_kg) =
        placed.fold((Vector3::zeros(), 0.0), |(moment, mass_kg), (part, world_from_part)| {
            let centre_m = world_from_part * Point3::from(part.centre_m);
            (moment + part.mass_kg * centre_m.coords, mass_kg + part.mass_kg)
        });
    moment / mass_kg
}

/// The height of the lowest point of parts that are in these places, in metres.
pub fn lowest_m(poses: &[Isometry3<f64>], parts: &[Part]) -> f64 {
    let bottoms = parts.iter().zip(poses).flat_map(|(part, world_from_part)| {
        part.solids.iter().map(move |solid| {
            let pose = world_from_part * solid.part_from_solid;
            pose.translation.z - solid.shape.reach_m(&pose.rotation, &Vector3::z())
        })
    });
    bottoms.fold(f64::INFINITY, f64::min)
}

/// The position of a body's root link, in metres.
pub fn root_position(
    world: &(impl World + ?Sized),
    assembly: &Assembly,
    body: &Member,
) -> Vector3<f64> {
    link_pose(world, assembly, body.links.start).translation.vector
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

/// Where a link is.
pub fn link_pose(
    world: &(impl World + ?Sized),
    assembly: &Assembly,
    link: usize,
) -> Isometry3<f64> {
    let place = &assembly.places[link];
    world.world_from_part(place.part) * place.part_from_link
}
