//! The tests of networks are those of the paper.

use super::cart::Cart;
use super::*;
use crate::networks::{Link, Neuron, marking};
use crate::rng::{Purpose, Source};

fn neat(test: Test) -> Neat {
    Neat { test, start: Start::Minimal }
}

fn linked(links: &[(u64, u64, f64)], hidden: Option<u64>) -> Vec<networks::Gene> {
    let mut genome = Genome::default();
    let neuron = |marking| Neuron { marking, function: Function::Sigmoid };
    hidden.into_iter().for_each(|marking| genome.add_neuron(neuron(marking)));
    for &(from, to, weight) in links {
        genome.add_link(Link { from, to, weight, enabled: true });
    }
    genome.genes()
}

#[test]
fn xor_is_worth_the_square_of_what_is_right_and_solved_with_a_hidden_neuron() {
    let nothing = linked(&[(2, 3, 0.0)], None);
    assert_eq!(neat(Test::Xor).evaluate(&nothing).fitness.get(), 4.0, "four answers of one half");
    let and = marking::of_split(0, 3, 0);
    let links = [(0, 3, 4.0), (1, 3, 4.0), (2, 3, -2.0), (0, and, 4.0), (1, and, 4.0)];
    let solution = linked(&[&links[..], &[(2, and, -6.0), (and, 3, -8.0)]].concat(), Some(and));
    let score = neat(Test::Xor).evaluate(&solution).fitness.get();
    assert!(score > xor::SOLVED + 15.9 && score <= xor::SOLVED + 16.0, "{score}");
}

/// The energy of cart and poles without friction, in joules.
fn energy(cart: &Cart) -> f64 {
    let [_, speed, ..] = cart.0;
    let pole = |kg: f64, half_m: f64, angle: f64, turning: f64| {
        let cross = kg * half_m * speed * turning * libm::cos(angle);
        let spin = 0.5 * (4.0 / 3.0) * kg * half_m * half_m * turning * turning;
        0.5 * kg * speed * speed + cross + spin + kg * 9.8 * half_m * libm::cos(angle)
    };
    0.5 * speed * speed
        + pole(0.1, 0.5, cart.0[2], cart.0[3])
        + pole(0.01, 0.05, cart.0[4], cart.0[5])
}

#[test]
fn a_cart_that_nobody_pushes_keeps_its_energy_and_its_poles_fall() {
    let mut cart = Cart([0.0, 0.3, 0.07, 0.0, -0.02, 0.0]);
    let before = energy(&cart);
    let mut steps = 0;
    while cart.stands() && steps < 1_000 {
        cart.push(0.0);
        steps += 1;
    }
    assert!((10..60).contains(&steps), "{steps}");
    assert!((energy(&cart) - before).abs() < 1e-4, "{} and {before}", energy(&cart));
}

#[test]
fn a_push_to_the_right_moves_the_cart_there_and_the_poles_lag_behind() {
    let mut cart = Cart([0.0; 6]);
    cart.push(10.0);
    let [x, speed, long, _, short, _] = cart.0;
    assert!(x > 0.0 && speed > 0.15 && long < 0.0 && short < long);
    assert!((x - 0.5 * 9.73 * 0.02 * 0.02).abs() < 1e-4, "{x}");
}

#[test]
fn a_network_without_force_falls_soon() {
    let problem = neat(Test::DoublePole);
    // The output of one half is no force.
    let still = problem.evaluate(&linked(&[(6, 7, 0.0)], None)).fitness.get();
    assert!((10.0..80.0).contains(&still), "{still}");
}

#[test]
fn whoever_is_no_better_than_the_best_resident_gets_no_long_trial() {
    let problem = neat(Test::DoublePoleBlind);
    let genes = linked(&[(3, 4, 0.0)], None);
    let whole = problem.evaluate(&genes).fitness;
    assert_eq!(problem.estimate(&genes, &Hurdles::LAST).fitness, whole, "it has solved nothing");
    assert!(whole.get() < 0.1, "it fell at once: {whole:?}");
    // Without a force poles stand where they stand upright, and the cart does not roll off its track.
    assert_eq!(problem.starts_held(&genes), Some(5));
}

#[test]
fn genes_that_make_no_network_fail_and_do_not_panic() {
    let alien = linked(&[(9, 12, 1.0)], None);
    for test in Test::ALL {
        let evaluation = neat(test).evaluate(&alien);
        assert_eq!(evaluation.outcome, Outcome::TooLarge);
    }
}

#[test]
fn the_child_of_what_is_no_network_is_none_either_and_never_empty() {
    let alien = linked(&[(9, 12, 1.0)], None);
    let problem = neat(Test::Xor);
    let mut rng = Source { seed: 3, island: 0 }.stream(0, 0, Purpose::Mutation);
    let sound = problem.random_genome(&mut rng);
    let variation = Variation::default();
    for _ in 0..50 {
        for father in [&alien, &sound] {
            let mut child = problem.crossover(&alien, father, &variation, &mut rng);
            problem.mutate(&mut child, &variation, &mut rng);
            assert_eq!(problem.evaluate(&child).outcome, Outcome::TooLarge);
            assert!(!child.is_empty());
        }
        let mut child = problem.crossover(&sound, &alien, &variation, &mut rng);
        problem.mutate(&mut child, &variation, &mut rng);
        assert_eq!(problem.evaluate(&child).outcome, Outcome::Scored);
    }
}
