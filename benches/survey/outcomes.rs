//! How the evaluations of random creatures end.

use super::{GENES, LINKS_MAX, SEED, creatures, problem};
use islands::creature::{Gene, Profile};
use islands::evolution::{Outcome, Problem};
use islands::problems::Locomotion;
use islands::problems::outcomes;
use islands::simulation::Engine;

/// Prints how many ended how, by profile and engine.
///
/// # Panics
/// If an evaluation did.
pub fn survey(count: usize) {
    println!(
        "## Outcomes\n\n{count} random genomes of each profile, 1 to {} genes, at most {LINKS_MAX} links, \
         seed {SEED}; each profile's first task\n",
        GENES.len()
    );
    let names = outcomes::ALL.map(|outcome| outcome.to_string());
    println!("| profile | task | engine | {} |", names.join(" | "));
    println!("|---|---|---{}|", "|---".repeat(names.len()));
    let mut panics = 0;
    for profile in Profile::ALL {
        let creatures = creatures(&problem(profile), &GENES, count);
        let genomes: Vec<&[Gene]> = creatures.iter().map(|(genome, _)| genome.as_slice()).collect();
        for engine in Engine::ALL {
            let problem = Locomotion { engine, ..problem(profile) };
            let evaluations = problem.evaluate_batch(&genomes);
            let number =
                |outcome| evaluations.iter().filter(|tried| tried.outcome == outcome).count();
            let numbers = outcomes::ALL.map(|outcome| number(outcome).to_string());
            println!("| {profile} | {} | {engine} | {} |", problem.task, numbers.join(" | "));
            panics += number(Outcome::Panicked);
        }
    }
    println!();
    assert_eq!(panics, 0, "no genome may make an evaluation panic");
}
