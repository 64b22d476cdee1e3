//! What random creatures come to: how their evaluations end, what the length of a step does to them, and how far
//! the engines agree about them. On all threads; the figures are the same on every machine.
//!
//! `cargo bench --bench survey`, or one part of it: `cargo bench --bench survey -- outcomes` (or `rates`, `engines`)

#![expect(clippy::print_stdout, reason = "the tables are what it is for")]

mod engines;
mod outcomes;
mod rates;
mod statistics;

use islands::creature::{Course, Creature, Encoding, Gene, Profile};
use islands::problems::{Locomotion, Task};
use islands::rng::{Purpose, Source};
use islands::simulation::Engine;

/// How much is surveyed.
struct Size {
    outcomes: usize,
    rates: usize,
    engines: usize,
}

const WHOLE: Size = Size { outcomes: 2000, rates: 300, engines: 200 };
/// As criterion's benches have it: everything once, to see that it works.
const TRIAL: Size = Size { outcomes: 6, rates: 2, engines: 4 };

const SEED: u64 = 2000;
/// As many genomes of one gene as of each other number up to ten.
const GENES: [usize; 10] = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10];
/// Larger bodies are passed over: those of profile `coursework`, which never cuts, have hundreds of links.
const LINKS_MAX: usize = 32;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let has = |name: &str| arguments.iter().any(|argument| argument == name);
    let size = if has("--test") { TRIAL } else { WHOLE };
    let all = !["outcomes", "rates", "engines"].into_iter().any(has);
    let is_wanted = |part| all || has(part);
    if is_wanted("outcomes") {
        outcomes::survey(size.outcomes);
    }
    if is_wanted("rates") {
        rates::survey(size.rates);
    }
    if is_wanted("engines") {
        engines::survey(size.engines);
    }
}

/// Random genomes of so many genes in turn, and their bodies.
fn creatures(problem: &Locomotion, genes: &[usize], count: usize) -> Vec<(Vec<Gene>, Creature)> {
    let source = Source { seed: SEED, island: 0 };
    let genome = |index: u32| {
        let genes = genes[index as usize % genes.len()];
        let mut stream = source.stream(0, index, Purpose::Genesis);
        Course { genes, ..problem.encoding }.random_genome(&mut stream)
    };
    let express = |genome: Vec<Gene>| {
        let creature = problem.express(&genome).ok()?;
        (creature.morphology.links.len() <= LINKS_MAX).then_some((genome, creature))
    };
    (0..).map(genome).filter_map(express).take(count).collect()
}

fn problem(profile: Profile) -> Locomotion {
    let task = match profile {
        Profile::Native | Profile::Lecture => Task::Walk,
        Profile::Coursework => Task::Course,
    };
    let single = Locomotion::single(Engine::Featherstone);
    let encoding = Course { profile, links_max: LINKS_MAX, ..Course::DEFAULT };
    Locomotion { encoding, task, ..single }
}
