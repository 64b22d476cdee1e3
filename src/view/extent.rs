//! How large a moving body is, and where.

use crate::creature::Shape;
use crate::simulation::trajectory::Pose;
use libm::hypotf;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};

/// The camera forgets movement that is shorter than this.
const CALM_S: f64 = 0.8;

/// Indices of `times_s` at most `rate` a second, none after `end_s`; the first one always.
pub fn every(times_s: &[f64], rate: f64, end_s: f64) -> Vec<usize> {
    // A little slack, so that frames at exactly this rate all stay.
    let step = 0.99 / rate;
    let mut picks: Vec<usize> = Vec::new();
    for (i, &time) in times_s.iter().enumerate() {
        let late_enough = picks.last().is_none_or(|&last| time - times_s[last] >= step);
        if late_enough && (time <= end_s || picks.is_empty()) {
            picks.push(i);
        }
    }
    picks
}

/// Where the middle of a body is on the ground.
pub fn middle(poses: &[Pose]) -> [f32; 2] {
    [0, 1].map(|axis| mean(poses.iter(), axis))
}

/// The mean position along an axis.
pub fn mean<'a>(poses: impl Iterator<Item = &'a Pose>, axis: usize) -> f32 {
    let (sum, count) =
        poses.fold((0.0, 0.0), |(sum, count), pose| (sum + pose.position_m[axis], count + 1.0));
    sum / f32::max(count, 1.0)
}

/// The running mean of `points` over [`CALM_S`].
pub fn calm(times_s: &[f64], points: &[[f32; 2]]) -> Vec<[f32; 2]> {
    let near = |t: f64| {
        let from = times_s.partition_point(|&other| other < t - CALM_S / 2.0);
        let to = times_s.partition_point(|&other| other <= t + CALM_S / 2.0);
        &points[from..to]
    };
    let mean = |points: &[[f32; 2]]| {
        [0, 1].map(|axis| points.iter().map(|p| p[axis]).sum::<f32>() / points.len() as f32)
    };
    times_s.iter().map(|&t| mean(near(t))).collect()
}

/// How far a body's links reach from a point.
pub fn reach(shapes: &[Shape], poses: &[Pose], from: [f32; 3]) -> f32 {
    let far = |(shape, pose): (&Shape, &Pose)| {
        let [x, y, z] = std::array::from_fn(|axis| pose.position_m[axis] - from[axis]);
        hypotf(hypotf(x, y), z) + shape.farthest_m() as f32
    };
    shapes.iter().zip(poses).map(far).fold(0.0, f32::max)
}

/// The point on a pose's z axis that is so far from its origin, in metres.
pub fn along_z(pose: &Pose, distance_m: f32) -> [f32; 3] {
    let [x, y, z, w] = pose.rotation_xyzw;
    let axis = [2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)];
    std::array::from_fn(|i| pose.position_m[i] + distance_m * axis[i])
}

/// Half the vertical extent of a solid in a pose.
pub fn half_height(shape: &Shape, pose: &Pose) -> f32 {
    let [x, y, z, w] = pose.rotation_xyzw.map(f64::from);
    let rotation = UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z));
    shape.reach_m(&rotation, &Vector3::z()) as f32
}
