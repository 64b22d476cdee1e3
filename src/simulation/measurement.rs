//! What is measured in a trial.

use nalgebra::{Isometry3, Vector2, Vector3};

/// What was measured in a trial that ran to its end.
#[derive(Debug, Clone, PartialEq)]
pub struct Measurement {
    /// The root's position after the very first step, in metres.
    pub root_first_m: Vector3<f64>,
    /// The root's position at the end, in metres.
    pub root_last_m: Vector3<f64>,
    /// The centre of mass when scoring began, in metres.
    pub centre_first_m: Vector3<f64>,
    /// The centre of mass at the end, in metres.
    pub centre_last_m: Vector3<f64>,
    /// The length of the horizontal path of the centre of mass while scoring, in metres, from positions
    /// 0.1 s apart.
    pub path_m: f64,
    /// Where the centre of mass was above the ground, in metres: when scoring began, and every
    /// [`TRACK_SAMPLE_S`] since.
    pub track_m: Vec<Vector2<f64>>,
    /// On a terrain, the height of the body's lowest point at the same moments, but at most that of the ground below
    /// its centre of mass, in metres: what is in the air, or leans on a wall, is no higher than what it is above.
    pub heights_m: Vec<f64>,
    /// Where every part was at the same moments.
    pub poses: Poses,
    /// How far the body reaches from its root at rest, in metres.
    pub extent_m: f64,
    /// The same of who and what else is in its world, in the order of [`Trial::others`](super::Trial::others).
    pub others: Vec<Measurement>,
}

/// Positions on the track of the centre of mass are this far apart, in seconds.
pub const TRACK_SAMPLE_S: f64 = 0.1;

/// Where the parts of a body were, moment by moment; the parts are in the order of the body's
/// [`assembly`](super::assembly).
#[derive(Debug, Clone, PartialEq)]
pub struct Poses {
    parts: usize,
    /// Those of the first moment, then those of the next.
    places: Vec<Isometry3<f64>>,
}

impl Poses {
    /// None yet, of a body of at least one part. For so many moments it will ask for no more memory.
    pub fn new(parts: usize, moments: usize) -> Self {
        Self { parts, places: Vec::with_capacity(parts * moments) }
    }

    /// Adds a moment, and returns it.
    pub fn push(&mut self, poses: impl Iterator<Item = Isometry3<f64>>) -> &[Isometry3<f64>] {
        let start = self.places.len();
        self.places.extend(poses);
        debug_assert_eq!(self.places.len(), start + self.parts, "every part is somewhere");
        &self.places[start..]
    }

    /// The number of parts.
    pub fn parts(&self) -> usize {
        self.parts
    }

    /// The places of all parts, moment by moment.
    pub fn moments(&self) -> impl DoubleEndedIterator<Item = &[Isometry3<f64>]> + Clone {
        self.places.chunks_exact(self.parts)
    }
}

impl Measurement {
    /// That of the first body of a trial, with those of the others.
    pub(super) fn of_first(mut measured: Vec<Self>) -> Self {
        // There is a first one: every body of a trial is measured.
        let first = measured.remove(0);
        Self { others: measured, ..first }
    }
}
