//! Two lanes of SSE2, which is part of x86-64.

use super::{Masks, Numbers, Width, Work};
use bytemuck::{cast, cast_mut, cast_ref};
use pulp::core_arch::x86::Sse2;
use std::arch::x86_64::__m128d;
use std::array;

/// Two lanes.
#[derive(Debug, Clone, Copy)]
pub struct Pair(Sse2);

/// Two lanes, if the processor has SSE2.
pub fn pair() -> Option<Pair> {
    Sse2::try_new().map(Pair)
}

impl Masks for Pair {
    type Bits = __m128d;

    #[inline(always)]
    fn bits(self, all: bool) -> __m128d {
        cast([if all { u64::MAX } else { 0 }; 2])
    }

    #[inline(always)]
    fn put(bits: &mut __m128d, lane: usize, is_in: bool) {
        cast_mut::<__m128d, [u64; 2]>(bits)[lane] = if is_in { u64::MAX } else { 0 };
    }

    #[inline(always)]
    fn and(self, a: __m128d, b: __m128d) -> __m128d {
        self.0._mm_and_pd(a, b)
    }

    #[inline(always)]
    fn or(self, a: __m128d, b: __m128d) -> __m128d {
        self.0._mm_or_pd(a, b)
    }

    #[inline(always)]
    fn not(self, a: __m128d) -> __m128d {
        self.0._mm_andnot_pd(a, self.bits(true))
    }

    #[inline(always)]
    fn any(self, a: __m128d) -> bool {
        self.0._mm_movemask_pd(a) != 0
    }

    #[inline(always)]
    fn all(self, a: __m128d) -> bool {
        self.0._mm_movemask_pd(a) == 0b11
    }
}

impl Numbers<f64> for Pair {
    type All = __m128d;

    #[inline(always)]
    fn splat(self, number: f64) -> __m128d {
        self.0._mm_set1_pd(number)
    }

    #[inline(always)]
    fn get(all: &__m128d, lane: usize) -> f64 {
        cast_ref::<__m128d, [f64; 2]>(all)[lane]
    }

    #[inline(always)]
    fn set(all: &mut __m128d, lane: usize, number: f64) {
        cast_mut::<__m128d, [f64; 2]>(all)[lane] = number;
    }

    #[inline(always)]
    fn add(self, a: __m128d, b: __m128d) -> __m128d {
        self.0._mm_add_pd(a, b)
    }

    #[inline(always)]
    fn sub(self, a: __m128d, b: __m128d) -> __m128d {
        self.0._mm_sub_pd(a, b)
    }

    #[inline(always)]
    fn mul(self, a: __m128d, b: __m128d) -> __m128d {
        self.0._mm_mul_pd(a, b)
    }

    #[inline(always)]
    fn div(self, a: __m128d, b: __m128d) -> __m128d {
        self.0._mm_div_pd(a, b)
    }

    #[inline(always)]
    fn neg(self, a: __m128d) -> __m128d {
        self.0._mm_xor_pd(a, self.0._mm_set1_pd(-0.0))
    }

    #[inline(always)]
    fn abs(self, a: __m128d) -> __m128d {
        self.0._mm_andnot_pd(self.0._mm_set1_pd(-0.0), a)
    }

    #[inline(always)]
    fn sqrt(self, a: __m128d) -> __m128d {
        self.0._mm_sqrt_pd(a)
    }

    #[inline(always)]
    fn max(self, a: __m128d, b: __m128d) -> __m128d {
        self.0._mm_max_pd(a, b)
    }

    #[inline(always)]
    fn min(self, a: __m128d, b: __m128d) -> __m128d {
        self.0._mm_min_pd(a, b)
    }

    #[inline(always)]
    fn less(self, a: __m128d, b: __m128d) -> __m128d {
        self.0._mm_cmplt_pd(a, b)
    }

    #[inline(always)]
    fn at_most(self, a: __m128d, b: __m128d) -> __m128d {
        self.0._mm_cmple_pd(a, b)
    }

    #[inline(always)]
    fn choose(self, is_so: __m128d, a: __m128d, b: __m128d) -> __m128d {
        self.0._mm_or_pd(self.0._mm_and_pd(is_so, a), self.0._mm_andnot_pd(is_so, b))
    }
}

/// A number of two in single precision, as a plain array: nothing here needs them fast.
impl Numbers<f32> for Pair {
    type All = [f32; 2];

    #[inline(always)]
    fn splat(self, number: f32) -> [f32; 2] {
        [number; 2]
    }

    #[inline(always)]
    fn get(all: &[f32; 2], lane: usize) -> f32 {
        all[lane]
    }

    #[inline(always)]
    fn set(all: &mut [f32; 2], lane: usize, number: f32) {
        all[lane] = number;
    }

    #[inline(always)]
    fn add(self, a: [f32; 2], b: [f32; 2]) -> [f32; 2] {
        array::from_fn(|lane| a[lane] + b[lane])
    }

    #[inline(always)]
    fn sub(self, a: [f32; 2], b: [f32; 2]) -> [f32; 2] {
        array::from_fn(|lane| a[lane] - b[lane])
    }

    #[inline(always)]
    fn mul(self, a: [f32; 2], b: [f32; 2]) -> [f32; 2] {
        array::from_fn(|lane| a[lane] * b[lane])
    }

    #[inline(always)]
    fn div(self, a: [f32; 2], b: [f32; 2]) -> [f32; 2] {
        array::from_fn(|lane| a[lane] / b[lane])
    }

    #[inline(always)]
    fn neg(self, a: [f32; 2]) -> [f32; 2] {
        a.map(|number| -number)
    }

    #[inline(always)]
    fn abs(self, a: [f32; 2]) -> [f32; 2] {
        a.map(f32::abs)
    }

    #[inline(always)]
    fn sqrt(self, a: [f32; 2]) -> [f32; 2] {
        a.map(f32::sqrt)
    }

    #[inline(always)]
    fn max(self, a: [f32; 2], b: [f32; 2]) -> [f32; 2] {
        array::from_fn(|lane| if a[lane] > b[lane] { a[lane] } else { b[lane] })
    }

    #[inline(always)]
    fn min(self, a: [f32; 2], b: [f32; 2]) -> [f32; 2] {
        array::from_fn(|lane| if a[lane] < b[lane] { a[lane] } else { b[lane] })
    }

    #[inline(always)]
    fn less(self, a: [f32; 2], b: [f32; 2]) -> __m128d {
        cast([0, 1].map(|lane| if a[lane] < b[lane] { u64::MAX } else { 0 }))
    }

    #[inline(always)]
    fn at_most(self, a: [f32; 2], b: [f32; 2]) -> __m128d {
        cast([0, 1].map(|lane| if a[lane] <= b[lane] { u64::MAX } else { 0 }))
    }

    #[inline(always)]
    fn choose(self, is_so: __m128d, a: [f32; 2], b: [f32; 2]) -> [f32; 2] {
        let is_so = cast::<__m128d, [u64; 2]>(is_so);
        array::from_fn(|lane| if is_so[lane] != 0 { a[lane] } else { b[lane] })
    }
}

impl Width for Pair {
    const LANES: usize = 2;

    #[inline(always)]
    fn narrowed(self, numbers: __m128d) -> [f32; 2] {
        cast::<__m128d, [f64; 2]>(numbers).map(|number| number as f32)
    }

    #[inline(always)]
    fn widened(self, numbers: [f32; 2]) -> __m128d {
        cast(numbers.map(f64::from))
    }

    #[inline(always)]
    fn with<T>(self, work: impl Work<Output = T>) -> T {
        work.run()
    }
}
