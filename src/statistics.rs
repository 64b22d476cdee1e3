//! What repeated runs come to, and whether two sets of them differ.
//!
//! Nothing is assumed about how values are distributed: medians and quartiles describe ([`Five`]), ranks compare
//! ([`mann_whitney`]), [`holm`] keeps many comparisons honest, and the effect size [`a12`] says whether a
//! difference matters. A value may be infinite, but not NaN.

/// The five numbers that a box plot draws.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Five {
    /// The smallest value.
    pub least: f64,
    /// A quarter of the values is below.
    pub lower: f64,
    /// Half of the values is below.
    pub median: f64,
    /// Three quarters of the values are below.
    pub upper: f64,
    /// The largest value.
    pub most: f64,
}

impl Five {
    /// Describes values in any order; none if there are none.
    pub fn of(values: &[f64]) -> Option<Self> {
        let mut sorted = values.to_vec();
        sorted.sort_unstable_by(f64::total_cmp);
        let at = |share| quantile(&sorted, share);
        Some(Self {
            least: at(0.0)?,
            lower: at(0.25)?,
            median: at(0.5)?,
            upper: at(0.75)?,
            most: at(1.0)?,
        })
    }
}

/// The value that a share (0 to 1) of `sorted` values is below, between two of them by linear interpolation (type 7
/// of Hyndman & Fan 1996, as in R and NumPy); none if there are no values.
pub fn quantile(sorted: &[f64], share: f64) -> Option<f64> {
    let place = share * sorted.len().checked_sub(1)? as f64;
    let (low, high) = (sorted[place.floor() as usize], sorted[place.ceil() as usize]);
    let part = place.fract();
    // Infinity less infinity, and nothing of infinity, are no numbers.
    Some(if part == 0.0 || low.is_infinite() { low } else { low + part * (high - low) })
}

/// Whether two samples differ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MannWhitney {
    /// In how many pairs the first sample has the larger value, ties counted as half.
    pub u: f64,
    /// How probable a difference at least as large is, in either direction, if there is none; 0 to 1.
    pub p: f64,
}

/// Samples with so many values together are compared exactly; there are fewer ways to deal them out than a float
/// can count.
const EXACT_MAX: usize = 50;

/// The two-sided test of Mann & Whitney (1947); none if a sample is empty.
///
/// For samples of no more than 50 values together, `p` is exact: that share of all ways to deal the values out to the
/// two samples, ties included, in the rarer direction, twice. For larger ones it is the normal approximation,
/// corrected for ties and for continuity.
pub fn mann_whitney(a: &[f64], b: &[f64]) -> Option<MannWhitney> {
    if a.is_empty() || b.is_empty() {
        return None;
    }
    let ranks = doubled_ranks(a, b);
    let own: usize = ranks[..a.len()].iter().sum();
    let u = own as f64 / 2.0 - (a.len() * (a.len() + 1)) as f64 / 2.0;
    let p = match ranks.len() <= EXACT_MAX {
        true => exact(&ranks, a.len()),
        false => approximate(&ranks, a.len(), u),
    };
    Some(MannWhitney { u, p })
}

/// The probability that a value of `a` is larger than one of `b`, ties counted as half: 0.5 if neither is better
/// (Vargha & Delaney 2000). They call 0.56 a small effect, 0.64 a medium and 0.71 a large one, and as much below 0.5.
/// None if a sample is empty.
pub fn a12(a: &[f64], b: &[f64]) -> Option<f64> {
    Some(mann_whitney(a, b)?.u / (a.len() * b.len()) as f64)
}

/// The p-values of several tests, corrected so that the probability of any false alarm among them stays what one
/// test's would be (Holm 1979), in the order given.
pub fn holm(p: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..p.len()).collect();
    order.sort_by(|&a, &b| p[a].total_cmp(&p[b]));
    let mut corrected = vec![0.0; p.len()];
    let mut floor = 0.0_f64;
    for (rank, &test) in order.iter().enumerate() {
        floor = floor.max(p[test] * (p.len() - rank) as f64).min(1.0);
        corrected[test] = floor;
    }
    corrected
}

/// Twice the rank of each value among all, those of `a` first. Equal values share the mean of their ranks, which may
/// be a half.
fn doubled_ranks(a: &[f64], b: &[f64]) -> Vec<usize> {
    let all = [a, b].concat();
    let rank = |value: &f64| {
        let below = all.iter().filter(|other| *other < value).count();
        let equal = all.iter().filter(|other| *other == value).count();
        2 * below + equal + 1
    };
    all.iter().map(rank).collect()
}

fn exact(ranks: &[usize], first: usize) -> f64 {
    // The smaller sample has the fewer sums.
    let (sample, size) = match first * 2 <= ranks.len() {
        true => (&ranks[..first], first),
        false => (&ranks[first..], ranks.len() - first),
    };
    let sum: usize = sample.iter().sum();
    let ways = ways(ranks, size);
    let all: f64 = ways.iter().sum();
    let below: f64 = ways[..=sum].iter().sum();
    let above: f64 = ways[sum..].iter().sum();
    (2.0 * below.min(above) / all).min(1.0)
}

/// In how many ways `size` of the ranks can be taken that have each sum.
fn ways(ranks: &[usize], size: usize) -> Vec<f64> {
    let sums = ranks.iter().sum::<usize>() + 1;
    let mut ways = vec![vec![0.0; sums]; size + 1];
    ways[0][0] = 1.0;
    for &rank in ranks {
        for taken in (1..=size).rev() {
            let (fewer, more) = ways.split_at_mut(taken);
            for (sum, count) in fewer[taken - 1].iter().enumerate().filter(|(_, n)| **n > 0.0) {
                more[0][sum + rank] += count;
            }
        }
    }
    ways.swap_remove(size)
}

fn approximate(ranks: &[usize], first: usize, u: f64) -> f64 {
    let all = ranks.len() as f64;
    let pairs = (first * (ranks.len() - first)) as f64;
    // Each of t equal values adds t² - 1, so that they add t³ - t together.
    let equal = |rank: &usize| ranks.iter().filter(|other| *other == rank).count() as f64;
    let ties: f64 = ranks.iter().map(|rank| equal(rank) * equal(rank) - 1.0).sum();
    let deviation = (pairs / 12.0 * (all + 1.0 - ties / (all * (all - 1.0)))).sqrt();
    let distance = ((u - pairs / 2.0).abs() - 0.5).max(0.0);
    match deviation > 0.0 {
        // Twice the normal distribution's upper tail.
        true => libm::erfc(distance / deviation / std::f64::consts::SQRT_2),
        false => 1.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether they agree as far as two programs that count can.
    fn agree(found: f64, expected: f64) -> bool {
        (found - expected).abs() <= 1e-12 * expected.abs()
    }

    fn test(a: &[f64], b: &[f64], u: f64, p: f64) {
        let found = mann_whitney(a, b).expect("there are values");
        assert!(found.u == u && agree(found.p, p), "{found:?}, not {u} and {p}");
        let other = mann_whitney(b, a).expect("there are values");
        assert_eq!(other.u, (a.len() * b.len()) as f64 - u);
        assert!(agree(other.p, p), "{other:?} the other way round");
    }

    #[test]
    fn samples_without_ties_have_the_published_probabilities() {
        // Permeability of membranes (Hollander & Wolfe 1973, as in R's help); p of SciPy 1.17, exact.
        let term = [0.80, 0.83, 1.89, 1.04, 1.45, 1.38, 1.91, 1.64, 0.73, 1.46];
        test(&term, &[1.15, 0.88, 0.90, 0.74, 1.21], 35.0, 0.254_412_254_412_254_4);
        // The example of SciPy's documentation.
        test(&[19.0, 22.0, 16.0, 29.0, 24.0], &[20.0, 11.0, 17.0, 12.0], 17.0, 1.0 / 9.0);
        // Two of the 252 ways to deal ten values out to two equal samples are as extreme.
        test(&[1.0, 2.0, 3.0, 4.0, 5.0], &[6.0, 7.0, 8.0, 9.0, 10.0], 0.0, 2.0 / 252.0);
        let i = |i: u32| f64::from(i);
        let a: Vec<f64> = (0..25).map(|k| i(k * k % 53) + i(k) / 100.0).collect();
        let b: Vec<f64> = (0..25).map(|k| i(k * 7 % 41) + i(k) / 90.0 + 0.003).collect();
        test(&a, &b, 372.0, 0.254_776_007_273_640_3);
    }

    #[test]
    fn ties_are_counted_exactly_in_small_samples_too() {
        // All ways were listed with SciPy's permutation_test.
        let b = [2.0, 4.0, 5.0, 6.0, 6.0, 7.0, 8.0];
        test(&[1.0, 2.0, 2.0, 3.0, 5.0, 5.0], &b, 7.0, 0.044_289_044_289_044_29);
        let b = [1.0, 1.0, 2.0, 2.0, 3.0, 3.0];
        test(&[1.0, 1.0, 1.0, 2.0], &b, 6.0, 1.0 / 3.0);
        test(&[1.0; 3], &[1.0; 3], 4.5, 1.0);
        let never = f64::NEG_INFINITY;
        test(&[never, never], &[never, 1.0], 1.0, 1.0);
    }

    #[test]
    fn large_samples_have_the_probability_that_scipy_approximates() {
        let a: Vec<f64> = (0..30).map(|i| f64::from(i * 37 % 101) / 10.0).collect();
        let b: Vec<f64> = (0..30).map(|i| f64::from(i * 53 % 97) / 10.0 + 1.5).collect();
        test(&a, &b, 354.5, 0.160_111_677_410_428_98);
        let even = |values: &[f64]| values.iter().map(|v| v.round_ties_even()).collect::<Vec<_>>();
        test(&even(&a), &even(&b), 353.0, 0.151_604_654_585_494_5);
        let a: Vec<f64> = (0..40).map(f64::from).collect();
        let b: Vec<f64> = (1000..1040).map(f64::from).collect();
        test(&a, &b, 0.0, 1.435_085_306_393_668e-14);
        test(&[1.0; 30], &[1.0; 30], 450.0, 1.0);
    }

    #[test]
    fn the_effect_size_is_the_share_of_pairs_that_the_first_wins() {
        assert_eq!(a12(&[2.0, 3.0], &[1.0]), Some(1.0));
        assert_eq!(a12(&[1.0, 2.0], &[1.0, 3.0]), Some(0.375));
        assert_eq!(a12(&[], &[1.0]), None);
    }

    #[test]
    fn quartiles_are_those_of_numpy_and_what_never_scored_is_no_number_between() {
        let five = Five::of(&[3.0, 1.0, 4.0, 1.0, 5.0, 9.0, 2.0, 6.0]).expect("there are values");
        let expected = Five { least: 1.0, lower: 1.75, median: 3.5, upper: 5.25, most: 9.0 };
        assert_eq!(five, expected);
        let never = f64::NEG_INFINITY;
        let five = Five::of(&[never, never, 1.0, 2.0]).expect("there are values");
        assert_eq!((five.least, five.lower, five.median, five.most), (never, never, never, 2.0));
        assert_eq!(Five::of(&[]), None);
    }

    #[test]
    fn holm_multiplies_the_smallest_by_the_number_of_tests_and_keeps_the_order() {
        // 0.01 × 4, 0.02 × 3, 0.03 × 2; the last is no smaller than the one before it.
        let corrected = holm(&[0.03, 0.01, 0.04, 0.02]);
        for (found, expected) in corrected.iter().zip([0.06, 0.04, 0.06, 0.06]) {
            assert!(agree(*found, expected), "{corrected:?}");
        }
        assert_eq!(holm(&[0.9, 0.8]), [1.0, 1.0]);
        assert_eq!(holm(&[]), [0.0; 0]);
    }
}
