//! The whole of a run in one struct: `list` has every setting, `defaults` what it is for each problem, `file` reads and
//! writes it, `check` says whether it can be run, `meaning` what of it decides nothing, and here is what it comes to.

mod check;
mod defaults;
mod file;
mod limits;
mod list;
mod meaning;
mod parts;
mod written;

pub use defaults::Wish;
pub use file::{FILE_BYTES_MAX, flat, one_line};
pub use limits::*;
pub use list::{Config, SETTINGS};
pub use meaning::Unused;
pub use written::{Launch, SeedGenomes};

use super::failure::Failure;
use crate::archipelago::{Algorithm, Archipelago};
use crate::creature::Course;
use crate::problems::Locomotion;
use crate::transport::Domain;

impl Config {
    /// Whether it is that of a run: a launch picks a seed where none is said.
    pub fn is_launched(&self) -> bool {
        self.seed.is_some() && self.launch.is_some()
    }

    /// The version of the program that launched the run, empty if none did.
    pub fn version(&self) -> &str {
        self.launch.as_ref().map_or("", |launch| &launch.version)
    }

    /// What decides the result of the run, but for the problem. A seed that was not picked yet is 0.
    pub fn archipelago(&self) -> Archipelago {
        let seed = self.seed.unwrap_or_default();
        self.algorithm.on(Archipelago { seed, ..self.parts().archipelago })
    }

    /// The problem of locomotion that is solved where creatures are evolved.
    pub fn locomotion(&self) -> Locomotion {
        let terrain = self.terrain.as_ref().and_then(|it| it.terrain.clone());
        let usual = self.parts().locomotion;
        let encoding = Course { scales: self.scales, ..usual.encoding };
        Locomotion { encoding, terrain, ..usual }
    }

    /// The configuration that is run: without islands, all individuals live on one.
    pub fn settled(self) -> Self {
        match self.algorithm {
            Algorithm::Panmictic => {
                let islands = self.islands as usize;
                let population = self.population.saturating_mul(islands);
                let elites = match self.survival.has_elites() {
                    true => self.elites.saturating_mul(islands),
                    false => self.elites,
                };
                Self { islands: 1, population, elites, heterogeneous: false, ..self }
            }
            _ => self,
        }
    }

    /// The shared memory of a run that was launched.
    ///
    /// # Errors
    /// If it never was.
    pub fn domain(&self) -> Result<Domain, Failure> {
        let launch = self.launch.as_ref();
        let launch = launch.ok_or_else(|| Failure::usage("this run was never launched"))?;
        Ok(launch.run_id.parse::<Domain>()?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::archipelago::{ExchangeMode, Replacement};
    use crate::creature::Profile;
    use crate::evolution::Adaptation;
    use crate::problems::{RobustBy, Task};
    use crate::simulation::Engine;
    use serde::Serialize;

    fn is_written_as_shown<T: Serialize + ToString>(choices: &[T]) -> bool {
        let is_same =
            |choice: &T| serde_json::to_value(choice).expect("it is a word") == choice.to_string();
        choices.iter().all(is_same)
    }

    #[test]
    fn a_choice_is_called_the_same_in_a_file_and_on_the_command_line() {
        assert!(is_written_as_shown(&Algorithm::ALL));
        assert!(is_written_as_shown(&Task::ALL));
        assert!(is_written_as_shown(&Profile::ALL));
        assert!(is_written_as_shown(&Engine::ALL));
        assert!(is_written_as_shown(&RobustBy::ALL));
        assert!(is_written_as_shown(&Adaptation::ALL));
        assert!(is_written_as_shown(&Replacement::ALL));
        assert!(is_written_as_shown(&ExchangeMode::ALL));
    }

    #[test]
    fn a_configuration_survives_its_file_and_a_file_need_not_say_everything() {
        let config = Config { seed: Some(7), threads: Some(3), ..Config::default() };
        assert_eq!(Config::parse(&config.to_toml()), Ok(config));
        assert_eq!(Config::parse(""), Ok(Config::default()));
        assert!(Config::parse("popluation = 3").is_err());
    }

    #[test]
    fn the_file_has_sections_and_one_without_them_says_the_same() {
        let config = Config { seed: Some(7), elites: 3, migrants: 1, ..Config::default() };
        let text = config.to_toml();
        for section in ["creatures", "genetic-algorithm", "migration", "running"] {
            assert!(text.contains(&format!("\n[{section}]\n")), "{text}");
        }
        let is_head = |line: &&str| !line.starts_with('[');
        let flat: Vec<&str> = text.lines().filter(is_head).collect();
        assert_eq!(Config::parse(&flat.join("\n")), Ok(config));
        let twice = Config::parse("elites = 1\n[genetic-algorithm]\nelites = 2");
        assert_eq!(twice, Err("elites is said twice".to_owned()));
        let misspelt = Config::parse("[migrations]\nmigrants = 2").expect_err("there is none");
        assert!(misspelt.starts_with("there is no section [migrations]: choose one of vectors, "));
    }
}
