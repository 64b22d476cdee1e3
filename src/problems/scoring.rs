//! How a moving body comes to its score: looks at it, all of its trials, and the other engine as a judge; and what of a
//! score holds in fresh trials.

use super::locomotion::Locomotion;
use super::task::Task;
use super::validation::Validation;
use crate::creature::Creature;
use crate::evolution::{Fitness, Hurdles, LOOKS, Outcome, sharing};
use crate::simulation::{self, Engine, Trial};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// So many trials has who was looked at once, twice, three times: who is worse than a quarter, half or three quarters
/// of the residents then is tried no further.
const LOOK_TRIALS: [usize; LOOKS] = [1, 2, 4];
/// So many trials has the judge.
const JUDGE_TRIALS: u32 = 4;
/// A score of which the judge finds at least this share stands: engines never agree wholly, and trials vary. Who had
/// to be as good in both would have to be lucky with the judge, and nearly every good offspring would have to be judged.
const CONFIRMED_SHARE: f64 = 0.85;
/// The first perturbation that nobody is selected on.
const FRESH: u32 = 1 << 20;

impl Locomotion {
    /// The score of a body, as far as it gets over the hurdles. Who fails in one trial has failed.
    pub(super) fn score(
        &self,
        creature: &Creature,
        usual: &Trial,
        hurdles: &Hurdles,
    ) -> Result<f64, Outcome> {
        let by = self.robustness.by;
        let mut scores = Vec::new();
        for trial in self.trials(*usual) {
            let look = LOOK_TRIALS.iter().position(|&trials| trials == scores.len());
            if look.is_some_and(|look| Fitness::new(by.of(&scores)) < hurdles.looks[look]) {
                return Ok(by.of(&scores));
            }
            scores.push(self.try_out(creature, &trial, self.engine)?);
        }
        let score = by.of(&scores);
        match self.judged && Fitness::new(score) > hurdles.judge {
            true => self.judge(creature, usual, score, hurdles.judge),
            false => Ok(score),
        }
    }

    /// A body's score if the other engine confirms it in perturbations of its own, else what it gets there, as far as
    /// it gets over the judge's hurdle.
    fn judge(
        &self,
        creature: &Creature,
        usual: &Trial,
        score: f64,
        hurdle: Fitness,
    ) -> Result<f64, Outcome> {
        let trials = match self.robustness.trials {
            0 => vec![*usual],
            first => (first..first + JUDGE_TRIALS).map(|index| usual.perturbed(index)).collect(),
        };
        let mut judged = score;
        let mut scores = Vec::new();
        for trial in trials {
            scores.push(self.try_out(creature, &self.unpushed(trial), self.engine.other())?);
            let found = self.robustness.by.of(&scores);
            judged = if found < CONFIRMED_SHARE * score { score.min(found) } else { score };
            if Fitness::new(judged) <= hurdle {
                break;
            }
        }
        Ok(judged)
    }

    /// That of a body's trials whose score is nearest to what all of them come to, or the first that fails.
    pub(super) fn typical(&self, creature: &Creature, usual: &Trial) -> Trial {
        let mut scores = Vec::new();
        for trial in self.trials(*usual) {
            match self.try_out(creature, &trial, self.engine) {
                Ok(score) => scores.push(score),
                Err(_) => return trial,
            }
        }
        let all = self.robustness.by.of(&scores);
        let tried = self.trials(*usual).zip(&scores);
        let nearest = tried.min_by(|(_, a), (_, b)| (*a - all).abs().total_cmp(&(*b - all).abs()));
        nearest.map_or(*usual, |(trial, _)| trial)
    }

    /// What a body gets in one trial.
    fn try_out(&self, creature: &Creature, trial: &Trial, engine: Engine) -> Result<f64, Outcome> {
        let measured = simulation::simulate(creature, trial, engine)?;
        Ok(self.task.score(&measured))
    }

    pub(super) fn trials(&self, usual: Trial) -> impl Iterator<Item = Trial> {
        self.robustness.trials(usual).map(|trial| self.unpushed(trial))
    }

    /// Nobody is pushed where distance is all that counts, however it came about.
    fn unpushed(&self, trial: Trial) -> Trial {
        if self.task == Task::Course { trial.unpushed() } else { trial }
    }

    /// So many fresh trials in each engine say what a creature is worth: four times as many as a score has.
    pub fn fresh_trials(&self) -> u32 {
        4 * self.robustness.trials.max(1)
    }

    /// Tries a body in so many fresh perturbations in each engine.
    pub fn validate_in_each(&self, creature: &Creature, trials: u32) -> Vec<Validation> {
        Engine::ALL.map(|engine| self.validate_body(creature, engine, trials)).to_vec()
    }

    /// Tries a body in so many fresh perturbations in an engine, on the threads of the current rayon pool.
    pub fn validate_body(&self, creature: &Creature, engine: Engine, trials: u32) -> Validation {
        let usual = self.trial();
        let results = sharing::dearest_first(&vec![1; trials as usize], |index| {
            let trial = self.unpushed(usual.perturbed(FRESH + index as u32));
            let score = || self.try_out(creature, &trial, engine);
            catch_unwind(AssertUnwindSafe(score)).unwrap_or(Err(Outcome::Panicked))
        });
        Validation::of(engine, &results)
    }
}
