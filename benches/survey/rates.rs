//! What the length of a step does to random native creatures.
//!
//! Most bodies on the ground are chaotic, so that any change of the step changes where they end. What counts is how
//! much more a long step changes than one that is as fine as anybody computes: hence two reference rates.

use super::statistics::{quantile, rank_correlation};
use super::{GENES, SEED, creatures, problem};
use islands::creature::{Creature, Profile};
use islands::problems::Task;
use islands::simulation::stability::Ledger;
use islands::simulation::{Engine, Failure, Guards, Measurement, Trajectory, Trial, film};
use nalgebra::Vector3;
use rayon::prelude::*;

const RATES_HZ: [u32; 4] = [960, 480, 240, 120];
/// All others are held against this one.
const REFERENCE_HZ: u32 = 480;
const TASKS: [Task; 2] = [Task::Walk, Task::Travel];

/// What a trial came to.
struct Tried {
    result: Result<Measurement, Failure>,
    /// Speed that it gained out of nothing, in m/s.
    excess_m_s: f64,
}

/// Prints how evaluations end, how scores change and how much momentum comes from nothing, by rate.
pub fn survey(count: usize) {
    let creatures = creatures(&problem(Profile::Native), &GENES, count);
    println!(
        "## Steps a second\n\n{count} random native creatures, 1 to {} genes, seed {SEED}, against \
         {REFERENCE_HZ} Hz: rank correlation (Spearman), median and 90th percentile of the change of the score; speed \
         gained out of nothing\n",
        GENES.len()
    );
    println!(
        "| engine | Hz | scored | walk: ranks | median | p90 | travel: ranks | median | p90 | excess p99 | worst, \
         m/s |\n|---|---|---|---|---|---|---|---|---|---|---|"
    );
    for engine in Engine::ALL {
        let tried = RATES_HZ.map(|rate_hz| (rate_hz, try_all(&creatures, rate_hz, engine)));
        let (_, reference) =
            tried.iter().find(|(rate, _)| *rate == REFERENCE_HZ).expect("it is one of the rates");
        for (rate_hz, tried) in &tried {
            let scored = tried.iter().filter(|tried| tried.result.is_ok()).count();
            let changes = TASKS.map(|task| change(task, reference, tried));
            let excesses: Vec<f64> = tried.iter().map(|tried| tried.excess_m_s).collect();
            println!(
                "| {engine} | {rate_hz} | {scored} | {} | {:.4} | {:.4} |",
                changes.join(" | "),
                quantile(&excesses, 0.99),
                quantile(&excesses, 1.0)
            );
        }
    }
    println!();
}

type Creatures = [(Vec<islands::creature::Gene>, Creature)];

fn try_all(creatures: &Creatures, steps_per_s: u32, engine: Engine) -> Vec<Tried> {
    // The ledger is read here, and must refuse nobody before.
    let guards = Guards { keeps_ledger: false, ..Guards::ALL };
    let trial = Trial { steps_per_s, guards, ..Task::Walk.trial() };
    let try_out = |(_, creature): &(_, Creature)| {
        let (result, film) = film(creature, &trial, engine);
        Tried { result, excess_m_s: excess_m_s(creature, &trial, &film) }
    };
    creatures.par_iter().with_max_len(1).map(try_out).collect()
}

/// Frames of a film that are one entry in the ledger: 0.1 s.
const FRAMES: usize = 6;

fn excess_m_s(creature: &Creature, trial: &Trial, film: &Trajectory) -> f64 {
    let scored = film.times_s.partition_point(|time_s| *time_s < film.scoring_from_s);
    let links = &creature.morphology.links;
    let mass_kg: f64 = links.iter().map(|link| link.mass_kg).sum();
    let mut centres_m =
        film.poses[scored.min(film.poses.len())..].iter().step_by(FRAMES).map(|poses| {
            let moment = |(link, pose): (&islands::creature::Link, &islands::simulation::Pose)| {
                link.mass_kg * Vector3::from(pose.position_m).cast::<f64>()
            };
            links.iter().zip(poses).map(moment).sum::<Vector3<f64>>() / mass_kg
        });
    let Some(first_m) = centres_m.next() else { return 0.0 };
    let mut ledger = Ledger::new(trial, trial.steps_per_s / 10, first_m, Vector3::zeros());
    // A body that goes over the limit goes on, to see how far.
    for centre_m in centres_m {
        let _ = ledger.enter(centre_m);
    }
    ledger.excess_m_s()
}

/// A row's three columns for a task.
fn change(task: Task, reference: &[Tried], tried: &[Tried]) -> String {
    let score = |tried: &Tried| tried.result.as_ref().ok().map(|measured| task.score(measured));
    let both = reference.iter().zip(tried);
    let pairs: Vec<(f64, f64)> = both.filter_map(|(a, b)| Some((score(a)?, score(b)?))).collect();
    let changes: Vec<f64> = pairs.iter().map(|(a, b)| (a - b).abs()).collect();
    let ranks = rank_correlation(&pairs);
    format!("{ranks:.3} | {:.3} | {:.3}", quantile(&changes, 0.5), quantile(&changes, 0.9))
}
