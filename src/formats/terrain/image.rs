//! Greyscale images: a pixel a point, black at height 0, white highest, north at the top.

use super::{Grid, Sizing, TerrainFileError};
use crate::simulation::Terrain;
use crate::simulation::terrain::POINTS_MAX;
use png::{BitDepth, ColorType, Decoder, Limits, Transformations};
use std::io::Cursor;

/// What every PNG begins with.
const MAGIC: &[u8] = b"\x89PNG\r\n\x1a\n";
/// The width of an image if nothing is said, in metres.
const WIDTH_M: f64 = 20.0;
/// The height of white if nothing is said, in metres.
const HEIGHT_M: f64 = 5.0;
/// What a decoder may allocate, in bytes: several times the largest image.
const MEMORY_BYTES: usize = 16 << 20;

/// Whether a file is an image.
pub fn is_one(bytes: &[u8]) -> bool {
    bytes.starts_with(MAGIC)
}

/// Reads an image.
pub fn read(bytes: &[u8], sizing: &Sizing) -> Result<Terrain, TerrainFileError> {
    let (points, shades) = shades(bytes)?;
    let height_m = sizing.height_m.unwrap_or(HEIGHT_M);
    let north_to_south = shades.chunks(points[0]).rev();
    let heights_m = north_to_south.flatten().map(|shade| shade * height_m).collect();
    let step_m = sizing.width_m.unwrap_or(WIDTH_M) / (points[0] - 1) as f64;
    Grid { points, step_m, heights_m }.terrain(sizing)
}

/// The size of an image and its shades, from 0 to 1.
fn shades(bytes: &[u8]) -> Result<([usize; 2], Vec<f64>), TerrainFileError> {
    let broken = |error: png::DecodingError| TerrainFileError::Image(error.to_string());
    let limits = Limits { bytes: MEMORY_BYTES };
    let mut decoder = Decoder::new_with_limits(Cursor::new(bytes), limits);
    decoder.set_transformations(Transformations::IDENTITY);
    let header = decoder.read_header_info().map_err(broken)?;
    let (width, height) = (header.width, header.height);
    let points = [width, height].map(|pixels| pixels as usize);
    if !points.iter().all(|pixels| (2..=POINTS_MAX).contains(pixels)) {
        return Err(TerrainFileError::Pixels(width, height));
    }
    let sixteen = match (header.color_type, header.bit_depth) {
        (ColorType::Grayscale, BitDepth::Eight) => false,
        (ColorType::Grayscale, BitDepth::Sixteen) => true,
        _ => return Err(TerrainFileError::Colours),
    };
    let mut reader = decoder.read_info().map_err(broken)?;
    let mut pixels = vec![0; points[0] * points[1] * if sixteen { 2 } else { 1 }];
    reader.next_frame(&mut pixels).map_err(broken)?;
    let shades = match sixteen {
        true => pixels
            .chunks_exact(2)
            .map(|pair| f64::from(u16::from_be_bytes([pair[0], pair[1]])) / f64::from(u16::MAX))
            .collect(),
        false => pixels.iter().map(|&shade| f64::from(shade) / f64::from(u8::MAX)).collect(),
    };
    Ok((points, shades))
}
