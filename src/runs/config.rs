//! The whole of a run in one struct: `file` reads and writes it, `check` says whether it can be run.

mod check;
mod file;

pub use file::{FILE_BYTES_MAX, one_line};

use super::catalogue::Kind;
use super::failure::Failure;
use super::seeds::SeedGenomes;
use super::terrains::KeptTerrain;
use crate::archipelago::migration::{MIGRANTS_MAX, Migration};
use crate::archipelago::{Algorithm, Archipelago, Emigrants, ExchangeMode, Replacement, Topology};
use crate::creature::{Profile, Scales};
use crate::evolution::{
    Adaptation, Crossover, Mutation, Reproduction, Selection, Strategy, Survival, Variation,
};
use crate::problems::{Locomotion, RobustBy, Robustness, Task};
use crate::simulation::Engine;
use crate::transport::Domain;
use serde::{Deserialize, Serialize};

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

/// Everything that decides a run. Command-line flags of the same names win over a file, and what neither
/// says has the default.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", default, deny_unknown_fields)]
pub struct Config {
    /// Number of islands, each a process.
    pub islands: u32,
    /// Seed of all randomness; none until one is picked at launch.
    pub seed: Option<u64>,
    /// What searches.
    pub algorithm: Algorithm,
    /// Generations after the random first one.
    pub generations: u32,
    /// Individuals on each island.
    pub population: usize,
    /// What is evolved: creatures, points of a function or bits.
    pub problem: Kind,
    /// Variables of a function, or bits of a genome.
    pub dimensions: usize,
    /// Which shift and rotation a function has.
    pub instance: u64,
    /// Whether a function is rotated.
    pub rotated: bool,
    /// Bits of a block of a trap or a royal road.
    pub block: usize,
    /// What creatures have to do.
    pub task: Task,
    /// How genes are read.
    pub profile: Profile,
    /// What moves the bodies.
    pub engine: Engine,
    /// Perturbed trials of a genome, and four times as many of who may be the best; 0 for one that is not perturbed.
    pub robustness: u32,
    /// What their scores come to.
    pub robust_by: RobustBy,
    /// Whether champions and emigrants are judged by the other engine, too.
    pub judged: bool,
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
    /// How the next population is made of the old one and its offspring.
    pub survival: Survival,
    /// How two parents are recombined.
    pub crossover: Crossover,
    /// Probability of an offspring to have two parents.
    pub crossover_rate: f64,
    /// How a value is changed.
    pub mutation: Mutation,
    /// Probability of each value of each gene to be changed.
    pub point_rate: f64,
    /// The scale of such a change, as a share of the value's range.
    pub point_amount: f64,
    /// Probability of an offspring to lose a gene.
    pub shrink_rate: f64,
    /// Probability of an offspring to gain a gene.
    pub grow_rate: f64,
    /// Probability of an offspring to repeat one of its limbs.
    pub duplicate_rate: f64,
    /// What changes the scale of mutation from one generation to the next.
    pub adaptation: Adaptation,
    /// Whether each island has crossover and mutation rates of its own.
    pub heterogeneous: bool,
    /// Who sends migrants to whom.
    pub topology: Topology,
    /// Generations between two exchanges.
    pub migration_interval: u32,
    /// Individuals that an island sends at each exchange.
    pub migrants: usize,
    /// Epochs by which immigrants are older than they could be, so that no island waits.
    pub migration_lag: u32,
    /// Who is sent.
    pub emigrants: Emigrants,
    /// Whom immigrants replace.
    pub replacement: Replacement,
    /// Whether islands wait for each other; if not, the seed alone does not fix the result.
    pub exchange: ExchangeMode,
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
        let strategy = Strategy::default();
        let variation = strategy.variation;
        Self {
            islands: 4,
            seed: None,
            algorithm: Algorithm::Ga,
            generations: 140,
            population: strategy.population,
            problem: Kind::Creatures,
            dimensions: 30,
            instance: 1,
            rotated: false,
            block: 5,
            task: Task::Walk,
            profile: Profile::Native,
            engine: Locomotion::DEFAULT.engine,
            robustness: Locomotion::DEFAULT.robustness.trials,
            robust_by: Locomotion::DEFAULT.robustness.by,
            judged: Locomotion::DEFAULT.judged,
            genes: 4,
            max_genes: variation.genes_max,
            max_links: Locomotion::DEFAULT.links_max,
            selection: strategy.selection,
            elites: strategy.elites,
            survival: strategy.survival,
            crossover: variation.crossover,
            crossover_rate: variation.crossover_rate,
            mutation: variation.mutation,
            point_rate: variation.point_rate,
            point_amount: variation.point_amount,
            shrink_rate: variation.shrink_rate,
            grow_rate: variation.grow_rate,
            duplicate_rate: variation.duplicate_rate,
            adaptation: strategy.adaptation,
            heterogeneous: strategy.heterogeneous,
            topology: Topology::Ring,
            migration_interval: 5,
            migrants: 2,
            migration_lag: 1,
            emigrants: Emigrants::Best,
            replacement: Replacement::Worst,
            exchange: ExchangeMode::Sync,
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
        self.algorithm.on(Archipelago {
            islands: self.islands,
            seed: self.seed.unwrap_or_default(),
            topology: self.topology,
            migration: Migration {
                interval: self.migration_interval,
                migrants: self.migrants,
                lag: self.migration_lag,
                emigrants: self.emigrants,
                replacement: self.replacement,
                exchange: self.exchange,
            },
            strategy: Strategy {
                population: self.population,
                elites: self.elites,
                reproduction: Reproduction::Parents,
                selection: self.selection,
                survival: self.survival,
                adaptation: self.adaptation,
                heterogeneous: self.heterogeneous,
                variation: Variation {
                    crossover: self.crossover,
                    mutation: self.mutation,
                    duplicate_rate: self.duplicate_rate,
                    crossover_rate: self.crossover_rate,
                    point_rate: self.point_rate,
                    point_amount: self.point_amount,
                    shrink_rate: self.shrink_rate,
                    grow_rate: self.grow_rate,
                    genes_max: self.max_genes,
                },
            },
        })
    }

    /// The configuration that is run: without islands, all individuals live on one.
    pub fn settled(self) -> Self {
        match self.algorithm {
            Algorithm::Panmictic => {
                let islands = self.islands as usize;
                let population = self.population.saturating_mul(islands);
                let elites = match self.survival.is_steady() {
                    true => self.elites,
                    false => self.elites.saturating_mul(islands),
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

    /// The problem of locomotion that is solved where creatures are evolved.
    pub fn locomotion(&self) -> Locomotion {
        Locomotion {
            profile: self.profile,
            scales: self.scales,
            task: self.task,
            genes: self.genes,
            links_max: self.max_links,
            engine: self.engine,
            terrain: self.terrain.as_ref().and_then(|it| it.terrain),
            robustness: Robustness { trials: self.robustness, by: self.robust_by },
            judged: self.judged,
        }
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
}
