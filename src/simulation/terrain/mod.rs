//! What bodies stand on: a plane, or hills within walls.
//!
//! A terrain is a grid of heights. Each cell is two triangles, which meet along the diagonal from its south-west to
//! its north-east corner, and every engine sees the same ones. The walls around it stand at its edge.

mod mountain;
mod standing;
#[cfg(test)]
mod tests;

pub use mountain::mountain;

use super::rapier_shape::GroundShape;
use nalgebra::{Vector2, Vector3};
use std::fmt;
use std::sync::Arc;

/// The most points of a grid, along either side.
pub const POINTS_MAX: usize = 1_025;
/// The smallest and the greatest distance between points, in metres.
pub const STEP_M: [f64; 2] = [0.01, 100.0];
/// No point may be further above or below zero than this, in metres.
pub const HEIGHT_M_MAX: f64 = 1_000.0;
/// From no point to the next one along x or y may it be steeper than this: height for way. What is steeper is a wall,
/// and nothing stands on it.
pub const STEEPNESS_MAX: f64 = 20.0;
/// The height of the walls above the highest point of the edge, in metres.
pub const WALL_M: f64 = 1.0;

/// How many times as rough as a plane a terrain is: its coefficient of friction with a link is 1, as that of rubber on
/// rock. With the plane's ¼ nobody can so much as stand on what is steeper than 14°, and the mountain has 45°.
const ROUGHNESS: f64 = 4.0;

/// What a body stands on.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum Ground {
    /// A plane without an end, at height 0.
    #[default]
    Plane,
    /// A terrain, which all trials on it share.
    Terrain(Arc<Terrain>),
}

impl Ground {
    /// The height of the ground at a place, in metres.
    pub fn height_m(&self, x_m: f64, y_m: f64) -> f64 {
        match self {
            Ground::Plane => 0.0,
            Ground::Terrain(terrain) => terrain.height_m(x_m, y_m),
        }
    }

    /// Away from the ground at a place, of length 1.
    pub fn normal(&self, x_m: f64, y_m: f64) -> Vector3<f64> {
        match self {
            Ground::Plane => Vector3::z(),
            Ground::Terrain(terrain) => terrain.facet(x_m, y_m).normal,
        }
    }

    /// How rough it is, in multiples of a plane's friction.
    pub fn roughness(&self) -> f64 {
        match self {
            Ground::Plane => 1.0,
            Ground::Terrain(_) => ROUGHNESS,
        }
    }

    /// Whether a place is on it, rather than beyond its walls.
    pub fn holds(&self, x_m: f64, y_m: f64) -> bool {
        self.terrain().is_none_or(|terrain| terrain.holds(x_m, y_m))
    }

    /// The terrain, if it is one.
    pub fn terrain(&self) -> Option<&Terrain> {
        match self {
            Ground::Plane => None,
            Ground::Terrain(terrain) => Some(terrain),
        }
    }
}

/// A grid of heights, its middle at the origin, with walls around.
#[derive(Clone, PartialEq)]
pub struct Terrain {
    columns: usize,
    rows: usize,
    step_m: f64,
    /// Row by row from the south, each from the west.
    heights_m: Vec<f64>,
    start_m: [f64; 2],
    wall_top_m: f64,
    /// The same, as rapier has it.
    pub(super) shape: GroundShape,
}

/// What makes a grid no terrain.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum TerrainError {
    /// It is too small or too large.
    #[error("it has {0} × {1} points; there must be from 2 to {POINTS_MAX} each way")]
    Points(usize, usize),
    /// Points are too near or too far.
    #[error("its points would be {0} m apart; that must be from {low} to {high} m", low = STEP_M[0], high = STEP_M[1])]
    Step(f64),
    /// A height is no number, or too great.
    #[error("a height is {0} m; it must be a number from -{HEIGHT_M_MAX} to {HEIGHT_M_MAX}")]
    Height(f64),
    /// There is a cliff from one point to the next.
    #[error(
        "it rises by {rise_m} m from one point to the next, {step_m} m on: nothing stands on what is steeper than \
         {STEEPNESS_MAX} : 1; make it wider or lower"
    )]
    Cliff {
        /// By so much, in metres.
        rise_m: f64,
        /// Within so much, in metres.
        step_m: f64,
    },
    /// Nobody can begin there.
    #[error("a body cannot begin at ({0} m, {1} m), which is not on it")]
    Start(f64, f64),
}

/// The ground at a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Facet {
    /// Its height, in metres.
    pub height_m: f64,
    /// Away from it, of length 1.
    pub normal: Vector3<f64>,
}

impl Terrain {
    /// A terrain of so many points along x and y, a step apart, with their heights row by row from the south. Bodies
    /// begin at `start_m`.
    ///
    /// # Errors
    /// If nothing could stand on it.
    pub fn new(
        [columns, rows]: [usize; 2],
        step_m: f64,
        mut heights_m: Vec<f64>,
        start_m: [f64; 2],
    ) -> Result<Self, TerrainError> {
        let fits = |points| (2..=POINTS_MAX).contains(&points);
        if !(fits(columns) && fits(rows)) || heights_m.len() != columns * rows {
            return Err(TerrainError::Points(columns, rows));
        }
        if !(STEP_M[0]..=STEP_M[1]).contains(&step_m) {
            return Err(TerrainError::Step(step_m));
        }
        for height_m in &mut heights_m {
            // What rapier sees, in single precision, is what there is. Adding zero turns -0.0 into 0.0.
            *height_m = f64::from(*height_m as f32) + 0.0;
            if !(-HEIGHT_M_MAX..=HEIGHT_M_MAX).contains(height_m) {
                return Err(TerrainError::Height(*height_m));
            }
        }
        let shape = GroundShape::default();
        let mut terrain =
            Self { columns, rows, step_m, heights_m, start_m, wall_top_m: 0.0, shape };
        terrain.check_cliffs()?;
        if !terrain.holds(start_m[0], start_m[1]) {
            return Err(TerrainError::Start(start_m[0], start_m[1]));
        }
        terrain.wall_top_m = terrain.edge_m() + WALL_M;
        Ok(terrain)
    }

    /// Where a body begins if nothing else is said: as far south of the middle as the foot of [`mountain`] is.
    pub fn usual_start_m([_, rows]: [usize; 2], step_m: f64) -> [f64; 2] {
        [0.0, -0.35 * (rows.saturating_sub(1)) as f64 * step_m]
    }

    fn check_cliffs(&self) -> Result<(), TerrainError> {
        let most_m = STEEPNESS_MAX * self.step_m;
        let rise_m = |(column, row), (c, r)| self.point_m(c, r) - self.point_m(column, row);
        for (column, row) in (0..self.rows).flat_map(|r| (0..self.columns).map(move |c| (c, r))) {
            let east = (column + 1 < self.columns).then_some((column + 1, row));
            let north = (row + 1 < self.rows).then_some((column, row + 1));
            let rises = east.into_iter().chain(north).map(|next| rise_m((column, row), next).abs());
            if let Some(rise_m) = rises.into_iter().find(|rise_m| *rise_m > most_m) {
                return Err(TerrainError::Cliff { rise_m, step_m: self.step_m });
            }
        }
        Ok(())
    }

    /// The highest point of its edge.
    fn edge_m(&self) -> f64 {
        let is_edge = |i: usize| {
            let (column, row) = (i % self.columns, i / self.columns);
            column == 0 || row == 0 || column + 1 == self.columns || row + 1 == self.rows
        };
        let edge = self.heights_m.iter().enumerate().filter(|(i, _)| is_edge(*i));
        edge.fold(f64::NEG_INFINITY, |most, (_, height_m)| most.max(*height_m))
    }

    /// The points along x and y.
    pub fn points(&self) -> [usize; 2] {
        [self.columns, self.rows]
    }

    /// How far they are apart, in metres.
    pub fn step_m(&self) -> f64 {
        self.step_m
    }

    /// All heights, row by row from the south, each from the west, in metres.
    pub fn heights_m(&self) -> &[f64] {
        &self.heights_m
    }

    /// Where a body begins, in metres.
    pub fn start_m(&self) -> [f64; 2] {
        self.start_m
    }

    /// Half of its size along x and y, in metres: its walls stand there.
    pub fn half_m(&self) -> Vector2<f64> {
        Vector2::new((self.columns - 1) as f64, (self.rows - 1) as f64) * (0.5 * self.step_m)
    }

    /// The height of its walls' tops, in metres.
    pub fn wall_top_m(&self) -> f64 {
        self.wall_top_m
    }

    /// Whether a place is within its walls.
    pub fn holds(&self, x_m: f64, y_m: f64) -> bool {
        let half_m = self.half_m();
        x_m.abs() <= half_m.x && y_m.abs() <= half_m.y
    }

    /// The place of a point of the grid, and its height, in metres.
    pub fn place_m(&self, column: usize, row: usize) -> Vector3<f64> {
        let half_m = self.half_m();
        let [x_m, y_m] = [column, row].map(|i| i as f64 * self.step_m);
        Vector3::new(x_m - half_m.x, y_m - half_m.y, self.point_m(column, row))
    }

    /// The height at a place, in metres; beyond the edge that of the nearest place within.
    pub fn height_m(&self, x_m: f64, y_m: f64) -> f64 {
        self.facet(x_m, y_m).height_m
    }

    /// The ground at a place; beyond the edge that of the nearest place within.
    pub fn facet(&self, x_m: f64, y_m: f64) -> Facet {
        let half_m = self.half_m();
        let (column, u) = cell((x_m + half_m.x) / self.step_m, self.columns);
        let (row, v) = cell((y_m + half_m.y) / self.step_m, self.rows);
        let south_west = self.point_m(column, row);
        let north_east = self.point_m(column + 1, row + 1);
        let [along_x, along_y] = if u >= v {
            let south_east = self.point_m(column + 1, row);
            [south_east - south_west, north_east - south_east]
        } else {
            let north_west = self.point_m(column, row + 1);
            [north_east - north_west, north_west - south_west]
        };
        Facet {
            height_m: south_west + u * along_x + v * along_y,
            normal: Vector3::new(-along_x, -along_y, self.step_m).normalize(),
        }
    }

    /// The highest point of the ground within a box, or just beside it, in metres.
    pub fn highest_m(&self, low_m: Vector2<f64>, high_m: Vector2<f64>) -> f64 {
        let half_m = self.half_m();
        let range = |low_m: f64, high_m: f64, half_m: f64, points: usize| {
            let [(first, _), (last, _)] =
                [low_m, high_m].map(|at_m| cell((at_m + half_m) / self.step_m, points));
            first..last + 2
        };
        let columns = range(low_m.x, high_m.x, half_m.x, self.columns);
        range(low_m.y, high_m.y, half_m.y, self.rows)
            .flat_map(|row| &self.heights_m[row * self.columns..][columns.clone()])
            .fold(f64::NEG_INFINITY, |most, height_m| most.max(*height_m))
    }

    fn point_m(&self, column: usize, row: usize) -> f64 {
        self.heights_m[row * self.columns + column]
    }
}

impl fmt::Debug for Terrain {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { columns, rows, step_m, .. } = self;
        write!(f, "Terrain({columns} × {rows}, {step_m} m)")
    }
}

/// The cell of a place that is measured in cells, and where in it: from 0 to 1.
fn cell(at: f64, points: usize) -> (usize, f64) {
    let at = at.clamp(0.0, (points - 1) as f64);
    let index = (at as usize).min(points - 2);
    (index, at - index as f64)
}
