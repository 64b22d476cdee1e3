//! What is wrong with a terrain's file.

use super::{BYTES_MAX, mesh};
use crate::simulation::terrain::{POINTS_MAX, TerrainError};

/// What is wrong with a terrain's file.
#[derive(Debug, thiserror::Error)]
pub enum TerrainFileError {
    /// It has too many bytes.
    #[error("it is larger than {BYTES_MAX} bytes")]
    Large,
    /// It is nothing that is known.
    #[error("it is neither a PNG image, an OBJ mesh nor a grid that a run kept")]
    Unknown,
    /// A size that the user wants is none.
    #[error("a size of {0} m is impossible: it must be a number above 0")]
    Size(f64),
    /// The image is broken.
    #[error("it is no sound PNG image: {0}")]
    Image(String),
    /// The image is not greyscale.
    #[error(
        "it has colours, transparency or few shades: save it as greyscale with 8 or 16 bits a pixel"
    )]
    Colours,
    /// The image is too large or too small.
    #[error("it has {0} × {1} pixels; there must be from 2 to {POINTS_MAX} each way: scale it")]
    Pixels(u32, u32),
    /// A line of the mesh makes no sense.
    #[error("line {line}: {reason}")]
    Line {
        /// The line, from 1.
        line: usize,
        /// What is wrong with it.
        reason: String,
    },
    /// There is no surface.
    #[error("it has no faces that can be stood on: triangles are needed, with z up")]
    NoFaces,
    /// It has too much of something.
    #[error("it has more than {most} {what}", most = mesh::ITEMS_MAX)]
    Many {
        /// What.
        what: &'static str,
    },
    /// Sampling it would take too long.
    #[error("its faces lie in too many layers over each other: take the upper surface alone")]
    Layers,
    /// The grid is damaged.
    #[error("line {0}: it is not as a run writes it")]
    Grid(usize),
    /// The grid has a size.
    #[error("a run's terrain has a size: leave out --terrain-size and --terrain-height")]
    Sized,
    /// It is no terrain.
    #[error(transparent)]
    Terrain(#[from] TerrainError),
}
