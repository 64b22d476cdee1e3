//! One lane.

use super::{Masks, Numbers, Width, Work};

/// One lane: a plain number, on any processor.
#[derive(Debug, Clone, Copy)]
pub struct Alone;

impl Masks for Alone {
    type Bits = bool;

    #[inline(always)]
    fn bits(self, all: bool) -> bool {
        all
    }

    #[inline(always)]
    fn put(bits: &mut bool, _: usize, is_in: bool) {
        *bits = is_in;
    }

    #[inline(always)]
    fn and(self, a: bool, b: bool) -> bool {
        a & b
    }

    #[inline(always)]
    fn or(self, a: bool, b: bool) -> bool {
        a | b
    }

    #[inline(always)]
    fn not(self, a: bool) -> bool {
        !a
    }

    #[inline(always)]
    fn any(self, a: bool) -> bool {
        a
    }

    #[inline(always)]
    fn all(self, a: bool) -> bool {
        a
    }
}

macro_rules! alone {
    ($number:ty) => {
        impl Numbers<$number> for Alone {
            type All = $number;

            #[inline(always)]
            fn splat(self, number: $number) -> $number {
                number
            }

            #[inline(always)]
            fn get(all: &$number, _: usize) -> $number {
                *all
            }

            #[inline(always)]
            fn set(all: &mut $number, _: usize, number: $number) {
                *all = number;
            }

            #[inline(always)]
            fn add(self, a: $number, b: $number) -> $number {
                a + b
            }

            #[inline(always)]
            fn sub(self, a: $number, b: $number) -> $number {
                a - b
            }

            #[inline(always)]
            fn mul(self, a: $number, b: $number) -> $number {
                a * b
            }

            #[inline(always)]
            fn div(self, a: $number, b: $number) -> $number {
                a / b
            }

            #[inline(always)]
            fn neg(self, a: $number) -> $number {
                -a
            }

            #[inline(always)]
            fn abs(self, a: $number) -> $number {
                a.abs()
            }

            #[inline(always)]
            fn sqrt(self, a: $number) -> $number {
                a.sqrt()
            }

            #[inline(always)]
            fn max(self, a: $number, b: $number) -> $number {
                if a > b { a } else { b }
            }

            #[inline(always)]
            fn min(self, a: $number, b: $number) -> $number {
                if a < b { a } else { b }
            }

            #[inline(always)]
            fn less(self, a: $number, b: $number) -> bool {
                a < b
            }

            #[inline(always)]
            fn at_most(self, a: $number, b: $number) -> bool {
                a <= b
            }

            #[inline(always)]
            fn choose(self, is_so: bool, a: $number, b: $number) -> $number {
                if is_so { a } else { b }
            }
        }
    };
}

alone!(f64);
alone!(f32);

impl Width for Alone {
    const LANES: usize = 1;

    #[inline(always)]
    fn narrowed(self, number: f64) -> f32 {
        number as f32
    }

    #[inline(always)]
    fn widened(self, number: f32) -> f64 {
        f64::from(number)
    }

    #[inline(always)]
    fn with<T>(self, work: impl Work<Output = T>) -> T {
        work.run()
    }
}
