//! Where the links are, and how their places change (Featherstone 2008, chapter 4).
//!
//! Angles are never needed, so none is kept: a hinge is a unit complex number and the root a unit quaternion, each
//! turned by the Cayley map, which takes no transcendental function and keeps the length of what it turns.

use super::model::{Link, Model};
use super::spatial::{Mat3, RigidInertia, Spatial};
use crate::simulation::lanes::width::{Alone, Width};
use crate::simulation::lanes::{Everywhere, Real, Vec3};
use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};

/// The configuration of a body.
pub struct Configuration<W: Width> {
    /// Where the root's centre of mass is, in metres.
    pub position_m: Vec3<W>,
    /// How the root is turned: a unit quaternion i, j, k, w.
    pub rotation: [Real<W>; 4],
    /// The cosine and the sine of each link's hinge.
    pub hinges: Vec<[Real<W>; 2]>,
}

/// Where a link is, in the world's axes, from the reference.
#[derive(Clone, Copy)]
pub struct Place<W: Width> {
    /// The world's axes from the link's.
    pub rotation: Mat3<W>,
    /// The link's origin, in metres.
    pub origin_m: Vec3<W>,
    /// The motion of the link when its hinge turns by 1 rad/s: the joint's motion subspace (section 3.5).
    pub axis: Spatial<W>,
    /// Its inertia, and its centre of mass.
    pub inertia: RigidInertia<W>,
}

impl<W: Width> Configuration<W> {
    /// A body of so many links whose hinges are at rest, at the origin.
    pub fn new(width: W, links: usize) -> Self {
        let (none, one) = (width.real(0.0), width.real(1.0));
        Self {
            position_m: width.vector(&Vector3::zeros()),
            rotation: [none, none, none, one],
            hinges: vec![[one, none]; links],
        }
    }

    /// Puts the body of one world to a place, with its hinges at rest.
    pub fn put(&mut self, lane: usize, position_m: &Vector3<f64>, rotation: &UnitQuaternion<f64>) {
        self.position_m.set_lane(lane, Alone.vector(position_m));
        for (x, new) in self.rotation.iter_mut().zip(rotation.coords.iter()) {
            x.set(lane, *new);
        }
        for [cos, sin] in &mut self.hinges {
            cos.set(lane, 1.0);
            sin.set(lane, 0.0);
        }
    }

    /// Becomes what another one is in one world.
    pub fn copy_lane(&mut self, lane: usize, from: &Self) {
        self.position_m.set_lane(lane, from.position_m.lane(lane));
        let numbers = self.rotation.iter_mut().chain(self.hinges.as_flattened_mut());
        let others = from.rotation.iter().chain(from.hinges.as_flattened());
        for (number, other) in numbers.zip(others) {
            number.set(lane, other.get(lane));
        }
    }

    /// Moves for a time by constant velocities: the root's about the reference, and each hinge's in rad/s.
    #[inline(always)]
    pub fn advance(&mut self, root: &Spatial<W>, rates_rad_s: &[Real<W>], time_s: Real<W>) {
        self.position_m += root.linear().times(time_s);
        self.rotation = turned(&self.rotation, &root.angular().times(time_s));
        for ([cos, sin], rate_rad_s) in self.hinges.iter_mut().zip(rates_rad_s) {
            let [turn_cos, turn_sin] = cayley(*rate_rad_s * time_s);
            (*cos, *sin) = (*cos * turn_cos - *sin * turn_sin, *sin * turn_cos + *cos * turn_sin);
        }
    }

    /// A link's rotation and origin in one world.
    pub fn world_from_link(
        &self,
        lane: usize,
        model: &Model,
        index: usize,
    ) -> (Mat3<Alone>, Vec3<Alone>) {
        let mut rotation = Mat3::everywhere(Alone, &Matrix3::identity());
        let mut origin_m = Alone.vector(&Vector3::zeros());
        let mut index = index;
        while index > 0 {
            let link = &model.links[index];
            let rest = Mat3::everywhere(Alone, &link.parent_from_rest);
            let hinge = self.hinges[index].map(|number| Alone.real(number.get(lane)));
            let parent_from_link = hinge_turn(&rest, &hinge);
            rotation = parent_from_link.product(&rotation);
            origin_m = parent_from_link.applied(&origin_m) + Alone.vector(&link.hinge_m);
            index = link.parent;
        }
        let root = matrix(&self.rotation.map(|number| Alone.real(number.get(lane))));
        (root.product(&rotation), root.applied(&origin_m) + self.position_m.lane(lane))
    }

    /// Where a point of a link is in one world, given in the link's frame, in metres.
    pub fn world_point_m(
        &self,
        lane: usize,
        model: &Model,
        index: usize,
        at_m: &Vector3<f64>,
    ) -> Vec3<Alone> {
        let mut point_m = Alone.vector(at_m);
        let mut index = index;
        while index > 0 {
            let link = &model.links[index];
            let [cos, sin] = self.hinges[index].map(|number| Alone.real(number.get(lane)));
            let [x, y, z] = point_m.0;
            let turned_m = Vec3([x, y * cos - z * sin, y * sin + z * cos]);
            let rest = Mat3::everywhere(Alone, &link.parent_from_rest);
            point_m = rest.applied(&turned_m) + Alone.vector(&link.hinge_m);
            index = link.parent;
        }
        let root = matrix(&self.rotation.map(|number| Alone.real(number.get(lane))));
        root.applied(&point_m) + self.position_m.lane(lane)
    }

    /// Where every link is: positions from the root outwards.
    #[inline(always)]
    pub fn place(&self, model: &Model, places: &mut [Place<W>]) {
        let origin_m = self.rotation[0].width.vector(&Vector3::zeros());
        places[0] = Place::of(&model.links[0], matrix(&self.rotation), origin_m);
        for (index, link) in model.links.iter().enumerate().skip(1) {
            let parent = &places[link.parent];
            let rest = parent.rotation.product_with(&link.parent_from_rest);
            let rotation = hinge_turn(&rest, &self.hinges[index]);
            let origin_m = parent.origin_m + parent.rotation.applied_to(&link.hinge_m);
            places[index] = Place::of(link, rotation, origin_m);
        }
    }

    /// Becomes another one.
    #[inline(always)]
    pub fn follow(&mut self, other: &Self) {
        (self.position_m, self.rotation) = (other.position_m, other.rotation);
        self.hinges.copy_from_slice(&other.hinges);
    }
}

impl<W: Width> Place<W> {
    /// A link's place before it is known.
    pub fn nowhere(width: W) -> Self {
        let (rotation, origin_m) =
            (Mat3::everywhere(width, &Matrix3::zeros()), width.vector(&Vector3::zeros()));
        Self {
            rotation,
            origin_m,
            axis: Spatial::zero(width),
            inertia: RigidInertia { mass_kg: 0.0, centre_m: origin_m, about_centre: rotation },
        }
    }

    #[inline(always)]
    fn of(link: &Link, rotation: Mat3<W>, origin_m: Vec3<W>) -> Self {
        let axis = rotation.0[0];
        let turned = rotation.product_with(&link.inertia_kg_m2);
        Self {
            rotation,
            origin_m,
            axis: Spatial::new(axis, origin_m.cross(&axis)),
            inertia: RigidInertia {
                mass_kg: link.mass_kg,
                centre_m: origin_m + rotation.applied_to(&link.centre_m),
                about_centre: turned.product(&rotation.transposed()),
            },
        }
    }
}

/// A rotation with a turn about the x axis before it.
#[inline(always)]
fn hinge_turn<W: Width>(rest: &Mat3<W>, [cos, sin]: &[Real<W>; 2]) -> Mat3<W> {
    let [x, y, z] = rest.0;
    Mat3([x, y.times(*cos) + z.times(*sin), z.times(*cos) - y.times(*sin)])
}

/// The tangent of half an angle, to the third order: a turn that is right to 1e-6 of itself at 24 rad/s and 240
/// Hz, and to 3e-5 at 100 Hz.
#[inline(always)]
fn tan_half<W: Width>(angle_rad: Real<W>) -> Real<W> {
    angle_rad * (angle_rad.width.real(0.5) + angle_rad * angle_rad * (1.0 / 24.0))
}

/// The cosine and the sine of a small angle.
#[inline(always)]
fn cayley<W: Width>(angle_rad: Real<W>) -> [Real<W>; 2] {
    let (tan, one) = (tan_half(angle_rad), angle_rad.width.real(1.0));
    let scale = one / (one + tan * tan);
    [(one - tan * tan) * scale, tan * 2.0 * scale]
}

/// A rotation turned by a small rotation vector in the world's axes: the product of two quaternions, made a unit.
#[inline(always)]
fn turned<W: Width>(rotation: &[Real<W>; 4], turn_rad: &Vec3<W>) -> [Real<W>; 4] {
    let share = rotation[0].width.real(0.5) + turn_rad.norm_squared() * (1.0 / 24.0);
    let [x, y, z] = turn_rad.times(share).0;
    let [i, j, k, w] = *rotation;
    let product = [
        i + x * w + y * k - z * j,
        j - x * k + y * w + z * i,
        k + x * j - y * i + z * w,
        w - x * i - y * j - z * k,
    ];
    let [i, j, k, w] = product;
    let length = ((i * i + k * k) + (j * j + w * w)).sqrt();
    [i / length, j / length, k / length, w / length]
}

/// The matrix of a unit quaternion.
#[inline(always)]
fn matrix<W: Width>([i, j, k, w]: &[Real<W>; 4]) -> Mat3<W> {
    let (i, j, k, w) = (*i, *j, *k, *w);
    let (ww, ii, jj, kk) = (w * w, i * i, j * j, k * k);
    let (ij, wk, wj) = (i * j * 2.0, w * k * 2.0, w * j * 2.0);
    let (ik, jk, wi) = (i * k * 2.0, j * k * 2.0, w * i * 2.0);
    Mat3([
        Vec3([ww + ii - jj - kk, wk + ij, ik - wj]),
        Vec3([ij - wk, ww - ii + jj - kk, wi + jk]),
        Vec3([wj + ik, jk - wi, ww - ii - jj + kk]),
    ])
}

/// The unit quaternion of a rotation, given as a matrix.
pub fn quaternion(rotation: &Mat3<Alone>) -> UnitQuaternion<f64> {
    let columns = rotation.0.map(|column| column.alone());
    let rotation = Rotation3::from_matrix_unchecked(Matrix3::from_columns(&columns));
    UnitQuaternion::from_rotation_matrix(&rotation)
}
