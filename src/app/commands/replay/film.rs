//! Trials that are filmed as the user wants them.

use crate::app::args::cli::ReplayArgs;
use crate::app::args::terrain_args;
use crate::creature::{Creature, Scales};
use crate::evolution::Evaluation;
use crate::problems::Locomotion;
use crate::runs::Failure;
use crate::runs::config::Config;
use crate::runs::subject::Subject;
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
    /// A studio that tries creatures as a run with a configuration does, but for what the user wants otherwise.
    ///
    /// # Errors
    /// If more links or trials are asked for than may be, or scales that the profile has not, or the terrain cannot be
    /// used.
    pub fn new(args: &ReplayArgs, usual: &Config) -> Result<Self, Failure> {
        let mut config = args.settings.over(usual.clone());
        config.scales = match args.changes.scales() {
            // Scales belong to the profile that they were changed in.
            none if none.is_empty() && config.profile != usual.profile => Scales::NONE,
            none if none.is_empty() => usual.scales,
            scales => scales,
        };
        terrain_args::find(&mut config, &args.terrain, None)?;
        config.check_values()?;
        let problem = config.locomotion();
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
