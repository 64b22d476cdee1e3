//! Genomes grow, cross and become networks as the paper says.

use super::marking::{is_hidden, of_split};
use super::mutation::Growth;
use super::*;
use crate::rng::{Purpose, Source, Stream};

const SOCKETS: Sockets = Sockets { inputs: 2, outputs: 1 };
const OUTPUT: u64 = 3;

fn stream(index: u32) -> Stream {
    Source { seed: 4, island: 0 }.stream(0, index, Purpose::Mutation)
}

fn growth(is_acyclic: bool) -> Growth<'static> {
    Growth {
        weights_rate: 0.8,
        weight_step: 2.0,
        neuron_rate: 0.3,
        link_rate: 0.5,
        functions: &Function::CPPN,
        is_acyclic,
        genes_max: 60,
    }
}

fn minimal(index: u32) -> Genome {
    Start::Minimal.genome(SOCKETS, &[Function::Sigmoid], &mut stream(index))
}

/// A genome that has mutated so often.
fn grown(index: u32, times: u32, is_acyclic: bool) -> Genome {
    let (mut genome, mut rng) = (minimal(index), stream(1_000 + index));
    (0..times).for_each(|_| growth(is_acyclic).mutate(&mut genome, SOCKETS, &mut rng));
    genome
}

#[test]
fn a_minimal_genome_links_inputs_and_bias_to_the_output_and_nothing_else() {
    let links = minimal(0).links;
    assert_eq!(links.iter().map(Link::marking).collect::<Vec<_>>(), [(0, 3), (1, 3), (2, 3)]);
    assert!(links.iter().all(|link| link.enabled && link.weight.abs() <= 1.0));
}

#[test]
fn every_start_is_sound_and_read_as_it_is_written() {
    let names = ["minimal", "layer:10", "random:10"];
    assert_eq!(Start::USUAL.map(|start| start.to_string()), names);
    for start in Start::USUAL {
        assert_eq!(start.to_string().parse(), Ok(start));
        for index in 0..50 {
            let genome = start.genome(SOCKETS, &Function::CPPN, &mut stream(index));
            assert_eq!(Genome::of_genes(&genome.genes(), SOCKETS), Ok(genome.clone()));
            assert!(genome.forwards(SOCKETS).is_some() && !genome.is_empty());
        }
    }
    let layer = Start::Layer { neurons: 10 }.genome(SOCKETS, &Function::CPPN, &mut stream(0));
    assert_eq!((layer.neurons.len(), layer.links.len()), (10, 10 * (3 + 1)));
    assert!("layer:0".parse::<Start>().is_err() && "full".parse::<Start>().is_err());
}

#[test]
fn genomes_stay_sound_however_they_grow_and_cross() {
    for index in 0..60 {
        for is_acyclic in [true, false] {
            let [a, b] = [index, index + 500].map(|index| grown(index, 40, is_acyclic));
            let child = crossover::cross(&a, &b, &mut stream(index));
            for genome in [a, b, child] {
                assert_eq!(Genome::of_genes(&genome.genes(), SOCKETS), Ok(genome.clone()));
                assert!(genome.len() <= 60);
                assert!(!is_acyclic || genome.forwards(SOCKETS).is_some());
            }
        }
    }
}

#[test]
fn a_split_keeps_the_weight_and_its_marking_says_which_split_of_which_link_it_was() {
    let mut genome = minimal(0);
    let before = genome.clone();
    growth(true).split_a_link(&mut genome, &mut stream(1));
    let off: Vec<Link> = genome.links.iter().copied().filter(|link| !link.enabled).collect();
    let [old] = off[..] else { panic!("one link is disabled") };
    let neuron = genome.neurons[0].marking;
    assert_eq!(neuron, of_split(old.from, OUTPUT, 0));
    assert!(is_hidden(neuron));
    assert_eq!(genome.link(old.from, neuron).unwrap().weight, 1.0);
    assert_eq!(genome.link(neuron, OUTPUT).unwrap().weight, old.weight);
    assert_eq!(before.link(old.from, OUTPUT).unwrap().weight, old.weight);
    // The same link comes back and is split again: that is another innovation.
    for link in &mut genome.links {
        link.enabled = link.marking() == old.marking();
    }
    growth(true).split_a_link(&mut genome, &mut stream(2));
    assert!(genome.neuron(of_split(old.from, OUTPUT, 1)).is_some());
}

#[test]
fn the_same_innovation_has_the_same_marking_in_every_genome() {
    let mut markings = std::collections::BTreeSet::new();
    for index in 0..40 {
        let mut genome = minimal(index);
        growth(true).split_a_link(&mut genome, &mut stream(index));
        markings.insert(genome.neurons[0].marking);
    }
    assert_eq!(markings.len(), 3, "there are three links that can be split");
}

#[test]
fn a_child_has_the_structure_of_its_fitter_parent_and_weights_of_both() {
    let (a, b) = (grown(1, 30, true), grown(2, 30, true));
    let (mut of_a, mut of_b) = (0, 0);
    for index in 0..50 {
        let child = crossover::cross(&a, &b, &mut stream(index));
        let markings = |genome: &Genome| genome.links.iter().map(Link::marking).collect::<Vec<_>>();
        assert_eq!(markings(&child), markings(&a));
        for (link, own) in child.links.iter().zip(&a.links) {
            match b.link(own.from, own.to) {
                None => assert_eq!(link.weight, own.weight),
                Some(_) if link.weight == own.weight => of_a += 1,
                Some(other) => {
                    assert_eq!(link.weight, other.weight);
                    of_b += 1;
                }
            }
        }
    }
    let share = f64::from(of_b) / f64::from(of_a + of_b);
    assert!((share - 0.5).abs() < 0.1, "{share}");
}

#[test]
fn a_gene_that_a_parent_has_disabled_is_disabled_three_times_out_of_four() {
    let (a, mut b) = (minimal(1), minimal(2));
    b.links[1].enabled = false;
    let child = |index| crossover::cross(&a, &b, &mut stream(index));
    let off = (0..2_000).filter(|&index| !child(index).links[1].enabled).count();
    assert!((1_440..1_560).contains(&off), "{off}");
    assert!((0..100).all(|index| child(index).links[0].enabled));
}

#[test]
fn distance_counts_genes_of_one_alone_and_the_mean_difference_of_weights() {
    let usual = Coefficients::USUAL;
    let a = minimal(1);
    assert_eq!(usual.distance(&a, &a), 0.0);
    let mut b = a.clone();
    b.links[0].weight += 3.0;
    assert!((usual.distance(&a, &b) - 0.4 * 3.0 / 3.0).abs() < 1e-12);
    assert!((Coefficients::LARGE.distance(&a, &b) - 3.0).abs() < 1e-12);
    growth(true).split_a_link(&mut b, &mut stream(3));
    assert!((usual.distance(&a, &b) - 2.4).abs() < 1e-12, "two links are new");
    assert_eq!(usual.distance(&a, &b), usual.distance(&b, &a));
    // From 20 links on their number is what unmatched ones are divided by.
    let layer =
        |n| Start::Layer { neurons: n }.genome(SOCKETS, &[Function::Sigmoid], &mut stream(9));
    let (big, one) = (layer(6), layer(5));
    assert!((usual.distance(&big, &one) - 4.0 / 24.0).abs() < 0.4 * 2.0);
    let mut less = big.clone();
    less.links.remove(0);
    assert!((usual.distance(&big, &less) - 1.0 / 24.0).abs() < 1e-12);
}

/// A network worked out by hand: output = σ(2a − b + 0.5 + 3·h), h = σ(a + b).
fn by_hand() -> Genome {
    let mut genome = Genome::default();
    let hidden = of_split(0, OUTPUT, 0);
    genome.add_neuron(Neuron { marking: hidden, function: Function::Sigmoid });
    for (from, to, weight, enabled) in [
        (0, OUTPUT, 2.0, true),
        (1, OUTPUT, -1.0, true),
        (2, OUTPUT, 0.5, true),
        (hidden, OUTPUT, 3.0, true),
        (0, hidden, 1.0, true),
        (1, hidden, 1.0, true),
        (2, hidden, 7.0, false),
    ] {
        genome.add_link(Link { from, to, weight, enabled });
    }
    genome
}

#[test]
fn a_signal_passes_all_links_at_once_forwards_and_one_at_a_time_where_there_may_be_circles() {
    let sigmoid = |x: f64| Function::Sigmoid.at(x);
    let build = |wiring| Network::new(&by_hand(), SOCKETS, wiring, Function::Sigmoid).unwrap();
    let inputs = [0.3, -0.2];
    let direct = 2.0 * 0.3 + 0.2 + 0.5;
    let whole = sigmoid(direct + 3.0 * sigmoid(0.1));
    let mut forward = build(Wiring::FeedForward);
    assert!((forward.step(&inputs)[0] - whole).abs() < 1e-15);
    assert_eq!(forward.links(), 6);
    let mut recurrent = build(Wiring::Recurrent);
    assert!((recurrent.step(&inputs)[0] - sigmoid(0.5)).abs() < 1.0, "nothing has arrived");
    assert!((recurrent.step(&inputs)[0] - whole).abs() < 1e-15);
    let remembered = recurrent.step(&inputs)[0];
    recurrent.forget();
    recurrent.step(&inputs);
    assert_eq!(recurrent.step(&inputs)[0].to_bits(), whole.to_bits());
    assert!((remembered - whole).abs() < 1e-15);
}

#[test]
fn a_network_with_a_circle_remembers_and_is_refused_where_it_must_not() {
    let mut genome = minimal(0);
    genome.links.iter_mut().for_each(|link| link.weight = 0.0);
    genome.add_link(Link { from: OUTPUT, to: OUTPUT, weight: 5.0, enabled: true });
    genome.links[0].weight = 8.0;
    let forward = Network::new(&genome, SOCKETS, Wiring::FeedForward, Function::SignedSigmoid);
    assert_eq!(forward.map(|_| ()).unwrap_err(), Misgrown::Circle);
    let mut network =
        Network::new(&genome, SOCKETS, Wiring::Recurrent, Function::SignedSigmoid).unwrap();
    let after = |network: &mut Network, first: f64| {
        network.forget();
        network.step(&[first, 0.0]);
        (0..20).fold(0.0, |_, _| network.step(&[0.0, 0.0])[0])
    };
    assert!(after(&mut network, 1.0) > 0.9 && after(&mut network, -1.0) < -0.9);
    assert_eq!(after(&mut network, 0.0), 0.0);
}

#[test]
fn functions_are_finite_and_what_they_say() {
    for function in Function::ALL {
        assert_eq!(function.to_string().parse(), Ok(function));
        assert_eq!(Function::of_code(function as u32), Some(function));
        for x in [-1e300, -1e6, -2.0, -0.0, 0.5, 1e6, 1e300] {
            assert!(function.at(x).is_finite(), "{function} at {x}");
        }
    }
    assert!((Function::Sigmoid.at(1.0) - 0.992_608_5).abs() < 1e-6);
    assert_eq!(Function::SignedSigmoid.at(0.0), 0.0);
    assert_eq!(Function::SignedRoot.at(-4.0), -2.0);
    assert_eq!(Function::Clamped.at(3.0), 1.0);
}

#[test]
fn genes_that_are_no_genome_are_refused() {
    let genome = by_hand();
    let genes = genome.genes();
    let read = |genes: &[Gene]| Genome::of_genes(genes, SOCKETS);
    assert_eq!(read(&[genes[1], genes[1]]), Err(Misgrown::Order));
    assert_eq!(read(&[genes[2], genes[1]]), Err(Misgrown::Order));
    assert_eq!(read(&[genes[1], genes[0]]), Err(Misgrown::Order));
    assert_eq!(read(&genes[1..]), Err(Misgrown::Link), "its neuron is gone");
    let few = Sockets { inputs: 1, outputs: 1 };
    assert_eq!(Genome::of_genes(&genes, few), Err(Misgrown::Link));
    for byte in 0..size_of::<Gene>() {
        for bit in 0..8 {
            let mut bytes: [u8; 32] = bytemuck::cast(genes[1]);
            bytes[byte] ^= 1 << bit;
            // Whatever comes of it is a gene or none, and never a panic.
            let spoilt: Gene = bytemuck::cast(bytes);
            let _ = read(&[genes[0], spoilt]);
        }
    }
    let nan = Link { from: 0, to: OUTPUT, weight: f64::NAN, enabled: true };
    assert_eq!(Gene::from(gene::Part::Link(nan)).part(), None);
}
