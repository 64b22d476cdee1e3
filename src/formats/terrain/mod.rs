//! Terrains from files: greyscale images, meshes, and the grids of heights that runs keep.
//!
//! Whatever a file holds, reading it takes bounded time and memory, and what is wrong with it is a sentence.

mod error;
mod grid;
mod image;
mod mesh;
#[cfg(test)]
mod tests;

pub use error::TerrainFileError;
pub use grid::write;

use crate::simulation::Terrain;

/// The largest file, in bytes.
pub const BYTES_MAX: usize = 64 << 20;

/// What a user says of a file that it does not say itself.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Sizing {
    /// Its size from west to east, in metres: 20 of an image, a mesh's own.
    pub width_m: Option<f64>,
    /// How much higher its highest place is than its lowest, in metres; of an image white than black, 5. A mesh's own.
    pub height_m: Option<f64>,
    /// Where bodies begin, in metres.
    pub start_m: Option<[f64; 2]>,
}

/// Reads a terrain: a PNG, an OBJ or what [`write`](fn@write) writes, by what is in it.
///
/// # Errors
/// What is wrong with it.
pub fn read(bytes: &[u8], sizing: &Sizing) -> Result<Terrain, TerrainFileError> {
    if bytes.len() > BYTES_MAX {
        return Err(TerrainFileError::Large);
    }
    for size_m in [sizing.width_m, sizing.height_m].into_iter().flatten() {
        if !(size_m > 0.0 && size_m.is_finite()) {
            return Err(TerrainFileError::Size(size_m));
        }
    }
    if image::is_one(bytes) {
        return image::read(bytes, sizing);
    }
    let text = str::from_utf8(bytes).map_err(|_| TerrainFileError::Unknown)?;
    if grid::is_one(text) { grid::read(text, sizing) } else { mesh::read(text, sizing) }
}

/// A grid as it was read, its rows from the south.
struct Grid {
    points: [usize; 2],
    step_m: f64,
    heights_m: Vec<f64>,
}

impl Grid {
    fn terrain(self, sizing: &Sizing) -> Result<Terrain, TerrainFileError> {
        let Self { points, step_m, heights_m } = self;
        let start_m = sizing.start_m.unwrap_or_else(|| Terrain::usual_start_m(points, step_m));
        Ok(Terrain::new(points, step_m, heights_m, start_m)?)
    }
}
