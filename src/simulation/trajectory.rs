//! What a simulation looked like: the poses of every link over time.

use super::terrain::Ground;
use crate::creature::{Creature, Shape};
use std::ops::Range;

/// Frames a second in a film of a trial.
pub const FRAMES_PER_S: f64 = 60.0;

/// Where a link is in the world.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// The link frame's origin, in metres; z points up.
    pub position_m: [f32; 3],
    /// The link frame's rotation, a unit quaternion (x, y, z, w).
    pub rotation_xyzw: [f32; 4],
}

/// A filmed simulation: `poses[frame][link]`.
#[derive(Debug, Clone, PartialEq)]
pub struct Trajectory {
    /// The solid of each link, body by body.
    pub shapes: Vec<Shape>,
    /// How many links each body has.
    pub bodies: Vec<usize>,
    /// The simulated time of each frame in seconds, ascending from 0.
    pub times_s: Vec<f64>,
    /// The pose of each link in each frame.
    pub poses: Vec<Vec<Pose>>,
    /// When settling ended and scoring began, in seconds.
    pub scoring_from_s: f64,
    /// What it stands on.
    pub ground: Ground,
}

impl Trajectory {
    /// A film of some bodies, without a frame.
    pub fn new<'a>(
        creatures: impl Iterator<Item = &'a Creature>,
        scoring_from_s: f64,
        ground: Ground,
    ) -> Self {
        let (mut shapes, mut bodies) = (Vec::new(), Vec::new());
        for links in creatures.map(|creature| &creature.morphology.links) {
            bodies.push(links.len());
            shapes.extend(links.iter().map(|link| link.shape));
        }
        Self { shapes, bodies, times_s: Vec::new(), poses: Vec::new(), scoring_from_s, ground }
    }

    /// Which links are whose, body by body.
    pub fn links(&self) -> impl Iterator<Item = Range<usize>> {
        self.bodies.iter().scan(0, |end, links| {
            let start = *end;
            *end += links;
            Some(start..*end)
        })
    }

    /// Where the links of the first body are in a frame.
    pub fn first_body(&self, frame: usize) -> &[Pose] {
        &self.poses[frame][self.links().next().unwrap_or_default()]
    }

    /// Forgets every frame.
    pub fn clear(&mut self) {
        self.times_s.clear();
        self.poses.clear();
    }

    /// Adds a frame.
    pub fn push(&mut self, time_s: f64, poses: Vec<Pose>) {
        self.times_s.push(time_s);
        self.poses.push(poses);
    }
}
