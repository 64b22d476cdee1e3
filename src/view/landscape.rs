//! Terrains: hills coloured by height, fences where the walls are.

use super::palette;
use crate::simulation::Terrain;
use crate::simulation::terrain::WALL_M;
use nalgebra::{Vector3, vector};
use rerun::{Color, LineStrips3D, Mesh3D};

/// Tiles along the longer side, at most: a finer terrain is shown as every second point, every third, …
const TILES_MAX: usize = 128;
/// The colour of the highest place.
const SUMMIT: [u8; 3] = [236, 238, 242];
/// How much of that there is in it.
const SUMMIT_SHARE: f32 = 0.75;
/// Where the light comes from, of length 1.
const LIGHT: [f64; 3] = [-0.48, -0.36, 0.8];
/// How dark a place is that no light falls on.
const SHADE: f32 = 0.25;
/// Posts of fences are so far apart, in metres.
const POSTS_M: f64 = 2.0;

/// The ground, in tiles of the colours of an island.
pub fn ground(terrain: &Terrain, hue: u32) -> Mesh3D {
    let points = terrain.points();
    let every = (points[0].max(points[1]) - 1).div_ceil(TILES_MAX);
    let [columns, rows] = points.map(|points| corners(points, every));
    let paint = Paint::of(terrain, hue);
    let (mut positions, mut colors, mut triangles) = (Vec::new(), Vec::new(), Vec::new());
    for (row, ys) in rows.windows(2).enumerate() {
        for (column, xs) in columns.windows(2).enumerate() {
            let first = positions.len() as u32;
            let corners = [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(x, y)| (xs[x], ys[y]));
            let places_m = corners.map(|(column, row)| terrain.place_m(column, row));
            let light = light(&places_m);
            for place_m in places_m {
                positions.push(place_m.cast::<f32>().into());
                colors.push(paint.at(place_m.z, (row + column) & 1, light));
            }
            // Along the diagonal that the simulation has.
            triangles.push([first, first + 1, first + 2]);
            triangles.push([first, first + 2, first + 3]);
        }
    }
    let positions: Vec<[f32; 3]> = positions;
    // Without normals the viewer does not shade; the light is in the colours.
    Mesh3D::new(positions).with_vertex_colors(colors).with_triangle_indices(triangles)
}

/// Every so many points, and the last one.
fn corners(points: usize, every: usize) -> Vec<usize> {
    (0..points - 1).step_by(every).chain([points - 1]).collect()
}

/// How much light falls on a tile, from 0 to 1.
fn light([a, b, c, d]: &[Vector3<f64>; 4]) -> f32 {
    let normal = (c - a).cross(&(d - b)).normalize();
    normal.dot(&Vector3::from(LIGHT)).max(0.0) as f32
}

/// The colours of a terrain.
struct Paint {
    tiles: [[u8; 3]; 2],
    lowest_m: f64,
    range_m: f64,
}

impl Paint {
    fn of(terrain: &Terrain, hue: u32) -> Self {
        let heights_m = || terrain.heights_m().iter().copied();
        let lowest_m = heights_m().fold(f64::INFINITY, f64::min);
        let range_m = heights_m().fold(f64::NEG_INFINITY, f64::max) - lowest_m;
        let island = palette::island(hue);
        let tiles = [0.72, 0.62].map(|dark| palette::mix(island, palette::BACKDROP, dark));
        Self { tiles, lowest_m, range_m: range_m.max(f64::MIN_POSITIVE) }
    }

    fn at(&self, height_m: f64, tile: usize, light: f32) -> Color {
        let share = ((height_m - self.lowest_m) / self.range_m) as f32;
        let color = palette::mix(self.tiles[tile], SUMMIT, SUMMIT_SHARE * share);
        palette::opaque(palette::mix(palette::BACKDROP, color, SHADE + (1.0 - SHADE) * light))
    }
}

/// The walls, as what does not stand between the eye and the creatures: rails and posts.
pub fn fence(terrain: &Terrain) -> LineStrips3D {
    let half_m = terrain.half_m();
    let top_m = terrain.wall_top_m();
    let corner = |x: f64, y: f64, z_m: f64| vector![x * half_m.x, y * half_m.y, z_m];
    let around = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0)];
    let rail = |z_m: f64| around.map(|(x, y)| corner(x, y, z_m)).to_vec();
    let mut strips = vec![rail(top_m), rail(top_m - WALL_M / 2.0)];
    for side in around.windows(2) {
        let [from_m, to_m] = [side[0], side[1]].map(|(x, y)| corner(x, y, top_m));
        let posts = ((to_m - from_m).norm() / POSTS_M).ceil().clamp(1.0, 64.0) as usize;
        strips.extend((0..posts).map(|post| {
            let top_m = from_m.lerp(&to_m, post as f64 / posts as f64);
            vec![vector![top_m.x, top_m.y, terrain.height_m(top_m.x, top_m.y)], top_m]
        }));
    }
    let line = |strip: Vec<Vector3<f64>>| -> Vec<[f32; 3]> {
        strip.into_iter().map(|place_m| place_m.cast::<f32>().into()).collect()
    };
    LineStrips3D::new(strips.into_iter().map(line))
        .with_colors([palette::opaque(palette::mix(palette::MARKS, palette::BACKDROP, 0.35))])
        .with_radii([0.02])
}
