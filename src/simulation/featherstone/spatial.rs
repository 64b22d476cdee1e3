//! Spatial vectors and inertias (Featherstone 2008, chapter 2), all about one point and along the world's axes.
//!
//! With one point for the whole body nothing has to be carried from link to link: velocities, wrenches and
//! inertias of different parts are simply added.

use crate::simulation::lanes::width::{Alone, Width};
use crate::simulation::lanes::{Everywhere, Real, Vec3};
use nalgebra::{Matrix3, Vector3};
use std::ops::{Add, AddAssign, Mul, Sub, SubAssign};

/// A motion (angular over linear velocity of the body's point at the reference) or a wrench (moment about the
/// reference over force). Which of them, its place says.
#[derive(Clone, Copy)]
pub struct Spatial<W: Width>(pub [Real<W>; 6]);

impl<W: Width> Spatial<W> {
    /// Nothing.
    #[inline(always)]
    pub fn zero(width: W) -> Self {
        Self([width.real(0.0); 6])
    }

    /// An angular over a linear part.
    #[inline(always)]
    pub fn new(angular: Vec3<W>, linear: Vec3<W>) -> Self {
        let ([a, b, c], [x, y, z]) = (angular.0, linear.0);
        Self([a, b, c, x, y, z])
    }

    /// The upper half: an angular velocity, or a moment.
    #[inline(always)]
    pub fn angular(&self) -> Vec3<W> {
        Vec3([self.0[0], self.0[1], self.0[2]])
    }

    /// The lower half: a linear velocity, or a force.
    #[inline(always)]
    pub fn linear(&self) -> Vec3<W> {
        Vec3([self.0[3], self.0[4], self.0[5]])
    }

    /// What it is in one world.
    #[inline(always)]
    pub fn lane(&self, lane: usize) -> Spatial<Alone> {
        Spatial::new(self.angular().lane(lane), self.linear().lane(lane))
    }

    /// Sets what it is in one world.
    pub fn set_lane(&mut self, lane: usize, spatial: Spatial<Alone>) {
        for (x, new) in self.0.iter_mut().zip(spatial.0) {
            x.set(lane, new.get(0));
        }
    }

    /// The power of a wrench on a motion.
    #[inline(always)]
    pub fn dot(&self, other: &Self) -> Real<W> {
        let (a, b) = (&self.0, &other.0);
        (a[0] * b[0] + a[1] * b[1] + a[2] * b[2]) + (a[3] * b[3] + a[4] * b[4] + a[5] * b[5])
    }

    /// How this motion changes in a body that moves by a velocity: the cross product for motions (eq. 2.31).
    #[inline(always)]
    pub fn carried_by(&self, velocity: &Self) -> Self {
        let (turn, shift) = (velocity.angular(), velocity.linear());
        let (angular, linear) = (self.angular(), self.linear());
        Self::new(turn.cross(&angular), turn.cross(&linear) + shift.cross(&angular))
    }

    /// The velocity of the body's point at a place, for a motion.
    #[inline(always)]
    pub fn velocity_at(&self, place: &Vec3<W>) -> Vec3<W> {
        self.linear() + self.angular().cross(place)
    }

    /// The wrench of a force, or of an impulse, at a place.
    #[inline(always)]
    pub fn of_force_at(force: &Vec3<W>, place: &Vec3<W>) -> Self {
        Self::new(place.cross(force), *force)
    }

    /// This wrench with another reference, which is there in terms of the present one.
    #[inline(always)]
    pub fn wrench_about(&self, place: &Vec3<W>) -> Self {
        Self::new(self.angular() - place.cross(&self.linear()), self.linear())
    }

    /// Times a number.
    #[inline(always)]
    pub fn times(&self, factor: Real<W>) -> Self {
        let [a, b, c, x, y, z] = self.0;
        Self([a * factor, b * factor, c * factor, x * factor, y * factor, z * factor])
    }
}

impl<W: Width> Add for Spatial<W> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self::new(self.angular() + other.angular(), self.linear() + other.linear())
    }
}

impl<W: Width> Sub for Spatial<W> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self::new(self.angular() - other.angular(), self.linear() - other.linear())
    }
}

impl<W: Width> AddAssign for Spatial<W> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<W: Width> SubAssign for Spatial<W> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl<W: Width> Mul<Real<W>> for Spatial<W> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, factor: Real<W>) -> Self {
        self.times(factor)
    }
}

/// A matrix in each world, as columns.
#[derive(Clone, Copy)]
pub struct Mat3<W: Width>(pub [Vec3<W>; 3]);

impl<W: Width> Mat3<W> {
    /// The same matrix in every world.
    pub fn everywhere(width: W, matrix: &Matrix3<f64>) -> Self {
        Self([0, 1, 2].map(|i| width.vector(&matrix.column(i).into_owned())))
    }

    /// The matrix in one world.
    #[inline(always)]
    pub fn lane(&self, lane: usize) -> Mat3<Alone> {
        Mat3(self.0.map(|column| column.lane(lane)))
    }

    /// Rows for columns.
    #[inline(always)]
    pub fn transposed(&self) -> Self {
        let [Vec3([xx, yx, zx]), Vec3([xy, yy, zy]), Vec3([xz, yz, zz])] = self.0;
        Self([Vec3([xx, xy, xz]), Vec3([yx, yy, yz]), Vec3([zx, zy, zz])])
    }

    /// The product with a vector.
    #[inline(always)]
    pub fn applied(&self, vector: &Vec3<W>) -> Vec3<W> {
        let [x, y, z] = vector.0;
        self.0[0].times(x) + self.0[1].times(y) + self.0[2].times(z)
    }

    /// The product with a vector that is the same in every world.
    #[inline(always)]
    pub fn applied_to(&self, vector: &Vector3<f64>) -> Vec3<W> {
        self.0[0] * vector.x + self.0[1] * vector.y + self.0[2] * vector.z
    }

    /// The product with a matrix.
    #[inline(always)]
    pub fn product(&self, right: &Self) -> Self {
        let [x, y, z] = &right.0;
        Self([self.applied(x), self.applied(y), self.applied(z)])
    }

    /// The product with a matrix that is the same in every world.
    #[inline(always)]
    pub fn product_with(&self, right: &Matrix3<f64>) -> Self {
        let mut product = *self;
        for (i, column) in product.0.iter_mut().enumerate() {
            *column = self.applied_to(&right.column(i).into_owned());
        }
        product
    }
}

/// The inertia of a rigid body.
#[derive(Clone, Copy)]
pub struct RigidInertia<W: Width> {
    /// The mass, in kilograms.
    pub mass_kg: f64,
    /// The centre of mass, from the reference, in metres.
    pub centre_m: Vec3<W>,
    /// The rotational inertia about the centre of mass, in kg·m².
    pub about_centre: Mat3<W>,
}

impl<W: Width> RigidInertia<W> {
    /// What it is in one world.
    pub fn lane(&self, lane: usize) -> RigidInertia<Alone> {
        RigidInertia {
            mass_kg: self.mass_kg,
            centre_m: self.centre_m.lane(lane),
            about_centre: self.about_centre.lane(lane),
        }
    }

    /// The momentum that a motion has.
    #[inline(always)]
    pub fn times(&self, motion: &Spatial<W>) -> Spatial<W> {
        let momentum = motion.velocity_at(&self.centre_m) * self.mass_kg;
        let spin = self.about_centre.applied(&motion.angular());
        Spatial::new(spin + self.centre_m.cross(&momentum), momentum)
    }

    /// All of its entries (eq. 2.63).
    #[inline(always)]
    pub fn spread(&self) -> Inertia<W> {
        let [x, y, z] = self.centre_m.0;
        let (mx, my, mz) = (x * self.mass_kg, y * self.mass_kg, z * self.mass_kg);
        let [Vec3([xx, yx, zx]), Vec3([_, yy, zy]), Vec3([_, _, zz])] = self.about_centre.0;
        let (yx, zx, zy) = (yx - my * x, zx - mz * x, zy - mz * y);
        let xx = xx + my * y + mz * z;
        let yy = yy + mx * x + mz * z;
        let zz = zz + mx * x + my * y;
        let (none, mass) = (x.width.real(0.0), x.width.real(self.mass_kg));
        Inertia([
            [xx, none, none, none, none, none],
            [yx, yy, none, none, none, none],
            [zx, zy, zz, none, none, none],
            [none, mz, -my, mass, none, none],
            [-mz, none, mx, none, mass, none],
            [my, -mx, none, none, none, mass],
        ])
    }
}

/// A spatial inertia, rigid or articulated: symmetric, and of its rows only what is up to the diagonal is used.
#[derive(Clone, Copy)]
pub struct Inertia<W: Width>([[Real<W>; 6]; 6]);

impl<W: Width> Inertia<W> {
    /// Nothing.
    pub fn zero(width: W) -> Self {
        Self([[width.real(0.0); 6]; 6])
    }

    /// An entry.
    #[inline(always)]
    pub fn at(&self, row: usize, column: usize) -> Real<W> {
        if row >= column { self.0[row][column] } else { self.0[column][row] }
    }

    /// The wrench that gives a motion in a unit of time, or its momentum.
    #[inline(always)]
    pub fn times(&self, motion: &Spatial<W>) -> Spatial<W> {
        let m = &motion.0;
        let mut wrench = *motion;
        for (i, sum) in wrench.0.iter_mut().enumerate() {
            *sum = (self.at(i, 0) * m[0] + self.at(i, 1) * m[1] + self.at(i, 2) * m[2])
                + (self.at(i, 3) * m[3] + self.at(i, 4) * m[4] + self.at(i, 5) * m[5]);
        }
        wrench
    }

    /// Adds another inertia.
    #[inline(always)]
    pub fn add(&mut self, other: &Self) {
        for row in 0..6 {
            for column in 0..=row {
                self.0[row][column] += other.0[row][column];
            }
        }
    }

    /// Takes away the product of a wrench with itself.
    #[inline(always)]
    pub fn subtract_square(&mut self, wrench: &Spatial<W>) {
        for row in 0..6 {
            for column in 0..=row {
                self.0[row][column] -= wrench.0[row] * wrench.0[column];
            }
        }
    }
}
