//! The flags that say what evolves, and how.

use super::config::Config;
use crate::creature::Profile;
use crate::evolution::Selection;
use crate::problems::Task;
use crate::simulation::Engine;
use clap::Args;

/// The settings of a run.
#[derive(Debug, Args)]
pub struct SettingArgs {
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
    /// What creatures have to do: walk (get away), travel (keep moving), course (as the course
    /// program measures) or climb (up its mountain) [default: walk]
    #[arg(long)]
    pub task: Option<Task>,
    /// How genes are read: native, lecture or coursework [default: native]
    #[arg(long)]
    pub profile: Option<Profile>,
    /// What moves the bodies: rapier (the engine of record) or featherstone (several times as
    /// fast) [default: rapier]
    #[arg(long)]
    pub engine: Option<Engine>,
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
    /// Generations between two clips of an island's champion in the film: fewer make it longer and larger
    /// [default: a twelfth of all]
    #[arg(long, value_name = "G", help_heading = "Running")]
    pub clip_every: Option<u32>,
    /// Threads of all islands together, at least one each; the result does not depend on it
    /// [default: all cores]
    #[arg(long, value_name = "T", help_heading = "Running")]
    pub threads: Option<usize>,
}

impl SettingArgs {
    /// Lays the flags over a configuration.
    pub fn over(&self, config: Config) -> Config {
        Config {
            islands: self.islands.unwrap_or(config.islands),
            seed: self.seed.or(config.seed),
            generations: self.generations.unwrap_or(config.generations),
            population: self.population.unwrap_or(config.population),
            task: self.task.unwrap_or(config.task),
            profile: self.profile.unwrap_or(config.profile),
            engine: self.engine.unwrap_or(config.engine),
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
            clip_every: self.clip_every.or(config.clip_every),
            threads: self.threads.or(config.threads),
            scales: config.scales,
            seed_genomes: config.seed_genomes,
            terrain: config.terrain,
            launch: None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::cli::Cli;
    use super::*;
    use clap::Parser;

    #[test]
    fn every_setting_has_a_flag_that_wins_over_a_file() {
        let flags = "islands --n 9 --seed 9 --generations 9 --population 9 --task travel --profile lecture \
            --genes 9 --max-genes 9 --max-links 9 --selection roulette --elites 9 \
            --crossover-rate 0.9 --point-rate 0.9 --point-amount 0.9 --shrink-rate 0.9 \
            --grow-rate 0.9 --migration-interval 9 --migrants 9 --migration-lag 9 \
            --checkpoint-interval 9 --clip-every 9 --threads 9 --engine featherstone";
        let parsed = Cli::try_parse_from(flags.split_whitespace()).expect("these flags exist");
        let laid =
            toml::Table::try_from(parsed.run.settings.over(Config::default())).expect("plain data");
        let file = toml::Table::try_from(Config::default()).expect("plain data");
        for (name, value) in &file {
            assert!(name == "topology" || laid[name] != *value, "{name} has no flag");
        }
    }
}
