//! What creatures may have to do: each task is a file, and all of them are listed once, in [`Task`].
//!
//! A further task is a file beside these with a [`Definition`], and a line of the list. Flags,
//! help, refusals and reports follow from the list.

pub mod definition;

use crate::choice;
use crate::simulation::{Engine, Measurement, Trial};
use definition::Definition;
use serde::{Deserialize, Serialize};

/// Makes the modules of the tasks, and the enum of them.
macro_rules! tasks {
    ($($(#[$attribute:meta])* $variant:ident => $module:ident,)+) => {
        $(mod $module;)+

        /// What a creature has to do.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
        #[derive(strum::Display, strum::VariantArray)]
        #[strum(serialize_all = "kebab-case")]
        #[serde(rename_all = "kebab-case")]
        pub enum Task {
            $($(#[$attribute])* $variant,)+
        }

        impl Task {
            /// All that there is to say of it.
            fn definition(self) -> &'static Definition {
                match self {
                    $(Task::$variant => &$module::DEFINITION,)+
                }
            }
        }
    };
}

tasks! {
    /// To get away from where it began.
    #[default]
    Walk => walk,
    /// To keep moving.
    Travel => travel,
    /// What the course program has bodies do, for comparison.
    Course => course,
    /// To get up a mountain.
    Climb => climb,
    /// To turn about the vertical.
    Turn => turn,
}

impl Task {
    /// Every task with its aim, as `--help` lists them.
    pub fn list() -> String {
        let lines = Task::ALL.map(|task| format!("{task} ({})", task.definition().aim));
        let [first @ .., last] = &lines;
        format!("{} or {last}", first.join(", "))
    }

    /// How bodies are tried in an engine: with as few steps a second as it needs.
    ///
    /// Of 300 random native bodies (`cargo bench --bench survey -- rates`) half as many steps changed what our own engine
    /// gave at 480 Hz no more than 960 Hz did (rank correlations of walk 0.84 and 0.83). What evolved in such trials held
    /// in other engines better than what evolved at 240 Hz: benches/RESULTS.md. On terrains nobody has measured it.
    pub fn trial_in(self, engine: Engine) -> Trial {
        let trial = self.trial();
        match self.definition().long_steps_per_s {
            Some(steps_per_s) if engine.takes_long_steps() => Trial { steps_per_s, ..trial },
            _ => trial,
        }
    }

    /// How bodies are tried in any engine.
    pub fn trial(self) -> Trial {
        (self.definition().trial)()
    }

    /// Whether perturbed trials push the body.
    pub fn is_pushed(self) -> bool {
        self.definition().is_pushed
    }

    /// What a measurement is worth.
    pub fn score(self, measured: &Measurement) -> f64 {
        (self.definition().score)(measured)
    }

    /// The unit of the score.
    pub fn unit(self) -> &'static str {
        self.definition().unit
    }
}

choice::one_of!("task", Task);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_task_is_listed_by_its_name_with_its_aim_and_read_by_it() {
        for task in Task::ALL {
            assert!(Task::list().contains(&format!("{task} (")), "{}", Task::list());
            assert_eq!(task.to_string().parse(), Ok(task));
            assert_eq!(serde_json::to_value(task).unwrap(), task.to_string());
        }
    }
}
