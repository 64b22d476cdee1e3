//! How good a genome is, and how its evaluation ended.

use super::outcome::Outcome;
use serde::{Deserialize, Serialize};
use std::cmp::Ordering;

/// A score to be maximised, in the task's unit (metres for locomotion): totally ordered, never NaN.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(from = "f64", into = "f64")]
pub struct Fitness(f64);

impl Fitness {
    /// What a genome gets that could not be scored: below every real score.
    pub const WORST: Fitness = Fitness(f64::NEG_INFINITY);

    /// At least as good as every real score.
    pub const HIGHEST: Fitness = Fitness(f64::MAX);

    /// A score. What is not finite cannot be a score and becomes [`Fitness::WORST`].
    pub fn new(score: f64) -> Self {
        // Adding zero turns -0.0 into 0.0: equal scores must have equal bits.
        if score.is_finite() { Self(score + 0.0) } else { Self::WORST }
    }

    /// The score, or negative infinity for [`Fitness::WORST`].
    pub fn get(self) -> f64 {
        self.0
    }

    /// The next lower one; nothing is lower than [`Fitness::WORST`].
    pub fn just_below(self) -> Self {
        Self::new(self.0.next_down())
    }

    /// The score, if there is one.
    pub fn finite(self) -> Option<f64> {
        self.0.is_finite().then_some(self.0)
    }

    /// The score as a finite number, the most negative one for [`Fitness::WORST`]: for formats such as
    /// JSON that know no infinity.
    pub fn saturated(self) -> f64 {
        self.0.max(f64::MIN)
    }

    /// The fitness that [`Fitness::saturated`] has made a finite number.
    pub fn of_saturated(number: f64) -> Self {
        if number > f64::MIN { Self::new(number) } else { Self::WORST }
    }
}

impl From<f64> for Fitness {
    fn from(score: f64) -> Self {
        Self::new(score)
    }
}

impl From<Fitness> for f64 {
    fn from(fitness: Fitness) -> Self {
        fitness.0
    }
}

impl Eq for Fitness {}

impl Ord for Fitness {
    fn cmp(&self, other: &Self) -> Ordering {
        self.0.total_cmp(&other.0)
    }
}

impl PartialOrd for Fitness {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// The result of evaluating one genome.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Evaluation {
    /// The score, [`Fitness::WORST`] unless the outcome is [`Outcome::Scored`].
    pub fitness: Fitness,
    /// How the evaluation ended.
    pub outcome: Outcome,
}

impl Evaluation {
    /// A trial that ran to its end; a score that is not finite becomes [`Outcome::NotFinite`].
    pub fn scored(score: f64) -> Self {
        if score.is_finite() {
            Self { fitness: Fitness::new(score), outcome: Outcome::Scored }
        } else {
            Self::failed(Outcome::NotFinite)
        }
    }

    /// A trial that did not.
    pub fn failed(outcome: impl Into<Outcome>) -> Self {
        Self { fitness: Fitness::WORST, outcome: outcome.into() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fitness_is_totally_ordered_and_never_nan() {
        assert_eq!(Fitness::new(f64::NAN), Fitness::WORST);
        assert_eq!(Fitness::new(f64::INFINITY), Fitness::WORST);
        assert!(Fitness::new(-1e300) > Fitness::WORST);
        assert!(Fitness::new(2.0) > Fitness::new(1.0));
        assert_eq!(Fitness::new(-0.0).get().to_bits(), 0.0_f64.to_bits());
        assert!(Fitness::WORST.saturated().is_finite());
    }
}
