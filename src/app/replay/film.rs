//! Trials that are filmed as the user wants them.

use crate::app::cli::ReplayArgs;
use crate::app::genomes::{links_max, reading, robustness};
use crate::creature::{Creature, Reading, Scales};
use crate::evolution::{Evaluation, Problem};
use crate::problems::Locomotion;
use crate::runs::Failure;
use crate::simulation::{Trajectory, Trial};
use crate::view::{Draft, Recorder, RunCard};
use std::path::Path;

/// How creatures are tried.
pub struct Studio {
    /// What they have to do.
    pub problem: Locomotion,
    /// For how long.
    pub trial: Trial,
}

/// A creature, filmed.
pub struct Shot {
    /// Its body and what moves it.
    pub creature: Creature,
    /// What it got.
    pub evaluation: Evaluation,
    /// How it moved.
    pub trajectory: Trajectory,
}

impl Studio {
    /// A studio for a problem, but for what the user wants otherwise.
    ///
    /// # Errors
    /// If more links or trials are asked for than may be, or scales that the profile has not.
    pub fn new(args: &ReplayArgs, problem: Locomotion) -> Result<Self, Failure> {
        let usual = problem.reading();
        let profile = args.profile.unwrap_or(usual.profile);
        let scales = match args.changes.scales() {
            // Scales belong to the profile that they were changed in.
            none if none.is_empty() && profile != usual.profile => Scales::NONE,
            none if none.is_empty() => usual.scales,
            scales => scales,
        };
        let Reading { profile, scales } = reading(profile, scales)?;
        let (trials, by) = (problem.robustness.trials, problem.robustness.by);
        let problem = Locomotion {
            task: args.task.unwrap_or(problem.task),
            profile,
            scales,
            engine: args.engine.unwrap_or(problem.engine),
            links_max: links_max(args.max_links.unwrap_or(problem.links_max))?,
            robustness: robustness(
                args.robustness.unwrap_or(trials),
                args.robust_by.unwrap_or(by),
            )?,
            judged: args.judged.unwrap_or(problem.judged),
            terrain: args.terrain.read()?.or(problem.terrain),
            ..problem
        };
        let usual = problem.trial();
        let trial = Trial { scored_s: args.seconds.unwrap_or(usual.scored_s), ..usual };
        Ok(Self { problem, trial })
    }

    /// The length of a clip, in seconds.
    pub fn clip_s(&self) -> f64 {
        self.trial.settle_s + self.trial.scored_s
    }

    /// Films a creature.
    pub fn shoot(&self, creature: Creature) -> Shot {
        let (evaluation, trajectory) = self.problem.film_trial(&creature, &self.trial);
        Shot { creature, evaluation, trajectory }
    }

    /// A row of a table of scores.
    pub fn row(&self, shot: &Shot, name: &str) -> String {
        let score = self.problem.show(shot.evaluation.fitness);
        format!("{score:>12}  {}  {name}", shot.evaluation.outcome)
    }
}

/// Begins a recording.
///
/// # Errors
/// If it cannot be written there.
pub fn recorder(out: &Path, card: RunCard) -> Result<Recorder, Failure> {
    let elsewhere = |error| Failure::usage(format!("{error}; choose another file with --out"));
    let draft = Draft::beside(out).map_err(elsewhere)?;
    Recorder::create(draft, None, card).map_err(elsewhere)
}
