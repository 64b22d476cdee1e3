//! A few truths that every simulation must keep to, however its constants are tuned.

mod hand;

use crate::hostile::memory;
use islands::creature::encodings::course::PARAMETER_COUNT;
use islands::creature::{Course, Gene, Profile, Shape, express};
use islands::evolution::{Evaluation, Outcome, Problem};
use islands::problems::{Locomotion, Task};
use islands::rng::{Purpose, Source};
use islands::simulation::{self, Engine, Trajectory, Trial};
use std::collections::BTreeMap;

fn problem(profile: Profile, task: Task) -> Locomotion {
    let encoding = Course { profile, genes: 3, ..Course::DEFAULT };
    Locomotion { encoding, task, ..Locomotion::single(Engine::Rapier) }
}

/// Every profile in every task under every engine.
fn problems() -> impl Iterator<Item = Locomotion> {
    Profile::ALL.into_iter().flat_map(|profile| {
        Task::ALL.into_iter().flat_map(move |task| {
            Engine::ALL.map(|engine| Locomotion { engine, ..problem(profile, task) })
        })
    })
}

/// Genomes of one to so many genes.
fn random_genomes(count: u32, genes_max: usize) -> Vec<Vec<Gene>> {
    let genome = |index| {
        let genes = 1 + index as usize % genes_max;
        let encoding = Course { genes, ..Course::DEFAULT };
        let problem = Locomotion { encoding, ..problem(Profile::Native, Task::Walk) };
        problem.random_genome(&mut Source { seed: 31, island: 0 }.stream(
            0,
            index,
            Purpose::Genesis,
        ))
    };
    (0..count).map(genome).collect()
}

/// A gene without anything special, but for its shape.
fn plain_gene(shape: f64) -> Gene {
    let mut gene = Gene([0.5; PARAMETER_COUNT]);
    gene.0[0] = shape;
    gene
}

#[test]
fn a_link_falls_by_half_g_t_squared() {
    const STEP_S: f64 = 1.0 / 240.0;
    for course in problems().filter(|problem| problem.task == Task::Course) {
        let (_, film) = course.film(&[plain_gene(0.9)]).unwrap();
        let frames = film.times_s.iter().zip(&film.poses).take_while(|(t, _)| **t <= 0.4);
        for (t, poses) in frames {
            let [x, y, z] = poses[0].position_m.map(f64::from);
            let fallen = 2.5 - z;
            // A velocity that is constant over a step is wrong by at most that of half a step.
            let error = (fallen - 0.5 * 10.0 * t * t).abs();
            assert!(error <= 10.0 * t * STEP_S + 1e-6, "{fallen} m in {t} s");
            assert_eq!((x, y), (0.0, 0.0));
        }
    }
}

#[test]
fn a_box_that_nothing_drives_stays_where_it_lands() {
    for engine in Engine::ALL {
        let walk = Locomotion { engine, ..problem(Profile::Native, Task::Walk) };
        let scored = walk.evaluate(&[plain_gene(0.9)]);
        assert!(scored.fitness.finite().unwrap() < 0.01, "{engine}: {scored:?}");
    }
}

#[test]
fn a_solid_of_any_kind_comes_to_rest_on_its_side_or_foot() {
    let (radius_m, length_m) = (0.2, 0.5);
    // A native root lies along x: its own x axis points down.
    let half_extents_m = nalgebra::vector![0.1, 0.3, 0.3];
    let shapes = [
        (Shape::Cuboid { half_extents_m }, 0.1),
        (Shape::Cylinder { radius_m, length_m }, 0.2),
        (Shape::Sphere { radius_m }, 0.2),
        (Shape::Capsule { radius_m, length_m }, 0.2),
    ];
    let mut creature = express(&[plain_gene(0.1)], Profile::Native, 1).unwrap();
    for engine in Engine::ALL {
        for (shape, height_m) in shapes {
            creature.morphology.links[0].shape = shape;
            let (measured, film) = simulation::film(&creature, &Task::Walk.trial(), engine);
            measured.unwrap();
            let [.., z] = film.poses.last().unwrap()[0].position_m;
            assert!((f64::from(z) - height_m).abs() < 0.005, "{shape:?} rests at {z} m");
        }
    }
}

#[test]
fn the_middle_of_no_link_is_ever_below_the_ground() {
    for engine in Engine::ALL {
        let walk = Locomotion { engine, ..problem(Profile::Native, Task::Walk) };
        for genome in random_genomes(12, 3) {
            let (_, film) = walk.film(&genome).unwrap();
            let heights = film.poses.iter().flatten().map(|pose| pose.position_m[2]);
            let lowest = heights.fold(f32::INFINITY, f32::min);
            assert!(lowest > 0.0, "{engine}: {lowest}");
        }
    }
}

/// What a trial needs is asked for before its first step: one that ends before the body lands asks as often.
#[test]
fn our_own_engine_asks_for_no_memory_while_it_steps() {
    for genome in random_genomes(12, 6) {
        let creature = problem(Profile::Native, Task::Course).express(&genome).unwrap();
        let times = [0.25, 8.0].map(|scored_s| {
            let trial = Trial { scored_s, ..Task::Course.trial() };
            let try_out = || _ = simulation::simulate(&creature, &trial, Engine::Featherstone);
            memory::times_in(try_out)
        });
        assert!(times[0] > 0 && times[0] == times[1], "{times:?}");
    }
}

/// All that is known of a trial, as bits.
fn bits(evaluation: Evaluation, film: &Trajectory) -> Vec<u64> {
    let poses = film.poses.iter().flatten();
    let numbers = poses.flat_map(|pose| pose.position_m.into_iter().chain(pose.rotation_xyzw));
    let fitness = evaluation.fitness.get().to_bits();
    std::iter::once(fitness).chain(numbers.map(|number| number.to_bits().into())).collect()
}

#[test]
fn a_creature_moves_by_the_same_bits_again_on_any_thread_and_among_others() {
    let genomes = random_genomes(4, 3);
    for walk in problems().filter(|problem| problem.task == Task::Walk) {
        let film = |genome: &Vec<Gene>| {
            let (evaluation, film) = walk.film(genome).unwrap();
            bits(evaluation, &film)
        };
        let once: Vec<_> = genomes.iter().map(film).collect();
        let at_once: Vec<_> = std::thread::scope(|scope| {
            let threads: Vec<_> = genomes.iter().map(|g| scope.spawn(move || film(g))).collect();
            threads.into_iter().map(|thread| thread.join().unwrap()).collect()
        });
        assert!(once == at_once, "{walk:?}");
    }
}

#[test]
fn a_creature_scores_the_same_whether_it_is_filmed_or_not() {
    for problem in problems().filter(|problem| problem.encoding.profile == Profile::Native) {
        for genome in random_genomes(4, 3) {
            let (filmed, _) = problem.film(&genome).unwrap();
            let scored = problem.evaluate(&genome);
            assert_eq!(filmed.fitness.get().to_bits(), scored.fitness.get().to_bits());
            assert_eq!(filmed.outcome, scored.outcome);
        }
    }
}

#[test]
fn random_creatures_end_in_a_score_or_a_named_failure_and_never_in_a_panic() {
    let small = random_genomes(200, 3);
    // Profile coursework does not cut bodies, which takes hundreds of links, and minutes.
    let large = random_genomes(60, 10);
    for engine in Engine::ALL {
        for (genomes, profiles) in [(&small, &Profile::ALL[..]), (&large, &Profile::ALL[..2])] {
            let genomes: Vec<&[Gene]> = genomes.iter().map(Vec::as_slice).collect();
            for &profile in profiles {
                let problem = Locomotion { engine, ..problem(profile, Task::Walk) };
                let evaluations = problem.evaluate_batch(&genomes);
                evaluations.iter().for_each(assert_sound);
                let mut outcomes = BTreeMap::new();
                for evaluation in &evaluations {
                    *outcomes.entry(evaluation.outcome).or_insert(0) += 1;
                }
                let found = format!("{profile} in {engine}: {outcomes:?}");
                eprintln!("{found}");
                assert!(!outcomes.contains_key(&Outcome::Panicked), "{found}");
                // What random bodies of our own profiles do is nearly always sound.
                let is_ours = profile != Profile::Coursework;
                assert!(
                    !is_ours || outcomes[&Outcome::Scored] * 20 >= genomes.len() * 19,
                    "{found}"
                );
            }
        }
    }
}

fn assert_sound(evaluation: &Evaluation) {
    let Evaluation { fitness, outcome } = *evaluation;
    assert!(!fitness.get().is_nan());
    assert_eq!(fitness.finite().is_some(), outcome == Outcome::Scored, "{evaluation:?}");
}

/// Bodies that once flew off or stopped being numbers: a base under a gram that carries a kilogram, links
/// of a few micrograms.
#[test]
fn bodies_that_once_blew_up_pass_for_no_athletes() {
    let genomes: BTreeMap<String, Vec<Gene>> =
        serde_json::from_str(include_str!("../fixtures/physics/bad_genomes.json")).unwrap();
    assert_eq!(genomes.len(), 5);
    for (name, genome) in &genomes {
        for problem in problems() {
            let evaluation = problem.evaluate(genome);
            let place = format!("{name} in {problem:?}: {evaluation:?}");
            assert_sound(&evaluation);
            assert_ne!(evaluation.outcome, Outcome::Panicked, "{place}");
            assert!(evaluation.fitness.finite().is_none_or(|score| score < 50.0), "{place}");
        }
    }
}
