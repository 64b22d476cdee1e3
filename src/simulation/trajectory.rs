//! What a simulation looked like: the poses of every link over time.

use crate::creature::morphology::Shape;

/// Where a link is in the world.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// The link frame's origin, in metres; z points up.
    pub position_m: [f32; 3],
    /// The link frame's rotation, a unit quaternion (x, y, z, w).
    pub rotation_xyzw: [f32; 4],
}

/// A recorded simulation: `poses[frame][link]`.
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
}
