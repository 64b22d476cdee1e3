//! Four lanes of AVX2 and eight of AVX-512.

use super::{Masks, Numbers, Width, Work};
use bytemuck::{cast, cast_mut, cast_ref};
use pulp::x86::{V3, V4};
use pulp::{NullaryFnOnce, b8, f32x4, f32x8, f64x4, f64x8, m32x4, m64x4};

/// Four lanes.
pub type Avx2 = V3;
/// Eight lanes.
pub type Avx512 = V4;

/// AVX2, if the processor has it.
pub fn avx2() -> Option<Avx2> {
    V3::try_new()
}

/// AVX-512, if the processor has it.
pub fn avx512() -> Option<Avx512> {
    V4::try_new()
}

/// Numbers that do not lie across lines of the cache.
#[derive(Clone, Copy)]
#[repr(align(64))]
pub struct Line<T>(T);

/// The same, of half the size.
#[derive(Clone, Copy)]
#[repr(align(32))]
pub struct HalfLine<T>(T);

/// The same, of a quarter of the size.
#[derive(Clone, Copy)]
#[repr(align(16))]
pub struct QuarterLine<T>(T);

impl<W: Work> NullaryFnOnce for Wrapped<W> {
    type Output = W::Output;

    #[inline(always)]
    fn call(self) -> W::Output {
        self.0.run()
    }
}

struct Wrapped<W>(W);

macro_rules! numbers {
    ($simd:ty, $number:ty, $raw:ty, $line:ident, $lanes:literal,
     $add:ident $sub:ident $mul:ident $div:ident $xor:ident $abs:ident $sqrt:ident
     $max:ident $min:ident $less:ident $at_most:ident $select:ident $splat:ident,
     $to:expr, $from:expr) => {
        impl Numbers<$number> for $simd {
            type All = $line<$raw>;

            #[inline(always)]
            fn splat(self, number: $number) -> Self::All {
                $line(self.$splat(number))
            }

            #[inline(always)]
            fn get(all: &Self::All, lane: usize) -> $number {
                cast_ref::<$raw, [$number; $lanes]>(&all.0)[lane]
            }

            #[inline(always)]
            fn set(all: &mut Self::All, lane: usize, number: $number) {
                cast_mut::<$raw, [$number; $lanes]>(&mut all.0)[lane] = number;
            }

            #[inline(always)]
            fn add(self, a: Self::All, b: Self::All) -> Self::All {
                $line(self.$add(a.0, b.0))
            }

            #[inline(always)]
            fn sub(self, a: Self::All, b: Self::All) -> Self::All {
                $line(self.$sub(a.0, b.0))
            }

            #[inline(always)]
            fn mul(self, a: Self::All, b: Self::All) -> Self::All {
                $line(self.$mul(a.0, b.0))
            }

            #[inline(always)]
            fn div(self, a: Self::All, b: Self::All) -> Self::All {
                $line(self.$div(a.0, b.0))
            }

            #[inline(always)]
            fn neg(self, a: Self::All) -> Self::All {
                $line(self.$xor(a.0, self.$splat(-0.0)))
            }

            #[inline(always)]
            fn abs(self, a: Self::All) -> Self::All {
                $line(self.$abs(a.0))
            }

            #[inline(always)]
            fn sqrt(self, a: Self::All) -> Self::All {
                $line(self.$sqrt(a.0))
            }

            #[inline(always)]
            fn max(self, a: Self::All, b: Self::All) -> Self::All {
                $line(self.$max(a.0, b.0))
            }

            #[inline(always)]
            fn min(self, a: Self::All, b: Self::All) -> Self::All {
                $line(self.$min(a.0, b.0))
            }

            #[inline(always)]
            fn less(self, a: Self::All, b: Self::All) -> Self::Bits {
                ($to)(self, self.$less(a.0, b.0))
            }

            #[inline(always)]
            fn at_most(self, a: Self::All, b: Self::All) -> Self::Bits {
                ($to)(self, self.$at_most(a.0, b.0))
            }

            #[inline(always)]
            fn choose(self, is_so: Self::Bits, a: Self::All, b: Self::All) -> Self::All {
                $line(self.$select(($from)(self, is_so), a.0, b.0))
            }
        }
    };
}

impl Masks for V4 {
    type Bits = b8;

    #[inline(always)]
    fn bits(self, all: bool) -> b8 {
        b8(if all { u8::MAX } else { 0 })
    }

    #[inline(always)]
    fn put(bits: &mut b8, lane: usize, is_in: bool) {
        bits.0 = bits.0 & !(1 << lane) | u8::from(is_in) << lane;
    }

    #[inline(always)]
    fn and(self, a: b8, b: b8) -> b8 {
        b8(a.0 & b.0)
    }

    #[inline(always)]
    fn or(self, a: b8, b: b8) -> b8 {
        b8(a.0 | b.0)
    }

    #[inline(always)]
    fn not(self, a: b8) -> b8 {
        b8(!a.0)
    }

    #[inline(always)]
    fn any(self, a: b8) -> bool {
        a.0 != 0
    }

    #[inline(always)]
    fn all(self, a: b8) -> bool {
        a.0 == u8::MAX
    }
}

numbers!(V4, f64, f64x8, Line, 8,
    add_f64x8 sub_f64x8 mul_f64x8 div_f64x8 xor_f64x8 abs_f64x8 sqrt_f64x8
    max_f64x8 min_f64x8 cmp_lt_f64x8 cmp_le_f64x8 select_f64x8 splat_f64x8,
    |_: V4, bits: b8| bits, |_: V4, bits: b8| bits);
numbers!(V4, f32, f32x8, HalfLine, 8,
    add_f32x8 sub_f32x8 mul_f32x8 div_f32x8 xor_f32x8 abs_f32x8 sqrt_f32x8
    max_f32x8 min_f32x8 cmp_lt_f32x8 cmp_le_f32x8 select_f32x8 splat_f32x8,
    |_: V4, bits: b8| bits, |_: V4, bits: b8| bits);

impl Width for V4 {
    const LANES: usize = 8;

    #[inline(always)]
    fn narrowed(self, numbers: Line<f64x8>) -> HalfLine<f32x8> {
        HalfLine(self.convert_f64x8_to_f32x8(numbers.0))
    }

    #[inline(always)]
    fn widened(self, numbers: HalfLine<f32x8>) -> Line<f64x8> {
        Line(self.convert_f32x8_to_f64x8(numbers.0))
    }

    #[inline(always)]
    fn with<T>(self, work: impl Work<Output = T>) -> T {
        self.vectorize(Wrapped(work))
    }
}

impl Masks for V3 {
    type Bits = m32x4;

    #[inline(always)]
    fn bits(self, all: bool) -> m32x4 {
        cast([if all { u32::MAX } else { 0 }; 4])
    }

    #[inline(always)]
    fn put(bits: &mut m32x4, lane: usize, is_in: bool) {
        cast_mut::<m32x4, [u32; 4]>(bits)[lane] = if is_in { u32::MAX } else { 0 };
    }

    #[inline(always)]
    fn and(self, a: m32x4, b: m32x4) -> m32x4 {
        self.and_m32x4(a, b)
    }

    #[inline(always)]
    fn or(self, a: m32x4, b: m32x4) -> m32x4 {
        self.or_m32x4(a, b)
    }

    #[inline(always)]
    fn not(self, a: m32x4) -> m32x4 {
        self.not_m32x4(a)
    }

    #[inline(always)]
    fn any(self, a: m32x4) -> bool {
        self.sse._mm_movemask_ps(cast(a)) != 0
    }

    #[inline(always)]
    fn all(self, a: m32x4) -> bool {
        self.sse._mm_movemask_ps(cast(a)) == 0b1111
    }
}

/// A mask of doubles as one of singles: the lower halves.
#[inline(always)]
fn halved(simd: V3, mask: m64x4) -> m32x4 {
    let lower = cast([0_u32, 2, 4, 6, 0, 2, 4, 6]);
    let packed = simd.avx2._mm256_permutevar8x32_epi32(cast(mask), lower);
    cast(simd.avx._mm256_castsi256_si128(packed))
}

/// A mask of singles as one of doubles.
#[inline(always)]
fn doubled(simd: V3, mask: m32x4) -> m64x4 {
    cast(simd.convert_i32x4_to_i64x4(cast(mask)))
}

numbers!(V3, f64, f64x4, HalfLine, 4,
    add_f64x4 sub_f64x4 mul_f64x4 div_f64x4 xor_f64x4 abs_f64x4 sqrt_f64x4
    max_f64x4 min_f64x4 cmp_lt_f64x4 cmp_le_f64x4 select_f64x4 splat_f64x4,
    halved, doubled);
numbers!(V3, f32, f32x4, QuarterLine, 4,
    add_f32x4 sub_f32x4 mul_f32x4 div_f32x4 xor_f32x4 abs_f32x4 sqrt_f32x4
    max_f32x4 min_f32x4 cmp_lt_f32x4 cmp_le_f32x4 select_f32x4 splat_f32x4,
    |_: V3, bits: m32x4| bits, |_: V3, bits: m32x4| bits);

impl Width for V3 {
    const LANES: usize = 4;

    #[inline(always)]
    fn narrowed(self, numbers: HalfLine<f64x4>) -> QuarterLine<f32x4> {
        QuarterLine(self.convert_f64x4_to_f32x4(numbers.0))
    }

    #[inline(always)]
    fn widened(self, numbers: QuarterLine<f32x4>) -> HalfLine<f64x4> {
        HalfLine(self.convert_f32x4_to_f64x4(numbers.0))
    }

    #[inline(always)]
    fn with<T>(self, work: impl Work<Output = T>) -> T {
        self.vectorize(Wrapped(work))
    }
}
