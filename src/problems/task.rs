//! What creatures may have to do: how they are tried, and what a trial is worth.

use super::progress;
use crate::choice;
use crate::simulation::terrain::mountain;
use crate::simulation::{Engine, Ground, Measurement, Perturbation, Start, Trial};
use serde::{Deserialize, Serialize};

/// What a creature has to do.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Task {
    /// To get away: the horizontal displacement of its centre of mass after settling, if it keeps on:
    /// [`progress::away_m`].
    #[default]
    Walk,
    /// To keep moving: the length of the path of its centre of mass, the lectures' later fitness:
    /// [`progress::travelled_m`].
    Travel,
    /// The course program's set-up and measure: dropped from 2.5 m, distance of the root in space.
    /// It counts the fall, and is here for comparison.
    Course,
    /// To get up the course's mountain, or another terrain: the height that its lowest point gained and kept:
    /// [`progress::climbed_m`].
    Climb,
}

impl Task {
    /// Every task.
    pub const ALL: [Task; 4] = [Task::Walk, Task::Travel, Task::Course, Task::Climb];

    /// How bodies are tried in an engine: with as few steps a second as it needs.
    ///
    /// Of 300 random native bodies (`cargo bench --bench survey -- rates`) half as many steps changed what our own engine
    /// gave at 480 Hz no more than 960 Hz did (rank correlations of walk 0.84 and 0.83). What evolved in such trials held
    /// in other engines better than what evolved at 240 Hz: benches/RESULTS.md. On terrains nobody has measured it.
    pub fn trial_in(self, engine: Engine) -> Trial {
        let trial = self.trial();
        match (self, engine) {
            (Task::Walk | Task::Travel, Engine::Featherstone) => {
                Trial { steps_per_s: trial.steps_per_s / 2, ..trial }
            }
            _ => trial,
        }
    }

    /// How bodies are tried in any engine.
    pub fn trial(self) -> Trial {
        match self {
            Task::Walk | Task::Travel => Trial {
                // What rapier needs. There 240 Hz changed the scores that 480 gave no more than 960 did (rank correlation
                // 0.78 both), 120 more (0.72), and gave bodies eight times as much momentum out of nothing, half of what
                // the ledger refuses.
                steps_per_s: 240,
                perturbation: Perturbation::NONE,
                gravity_m_s2: 9.81,
                ground: Ground::Plane,
                // Low, since a body that falls far bounces, and one that lands on a light root flies off.
                start: Start::LeaningAt(0.1),
                settle_s: 0.5,
                scored_s: 8.0,
                keeps_ledger: true,
            },
            Task::Course => Trial {
                steps_per_s: 240,
                perturbation: Perturbation::NONE,
                gravity_m_s2: 10.0,
                ground: Ground::Plane,
                start: Start::RootAt(2.5),
                settle_s: 0.0,
                scored_s: 10.0,
                // The course refuses nobody, and a comparison must not either.
                keeps_ledger: false,
            },
            Task::Climb => Task::Walk.trial().on(mountain()),
        }
    }

    /// What a measurement is worth, in metres.
    pub fn score(self, measured: &Measurement) -> f64 {
        match self {
            Task::Walk => progress::away_m(&measured.track_m),
            Task::Travel => progress::travelled_m(&measured.track_m, measured.extent_m),
            Task::Climb => progress::climbed_m(&measured.heights_m),
            Task::Course => (measured.root_last_m - measured.root_first_m).norm(),
        }
    }
}

impl std::fmt::Display for Task {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Task::Walk => "walk",
            Task::Travel => "travel",
            Task::Course => "course",
            Task::Climb => "climb",
        })
    }
}

impl std::str::FromStr for Task {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        choice::named("task", &Task::ALL, text)
    }
}
