//! How many numbers go side by side, and what does the work.
//!
//! [`Alone`] is one plain number, on any processor. On x86 there is AVX2 for four lanes and AVX-512 for eight, by the
//! tokens of `pulp`: who has one has the instructions. All round alike (IEEE 754), so that a lane has the same bits in
//! each of them. [`Pair`] is the two lanes that every x86 of 64 bits has: articulated bodies are no faster in them than in
//! one, lattices are.

mod alone;
#[cfg(target_arch = "x86_64")]
mod pair;
#[cfg(target_arch = "x86_64")]
mod x86;

pub use alone::Alone;
#[cfg(target_arch = "x86_64")]
pub use pair::{Pair, pair};
#[cfg(target_arch = "x86_64")]
pub use x86::{Avx2, Avx512, avx2, avx512};

/// Nothing that other processors have.
#[cfg(not(target_arch = "x86_64"))]
pub type Pair = Alone;
/// Nothing that other processors have.
#[cfg(not(target_arch = "x86_64"))]
pub type Avx2 = Alone;
/// Nothing that other processors have.
#[cfg(not(target_arch = "x86_64"))]
pub type Avx512 = Alone;

/// It has none.
#[cfg(not(target_arch = "x86_64"))]
pub fn pair() -> Option<Pair> {
    None
}

/// It has none.
#[cfg(not(target_arch = "x86_64"))]
pub fn avx2() -> Option<Avx2> {
    None
}

/// It has none.
#[cfg(not(target_arch = "x86_64"))]
pub fn avx512() -> Option<Avx512> {
    None
}

/// Lanes of the numbers of a type.
pub trait Numbers<T>: Masks {
    /// A number in each lane.
    type All: Copy + Send;

    /// The same number in every lane.
    fn splat(self, number: T) -> Self::All;
    /// The number in one lane.
    fn get(all: &Self::All, lane: usize) -> T;
    /// Sets the number in one lane.
    fn set(all: &mut Self::All, lane: usize, number: T);
    /// a + b.
    fn add(self, a: Self::All, b: Self::All) -> Self::All;
    /// a - b.
    fn sub(self, a: Self::All, b: Self::All) -> Self::All;
    /// a · b.
    fn mul(self, a: Self::All, b: Self::All) -> Self::All;
    /// a/b.
    fn div(self, a: Self::All, b: Self::All) -> Self::All;
    /// -a.
    fn neg(self, a: Self::All) -> Self::All;
    /// |a|.
    fn abs(self, a: Self::All) -> Self::All;
    /// √a.
    fn sqrt(self, a: Self::All) -> Self::All;
    /// a where a > b, else b.
    fn max(self, a: Self::All, b: Self::All) -> Self::All;
    /// a where a < b, else b.
    fn min(self, a: Self::All, b: Self::All) -> Self::All;
    /// Where a < b.
    fn less(self, a: Self::All, b: Self::All) -> Self::Bits;
    /// Where a ≤ b.
    fn at_most(self, a: Self::All, b: Self::All) -> Self::Bits;
    /// a where it is so, else b.
    fn choose(self, is_so: Self::Bits, a: Self::All, b: Self::All) -> Self::All;
}

/// Sets of lanes.
pub trait Masks: Copy + Send + Sync + 'static {
    /// A set.
    type Bits: Copy + Send;

    /// All lanes, or none.
    fn bits(self, all: bool) -> Self::Bits;
    /// Puts a lane in or takes it out.
    fn put(bits: &mut Self::Bits, lane: usize, is_in: bool);
    /// Lanes that are in both.
    fn and(self, a: Self::Bits, b: Self::Bits) -> Self::Bits;
    /// Lanes that are in one of them.
    fn or(self, a: Self::Bits, b: Self::Bits) -> Self::Bits;
    /// Lanes that are not in it.
    fn not(self, a: Self::Bits) -> Self::Bits;
    /// Whether any lane is in it.
    fn any(self, a: Self::Bits) -> bool;
    /// Whether all lanes are in it.
    fn all(self, a: Self::Bits) -> bool;
}

/// A number of lanes, and what does the work.
pub trait Width: Numbers<f64> + Numbers<f32> {
    /// How many.
    const LANES: usize;

    /// In single precision.
    fn narrowed(self, numbers: <Self as Numbers<f64>>::All) -> <Self as Numbers<f32>>::All;

    /// In double precision.
    fn widened(self, numbers: <Self as Numbers<f32>>::All) -> <Self as Numbers<f64>>::All;

    /// Does work where the processor's instructions for this width can be used.
    fn with<T>(self, work: impl Work<Output = T>) -> T;
}

/// What [`Width::with`] does. Unlike a closure it is sure to be compiled in place.
pub trait Work {
    /// What comes of it.
    type Output;

    /// Does it; to be marked `#[inline(always)]`.
    fn run(self) -> Self::Output;
}
