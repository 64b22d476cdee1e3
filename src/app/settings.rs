//! The flags that say what evolves, and how.

use super::problem_args::ProblemArgs;
use crate::archipelago::{Algorithm, Emigrants, ExchangeMode, Replacement, Topology};
use crate::creature::Profile;
use crate::evolution::{Adaptation, Crossover, Mutation, Selection, Survival};
use crate::problems::{RobustBy, Task};
use crate::runs::config::Config;
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
    /// What searches: ga, or to compare with it random, hill-climb, cma-es or panmictic (one large population)
    /// [default: ga]
    #[arg(long)]
    pub algorithm: Option<Algorithm>,
    /// Generations after the random first one [default: 140]
    #[arg(long, value_name = "G")]
    pub generations: Option<u32>,
    /// Individuals on each island [default: 24]
    #[arg(long, value_name = "P")]
    pub population: Option<usize>,
    #[command(flatten)]
    pub problem: ProblemArgs,
    /// What creatures have to do.
    #[arg(long, help = format!("What creatures have to do: {} [default: walk]", Task::list()))]
    pub task: Option<Task>,
    /// How genes are read: native, lecture or coursework [default: native]
    #[arg(long)]
    pub profile: Option<Profile>,
    /// Physics engine: featherstone (our own, ten times as fast) or rapier [default: featherstone]
    #[arg(long)]
    pub engine: Option<Engine>,
    /// Perturbed trials of each genome, and four times as many of who would be the best: friction, motor strength, first
    /// direction, a push and the step differ, so that luck and quirks of one world count little; 0 for one trial as it
    /// is [default: 8]
    #[arg(long, value_name = "K")]
    pub robustness: Option<u32>,
    /// What the scores of these trials come to: mean, median, quartile (the lower one) or worst [default:
    /// quartile]
    #[arg(long, value_name = "HOW")]
    pub robust_by: Option<RobustBy>,
    /// Have the other engine judge who would be champion or emigrates: where it finds less than 0.85 of a score, its own
    /// counts [default: false]
    #[arg(long, num_args = 0..=1, require_equals = true, default_missing_value = "true", value_name = "BOOL")]
    pub judged: Option<bool>,
    /// Genes of a random genome [default: 4]
    #[arg(long, value_name = "G", help_heading = "Genetic algorithm")]
    pub genes: Option<usize>,
    /// No genome gets longer than this [default: 12]
    #[arg(long, value_name = "G", help_heading = "Genetic algorithm")]
    pub max_genes: Option<usize>,
    /// No body gets more links than this [default: 16]
    #[arg(long, value_name = "L", help_heading = "Genetic algorithm")]
    pub max_links: Option<usize>,
    /// How parents are picked: roulette, sus, tournament:SIZE, rank:PRESSURE or truncation:FRACTION
    /// [default: tournament:3], with --survival sharing sus
    #[arg(long, value_name = "SCHEME", help_heading = "Genetic algorithm")]
    pub selection: Option<Selection>,
    /// How many of the best live on unchanged [default: 2]
    #[arg(long, value_name = "E", help_heading = "Genetic algorithm")]
    pub elites: Option<usize>,
    /// How the next population is made: generational, drifting, sharing:RADIUS, crowding, afpo or map-elites:BINS
    /// [default: generational]
    #[arg(long, value_name = "SCHEME", help_heading = "Genetic algorithm")]
    pub survival: Option<Survival>,
    /// How two parents are recombined: one-point, two-point, uniform, blend:ALPHA or sbx:ETA
    /// [default: one-point]
    #[arg(long, value_name = "OPERATOR", help_heading = "Genetic algorithm")]
    pub crossover: Option<Crossover>,
    /// Probability of an offspring to have two parents [default: 0.3]
    #[arg(long, value_name = "0..1", help_heading = "Genetic algorithm")]
    pub crossover_rate: Option<f64>,
    /// How a value is changed: uniform, gaussian or polynomial:ETA [default: uniform]
    #[arg(long, value_name = "OPERATOR", help_heading = "Genetic algorithm")]
    pub mutation: Option<Mutation>,
    /// Probability of each value of a gene to be changed [default: 0.04]
    #[arg(long, value_name = "0..1", help_heading = "Genetic algorithm")]
    pub point_rate: Option<f64>,
    /// The scale of such a change, as a share of the value's range [default: 0.2]
    #[arg(long, value_name = "0..1", help_heading = "Genetic algorithm")]
    pub point_amount: Option<f64>,
    /// Probability of an offspring to lose a gene [default: 0.1]
    #[arg(long, value_name = "0..1", help_heading = "Genetic algorithm")]
    pub shrink_rate: Option<f64>,
    /// Probability of an offspring to gain a gene [default: 0.1]
    #[arg(long, value_name = "0..1", help_heading = "Genetic algorithm")]
    pub grow_rate: Option<f64>,
    /// Probability of an offspring to repeat one of its limbs [default: 0.0]
    #[arg(long, value_name = "0..1", help_heading = "Genetic algorithm")]
    pub duplicate_rate: Option<f64>,
    /// What changes the scale of mutation on the way: none, or one-fifth (the 1/5 success rule) [default: none]
    #[arg(long, value_name = "RULE", help_heading = "Genetic algorithm")]
    pub adaptation: Option<Adaptation>,
    /// Give each island crossover and mutation rates of its own [default: false]
    #[arg(long, num_args = 0..=1, require_equals = true, default_missing_value = "true", value_name = "BOOL",
        help_heading = "Genetic algorithm")]
    pub heterogeneous: Option<bool>,
    /// Who sends migrants to whom: ring, bidirectional-ring, full, torus, star, hypercube, random-regular:DEGREE
    /// or none [default: ring]
    #[arg(long, value_name = "GRAPH", help_heading = "Migration")]
    pub topology: Option<Topology>,
    /// Generations between two exchanges of migrants [default: 5]
    #[arg(long, value_name = "G", help_heading = "Migration")]
    pub migration_interval: Option<u32>,
    /// Individuals that an island sends at each exchange [default: 2]
    #[arg(long, value_name = "M", help_heading = "Migration")]
    pub migrants: Option<usize>,
    /// Exchanges by which immigrants come later, so that no island waits [default: 1]
    #[arg(long, value_name = "L", help_heading = "Migration")]
    pub migration_lag: Option<u32>,
    /// Who is sent: best, random or tournament:SIZE [default: best]
    #[arg(long, value_name = "WHO", help_heading = "Migration")]
    pub emigrants: Option<Emigrants>,
    /// Whom an immigrant replaces: worst (if it is better), random (any but the best) or similar (the most
    /// similar, if it is better) [default: worst]
    #[arg(long, value_name = "WHOM", help_heading = "Migration")]
    pub replacement: Option<Replacement>,
    /// Whether islands wait for each other's migrants: sync, or async (each takes in what has arrived; the seed
    /// alone does not fix the result then, but what arrived is recorded and can be replayed) [default: sync]
    #[arg(long, value_name = "HOW", help_heading = "Migration")]
    pub exchange: Option<ExchangeMode>,
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
        let config = self.problem.over(config);
        Config {
            islands: self.islands.unwrap_or(config.islands),
            seed: self.seed.or(config.seed),
            algorithm: self.algorithm.unwrap_or(config.algorithm),
            generations: self.generations.unwrap_or(config.generations),
            population: self.population.unwrap_or(config.population),
            task: self.task.unwrap_or(config.task),
            profile: self.profile.unwrap_or(config.profile),
            engine: self.engine.unwrap_or(config.engine),
            robustness: self.robustness.unwrap_or(config.robustness),
            robust_by: self.robust_by.unwrap_or(config.robust_by),
            judged: self.judged.unwrap_or(config.judged),
            genes: self.genes.unwrap_or(config.genes),
            max_genes: self.max_genes.unwrap_or(config.max_genes),
            max_links: self.max_links.unwrap_or(config.max_links),
            selection: self.selection.unwrap_or(config.selection),
            elites: self.elites.unwrap_or(config.elites),
            survival: self.survival.unwrap_or(config.survival),
            crossover: self.crossover.unwrap_or(config.crossover),
            crossover_rate: self.crossover_rate.unwrap_or(config.crossover_rate),
            mutation: self.mutation.unwrap_or(config.mutation),
            point_rate: self.point_rate.unwrap_or(config.point_rate),
            point_amount: self.point_amount.unwrap_or(config.point_amount),
            shrink_rate: self.shrink_rate.unwrap_or(config.shrink_rate),
            grow_rate: self.grow_rate.unwrap_or(config.grow_rate),
            duplicate_rate: self.duplicate_rate.unwrap_or(config.duplicate_rate),
            adaptation: self.adaptation.unwrap_or(config.adaptation),
            heterogeneous: self.heterogeneous.unwrap_or(config.heterogeneous),
            topology: self.topology.unwrap_or(config.topology),
            migration_interval: self.migration_interval.unwrap_or(config.migration_interval),
            migrants: self.migrants.unwrap_or(config.migrants),
            migration_lag: self.migration_lag.unwrap_or(config.migration_lag),
            emigrants: self.emigrants.unwrap_or(config.emigrants),
            replacement: self.replacement.unwrap_or(config.replacement),
            exchange: self.exchange.unwrap_or(config.exchange),
            checkpoint_interval: self.checkpoint_interval.unwrap_or(config.checkpoint_interval),
            clip_every: self.clip_every.or(config.clip_every),
            threads: self.threads.or(config.threads),
            scales: config.scales,
            seed_genomes: config.seed_genomes,
            terrain: config.terrain,
            launch: None,
            ..config
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::cli::Cli;
    use clap::Parser;

    #[test]
    fn every_setting_has_a_flag_that_wins_over_a_file() {
        let flags = "islands --n 9 --seed 9 --generations 9 --population 9 --task travel --profile lecture \
            --genes 9 --max-genes 9 --max-links 9 --selection roulette --elites 9 \
            --crossover-rate 0.9 --point-rate 0.9 --point-amount 0.9 --shrink-rate 0.9 \
            --grow-rate 0.9 --migration-interval 9 --migrants 9 --migration-lag 9 \
            --topology torus --emigrants random --replacement similar --exchange async \
            --checkpoint-interval 9 --clip-every 9 --threads 9 --engine rapier --algorithm random --survival crowding \
            --crossover uniform --mutation gaussian --duplicate-rate 0.9 --adaptation one-fifth --heterogeneous --problem sphere \
            --dimensions 9 --instance 9 --rotated --block 9 --robustness 9 --robust-by worst --judged";
        let parsed = Cli::try_parse_from(flags.split_whitespace()).expect("these flags exist");
        let laid =
            toml::Table::try_from(parsed.run.settings.over(Config::default())).expect("plain data");
        let file = toml::Table::try_from(Config::default()).expect("plain data");
        for (name, value) in &file {
            assert!(laid[name] != *value, "{name} has no flag");
        }
    }
}
