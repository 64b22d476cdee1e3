//! Scores of several trials that differ a little, so that evolution cannot live on one world's quirks.

use crate::choice;
use crate::evolution::Outcome;
use crate::simulation::Trial;
use serde::{Deserialize, Serialize};

/// How a genome is tried more than once.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Robustness {
    /// So many perturbed trials; 0 for one that is not perturbed.
    pub trials: u32,
    /// What their scores come to.
    pub by: RobustBy,
}

/// What the scores of several trials come to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RobustBy {
    /// The worst of them.
    #[default]
    Worst,
    /// Their mean.
    Mean,
}

impl RobustBy {
    /// Every way.
    pub const ALL: [RobustBy; 2] = [RobustBy::Worst, RobustBy::Mean];
}

impl std::fmt::Display for RobustBy {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            RobustBy::Worst => "worst",
            RobustBy::Mean => "mean",
        })
    }
}

impl std::str::FromStr for RobustBy {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        choice::named("robust-by", &RobustBy::ALL, text)
    }
}

impl Robustness {
    /// One trial, which is not perturbed.
    pub const NONE: Self = Self { trials: 0, by: RobustBy::Worst };

    /// The most trials.
    pub const TRIALS_MAX: u32 = 100;

    /// Whether trials are perturbed.
    pub fn is_wanted(self) -> bool {
        self.trials > 0
    }

    /// The trials that are scored.
    pub fn trials(self, usual: Trial) -> impl Iterator<Item = Trial> {
        let perturbed = move |index| match self.is_wanted() {
            true => usual.perturbed(index),
            false => usual,
        };
        (0..self.trials.max(1)).map(perturbed)
    }

    /// What the scores of these trials come to. Who fails in one of them has failed, and is not tried further.
    ///
    /// # Errors
    /// The first outcome without a score.
    pub fn score(
        self,
        mut scores: impl Iterator<Item = Result<f64, Outcome>>,
    ) -> Result<f64, Outcome> {
        let first = scores.next().unwrap_or(Ok(0.0))?;
        match self.by {
            RobustBy::Worst => scores.try_fold(first, |worst, score| Ok(worst.min(score?))),
            RobustBy::Mean => {
                let sum = scores.try_fold(first, |sum, score| Ok::<_, Outcome>(sum + score?))?;
                Ok(sum / f64::from(self.trials.max(1)))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_worst_is_no_more_than_the_mean_and_one_failure_is_a_failure() {
        let by = |by, scores: [Result<f64, Outcome>; 3]| {
            Robustness { trials: 3, by }.score(scores.into_iter())
        };
        let [worst, mean] = RobustBy::ALL.map(|it| by(it, [Ok(3.0), Ok(1.0), Ok(5.0)]));
        assert_eq!((worst, mean), (Ok(1.0), Ok(3.0)));
        for way in RobustBy::ALL {
            let failed = by(way, [Ok(3.0), Err(Outcome::TooFast), Err(Outcome::Launched)]);
            assert_eq!(failed, Err(Outcome::TooFast));
        }
    }

    #[test]
    fn who_has_failed_is_not_tried_further() {
        let scores = [Ok(3.0), Err(Outcome::TooFast)].into_iter();
        let tried = scores.chain(std::iter::from_fn(|| panic!("tried further")));
        let found = Robustness { trials: 3, by: RobustBy::Mean }.score(tried);
        assert_eq!(found, Err(Outcome::TooFast));
    }
}
