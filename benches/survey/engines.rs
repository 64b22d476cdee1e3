//! How far the engines agree.

use super::statistics::rank_correlation;
use super::{LINKS_MAX, SEED, creatures, problem};
use islands::creature::Profile;
use islands::simulation::{Engine, Measurement, simulate};
use rayon::prelude::*;

/// Three of five bodies are small, as most are that evolve. None is of one gene: what lies still has no rank.
const GENES: [usize; 5] = [3, 3, 3, 6, 10];

/// Prints the rank correlation of what each engine and the engine of record say of the same creatures of the course.
/// Bodies that either of them gives up count as no pair.
pub fn survey(count: usize) {
    let problem = problem(Profile::Coursework);
    let (trial, creatures) = (problem.task.trial(), creatures(&problem, &GENES, count));
    let try_out = |engine| -> Vec<Option<Measurement>> {
        let tried = creatures.par_iter().with_max_len(1);
        tried.map(|(_, creature)| simulate(creature, &trial, engine).ok()).collect()
    };
    println!(
        "## Engines\n\n{count} random creatures of profile {}, of 3, 6 and 10 genes (3 to 1 to 1), at most {LINKS_MAX} links, \
         seed {SEED}, task {}: rank correlation (Spearman) with {}\n",
        problem.profile,
        problem.task,
        Engine::default()
    );
    println!("| engine | pairs | path | displacement |\n|---|---|---|---|");
    let record = try_out(Engine::default());
    for engine in Engine::ALL {
        let other = if engine == Engine::default() { record.clone() } else { try_out(engine) };
        let of = |what: fn(&Measurement) -> f64| -> Vec<(f64, f64)> {
            let both = record.iter().zip(&other);
            both.filter_map(|(a, b)| Some((what(a.as_ref()?), what(b.as_ref()?)))).collect()
        };
        let paths = of(|measured| measured.path_m);
        let displacements =
            of(|measured| (measured.root_last_m - measured.root_first_m).xy().norm());
        println!(
            "| {engine} | {} | {:.3} | {:.3} |",
            paths.len(),
            rank_correlation(&paths),
            rank_correlation(&displacements)
        );
    }
    println!();
}
