//! The command line.

use super::config::Config;
use crate::creature::Profile;
use crate::evolution::Selection;
use crate::problems::Task;
use clap::{Args, Parser, Subcommand};
use std::path::PathBuf;

/// Evolve virtual creatures on every core, reproducibly to the last bit, and watch them learn to walk.
#[derive(Debug, Parser)]
#[command(
    name = "islands",
    version,
    args_conflicts_with_subcommands = true,
    after_help = "Examples:
  islands --n 4                      four islands evolve walkers
  islands run --n 4 --seed 7         the same, with a seed that fixes the result to the last bit
  islands evaluate champion.csv      how far does this creature get?
  islands replay champion.csv --out walk.rrd && rerun walk.rrd"
)]
pub struct Cli {
    #[command(subcommand)]
    pub command: Option<Command>,
    #[command(flatten)]
    pub run: RunArgs,
}

/// What to do; without a word, `run`.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Evolve creatures on several islands
    Run(Box<RunArgs>),
    /// Score genomes
    Evaluate(EvaluateArgs),
    /// Show the body that a genome describes
    Inspect(InspectArgs),
    /// Film genomes for the Rerun viewer
    Replay(ReplayArgs),
    /// Record and serve a run that is under way; `run` starts one by itself
    Monitor(MonitorArgs),
    /// Check that a run's folder holds what it claims, by simulating its champions again
    Verify(VerifyArgs),
    /// One island of a run; `run` starts them
    #[command(hide = true)]
    Island(IslandArgs),
}

/// A run. What is not said has a default, or is as a file says.
#[derive(Debug, Args)]
pub struct RunArgs {
    /// Number of islands, each a process [default: 4]
    #[arg(long = "n", visible_alias = "islands", value_name = "N")]
    pub islands: Option<u32>,
    /// Seed that fixes the result; picked and printed if none is given
    #[arg(long)]
    pub seed: Option<u64>,
    /// Generations after the random first one [default: 80]
    #[arg(long, value_name = "G")]
    pub generations: Option<u32>,
    /// Individuals on each island [default: 24]
    #[arg(long, value_name = "P")]
    pub population: Option<usize>,
    /// What creatures have to do: walk (get away), travel (keep moving) or course (as the course
    /// program measures) [default: walk]
    #[arg(long)]
    pub task: Option<Task>,
    /// How genes are read: native, lecture or coursework [default: native]
    #[arg(long)]
    pub profile: Option<Profile>,
    /// Genes of a random genome [default: 4]
    #[arg(long, value_name = "G", help_heading = "Genetic algorithm")]
    pub genes: Option<usize>,
    /// No genome gets longer than this [default: 12]
    #[arg(long, value_name = "G", help_heading = "Genetic algorithm")]
    pub max_genes: Option<usize>,
    /// No body gets more links than this [default: 32]
    #[arg(long, value_name = "L", help_heading = "Genetic algorithm")]
    pub max_links: Option<usize>,
    /// How parents are picked: roulette, tournament:SIZE, rank:PRESSURE or truncation:FRACTION
    /// [default: tournament:3]
    #[arg(long, value_name = "SCHEME", help_heading = "Genetic algorithm")]
    pub selection: Option<Selection>,
    /// How many of the best live on unchanged [default: 2]
    #[arg(long, value_name = "E", help_heading = "Genetic algorithm")]
    pub elites: Option<usize>,
    /// Probability of an offspring to have two parents [default: 0.3]
    #[arg(long, value_name = "0..1", help_heading = "Genetic algorithm")]
    pub crossover_rate: Option<f64>,
    /// Probability of each value of a gene to be changed [default: 0.04]
    #[arg(long, value_name = "0..1", help_heading = "Genetic algorithm")]
    pub point_rate: Option<f64>,
    /// The most by which a value is changed, as a share of its range [default: 0.2]
    #[arg(long, value_name = "0..1", help_heading = "Genetic algorithm")]
    pub point_amount: Option<f64>,
    /// Probability of an offspring to lose a gene [default: 0.1]
    #[arg(long, value_name = "0..1", help_heading = "Genetic algorithm")]
    pub shrink_rate: Option<f64>,
    /// Probability of an offspring to gain a gene [default: 0.1]
    #[arg(long, value_name = "0..1", help_heading = "Genetic algorithm")]
    pub grow_rate: Option<f64>,
    /// Generations between two exchanges of migrants [default: 5]
    #[arg(long, value_name = "G", help_heading = "Migration")]
    pub migration_interval: Option<u32>,
    /// Individuals that an island sends at each exchange [default: 2]
    #[arg(long, value_name = "M", help_heading = "Migration")]
    pub migrants: Option<usize>,
    /// Exchanges by which immigrants come later, so that no island waits [default: 1]
    #[arg(long, value_name = "L", help_heading = "Migration")]
    pub migration_lag: Option<u32>,
    /// Generations between two checkpoints of an island: what a crash costs at most [default: 1]
    #[arg(long, value_name = "G", help_heading = "Running")]
    pub checkpoint_interval: Option<u32>,
    /// Threads of all islands together, at least one each; the result does not depend on it
    /// [default: all cores]
    #[arg(long, value_name = "T", help_heading = "Running")]
    pub threads: Option<usize>,
    /// A file that says the same as these flags, such as a run's run.toml; flags win over it
    #[arg(long, value_name = "FILE.toml", help_heading = "Running")]
    pub config: Option<PathBuf>,
    /// Folder for the run's files, new or empty [default: runs/<task>-seed<seed>]
    #[arg(long, value_name = "DIR", help_heading = "Running")]
    pub out: Option<PathBuf>,
    /// Record and serve nothing; every other file is written all the same
    #[arg(long, help_heading = "Running")]
    pub no_monitor: bool,
    /// Show no progress
    #[arg(long, help_heading = "Running")]
    pub quiet: bool,
    /// Print the result as one JSON object, the last line of standard output
    #[arg(long, help_heading = "Running")]
    pub json: bool,
}

impl RunArgs {
    /// Lays the flags over a configuration.
    pub fn over(&self, config: Config) -> Config {
        Config {
            islands: self.islands.unwrap_or(config.islands),
            seed: self.seed.or(config.seed),
            generations: self.generations.unwrap_or(config.generations),
            population: self.population.unwrap_or(config.population),
            task: self.task.unwrap_or(config.task),
            profile: self.profile.unwrap_or(config.profile),
            genes: self.genes.unwrap_or(config.genes),
            max_genes: self.max_genes.unwrap_or(config.max_genes),
            max_links: self.max_links.unwrap_or(config.max_links),
            selection: self.selection.unwrap_or(config.selection),
            elites: self.elites.unwrap_or(config.elites),
            crossover_rate: self.crossover_rate.unwrap_or(config.crossover_rate),
            point_rate: self.point_rate.unwrap_or(config.point_rate),
            point_amount: self.point_amount.unwrap_or(config.point_amount),
            shrink_rate: self.shrink_rate.unwrap_or(config.shrink_rate),
            grow_rate: self.grow_rate.unwrap_or(config.grow_rate),
            topology: config.topology,
            migration_interval: self.migration_interval.unwrap_or(config.migration_interval),
            migrants: self.migrants.unwrap_or(config.migrants),
            migration_lag: self.migration_lag.unwrap_or(config.migration_lag),
            checkpoint_interval: self.checkpoint_interval.unwrap_or(config.checkpoint_interval),
            threads: self.threads.or(config.threads),
            launch: None,
        }
    }
}

/// How a genome file is read and tried.
#[derive(Debug, Clone, Copy, Args)]
pub struct TrialArgs {
    /// What the creature has to do: walk, travel or course
    #[arg(long, default_value_t)]
    pub task: Task,
    /// How genes are read: native, lecture or coursework
    #[arg(long, default_value_t)]
    pub profile: Profile,
    /// No body gets more links than this, but for profile coursework
    #[arg(long, default_value_t = 32, value_name = "L")]
    pub max_links: usize,
}

/// Scoring.
#[derive(Debug, Args)]
pub struct EvaluateArgs {
    /// Files of genomes: a gene a line, 17 numbers from 0 to 1
    #[arg(required = true, value_name = "GENOME.csv")]
    pub genomes: Vec<PathBuf>,
    #[command(flatten)]
    pub trial: TrialArgs,
    /// Threads [default: all cores]
    #[arg(long, value_name = "K")]
    pub threads: Option<usize>,
    /// Evaluate everything so many times, to measure speed
    #[arg(long, default_value_t = 1, value_name = "R")]
    pub repeat: usize,
    /// Print the result as one JSON object, the last line of standard output
    #[arg(long)]
    pub json: bool,
}

/// Looking at a body.
#[derive(Debug, Args)]
pub struct InspectArgs {
    /// File of the genome
    #[arg(value_name = "GENOME.csv")]
    pub genome: PathBuf,
    /// How genes are read: native, lecture or coursework
    #[arg(long, default_value_t)]
    pub profile: Profile,
    /// No body gets more links than this, but for profile coursework
    #[arg(long, default_value_t = 32, value_name = "L")]
    pub max_links: usize,
    /// Print one JSON object
    #[arg(long)]
    pub json: bool,
}

/// Filming.
#[derive(Debug, Args)]
pub struct ReplayArgs {
    /// Files of genomes; several of them race
    #[arg(required = true, value_name = "GENOME.csv")]
    pub genomes: Vec<PathBuf>,
    /// The recording to write
    #[arg(long, value_name = "FILE.rrd")]
    pub out: PathBuf,
    #[command(flatten)]
    pub trial: TrialArgs,
}

/// Watching.
#[derive(Debug, Args)]
pub struct MonitorArgs {
    /// Folder of a run that is under way
    #[arg(value_name = "RUN_DIR")]
    pub dir: PathBuf,
    /// The process that started this one and without which it ends
    #[arg(long, hide = true)]
    pub parent: Option<i32>,
}

/// Checking a run.
#[derive(Debug, Args)]
#[command(
    after_help = "Every checksum is checked, the records of each island are compared with one another and with
its checkpoints, the digest is computed again from the final populations, and every champion is
simulated again and must get its fitness to the last bit. Nothing in the folder is changed. A run
that was interrupted or killed may be verified as well: it has no digest yet, and a record that
was being written when it died is no damage.

Exit codes: 0 all is as it is claimed, 1 something is not, 2 there is no run or it is under way.

Examples:
  islands verify runs/walk-seed7               what the run claims holds here too
  islands verify runs/walk-seed7 --thorough    so does the fitness of everybody else
  islands verify runs/walk-seed7 --json | tail -n 1 | jq .ok"
)]
pub struct VerifyArgs {
    /// Folder of a run that is not under way
    #[arg(value_name = "RUN_DIR")]
    pub dir: PathBuf,
    /// Simulate the newest populations and all migrants again too, not only the champions
    #[arg(long)]
    pub thorough: bool,
    /// Threads [default: all cores]
    #[arg(long, value_name = "K")]
    pub threads: Option<usize>,
    /// Print the result as one JSON object, the last line of standard output
    #[arg(long)]
    pub json: bool,
}

/// One island.
#[derive(Debug, Args)]
pub struct IslandArgs {
    /// Folder of the run
    pub dir: PathBuf,
    /// Which island
    #[arg(long)]
    pub index: u32,
    /// Its threads
    #[arg(long)]
    pub threads: usize,
    /// The process that started this one and without which it ends
    #[arg(long)]
    pub parent: i32,
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_help_names_the_defaults_that_hold() {
        Cli::command().debug_assert();
        let config = toml::Table::try_from(Config::default()).expect("it is plain data");
        for arg in Cli::command().get_arguments() {
            let name = arg.get_id().as_str().replace('_', "-");
            let help = arg.get_help().map(ToString::to_string).unwrap_or_default();
            let Some(value) = config.get(&name) else { continue };
            let value = value.as_str().map_or_else(|| value.to_string(), str::to_owned);
            assert!(help.contains(&format!("[default: {value}]")), "{name} is {value}: {help}");
        }
    }

    #[test]
    fn every_setting_has_a_flag_that_wins_over_a_file() {
        let flags = [
            "islands",
            "--n",
            "9",
            "--seed",
            "9",
            "--generations",
            "9",
            "--population",
            "9",
            "--task",
            "travel",
            "--profile",
            "lecture",
            "--genes",
            "9",
            "--max-genes",
            "9",
            "--max-links",
            "9",
            "--selection",
            "roulette",
            "--elites",
            "9",
            "--crossover-rate",
            "0.9",
            "--point-rate",
            "0.9",
            "--point-amount",
            "0.9",
            "--shrink-rate",
            "0.9",
            "--grow-rate",
            "0.9",
            "--migration-interval",
            "9",
            "--migrants",
            "9",
            "--migration-lag",
            "9",
            "--checkpoint-interval",
            "9",
            "--threads",
            "9",
        ];
        let parsed = Cli::try_parse_from(flags).expect("these flags exist");
        let laid = toml::Table::try_from(parsed.run.over(Config::default())).expect("plain data");
        let file = toml::Table::try_from(Config::default()).expect("plain data");
        for (name, value) in &file {
            assert!(name == "topology" || laid[name] != *value, "{name} has no flag");
        }
    }
}
