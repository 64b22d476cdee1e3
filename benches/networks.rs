//! How fast networks work, by the number of their links, beside a straightforward evaluator: activations a second.
//!
//! `cargo bench --bench networks`

use criterion::{BenchmarkId, Criterion, Throughput};
use islands::networks::marking::of_first;
use islands::networks::{Function, Genome, Link, Network, Neuron, Sockets, Wiring};
use islands::rng::{Purpose, Source, Stream};
use rand::RngExt;
use std::hint::black_box;
use std::time::Duration;

const LINKS: [usize; 3] = [10, 100, 1_000];
const SOCKETS: Sockets = Sockets { inputs: 4, outputs: 2 };

fn main() {
    let mut criterion = Criterion::default().configure_from_args();
    let mut group = criterion.benchmark_group("networks");
    group
        .sample_size(20)
        .warm_up_time(Duration::from_millis(200))
        .measurement_time(Duration::from_secs(1))
        .throughput(Throughput::Elements(1));
    for links in LINKS {
        let genome = genome(links);
        let inputs = [0.5, -0.25, 1.0, 0.125];
        for (name, wiring) in
            [("feed-forward", Wiring::FeedForward), ("recurrent", Wiring::Recurrent)]
        {
            let network = Network::new(&genome, SOCKETS, wiring, Function::Sigmoid);
            let mut network = network.expect("its links lead forwards");
            group.bench_function(BenchmarkId::new(name, links), |bencher| {
                bencher.iter(|| black_box(network.step(black_box(&inputs))[0]));
            });
        }
        let nested = Nested::of(&genome);
        group.bench_function(BenchmarkId::new("vec-of-vec", links), |bencher| {
            bencher.iter(|| black_box(nested.step(black_box(&inputs))[0]));
        });
    }
    group.finish();
    criterion.final_summary();
}

/// A network of so many links: hidden neurons in a row, each linked forwards at random.
fn genome(links: usize) -> Genome {
    let mut rng = Source { seed: 7, island: 0 }.stream(0, 0, Purpose::Genesis);
    let mut genome = Genome::default();
    let hidden: Vec<u64> = (0..links as u64 / 5).map(of_first).collect();
    for &marking in &hidden {
        genome.add_neuron(Neuron { marking, function: Function::Sigmoid });
    }
    let sources: Vec<u64> = SOCKETS.sources().collect();
    let outputs: Vec<u64> = SOCKETS.outputs().collect();
    let row: Vec<u64> = [&sources[..], &hidden, &outputs].concat();
    let draw = |from: usize, to: usize, rng: &mut Stream| rng.random_range(from..to);
    while genome.links.len() < links {
        let to = draw(sources.len(), row.len(), &mut rng);
        let from = draw(0, to.min(sources.len() + hidden.len()), &mut rng);
        if genome.link(row[from], row[to]).is_none() {
            let weight = rng.random_range(-1.0..1.0);
            genome.add_link(Link { from: row[from], to: row[to], weight, enabled: true });
        }
    }
    genome
}

/// What one would write first: a list of lists of links, walked neuron by neuron, with a new list of values each time.
struct Nested {
    order: Vec<usize>,
    arriving: Vec<Vec<(usize, f64)>>,
}

impl Nested {
    fn of(genome: &Genome) -> Self {
        let hidden = genome.neurons.iter().map(|neuron| neuron.marking);
        let all: Vec<u64> = SOCKETS.sources().chain(SOCKETS.outputs()).chain(hidden).collect();
        let place = |marking: u64| all.iter().position(|it| *it == marking).expect("it is there");
        let mut arriving = vec![Vec::new(); all.len()];
        for link in &genome.links {
            arriving[place(link.to)].push((place(link.from), link.weight));
        }
        let order = genome.forwards(SOCKETS).expect("its links lead forwards");
        Self { order: order.into_iter().map(place).collect(), arriving }
    }

    fn step(&self, inputs: &[f64]) -> Vec<f64> {
        let mut values = vec![0.0; self.arriving.len()];
        values[..inputs.len()].copy_from_slice(inputs);
        values[inputs.len()] = 1.0;
        for &place in &self.order {
            let sum: f64 =
                self.arriving[place].iter().map(|&(from, weight)| values[from] * weight).sum();
            values[place] = Function::Sigmoid.at(sum);
        }
        let first = inputs.len() + 1;
        values[first..first + SOCKETS.outputs as usize].to_vec()
    }
}
