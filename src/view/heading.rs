//! Which way a champion goes: films show all of them going the same way.

use super::extent::middle;
use crate::creature::{Link, Morphology};
use crate::simulation::trajectory::{Pose, Trajectory};
use libm::hypotf;
use nalgebra::{UnitQuaternion, Vector3};
use rerun::{Quaternion, Transform3D};

/// Who gets less far than this goes nowhere, in metres.
const NOWHERE_M: f32 = 0.05;

/// A turn about the vertical and a shift, which bring the start of a champion's scored way to the start of its
/// lane and its end into the middle of the lane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Heading {
    start: [f32; 2],
    cos: f32,
    sin: f32,
    begins: [f32; 2],
}

impl Heading {
    /// The heading of a film. On a terrain everything stays where it is.
    pub fn of(morphology: &Morphology, trajectory: &Trajectory) -> Self {
        let Trajectory { times_s, poses, scoring_from_s, ground, .. } = trajectory;
        let begins = times_s.partition_point(|time| time < scoring_from_s).min(poses.len() - 1);
        let [start, end] = [begins, poses.len() - 1]
            .map(|frame| centre_of_mass(morphology, trajectory.first_body(frame)));
        if ground.terrain().is_some() {
            return Self { start: [0.0; 2], cos: 1.0, sin: 0.0, begins: start };
        }
        let [x, y] = [end[0] - start[0], end[1] - start[1]];
        let way = hypotf(x, y);
        let (cos, sin) = if way < NOWHERE_M { (1.0, 0.0) } else { (x / way, y / way) };
        Self { start, cos, sin, begins: [0.0; 2] }
    }

    /// Where the scored way begins, in the lane.
    pub fn begins(&self) -> [f32; 2] {
        self.begins
    }

    /// A point of the trial's ground, in the lane.
    pub fn turn(&self, [x, y]: [f32; 2]) -> [f32; 2] {
        let [x, y] = [x - self.start[0], y - self.start[1]];
        [self.cos * x + self.sin * y, self.cos * y - self.sin * x]
    }

    /// The same as a frame for the links themselves, whose poses stay as they were simulated.
    pub fn transform(&self) -> Transform3D {
        let [x, y] = self.turn([0.0, 0.0]);
        // Half of the angle, by the formulas of the half angle.
        let (half_cos, half_sin) = if self.cos > -0.999 {
            let cos = ((1.0 + self.cos) / 2.0).sqrt();
            (cos, self.sin / (2.0 * cos))
        } else {
            (0.0, 1.0)
        };
        Transform3D::from_translation([x, y, 0.0])
            .with_quaternion(Quaternion::from_xyzw([0.0, 0.0, -half_sin, half_cos]))
    }
}

/// Where the centre of mass is on the ground; of a body without masses, the middle of its links.
pub fn centre_of_mass(morphology: &Morphology, poses: &[Pose]) -> [f32; 2] {
    let mass = |link: usize| morphology.links.get(link).map_or(0.0, |link| link.mass_kg);
    let all: f64 = (0..poses.len()).map(mass).sum();
    if all <= 0.0 {
        return middle(poses);
    }
    let centre = |link: usize, pose: &Pose| {
        let off = morphology.links.get(link).map_or_else(Vector3::zeros, Link::centre_m);
        let [x, y, z, w] = pose.rotation_xyzw.map(f64::from);
        let rotation = UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(w, x, y, z));
        Vector3::from(pose.position_m.map(f64::from)) + rotation * off
    };
    let moments = poses.iter().enumerate().map(|(link, pose)| mass(link) * centre(link, pose));
    let sum: Vector3<f64> = moments.sum();
    [sum.x, sum.y].map(|moment| (moment / all) as f32)
}

#[cfg(test)]
mod tests {
    use super::super::tests::kit;
    use super::*;
    use crate::creature::{Inertia, Shape};
    use nalgebra::Matrix3;
    use std::f32::consts::FRAC_1_SQRT_2;

    #[test]
    fn a_mass_that_lies_beside_its_solid_is_seen_there() {
        let shape = Shape::Sphere { radius_m: 0.1 };
        let mut morphology = kit::body(&[shape, shape]).morphology;
        let off = Inertia {
            centre_m: Vector3::new(0.4, 0.0, 0.0),
            about_centre_kg_m2: Matrix3::identity(),
        };
        morphology.links[1].inertia = Some(off);
        // The second link is turned by a right angle about the vertical.
        let half = FRAC_1_SQRT_2;
        let poses = [[0.0, 0.0, 0.0, 1.0], [0.0, 0.0, half, half]]
            .map(|rotation_xyzw| Pose { position_m: [1.0, 2.0, 0.1], rotation_xyzw });
        let [x, y] = centre_of_mass(&morphology, &poses);
        assert!((x - 1.0).abs() < 1e-6 && (y - 2.2).abs() < 1e-6, "{x}, {y}");
    }
}
