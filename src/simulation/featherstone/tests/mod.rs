//! The stepper against the textbook: identities that hold between its algorithms and others for the same thing.

mod motion;
mod widths;

use super::FeatherstoneWorld;
use super::factor::Whitened;
use super::spatial::Spatial;
use crate::creature::encodings::course::PARAMETER_COUNT;
use crate::creature::{Gene, Profile, express};
use crate::simulation::assembly::Assembly;
use crate::simulation::failure::Failure;
use crate::simulation::lanes::width::Alone;
use crate::simulation::lanes::{Everywhere, Real};
use crate::simulation::medium::Medium;
use crate::simulation::perturbation::Perturbation;
use crate::simulation::start::Start;
use crate::simulation::terrain::Ground;
use crate::simulation::trial::{Guards, Trial};
use crate::simulation::world::{Stepper, World};
use nalgebra::{DMatrix, DVector, Vector3};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

const TRIAL: Trial = Trial {
    steps_per_s: 240,
    perturbation: Perturbation::NONE,
    gravity_m_s2: 9.81,
    ground: Ground::Plane,
    medium: Medium::Void,
    start: Start::LowestAt(0.1),
    settle_s: 0.0,
    scored_s: 1.0,
    guards: Guards::ALL,
    others: Vec::new(),
};

type Motion = Spatial<Alone>;

fn real(number: f64) -> Real<Alone> {
    Alone.real(number)
}

fn reals(numbers: &[f64]) -> Vec<Real<Alone>> {
    numbers.iter().map(|number| real(*number)).collect()
}

fn motion(numbers: [f64; 6]) -> Motion {
    Spatial(numbers.map(real))
}

fn still() -> Motion {
    Spatial::zero(Alone)
}

fn numbers(motion: &Motion) -> [f64; 6] {
    motion.0.map(|number| number.get(0))
}

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
        link.has_motor = false;
    }
    world.is_held.fill(Alone.mask(false));
    let turn = world.rates_rad_s.iter().map(|_| real(rng.random_range(-1.0..1.0)));
    let turn: Vec<_> = turn.collect();
    world.configuration.advance(&random_spatial(&mut rng), &turn, real(1.0));
    world.midway.follow(&world.configuration);
    world.midway.place(&world.model, &mut world.places);
    let links = world.places.len();
    let rates: Vec<f64> = (0..links).map(|_| rng.random_range(-3.0..3.0)).collect();
    move_by(&mut world, random_spatial(&mut rng), &rates);
    (world, rng)
}

fn random_spatial(rng: &mut ChaCha8Rng) -> Motion {
    motion(std::array::from_fn(|_| rng.random_range(-1.0..1.0)))
}

/// Gives a body velocities.
fn move_by(world: &mut FeatherstoneWorld, root: Motion, rates_rad_s: &[f64]) {
    world.rates_rad_s = reals(rates_rad_s);
    world.velocities = velocities(world, root, rates_rad_s);
    for (index, place) in world.places.iter().enumerate() {
        world.momenta[index] = place.inertia.times(&world.velocities[index]);
    }
}

fn velocities(world: &FeatherstoneWorld, root: Motion, rates_rad_s: &[f64]) -> Vec<Motion> {
    let mut velocities = vec![root; world.places.len()];
    for index in 1..velocities.len() {
        let parent = velocities[world.model.links[index].parent];
        velocities[index] = parent + world.places[index].axis * real(rates_rad_s[index]);
    }
    velocities
}

/// The cross product for wrenches (eq. 2.32).
fn carried_wrench(velocity: &Motion, wrench: &Motion) -> Motion {
    let (turn, shift) = (velocity.angular(), velocity.linear());
    let (moment, force) = (wrench.angular(), wrench.linear());
    Spatial::new(turn.cross(&moment) + shift.cross(&force), turn.cross(&force))
}

/// Inverse dynamics by the recursive Newton–Euler algorithm (section 5.3), without gravity: the wrench on the root,
/// then the torque of each hinge.
fn inverse_dynamics(
    world: &FeatherstoneWorld,
    velocities: &[Motion],
    rates_rad_s: &[f64],
    root: Motion,
    accelerations: &[f64],
) -> DVector<f64> {
    let links = world.places.len();
    let mut motions = vec![root; links];
    let mut wrenches = vec![still(); links];
    for (index, place) in world.places.iter().enumerate() {
        let velocity = &velocities[index];
        if index > 0 {
            let swing = place.axis.carried_by(velocity) * real(rates_rad_s[index]);
            motions[index] = motions[world.model.links[index].parent]
                + place.axis * real(accelerations[index])
                + swing;
        }
        wrenches[index] = place.inertia.times(&motions[index])
            + carried_wrench(velocity, &place.inertia.times(velocity));
    }
    let mut forces = DVector::zeros(links + 5);
    for index in (1..links).rev() {
        forces[index + 5] = world.places[index].axis.dot(&wrenches[index]).get(0);
        let wrench = wrenches[index];
        wrenches[world.model.links[index].parent] += wrench;
    }
    forces.rows_mut(0, 6).copy_from_slice(&numbers(&wrenches[0]));
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
            let value = world.places[ancestor].axis.dot(&wrench).get(0);
            matrix[(index + 5, ancestor + 5)] = value;
            matrix[(ancestor + 5, index + 5)] = value;
            ancestor = world.model.links[ancestor].parent;
        }
        for row in 0..6 {
            matrix[(index + 5, row)] = wrench.0[row].get(0);
            matrix[(row, index + 5)] = wrench.0[row].get(0);
        }
        composite[world.model.links[index].parent].add(&inertia);
    }
    for (row, column) in (0..36).map(|cell| (cell / 6, cell % 6)) {
        matrix[(row, column)] = composite[0].at(row, column).get(0);
    }
    matrix
}

/// L⁻¹, column by column, of a body without held hinges.
fn inverse_factor(world: &mut FeatherstoneWorld) -> DMatrix<f64> {
    let links = world.places.len();
    world.factor.factorise(&world.places, &vec![Alone.mask(false); links]);
    let mut inverse = DMatrix::zeros(links + 5, links + 5);
    for column in 0..links + 5 {
        let mut unit = Whitened { root: still().0, hinges: vec![real(0.0); links] };
        if column < 6 {
            unit.root[column] = real(1.0)
        } else {
            unit.hinges[column - 5] = real(1.0)
        }
        let (mut rates, mut velocities) = (vec![real(0.0); links], vec![still(); links]);
        world.factor.unwhiten(&unit, &mut rates, &mut velocities);
        inverse.view_mut((0, column), (6, 1)).copy_from_slice(&numbers(&velocities[0]));
        let rates: Vec<f64> = rates.iter().map(|rate| rate.get(0)).collect();
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
        let at_rest = (vec![still(); links], vec![0.0; links]);
        for column in 0..links + 5 {
            let (mut root, mut accelerations) = (still(), vec![0.0; links]);
            if column < 6 {
                root.0[column] = real(1.0)
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
            let root = world
                .factor
                .whiten_wrenches(link, lanes, |hinge, [y]| rows[(row, hinge + 5)] = y.get(0));
            (0..6).for_each(|i| rows[(row, i)] = root[i][0].get(0));
            (0..6).for_each(|i| jacobians[(row, i)] = wrench.0[i].get(0));
            let mut ancestor = link;
            while ancestor > 0 {
                jacobians[(row, ancestor + 5)] = world.places[ancestor].axis.dot(&wrench).get(0);
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
        let carried = Spatial::new(still().linear(), carried);
        let root = (world.velocities[0] - before) * real(per_s) - carried;
        let change =
            |(after, before): (&Real<Alone>, &Real<Alone>)| (after.get(0) - before.get(0)) * per_s;
        let accelerations: Vec<f64> =
            world.rates_rad_s.iter().zip(&rates_before).map(change).collect();
        let rates: Vec<f64> = world.rates_rad_s.iter().map(|rate| rate.get(0)).collect();
        let (v, q) = (&world.velocities, &rates);
        let rest = inverse_dynamics(&world, v, q, root, &accelerations).amax();
        let unmoved = vec![0.0; accelerations.len()];
        let bias = inverse_dynamics(&world, v, q, still(), &unmoved).amax();
        assert!(rest < 1e-4 * bias, "{rest} of {bias}");
    }
}

#[test]
fn velocities_are_the_changes_of_places() {
    for seed in 0..20 {
        let (mut world, mut rng) = floating_world(seed, 240);
        let point_m = Vector3::from_fn(|_, _| rng.random_range(-1.0..1.0));
        let (link, time_s) = (world.places.len() - 1, 1e-6);
        let point_m = Alone.vector(&point_m);
        let at = |world: &FeatherstoneWorld| {
            let (rotation, origin_m) = world.configuration.world_from_link(0, &world.model, link);
            origin_m + rotation.applied(&point_m)
        };
        let before_m = at(&world);
        let velocity_m_s =
            world.velocities[link].velocity_at(&(before_m - world.configuration.position_m));
        let root = world.velocities[0];
        world.configuration.advance(&root, &world.rates_rad_s, real(time_s));
        let moved_m_s = (at(&world) - before_m).alone() / time_s;
        let velocity_m_s = velocity_m_s.alone();
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
                let needed = world.motor_impulse_nms(i).get(0);
                let error = (needed - f64::from(motor.impulse_nms.get(0))).abs();
                let transmitted = numbers(&world.transmitted[i]);
                let scale = transmitted.iter().fold(1e-3, |a: f64, b| a.max(b.abs()));
                assert!(error < 1e-5 * scale, "{error} {needed} {scale}");
            }
            world.release(false);
            world.remember();
            world.advance();
        }
    }
}
