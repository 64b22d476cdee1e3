//! How fast bodies are tried, by engine and the number of their links: simulation steps a second on one thread.
//!
//! `cargo bench --bench evaluation`

use criterion::{BenchmarkId, Criterion, SamplingMode, Throughput};
use islands::creature::{Course, Encoding, Gene};
use islands::evolution::{Outcome, Problem};
use islands::problems::{Locomotion, Task};
use islands::rng::{Purpose, Source};
use islands::simulation::Engine;
use std::time::Duration;

/// Default settings build at most 16.
const LINKS: [usize; 6] = [3, 6, 10, 15, 21, LINKS_MAX];
const LINKS_MAX: usize = 32;
/// Bodies of one size need not take the same time: so more than one of each.
const BODIES: usize = 3;
const SEED: u64 = 7;
const GENES_MAX: u32 = 12;

fn main() {
    let mut criterion = Criterion::default().configure_from_args();
    evaluation(&mut criterion);
    criterion.final_summary();
}

fn evaluation(criterion: &mut Criterion) {
    // This task alone has as many steps for every body.
    let problem = Locomotion {
        task: Task::Course,
        encoding: Course { genes: 1, links_max: LINKS_MAX, ..Course::DEFAULT },
        ..Locomotion::single(Engine::Featherstone)
    };
    let mut group = criterion.benchmark_group("evaluation");
    group
        .sample_size(10)
        .sampling_mode(SamplingMode::Flat)
        .warm_up_time(Duration::from_millis(200))
        .measurement_time(Duration::from_secs(3));
    for links in LINKS {
        let genomes = genomes_of(&problem, links);
        let steps = u64::from(problem.trial().steps()) * genomes.len() as u64;
        group.throughput(Throughput::Elements(steps));
        for engine in Engine::ALL {
            let problem = Locomotion { engine, ..problem.clone() };
            let id = BenchmarkId::new(engine.to_string(), links);
            group.bench_with_input(id, &genomes, |bencher, genomes| {
                bencher.iter(|| -> f64 {
                    genomes.iter().map(|genome| problem.evaluate(genome).fitness.get()).sum()
                });
            });
        }
    }
    group.finish();
}

/// The first random genomes whose bodies have exactly so many links and stay whole to the end.
fn genomes_of(problem: &Locomotion, links: usize) -> Vec<Vec<Gene>> {
    let source = Source { seed: SEED, island: 0 };
    let genome = |index: u32| {
        let genes = 1 + (index % GENES_MAX) as usize;
        let mut stream = source.stream(0, index, Purpose::Genesis);
        Course { genes, ..problem.encoding }.random_genome(&mut stream)
    };
    let is_right = |genome: &Vec<Gene>| {
        let creature = problem.express(genome).expect("a native body is never refused");
        creature.morphology.links.len() == links
            && problem.evaluate(genome).outcome == Outcome::Scored
    };
    (0..).map(genome).filter(is_right).take(BODIES).collect()
}
