//! Creatures on terrains: they climb, what is no climbing gains nothing, and a run keeps what it stood on.

use crate::formats::course::fixture;
use crate::support::{TINY, World};
use islands::archipelago::lockstep;
use islands::creature::{Controller, Creature, Link, Morphology, Shape};
use islands::evolution::{Evaluation, Problem};
use islands::formats::terrain;
use islands::problems::{Locomotion, RobustBy, Robustness, Task};
use islands::rng::{Purpose, Source};
use islands::runs::config::Config;
use islands::simulation::terrain::mountain;
use islands::simulation::{Engine, simulate};
use islands::store::RunDir;
use nalgebra::{UnitQuaternion, vector};
use std::fs;
use std::sync::Arc;

/// A pillar that stands on its end.
fn pillar(height_m: f64) -> Creature {
    let link = Link {
        shape: Shape::Cuboid { half_extents_m: vector![0.3, 0.3, height_m / 2.0] },
        mass_kg: 5.0,
        inertia: None,
        joint: None,
    };
    let root_rotation = UnitQuaternion::identity();
    Creature {
        morphology: Morphology { links: vec![link], root_rotation },
        controller: Controller::of_waves(0.1, [None]),
    }
}

fn random_genomes(problem: &Locomotion, count: u32) -> Vec<Vec<islands::creature::Gene>> {
    let source = Source { seed: 12, island: 0 };
    (0..count)
        .map(|index| problem.random_genome(&mut source.stream(0, index, Purpose::Genesis)))
        .collect()
}

#[test]
fn what_is_tall_or_falls_over_uphill_has_climbed_nothing() {
    for engine in Engine::ALL {
        for height_m in [0.2, 1.0, 2.0, 3.0] {
            let measured = simulate(&pillar(height_m), &Task::Climb.trial(), engine).unwrap();
            let score = Task::Climb.score(&measured);
            assert!(score < 0.005, "{engine}: {score} m of a pillar of {height_m} m");
        }
    }
}

#[test]
fn who_is_in_the_air_is_as_high_as_the_ground_below() {
    for engine in Engine::ALL {
        let drop = islands::simulation::Trial {
            start: islands::simulation::Start::LowestAt(2.0),
            settle_s: 0.0,
            scored_s: 0.3,
            ..Task::Climb.trial()
        };
        let measured = simulate(&pillar(0.4), &drop, engine).unwrap();
        let below_m = mountain().height_m(measured.centre_first_m.x, measured.centre_first_m.y);
        assert!(measured.centre_last_m.z > below_m + 1.0, "{engine}: it is in the air");
        for height_m in measured.heights_m {
            assert!((height_m - below_m).abs() < 0.01, "{engine}: {height_m}, not {below_m}");
        }
    }
}

#[test]
fn random_creatures_stay_on_the_mountain_or_are_refused_and_climb_next_to_nothing() {
    for engine in Engine::ALL {
        let problem = Locomotion { task: Task::Climb, ..Locomotion::single(engine) };
        let mut refused = 0;
        for genome in random_genomes(&problem, 40) {
            let creature = problem.express(&genome).unwrap();
            let Ok(measured) = simulate(&creature, &problem.trial(), engine) else {
                refused += 1;
                continue;
            };
            let last_m = measured.centre_last_m;
            assert!(mountain().holds(last_m.x, last_m.y), "{engine}: {last_m}");
            assert!(last_m.z > mountain().height_m(last_m.x, last_m.y) - 0.3, "{engine}: {last_m}");
            let score = Task::Climb.score(&measured);
            assert!((0.0..0.3).contains(&score), "{engine}: {score}");
        }
        assert!(refused <= 2, "{engine}: {refused} refused");
    }
}

#[test]
fn perturbed_trials_are_on_the_terrain() {
    for engine in Engine::ALL {
        let usual = Locomotion { terrain: Some(mountain()), ..Locomotion::single(engine) };
        let robustness = Robustness { trials: 1, by: RobustBy::Mean };
        let robust = Locomotion { robustness, ..usual.clone() };
        for genome in random_genomes(&usual, 4) {
            let creature = usual.express(&genome).unwrap();
            let scores = (0..4).map(|index| {
                let measured = simulate(&creature, &usual.trial().perturbed(index), engine);
                assert!(measured.iter().all(|it| !it.heights_m.is_empty()), "{engine}");
                measured.map(|measured| usual.task.score(&measured))
            });
            let scores: Result<Vec<f64>, _> = scores.collect();
            let score = scores.map(|scores| robustness.by.of(&scores));
            let expected = score.map_or_else(Evaluation::failed, Evaluation::scored);
            assert_eq!(robust.evaluate(&genome), expected, "{engine}");
            assert_eq!(robust.film(&genome).unwrap().0, expected, "{engine}");
        }
    }
}

#[test]
fn evolving_gains_height() {
    let config = Config {
        islands: 1,
        seed: Some(1),
        population: 16,
        generations: 10,
        migrants: 0,
        task: Task::Climb,
        robustness: 0,
        judged: false,
        ..Config::default()
    };
    let mut best = Vec::new();
    lockstep::run(&config.locomotion(), &config.archipelago(), config.generations, |step| {
        best.push(step.report.statistics.best.finite().unwrap_or(0.0));
    });
    let (first, last) = (best[0], best[best.len() - 1]);
    assert!(last > 0.01 && last > 3.0 * first, "{best:?}");
}

/// A world with a genome and an image of a valley.
fn valley() -> World {
    let world = World::new();
    let shades: Vec<u8> = (0..21 * 21).map(|i| ((i % 21 - 10_i32).pow(2) * 2) as u8).collect();
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, 21, 21);
    encoder.set_color(png::ColorType::Grayscale);
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(&shades).unwrap();
    writer.finish().unwrap();
    world.write("valley.png", file);
    world.write("genome.csv", fixture("genome_0.csv"));
    world
}

#[test]
fn a_run_keeps_the_terrain_that_it_was_on_and_everybody_uses_it() {
    let world = valley();
    let settings = format!("--n 2 --seed 3 --task walk --engine featherstone {TINY}");
    let on_it = format!("{settings} --terrain valley.png --terrain-height 2");
    let digest = world.digest("run", &on_it);
    assert_ne!(world.digest("plane", &settings), digest);
    fs::remove_file(world.path("valley.png")).unwrap();

    let dir = RunDir::at(world.path("run"));
    let config = Config::of_run(&dir).unwrap();
    let kept = terrain::read(&fs::read(dir.terrain()).unwrap(), &Default::default()).unwrap();
    assert_eq!(config.locomotion().terrain, Some(Arc::new(kept)));
    assert_eq!(world.json("verify run --thorough --json")["ok"], true);
    assert_eq!(world.digest("again", "--config run/run.toml"), digest);
    assert_eq!(world.digest("kept", &format!("{settings} --terrain run/terrain.csv")), digest);
    let longer = world.json("resume run --generations 4 --no-monitor --quiet --json");
    let whole = world.digest("longer", "--config run/run.toml --generations 4");
    assert_eq!(longer["digest"], whole);

    let champion = "run/champion.csv --robustness 0";
    let score = |more: &str| {
        world.json(&format!("evaluate {champion} --json {more}"))["genomes"][0]["fitness"].clone()
    };
    assert_ne!(score(""), score("--terrain run/terrain.csv"));
}

#[test]
fn a_terrain_that_was_changed_or_is_gone_is_refused() {
    let world = valley();
    world.digest(
        "run",
        &format!("--n 1 --seed 3 --migrants 0 {TINY} --engine featherstone --terrain valley.png"),
    );
    let copy = world.read("run/terrain.csv");
    world.write("run/terrain.csv", copy.replacen(",0,", ",0.5,", 1));
    let said = world.refusal("resume run --generations 4");
    assert!(said.contains("it is not what run.toml says of it"), "{said}");
    let blamed = || {
        let ending = world.islands("verify run --json");
        assert_eq!(ending.code, Some(1), "{ending:?}");
        let damaged = ending.json()["damaged"].to_string();
        assert!(damaged.contains("cannot use run/terrain.csv as a terrain"), "{damaged}");
        let table = world.islands("verify run").stdout;
        assert!(table.contains("terrain.csv") && !table.contains("run.toml is damaged"), "{table}");
    };
    blamed();
    fs::remove_file(world.path("run/terrain.csv")).unwrap();
    blamed();
    let said = world.refusal("resume run --generations 4");
    assert!(said.contains("terrain.csv"), "{said}");
    let said = world.refusal("run --config run/run.toml --out new");
    assert!(said.contains("terrain.csv"), "{said}");
}

#[test]
fn what_is_no_terrain_is_refused_before_anything_is_made() {
    let world = valley();
    for (arguments, says) in [
        ("run --terrain genome.csv", "cannot use genome.csv as a terrain: it has no faces"),
        ("run --terrain nothing.png", "cannot use nothing.png as a terrain: "),
        ("run --terrain valley.png --terrain-size 0", "a size of 0 m is impossible"),
        ("run --terrain valley.png --terrain-start 99,0", "a body cannot begin at (99 m, 0 m)"),
        ("evaluate genome.csv --terrain genome.csv", "it has no faces"),
        ("replay genome.csv --terrain genome.csv", "it has no faces"),
        ("export genome.csv --format mjcf --out it --task climb", "--format mjcf writes a plane"),
        ("export genome.csv --format mjcf --out it --terrain valley.png", "only motion knows"),
        ("run --problem sphere --terrain valley.png", "terrain means nothing to sphere"),
        ("evaluate genome.csv --problem sphere --terrain valley.png", "terrain means nothing"),
    ] {
        let said = world.refusal(arguments);
        assert!(said.contains(says), "{said}");
    }
}
