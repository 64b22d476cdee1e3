//! How bodies move in the long run: what is kept, what stays, and what ends a trial.

use super::*;

fn total(momenta: &[Motion]) -> Motion {
    momenta.iter().fold(still(), |sum, momentum| sum + *momentum)
}

/// Kinetic energy midway, before the body is moved on, in joules.
fn energy_j(world: &FeatherstoneWorld) -> f64 {
    world.velocities.iter().zip(&world.momenta).map(|(v, h)| 0.5 * v.dot(h).get(0)).sum()
}

#[test]
fn momentum_is_kept_to_the_last_digits_whatever_motors_do_in_empty_space() {
    for seed in 0..20 {
        let (mut world, mut rng) = floating_world(seed, 240);
        for (index, link) in world.model.links.iter_mut().enumerate().skip(1) {
            link.has_motor = true;
            world.torques_nm_max[index] = real(1.0);
            world.is_held[index] = Alone.mask(true);
        }
        let about_origin = |world: &FeatherstoneWorld| {
            total(&world.momenta).wrench_about(&-world.midway.position_m)
        };
        let before = about_origin(&world);
        for _ in 0..240 {
            (1..world.places.len()).for_each(|i| world.drive(i, rng.random_range(-3.0..3.0)));
            world.step().unwrap();
        }
        let change = numbers(&(about_origin(&world) - before));
        let change = change.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
        let scale = total(&world.momenta).linear().alone().norm();
        assert!(change < 1e-6 * scale * 100.0, "{change}");
    }
}

#[test]
fn an_undriven_chain_does_not_gain_energy_and_hardly_loses_any() {
    for seed in 0..20 {
        let (mut world, _) = floating_world(seed, 240);
        let before_j = energy_j(&world);
        for _ in 0..2400 {
            world.find_contacts();
            world.fall();
            world.attempt();
            world.transmit();
            let share = energy_j(&world) / before_j;
            assert!((0.998..1.0005).contains(&share), "{seed}: {share}");
            world.remember();
            world.advance();
        }
    }
}

#[test]
fn a_body_at_rest_stays_at_rest() {
    for seed in 0..20 {
        let (mut world, _) = random_world(seed, &TRIAL);
        let settle_steps = 10 * 240;
        (0..settle_steps).for_each(|_| world.step().unwrap());
        let before_m = world.configuration.position_m;
        (0..240).for_each(|_| world.step().unwrap());
        let moved_m = (world.configuration.position_m - before_m).alone().norm();
        assert!(moved_m < 1e-3, "{seed}: {moved_m}");
    }
}

#[test]
fn numbers_that_are_none_end_the_trial_by_their_name() {
    let (mut world, _) = random_world(1, &TRIAL);
    world.momenta[2].0[4] = real(f64::NAN);
    assert_eq!(world.step(), Err(Failure::NotFinite));
    let (mut world, _) = random_world(1, &TRIAL);
    world.targets_rad_s[2] = real(f64::INFINITY);
    assert_eq!(world.step(), Err(Failure::NotFinite));
}

#[test]
fn links_that_weigh_nothing_are_carried_along() {
    for seed in 0..20 {
        let (mut world, _) = random_world(seed, &TRIAL);
        let last = world.model.links.last_mut().unwrap();
        (last.mass_kg, last.inertia_kg_m2) = (0.0, last.inertia_kg_m2 * 0.0);
        world.configuration.place(&world.model, &mut world.places);
        for step in 0..480 {
            let target_rad_s = if step % 48 < 24 { 2.0 } else { -2.0 };
            (1..world.places.len()).for_each(|i| world.drive(i, target_rad_s));
            assert_eq!(world.step(), Ok(()), "{seed}: {step}");
        }
    }
}

#[test]
fn positions_are_those_of_poses() {
    for seed in 0..20 {
        let (mut world, mut rng) = random_world(seed, &TRIAL);
        for _ in 0..48 {
            (1..world.places.len()).for_each(|i| world.drive(i, rng.random_range(-3.0..3.0)));
            world.step().unwrap();
        }
        for part in 0..world.places.len() {
            let pose = world.world_from_part(part);
            let error_m = (world.position_m(part) - pose.translation.vector).norm();
            assert!(error_m < 1e-9, "{seed}, {part}: {error_m}");
        }
    }
}
