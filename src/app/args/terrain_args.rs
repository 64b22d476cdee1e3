//! The flags that name a terrain.

use crate::formats::terrain::{self, BYTES_MAX, Sizing};
use crate::runs::Failure;
use crate::runs::config::Config;
use crate::runs::terrains::{self, KeptTerrain, wrong};
use crate::simulation::Terrain;
use crate::store::{RunDir, file};
use clap::Args;
use std::path::{Path, PathBuf};

/// What creatures stand on.
#[derive(Debug, Clone, Default, Args)]
pub struct TerrainArgs {
    /// Terrain instead of the task's ground, with walls around it: a greyscale PNG (white is high, north is at the top),
    /// an OBJ mesh (z is up, in metres; the highest surface counts) or a run's terrain.csv
    #[arg(long, value_name = "FILE")]
    pub terrain: Option<PathBuf>,
    /// Size of the terrain from west to east, in metres [default: 20 for a PNG, a mesh's own]
    #[arg(long, value_name = "M", requires = "terrain")]
    pub terrain_size: Option<f64>,
    /// Height of the terrain from its lowest to its highest place, in metres; of a PNG, from black to white [default: 5
    /// for a PNG, a mesh's own]
    #[arg(long, value_name = "M", requires = "terrain")]
    pub terrain_height: Option<f64>,
    /// Place where creatures begin, in metres east and north of the terrain's middle [default: seven tenths of the way
    /// to the southern wall, or as in the terrain.csv]
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
    pub fn read(&self) -> Result<Option<Terrain>, Failure> {
        let Some(path) = &self.terrain else { return Ok(None) };
        let sizing = Sizing {
            width_m: self.terrain_size,
            height_m: self.terrain_height,
            start_m: self.terrain_start.map(|place| place.0),
        };
        let bytes = file::read(path, BYTES_MAX).map_err(|error| wrong(path, &error.reason()))?;
        let terrain = terrain::read(&bytes, &sizing).map_err(|error| wrong(path, &error))?;
        Ok(Some(terrain))
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
        (None, Some(file)) => {
            terrains::read(&mut config.terrain, &RunDir::at(file.with_file_name("")))?
        }
        (None, None) => {}
    }
    Ok(())
}
