//! The command line.

use crate::app::args::body_args::ChangeArgs;
pub use crate::app::args::body_args::{ExportArgs, Format, ImportArgs, InspectArgs};
use crate::app::args::settings::{OfReplay, OfWorth, SettingArgs};
use crate::app::args::terrain_args::TerrainArgs;
pub use crate::app::commands::experiment::ExperimentArgs;
use crate::choice;
use crate::runs::config::SETTINGS;
use clap::{Args, CommandFactory, FromArgMatches, Parser, Subcommand};
use std::net::{IpAddr, Ipv4Addr};
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
  islands run --problem rastrigin --dimensions 10   four islands look for the lowest point
  islands resume runs/walk-seed7     goes on after Ctrl-C, a crash or a reboot, to the same result
  islands evaluate champion.csv      how far does this creature get?
  islands replay runs/walk-seed7 --ancestry --view spawn
  islands --task climb               up the course's mountain; --terrain FILE climbs another one
  islands export champion.csv --format urdf --out walker.urdf
  islands import elites/ --out genomes && islands run --profile coursework --seed-genomes genomes"
)]
pub struct Cli {
    #[command(subcommand)]
    pub command: Option<Command>,
    #[command(flatten)]
    pub run: RunArgs,
}

/// Reads the command line; where it makes no sense the program ends with a sentence.
pub fn parse() -> Cli {
    let matches = command().get_matches();
    Cli::from_arg_matches(&matches).unwrap_or_else(|error| error.exit())
}

// All settings can be said to a run that goes on, so that it can say which one it cannot change. Its help names
// those that it can.
fn command() -> clap::Command {
    Cli::command().mut_subcommand("resume", |resume| {
        SETTINGS.iter().fold(resume, |resume, setting| {
            resume.mut_arg(&setting.name, |arg| match setting.about.is_free {
                true => arg.help(format!("{} [default: as in the run]", setting.help)),
                false => arg.hide(true),
            })
        })
    })
}

/// What to do; without a word, `run`.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Evolve creatures on several islands
    Run(Box<RunArgs>),
    /// Go on with a run that was interrupted or crashed, or make a finished one longer
    Resume(Box<ResumeArgs>),
    /// Compare settings: a grid of them times seeds, with statistics and a plot
    Experiment(ExperimentArgs),
    /// Score genomes, and bodies from URDF
    Evaluate(EvaluateArgs),
    /// Show the body or the network that a file describes
    Inspect(InspectArgs),
    /// Film genomes, bodies from URDF, or the creatures of a run, for the Rerun viewer
    Replay(ReplayArgs),
    /// Read genome files of the course, also odd ones, and write them in one form
    Import(ImportArgs),
    /// Write a creature for other programs: as the course's CSV, URDF, MJCF, STL or motion
    Export(ExportArgs),
    /// Film a run, under way or over, and serve its live view; `run` starts a monitor by itself
    Monitor(MonitorArgs),
    /// Check that a run's folder holds what it claims, by simulating its champions again
    Verify(VerifyArgs),
    /// Remove what crashed runs left in shared memory and the temporary folder; runs under way are not touched
    Clean(CleanArgs),
    /// One island of a run; `run` starts them
    #[command(hide = true)]
    Island(IslandArgs),
}

/// A run. What is not said has a default, or is as a file says.
#[derive(Debug, Args)]
pub struct RunArgs {
    #[command(flatten)]
    pub settings: SettingArgs,
    /// Genomes to begin with: files, folders or patterns such as 'elites/*.csv'. Every island begins with as many
    /// of them as it has room for, the rest is random. The run keeps a copy
    #[arg(long, value_name = "GLOB", num_args = 1.., help_heading = "Genetic algorithm")]
    pub seed_genomes: Vec<PathBuf>,
    #[command(flatten, next_help_heading = "Genetic algorithm")]
    pub changes: ChangeArgs,
    #[command(flatten, next_help_heading = "Terrain")]
    pub terrain: TerrainArgs,
    /// File of settings, such as a run's run.toml; flags win over it
    #[arg(long, value_name = "FILE.toml", help_heading = "Running")]
    pub config: Option<PathBuf>,
    /// Folder for the run's files, new or empty [default: runs/<task or problem>-seed<seed>]
    #[arg(long, value_name = "DIR", help_heading = "Running")]
    pub out: Option<PathBuf>,
    #[command(flatten)]
    pub output: OutputArgs,
}

/// Going on.
#[derive(Debug, Args)]
#[command(
    after_help = "The result is the one that the run would have had undisturbed. What would change it, such as
another seed, is refused. A finished run that is not made longer prints its result again.

Exit codes: 0 done, 1 failed, 2 there is no run, it is under way or cannot go on so, 130 interrupted.

Examples:
  islands resume runs/walk-seed7                     goes on, to the same digest
  islands resume runs/walk-seed7 --generations 200   a finished run, made longer"
)]
pub struct ResumeArgs {
    /// Folder of a run that was interrupted, crashed or has finished
    #[arg(value_name = "RUN_DIR")]
    pub dir: PathBuf,
    #[command(flatten)]
    pub settings: SettingArgs,
    #[command(flatten)]
    pub output: OutputArgs,
}

/// What a run shows.
#[derive(Debug, Args)]
pub struct OutputArgs {
    /// Start no monitor, which films the run and serves the live view; all other files are written
    #[arg(long, help_heading = "Running")]
    pub no_monitor: bool,
    #[command(flatten)]
    pub view: ViewArgs,
    /// Show no progress
    #[arg(long, help_heading = "Running")]
    pub quiet: bool,
    /// Print the result as one JSON object, the last line of standard output
    #[arg(long, help_heading = "Running")]
    pub json: bool,
}

impl OutputArgs {
    /// Whether a monitor films the run.
    pub fn films(&self) -> bool {
        cfg!(feature = "view") && !self.no_monitor
    }
}

/// How a run is watched while it goes on.
#[derive(Debug, Clone, Copy, Args)]
pub struct ViewArgs {
    /// Live view: live (viewers can connect), spawn (the same, and a viewer opens) or off (the run is only recorded)
    #[arg(long, value_name = "HOW", default_value_t, help_heading = "Running")]
    pub view: Watching,
    /// Port of the live view, or one of the next if it is taken [default: 9876]
    #[arg(long, value_name = "PORT", value_parser = clap::value_parser!(u16).range(1..), help_heading = "Running")]
    pub view_port: Option<u16>,
    /// Address of the live view. Who can reach it can watch without a password, and change what others see: on any
    /// address but 127.0.0.1 that may be many people
    #[arg(long, value_name = "IP", default_value_t = Ipv4Addr::LOCALHOST.into(), help_heading = "Running")]
    pub view_address: IpAddr,
}

/// Who can watch.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, strum::Display, strum::VariantArray)]
#[strum(serialize_all = "kebab-case")]
pub enum Watching {
    /// Whoever attaches a viewer.
    #[default]
    Live,
    /// The same, and a viewer is opened.
    Spawn,
    /// Nobody.
    Off,
}

choice::one_of!("view", Watching);

/// Scoring.
#[derive(Debug, Args)]
pub struct EvaluateArgs {
    /// Files of genomes, with a gene on each line (of a creature 17 numbers from 0 to 1), or of bodies
    #[arg(required = true, value_name = "GENOME.csv|BODY.urdf")]
    pub genomes: Vec<PathBuf>,
    #[command(flatten)]
    pub settings: SettingArgs<OfWorth>,
    #[command(flatten)]
    pub changes: ChangeArgs,
    #[command(flatten)]
    pub terrain: TerrainArgs,
    /// Number of perturbations to try every creature in, none of which a run selects on; both engines try it, and the
    /// command prints mean, spread and worst
    #[arg(long, value_name = "N")]
    pub trials: Option<u32>,
    /// Threads [default: all cores]
    #[arg(long, value_name = "K")]
    pub threads: Option<usize>,
    /// Number of times that everything is evaluated, to measure speed
    #[arg(long, default_value_t = 1, value_name = "R")]
    pub repeat: usize,
    /// Print the result as one JSON object, the last line of standard output
    #[arg(long)]
    pub json: bool,
}

/// Filming.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  islands replay champion.csv --view spawn          one creature, in a viewer
  islands replay a.csv b.csv c.urdf --out race.rrd  three of them race
  islands replay runs/walk-seed7                    a run's champions through the generations
  islands replay runs/walk-seed7 --ancestry         the ancestors of its best creature")]
pub struct ReplayArgs {
    /// Files of genomes or bodies, several of which race, or the folder of a run
    #[arg(required = true, value_name = "GENOME.csv|BODY.urdf|RUN_DIR")]
    pub what: Vec<PathBuf>,
    /// Film the ancestors of a run's best creature instead of its champions
    #[arg(long)]
    pub ancestry: bool,
    /// Number of creatures of a run to film, picked evenly from the first to the last
    #[arg(long, default_value_t = 12, value_name = "C", value_parser = clap::value_parser!(u32).range(2..=64))]
    pub clips: u32,
    /// Trial duration in seconds [default: the task's]
    #[arg(long, value_name = "S")]
    pub seconds: Option<f64>,
    /// Recording to write [default: beside the file, or in the run's folder]
    #[arg(long, value_name = "FILE.rrd")]
    pub out: Option<PathBuf>,
    /// Whether a viewer opens: spawn or off
    #[arg(long, value_name = "HOW", default_value = "off")]
    pub view: Watching,
    #[command(flatten)]
    pub settings: SettingArgs<OfReplay>,
    #[command(flatten)]
    pub changes: ChangeArgs,
    #[command(flatten)]
    pub terrain: TerrainArgs,
}

/// Watching.
#[derive(Debug, Args)]
pub struct MonitorArgs {
    /// Folder of a run, under way or over
    #[arg(value_name = "RUN_DIR")]
    pub dir: PathBuf,
    #[command(flatten)]
    pub view: ViewArgs,
    /// Generations between two clips of an island's champion [default: as in the run]
    #[arg(long, value_name = "G", value_parser = clap::value_parser!(u32).range(1..))]
    pub clip_every: Option<u32>,
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
    /// Simulate also the newest populations and all migrants again, and evolve a run of --exchange async again from
    /// what its islands recorded, to the same digest
    #[arg(long)]
    pub thorough: bool,
    /// Threads [default: all cores]
    #[arg(long, value_name = "K")]
    pub threads: Option<usize>,
    /// Print the result as one JSON object, the last line of standard output
    #[arg(long)]
    pub json: bool,
}

/// Cleaning.
#[derive(Debug, Args)]
pub struct CleanArgs {
    /// Only list what would be removed
    #[arg(long)]
    pub dry_run: bool,
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
    use crate::runs::config::Config;

    #[test]
    fn the_help_of_resume_names_no_default_of_a_new_run() {
        let command = command();
        let resume = command.find_subcommand("resume").expect("there is one");
        for setting in SETTINGS.iter() {
            let is_it = |arg: &&clap::Arg| arg.get_id() == setting.name.as_str();
            let arg = resume.get_arguments().find(is_it).expect("it is refused by name");
            let help = arg.get_help().expect("it has one").to_string();
            assert_eq!(help.ends_with("[default: as in the run]"), setting.about.is_free, "{help}");
            assert_eq!(arg.is_hide_set(), !setting.about.is_free, "{help}");
        }
    }

    #[test]
    fn the_help_names_the_defaults_that_hold() {
        command().debug_assert();
        let config = toml::Table::try_from(Config::default()).expect("it is plain data");
        for arg in Cli::command().get_arguments() {
            let name = arg.get_id().as_str();
            let help = arg.get_help().map(ToString::to_string).unwrap_or_default();
            let Some(value) = config.get(name) else { continue };
            let value = value.as_str().map_or_else(|| value.to_string(), str::to_owned);
            assert!(help.contains(&format!("[default: {value}]")), "{name} is {value}: {help}");
        }
    }
}
