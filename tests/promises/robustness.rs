//! Scores of several perturbed trials: what they come to, and that a run, its film and its verifier agree on them.

use crate::support::World;
use islands::archipelago::Champion;
use islands::creature::{
    Controller, Course, Creature, Gene, Joint, JointKind, Link, Morphology, Motor, Shape, Wave,
    Waveform,
};
use islands::evolution::{Evaluation, Fitness, Hurdles, Outcome, Problem};
use islands::problems::{Locomotion, RobustBy, Robustness, Task};
use islands::rng::{Purpose, Source};
use islands::runs::config::Config;
use islands::simulation::{self, Engine, Failure};
use islands::store::{RecordLog, RunDir};
use nalgebra::{Isometry3, UnitQuaternion, Vector3};

const TINY: &str = "--population 4 --generations 3 --genes 2 --migration-interval 1";

fn genome(genes: usize, index: u32) -> Vec<Gene> {
    let problem =
        Locomotion { encoding: Course { genes, ..Course::DEFAULT }, ..Locomotion::DEFAULT };
    problem.random_genome(&mut Source { seed: 83, island: 0 }.stream(0, index, Purpose::Genesis))
}

fn robust(trials: u32, by: RobustBy, engine: Engine) -> Locomotion {
    let robustness = Robustness { trials, by };
    Locomotion { robustness, judged: false, engine, ..Locomotion::DEFAULT }
}

/// What a genome gets in one perturbed trial after another.
fn one_by_one(trials: u32, genome: &[Gene], engine: Engine) -> Vec<Evaluation> {
    let creature = Locomotion::DEFAULT.express(genome).unwrap();
    let evaluation = |index| {
        let trial = Task::Walk.trial_in(engine).perturbed(index);
        let score = |measured| Evaluation::scored(Task::Walk.score(&measured));
        simulation::simulate(&creature, &trial, engine).map_or_else(Evaluation::failed, score)
    };
    (0..trials).map(evaluation).collect()
}

#[test]
fn a_robust_score_is_what_its_name_says_of_the_perturbed_trials() {
    let mut differ = 0;
    for engine in Engine::ALL {
        for index in 0..4 {
            let genome = genome(3, index);
            let scores = one_by_one(12, &genome, engine);
            let scores: Vec<f64> = scores.iter().map(|one| one.fitness.finite().unwrap()).collect();
            let found = RobustBy::ALL
                .map(|by| robust(3, by, engine).evaluate(&genome).fitness.finite().unwrap());
            assert_eq!(found, RobustBy::ALL.map(|by| by.of(&scores)));
            let [worst, .., mean] = found;
            assert_eq!(worst, scores.iter().copied().fold(f64::MAX, f64::min));
            assert_eq!(mean, scores.iter().sum::<f64>() / 12.0);
            assert!(worst <= mean);
            differ += usize::from(worst < mean);
        }
    }
    assert_eq!(differ, 8, "perturbations that change nothing");
}

/// A heavy trunk with an arm on top, whose motor brings it to 50 m/s in eight seconds if it gives a little more than it
/// usually has.
fn sling() -> Creature {
    let cuboid = |half_m: [f64; 3], mass_kg, joint| Link {
        shape: Shape::Cuboid { half_extents_m: half_m.into() },
        mass_kg,
        inertia: None,
        joint,
    };
    let joint = Joint {
        parent: 0,
        parent_from_joint: Isometry3::translation(0.0, 0.0, 0.6),
        joint_from_link: Isometry3::translation(1.0, 0.0, 0.0),
        kind: JointKind::Revolute(Vector3::z()),
    };
    let wave = Wave {
        waveform: Waveform::Pulse,
        amplitude_rad_s: 1_000.0,
        phase_start_rad: 0.0,
        phase_step_rad: 0.0,
    };
    let motor = Motor { torque_nm_max: 6.25 };
    let links =
        vec![cuboid([1.0, 1.0, 0.5], 1e5, None), cuboid([0.1, 0.1, 0.05], 1.0, Some(joint))];
    Creature {
        morphology: Morphology { links, root_rotation: UnitQuaternion::identity() },
        controller: Controller::of_waves(0.1, [None, Some((motor, wave))]),
    }
}

#[test]
fn whoever_fails_in_one_perturbed_trial_has_failed() {
    for engine in Engine::ALL {
        let tried = |index| {
            let trial = Task::Walk.trial_in(engine).perturbed(index);
            simulation::simulate(&sling(), &trial, engine).err()
        };
        let found: Vec<Option<Failure>> = (0..4).map(tried).collect();
        assert!(found.contains(&None) && found.contains(&Some(Failure::TooFast)), "{found:?}");
        for by in RobustBy::ALL {
            let (evaluation, _) = robust(4, by, engine).film_body(&sling());
            assert_eq!(evaluation, Evaluation::failed(Failure::TooFast));
        }
        let (usual, _) = robust(0, RobustBy::Worst, engine).film_body(&sling());
        assert_eq!(usual.outcome, Outcome::Scored);
    }
}

#[test]
fn a_film_has_the_score_of_all_trials_and_shows_the_one_that_is_nearest_to_it() {
    for engine in Engine::ALL {
        let problem = robust(3, RobustBy::Worst, engine);
        let genome = genome(3, 0);
        let (evaluation, film) = problem.film(&genome).unwrap();
        assert_eq!(evaluation, problem.evaluate(&genome));
        let scores = one_by_one(12, &genome, engine);
        let worst = scores.iter().position(|score| *score == evaluation).unwrap() as u32;
        let creature = problem.express(&genome).unwrap();
        let trial = Task::Walk.trial_in(engine).perturbed(worst);
        assert!(film == simulation::film(&creature, &trial, engine).1, "{engine}");
    }
}

#[test]
fn a_score_that_the_judge_does_not_confirm_is_what_it_finds() {
    let mut lowered = 0;
    for engine in Engine::ALL {
        for index in 0..6 {
            let genome = genome(3, index);
            let own = robust(4, RobustBy::Mean, engine);
            let score = |problem: &Locomotion| problem.evaluate(&genome).fitness;
            let creature = own.express(&genome).unwrap();
            let others = [16, 17, 18, 19].map(|index| {
                let trial = Task::Walk.trial_in(engine.judge()).perturbed(index);
                let measured = simulation::simulate(&creature, &trial, engine.judge()).unwrap();
                Task::Walk.score(&measured)
            });
            let other = Fitness::new(RobustBy::Mean.of(&others));
            let judged = score(&Locomotion { judged: true, ..own.clone() });
            let is_confirmed = other.get() >= 0.85 * score(&own).get();
            let expected = if is_confirmed { score(&own) } else { other };
            assert_eq!(judged, expected, "{engine}");
            lowered += usize::from(judged < score(&own));
        }
    }
    assert!((1..12).contains(&lowered), "{lowered}");
}

/// The means of a genome's first trials in featherstone, of all prefixes, and of one to four of rapier's as a judge.
fn means(genome: &[Gene]) -> (Vec<Fitness>, Vec<Fitness>) {
    let prefixes = |scores: &[f64]| {
        let mean = |trials: usize| Fitness::new(RobustBy::Mean.of(&scores[..trials]));
        (0..=scores.len()).map(mean).collect()
    };
    let scores = one_by_one(20, genome, Engine::Featherstone);
    let scores: Vec<f64> = scores.iter().map(|one| one.fitness.get()).collect();
    let creature = Locomotion::DEFAULT.express(genome).unwrap();
    let judged = [20, 21, 22, 23].map(|index| {
        let trial = Task::Walk.trial_in(Engine::Rapier).perturbed(index);
        Task::Walk.score(&simulation::simulate(&creature, &trial, Engine::Rapier).unwrap())
    });
    (prefixes(&scores), prefixes(&judged))
}

#[test]
fn who_fails_at_a_hurdle_has_the_estimate_of_the_trials_until_then() {
    let problem = Locomotion { judged: true, ..robust(5, RobustBy::Mean, Engine::Featherstone) };
    let found = (0..12).map(|index| (genome(3, index), means(&genome(3, index))));
    let is_refuted = |own: &[Fitness], judged: &[Fitness]| {
        judged[1..].iter().all(|it| it.get() < 0.85 * own[20].get())
    };
    let mut refuted = found.filter(|(_, (own, judged))| is_refuted(own, judged));
    let (genome, (own, judged)) = refuted.next().expect("a luckier one");

    let looks = [own[1], own[2], own[4]];
    let estimate = |hurdles: Hurdles| problem.estimate(&genome, &hurdles).fitness;
    for index in 0..3 {
        let mut hurdles = Hurdles { looks, ..Hurdles::LAST };
        hurdles.looks[index] = Fitness::new(looks[index].get() + 1e-9);
        assert_eq!(estimate(hurdles), looks[index], "look {index}");
    }
    assert_eq!(estimate(Hurdles { looks, ..Hurdles::LAST }), own[5], "usual trials for all");
    let best_of = |best| estimate(Hurdles { looks, best });
    let after = [own[5], own[10], own[15], own[20]].into_iter().chain(judged[1..].to_vec());
    let mut lows: Vec<Fitness> = Vec::new();
    for so_far in after.clone() {
        if lows.last().is_none_or(|lowest| so_far < *lowest) {
            assert_eq!(best_of(so_far), so_far, "it stops as soon as it is known as no better");
            lows.push(so_far);
        }
    }
    assert!(lows.len() > 2, "{lows:?}");
    let whole = judged[4];
    assert_eq!(problem.evaluate(&genome).fitness, whole);
    assert_eq!(best_of(lows.last().unwrap().just_below()), whole);
    let possible = problem.possible_scores(&genome);
    let expected = looks.into_iter().chain(after);
    assert!(possible.iter().all(|score| expected.clone().any(|it| it == *score)), "{possible:?}");
    let is_possible = |score: &Fitness| possible.contains(score);
    assert!(looks.iter().chain(&lows).chain([&whole]).all(is_possible), "{possible:?}");
    assert_eq!(possible.last(), Some(&whole));
}

#[test]
fn fresh_trials_are_perturbed_otherwise_than_those_that_are_selected_on() {
    let genome = genome(3, 0);
    let problem = robust(16, RobustBy::Mean, Engine::Featherstone);
    let creature = problem.express(&genome).unwrap();
    let fresh = problem.validate_body(&creature, Engine::Featherstone, 32);
    assert_eq!(problem.validate(&genome), Some(Fitness::new(fresh.mean)));
    assert_ne!(problem.validate(&genome), Some(problem.evaluate(&genome).fitness));
    assert!(fresh.worst < fresh.mean && fresh.sd > 0.0 && fresh.failed == 0, "{fresh:?}");
    let threads = rayon::ThreadPoolBuilder::new().num_threads(3).build().unwrap();
    let shared = threads.install(|| problem.validate_body(&creature, Engine::Featherstone, 32));
    assert_eq!(shared, fresh, "who tries them changes no bit");
}

#[test]
fn a_robust_evaluation_costs_all_of_its_trials() {
    let genome = genome(3, 0);
    let links = Locomotion::DEFAULT.express(&genome).unwrap().morphology.links.len() as u64;
    let trials = (0..5).map(|index| Task::Walk.trial_in(Engine::Rapier).perturbed(index));
    let steps: u64 = trials.map(|trial| u64::from(trial.steps())).sum();
    let problem = robust(5, RobustBy::Worst, Engine::Rapier);
    assert_eq!(problem.cost(&genome), links * steps);
    assert_eq!(problem.steps(), steps);
}

fn ball() -> Creature {
    let ball =
        Link { shape: Shape::Sphere { radius_m: 0.2 }, mass_kg: 5.0, inertia: None, joint: None };
    Creature {
        morphology: Morphology { links: vec![ball], root_rotation: UnitQuaternion::identity() },
        controller: Controller::of_waves(0.1, [None]),
    }
}

/// A ball rolls on for ever, and whoever pushes it moves it by metres.
#[test]
fn a_ball_gains_nothing_by_being_pushed() {
    let body = ball();
    for engine in Engine::ALL {
        let moved_m = |index| {
            let trial = Task::Walk.trial_in(engine).perturbed(index);
            let measured = simulation::simulate(&body, &trial, engine).unwrap();
            (measured.centre_last_m - measured.centre_first_m).xy().norm()
        };
        assert!((0..6).map(moved_m).fold(0.0, f64::max) > 0.3);
        let (evaluation, _) = robust(6, RobustBy::Mean, engine).film_body(&body);
        let score = evaluation.fitness.finite().unwrap();
        assert!(score < 0.01, "{engine}: {score} m");
    }
}

/// The course's measure has no halves, so that a push would count in full.
#[test]
fn nobody_is_pushed_in_the_course() {
    let body = ball();
    for engine in Engine::ALL {
        let score = |trials| {
            let problem =
                Locomotion { task: Task::Course, ..robust(trials, RobustBy::Mean, engine) };
            problem.film_body(&body).0.fitness.finite().unwrap()
        };
        let gained_m = score(6) - score(0);
        assert!(gained_m.abs() < 0.01, "{engine}: {gained_m} m");
    }
}

#[test]
fn what_a_run_says_of_robust_champions_is_what_everybody_else_finds() {
    let world = World::new();
    let wish = "--engine featherstone --robustness 2 --robust-by mean";
    let result = world.json(&format!("--n 2 --seed 3 --out run --json --view off {wish} {TINY}"));
    let dir = RunDir::at(world.path("run"));
    let problem = Config::read(&dir.config()).unwrap().locomotion();
    assert_eq!(problem.robustness, Robustness { trials: 2, by: RobustBy::Mean });
    for island in 0..2 {
        let log = RecordLog::<Champion<Gene>>::read(&dir.champions(island)).unwrap();
        for champion in &log.records {
            let genome = &champion.individual.genome;
            assert_eq!(champion.individual.fitness, problem.evaluate(genome).fitness);
            assert_eq!(champion.validated, problem.validate(genome));
        }
    }
    // The monitor filmed them, and found what they were reported with.
    assert!(!world.read("run/run.log").contains("WARNING"));
    let scores = world.json(&format!("evaluate run/champion.csv --json {wish}"));
    assert_eq!(scores["genomes"][0]["fitness"], result["best_fitness"], "{scores}");
    let plainly = world.json("evaluate run/champion.csv --json --robustness 0");
    assert_ne!(plainly["genomes"][0]["fitness"], result["best_fitness"], "{plainly}");
    let verified = world.islands("verify run --thorough --json");
    assert_eq!(verified.code, Some(0), "{verified:?}");
    world.assert_left_nothing();
}

#[cfg(feature = "view")]
#[test]
fn a_replay_shows_robust_scores_as_the_run_had_them_and_others_if_it_is_told_to() {
    let world = World::new();
    let wish = "--engine featherstone --robustness 2 --robust-by mean";
    let result = world.json(&format!("--n 1 --seed 3 --out run --json --no-monitor {wish} {TINY}"));
    let shown = |what: &str| {
        let ending = world.islands(&format!("replay {what}"));
        assert_eq!((ending.code, ending.stderr.as_str()), (Some(0), ""), "{ending:?}");
        ending.stdout.contains(&format!("{:.3} m", result["best_fitness"].as_f64().unwrap()))
    };
    assert!(shown("run"));
    assert!(shown("run --ancestry"));
    assert!(shown(&format!("run/champion.csv {wish}")));
    assert!(!shown("run --robustness 0"));
    assert!(!shown("run/champion.csv --robustness 0"));
    let said = world.refusal("replay run/champion.csv --robustness 101");
    assert!(said.contains("robustness must be from 0 to 100"), "{said}");
}

#[cfg(feature = "view")]
#[test]
fn the_film_that_a_run_names_gets_what_the_run_got() {
    let world = World::new();
    for wish in [
        "--robustness 2 --robust-by mean --max-links 3",
        "--profile coursework --scale link-length=0.4",
    ] {
        let run = world.islands(&format!("--n 1 --seed 3 --out run --no-monitor {wish} {TINY}"));
        let line = |begins: &str| {
            let found = run.stdout.lines().find_map(|line| line.strip_prefix(begins));
            found.unwrap_or_else(|| panic!("{run:?}")).to_owned()
        };
        let [best, film] = ["best ", "film     islands "].map(line);
        let score = best.trim().split(',').next().unwrap();
        let ending = world.islands(&film);
        assert!(ending.stdout.contains(score), "{film}: {ending:?}, not {score}");
        std::fs::remove_dir_all(world.path("run")).unwrap();
    }
}

#[test]
fn a_run_goes_on_with_the_robustness_that_it_has_and_no_other() {
    let world = World::new();
    let run = |folder: &str, generations: u32| {
        let settings = "--n 1 --seed 5 --population 4 --genes 2 --robustness 2 --quiet --json";
        world.json(&format!("--out {folder} --generations {generations} --no-monitor {settings}"))
    };
    run("short", 2);
    let resumed = world.json("resume short --generations 4 --no-monitor --quiet --json");
    assert_eq!(resumed["digest"], run("long", 4)["digest"]);
    for (wish, reason) in [
        ("resume short --robustness 3", "robustness is 2, not 3"),
        ("resume short --robust-by worst", "robust-by is \"quartile\", not \"worst\""),
        ("resume short --judged", "judged is false, not true"),
        ("--robustness 101", "robustness must be from 0 to 100, not 101"),
        ("evaluate short/champion.csv --robustness 101", "robustness must be from 0 to 100"),
    ] {
        let said = world.refusal(wish);
        assert!(said.contains(reason), "{said}");
    }
}
