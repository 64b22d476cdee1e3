//! Terrains that the user names, and the copy that a run keeps.
//!
//! The result of a run depends on what its creatures stand on, so its configuration holds the digest of the terrain,
//! and its folder the grid of heights that it came to, whatever file it was read from.

use super::Failure;
use super::config::Config;
use crate::formats::terrain::{self, BYTES_MAX, Sizing};
use crate::simulation::Terrain;
use crate::store::{RunDir, file};
use clap::Args;
use serde::{Deserialize, Serialize};
use std::fmt::Display;
use std::path::{Path, PathBuf};

/// What creatures stand on.
#[derive(Debug, Clone, Default, Args)]
pub struct TerrainArgs {
    /// What creatures stand on instead, walls around it: a greyscale PNG (a pixel a point, white is high, north at the
    /// top), an OBJ mesh (z up, metres; its highest surface counts) or a run's terrain.csv. With any task
    #[arg(long, value_name = "FILE")]
    pub terrain: Option<PathBuf>,
    /// The terrain's size from west to east, in metres [default: 20 of a PNG, a mesh's own]
    #[arg(long, value_name = "M", requires = "terrain")]
    pub terrain_size: Option<f64>,
    /// How much higher its highest place is than its lowest, in metres; of a PNG, white than black [default: 5 of a
    /// PNG, a mesh's own]
    #[arg(long, value_name = "M", requires = "terrain")]
    pub terrain_height: Option<f64>,
    /// Where on it creatures begin, in metres east and north of its middle [default: seven tenths of the way to the
    /// southern wall, or as in the terrain.csv]
    #[arg(long, value_name = "X,Y", requires = "terrain", allow_hyphen_values = true)]
    pub terrain_start: Option<Place>,
}

/// A place on a terrain, in metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place([f64; 2]);

impl std::str::FromStr for Place {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let number = |text: &str| text.trim().parse::<f64>().ok().filter(|it| it.is_finite());
        let both = text.split_once(',').and_then(|(x, y)| Some([number(x)?, number(y)?]));
        both.map(Self).ok_or_else(|| "a place is two numbers, such as 0,-8".to_owned())
    }
}

impl TerrainArgs {
    /// The terrain that is named, if one is.
    ///
    /// # Errors
    /// One sentence that names the file and what is wrong.
    pub fn read(&self) -> Result<Option<&'static Terrain>, Failure> {
        let Some(path) = &self.terrain else { return Ok(None) };
        let sizing = Sizing {
            width_m: self.terrain_size,
            height_m: self.terrain_height,
            start_m: self.terrain_start.map(|place| place.0),
        };
        let bytes = file::read(path, BYTES_MAX).map_err(|error| wrong(path, &error.reason()))?;
        let terrain = terrain::read(&bytes, &sizing).map_err(|error| wrong(path, &error))?;
        Ok(Some(terrain.keep()))
    }
}

/// What a configuration says of the terrain of its run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct KeptTerrain {
    /// The BLAKE3 hash of the copy in the run's folder.
    pub digest: String,
    /// The terrain, once the copy was read.
    #[serde(skip)]
    pub terrain: Option<&'static Terrain>,
}

impl KeptTerrain {
    fn of(terrain: &'static Terrain) -> Self {
        let digest = blake3::hash(&copy(terrain)).to_string();
        Self { digest, terrain: Some(terrain) }
    }

    fn read(&mut self, dir: &RunDir) -> Result<(), Failure> {
        let path = dir.terrain();
        let bytes = file::read(&path, BYTES_MAX).map_err(|error| wrong(&path, &error.reason()))?;
        if blake3::hash(&bytes).to_string() != self.digest {
            let changed = "it is not what run.toml says of it; the run's creatures stand on it";
            return Err(wrong(&path, &changed));
        }
        let terrain = terrain::read(&bytes, &Sizing::default());
        self.terrain = Some(terrain.map_err(|error| wrong(&path, &error))?.keep());
        Ok(())
    }

    /// Requires that the copy was read: a configuration alone does not say what creatures stand on.
    ///
    /// # Errors
    /// If it was not.
    pub fn check(&self) -> Result<(), Failure> {
        let lost =
            "the configuration says that there is a terrain, but not which: name it with --terrain";
        self.terrain.map(|_| ()).ok_or_else(|| Failure::usage(lost))
    }
}

/// Finds the terrain of a run, and sets in its configuration what it has to say of it: the one that is named or, if
/// none is, that of the run whose configuration was read.
///
/// # Errors
/// If it cannot be read.
pub fn find(
    config: &mut Config,
    args: &TerrainArgs,
    read_from: Option<&Path>,
) -> Result<(), Failure> {
    match (args.read()?, read_from) {
        (Some(terrain), _) => config.terrain = Some(KeptTerrain::of(terrain)),
        (None, Some(file)) => read(config, &RunDir::at(file.with_file_name("")))?,
        (None, None) => {}
    }
    Ok(())
}

/// Reads the terrain that a run's folder keeps, if the configuration says that there is one.
///
/// # Errors
/// If it is not there, or not what the configuration says.
pub fn read(config: &mut Config, dir: &RunDir) -> Result<(), Failure> {
    config.terrain.as_mut().map_or(Ok(()), |terrain| terrain.read(dir))
}

/// Writes the copy into the folder of a run that has a terrain of its own.
///
/// # Errors
/// If the disk is full or gone.
pub fn keep(dir: &RunDir, config: &Config) -> Result<(), Failure> {
    let Some(terrain) = config.terrain.as_ref().and_then(|it| it.terrain) else { return Ok(()) };
    Ok(dir.write(&dir.terrain(), |out| out.write_all(&copy(terrain)))?)
}

fn copy(terrain: &Terrain) -> Vec<u8> {
    let mut copy = Vec::new();
    terrain::write(terrain, &mut copy).expect("memory takes everything");
    copy
}

fn wrong(path: &Path, reason: &dyn Display) -> Failure {
    Failure::usage(format!("cannot use {} as a terrain: {reason}", path.display()))
}
