//! A terrain as rapier has it.

use super::super::terrain::Terrain;
use super::surface;
use rapier3d::prelude::*;
use std::f32::consts::FRAC_PI_2;

/// The thickness of walls, and how far they reach below the ground, in metres.
const WALL_M: f32 = 1.0;

/// The ground and the walls.
pub fn colliders(terrain: &Terrain) -> Vec<ColliderBuilder> {
    // rapier's heights are along y, ours along z: its rows go north to south.
    let ground = ColliderBuilder::new(terrain.shape.0.get_or_init(|| shape(terrain)).clone())
        .rotation(Vector::X * FRAC_PI_2);
    std::iter::once(ground)
        .chain(walls(terrain))
        .map(|ground| surface::collider(ground, surface::of_ground()))
        .collect()
}

fn shape(terrain: &Terrain) -> SharedShape {
    let [columns, rows] = terrain.points();
    let size_m = (terrain.half_m() * 2.0).cast::<f32>();
    let mut heights_m = Array2::repeat(rows, columns, 0.0);
    for (row, west_to_east) in terrain.heights_m().chunks(columns).rev().enumerate() {
        for (column, height_m) in west_to_east.iter().enumerate() {
            heights_m[(row, column)] = *height_m as f32;
        }
    }
    // Without these, what slides stumbles over edges between triangles.
    let flags = HeightFieldFlags::FIX_INTERNAL_EDGES;
    SharedShape::heightfield_with_flags(heights_m, Vector::new(size_m.x, 1.0, size_m.y), flags)
}

fn walls(terrain: &Terrain) -> impl Iterator<Item = ColliderBuilder> {
    let half_m = terrain.half_m().cast::<f32>();
    let lowest_m = terrain.heights_m().iter().copied().fold(f64::INFINITY, f64::min) as f32;
    let (bottom_m, top_m) = (lowest_m - WALL_M, terrain.wall_top_m() as f32);
    let (middle_m, half_height_m) = ((top_m + bottom_m) / 2.0, (top_m - bottom_m) / 2.0);
    [-1.0, 1.0].into_iter().flat_map(move |side| {
        let [x_m, y_m] = [half_m.x, half_m.y].map(|half_m| side * (half_m + WALL_M / 2.0));
        [
            ColliderBuilder::cuboid(WALL_M / 2.0, half_m.y + WALL_M, half_height_m)
                .translation(Vector::new(x_m, 0.0, middle_m)),
            ColliderBuilder::cuboid(half_m.x + WALL_M, WALL_M / 2.0, half_height_m)
                .translation(Vector::new(0.0, y_m, middle_m)),
        ]
    })
}
