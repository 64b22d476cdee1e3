//! A run that was interrupted or killed goes on, to the result that it would have had.

use crate::support::{Running, TINY, World, await_generation, is_alive, run_id, signal, until};
use islands::formats::metrics;
use islands::store::{Checkpoint, Entry, RecordLog, RunDir, checkpoint};
use serde_json::Value;
use std::fs;

/// A run that nobody waits for.
const ENDLESS: &str = "--n 2 --seed 3 --population 4 --robustness 0 --generations 1000000 --genes 1 --migration-interval 1";
/// A run of a second or two.
const RUN: &str = "--n 2 --seed 37 --population 5 --robustness 0 --generations 14 --genes 2 --migration-interval 2";

/// Starts a run, and waits until its islands have evolved some generations.
fn start(world: &World, settings: &str, generation: u32) -> Running {
    let run = world.start(&format!("--out run --no-monitor --json {settings}"));
    await_generation(&RunDir::at(world.path("run")), 2, generation);
    run
}

#[test]
fn a_run_that_is_interrupted_saves_where_it_is_and_says_how_to_go_on() {
    let world = World::new();
    let run = start(&world, ENDLESS, 1);
    run.signal("INT");
    let ending = run.wait();
    assert_eq!(ending.code, Some(130), "{ending:?}");
    assert_eq!(ending.stdout, "");
    let said = ending.stderr.lines().next_back().unwrap();
    assert!(said.starts_with("error: interrupted after generation "), "{said}");
    assert!(said.ends_with("; nothing is lost; go on with: islands resume run"), "{said}");
    let dir = RunDir::at(world.path("run"));
    for island in 0..2 {
        let entries = RecordLog::<Entry>::read(&dir.reports(island)).unwrap().records;
        let last = entries.last().unwrap().report.generation;
        let saved: Checkpoint<islands::creature::Gene> =
            checkpoint::load(&dir.checkpoint(island, last)).unwrap();
        assert_eq!(saved.island.generation, last);
    }
    let rows = metrics::read(fs::File::open(dir.metrics()).unwrap()).unwrap();
    assert!(rows.len() >= 4, "what there is can be plotted: {rows:?}");
    assert!(!dir.summary().exists() && !dir.partial().exists());
    world.assert_left_nothing();
}

#[test]
fn an_interrupted_run_goes_on_to_the_same_result() {
    let world = World::new();
    let expected = world.digest("undisturbed", RUN);
    let first_id;
    {
        let run = start(&world, RUN, 2);
        first_id = run_id(&world.read("run/run.toml"));
        run.signal("TERM");
        assert_eq!(run.wait().code, Some(130));
    }
    let result = world.json("resume run --no-monitor --json --threads 1");
    assert_eq!(result["digest"], expected);
    assert_ne!(run_id(&world.read("run/run.toml")), first_id);
    let files: Vec<String> = world.files();
    let of = |run: &str| -> Vec<String> {
        files.iter().filter_map(|file| file.strip_prefix(run)).map(str::to_owned).collect()
    };
    assert_eq!(of("run/"), of("undisturbed/"));
    for file in ["champion.csv", "champion.urdf"] {
        assert_eq!(world.read(&format!("run/{file}")), world.read(&format!("undisturbed/{file}")));
    }
    world.assert_left_nothing();
}

#[test]
fn who_interrupts_twice_does_not_wait_and_loses_nothing_either() {
    let world = World::new();
    // A generation takes far longer than anybody waits for.
    let settings = "--n 2 --seed 5 --population 3000 --robustness 0 --generations 1 --genes 4";
    let run = world.start(&format!("--out run --no-monitor --json {settings}"));
    run.child("--index=1");
    run.signal("INT");
    run.signal("INT");
    until("it ends", || !run.is_alive());
    assert_eq!(run.wait().code, Some(130));
    world.assert_left_nothing();
}

#[test]
fn a_run_whose_launcher_is_killed_ends_by_itself_and_can_be_resumed() {
    let world = World::new();
    let expected = world.digest("undisturbed", RUN);
    let run = start(&world, RUN, 3);
    let islands = run.children();
    assert_eq!(islands.len(), 2);
    run.signal("KILL");
    assert_eq!(run.wait().code, None);
    until("its islands have ended, too", || islands.iter().all(|&pid| !is_alive(pid)));
    let result = world.json("resume run --no-monitor --json");
    assert_eq!(result["digest"], expected);
    world.assert_left_nothing();
}

#[test]
fn a_longer_run_contains_a_shorter_one() {
    let world = World::new();
    let longer = "--n 2 --seed 37 --population 5 --robustness 0 --generations 20 --genes 2 --migration-interval 2";
    let expected = world.json(&format!("--out longer --no-monitor --quiet --json {longer}"));
    world.digest("run", RUN);
    let result = world.json("resume run --generations 20 --no-monitor --json");
    for same in ["digest", "best_fitness", "evaluations", "reused", "generations"] {
        assert_eq!(result[same], expected[same], "{same}");
    }
    world.assert_left_nothing();
}

#[test]
fn a_finished_run_prints_its_result_again_and_touches_nothing() {
    let world = World::new();
    let first = world.json(&format!("--n 2 --seed 3 --out run --json {TINY}"));
    let state = |world: &World| -> Vec<_> {
        let time = |file: &String| fs::metadata(world.path(file)).unwrap().modified().unwrap();
        world.files().iter().map(|file| (file.clone(), time(file))).collect()
    };
    let before = state(&world);
    assert_eq!(world.json("resume run --json"), first);
    assert_eq!(state(&world), before);
    let ending = world.islands("resume run --quiet");
    assert!(ending.stdout.contains(first["digest"].as_str().unwrap()), "{ending:?}");
    world.assert_left_nothing();
}

#[test]
fn a_finished_run_whose_last_state_is_damaged_evolves_it_again() {
    let world = World::new();
    let first = world.digest("run", RUN);
    let last = RunDir::at(world.path("run")).checkpoint(1, 14);
    fs::write(&last, "no checkpoint").unwrap();
    let ending = world.islands("resume run --json --no-monitor");
    assert_eq!(ending.json()["digest"], first);
    let warning =
        "warning: island 1: run/checkpoints/island-1/14.ckpt is damaged: it is no checkpoint";
    assert!(ending.stderr.lines().any(|line| line == warning), "{ending:?}");
}

#[test]
fn a_run_under_way_cannot_be_resumed_nor_its_folder_used() {
    let world = World::new();
    let run = start(&world, ENDLESS, 0);
    let before = world.read("run/run.toml");
    for arguments in ["resume run", "--n 1 --seed 1 --out run"] {
        let ending = world.islands(&format!("{arguments} --no-monitor --json"));
        assert_eq!(ending.code, Some(2), "{ending:?}");
        assert!(ending.stderr.contains("is under way in another process"), "{ending:?}");
    }
    assert_eq!(world.read("run/run.toml"), before);
    run.signal("INT");
    assert_eq!(run.wait().code, Some(130));
}

#[test]
fn of_two_launchers_at_once_one_is_refused() {
    let world = World::new();
    world.digest("run", RUN);
    let resume = || world.start("resume run --generations 40 --no-monitor --json --quiet");
    let endings = [resume(), resume()].map(Running::wait);
    let mut codes = endings.each_ref().map(|ending| ending.code);
    codes.sort_unstable();
    assert_eq!(codes, [Some(0), Some(2)], "{endings:?}");
}

#[test]
fn what_would_change_the_result_is_refused_by_name() {
    let world = World::new();
    world.digest("run", &format!("--n 2 --seed 3 {TINY}"));
    let refusal = |arguments: &str| world.refusal(&format!("resume run --no-monitor {arguments}"));
    let said = refusal("--seed 4 --generations 9 --population 30");
    assert!(said.contains("population is 4, not 30, seed is 3, not 4;"), "{said}");
    assert!(refusal("--n 3").contains("islands is 2, not 3"));
    assert!(refusal("--task travel").contains("task is \"walk\", not \"travel\""));
    assert!(refusal("--generations 2").contains("has evolved 3 generations already"));
    let config = world.read("run/run.toml");
    let refusal_of = |config: String| {
        world.write("run/run.toml", config);
        refusal("--generations 9")
    };
    let said = refusal_of(config.replace("population = 4", "population = 5"));
    assert!(
        said.contains("run.toml was changed") && said.contains("population is 4, not 5"),
        "{said}"
    );
    let version = format!("version = \"{}\"", env!("CARGO_PKG_VERSION"));
    let said = refusal_of(config.replace(&version, "version = \"0.0.9\""));
    assert!(said.contains("made by version 0.0.9"), "{said}");
    let said = refusal_of(config[..config.find("[launch]").unwrap()].to_owned());
    assert!(said.contains("was not written by a run"), "{said}");
    // Before its first checkpoint nothing else knows the seed.
    let said = refusal_of(config.replace("seed = 3\n", ""));
    assert!(said.contains("was not written by a run"), "{said}");
    assert!(refusal_of("population = ".to_owned()).contains("run.toml"));
    fs::remove_file(world.path("run/run.toml")).unwrap();
    assert!(refusal("").contains("there is no run in run"));
    assert!(world.refusal("resume nowhere").contains("there is no run in nowhere"));
}

#[test]
fn what_a_run_makes_is_for_its_user_only() {
    use std::os::unix::fs::PermissionsExt;
    let world = World::new();
    world.json(&format!("--n 2 --seed 3 --out runs/run --json {TINY}"));
    let mode = |path: &str| fs::metadata(world.path(path)).unwrap().permissions().mode() & 0o777;
    for file in world.files() {
        assert_eq!(mode(&file), 0o600, "{file}");
    }
    for folder in ["runs", "runs/run", "runs/run/champions", "runs/run/checkpoints/island-1"] {
        assert_eq!(mode(folder), 0o700, "{folder}");
    }
}

#[test]
fn a_run_that_died_in_its_first_generation_starts_anew() {
    let world = World::new();
    let settings = "--n 1 --seed 3 --population 40 --robustness 0 --generations 1 --genes 3";
    let expected: Value = world.digest("undisturbed", settings).into();
    let run = world.start(&format!("--out run --no-monitor --json {settings}"));
    run.child("--index=0");
    run.signal("KILL");
    run.wait();
    assert_eq!(world.json("resume run --no-monitor --json")["digest"], expected);
}

#[test]
fn a_folder_whose_launcher_died_before_it_had_said_what_the_run_is_can_be_used_again() {
    let world = World::new();
    fs::create_dir_all(world.path("run/.partial")).unwrap();
    world.write("run/.partial/.tmpX", "half a configuration");
    assert!(world.refusal("resume run").contains("there is no run in run"));
    world.json(&format!("--n 1 --seed 3 --out run --no-monitor --json {TINY}"));
    assert!(!RunDir::at(world.path("run")).partial().exists());
    // What is more than that is no launcher's.
    for folder in ["theirs", "theirs/.partial", "theirs/champions"] {
        fs::create_dir(world.path(folder)).unwrap();
    }
    world.write("theirs/.partial/precious", "a file");
    let said = world.refusal("--n 1 --out theirs");
    assert!(said.contains("cannot use theirs: it is not empty"), "{said}");
    assert_eq!(world.read("theirs/.partial/precious"), "a file");
}

#[test]
fn islands_that_are_told_to_terminate_are_started_again_and_the_launcher_alone_ends_the_run() {
    let world = World::new();
    let run = start(&world, ENDLESS, 0);
    for pid in run.children() {
        signal(pid, "TERM");
    }
    let noticed = "died (signal: 15 (SIGTERM)); it is started again";
    until("both are started again", || world.read("run/run.log").matches(noticed).count() == 2);
    run.signal("INT");
    assert_eq!(run.wait().code, Some(130));
    world.assert_left_nothing();
}
