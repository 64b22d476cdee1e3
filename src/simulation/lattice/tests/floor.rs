//! The floor carries, holds and brakes, and a body does not pass through itself.

use super::super::{Floor, Lattice, Surroundings};
use super::{MUSCLE, SOFT, block, run};
use nalgebra::Vector3;

/// Coulomb's floor with µ 1 and 0.5, tilted.
fn slope(angle_rad: f64) -> Surroundings {
    let pull = Vector3::new(libm::sin(angle_rad), 0.0, -libm::cos(angle_rad)) * 9.81;
    Surroundings { gravity_m_s2: pull, air_damping: 0.0, ..Surroundings::GROUND }
}

#[test]
fn what_slides_stops_where_coulomb_says() {
    let mut lattice = Lattice::new(block([2, 2, 1], SOFT), slope(0.0), 1.0);
    run(&mut lattice, 0.5);
    (0..4).for_each(|voxel| lattice.kick(voxel, [0.5, 0.0, 0.0], [0.0; 3]));
    let start_m = lattice.centre_m().x;
    run(&mut lattice, 2.0);
    let expected_m = 0.5 * 0.5 / (2.0 * 0.5 * 9.81);
    let went_m = lattice.centre_m().x - start_m;
    assert!((went_m / expected_m - 1.0).abs() < 0.01, "{went_m} {expected_m}");
    let stopped_m = lattice.centre_m().x;
    run(&mut lattice, 3.0);
    assert_eq!(lattice.centre_m().x, stopped_m, "what rests does not creep");
}

#[test]
fn a_slope_holds_up_to_its_static_friction() {
    let slid_m = |angle_rad: f64| {
        let mut lattice = Lattice::new(block([2, 2, 1], SOFT), slope(angle_rad), 1.0);
        // Held until its weight presses it down.
        while lattice.time_s() < 0.1 {
            lattice.step();
            (0..4).for_each(|voxel| lattice.kick(voxel, [0.0; 3], [0.0; 3]));
        }
        let start_m = lattice.centre_m().x;
        run(&mut lattice, 1.1);
        lattice.centre_m().x - start_m
    };
    // Up to 45°, where what slides already would go on.
    assert!(slid_m(0.7).abs() < 1e-5, "{}", slid_m(0.7));
    // Beyond it goes down with g(sin − ½cos).
    let angle_rad = 0.9;
    let expected_m = 0.5 * 9.81 * (libm::sin(angle_rad) - 0.5 * libm::cos(angle_rad));
    let ratio = slid_m(angle_rad) / expected_m;
    assert!((ratio - 1.0).abs() < 0.01, "{ratio}");
}

#[test]
fn a_body_rests_as_deep_as_its_weight_presses() {
    let mut lattice = Lattice::new(block([1, 1, 1], SOFT), slope(0.0), 1.0);
    run(&mut lattice, 2.0);
    let depth_m = 0.005 - lattice.corner(0).position_m.z;
    // mg over the contact's 2EL.
    let expected_m = 1e-3 * 9.81 / (2.0 * 1e4 * 0.01);
    assert!((depth_m / expected_m - 1.0).abs() < 1e-6, "{depth_m} {expected_m}");
    assert!((lattice.depth() - depth_m / 0.005).abs() < 1e-9);
}

#[test]
fn a_frictionless_floor_gives_no_way() {
    let floor = Some(Floor { static_friction: 0.0, kinetic_friction: 0.0 });
    let surroundings = Surroundings { floor, ..slope(0.0) };
    let mut body = block([4, 2, 2], SOFT);
    body.voxels[..6].fill(Some(MUSCLE));
    let mut lattice = Lattice::new(body, surroundings, 1.0);
    let start_m = lattice.centre_m();
    run(&mut lattice, 1.0);
    assert!((lattice.centre_m() - start_m).xy().norm() < 1e-12);
}

#[test]
fn arms_that_swing_together_meet_only_where_a_body_feels_itself() {
    // Two towers on a base, a voxel apart.
    let mut body = block([3, 1, 9], SOFT);
    for layer in 1..9 {
        body.voxels[layer * 3 + 1] = None;
    }
    let closest_m = |self_collision: bool| {
        let surroundings = Surroundings { self_collision, ..Surroundings::VACUUM };
        let mut lattice = Lattice::new(body.clone(), surroundings, 1.0);
        let [left, right] = [lattice.len() - 2, lattice.len() - 1];
        lattice.kick(left, [0.3, 0.0, 0.0], [0.0; 3]);
        lattice.kick(right, [-0.3, 0.0, 0.0], [0.0; 3]);
        let mut closest_m = f64::INFINITY;
        while lattice.time_s() < 0.4 {
            lattice.step();
            let gap_m = lattice.corner(right).position_m.x - lattice.corner(left).position_m.x;
            closest_m = gap_m.min(closest_m);
        }
        let [linear, angular] = lattice.momenta();
        assert!(linear.norm() < 1e-12 && angular.norm() < 1e-12);
        closest_m
    };
    assert!(closest_m(false) < 0.002, "{}", closest_m(false));
    assert!(closest_m(true) > 0.006, "{}", closest_m(true));
}
