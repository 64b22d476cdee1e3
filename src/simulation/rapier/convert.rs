//! Poses on their way to rapier and back: f64 here, f32 there.

use nalgebra::{Isometry3, Quaternion, UnitQuaternion, Vector3};
use rapier3d::prelude as rapier;

/// A pose for rapier.
pub fn to_rapier(pose: &Isometry3<f64>) -> rapier::Pose {
    let t = pose.translation.vector.cast::<f32>();
    let r = pose.rotation.coords.cast::<f32>();
    rapier::Pose::from_parts(
        rapier::Vector::new(t.x, t.y, t.z),
        rapier::Rotation::from_xyzw(r.x, r.y, r.z, r.w).normalize(),
    )
}

/// A pose that rapier gave.
pub fn from_rapier(pose: &rapier::Pose) -> Isometry3<f64> {
    let translation = Vector3::from(pose.translation.to_array()).cast::<f64>();
    let [x, y, z, w] = pose.rotation.to_array().map(f64::from);
    Isometry3::from_parts(
        translation.into(),
        UnitQuaternion::new_normalize(Quaternion::new(w, x, y, z)),
    )
}

/// A vector for rapier.
pub fn vector(vector: &Vector3<f64>) -> rapier::Vector {
    let [x, y, z] = vector.cast::<f32>().into();
    rapier::Vector::new(x, y, z)
}
