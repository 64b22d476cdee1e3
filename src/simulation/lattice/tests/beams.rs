//! Beams bend and swing as Euler and Bernoulli say.

use super::super::{AIR_DAMPING, Lattice, Surroundings};
use super::{SOFT, block, run, vacuum};
use nalgebra::Vector3;

/// How far the tip of a beam that stands on its first layer hangs down under a small weight along x, as a multiple of
/// the closed form: each layer is a load at its place.
fn sag(side: usize, layers: usize) -> f64 {
    let body = block([side, side, layers], SOFT);
    let (edge_m, width_m) = (body.edge_m, body.edge_m * side as f64);
    let stiffness_nm2 = 1e4 * (width_m * width_m * width_m * width_m) / 12.0;
    let load_n = body.mass_kg() * (side * side) as f64 * 1e-3;
    let length_m = (layers - 1) as f64 * edge_m;
    let bend = |layer: usize| {
        let at_m = layer as f64 * edge_m;
        load_n * at_m * at_m * (3.0 * length_m - at_m) / (6.0 * stiffness_nm2)
    };
    let expected_m: f64 = (0..layers).map(bend).sum();
    let surroundings = Surroundings {
        gravity_m_s2: Vector3::new(1e-3, 0.0, 0.0),
        air_damping: AIR_DAMPING * 9.0 / (layers - 1) as f64,
        ..Surroundings::VACUUM
    };
    let mut lattice = Lattice::new(body, surroundings, 1.0);
    (0..side * side).for_each(|voxel| lattice.nail(voxel));
    let tip = lattice.len() - 1;
    let rest_m = lattice.corner(tip).position_m.x;
    run(&mut lattice, 6.0 * (layers * layers) as f64 / 100.0);
    (lattice.corner(tip).position_m.x - rest_m) / expected_m
}

#[test]
fn cantilevers_hang_as_euler_and_bernoulli_say() {
    assert!((sag(1, 10) - 1.0).abs() < 1e-3, "{}", sag(1, 10));
    // A thick beam shears, too, the less the longer it is.
    assert!((sag(3, 10) - 1.0).abs() < 0.08, "{}", sag(3, 10));
}

#[test]
#[expect(clippy::disallowed_methods, reason = "closed forms decide no result")]
fn a_cantilever_swings_at_its_first_frequency() {
    let layers = 10;
    let body = block([1, 1, layers], SOFT);
    let (edge_m, length_m) = (body.edge_m, body.edge_m * (layers as f64 - 0.5));
    let root: f64 = 1.875_104_068_711_961;
    // √(EI/ρA)
    let speed = (1e4 / 1_000.0 * edge_m * edge_m / 12.0).sqrt();
    let expected_hz = root * root / std::f64::consts::TAU * speed / (length_m * length_m);

    let mut lattice = vacuum(body);
    lattice.nail(0);
    // In the shape of the first mode.
    let ratio = (root.cosh() + root.cos()) / (root.sinh() + root.sin());
    for layer in 1..layers {
        let b = root / length_m;
        let at = b * layer as f64 * edge_m;
        let shape = at.cosh() - at.cos() - ratio * (at.sinh() - at.sin());
        let slope = b * (at.sinh() + at.sin() - ratio * (at.cosh() - at.cos()));
        lattice.kick(layer, [1e-4 * shape, 0.0, 0.0], [0.0, 1e-4 * slope, 0.0]);
    }
    let rest_m = lattice.corner(layers - 1).position_m.x;
    let mut crossings_s = Vec::new();
    let mut last_m = 0.0;
    while crossings_s.len() < 9 {
        lattice.step();
        let at_m = lattice.corner(layers - 1).position_m.x - rest_m;
        if last_m < 0.0 && at_m >= 0.0 || last_m > 0.0 && at_m <= 0.0 {
            let share = at_m / (at_m - last_m);
            crossings_s.push(lattice.time_s() - share * lattice.step_s());
        }
        last_m = at_m;
    }
    let found_hz = 4.0 / (crossings_s[8] - crossings_s[0]);
    assert!((found_hz / expected_hz - 1.0).abs() < 5e-3, "{found_hz} {expected_hz}");
}
