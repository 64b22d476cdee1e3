//! The whole of a run in one struct.

use super::Failure;
use super::seeds::SeedGenomes;
use super::terrains::{self, KeptTerrain};
use crate::archipelago::{Archipelago, Migration, Topology, migration::MIGRANTS_MAX};
use crate::creature::{Profile, Scales};
use crate::evolution::{Selection, Strategy, Variation};
use crate::problems::{Locomotion, Task};
use crate::simulation::Engine;
use crate::store::{RunDir, file};
use crate::transport::Domain;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// The most islands of a run.
pub const ISLANDS_MAX: u32 = 256;
/// The largest seed: what a TOML file can hold.
pub const SEED_MAX: u64 = i64::MAX as u64;
/// The most individuals of an island.
pub const POPULATION_MAX: usize = 100_000;
/// The longest genome that may be asked for, in genes.
pub const GENES_MAX: usize = 1_000;
/// The most genes that the genomes of an island may have together: its checkpoint must be readable.
pub const GENES_OF_ISLAND_MAX: usize = 5_000_000;
/// The largest body that may be asked for, in links.
pub const LINKS_MAX: usize = 512;
/// The most threads.
pub const THREADS_MAX: usize = 4_096;

/// The settings that do not decide what evolves, only how long and how it is run: a run that goes on may have
/// other ones.
pub const FREE: [&str; 4] = ["generations", "threads", "checkpoint-interval", "clip-every"];

/// The largest configuration file, in bytes; ours have a thousand.
pub const FILE_BYTES_MAX: usize = 1 << 20;
/// The longest complaint about a file that is passed on, in characters.
const COMPLAINT_MAX: usize = 400;

/// Everything that decides a run. Command-line flags of the same names win over a file, and what neither
/// says has the default.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", default, deny_unknown_fields)]
pub struct Config {
    /// Number of islands, each a process.
    pub islands: u32,
    /// Seed of all randomness; none until one is picked at launch.
    pub seed: Option<u64>,
    /// Generations after the random first one.
    pub generations: u32,
    /// Individuals on each island.
    pub population: usize,
    /// What creatures have to do.
    pub task: Task,
    /// How genes are read.
    pub profile: Profile,
    /// What moves the bodies.
    pub engine: Engine,
    /// Genes of a random genome.
    pub genes: usize,
    /// No genome gets longer than this, in genes.
    pub max_genes: usize,
    /// The largest body that is built, in links.
    pub max_links: usize,
    /// How parents are picked.
    pub selection: Selection,
    /// How many of the best live on unchanged.
    pub elites: usize,
    /// Probability of an offspring to have two parents.
    pub crossover_rate: f64,
    /// Probability of each value of each gene to be changed.
    pub point_rate: f64,
    /// The most by which a value is changed, as a share of its range.
    pub point_amount: f64,
    /// Probability of an offspring to lose a gene.
    pub shrink_rate: f64,
    /// Probability of an offspring to gain a gene.
    pub grow_rate: f64,
    /// Who sends migrants to whom.
    pub topology: Topology,
    /// Generations between two exchanges.
    pub migration_interval: u32,
    /// Individuals that an island sends at each exchange.
    pub migrants: usize,
    /// Epochs by which immigrants are older than they could be, so that no island waits.
    pub migration_lag: u32,
    /// Generations between two checkpoints of an island; its first and last state are always saved. The result
    /// does not depend on it.
    pub checkpoint_interval: u32,
    /// Generations between two clips of each island's champion in the film; a twelfth of all of them if none is
    /// said. The result does not depend on it.
    pub clip_every: Option<u32>,
    /// Threads of all islands together, at least one each; as many as there are cores if none is said. The result
    /// does not depend on it.
    pub threads: Option<usize>,
    /// Scales of profile `coursework` that were changed.
    #[serde(skip_serializing_if = "Scales::is_empty")]
    pub scales: Scales,
    /// The genomes that the islands begin with, if not all are random: the run's folder keeps them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub seed_genomes: Option<SeedGenomes>,
    /// What creatures stand on, if not on the task's ground: the run's folder keeps it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub terrain: Option<KeptTerrain>,
    /// What launched the run: written by the program, ignored when it is read for a new run.
    pub launch: Option<Launch>,
}

/// What launched a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub struct Launch {
    /// The version of the program.
    pub version: String,
    /// Names the run's shared memory, in hexadecimal; another one at each launch.
    pub run_id: String,
}

impl Default for Config {
    fn default() -> Self {
        Self {
            islands: 4,
            seed: None,
            generations: 80,
            population: 24,
            task: Task::Walk,
            profile: Profile::Native,
            engine: Engine::Rapier,
            genes: 4,
            max_genes: 12,
            max_links: 32,
            selection: Selection::Tournament { size: 3 },
            elites: 2,
            crossover_rate: 0.3,
            point_rate: 0.04,
            point_amount: 0.2,
            shrink_rate: 0.1,
            grow_rate: 0.1,
            topology: Topology::Ring,
            migration_interval: 5,
            migrants: 2,
            migration_lag: 1,
            checkpoint_interval: 1,
            clip_every: None,
            threads: None,
            scales: Scales::NONE,
            seed_genomes: None,
            terrain: None,
            launch: None,
        }
    }
}

impl Config {
    /// Reads a configuration file.
    ///
    /// # Errors
    /// If it cannot be read, is too large, no TOML, or says something that a configuration does not know.
    pub fn read(path: &Path) -> Result<Self, Failure> {
        let wrong =
            |reason: String| Failure::usage(format!("cannot use {}: {reason}", path.display()));
        let text = file::read_text(path, FILE_BYTES_MAX).map_err(|error| {
            wrong(format!("{}; name a file such as a run's run.toml", error.reason()))
        })?;
        Self::parse(&text).map_err(wrong)
    }

    /// Reads what a configuration file says.
    ///
    /// # Errors
    /// What is wrong with it, if it is no TOML or says something that a configuration does not know.
    pub fn parse(text: &str) -> Result<Self, String> {
        toml::from_str(text).map_err(|error| one_line(&error, text))
    }

    /// Reads the configuration of a run that was launched.
    ///
    /// # Errors
    /// If there is none, it cannot be read, is not sound, or was not written by a launch.
    pub fn of_run(dir: &RunDir) -> Result<Self, Failure> {
        if !dir.config().exists() {
            return Err(Failure::no_run(dir));
        }
        let mut config = Self::read(&dir.config())?;
        terrains::read(&mut config, dir)?;
        config.check()?;
        match config.is_launched() {
            true => Ok(config),
            false => Err(Failure::usage(format!(
                "{} was not written by a run: start one with islands --config {0}",
                dir.config().display()
            ))),
        }
    }

    /// The file that says the same.
    pub fn to_toml(&self) -> String {
        toml::to_string(self).expect("a checked configuration is plain data within TOML's ranges")
    }

    /// Says what is wrong with the configuration, if anything.
    ///
    /// # Errors
    /// One sentence that says what to change.
    pub fn check(&self) -> Result<(), Failure> {
        self.check_ranges()?;
        self.check_genes()?;
        self.check_migrants()?;
        self.terrain.as_ref().map_or(Ok(()), KeptTerrain::check)?;
        self.scales.check(self.profile).map_err(|error| Failure::usage(error.to_string()))?;
        match self.seed {
            Some(seed) if seed > SEED_MAX => {
                Err(Failure::usage(format!("seed must be at most {SEED_MAX}")))
            }
            _ => Ok(()),
        }
    }

    fn check_ranges(&self) -> Result<(), Failure> {
        let within = |name, value: f64, least: f64, most: f64| {
            let fine = (least..=most).contains(&value);
            fine.then_some(()).ok_or_else(|| {
                Failure::usage(format!("{name} must be from {least} to {most}, not {value}"))
            })
        };
        within("islands (--n)", f64::from(self.islands), 1.0, f64::from(ISLANDS_MAX))?;
        within("population", self.population as f64, 2.0, POPULATION_MAX as f64)?;
        within("max-genes", self.max_genes as f64, 1.0, GENES_MAX as f64)?;
        within("genes", self.genes as f64, 1.0, self.max_genes as f64)?;
        within("max-links", self.max_links as f64, 1.0, LINKS_MAX as f64)?;
        within("elites", self.elites as f64, 0.0, self.population as f64 - 1.0)?;
        within("crossover-rate", self.crossover_rate, 0.0, 1.0)?;
        within("point-rate", self.point_rate, 0.0, 1.0)?;
        within("point-amount", self.point_amount, 0.0, 1.0)?;
        within("shrink-rate", self.shrink_rate, 0.0, 1.0)?;
        within("grow-rate", self.grow_rate, 0.0, 1.0)?;
        within("migration-interval", f64::from(self.migration_interval), 1.0, 1e9)?;
        within("migration-lag", f64::from(self.migration_lag), 0.0, 1e3)?;
        within("checkpoint-interval", f64::from(self.checkpoint_interval), 1.0, 1e9)?;
        within("clip-every", f64::from(self.clip_every.unwrap_or(1)), 1.0, 1e9)?;
        within("generations", f64::from(self.generations), 0.0, 1e9)?;
        let threads = self.threads.unwrap_or(1);
        within("threads", threads as f64, 1.0, THREADS_MAX as f64)
    }

    fn check_genes(&self) -> Result<(), Failure> {
        let genes = self.population.saturating_mul(self.max_genes);
        if genes > GENES_OF_ISLAND_MAX {
            return Err(Failure::usage(format!(
                "a population of {} with max-genes {} may have {genes} genes: an island holds {GENES_OF_ISLAND_MAX} \
                 at most",
                self.population, self.max_genes
            )));
        }
        Ok(())
    }

    fn check_migrants(&self) -> Result<(), Failure> {
        let migrants_max = MIGRANTS_MAX.min(self.population);
        if self.migrants > migrants_max {
            return Err(Failure::usage(format!(
                "{} migrants are more than there can be: take at most {migrants_max}, with a \
                 population of {}",
                self.migrants, self.population
            )));
        }
        Ok(())
    }

    /// The settings that decide what evolves, as TOML: all but [`FREE`] and what launched it. States that were
    /// saved under other ones, or by another version, are of no use.
    pub fn settings(&self) -> String {
        self.settings_of(env!("CARGO_PKG_VERSION"))
    }

    /// The settings as a version of the program has them that knows the same ones.
    pub fn settings_of(&self, version: &str) -> String {
        let mut settings =
            toml::Table::try_from(self).expect("a checked configuration is plain data");
        for other in FREE.into_iter().chain(["launch"]) {
            settings.remove(other);
        }
        settings.insert("version".to_owned(), version.into());
        settings.to_string()
    }

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
        Archipelago {
            islands: self.islands,
            seed: self.seed.unwrap_or_default(),
            topology: self.topology,
            migration: Migration {
                interval: self.migration_interval,
                migrants: self.migrants,
                lag: self.migration_lag,
            },
            strategy: Strategy {
                population: self.population,
                elites: self.elites,
                selection: self.selection,
                variation: Variation {
                    crossover_rate: self.crossover_rate,
                    point_rate: self.point_rate,
                    point_amount: self.point_amount,
                    shrink_rate: self.shrink_rate,
                    grow_rate: self.grow_rate,
                    genes_max: self.max_genes,
                },
            },
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

    /// The problem that is solved.
    pub fn problem(&self) -> Locomotion {
        Locomotion {
            profile: self.profile,
            scales: self.scales,
            task: self.task,
            genes: self.genes,
            links_max: self.max_links,
            engine: self.engine,
            terrain: self.terrain.as_ref().and_then(|it| it.terrain),
        }
    }
}

/// TOML's errors draw the line that they complain of; ours are one sentence.
fn one_line(error: &toml::de::Error, text: &str) -> String {
    // It may quote the file: neither at any length nor what a terminal would obey.
    let shown = error.message().chars().take(COMPLAINT_MAX);
    let message: String = shown.map(|c| if c.is_control() { ' ' } else { c }).collect();
    match error.span().and_then(|span| text.get(..span.start)) {
        Some(before) => format!("line {}: {message}", before.matches('\n').count() + 1),
        None => message,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_configuration_survives_its_file_and_a_file_need_not_say_everything() {
        let config = Config { seed: Some(7), threads: Some(3), ..Config::default() };
        assert_eq!(toml::from_str(&config.to_toml()), Ok(config));
        assert_eq!(toml::from_str(""), Ok(Config::default()));
        assert!(toml::from_str::<Config>("popluation = 3").is_err());
    }

    #[test]
    fn the_defaults_are_sound_and_each_impossible_wish_is_refused() {
        let sound = Config::default();
        assert!(sound.check().is_ok());
        for wrong in [
            Config { islands: 0, ..sound.clone() },
            Config { population: 1, ..sound.clone() },
            Config { migrants: 25, ..sound.clone() },
            Config { migrants: 33, population: 99, ..sound.clone() },
            Config { elites: 24, ..sound.clone() },
            Config { genes: 13, ..sound.clone() },
            Config { genes: 0, ..sound.clone() },
            Config { point_rate: f64::NAN, ..sound.clone() },
            Config { migration_interval: 0, ..sound.clone() },
            Config { threads: Some(0), ..sound.clone() },
            Config { clip_every: Some(0), ..sound.clone() },
            Config { threads: Some(usize::MAX), ..sound.clone() },
            Config { seed: Some(u64::MAX), ..sound.clone() },
        ] {
            assert!(wrong.check().is_err(), "{wrong:?}");
        }
    }
}
