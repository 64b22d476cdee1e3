//! Which way a champion goes: films show all of them going the same way.

use super::extent::middle;
use crate::creature::Morphology;
use crate::simulation::trajectory::{Pose, Trajectory};
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
}

impl Heading {
    /// The heading of a film.
    pub fn of(morphology: &Morphology, trajectory: &Trajectory) -> Self {
        let Trajectory { times_s, poses, scoring_from_s, .. } = trajectory;
        let begins = times_s.partition_point(|time| time < scoring_from_s).min(poses.len() - 1);
        let [start, end] =
            [begins, poses.len() - 1].map(|frame| centre_of_mass(morphology, &poses[frame]));
        let [x, y] = [end[0] - start[0], end[1] - start[1]];
        let way = x.hypot(y);
        let (cos, sin) = if way < NOWHERE_M { (1.0, 0.0) } else { (x / way, y / way) };
        Self { start, cos, sin }
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
    [0, 1].map(|axis| {
        let moments = poses.iter().enumerate();
        let sum: f64 = moments.map(|(i, pose)| mass(i) * f64::from(pose.position_m[axis])).sum();
        (sum / all) as f32
    })
}
