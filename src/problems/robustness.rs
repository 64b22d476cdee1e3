//! Scores of several trials that differ a little, so that evolution cannot live on one world's quirks, nor on luck.
//!
//! A body that walks is a chaotic system: one trial of it is a draw, and who selects the best of many draws selects luck
//! (the winner's curse). What several trials come to, in worlds that differ a little, is what the body can do.

use crate::choice;
use crate::simulation::Trial;
use serde::{Deserialize, Serialize};

/// Who may be the best of its island has so many times as many trials as others.
pub const BEST_TIMES: u32 = 4;

/// How a genome is tried more than once.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Robustness {
    /// So many perturbed trials, and [`BEST_TIMES`] as many of who may be the best of its island; 0 for one that is not
    /// perturbed.
    pub trials: u32,
    /// What their scores come to.
    pub by: RobustBy,
}

/// What the scores of several trials come to.
#[derive(
    Debug,
    Clone,
    Copy,
    PartialEq,
    Eq,
    Default,
    Serialize,
    Deserialize,
    strum::Display,
    strum::VariantArray,
)]
#[strum(serialize_all = "kebab-case")]
#[serde(rename_all = "kebab-case")]
pub enum RobustBy {
    /// The worst of them.
    Worst,
    /// Their lower quartile: a quarter of them is worse.
    #[default]
    Quartile,
    /// Their median.
    Median,
    /// Their mean.
    Mean,
}

impl RobustBy {
    /// What some scores come to, which must be numbers; nothing without any.
    pub fn of(self, scores: &[f64]) -> f64 {
        if scores.is_empty() {
            return 0.0;
        }
        let quantile = |share: f64| {
            let mut sorted = scores.to_vec();
            sorted.sort_unstable_by(f64::total_cmp);
            let place = share * (sorted.len() - 1) as f64;
            let (low, part) = (place as usize, place.fract());
            let high = (low + 1).min(sorted.len() - 1);
            sorted[low] + part * (sorted[high] - sorted[low])
        };
        match self {
            RobustBy::Worst => quantile(0.0),
            RobustBy::Quartile => quantile(0.25),
            RobustBy::Median => quantile(0.5),
            RobustBy::Mean => scores.iter().sum::<f64>() / scores.len() as f64,
        }
    }
}

choice::one_of!("robust-by", RobustBy);

impl Robustness {
    /// One trial, which is not perturbed.
    pub const NONE: Self = Self { trials: 0, by: RobustBy::Mean };

    /// The most trials.
    pub const TRIALS_MAX: u32 = 100;

    /// Whether trials are perturbed.
    pub fn is_wanted(self) -> bool {
        self.trials > 0
    }

    /// The trials that are scored, in their order: the usual ones, then those of who may be the best of its island.
    pub fn trials(self, usual: Trial) -> impl Iterator<Item = Trial> {
        let perturbed = move |index| match self.is_wanted() {
            true => usual.perturbed(index),
            false => usual.clone(),
        };
        (0..self.trials_of_the_best().max(1)).map(perturbed)
    }

    /// So many perturbed trials has who may be the best. The highest score of many is the luckiest, too.
    pub fn trials_of_the_best(self) -> u32 {
        BEST_TIMES * self.trials
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_way_is_what_its_name_says() {
        let scores = [5.0, 1.0, 2.0, 8.0, 4.0];
        let found = RobustBy::ALL.map(|by| by.of(&scores));
        assert_eq!(found, [1.0, 2.0, 4.0, 4.0]);
        assert_eq!(RobustBy::ALL.map(|by| by.of(&[3.0, 1.0])), [1.0, 1.5, 2.0, 2.0]);
        for by in RobustBy::ALL {
            assert_eq!((by.of(&[7.0]), by.of(&[])), (7.0, 0.0));
        }
    }
}
