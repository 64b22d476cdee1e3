//! How a moving body comes to its score: looks at it, all of its trials, and the other engine as a judge; and what of a
//! score holds in fresh trials.

use super::locomotion::Locomotion;
use super::validation::Validation;
use crate::creature::Creature;
use crate::creature::encodings::Encoding;
use crate::evolution::{Fitness, Hurdles, LOOKS, Outcome};
use crate::simulation::{self, Engine, Trial};
use crate::work_queue;
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

impl<E: Encoding> Locomotion<E> {
    /// The score of a body, as far as it gets over the hurdles. Who fails in one trial has failed.
    pub(super) fn score(
        &self,
        creature: &Creature,
        usual: &Trial,
        hurdles: &Hurdles,
    ) -> Result<f64, Outcome> {
        self.score_knowing(&mut Vec::new(), creature, usual, hurdles)
    }

    /// The same, where the outcomes of some first trials are known. More of them are afterwards.
    fn score_knowing(
        &self,
        known: &mut Vec<Result<f64, Outcome>>,
        creature: &Creature,
        usual: &Trial,
        hurdles: &Hurdles,
    ) -> Result<f64, Outcome> {
        let trials: Vec<Trial> = self.trials(usual.clone()).collect();
        let mut scores = Vec::new();
        for index in 0..trials.len() {
            if self.fails(&scores, hurdles) {
                return Ok(self.robustness.by.of(&scores));
            }
            if index == known.len() {
                let next =
                    &trials[index..][..self.at_a_time(index, hurdles).min(trials.len() - index)];
                known.extend(self.try_each(creature, next));
            }
            scores.push(known[index]?);
        }
        let score = self.robustness.by.of(&scores);
        match self.judged && Fitness::new(score) > hurdles.best {
            true => self.judge(creature, usual, score, hurdles.best),
            false => Ok(score),
        }
    }

    /// So many trials go side by side after some. Most offspring fail at the first look: who may has its first trial
    /// alone.
    fn at_a_time(&self, tried: usize, hurdles: &Hurdles) -> usize {
        let most = simulation::at_a_time(self.engine, &self.trial().ground);
        match tried {
            0 if hurdles.looks[0] > Fitness::WORST => 1,
            _ => most - tried % most,
        }
    }

    /// Whether a body whose trials came to some scores so far is tried no further.
    fn fails(&self, scores: &[f64], hurdles: &Hurdles) -> bool {
        let so_far = || Fitness::new(self.robustness.by.of(scores));
        match (scores.len(), self.robustness.trials as usize) {
            (0, _) => false,
            (tried, usual) if tried < usual => {
                let look = LOOK_TRIALS.iter().position(|&trials| trials == tried);
                look.is_some_and(|look| so_far() < hurdles.looks[look])
            }
            (tried, usual) => tried.is_multiple_of(usual) && so_far() <= hurdles.best,
        }
    }

    /// All scores that a body can have where it fails at some hurdle, and its whole score, which is the last.
    pub(super) fn possible(&self, creature: &Creature) -> Vec<Fitness> {
        let (usual, mut known) = (self.trial(), Vec::new());
        let mut score = |hurdles: Hurdles| {
            let score = self.score_knowing(&mut known, creature, &usual, &hurdles);
            score.map_or(Fitness::WORST, Fitness::new)
        };
        let mut possible = Vec::new();
        for look in 0..LOOKS {
            let mut hurdles = Hurdles::NONE;
            hurdles.looks[look] = Fitness::HIGHEST;
            possible.push(score(hurdles));
        }
        // After the usual trials who is not the best fails where what its trials come to is lower than ever before.
        let mut lowest = score(Hurdles::LAST);
        possible.push(lowest);
        loop {
            let found = score(Hurdles { best: lowest.just_below(), ..Hurdles::NONE });
            if found >= lowest {
                break;
            }
            possible.push(found);
            lowest = found;
        }
        possible.push(score(Hurdles::NONE));
        possible
    }

    /// A body's score if the other engine confirms it in perturbations of its own, else what it gets there, as far as
    /// it gets over the judge's hurdle. Nobody is judged by an engine that cannot do the trial.
    fn judge(
        &self,
        creature: &Creature,
        usual: &Trial,
        score: f64,
        hurdle: Fitness,
    ) -> Result<f64, Outcome> {
        let Some(engine) = self.judge_of(usual) else { return Ok(score) };
        let other = Self { engine, ..self.clone() };
        let usual = Trial { steps_per_s: other.trial().steps_per_s, ..usual.clone() };
        let trials = match self.robustness.trials {
            0 => vec![usual],
            _ => (0..JUDGE_TRIALS).map(|index| usual.perturbed(self.unscored() + index)).collect(),
        };
        let mut judged = score;
        let mut scores = Vec::new();
        for trial in trials {
            scores.push(self.try_out(creature, &self.unpushed(trial), other.engine)?);
            let found = self.robustness.by.of(&scores);
            judged = if found < CONFIRMED_SHARE * score { score.min(found) } else { score };
            if Fitness::new(judged) <= hurdle {
                break;
            }
        }
        Ok(judged)
    }

    /// The score of a body, and that of its trials whose score is nearest to what all of them come to, or the first that
    /// fails.
    pub(super) fn typical(
        &self,
        creature: &Creature,
        usual: &Trial,
    ) -> (Result<f64, Outcome>, Trial) {
        let mut tried = Vec::new();
        let score = self.score_knowing(&mut tried, creature, usual, &Hurdles::NONE);
        let scores: Vec<f64> = tried.iter().copied().flatten().collect();
        let all = self.robustness.by.of(&scores);
        let far = |result: &Result<f64, Outcome>| result.map_or(-1.0, |own| (own - all).abs());
        let trials = self.trials(usual.clone()).zip(&tried);
        let nearest = trials.min_by(|(_, a), (_, b)| far(a).total_cmp(&far(b)));
        (score, nearest.map_or_else(|| usual.clone(), |(trial, _)| trial))
    }

    /// The engine that judges a trial, if it can do it.
    fn judge_of(&self, trial: &Trial) -> Option<Engine> {
        let judge = self.engine.judge();
        simulation::check(judge, trial).is_ok().then_some(judge)
    }

    /// What a body gets in the other engine, or the own one if only that can do the trial, in as many perturbations as
    /// its score has and none of the same ones. A trial that blew up counts as a score of 0.
    pub fn elsewhere(&self, creature: &Creature) -> Fitness {
        let engine = self.judge_of(&self.trial()).unwrap_or(self.engine);
        let trials = self.robustness.trials;
        let results = self.try_perturbed(creature, engine, self.unscored(), trials);
        let scores: Vec<f64> = results.into_iter().map(|result| result.unwrap_or(0.0)).collect();
        Fitness::new(self.robustness.by.of(&scores))
    }

    /// The first perturbation that no score comes from.
    fn unscored(&self) -> u32 {
        self.robustness.trials_of_the_best()
    }

    /// What a body gets in one trial.
    fn try_out(&self, creature: &Creature, trial: &Trial, engine: Engine) -> Result<f64, Outcome> {
        let measured = simulation::simulate(creature, trial, engine)?;
        Ok(self.task.score(&measured))
    }

    /// What a body gets in each of some trials, which go side by side.
    fn try_each(&self, creature: &Creature, trials: &[Trial]) -> Vec<Result<f64, Outcome>> {
        let measured = simulation::simulate_each(creature, trials, self.engine).into_iter();
        measured.map(|measured| Ok(self.task.score(&measured?))).collect()
    }

    pub(super) fn trials(&self, usual: Trial) -> impl Iterator<Item = Trial> {
        self.robustness.trials(usual).map(|trial| self.unpushed(trial))
    }

    /// Nobody is pushed where that would be a free gain.
    fn unpushed(&self, trial: Trial) -> Trial {
        if self.task.is_pushed() { trial } else { trial.unpushed() }
    }

    /// So many fresh trials in each engine say what a creature is worth: four times as many as a score has.
    pub fn fresh_trials(&self) -> u32 {
        4 * self.robustness.trials.max(1)
    }

    /// Tries a body in so many fresh perturbations in each engine that can do the trial.
    pub fn validate_in_each(&self, creature: &Creature, trials: u32) -> Vec<Validation> {
        let usual = self.trial();
        let engines = Engine::ALL.into_iter().filter(|it| simulation::check(*it, &usual).is_ok());
        engines.map(|engine| self.validate_body(creature, engine, trials)).collect()
    }

    /// Tries a body in so many fresh perturbations in an engine, on the threads of the current rayon pool.
    pub fn validate_body(&self, creature: &Creature, engine: Engine, trials: u32) -> Validation {
        Validation::of(engine, &self.try_perturbed(creature, engine, FRESH, trials))
    }

    /// What a body gets in so many perturbations from a first one on, on the threads of the current rayon pool.
    fn try_perturbed(
        &self,
        creature: &Creature,
        engine: Engine,
        first: u32,
        trials: u32,
    ) -> Vec<Result<f64, Outcome>> {
        let problem = Self { engine, ..self.clone() };
        let usual = problem.trial();
        let trial = |index| self.unpushed(usual.perturbed(first + index));
        let trials: Vec<Trial> = (0..trials).map(trial).collect();
        let groups: Vec<&[Trial]> =
            trials.chunks(simulation::at_a_time(engine, &usual.ground)).collect();
        let tried = work_queue::dearest_first(&vec![1; groups.len()], |group| {
            let scores = || problem.try_each(creature, groups[group]);
            catch_unwind(AssertUnwindSafe(scores))
                .unwrap_or_else(|_| vec![Err(Outcome::Panicked); groups[group].len()])
        });
        tried.into_iter().flatten().collect()
    }
}
