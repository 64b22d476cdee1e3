//! The stepper against the textbook: identities that hold between its algorithms and others for the same thing.

use super::super::perturbation::Perturbation;
use super::super::terrain::Ground;
use super::super::trial::Start;
use super::*;
use crate::creature::gene::PARAMETER_COUNT;
use crate::creature::{Gene, Profile, express};
use nalgebra::{DMatrix, DVector};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

const TRIAL: Trial = Trial {
    steps_per_s: 240,
    perturbation: Perturbation::NONE,
    gravity_m_s2: 9.81,
    ground: Ground::Plane,
    start: Start::LowestAt(0.1),
    settle_s: 0.0,
    scored_s: 1.0,
    keeps_ledger: true,
};

/// A world with a random body of several hinges, and the generator that made it.
fn random_world(seed: u64, trial: &Trial) -> (FeatherstoneWorld, ChaCha8Rng) {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    loop {
        let gene = |rng: &mut ChaCha8Rng| Gene(std::array::from_fn(|_| rng.random()));
        let mut genome = [Gene([0.0; PARAMETER_COUNT]); 4];
        genome.iter_mut().for_each(|slot| *slot = gene(&mut rng));
        let creature = express(&genome, Profile::Native, 12).unwrap();
        let assembly = Assembly::new(&creature, trial);
        if assembly.parts.len() > 3 {
            return (FeatherstoneWorld::new(&assembly, trial), rng);
        }
    }
}

/// The same, floating, without motors, turned and moving anyhow.
fn floating_world(seed: u64, steps_per_s: u32) -> (FeatherstoneWorld, ChaCha8Rng) {
    let start = Start::RootAt(100.0);
    let trial = Trial { steps_per_s, gravity_m_s2: 0.0, start, ..TRIAL };
    let (mut world, mut rng) = random_world(seed, &trial);
    for link in &mut world.model.links {
        link.torque_nm_max = 0.0;
    }
    world.is_held.fill(false);
    let turn = world.rates_rad_s.iter().map(|_| rng.random_range(-1.0..1.0)).collect::<Vec<_>>();
    world.configuration.advance(&random_spatial(&mut rng), &turn, 1.0);
    world.midway = world.configuration.clone();
    world.midway.place(&world.model, &mut world.places);
    let links = world.places.len();
    let rates: Vec<f64> = (0..links).map(|_| rng.random_range(-3.0..3.0)).collect();
    move_by(&mut world, random_spatial(&mut rng), &rates);
    (world, rng)
}

fn random_spatial(rng: &mut ChaCha8Rng) -> Spatial {
    Spatial(std::array::from_fn(|_| rng.random_range(-1.0..1.0)))
}

/// Gives a body velocities.
fn move_by(world: &mut FeatherstoneWorld, root: Spatial, rates_rad_s: &[f64]) {
    world.rates_rad_s.copy_from_slice(rates_rad_s);
    world.velocities = velocities(world, root, rates_rad_s);
    for (index, place) in world.places.iter().enumerate() {
        world.momenta[index] = place.inertia.times(&world.velocities[index]);
    }
}

fn velocities(world: &FeatherstoneWorld, root: Spatial, rates_rad_s: &[f64]) -> Vec<Spatial> {
    let mut velocities = vec![root; world.places.len()];
    for index in 1..velocities.len() {
        let parent = velocities[world.model.links[index].parent];
        velocities[index] = parent + world.places[index].axis * rates_rad_s[index];
    }
    velocities
}

/// The cross product for wrenches (eq. 2.32).
fn carried_wrench(velocity: &Spatial, wrench: &Spatial) -> Spatial {
    let (turn, shift) = (velocity.angular(), velocity.linear());
    let (moment, force) = (wrench.angular(), wrench.linear());
    Spatial::new(turn.cross(&moment) + shift.cross(&force), turn.cross(&force))
}

/// Inverse dynamics by the recursive Newton–Euler algorithm (section 5.3), without gravity: the wrench on the root,
/// then the torque of each hinge.
fn inverse_dynamics(
    world: &FeatherstoneWorld,
    velocities: &[Spatial],
    rates_rad_s: &[f64],
    root: Spatial,
    accelerations: &[f64],
) -> DVector<f64> {
    let links = world.places.len();
    let mut motions = vec![root; links];
    let mut wrenches = vec![Spatial::ZERO; links];
    for (index, place) in world.places.iter().enumerate() {
        let velocity = &velocities[index];
        if index > 0 {
            let swing = place.axis.carried_by(velocity) * rates_rad_s[index];
            motions[index] = motions[world.model.links[index].parent]
                + place.axis * accelerations[index]
                + swing;
        }
        wrenches[index] = place.inertia.times(&motions[index])
            + carried_wrench(velocity, &place.inertia.times(velocity));
    }
    let mut forces = DVector::zeros(links + 5);
    for index in (1..links).rev() {
        forces[index + 5] = world.places[index].axis.dot(&wrenches[index]);
        let wrench = wrenches[index];
        wrenches[world.model.links[index].parent] += wrench;
    }
    forces.rows_mut(0, 6).copy_from_slice(&wrenches[0].0);
    forces
}

/// The joint-space mass matrix by the composite-rigid-body algorithm (section 6.2).
fn mass_matrix(world: &FeatherstoneWorld) -> DMatrix<f64> {
    let links = world.places.len();
    let mut composite: Vec<_> = world.places.iter().map(|place| place.inertia.spread()).collect();
    let mut matrix = DMatrix::zeros(links + 5, links + 5);
    for index in (1..links).rev() {
        let inertia = composite[index];
        let wrench = inertia.times(&world.places[index].axis);
        let mut ancestor = index;
        while ancestor > 0 {
            let value = world.places[ancestor].axis.dot(&wrench);
            matrix[(index + 5, ancestor + 5)] = value;
            matrix[(ancestor + 5, index + 5)] = value;
            ancestor = world.model.links[ancestor].parent;
        }
        for row in 0..6 {
            matrix[(index + 5, row)] = wrench.0[row];
            matrix[(row, index + 5)] = wrench.0[row];
        }
        composite[world.model.links[index].parent].add(&inertia);
    }
    for (row, column) in (0..36).map(|cell| (cell / 6, cell % 6)) {
        matrix[(row, column)] = composite[0][(row, column)];
    }
    matrix
}

/// L⁻¹, column by column, of a body without held hinges.
fn inverse_factor(world: &mut FeatherstoneWorld) -> DMatrix<f64> {
    let links = world.places.len();
    world.factor.factorise(&world.places, &vec![false; links]);
    let mut inverse = DMatrix::zeros(links + 5, links + 5);
    for column in 0..links + 5 {
        let mut unit = Whitened { root: [0.0; 6], hinges: vec![0.0; links] };
        if column < 6 {
            unit.root[column] = 1.0
        } else {
            unit.hinges[column - 5] = 1.0
        }
        let (mut rates, mut velocities) = (vec![0.0; links], vec![Spatial::ZERO; links]);
        world.factor.unwhiten(&unit, &mut rates, &mut velocities);
        inverse.view_mut((0, column), (6, 1)).copy_from_slice(&velocities[0].0);
        inverse.view_mut((6, column), (links - 1, 1)).copy_from_slice(&rates[1..]);
    }
    inverse
}

#[test]
fn the_mass_matrix_is_symmetric_and_positive_definite_and_inverse_dynamics_gives_its_columns() {
    for seed in 0..20 {
        let (world, _) = floating_world(seed, 240);
        let matrix = mass_matrix(&world);
        assert!(matrix.clone().cholesky().is_some(), "{matrix}");
        let links = world.places.len();
        let at_rest = (vec![Spatial::ZERO; links], vec![0.0; links]);
        for column in 0..links + 5 {
            let (mut root, mut accelerations) = (Spatial::ZERO, vec![0.0; links]);
            if column < 6 {
                root.0[column] = 1.0
            } else {
                accelerations[column - 5] = 1.0
            }
            let forces = inverse_dynamics(&world, &at_rest.0, &at_rest.1, root, &accelerations);
            let error = (forces - matrix.column(column)).amax();
            assert!(error < 1e-9 * matrix.amax(), "{error}");
        }
    }
}

#[test]
fn the_factor_is_that_of_the_mass_matrix_and_as_sparse_as_the_tree() {
    for seed in 0..20 {
        let (mut world, _) = floating_world(seed, 240);
        let inverse = inverse_factor(&mut world);
        let identity = inverse.transpose() * mass_matrix(&world) * &inverse;
        let error = (identity - DMatrix::identity(inverse.nrows(), inverse.nrows())).amax();
        assert!(error < 1e-9, "{error}");
        for row in 1..world.places.len() {
            for column in 1..world.places.len() {
                let mut ancestor = row;
                while ancestor > column {
                    ancestor = world.model.links[ancestor].parent;
                }
                assert!(ancestor == column || inverse[(row + 5, column + 5)] == 0.0);
            }
        }
    }
}

#[test]
fn the_product_of_two_whitened_rows_is_that_of_their_jacobians_over_the_mass_matrix() {
    for seed in 0..20 {
        let (mut world, mut rng) = floating_world(seed, 240);
        let inverse = inverse_factor(&mut world);
        let links = world.places.len();
        let mut rows = DMatrix::zeros(2, links + 5);
        let mut jacobians = DMatrix::zeros(2, links + 5);
        for row in 0..2 {
            let (link, wrench) = (rng.random_range(1..links), random_spatial(&mut rng));
            let lanes = wrench.0.map(|part| [part]);
            let root =
                world.factor.whiten_wrenches(link, lanes, |hinge, [y]| rows[(row, hinge + 5)] = y);
            (0..6).for_each(|i| rows[(row, i)] = root[i][0]);
            (0..6).for_each(|i| jacobians[(row, i)] = wrench.0[i]);
            let mut ancestor = link;
            while ancestor > 0 {
                jacobians[(row, ancestor + 5)] = world.places[ancestor].axis.dot(&wrench);
                ancestor = world.model.links[ancestor].parent;
            }
        }
        let whitened = &rows * rows.transpose();
        let plain = &jacobians * (&inverse * inverse.transpose()) * jacobians.transpose();
        assert!((&whitened - &plain).amax() < 1e-9 * plain.amax(), "{whitened} {plain}");
    }
}

#[test]
fn forward_dynamics_undoes_inverse_dynamics_and_has_every_coriolis_force() {
    for seed in 0..20 {
        let steps_per_s = 1_000_000;
        let (mut world, _) = floating_world(seed, steps_per_s);
        (0..2).for_each(|_| world.step().unwrap());
        let (before, rates_before) = (world.velocities[0], world.rates_rad_s.clone());
        world.fall();
        world.attempt();
        let per_s = f64::from(steps_per_s);
        // The book's acceleration is that of the motion at a fixed place (section 2.11), not of the root's centre.
        let carried = before.angular().cross(&before.linear());
        let root = (world.velocities[0] - before) * per_s - Spatial::new(Vector3::zeros(), carried);
        let change = |(after, before): (&f64, &f64)| (after - before) * per_s;
        let accelerations: Vec<f64> =
            world.rates_rad_s.iter().zip(&rates_before).map(change).collect();
        let (v, q) = (&world.velocities, &world.rates_rad_s);
        let rest = inverse_dynamics(&world, v, q, root, &accelerations).amax();
        let unmoved = vec![0.0; accelerations.len()];
        let bias = inverse_dynamics(&world, v, q, Spatial::ZERO, &unmoved).amax();
        assert!(rest < 1e-4 * bias, "{rest} of {bias}");
    }
}

#[test]
fn velocities_are_the_changes_of_places() {
    for seed in 0..20 {
        let (mut world, mut rng) = floating_world(seed, 240);
        let point_m = Vector3::from_fn(|_, _| rng.random_range(-1.0..1.0));
        let (link, time_s) = (world.places.len() - 1, 1e-6);
        let at = |world: &FeatherstoneWorld| {
            let (rotation, origin_m) = world.configuration.world_from_link(&world.model, link);
            origin_m + rotation * point_m
        };
        let before_m = at(&world);
        let velocity_m_s =
            world.velocities[link].velocity_at(&(before_m - world.configuration.position_m));
        let root = world.velocities[0];
        world.configuration.advance(&root, &world.rates_rad_s, time_s);
        let moved_m_s = (at(&world) - before_m) / time_s;
        assert!((moved_m_s - velocity_m_s).norm() < 1e-4, "{moved_m_s} {velocity_m_s}");
    }
}

#[test]
fn a_motor_gives_what_its_hinge_transmits() {
    for seed in 0..20 {
        let (mut world, mut rng) = random_world(seed, &TRIAL);
        for step in 0..240 {
            if step % 24 == 0 {
                (1..world.places.len()).for_each(|i| world.drive(i, rng.random_range(-3.0..3.0)));
            }
            world.find_contacts();
            world.fall();
            world.attempt();
            world.transmit();
            for motor in &world.solver.motors {
                let i = motor.link;
                let needed = world.motor_impulse_nms(i);
                let error = (needed - f64::from(motor.impulse_nms)).abs();
                let scale = world.transmitted[i].0.iter().fold(1e-3, |a: f64, b| a.max(b.abs()));
                assert!(error < 1e-5 * scale, "{error} {needed} {scale}");
            }
            world.release(false);
            world.remember();
            world.advance();
        }
    }
}

fn total(momenta: &[Spatial]) -> Spatial {
    momenta.iter().fold(Spatial::ZERO, |sum, momentum| sum + *momentum)
}

/// Kinetic energy midway, before the body is moved on, in joules.
fn energy_j(world: &FeatherstoneWorld) -> f64 {
    world.velocities.iter().zip(&world.momenta).map(|(v, h)| 0.5 * v.dot(h)).sum()
}

#[test]
fn momentum_is_kept_to_the_last_digits_whatever_motors_do_in_empty_space() {
    for seed in 0..20 {
        let (mut world, mut rng) = floating_world(seed, 240);
        for (index, link) in world.model.links.iter_mut().enumerate().skip(1) {
            link.torque_nm_max = 1.0;
            world.is_held[index] = true;
        }
        let about_origin = |world: &FeatherstoneWorld| {
            total(&world.momenta).wrench_about(&-world.midway.position_m)
        };
        let before = about_origin(&world);
        for _ in 0..240 {
            (1..world.places.len()).for_each(|i| world.drive(i, rng.random_range(-3.0..3.0)));
            world.step().unwrap();
        }
        let change = (about_origin(&world) - before).0.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
        assert!(change < 1e-6 * total(&world.momenta).linear().norm() * 100.0, "{change}");
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
        let moved_m = (world.configuration.position_m - before_m).norm();
        assert!(moved_m < 1e-3, "{seed}: {moved_m}");
    }
}

#[test]
fn numbers_that_are_none_end_the_trial_by_their_name() {
    let (mut world, _) = random_world(1, &TRIAL);
    world.momenta[2].0[4] = f64::NAN;
    assert_eq!(world.step(), Err(Outcome::NotFinite));
    let (mut world, _) = random_world(1, &TRIAL);
    world.targets_rad_s[2] = f64::INFINITY;
    assert_eq!(world.step(), Err(Outcome::NotFinite));
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
