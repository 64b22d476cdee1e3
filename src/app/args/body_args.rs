//! What can be said about files of genomes and bodies.

use crate::app::args::settings::{OfBody, OfTrial, SettingArgs};
use crate::app::args::terrain_args::{self, TerrainArgs};
use crate::choice;
use crate::creature::encodings::course::Rescaling;
use crate::creature::{Profile, Scales};
use crate::runs::Failure;
use crate::runs::config::Config;
use clap::Args;
use std::path::PathBuf;

/// How the files of changed course programs are read.
#[derive(Debug, Clone, Default, Args)]
pub struct ChangeArgs {
    /// Changed scale of a parameter of profile coursework, such as link-length=1; may be repeated
    #[arg(long = "scale", value_name = "NAME=SCALE")]
    pub scales: Vec<Rescaling>,
    /// Number of a column to leave out, from 1, where lines have more columns than a gene; may be repeated
    #[arg(long = "drop-column", value_name = "N")]
    pub drop_columns: Vec<usize>,
}

impl ChangeArgs {
    /// The scales that are changed.
    pub fn scales(&self) -> Scales {
        self.scales.iter().cloned().collect()
    }
}

/// How a genome file is read and tried.
#[derive(Debug, Clone, Args)]
pub struct TrialArgs {
    #[command(flatten)]
    pub settings: SettingArgs<OfTrial>,
    #[command(flatten)]
    pub changes: ChangeArgs,
    #[command(flatten)]
    pub terrain: TerrainArgs,
}

impl TrialArgs {
    /// The configuration of a run whose creatures are tried so.
    ///
    /// # Errors
    /// If something is out of its range, the profile has no such scales, or the terrain cannot be used.
    pub fn config(&self) -> Result<Config, Failure> {
        let scales = self.changes.scales();
        let mut config = self.settings.over(Config { scales, ..Config::default() });
        terrain_args::find(&mut config, &self.terrain, None)?;
        config.check()?;
        Ok(config)
    }
}

/// Looking at a body.
#[derive(Debug, Args)]
#[command(
    after_help = "A URDF may be another program's, as long as it is made of boxes, cylinders, spheres and
capsules on fixed, revolute or continuous joints. The command names what it ignores.

Examples:
  islands inspect champion.csv                              link by link
  islands inspect elite_40.csv --profile coursework --json  a genome of the course, for programs
  islands inspect robot.urdf                                any body of simple solids"
)]
pub struct InspectArgs {
    /// File of the genome, the body or the network
    #[arg(value_name = "GENOME.csv|BODY.urdf|NETWORK.csv")]
    pub genome: PathBuf,
    #[command(flatten)]
    pub settings: SettingArgs<OfBody>,
    #[command(flatten)]
    pub changes: ChangeArgs,
    /// Print one JSON object
    #[arg(long)]
    pub json: bool,
    /// Print a drawing of a network, for Graphviz
    #[arg(long, conflicts_with = "json")]
    pub dot: bool,
}

/// Taking in genomes of the course.
#[derive(Debug, Args)]
#[command(
    after_help = "The command reads every file, and says at the end which ones it refused, and why. With --out it writes
the others as files that the course's program and all commands here can read, with the course's own
scales. Values of 1 and more become just under 1.

Exit codes: 0 all were read, 1 some were refused, 2 asked for something impossible.

Examples:
  islands import elites/ --out genomes                   every CSV below a folder
  islands import a.csv b.csv                             only look whether they can be read
  islands import elites/ --scale link-length=1 --scale link-recurrence=4 --out genomes
  islands import old/ --drop-column 6 --out genomes      files with an additional sixth column
  islands run --profile coursework --task course --seed-genomes genomes"
)]
pub struct ImportArgs {
    /// Files of genomes, and folders of them
    #[arg(required = true, value_name = "FILE.csv|DIR")]
    pub files: Vec<PathBuf>,
    /// How genes are read: native, lecture or coursework
    #[arg(long, default_value_t = Profile::Coursework)]
    pub profile: Profile,
    #[command(flatten)]
    pub changes: ChangeArgs,
    /// Folder for the files that could be read, new or empty
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Print the result as one JSON object, the last line of standard output
    #[arg(long)]
    pub json: bool,
}

/// Taking genomes and bodies elsewhere.
#[derive(Debug, Args)]
#[command(after_help = "Formats:
  csv     the genome, for the course's program; what it cannot build is refused with the reason
  urdf    the body, for ROS, PyBullet, Gazebo and others; read back here with all its motors
  mjcf    the body on a plane, for MuJoCo, with a velocity actuator for each motor; no terrain
  stl     the body at rest, for printing, with a closed surface for each link; in millimetres
  motion  how it moves in its trial, as CSV: time, link, position, rotation

Exit codes: 0 done, 1 failed, 2 asked for something impossible.

Examples:
  islands export runs/walk-seed7/champion.csv --format urdf --out walker.urdf
  islands export champion.csv --format mjcf --out walker.xml
  islands export champion.csv --format stl --size 0.1 --out walker.stl
  islands export mine.csv --profile coursework --scale link-length=1 --format csv --out elite.csv")]
pub struct ExportArgs {
    /// File of the genome or the body
    #[arg(value_name = "GENOME.csv|BODY.urdf")]
    pub genome: PathBuf,
    /// What to write: csv, urdf, mjcf, stl or motion
    #[arg(long)]
    pub format: Format,
    /// File to write; an existing one is replaced
    #[arg(long, value_name = "FILE")]
    pub out: PathBuf,
    #[command(flatten)]
    pub trial: TrialArgs,
    /// For stl: factor by which the body is scaled
    #[arg(long, default_value_t = 1.0, value_name = "TIMES")]
    pub size: f64,
    /// For stl: also write each link, standing, to a file of its own beside --out
    #[arg(long)]
    pub parts: bool,
}

/// A format to write.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::Display, strum::VariantArray)]
#[strum(serialize_all = "kebab-case")]
pub enum Format {
    /// The genome, for the course's program.
    Csv,
    /// The body, for other simulators.
    Urdf,
    /// The body, for MuJoCo.
    Mjcf,
    /// The body, for printing.
    Stl,
    /// How it moves in its trial.
    Motion,
}

choice::one_of!("format", Format);
