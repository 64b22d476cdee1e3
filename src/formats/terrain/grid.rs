//! Grids of heights, as runs keep them: a line that says what it is, and a line a row, from the south.

use super::{Grid, Sizing, TerrainFileError};
use crate::simulation::Terrain;
use crate::simulation::terrain::POINTS_MAX;
use std::io::{self, Write};

/// What the first line begins with; then points along x and y, their distance and where bodies begin, in metres.
const HEADER: &str = "islands-terrain-1,";

/// Whether a file is a grid.
pub fn is_one(text: &str) -> bool {
    text.starts_with(HEADER)
}

/// Writes a terrain so that reading it gives the same one, to the last bit.
///
/// # Errors
/// If it cannot be written.
pub fn write(terrain: &Terrain, out: &mut dyn Write) -> io::Result<()> {
    let ([columns, rows], step_m, [x_m, y_m]) =
        (terrain.points(), terrain.step_m(), terrain.start_m());
    writeln!(out, "{HEADER}{columns},{rows},{step_m},{x_m},{y_m}")?;
    for row in terrain.heights_m().chunks(columns) {
        // Heights are numbers of single precision.
        let heights: Vec<String> = row.iter().map(|height| (*height as f32).to_string()).collect();
        writeln!(out, "{}", heights.join(","))?;
    }
    Ok(())
}

/// Reads what [`write`] writes.
pub fn read(text: &str, sizing: &Sizing) -> Result<Terrain, TerrainFileError> {
    if sizing.width_m.is_some() || sizing.height_m.is_some() {
        return Err(TerrainFileError::Sized);
    }
    let mut lines = (1..).zip(text.lines());
    let header = lines.next().and_then(|(_, line)| line.strip_prefix(HEADER)).and_then(header);
    let ([columns, rows], [step_m, x_m, y_m]) = header.ok_or(TerrainFileError::Grid(1))?;
    let mut heights_m = Vec::new();
    for _ in 0..rows {
        let (number, line) = lines.next().ok_or(TerrainFileError::Grid(rows + 1))?;
        let before = heights_m.len();
        for height_m in line.split(',').take(columns + 1) {
            let height_m: f32 = height_m.parse().map_err(|_| TerrainFileError::Grid(number))?;
            heights_m.push(f64::from(height_m));
        }
        if heights_m.len() - before != columns {
            return Err(TerrainFileError::Grid(number));
        }
    }
    if lines.next().is_some() {
        return Err(TerrainFileError::Grid(rows + 2));
    }
    let start_m = sizing.start_m.unwrap_or([x_m, y_m]);
    let sizing = Sizing { start_m: Some(start_m), ..*sizing };
    Grid { points: [columns, rows], step_m, heights_m }.terrain(&sizing)
}

fn header(text: &str) -> Option<([usize; 2], [f64; 3])> {
    let mut words = text.split(',');
    let mut points = [0_usize; 2];
    for count in &mut points {
        *count = words.next()?.parse().ok().filter(|count| (2..=POINTS_MAX).contains(count))?;
    }
    let mut lengths_m = [0.0; 3];
    for length_m in &mut lengths_m {
        *length_m = words.next()?.parse().ok()?;
    }
    words.next().is_none().then_some((points, lengths_m))
}
