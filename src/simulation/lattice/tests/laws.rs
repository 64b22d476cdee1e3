//! What must stay stays.

use super::super::{AIR_DAMPING, Lattice, Surroundings};
use super::{ANTIPHASE, MUSCLE, SOFT, block, motley, run, vacuum};
use nalgebra::Vector3;

#[test]
fn what_falls_freely_falls_as_it_must() {
    let gravity_m_s2 = Vector3::new(0.0, 0.0, -9.81);
    let surroundings = Surroundings { gravity_m_s2, ..Surroundings::VACUUM };
    let mut lattice = Lattice::new(block([3, 2, 2], MUSCLE), surroundings, 1.0);
    let start_m = lattice.centre_m();
    run(&mut lattice, 1.0);
    let (time_s, step_s) = (lattice.time_s(), lattice.step_s());
    // With semi-implicit Euler ½gt(t + Δt), exactly.
    let expected_m = start_m + gravity_m_s2 * (0.5 * time_s * (time_s + step_s));
    assert!((lattice.centre_m() - expected_m).norm() < 1e-10);
}

#[test]
fn muscles_in_a_vacuum_make_no_momentum() {
    for index in 0..3 {
        let mut lattice = vacuum(motley([4, 3, 3], index));
        let centre_m = lattice.centre_m();
        run(&mut lattice, 1.0);
        let [linear, angular] = lattice.momenta();
        assert!(linear.norm() < 1e-12 && angular.norm() < 1e-12, "{linear} {angular}");
        assert!((lattice.centre_m() - centre_m).norm() < 1e-12);
        assert!(lattice.energy().kinetic_j > 1e-9, "it moves");
    }
}

#[test]
fn what_spins_keeps_its_momentum() {
    let mut lattice = vacuum(block([3, 3, 4], MUSCLE));
    let centre_m = lattice.centre_m();
    let spin_rad_s = Vector3::new(1.0, 2.0, 3.0);
    for voxel in 0..lattice.len() {
        let velocity = spin_rad_s.cross(&(lattice.corner(voxel).position_m - centre_m));
        let velocity = velocity + Vector3::new(0.1, 0.0, 0.2);
        lattice.kick(voxel, velocity.into(), spin_rad_s.into());
    }
    let before = lattice.momenta();
    run(&mut lattice, 2.0);
    for (before, after) in before.into_iter().zip(lattice.momenta()) {
        assert!((after - before).norm() < 1e-12 * before.norm(), "{before} {after}");
    }
}

#[test]
fn energy_stays_for_ten_seconds_where_nothing_takes_or_gives_any() {
    let mut body = block([3, 2, 4], SOFT);
    body.link_damping = 0.0;
    let mut lattice = vacuum(body);
    lattice.kick(0, [0.3, 0.1, -0.2], [5.0, 10.0, -5.0]);
    lattice.kick(20, [-0.1, 0.2, 0.2], [0.0, -10.0, 20.0]);
    let start_j = lattice.energy().stored_j();
    for second in 1..=10 {
        run(&mut lattice, f64::from(second));
        let ratio = lattice.energy().stored_j() / start_j;
        assert!((ratio - 1.0).abs() < 0.05, "{ratio} of its energy after {second} s");
    }
}

#[test]
fn the_ledger_of_energy_is_balanced_by_the_work_of_muscles() {
    let mut body = block([2, 2, 6], MUSCLE);
    body.voxels.iter_mut().step_by(3).for_each(|voxel| *voxel = Some(ANTIPHASE));
    body.link_damping = 0.0;
    let mut lattice = vacuum(body);
    for tenth in 1..=10 {
        run(&mut lattice, 0.1 * f64::from(tenth));
        let energy = lattice.energy();
        let error_j = energy.stored_j() - energy.work_j;
        assert!(error_j.abs() < 0.02 * energy.stored_j(), "{energy:?}");
    }
}

#[test]
fn damping_only_takes_energy() {
    let mut lattice = Lattice::new(
        block([3, 3, 3], MUSCLE),
        Surroundings { air_damping: AIR_DAMPING, ..Surroundings::VACUUM },
        1.0,
    );
    lattice.kick(0, [0.5, 0.0, 0.0], [0.0, 20.0, 0.0]);
    let start_j = lattice.energy().stored_j();
    run(&mut lattice, 1.0);
    let energy = lattice.energy();
    assert!(energy.stored_j() - energy.work_j < start_j, "{energy:?}");
}
