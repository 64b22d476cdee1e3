//! How often and how much genomes are varied, and by which operators.

use crate::choice;
use crate::rng::Stream;
use rand::RngExt;
use serde::{Deserialize, Serialize};
use std::str::FromStr;
use strum::EnumCount;

/// How often and how much genomes are varied.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Variation {
    /// How two parents are recombined.
    pub crossover: Crossover,
    /// Probability that an offspring has two parents, 0 to 1; else it starts as a copy of one.
    pub crossover_rate: f64,
    /// How a value is changed by point mutation.
    pub mutation: Mutation,
    /// Probability of each value of each gene to be changed by point mutation, 0 to 1.
    pub point_rate: f64,
    /// The scale of point mutation, as a share of a value's range, 0 to 1: see [`Mutation`].
    pub point_amount: f64,
    /// Probability of an offspring to lose a gene, 0 to 1.
    pub shrink_rate: f64,
    /// Probability of an offspring to gain a random gene, 0 to 1.
    pub grow_rate: f64,
    /// Probability of an offspring to repeat a part of itself, 0 to 1: see
    /// [`Problem::duplicate`](crate::evolution::Problem::duplicate).
    pub duplicate_rate: f64,
    /// No genome that may be of any length gets longer than this, in genes, at least 1.
    pub genes_max: usize,
}

impl Default for Variation {
    fn default() -> Self {
        Self {
            crossover: Crossover::OnePoint,
            crossover_rate: 0.3,
            mutation: Mutation::Uniform,
            point_rate: 0.04,
            point_amount: 0.2,
            shrink_rate: 0.1,
            grow_rate: 0.1,
            duplicate_rate: 0.0,
            genes_max: 12,
        }
    }
}

/// How two parents are recombined. Where genes hold no numbers, the last two take each gene from either parent.
#[derive(
    Debug, Clone, Copy, PartialEq, Serialize, Deserialize, strum::Display, strum::EnumCount,
)]
#[strum(serialize_all = "kebab-case")]
#[serde(try_from = "String", into = "String")]
pub enum Crossover {
    /// [`super::sequences::one_point_crossover`].
    OnePoint,
    /// [`super::sequences::two_point_crossover`].
    TwoPoint,
    /// Each gene is that of either parent (Syswerda 1989).
    Uniform,
    /// Each number lies between the parents' or beyond: BLX-alpha (Eshelman & Schaffer 1993).
    #[strum(to_string = "blend:{alpha}")]
    Blend {
        /// How far beyond, as a share of their distance, 0 to 2.
        alpha: f64,
    },
    /// Simulated binary crossover (Deb & Agrawal 1995).
    #[strum(to_string = "sbx:{eta}")]
    Sbx {
        /// How near to the parents, 0 to 1000: the larger, the nearer.
        eta: f64,
    },
}

/// How point mutation changes a value. What leaves the range is mirrored at its ends.
#[derive(
    Debug, Clone, Copy, PartialEq, Serialize, Deserialize, strum::Display, strum::EnumCount,
)]
#[strum(serialize_all = "kebab-case")]
#[serde(try_from = "String", into = "String")]
pub enum Mutation {
    /// Uniformly, by at most the point amount.
    Uniform,
    /// By a normal number with the point amount as its standard deviation.
    Gaussian,
    /// Polynomially within the range (Deb & Agrawal 1999), times the point amount.
    #[strum(to_string = "polynomial:{eta}")]
    Polynomial {
        /// How small changes are, 0 to 1000: the larger, the smaller.
        eta: f64,
    },
}

impl Crossover {
    /// One of every kind, with its usual number.
    pub const USUAL: [Crossover; Crossover::COUNT] = [
        Crossover::OnePoint,
        Crossover::TwoPoint,
        Crossover::Uniform,
        Crossover::Blend { alpha: 0.5 },
        Crossover::Sbx { eta: 15.0 },
    ];
}

impl FromStr for Crossover {
    type Err = String;

    /// Reads what `Display` writes; without its number an operator takes its usual one.
    fn from_str(text: &str) -> Result<Self, String> {
        let (usual, scheme) = choice::Scheme::of("crossover", &Self::USUAL, text)?;
        match usual {
            Crossover::Blend { alpha } => {
                Ok(Crossover::Blend { alpha: scheme.number(alpha, 0.0, 2.0)? })
            }
            Crossover::Sbx { eta } => Ok(Crossover::Sbx { eta: scheme.number(eta, 0.0, 1000.0)? }),
            plain => scheme.plain(plain),
        }
    }
}

impl Mutation {
    /// One of every kind, with its usual number.
    pub const USUAL: [Mutation; Mutation::COUNT] =
        [Mutation::Uniform, Mutation::Gaussian, Mutation::Polynomial { eta: 20.0 }];
}

impl FromStr for Mutation {
    type Err = String;

    /// Reads what `Display` writes; without its number an operator takes its usual one.
    fn from_str(text: &str) -> Result<Self, String> {
        let (usual, scheme) = choice::Scheme::of("mutation", &Self::USUAL, text)?;
        match usual {
            Mutation::Polynomial { eta } => {
                Ok(Mutation::Polynomial { eta: scheme.number(eta, 0.0, 1000.0)? })
            }
            plain => scheme.plain(plain),
        }
    }
}

choice::as_text!(Crossover, Mutation);

/// Whether an event of this probability happens; 0 never does, 1 always.
pub fn happens(probability: f64, rng: &mut Stream) -> bool {
    rng.random::<f64>() < probability
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_operator_is_read_as_it_is_written() {
        let names = ["one-point", "two-point", "uniform", "blend:0.5", "sbx:15"];
        assert_eq!(Crossover::USUAL.map(|operator| operator.to_string()), names);
        assert_eq!(names.map(str::parse), Crossover::USUAL.map(Ok));
        let names = ["uniform", "gaussian", "polynomial:20"];
        assert_eq!(Mutation::USUAL.map(|operator| operator.to_string()), names);
        assert_eq!(names.map(str::parse), Mutation::USUAL.map(Ok));
        assert_eq!("sbx".parse(), Ok(Crossover::Sbx { eta: 15.0 }));
        for wrong in ["", "three-point", "uniform:2", "blend:-1", "sbx:NaN"] {
            assert!(wrong.parse::<Crossover>().is_err() && wrong.parse::<Mutation>().is_err());
        }
    }
}
