//! Operators on real numbers from 0 (included) to 1 (excluded): what genes of any problem are made of, whatever they
//! stand for.

use super::operators::{Crossover, Mutation, Variation, happens};
use crate::rng::Stream;
use rand::RngExt;
use std::f64::consts::TAU;

/// The largest value: the largest number below 1.
pub const VALUE_MAX: f64 = 1.0 - f64::EPSILON / 2.0;

/// Point mutation: changes each value with probability [`Variation::point_rate`].
pub fn mutate(values: &mut [f64], variation: &Variation, rng: &mut Stream) {
    for value in values {
        if happens(variation.point_rate, rng) {
            let change = variation.mutation.change(*value, rng) * variation.point_amount;
            *value = reflect(*value + change);
        }
    }
}

/// Makes values of those of one parent and another: `a` becomes the child. Operators that know only whole genes
/// leave it as it is.
pub fn recombine(a: &mut [f64], b: &[f64], crossover: Crossover, rng: &mut Stream) {
    for (a, &b) in a.iter_mut().zip(b) {
        *a = match crossover {
            Crossover::Blend { alpha } => blend(*a, b, alpha, rng),
            Crossover::Sbx { eta } => sbx(*a, b, eta, rng),
            Crossover::OnePoint | Crossover::TwoPoint | Crossover::Uniform => *a,
        };
    }
}

impl Mutation {
    /// A change of `value`, as a share of the most that it may be changed by: mostly within -1 and 1.
    fn change(self, value: f64, rng: &mut Stream) -> f64 {
        match self {
            Mutation::Uniform => 2.0 * rng.random::<f64>() - 1.0,
            Mutation::Gaussian => normal(rng),
            Mutation::Polynomial { eta } => polynomial(value, eta, rng),
        }
    }
}

/// A standard normal number (Box & Muller 1958), by libm's functions: the same bits on every machine.
pub fn normal(rng: &mut Stream) -> f64 {
    // The logarithm of zero is none.
    let radius = libm::sqrt(-2.0 * libm::log(1.0 - rng.random::<f64>()));
    radius * libm::cos(TAU * rng.random::<f64>())
}

/// Polynomial mutation of a bounded value (Deb & Agrawal 1999): small changes are likely, the more so the larger `eta`,
/// and none leads out of the range.
fn polynomial(value: f64, eta: f64, rng: &mut Stream) -> f64 {
    let draw: f64 = rng.random();
    let root = |base: f64| libm::pow(base, 1.0 / (eta + 1.0));
    let power = |base: f64| libm::pow(base, eta + 1.0);
    if draw < 0.5 {
        root(2.0 * draw + (1.0 - 2.0 * draw) * power(1.0 - value)) - 1.0
    } else {
        1.0 - root(2.0 * (1.0 - draw) + (2.0 * draw - 1.0) * power(value))
    }
}

/// Blend crossover BLX-alpha (Eshelman & Schaffer 1993): uniform between the parents and beyond either by `alpha` of
/// their distance.
fn blend(a: f64, b: f64, alpha: f64, rng: &mut Stream) -> f64 {
    let (low, high) = (a.min(b), a.max(b));
    let beyond = alpha * (high - low);
    reflect(low - beyond + rng.random::<f64>() * (high - low + 2.0 * beyond))
}

/// Simulated binary crossover (Deb & Agrawal 1995): half of the values are those of the first parent, the others are as
/// near to one of the parents as one-point crossover of bits would leave them, the nearer the larger `eta`.
fn sbx(a: f64, b: f64, eta: f64, rng: &mut Stream) -> f64 {
    if rng.random() {
        return a;
    }
    let draw: f64 = rng.random();
    let base = if draw < 0.5 { 2.0 * draw } else { 0.5 / (1.0 - draw) };
    let beta = libm::pow(base, 1.0 / (eta + 1.0));
    let side = if rng.random() { beta } else { -beta };
    // So written that equal parents have a child that is equal to the last bit.
    reflect(0.5 * (a + b) + 0.5 * side * (a - b))
}

/// Brings a value that left the range from 0 to 1 back in, as mirrors at its ends would: a clamp would pile values up
/// there.
pub fn reflect(value: f64) -> f64 {
    let value = value.abs();
    let value = if value < 2.0 { value } else { value % 2.0 };
    if value < 1.0 { value } else { (2.0 - value).clamp(0.0, VALUE_MAX) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::{Purpose, Source};

    fn stream(index: u32) -> Stream {
        Source { seed: 3, island: 0 }.stream(0, index, Purpose::Mutation)
    }

    fn sample(draw: impl Fn(&mut Stream) -> f64) -> (f64, f64) {
        let draws: Vec<f64> = (0..20_000).map(|index| draw(&mut stream(index))).collect();
        let mean = draws.iter().sum::<f64>() / draws.len() as f64;
        let square = |it: &f64| (it - mean) * (it - mean);
        let variance = draws.iter().map(square).sum::<f64>() / draws.len() as f64;
        (mean, variance.sqrt())
    }

    fn assert_close(found: (f64, f64), mean: f64, deviation: f64) {
        assert!((found.0 - mean).abs() < 0.02 && (found.1 - deviation).abs() < 0.02, "{found:?}");
    }

    #[test]
    fn normal_numbers_have_mean_0_and_deviation_1() {
        assert_close(sample(normal), 0.0, 1.0);
    }

    #[test]
    fn a_reflected_value_is_in_the_range_wherever_it_came_from() {
        let wanted = [(-0.25, 0.25), (1.25, 0.75), (2.25, 0.25), (-3.25, 0.75), (1.0, VALUE_MAX)];
        for (from, to) in wanted {
            assert_eq!(reflect(from), to, "{from}");
        }
        assert!((0..1000).all(|i| (0.0..1.0).contains(&reflect(f64::from(i) * 0.37 - 185.0))));
    }

    #[test]
    fn polynomial_mutation_never_leaves_the_range_and_is_small_where_eta_is_large() {
        for value in [0.0, 0.1, 0.5, VALUE_MAX] {
            for index in 0..500 {
                let changed = value + polynomial(value, 5.0, &mut stream(index));
                assert!((-1e-12..=1.0 + 1e-12).contains(&changed), "{value} became {changed}");
            }
        }
        let deviation = |eta| sample(|rng| polynomial(0.5, eta, rng)).1;
        assert!(deviation(5.0) > 2.0 * deviation(20.0));
    }

    #[test]
    fn blending_is_uniform_between_the_parents_and_beyond() {
        let deviation = 0.4 / 12.0_f64.sqrt();
        assert_close(sample(|rng| blend(0.4, 0.6, 0.5, rng)), 0.5, deviation);
        assert_eq!(blend(0.3, 0.3, 0.5, &mut stream(0)), 0.3);
    }

    #[test]
    fn simulated_binary_crossover_keeps_half_of_the_values_and_spreads_the_others_about_both() {
        let draws: Vec<f64> = (0..4_000).map(|i| sbx(0.4, 0.6, 15.0, &mut stream(i))).collect();
        let count = |wanted: &dyn Fn(f64) -> bool| draws.iter().filter(|it| wanted(**it)).count();
        assert!((1_900..2_100).contains(&count(&|it| it == 0.4)));
        assert_eq!(sbx(0.3, 0.3, 1.0, &mut stream(1)), 0.3);
        let others = |near: f64| count(&|it| it != 0.4 && (it - near).abs() < 0.1);
        assert!((900..1_100).contains(&others(0.4)) && (900..1_100).contains(&others(0.6)));
    }
}
