//! Where the links are, and how their places change (Featherstone 2008, chapter 4).
//!
//! Angles are never needed, so none is kept: a hinge is a unit complex number and the root a unit quaternion, each
//! turned by the Cayley map, which takes no transcendental function and keeps the length of what it turns.

use super::model::{Link, Model};
use super::spatial::{RigidInertia, Spatial, applied, product};
use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};

/// The configuration of a body.
#[derive(Debug)]
pub struct Configuration {
    /// Where the root's centre of mass is, in metres.
    pub position_m: Vector3<f64>,
    /// How the root is turned.
    pub rotation: UnitQuaternion<f64>,
    /// The cosine and the sine of each link's hinge.
    pub hinges: Vec<(f64, f64)>,
}

/// Where a link is, in the world's axes, from the reference.
#[derive(Debug, Clone, Copy)]
pub struct Place {
    /// The world's axes from the link's.
    pub rotation: Matrix3<f64>,
    /// The link's origin, in metres.
    pub origin_m: Vector3<f64>,
    /// The motion of the link when its hinge turns by 1 rad/s: the joint's motion subspace (section 3.5).
    pub axis: Spatial,
    /// Its inertia, and its centre of mass.
    pub inertia: RigidInertia,
}

impl Configuration {
    /// A body whose hinges are at rest.
    pub fn new(position_m: Vector3<f64>, rotation: UnitQuaternion<f64>, links: usize) -> Self {
        Self { position_m, rotation, hinges: vec![(1.0, 0.0); links] }
    }

    /// Moves for a time by constant velocities: the root's about the reference, and each hinge's in rad/s.
    pub fn advance(&mut self, root: &Spatial, rates_rad_s: &[f64], time_s: f64) {
        self.position_m += root.linear() * time_s;
        self.rotation = turned(&self.rotation, &(root.angular() * time_s));
        for (hinge, rate_rad_s) in self.hinges.iter_mut().zip(rates_rad_s) {
            let (cos, sin) = *hinge;
            let (turn_cos, turn_sin) = cayley(rate_rad_s * time_s);
            *hinge = (cos * turn_cos - sin * turn_sin, sin * turn_cos + cos * turn_sin);
        }
    }

    /// A link's rotation and origin in the world.
    pub fn world_from_link(&self, model: &Model, index: usize) -> (Matrix3<f64>, Vector3<f64>) {
        let (mut rotation, mut origin_m) = (Matrix3::identity(), Vector3::zeros());
        let mut index = index;
        while index > 0 {
            let link = &model.links[index];
            let parent_from_link = hinge_turn(&link.parent_from_rest, self.hinges[index]);
            rotation = parent_from_link * rotation;
            origin_m = parent_from_link * origin_m + link.hinge_m;
            index = link.parent;
        }
        let root = *self.rotation.to_rotation_matrix().matrix();
        (root * rotation, root * origin_m + self.position_m)
    }

    /// Where every link is: positions from the root outwards.
    pub fn place(&self, model: &Model, places: &mut [Place]) {
        let rotation = *self.rotation.to_rotation_matrix().matrix();
        places[0] = Place::of(&model.links[0], rotation, Vector3::zeros());
        for (index, link) in model.links.iter().enumerate().skip(1) {
            let parent = &places[link.parent];
            let rest = product(&parent.rotation, &link.parent_from_rest);
            let rotation = hinge_turn(&rest, self.hinges[index]);
            let origin_m = parent.origin_m + applied(&parent.rotation, &link.hinge_m);
            places[index] = Place::of(link, rotation, origin_m);
        }
    }
}

impl Clone for Configuration {
    fn clone(&self) -> Self {
        Self { hinges: self.hinges.clone(), ..*self }
    }

    fn clone_from(&mut self, other: &Self) {
        (self.position_m, self.rotation) = (other.position_m, other.rotation);
        self.hinges.copy_from_slice(&other.hinges);
    }
}

impl Place {
    /// A link's place before it is known.
    pub fn nowhere() -> Self {
        Self {
            rotation: Matrix3::zeros(),
            origin_m: Vector3::zeros(),
            axis: Spatial::ZERO,
            inertia: RigidInertia {
                mass_kg: 0.0,
                centre_m: Vector3::zeros(),
                about_centre: Matrix3::zeros(),
            },
        }
    }

    #[inline]
    fn of(link: &Link, rotation: Matrix3<f64>, origin_m: Vector3<f64>) -> Self {
        let axis = rotation.column(0).into_owned();
        Self {
            rotation,
            origin_m,
            axis: Spatial::new(axis, origin_m.cross(&axis)),
            inertia: RigidInertia {
                mass_kg: link.mass_kg,
                centre_m: origin_m + applied(&rotation, &link.centre_m),
                about_centre: product(
                    &product(&rotation, &link.inertia_kg_m2),
                    &rotation.transpose(),
                ),
            },
        }
    }
}

/// A rotation with a turn about the x axis before it.
#[inline]
fn hinge_turn(rest: &Matrix3<f64>, (cos, sin): (f64, f64)) -> Matrix3<f64> {
    let (x, y, z) = (rest.column(0), rest.column(1), rest.column(2));
    Matrix3::from_columns(&[x.into_owned(), y * cos + z * sin, z * cos - y * sin])
}

/// The tangent of half an angle, to the third order: a turn that is right to 1e-6 of itself at 24 rad/s and 240 Hz.
#[inline]
fn tan_half(angle_rad: f64) -> f64 {
    angle_rad * (0.5 + angle_rad * angle_rad * (1.0 / 24.0))
}

/// The cosine and the sine of a small angle.
#[inline]
fn cayley(angle_rad: f64) -> (f64, f64) {
    let tan = tan_half(angle_rad);
    let scale = 1.0 / (1.0 + tan * tan);
    ((1.0 - tan * tan) * scale, 2.0 * tan * scale)
}

/// A rotation turned by a small rotation vector in the world's axes.
fn turned(rotation: &UnitQuaternion<f64>, turn_rad: &Vector3<f64>) -> UnitQuaternion<f64> {
    let half = turn_rad * (0.5 + turn_rad.norm_squared() * (1.0 / 24.0));
    let turn = Quaternion::from_parts(1.0, half);
    UnitQuaternion::new_normalize(turn * rotation.quaternion())
}
