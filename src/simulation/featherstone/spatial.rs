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

/// The inertia of a rigid body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RigidInertia {
    /// The mass, in kilograms.
    pub mass_kg: f64,
    /// The centre of mass, from the reference, in metres.
    pub centre_m: Vector3<f64>,
    /// The rotational inertia about the centre of mass, in kg·m².
    pub about_centre: Matrix3<f64>,
}

impl RigidInertia {
    /// The momentum that a motion has.
    #[inline]
    pub fn times(&self, motion: &Spatial) -> Spatial {
        let momentum = motion.velocity_at(&self.centre_m) * self.mass_kg;
        let spin = applied(&self.about_centre, &motion.angular());
        Spatial::new(spin + self.centre_m.cross(&momentum), momentum)
    }

    /// All six columns (eq. 2.63).
    #[inline]
    pub fn spread(&self) -> Inertia {
        let mass_kg = self.mass_kg;
        let (x, y, z) = (self.centre_m.x, self.centre_m.y, self.centre_m.z);
        let (mx, my, mz) = (mass_kg * x, mass_kg * y, mass_kg * z);
        let about = |row, column| self.about_centre[(row, column)];
        let (yx, zx, zy) = (about(1, 0) - my * x, about(2, 0) - mz * x, about(2, 1) - mz * y);
        let xx = about(0, 0) + my * y + mz * z;
        let yy = about(1, 1) + mx * x + mz * z;
        let zz = about(2, 2) + mx * x + my * y;
        Inertia([
            Spatial([xx, yx, zx, 0.0, -mz, my]),
            Spatial([yx, yy, zy, mz, 0.0, -mx]),
            Spatial([zx, zy, zz, -my, mx, 0.0]),
            Spatial([0.0, mz, -my, mass_kg, 0.0, 0.0]),
            Spatial([-mz, 0.0, mx, 0.0, mass_kg, 0.0]),
            Spatial([my, -mx, 0.0, 0.0, 0.0, mass_kg]),
        ])
    }
}

/// The product of a matrix and a vector.
#[inline]
pub fn applied(matrix: &Matrix3<f64>, vector: &Vector3<f64>) -> Vector3<f64> {
    let column = |i: usize| matrix.column(i) * vector[i];
    column(0) + column(1) + column(2)
}

/// The product of two matrices.
#[inline]
pub fn product(left: &Matrix3<f64>, right: &Matrix3<f64>) -> Matrix3<f64> {
    let column = |i: usize| applied(left, &right.column(i).into_owned());
    Matrix3::from_columns(&[column(0), column(1), column(2)])
}

/// A spatial inertia, rigid or articulated: six columns, symmetric.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Inertia([Spatial; 6]);

impl Inertia {
    /// Nothing.
    pub const ZERO: Self = Self([Spatial::ZERO; 6]);

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
