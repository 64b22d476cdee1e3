//! The functions of the real-coded suites, and the table that says where each comes from.

use crate::choice;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// A function of any number of variables whose least value is zero, at one known place.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, strum::Display, strum::VariantArray,
)]
#[strum(serialize_all = "kebab-case")]
#[serde(rename_all = "kebab-case")]
pub enum Function {
    /// One bowl.
    Sphere,
    /// A grid of pits in a bowl.
    Rastrigin,
    /// A bent valley, easy to find and long to follow.
    Rosenbrock,
    /// A plain of ripples with a funnel in it.
    Ackley,
    /// Pits of which the second best is far from the best.
    Schwefel,
    /// A bowl of ripples that are coupled by a product.
    Griewank,
}

/// A row of the table of functions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Facts {
    /// What is summed up, in terms of z, of which there are n.
    pub formula: &'static str,
    /// Each variable is from here…
    pub low: f64,
    /// … to here.
    pub high: f64,
    /// What a step of a variable is in z.
    pub scale: f64,
    /// What z is at the optimum.
    pub optimum: f64,
    /// Where formula and domain come from.
    pub source: &'static str,
}

/// Where Schwefel's function has its least value, in each variable.
const SCHWEFEL_OPTIMUM: f64 = 420.968_746_227_503_6;
/// Beyond it Schwefel's function is not defined by its author.
const SCHWEFEL_EDGE: f64 = 500.0;

/// The table of functions, in the order of [`Function::ALL`].
///
/// As in the CEC suites z = M · scale · (x − o) + optimum, where x is a point of the domain, o the shifted optimum
/// and M a rotation, or the identity. The error is the function's value, and zero at x = o alone.
pub const FUNCTIONS: [Facts; Function::ALL.len()] = [
    Facts {
        formula: "Σ zᵢ²",
        low: -100.0,
        high: 100.0,
        scale: 1.0,
        optimum: 0.0,
        source: "De Jong 1975; domain as CEC 2008 F1 (Tang et al. 2007)",
    },
    Facts {
        formula: "Σ zᵢ² + 10 (1 − cos 2πzᵢ)",
        low: -5.0,
        high: 5.0,
        scale: 1.0,
        optimum: 0.0,
        source: "Rastrigin 1974, in n variables Mühlenbein et al. 1991; domain as CEC 2008 F4",
    },
    Facts {
        formula: "Σ 100 (zᵢ² − zᵢ₊₁)² + (zᵢ − 1)², over i < n",
        low: -100.0,
        high: 100.0,
        scale: 1.0,
        optimum: 1.0,
        source: "Rosenbrock 1960; domain as CEC 2008 F3",
    },
    Facts {
        formula: "20 (1 − exp(−0.2 √(Σ zᵢ² / n))) + e − exp(Σ cos 2πzᵢ / n)",
        low: -32.0,
        high: 32.0,
        scale: 1.0,
        optimum: 0.0,
        source: "Ackley 1987, in n variables Bäck 1996; domain as CEC 2008 F6",
    },
    Facts {
        formula: "Σ g(420.97) − g(zᵢ), g(z) = z sin √|z|, mirrored and punished beyond ±500",
        low: -100.0,
        high: 100.0,
        scale: 10.0,
        optimum: SCHWEFEL_OPTIMUM,
        source: "Schwefel 1981; edge, scale and domain as CEC 2014 F10 (Liang et al. 2013)",
    },
    Facts {
        formula: "1 + Σ zᵢ² / 4000 − Π cos(zᵢ / √i), i from 1",
        low: -600.0,
        high: 600.0,
        scale: 1.0,
        optimum: 0.0,
        source: "Griewank 1981; domain as CEC 2008 F5",
    },
];

impl Function {
    /// Its row of the table.
    pub fn facts(self) -> Facts {
        FUNCTIONS[self as usize]
    }

    /// Its value at z, at least 0: the error of a point that is z away from the optimum, moved to where the formula
    /// has its own. Sums run in the order of the variables, so that they have the same bits everywhere.
    pub fn error(self, z: &[f64]) -> f64 {
        let value = match self {
            Function::Sphere => z.iter().map(|z| z * z).sum(),
            Function::Rastrigin => z.iter().map(|z| z * z + 10.0 * (1.0 - wave(*z))).sum(),
            Function::Rosenbrock => z.windows(2).map(|pair| bend(pair[0], pair[1])).sum(),
            Function::Ackley => ackley(z),
            Function::Schwefel => {
                let n = z.len() as f64;
                let best = pit(SCHWEFEL_OPTIMUM, n);
                z.iter().map(|z| best - pit(*z, n)).sum()
            }
            Function::Griewank => griewank(z),
        };
        // Rounding may take a sum of terms that vanish at the optimum a hair below it.
        f64::max(value, 0.0)
    }
}

/// One wave a unit.
fn wave(z: f64) -> f64 {
    libm::cos(TAU * z)
}

fn bend(z: f64, next: f64) -> f64 {
    let (valley, way) = (z * z - next, z - 1.0);
    100.0 * valley * valley + way * way
}

fn ackley(z: &[f64]) -> f64 {
    let n = z.len() as f64;
    let radius = libm::sqrt(z.iter().map(|z| z * z).sum::<f64>() / n);
    let waves = z.iter().map(|z| wave(*z)).sum::<f64>() / n;
    20.0 * (1.0 - libm::exp(-0.2 * radius)) + (libm::exp(1.0) - libm::exp(waves))
}

fn griewank(z: &[f64]) -> f64 {
    let bowl: f64 = z.iter().map(|z| z * z).sum();
    let ripple = |(z, i): (&f64, u32)| libm::cos(z / libm::sqrt(f64::from(i)));
    let ripples: f64 = z.iter().zip(1..).map(ripple).product();
    bowl / 4000.0 + (1.0 - ripples)
}

/// A term of Schwefel's function; beyond the edge a mirror of what is inside, less a parabola.
fn pit(z: f64, n: f64) -> f64 {
    let inside = |z: f64| z * libm::sin(libm::sqrt(libm::fabs(z)));
    let beyond = libm::fabs(z) - SCHWEFEL_EDGE;
    if beyond <= 0.0 {
        return inside(z);
    }
    let mirrored = SCHWEFEL_EDGE - libm::fmod(libm::fabs(z), SCHWEFEL_EDGE);
    inside(if z > 0.0 { mirrored } else { -mirrored }) - beyond * beyond / (10_000.0 * n)
}

choice::one_of!("function", Function);

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_close(found: f64, expected: f64) {
        let most = 1e-12 * libm::fmax(1.0, libm::fabs(expected));
        assert!((found - expected).abs() <= most, "{found} is not {expected}");
    }

    #[test]
    fn every_function_is_zero_at_its_optimum_and_nowhere_beside_it() {
        for function in Function::ALL {
            for n in [2, 3, 30, 1000] {
                let mut z = vec![function.facts().optimum; n];
                assert_eq!(function.error(&z), 0.0, "{function} of {n}");
                z[n - 1] += 0.01;
                assert!(function.error(&z) > 0.0, "{function} of {n}");
            }
        }
    }

    #[test]
    fn every_function_has_its_known_values() {
        let value = |function: Function, z: &[f64]| function.error(z);
        assert_close(value(Function::Sphere, &[3.0, -4.0]), 25.0);
        assert_close(value(Function::Rastrigin, &[1.0, -2.0]), 5.0);
        assert_close(value(Function::Rastrigin, &[0.5, 0.5, 0.5]), 60.75);
        assert_close(value(Function::Rosenbrock, &[-1.2, 1.0]), 24.2);
        assert_close(value(Function::Rosenbrock, &[0.0; 30]), 29.0);
        assert_close(value(Function::Ackley, &[1.0, 1.0]), 3.625_384_938_440_363);
        assert_close(value(Function::Griewank, &[0.0, 0.0, 0.0]), 0.0);
        assert_close(value(Function::Griewank, &[std::f64::consts::PI]), 2.002_467_401_100_272_4);
        assert_close(value(Function::Schwefel, &[0.0]), 418.982_887_272_433_8);
        assert_close(value(Function::Schwefel, &[0.0; 10]), 4_189.828_872_724_338);
    }

    #[test]
    fn schwefels_function_is_whole_at_its_edge_and_punishes_what_is_beyond() {
        for edge in [-500.0, 500.0] {
            let at = |z: f64| Function::Schwefel.error(&[z]);
            let [inside, beyond] = [at(edge * (1.0 - 1e-9)), at(edge * (1.0 + 1e-9))];
            assert!((inside - beyond).abs() < 1e-3, "{inside} and {beyond}");
            assert!(at(edge * 100.0) > 200_000.0);
        }
    }

    #[test]
    fn a_function_is_read_by_its_name() {
        for function in Function::ALL {
            assert_eq!(function.to_string().parse(), Ok(function));
        }
        assert!("circle".parse::<Function>().is_err());
    }
}
