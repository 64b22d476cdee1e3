//! Terrains against the formulas that they are made of.

use super::mountain::hill_m;
use super::*;
use std::f64::consts::FRAC_1_SQRT_2;

/// A plane that rises by `slope` towards the north, and its ends.
fn ramp(slope: f64) -> Terrain {
    let heights_m = (0..41 * 41).map(|i| slope * 0.5 * ((i / 41) as f64 - 20.0)).collect();
    Terrain::new([41, 41], 0.5, heights_m, [0.0, 0.0]).unwrap()
}

#[test]
fn the_mountain_is_the_courses_with_small_rocks_that_leave_its_foot_smooth() {
    let mountain = mountain();
    assert_eq!((mountain.points(), mountain.half_m()), ([41, 41], Vector2::new(10.0, 10.0)));
    let mut rocks = 0.0_f64;
    for (column, row) in (0..41).flat_map(|row| (0..41).map(move |column| (column, row))) {
        let place_m = mountain.place_m(column, row);
        let rock_m = place_m.z - hill_m(place_m.x, place_m.y);
        assert!((-1e-6..=0.1).contains(&rock_m), "{place_m}: {rock_m}");
        rocks = rocks.max(rock_m);
        if place_m.xy().norm() > 7.0 {
            assert!(rock_m < 0.034, "{place_m}: {rock_m}");
        }
    }
    assert!(rocks > 0.09, "{rocks}");
    let top_m = mountain.height_m(0.0, 0.0);
    assert!((5.0..=5.1).contains(&top_m), "{top_m}");
    assert!((mountain.wall_top_m() - 1.0).abs() < 0.05);
}

#[test]
fn between_points_heights_and_normals_are_those_of_the_triangles() {
    let slope = 0.3;
    let ramp = ramp(slope);
    let normal = Vector3::new(0.0, -slope, 1.0).normalize();
    for i in 0..200 {
        let (x_m, y_m) = (9.9 * libm::sin(f64::from(i)), 9.9 * libm::cos(1.7 * f64::from(i)));
        let facet = ramp.facet(x_m, y_m);
        assert!((facet.height_m - slope * y_m).abs() < 1e-6, "{facet:?} at {x_m}, {y_m}");
        assert!((facet.normal - normal).norm() < 1e-5, "{facet:?} at {x_m}, {y_m}");
    }
    // A single cell with one corner up: half of it stays flat.
    let corner = Terrain::new([2, 2], 1.0, vec![0.0, 1.0, 0.0, 0.0], [0.0, 0.0]).unwrap();
    assert_eq!(corner.facet(-0.25, 0.25), Facet { height_m: 0.0, normal: Vector3::z() });
    let facet = corner.facet(0.25, -0.25);
    assert_eq!(facet.height_m, 0.5);
    assert!((facet.normal - Vector3::new(-1.0, 1.0, 1.0).normalize()).norm() < 1e-12);
    // Beyond the edge it goes on level.
    assert_eq!(corner.height_m(7.0, -7.0), 1.0);
}

#[test]
fn the_hill_between_points_is_near_the_formula() {
    let mountain = mountain();
    for i in 0..500 {
        let (x_m, y_m) = (9.0 * libm::sin(f64::from(i)), 9.0 * libm::cos(1.3 * f64::from(i)));
        let error_m = mountain.height_m(x_m, y_m) - hill_m(x_m, y_m);
        assert!((-0.05..0.12).contains(&error_m), "{error_m} at {x_m}, {y_m}");
    }
    let steep = mountain.facet(0.0, -9.5).normal;
    assert!((steep - Vector3::z()).norm() < 0.06, "{steep}");
    assert!(mountain.facet(-3.0, 0.0).normal.z < FRAC_1_SQRT_2 + 0.12);
}

#[test]
fn the_highest_place_of_a_box_is_not_missed() {
    let mountain = mountain();
    for i in 0..200 {
        let at = |k: f64| 8.0 * libm::sin(f64::from(i) * k);
        let low_m = Vector2::new(at(1.0), at(2.3));
        let high_m = low_m + Vector2::new(1.3, 0.4);
        let highest_m = mountain.highest_m(low_m, high_m);
        for (u, v) in (0..25).map(|j| (f64::from(j % 5) / 4.0, f64::from(j / 5) / 4.0)) {
            let place = low_m + (high_m - low_m).component_mul(&Vector2::new(u, v));
            assert!(mountain.height_m(place.x, place.y) <= highest_m + 1e-12);
        }
    }
}

#[test]
fn what_nothing_could_stand_on_is_no_terrain() {
    let new = |points: [usize; 2], step_m, height_m, start_m| {
        let mut heights_m = vec![0.0; points[0] * points[1]];
        heights_m[1] = height_m;
        Terrain::new(points, step_m, heights_m, start_m).map(|_| ())
    };
    let start = [0.0, 0.0];
    assert_eq!(new([3, 2], 1.0, 0.5, start), Ok(()));
    assert_eq!(new([1, 2], 1.0, 0.5, start), Err(TerrainError::Points(1, 2)));
    let many = POINTS_MAX + 1;
    assert_eq!(new([many, 2], 1.0, 0.5, start), Err(TerrainError::Points(many, 2)));
    assert_eq!(new([3, 2], 0.0, 0.5, start), Err(TerrainError::Step(0.0)));
    assert!(matches!(new([3, 2], f64::NAN, 0.5, start), Err(TerrainError::Step(_))));
    assert!(matches!(new([3, 2], 1.0, f64::NAN, start), Err(TerrainError::Height(_))));
    assert!(matches!(new([3, 2], 1.0, 1e39, start), Err(TerrainError::Height(_))));
    assert!(matches!(new([3, 2], 1.0, 20.5, start), Err(TerrainError::Cliff { .. })));
    assert_eq!(new([3, 2], 1.0, 0.5, [1.5, 0.0]), Err(TerrainError::Start(1.5, 0.0)));
}
