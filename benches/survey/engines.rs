//! How far the engines agree.

use super::statistics::rank_correlation;
use super::{LINKS_MAX, SEED, creatures, problem};
use islands::creature::{Creature, Profile};
use islands::problems::Task;
use islands::simulation::trajectory::FRAMES_PER_S;
use islands::simulation::{Engine, Trajectory, Trial, film};
use rayon::prelude::*;

/// Three of five bodies are small, as most are that evolve. None is of one gene: what lies still has no rank.
const GENES: [usize; 5] = [3, 3, 3, 6, 10];

/// What is compared: an engine and its steps a second. That of record with steps half as long shows how much of a
/// difference is chaos: no engine can be expected to agree more than it does with itself.
const ROWS: [(Engine, u32); 3] =
    [(Engine::Rapier, 480), (Engine::Featherstone, 240), (Engine::Featherstone, 480)];

/// What a creature did, in metres.
#[derive(Clone, Copy)]
struct Motion {
    /// The length of its root's path over the ground, from positions 0.1 s apart: what other engines tell of a base.
    root_path_m: f64,
    /// The same of its centre of mass.
    path_m: f64,
    /// How far its root got over the ground.
    displacement_m: f64,
}

/// Prints the rank correlation of what each engine and the engine of record say of the same creatures of the course.
/// Bodies that either of them gives up count as no pair.
pub fn survey(count: usize) {
    let problem = problem(Profile::Coursework);
    let creatures = creatures(&problem, &GENES, count);
    let motions = |engine, steps_per_s| -> Vec<Option<Motion>> {
        let trial = Trial { steps_per_s, ..Task::Course.trial() };
        let tried = creatures.par_iter().with_max_len(1);
        tried.map(|(_, creature)| motion(creature, &trial, engine)).collect()
    };
    println!(
        "## Engines\n\n{count} random creatures of profile {}, of 3, 6 and 10 genes (3 to 1 to 1), at most {LINKS_MAX} links, \
         seed {SEED}, task course: rank correlation (Spearman) with rapier at 240 Hz\n",
        problem.encoding.profile,
    );
    println!("| engine | Hz | pairs | path of the root | of the centre of mass | displacement |");
    println!("|---|---|---|---|---|---|");
    let record = motions(Engine::Rapier, 240);
    for (engine, steps_per_s) in ROWS {
        let other = motions(engine, steps_per_s);
        let both: Vec<(Motion, Motion)> =
            record.iter().zip(&other).filter_map(|(a, b)| Some(((*a)?, (*b)?))).collect();
        let rank = |what: fn(&Motion) -> f64| -> f64 {
            let pairs: Vec<_> = both.iter().map(|(a, b)| (what(a), what(b))).collect();
            rank_correlation(&pairs)
        };
        println!(
            "| {engine} | {steps_per_s} | {} | {:.3} | {:.3} | {:.3} |",
            both.len(),
            rank(|motion| motion.root_path_m),
            rank(|motion| motion.path_m),
            rank(|motion| motion.displacement_m)
        );
    }
    println!();
}

fn motion(creature: &Creature, trial: &Trial, engine: Engine) -> Option<Motion> {
    let (measured, trajectory) = film(creature, trial, engine);
    let measured = measured.ok()?;
    Some(Motion {
        root_path_m: root_path_m(&trajectory),
        path_m: measured.path_m,
        displacement_m: (measured.root_last_m - measured.root_first_m).xy().norm(),
    })
}

fn root_path_m(trajectory: &Trajectory) -> f64 {
    let every = (FRAMES_PER_S / 10.0) as usize;
    let places: Vec<[f32; 3]> =
        trajectory.poses.iter().step_by(every).map(|poses| poses[0].position_m).collect();
    let legs = places.windows(2);
    legs.map(|leg| f64::from(libm::hypotf(leg[1][0] - leg[0][0], leg[1][1] - leg[0][1]))).sum()
}
