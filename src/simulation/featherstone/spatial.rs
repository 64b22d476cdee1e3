//! Spatial vectors and inertias (Featherstone 2008, chapter 2), all about one point and along the world's axes.
//!
//! With one point for the whole body nothing has to be carried from link to link: velocities, wrenches and
//! inertias of different parts are simply added.

use nalgebra::{Matrix3, Vector3};
use std::ops::{Add, AddAssign, Index, Mul, Neg, Sub, SubAssign};

/// A motion (angular over linear velocity of the body's point at the reference) or a wrench (moment about the
/// reference over force). Which of them, its place says.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Spatial(pub [f64; 6]);

impl Spatial {
    /// Nothing.
    pub const ZERO: Self = Self([0.0; 6]);

    /// An angular over a linear part.
    #[inline]
    pub fn new(angular: Vector3<f64>, linear: Vector3<f64>) -> Self {
        Self([angular.x, angular.y, angular.z, linear.x, linear.y, linear.z])
    }

    /// The upper half: an angular velocity, or a moment.
    #[inline]
    pub fn angular(&self) -> Vector3<f64> {
        Vector3::new(self.0[0], self.0[1], self.0[2])
    }

    /// The lower half: a linear velocity, or a force.
    #[inline]
    pub fn linear(&self) -> Vector3<f64> {
        Vector3::new(self.0[3], self.0[4], self.0[5])
    }

    /// The power of a wrench on a motion.
    #[inline]
    pub fn dot(&self, other: &Self) -> f64 {
        let product = |i: usize| self.0[i] * other.0[i];
        (product(0) + product(1) + product(2)) + (product(3) + product(4) + product(5))
    }

    /// How this motion changes in a body that moves by a velocity: the cross product for motions (eq. 2.31).
    #[inline]
    pub fn carried_by(&self, velocity: &Self) -> Self {
        let (turn, shift) = (velocity.angular(), velocity.linear());
        let (angular, linear) = (self.angular(), self.linear());
        Self::new(turn.cross(&angular), turn.cross(&linear) + shift.cross(&angular))
    }

    /// The velocity of the body's point at a place, for a motion.
    #[inline]
    pub fn velocity_at(&self, place: &Vector3<f64>) -> Vector3<f64> {
        self.linear() + self.angular().cross(place)
    }

    /// The wrench of a force, or of an impulse, at a place.
    #[inline]
    pub fn of_force_at(force: &Vector3<f64>, place: &Vector3<f64>) -> Self {
        Self::new(place.cross(force), *force)
    }

    /// This motion with another reference, which is there in terms of the present one.
    #[inline]
    pub fn motion_about(&self, place: &Vector3<f64>) -> Self {
        Self::new(self.angular(), self.velocity_at(place))
    }

    /// This wrench with another reference, which is there in terms of the present one.
    #[inline]
    pub fn wrench_about(&self, place: &Vector3<f64>) -> Self {
        Self::new(self.angular() - place.cross(&self.linear()), self.linear())
    }
}

impl Add for Spatial {
    type Output = Self;

    #[inline]
    fn add(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i] + other.0[i]))
    }
}

impl Sub for Spatial {
    type Output = Self;

    #[inline]
    fn sub(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i] - other.0[i]))
    }
}

impl AddAssign for Spatial {
    #[inline]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for Spatial {
    #[inline]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl Neg for Spatial {
    type Output = Self;

    #[inline]
    fn neg(self) -> Self {
        Self(self.0.map(|x| -x))
    }
}

impl Mul<f64> for Spatial {
    type Output = Self;

    #[inline]
    fn mul(self, factor: f64) -> Self {
        Self(self.0.map(|x| x * factor))
    }
}

/// A spatial inertia, rigid or articulated: six columns, symmetric.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Inertia([Spatial; 6]);

impl Inertia {
    /// Nothing.
    pub const ZERO: Self = Self([Spatial::ZERO; 6]);

    /// The inertia of a rigid body about the reference (eq. 2.63), by its mass, its centre of mass and its
    /// rotational inertia about that centre.
    #[inline]
    pub fn rigid(mass_kg: f64, centre_m: &Vector3<f64>, about_centre: &Matrix3<f64>) -> Self {
        let (x, y, z) = (centre_m.x, centre_m.y, centre_m.z);
        let (mx, my, mz) = (mass_kg * x, mass_kg * y, mass_kg * z);
        let [xx, yx, zx, _, yy, zy, _, _, zz] = about_centre.as_slice() else {
            unreachable!("three by three")
        };
        let (yx, zx, zy) = (yx - my * x, zx - mz * x, zy - mz * y);
        let (xx, yy, zz) = (xx + my * y + mz * z, yy + mx * x + mz * z, zz + mx * x + my * y);
        Self([
            Spatial([xx, yx, zx, 0.0, -mz, my]),
            Spatial([yx, yy, zy, mz, 0.0, -mx]),
            Spatial([zx, zy, zz, -my, mx, 0.0]),
            Spatial([0.0, mz, -my, mass_kg, 0.0, 0.0]),
            Spatial([-mz, 0.0, mx, 0.0, mass_kg, 0.0]),
            Spatial([my, -mx, 0.0, 0.0, 0.0, mass_kg]),
        ])
    }

    /// The wrench that gives a motion in a unit of time, or its momentum.
    #[inline]
    pub fn times(&self, motion: &Spatial) -> Spatial {
        let column = |i: usize| self.0[i] * motion.0[i];
        (column(0) + column(1) + column(2)) + (column(3) + column(4) + column(5))
    }

    /// Adds another inertia.
    #[inline]
    pub fn add(&mut self, other: &Self) {
        for (column, other) in self.0.iter_mut().zip(&other.0) {
            *column += *other;
        }
    }

    /// Takes away the product of a wrench with itself.
    #[inline]
    pub fn subtract_square(&mut self, wrench: &Spatial) {
        for (column, factor) in self.0.iter_mut().zip(wrench.0) {
            *column -= *wrench * factor;
        }
    }
}

impl Index<(usize, usize)> for Inertia {
    type Output = f64;

    #[inline]
    fn index(&self, (row, column): (usize, usize)) -> &f64 {
        &self.0[column].0[row]
    }
}
