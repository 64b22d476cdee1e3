//! What a creature is worth on trials that nobody selected it on: the honest number.

use crate::simulation::Engine;
use serde::{Deserialize, Serialize};

/// What fresh trials in an engine came to. A trial that blew up counts as a score of 0.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Validation {
    /// The engine.
    pub engine: Engine,
    /// How many trials there were.
    pub trials: u32,
    /// How many of them blew up.
    pub failed: u32,
    /// The mean of their scores.
    pub mean: f64,
    /// The standard deviation of their scores, of a sample; 0 for a single one.
    pub sd: f64,
    /// The worst of them.
    pub worst: f64,
}

impl Validation {
    /// What some trials came to.
    pub fn of<E>(engine: Engine, results: &[Result<f64, E>]) -> Self {
        let scores: Vec<f64> =
            results.iter().map(|result| *result.as_ref().unwrap_or(&0.0)).collect();
        let count = scores.len().max(1) as f64;
        let mean = scores.iter().sum::<f64>() / count;
        let squares: f64 = scores.iter().map(|score| (score - mean) * (score - mean)).sum();
        Self {
            engine,
            trials: scores.len() as u32,
            failed: results.iter().filter(|result| result.is_err()).count() as u32,
            mean,
            sd: libm::sqrt(squares / (count - 1.0).max(1.0)),
            worst: scores.iter().copied().reduce(f64::min).unwrap_or(0.0),
        }
    }

    /// The same as people read it.
    pub fn in_words(&self, unit: &str) -> String {
        let Self { engine, trials, failed, mean, sd, worst } = self;
        let failed =
            if *failed > 0 { format!(", {failed} of which blew up") } else { String::new() };
        format!(
            "{mean:.2} ± {sd:.2} {unit} in {engine}, worst {worst:.2} {unit} ({trials} fresh trials{failed})"
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolution::Outcome;

    #[test]
    fn a_trial_that_blew_up_is_worth_nothing() {
        let results = [Ok(2.0), Err(crate::problems::outcomes::TOO_FAST), Ok(4.0)];
        let found = Validation::of(Engine::Rapier, &results);
        let expected = Validation {
            engine: Engine::Rapier,
            trials: 3,
            failed: 1,
            mean: 2.0,
            sd: 2.0,
            worst: 0.0,
        };
        assert_eq!(found, expected);
    }

    #[test]
    fn one_trial_has_no_spread_and_none_are_worth_nothing() {
        let one = Validation::of::<Outcome>(Engine::Rapier, &[Ok(3.0)]);
        assert_eq!((one.mean, one.sd, one.worst), (3.0, 0.0, 3.0));
        let none = Validation::of::<Outcome>(Engine::Rapier, &[]);
        assert_eq!((none.trials, none.mean, none.sd, none.worst), (0, 0.0, 0.0, 0.0));
    }
}
