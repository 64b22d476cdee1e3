//! A replay shows what was scored.

use crate::support::reel::Recording;
use crate::support::{TINY, World};
use islands::archipelago::Champion;
use islands::creature::encodings::course::Rescaling;
use islands::creature::{Course, Gene, Profile};
use islands::formats::genome_csv;
use islands::problems::{Locomotion, Robustness, Task};
use islands::runs::config::Config;
use islands::runs::subject::Subject;
use islands::store::{RecordLog, RunDir};

const WALK: Locomotion = Locomotion {
    encoding: Course { genes: 2, ..Course::DEFAULT },
    robustness: Robustness::NONE,
    judged: false,
    ..Locomotion::DEFAULT
};

#[test]
fn a_replay_shows_the_simulation_that_got_the_score() {
    let world = World::new();
    let run = world.json(&format!("--n 1 --seed 47 --out run --no-monitor --json {TINY}"));
    let ending = world.islands("replay run/champion.csv --robustness 0 --out champion.rrd");
    assert_eq!(ending.code, Some(0), "{ending:?}");
    let score = format!("{:.3} m", run["best_fitness"].as_f64().unwrap());
    assert!(ending.stdout.contains(&score), "{ending:?}");
    assert!(ending.stdout.ends_with("view it:  rerun champion.rrd\n"), "{ending:?}");

    let genome = genome_csv::read(&Course::DEFAULT, world.read("run/champion.csv").as_bytes())
        .unwrap()
        .genome;
    let (evaluation, film) = WALK.film(&genome).unwrap();
    assert_eq!(run["best_fitness"], evaluation.fitness.get());
    Recording::read(&world.path("champion.rrd")).assert_ends_with(0, &film, Task::Walk);
}

#[test]
fn several_creatures_race_in_one_replay() {
    let world = World::new();
    let course = |i| format!("genome_{i}.csv");
    for i in [1, 2] {
        world.write(&course(i), crate::formats::course::fixture(&course(i)));
    }
    let problem = Locomotion {
        encoding: Course { profile: Profile::Coursework, ..Course::DEFAULT },
        task: Task::Course,
        ..Locomotion::DEFAULT
    };
    let files = [1, 2].map(course).join(" ");
    let ending =
        world.islands(&format!("replay {files} --profile coursework --task course --out race.rrd"));
    assert_eq!(ending.code, Some(0), "{ending:?}");
    let recording = Recording::read(&world.path("race.rrd"));
    for (lane, i) in [(0, 1), (1, 2)] {
        let genome =
            genome_csv::read(&Course::DEFAULT, world.read(&course(i)).as_bytes()).unwrap().genome;
        let (_, film) = problem.film(&genome).unwrap();
        recording.assert_ends_with(lane, &film, Task::Course);
    }
}

#[test]
fn the_ancestors_of_a_champion_are_bred_again_from_a_random_body_on() {
    let world = World::new();
    let settings = "--population 6 --robustness 0 --generations 8 --genes 2 --migration-interval 1 --migrants 2";
    world.json(&format!("--n 2 --seed 41 --out run --quiet --no-monitor --json {settings}"));
    let ending = world.islands("replay run --ancestry");
    assert_eq!((ending.code, ending.stderr.as_str()), (Some(0), ""), "{ending:?}");
    let rows: Vec<&str> = ending.stdout.lines().collect();
    assert!(rows.len() > 2 && rows[0].ends_with("random"), "{ending:?}");
    assert_eq!(*rows.last().unwrap(), "view it:  rerun run/ancestry.rrd");

    let recording = Recording::read(&world.path("run/ancestry.rrd"));
    let genome = genome_csv::read(&Course::DEFAULT, world.read("run/champion.csv").as_bytes())
        .unwrap()
        .genome;
    let (_, film) = WALK.film(&genome).unwrap();
    let last = rows.len() as u32 - 2;
    recording.assert_ends_with(last, &film, Task::Walk);
}

#[test]
fn the_champions_of_a_run_are_shown_through_its_generations() {
    let world = World::new();
    world.json(&format!("--n 2 --seed 41 --out run --quiet --no-monitor --json {TINY}"));
    let dir = RunDir::at(world.path("run"));
    let mut champions: Vec<Champion<Gene>> = (0..2)
        .flat_map(|island| RecordLog::read(&dir.champions(island)).unwrap().records)
        .collect();
    champions.sort_by_key(|champion| (champion.generation, champion.individual.id.island));
    let ending = world.islands("replay run --out film.rrd");
    assert_eq!((ending.code, ending.stderr.as_str()), (Some(0), ""), "{ending:?}");
    let best = champions.iter().max_by_key(|champion| champion.individual.fitness).unwrap();
    let (_, film) = WALK.film(&best.individual.genome).unwrap();
    let shown = ending.stdout.lines().count() as u32 - 1;
    Recording::read(&world.path("film.rrd")).assert_ends_with(shown - 1, &film, Task::Walk);
}

#[test]
fn a_replay_may_be_longer_than_the_trial_and_what_makes_no_sense_is_refused() {
    let world = World::new();
    world.json(&format!("--n 1 --seed 47 --out run --no-monitor --json {TINY}"));
    let ending = world.islands("replay run/champion.csv --robustness 0 --seconds 12");
    assert_eq!(ending.code, Some(0), "{ending:?}");
    let recording = Recording::read(&world.path("run/champion.rrd"));
    // Settling comes first; there is a frame for each sixtieth of a second but the last.
    let frames_wanted = ((Task::Walk.trial().settle_s + 12.0) * 60.0) as usize;
    let frames = ["boxes", "cylinders"]
        .map(|kind| recording.frames(&format!("/islands/0/champion/{kind}")).len());
    assert_eq!(frames.into_iter().max(), Some(frames_wanted));
    for (wish, reason) in [
        ("run run/champion.csv", "replay takes the folder of one run"),
        ("run/champion.csv --ancestry", "a genome alone has no ancestors"),
        ("run/champion.csv --seconds 0", "seconds must be from 0.1 to 3600, not 0"),
        ("run --ancestry --max-links 0", "max-links must be from 1"),
        ("run --drop-column 18", "--drop-column is for files of genomes"),
        ("run --scale link-length=1", "only profile coursework has scales to change, not native"),
    ] {
        let said = world.refusal(&format!("replay {wish}"));
        assert!(said.contains(reason), "{said}");
    }
}

#[test]
fn the_ancestors_of_a_run_that_began_with_genomes_are_bred_again_from_them() {
    let world = World::new();
    let founder = |i| crate::formats::course::fixture(&format!("genome_{i}.csv"));
    (0..5).for_each(|i| world.write(&format!("{i}.csv"), founder(i)));
    let settings =
        "--population 4 --robustness 0 --generations 5 --elites 0 --max-genes 20 --max-links 8";
    let seeds =
        "--seed-genomes 0.csv 1.csv 2.csv 3.csv 4.csv --profile coursework --scale link-length=1";
    world.json(&format!("--n 2 --seed 23 --out run --no-monitor --json {settings} {seeds}"));
    let ending = world.islands("replay run --ancestry --clips 64");
    assert_eq!((ending.code, ending.stderr.as_str()), (Some(0), ""), "{ending:?}");
    let rows: Vec<&str> = ending.stdout.lines().collect();
    assert!(rows.len() > 2 && rows[0].ends_with("founder"), "{ending:?}");

    let genome = genome_csv::read(&Course::DEFAULT, world.read("run/champion.csv").as_bytes())
        .unwrap()
        .genome;
    let problem = Config::read(&RunDir::at(world.path("run")).config()).unwrap().locomotion();
    let (_, film) = problem.film(&genome).unwrap();
    let last = rows.len() as u32 - 2;
    Recording::read(&world.path("run/ancestry.rrd")).assert_ends_with(last, &film, Task::Walk);

    let copy = world.read("run/seed-genomes.csv");
    world.write("run/seed-genomes.csv", copy.replacen('1', "2", 1));
    let said = world.refusal("replay run --ancestry");
    assert!(said.contains("it is not what run.toml says of it"), "{said}");
}

#[test]
fn genomes_in_any_state_and_bodies_race() {
    let world = World::new();
    let genome = crate::formats::course::fixture("genome_3.csv");
    world.write("own.csv", &genome);
    let wide = genome.lines().map(|line| format!("0.9,{line}\n"));
    world.write("wide.csv", wide.collect::<String>());
    let reading = "--profile coursework --scale link-length=1";
    let export = format!("export own.csv {reading} --format urdf --out body.urdf");
    assert_eq!(world.islands(&export).code, Some(0));
    let ending = world
        .islands(&format!("replay wide.csv body.urdf {reading} --drop-column 1 --task course"));
    assert_eq!(ending.code, Some(0), "{ending:?}");

    let scales = ["link-length=1".parse::<Rescaling>().unwrap()].into_iter().collect();
    let problem = Locomotion {
        encoding: Course { profile: Profile::Coursework, scales, ..Course::DEFAULT },
        task: Task::Course,
        ..Locomotion::DEFAULT
    };
    let genes = genome_csv::read(&Course::DEFAULT, genome.as_bytes()).unwrap().genome;
    let (evaluation, film) = problem.film(&genes).unwrap();
    let recording = Recording::read(&world.path("wide.rrd"));
    for lane in 0..2 {
        recording.assert_ends_with(lane, &film, Task::Course);
        let score = format!("{} ", problem.show(evaluation.fitness));
        assert!(ending.stdout.lines().nth(lane as usize).unwrap().contains(&score), "{ending:?}");
    }
}
