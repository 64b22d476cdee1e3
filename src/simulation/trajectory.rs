//! What a simulation looked like: the poses of every link over time.

use super::terrain::Ground;
use crate::creature::{Creature, Shape};

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
    /// The solid of each link.
    pub shapes: Vec<Shape>,
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
    /// A film without a frame.
    pub fn new(creature: &Creature, scoring_from_s: f64, ground: Ground) -> Self {
        let shapes = creature.morphology.links.iter().map(|link| link.shape).collect();
        Self { shapes, times_s: Vec::new(), poses: Vec::new(), scoring_from_s, ground }
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
