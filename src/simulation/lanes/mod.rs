//! Numbers side by side: the same one in several worlds, a lane each.
//!
//! The trials of a body are one body in worlds that differ a little, so that they take the same steps with other
//! numbers: what a processor does to eight numbers at a time as fast as to one. No operation here looks across lanes,
//! none joins a product and a sum, and each lane of a result has the bits that it would have alone; so how many go
//! side by side changes no result.

pub mod width;

use nalgebra::Vector3;
use std::ops::{Add, AddAssign, BitAnd, BitOr, Div, Mul, Neg, Not, Sub, SubAssign};
use width::{Alone, Masks, Numbers, Width};

/// A number in each world.
#[derive(Clone, Copy)]
pub struct Lanes<T, W: Numbers<T>> {
    /// What works on it.
    pub width: W,
    numbers: W::All,
}

/// In double precision.
pub type Real<W> = Lanes<f64, W>;
/// In single precision.
pub type Single<W> = Lanes<f32, W>;

/// Which of the worlds are meant.
#[derive(Clone, Copy)]
pub struct Mask<W: Masks> {
    width: W,
    bits: W::Bits,
}

/// A vector in each world.
#[derive(Clone, Copy)]
pub struct Vec3<W: Width>(pub [Real<W>; 3]);

/// The same in every world.
pub trait Everywhere: Width {
    /// A number.
    #[inline(always)]
    fn real(self, number: f64) -> Real<Self> {
        Lanes { width: self, numbers: self.splat(number) }
    }

    /// A number in single precision.
    #[inline(always)]
    fn single(self, number: f32) -> Single<Self> {
        Lanes { width: self, numbers: self.splat(number) }
    }

    /// Every world is meant, or none.
    #[inline(always)]
    fn mask(self, is_meant: bool) -> Mask<Self> {
        Mask { width: self, bits: self.bits(is_meant) }
    }

    /// A vector.
    #[inline(always)]
    fn vector(self, vector: &Vector3<f64>) -> Vec3<Self> {
        Vec3([self.real(vector.x), self.real(vector.y), self.real(vector.z)])
    }
}

impl<W: Width> Everywhere for W {}

impl<T: Copy, W: Numbers<T>> Lanes<T, W> {
    /// The number in one world.
    #[inline(always)]
    pub fn get(&self, lane: usize) -> T {
        W::get(&self.numbers, lane)
    }

    /// Sets the number in one world.
    #[inline(always)]
    pub fn set(&mut self, lane: usize, number: T) {
        W::set(&mut self.numbers, lane, number);
    }

    #[inline(always)]
    fn with(self, numbers: W::All) -> Self {
        Self { width: self.width, numbers }
    }

    /// The square root.
    #[inline(always)]
    pub fn sqrt(self) -> Self {
        self.with(self.width.sqrt(self.numbers))
    }

    /// Without its sign.
    #[inline(always)]
    pub fn abs(self) -> Self {
        self.with(self.width.abs(self.numbers))
    }

    /// This one where it is greater, else the other one.
    #[inline(always)]
    pub fn max(self, other: Self) -> Self {
        self.with(self.width.max(self.numbers, other.numbers))
    }

    /// This one where it is less, else the other one.
    #[inline(always)]
    pub fn min(self, other: Self) -> Self {
        self.with(self.width.min(self.numbers, other.numbers))
    }

    /// Where it is less.
    #[inline(always)]
    pub fn is_less(self, other: Self) -> Mask<W> {
        Mask { width: self.width, bits: self.width.less(self.numbers, other.numbers) }
    }

    /// Where it is not more; what is no number is not.
    #[inline(always)]
    pub fn is_at_most(self, other: Self) -> Mask<W> {
        Mask { width: self.width, bits: self.width.at_most(self.numbers, other.numbers) }
    }

    /// This one where it is meant, and another one elsewhere.
    #[inline(always)]
    pub fn where_or(self, meant: Mask<W>, other: Self) -> Self {
        self.with(self.width.choose(meant.bits, self.numbers, other.numbers))
    }

    /// The nearest number that is no further from zero than a bound; what is no number stays.
    #[inline(always)]
    pub fn within(self, bound: Self) -> Self {
        let inside = bound.where_or(bound.is_less(self), self);
        (-bound).where_or(inside.is_less(-bound), inside)
    }
}

impl<W: Width> Real<W> {
    /// This one where it is meant, and nothing elsewhere.
    #[inline(always)]
    pub fn only(self, meant: Mask<W>) -> Self {
        self.where_or(meant, self.width.real(0.0))
    }

    /// 1/x, and nothing of what is not positive: what cannot be moved needs no impulse.
    #[inline(always)]
    pub fn inverse(self) -> Self {
        let is_positive = self.width.real(f64::MIN_POSITIVE).is_less(self);
        (self.width.real(1.0) / self).only(is_positive)
    }

    /// 1/√x, and nothing of what is no positive number: a direction that has no inertia left does not move.
    #[inline(always)]
    pub fn inverse_root(self) -> Self {
        let is_positive = self.width.real(f64::MIN_POSITIVE).is_less(self);
        (self.width.real(1.0) / self.sqrt()).only(is_positive)
    }

    /// In single precision.
    #[inline(always)]
    pub fn single(self) -> Single<W> {
        Lanes { width: self.width, numbers: self.width.narrowed(self.numbers) }
    }
}

impl<W: Width> Single<W> {
    /// This one where it is meant, and nothing elsewhere.
    #[inline(always)]
    pub fn only(self, meant: Mask<W>) -> Self {
        self.where_or(meant, self.width.single(0.0))
    }

    /// In double precision.
    #[inline(always)]
    pub fn double(self) -> Real<W> {
        Lanes { width: self.width, numbers: self.width.widened(self.numbers) }
    }
}

macro_rules! operator {
    ($trait:ident, $method:ident) => {
        impl<T: Copy, W: Numbers<T>> $trait for Lanes<T, W> {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                self.with(self.width.$method(self.numbers, other.numbers))
            }
        }
    };
}

operator!(Add, add);
operator!(Sub, sub);
operator!(Mul, mul);
operator!(Div, div);

impl<W: Numbers<f64>> Mul<f64> for Lanes<f64, W> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        self.with(self.width.mul(self.numbers, self.width.splat(factor)))
    }
}

impl<T: Copy, W: Numbers<T>> Neg for Lanes<T, W> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        self.with(self.width.neg(self.numbers))
    }
}

impl<T: Copy, W: Numbers<T>> AddAssign for Lanes<T, W> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        self.numbers = self.width.add(self.numbers, other.numbers);
    }
}

impl<T: Copy, W: Numbers<T>> SubAssign for Lanes<T, W> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        self.numbers = self.width.sub(self.numbers, other.numbers);
    }
}

impl<W: Masks> Mask<W> {
    /// Sets whether a world is meant.
    #[inline(always)]
    pub fn put(&mut self, lane: usize, is_meant: bool) {
        W::put(&mut self.bits, lane, is_meant);
    }

    /// Whether any world is meant.
    #[inline(always)]
    pub fn any(self) -> bool {
        self.width.any(self.bits)
    }

    /// Whether every world is meant.
    #[inline(always)]
    pub fn all(self) -> bool {
        self.width.all(self.bits)
    }
}

impl<W: Masks> BitAnd for Mask<W> {
    type Output = Self;

    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        Self { width: self.width, bits: self.width.and(self.bits, other.bits) }
    }
}

impl<W: Masks> BitOr for Mask<W> {
    type Output = Self;

    #[inline(always)]
    fn bitor(self, other: Self) -> Self {
        Self { width: self.width, bits: self.width.or(self.bits, other.bits) }
    }
}

impl<W: Masks> Not for Mask<W> {
    type Output = Self;

    #[inline(always)]
    fn not(self) -> Self {
        Self { width: self.width, bits: self.width.not(self.bits) }
    }
}

impl<W: Width> Vec3<W> {
    /// The vector in one world.
    #[inline(always)]
    pub fn lane(&self, lane: usize) -> Vec3<Alone> {
        let [x, y, z] = &self.0;
        Vec3([x.get(lane), y.get(lane), z.get(lane)].map(|number| Alone.real(number)))
    }

    /// Sets the vector in one world.
    #[inline(always)]
    pub fn set_lane(&mut self, lane: usize, vector: Vec3<Alone>) {
        for (x, new) in self.0.iter_mut().zip(vector.0) {
            x.set(lane, new.get(0));
        }
    }

    /// The scalar product.
    #[inline(always)]
    pub fn dot(&self, other: &Self) -> Real<W> {
        self.0[0] * other.0[0] + self.0[1] * other.0[1] + self.0[2] * other.0[2]
    }

    /// The square of its length.
    #[inline(always)]
    pub fn norm_squared(&self) -> Real<W> {
        self.dot(self)
    }

    /// Its length.
    #[inline(always)]
    pub fn norm(&self) -> Real<W> {
        self.norm_squared().sqrt()
    }

    /// The vector product.
    #[inline(always)]
    pub fn cross(&self, other: &Self) -> Self {
        let ([a, b, c], [x, y, z]) = (self.0, other.0);
        Self([b * z - c * y, c * x - a * z, a * y - b * x])
    }

    /// Times a number.
    #[inline(always)]
    pub fn times(&self, factor: Real<W>) -> Self {
        let [x, y, z] = self.0;
        Self([x * factor, y * factor, z * factor])
    }
}

impl Vec3<Alone> {
    /// The vector in the only world.
    pub fn alone(&self) -> Vector3<f64> {
        let [x, y, z] = &self.0;
        Vector3::new(x.get(0), y.get(0), z.get(0))
    }
}

impl<W: Width> Add for Vec3<W> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let ([a, b, c], [x, y, z]) = (self.0, other.0);
        Self([a + x, b + y, c + z])
    }
}

impl<W: Width> Sub for Vec3<W> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        let ([a, b, c], [x, y, z]) = (self.0, other.0);
        Self([a - x, b - y, c - z])
    }
}

impl<W: Width> Neg for Vec3<W> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        let [x, y, z] = self.0;
        Self([-x, -y, -z])
    }
}

impl<W: Width> Mul<f64> for Vec3<W> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        let [x, y, z] = self.0;
        Self([x * factor, y * factor, z * factor])
    }
}

impl<W: Width> AddAssign for Vec3<W> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}
