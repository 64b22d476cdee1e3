//! What a brain may know of its body.

use nalgebra::Isometry3;

/// What a body feels at a control update. All lists are by link.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Senses {
    /// The joint that holds each link to its parent; at rest where there is none that moves.
    pub joints: Vec<JointSense>,
    /// Whether the rigid part that each link belongs to touches something that is not of its body.
    pub touches: Vec<bool>,
    /// Where each link is in the world.
    pub world_from_links: Vec<Isometry3<f64>>,
}

/// How far a joint has turned, and how fast it turns.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct JointSense {
    /// The angle from rest, in radians, from -π to π.
    pub angle_rad: f64,
    /// Its rate, in rad/s.
    pub rate_rad_s: f64,
}
