//! What a viewer gets to see is what was scored.

use crate::support::reel::Recording;
use crate::support::{Ending, TINY, World, await_generation, rewrite, signal, try_signal, until};
use islands::archipelago::Champion;
use islands::creature::{Course, Gene};
use islands::evolution::Fitness;
use islands::formats::metrics;
use islands::problems::{Locomotion, Robustness, Task};
use islands::store::{Entry, RecordLog, RunDir, checkpoint};
use std::collections::BTreeSet;
use std::os::unix::fs::PermissionsExt;

const WALK: Locomotion = Locomotion {
    encoding: Course { genes: 2, ..Course::DEFAULT },
    robustness: Robustness::NONE,
    judged: false,
    ..Locomotion::DEFAULT
};

#[test]
fn a_recording_shows_each_islands_champion_as_it_was_simulated() {
    let world = World::new();
    world.json(&format!("--n 2 --seed 41 --out run --quiet --json {TINY}"));
    let recording = Recording::read(&world.path("run/recording.rrd"));
    for index in 0..2 {
        let dir = RunDir::at(world.path("run"));
        let island = checkpoint::load::<Gene>(&dir.checkpoint(index, 3)).unwrap().island;
        let (evaluation, film) = WALK.film(&island.champion.genome).unwrap();
        assert_eq!(evaluation.fitness, island.champion.fitness);
        recording.assert_ends_with(index, &film, Task::Walk);
    }
}

#[test]
fn a_recording_holds_the_curves_of_every_island() {
    let world = World::new();
    world.json(&format!("--n 2 --seed 43 --out run --quiet --json {TINY}"));
    let recording = Recording::read(&world.path("run/recording.rrd"));
    let rows = metrics::read(world.read("run/metrics.csv").as_bytes()).unwrap();
    for island in 0..2 {
        let rows = rows.iter().filter(|row| row.island == island);
        let expected: Vec<_> =
            rows.map(|row| (i64::from(row.generation), row.best.unwrap())).collect();
        assert_eq!(recording.scalars(&format!("/fitness/best/{island}")), expected);
        for curve in ["fitness/mean", "diversity"] {
            assert_eq!(recording.scalars(&format!("/{curve}/{island}")).len(), 4, "{curve}");
        }
    }
}

#[test]
fn a_recording_of_numbers_holds_curves_families_and_events_and_nothing_in_space() {
    let world = World::new();
    let settings = "--problem ackley --dimensions 3 --population 6 --generations 12";
    world.json(&format!(
        "--n 2 --seed 43 --out run --quiet --json --migration-interval 3 {settings}"
    ));
    let recording = Recording::read(&world.path("run/recording.rrd"));
    assert_eq!(recording.generations(2), Vec::from_iter(0..=12));
    let events = recording.events(2).join("\n");
    assert!(events.contains("new champion, -") && events.contains("migration 0 → 1"), "{events}");
    assert!(recording.chunks("/family").next().is_some());
    let entities: BTreeSet<String> = recording.rows().into_keys().map(|key| key.0).collect();
    let in_space = |path: &&String| path.starts_with("/islands") || path.starts_with("/race");
    assert_eq!(entities.iter().find(in_space), None);
}

#[test]
fn a_monitor_that_comes_late_still_films_the_whole_of_a_short_run() {
    let world = World::new();
    let settings = "--population 6 --robustness 0 --generations 6 --genes 2";
    let run = world.start(&format!("--n 2 --seed 43 --out run --quiet --json {settings}"));
    let monitor = run.child("monitor");
    signal(monitor, "STOP");
    let dir = RunDir::at(world.path("run"));
    until("the islands have finished", || (0..2).all(|i| dir.checkpoint(i, 6).exists()));
    signal(monitor, "CONT");
    let ending = run.wait();
    assert_eq!((ending.code, ending.stderr.as_str()), (Some(0), ""), "{ending:?}");
    let recording = Recording::read(&dir.recording());
    for island in 0..2 {
        assert_eq!(recording.scalars(&format!("/fitness/mean/{island}")).len(), 7);
    }
}

#[test]
fn a_monitor_that_is_killed_again_and_again_leaves_a_film_without_gaps_or_doubles() {
    let world = World::new();
    let settings = "--population 4 --robustness 0 --generations 40 --genes 1 --elites 1";
    let run = world.start(&format!("--n 2 --seed 43 --out run --quiet --json {settings}"));
    let dir = RunDir::at(world.path("run"));
    for generation in [2, 5, 8] {
        await_generation(&dir, 2, generation);
        signal(run.child("monitor"), "KILL");
    }
    let ending = run.wait();
    assert_eq!(ending.code, Some(0), "{ending:?}");
    assert_eq!(Recording::read(&dir.recording()).generations(2), Vec::from_iter(0..=40));
    assert!(!dir.partial().exists());
}

/// As where there is no memory for it. What is there of the film when nobody kills it any more is all of it.
#[test]
fn a_monitor_that_is_killed_whenever_it_appears_costs_no_result_and_is_started_less_and_less_often()
{
    let world = World::new();
    let settings = "--n 1 --seed 43 --population 4 --robustness 0 --generations 40 --genes 1";
    let expected = world.digest("undisturbed", settings);
    let run = world.start(&format!("--out run --quiet --json {settings}"));
    let dir = RunDir::at(world.path("run"));
    until("there is a result", || {
        if let Some(monitor) = run.find_child("monitor") {
            try_signal(monitor, "KILL");
        }
        dir.summary().exists()
    });
    let said = world.read("run/summary.json");
    assert!(said.contains(&format!("\"digest\": \"{expected}\"")), "{said}");
    assert!(said.contains("awaits_film"), "{said}");
    let mut dead = None;
    until("it was killed often", || {
        let another = run.find_child("monitor").filter(|&monitor| Some(monitor) != dead);
        if let Some(monitor) = another {
            try_signal(monitor, "KILL");
            dead = another;
        }
        world.read("run/run.log").contains("dies again and again")
    });
    let ending = run.wait();
    assert_eq!(ending.json()["digest"], *expected, "{ending:?}");
    assert_eq!(ending.json()["recording"], "run/recording.rrd", "{ending:?}");
    assert!(!world.read("run/summary.json").contains("awaits_film"));
    let log = world.read("run/run.log");
    assert_eq!(log.matches("the monitor died").count(), 8, "{log}");
    assert_eq!(log.matches("dies again and again").count(), 1, "{log}");
    assert_eq!(Recording::read(&dir.recording()).generations(1), Vec::from_iter(0..=40));
    world.assert_left_nothing();
}

#[test]
fn going_on_makes_the_film_of_a_run_that_was_killed_over_it() {
    let world = World::new();
    let settings = "--n 1 --seed 43 --population 4 --robustness 0 --generations 9 --genes 1";
    let run = world.start(&format!("--out run --quiet --json {settings}"));
    let dir = RunDir::at(world.path("run"));
    signal(run.child("monitor"), "STOP");
    until("there is a result", || dir.summary().exists());
    run.signal("KILL");
    let ending = run.wait();
    assert!(!dir.recording().exists() && ending.code.is_none(), "{ending:?}");
    let without = world.json("resume run --no-monitor --json");
    assert!(without.get("recording").is_none(), "{without}");
    let with = world.json("resume run --json");
    assert_eq!(with["digest"], without["digest"]);
    assert_eq!(Recording::read(&dir.recording()).generations(1), Vec::from_iter(0..=9));
    world.assert_left_nothing();
}

#[test]
fn a_film_that_is_made_of_a_run_that_is_over_is_the_one_that_was_made_while_it_went_on() {
    let world = World::new();
    world.json(&format!("--n 2 --seed 41 --out run --quiet --json {TINY}"));
    let path = world.path("run/recording.rrd");
    let (files, live) = (world.files(), Recording::read(&path));
    std::fs::remove_file(&path).unwrap();
    let ending = world.islands("monitor run");
    let said = "view it:  rerun run/recording.rrd\n";
    assert_eq!((ending.code, ending.stdout.as_str()), (Some(0), said), "{ending:?}");
    assert_eq!(world.files(), files);
    let made = Recording::read(&path);
    assert_eq!(made.generations(2), [0, 1, 2, 3]);
    for island in 0..2 {
        for curve in ["fitness/best", "fitness/mean", "diversity"] {
            let curve = format!("/{curve}/{island}");
            assert_eq!(made.scalars(&curve), live.scalars(&curve));
        }
        for kind in ["boxes", "cylinders"] {
            let links = format!("/islands/{island}/champion/{kind}");
            assert_eq!(made.frames(&links), live.frames(&links));
        }
    }
    let events = |recording: &Recording| BTreeSet::from_iter(recording.events(2));
    assert_eq!(events(&made), events(&live));
}

#[test]
fn a_monitor_that_is_killed_after_the_islands_have_finished_still_leaves_the_film() {
    let world = World::new();
    let run = world.start(&format!("--n 1 --seed 3 --out run --json {TINY}"));
    let monitor = run.child("monitor");
    signal(monitor, "STOP");
    let is_awaited = || world.read("run/run.log").contains("the monitor films the last champions");
    until("it alone is waited for", is_awaited);
    signal(monitor, "KILL");
    let ending = run.wait();
    assert_eq!(ending.code, Some(0), "{ending:?}");
    assert_eq!(ending.json()["recording"], "run/recording.rrd");
    world.assert_left_nothing();
}

#[test]
fn a_monitor_that_nobody_started_follows_a_run_to_its_end_and_is_the_only_one() {
    let world = World::new();
    let endless =
        "--population 4 --robustness 0 --generations 1000000 --genes 1 --migration-interval 1";
    let run = world.start(&format!("--n 1 --seed 3 --out run --no-monitor --quiet {endless}"));
    let dir = RunDir::at(world.path("run"));
    await_generation(&dir, 1, 2);
    let monitor = world.start("monitor run --view-address 127.0.0.5");
    until("there is a recording", || dir.recording().exists());
    let ending = world.islands("monitor run");
    let refusal = "error: another monitor records run already\n";
    assert_eq!((ending.code, ending.stderr.as_str()), (Some(2), refusal), "{ending:?}");
    run.signal("INT");
    assert_eq!(run.wait().code, Some(130));
    let ending = monitor.wait();
    assert_eq!((ending.code, ending.stderr.as_str()), (Some(0), ""), "{ending:?}");
    let lines: Vec<&str> = ending.stdout.lines().collect();
    assert!(lines[0].starts_with("watch it live:  rerun rerun+http://127.0.0.5:"), "{ending:?}");
    assert_eq!(lines[1..], ["view it:  rerun run/recording.rrd"]);
    let reports = RecordLog::<Entry>::read(&dir.reports(0)).unwrap().records.len() as i64;
    assert_eq!(Recording::read(&dir.recording()).generations(1), Vec::from_iter(0..reports));
}

#[test]
fn champions_that_are_seen_are_checked_and_no_others_are_simulated() {
    let world = World::new();
    let settings = "--population 2 --robustness 0 --generations 31 --genes 1 --elites 1";
    world.json(&format!("--n 1 --seed 47 --out run --no-monitor --quiet --json {settings}"));
    let path = RunDir::at(world.path("run")).champions(0);
    let champion = RecordLog::<Champion<Gene>>::read(&path).unwrap().records.remove(0);
    let mut individual = champion.individual;
    // The next number after the one that it gets.
    individual.fitness = Fitness::new(individual.fitness.get().next_up());
    let champions: Vec<_> = (0..=31)
        .map(|generation| Champion { generation, individual: individual.clone(), validated: None })
        .collect();
    rewrite(&path, &champions);

    let ending = world.islands("monitor run");
    assert_eq!(ending.code, Some(0), "{ending:?}");
    // The film shows every third generation's champion, and at its end the one that came after the last of them.
    let warning = "WARNING: the champion of island 0 was reported with ";
    assert_eq!(ending.stderr.matches(warning).count(), 12, "{ending:?}");
    let events = Recording::read(&world.path("run/recording.rrd")).events(1);
    let count = |word| events.iter().filter(|event| event.contains(word)).count();
    assert_eq!((count(warning), count(": new champion, ")), (12, 32));
}

#[test]
fn a_recording_tells_what_happened() {
    let world = World::new();
    world.json(&format!("--n 2 --seed 41 --out run --quiet --json {TINY}"));
    let events = Recording::read(&world.path("run/recording.rrd")).events(2);
    let count = |word: &str| events.iter().filter(|event| event.contains(word)).count();
    assert!(count("new champion") >= 2, "{events:?}");
    assert_eq!(count(": 2 immigrants"), 2, "{events:?}");
    assert_eq!(count("WARNING"), 0, "{events:?}");
}

#[test]
fn two_runs_of_a_seed_have_the_same_film_row_by_row_and_piece_by_piece() {
    let world = World::new();
    let films = ["a", "b"].map(|name| {
        world.json(&format!("--n 2 --seed 41 --out {name} --quiet --json --clip-every 2 {TINY}"));
        Recording::read(&world.path(&format!("{name}/recording.rrd")))
    });
    assert_eq!(films[0].pieces(), films[1].pieces());
    let films = films.map(|film| film.rows());
    assert_eq!(films[0].len(), films[1].len());
    for (a, b) in films[0].iter().zip(&films[1]) {
        assert_eq!(a, b);
    }
    for entity in ["/events/0", "/family", "/state/island-0", "/islands/1/prints", "/topology"] {
        assert!(films[0].keys().any(|(path, ..)| path == entity), "{entity}");
    }
}

#[test]
fn a_wished_port_that_is_taken_is_said_and_nobody_is_served_if_that_is_wished() {
    let world = World::new();
    let taken = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let port = taken.local_addr().unwrap().port();
    let settings = "--n 1 --seed 3 --population 4 --robustness 0 --generations 2 --genes 1";
    let ending = world.islands(&format!("{settings} --out a --view-port {port}"));
    assert_eq!(ending.code, Some(0), "{ending:?}");
    let said = format!("port {port} is taken; the live view is served on port ");
    assert!(ending.stderr.contains(&said), "{ending:?}");
    let ending = world.islands(&format!("{settings} --out b --view off"));
    assert_eq!(ending.code, Some(0), "{ending:?}");
    assert!(!ending.stderr.contains("watch it live"), "{ending:?}");
    assert!(world.path("b/recording.rrd").exists());
}

#[test]
fn a_viewer_is_opened_if_it_is_there_and_of_the_right_version_and_otherwise_said_how_to_get() {
    let world = World::new();
    std::fs::create_dir(world.path("bin")).unwrap();
    world.write("bin/rerun", "#!/bin/sh\necho 'rerun-cli 0.1.0'\n");
    std::fs::set_permissions(world.path("bin/rerun"), PermissionsExt::from_mode(0o755)).unwrap();
    world.json(&format!("--n 1 --seed 47 --out run --no-monitor --json {TINY}"));
    let replay = |path: &str| -> Ending {
        let mut command = world.command("replay run/champion.csv --view spawn");
        command.env("PATH", path).output().unwrap().into()
    };
    let nowhere = replay("/nowhere");
    assert!(nowhere.stderr.contains("pip install rerun-sdk==0.36.3"), "{nowhere:?}");
    let bin = world.path("bin").display().to_string();
    let other = replay(&bin);
    assert!(other.stderr.contains("is another version (rerun-cli 0.1.0)"), "{other:?}");
    let right =
        "#!/bin/sh\necho 'rerun-cli 0.36.3'\n[ \"$1\" = --version ] || echo \"$1\" > opened\n";
    world.write("bin/rerun", right);
    let found = replay(&bin);
    assert_eq!((found.code, found.stderr.as_str()), (Some(0), ""), "{found:?}");
    until("the viewer was opened", || world.path("opened").exists());
    until("it was told what", || world.read("opened").trim() == "run/champion.rrd");
    world.write("bin/rerun", "#!/bin/sh\necho 'rerun-cli 0.36.3'\n[ \"$1\" = --version ]\n");
    let blind = replay(&bin);
    assert!(blind.stderr.contains("the viewer ended at once (exit status: 1)"), "{blind:?}");
}
