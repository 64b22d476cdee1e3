//! The terrain that a run stands on, and the copy of it that the run keeps.
//!
//! The result of a run depends on what its creatures stand on, so its configuration holds the digest of the terrain,
//! and its folder the grid of heights that it came to, whatever file it was read from.

use crate::formats::terrain::{self, BYTES_MAX, Sizing};
use crate::runs::Failure;
use crate::simulation::Terrain;
use crate::store::{RunDir, file};
use serde::{Deserialize, Serialize};
use std::fmt::Display;
use std::path::Path;
use std::sync::Arc;

/// What a configuration says of the terrain of its run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct KeptTerrain {
    /// The BLAKE3 hash of the copy in the run's folder.
    pub digest: String,
    /// The terrain, once the copy was read.
    #[serde(skip)]
    pub terrain: Option<Arc<Terrain>>,
}

impl KeptTerrain {
    /// That of a terrain.
    pub fn of(terrain: Terrain) -> Self {
        let digest = blake3::hash(&copy(&terrain)).to_string();
        Self { digest, terrain: Some(Arc::new(terrain)) }
    }

    fn read(&mut self, dir: &RunDir) -> Result<(), Failure> {
        let path = dir.terrain();
        let bytes = file::read(&path, BYTES_MAX).map_err(|error| wrong(&path, &error.reason()))?;
        if blake3::hash(&bytes).to_string() != self.digest {
            let changed = "it is not what run.toml says of it; the run's creatures stand on it";
            return Err(wrong(&path, &changed));
        }
        let terrain = terrain::read(&bytes, &Sizing::default());
        self.terrain = Some(Arc::new(terrain.map_err(|error| wrong(&path, &error))?));
        Ok(())
    }

    /// Requires that the copy was read: a configuration alone does not say what creatures stand on.
    ///
    /// # Errors
    /// If it was not.
    pub fn check(&self) -> Result<(), Failure> {
        let lost =
            "the configuration says that there is a terrain, but not which: name it with --terrain";
        self.terrain.as_ref().map(|_| ()).ok_or_else(|| Failure::usage(lost))
    }
}

/// Reads the terrain that a run's folder keeps, if the configuration says that there is one.
///
/// # Errors
/// If it is not there, or not what the configuration says.
pub fn read(said: &mut Option<KeptTerrain>, dir: &RunDir) -> Result<(), Failure> {
    said.as_mut().map_or(Ok(()), |terrain| terrain.read(dir))
}

/// Writes the copy into the folder of a run that has a terrain of its own.
///
/// # Errors
/// If the disk is full or gone.
pub fn keep(dir: &RunDir, said: Option<&KeptTerrain>) -> Result<(), Failure> {
    let Some(terrain) = said.and_then(|it| it.terrain.as_deref()) else { return Ok(()) };
    Ok(dir.write(&dir.terrain(), |out| out.write_all(&copy(terrain)))?)
}

fn copy(terrain: &Terrain) -> Vec<u8> {
    let mut copy = Vec::new();
    terrain::write(terrain, &mut copy).expect("memory takes everything");
    copy
}

/// The failure to use a file as a terrain.
pub fn wrong(path: &Path, reason: &dyn Display) -> Failure {
    Failure::usage(format!("cannot use {} as a terrain: {reason}", path.display()))
}
