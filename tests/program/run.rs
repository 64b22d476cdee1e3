//! A run, with every real part: processes, shared memory, files.

use crate::support::{Ending, Running, TINY, World, run_id};
use islands::formats::metrics;
use islands::runs::config::Config;
use islands::store::RunDir;
use serde_json::Value;
use std::collections::BTreeSet;
use std::thread::sleep;
use std::time::Duration;

#[test]
fn a_run_ends_with_one_json_object_that_says_what_came_out() {
    let world = World::new();
    let ending = world.islands(&format!("--n 3 --seed 3 --out run --no-monitor --json {TINY}"));
    assert_eq!(ending.code, Some(0), "{ending:?}");
    let result = ending.json();
    for key in ["best_fitness", "evaluations", "evaluations_per_second", "wall_seconds"] {
        assert!(result[key].is_number(), "{key} in {result}");
    }
    assert_eq!(result["digest"].as_str().unwrap().len(), 64);
    assert_eq!((&result["islands"], &result["seed"]), (&3.into(), &3.into()));
    assert_eq!((&result["generations"], &result["population"]), (&3.into(), &4.into()));
    assert_eq!(
        (&result["best_genome"], &result["run_dir"]),
        (&"run/champion.csv".into(), &"run".into())
    );
    assert!(result.as_object().unwrap().values().all(|value| !value.is_null()), "{result}");
    let summary: Value = serde_json::from_str(&world.read("run/summary.json")).unwrap();
    assert_eq!(summary, result);
    world.assert_left_nothing();
}

#[test]
fn a_run_leaves_the_files_of_its_folder_and_no_others() {
    let world = World::new();
    world.json(&format!("--n 2 --seed 3 --out run --json {TINY}"));
    let dir = RunDir::at("run");
    let mut expected = vec![
        dir.config(),
        dir.log(),
        dir.metrics(),
        dir.champion_genome(),
        dir.champion_body(),
        dir.summary(),
    ];
    expected.extend(cfg!(feature = "view").then(|| dir.recording()));
    for island in 0..2 {
        expected.extend([dir.champions(island), dir.migrations(island), dir.reports(island)]);
        expected.push(dir.lineages(island));
        expected.extend([dir.checkpoint(island, 2), dir.checkpoint(island, 3)]);
    }
    let files: BTreeSet<String> = world.files().into_iter().collect();
    let expected: BTreeSet<String> =
        expected.iter().map(|path| path.to_str().unwrap().to_owned()).collect();
    assert_eq!(files, expected);
    world.assert_left_nothing();
}

#[test]
fn the_metrics_have_a_row_an_island_and_generation_in_order() {
    let world = World::new();
    let run = world.json(&format!("--n 3 --seed 5 --out run --no-monitor --json {TINY}"));
    let rows = metrics::read(world.read("run/metrics.csv").as_bytes()).unwrap();
    let found: Vec<_> = rows.iter().map(|row| (row.generation, row.island)).collect();
    let expected: Vec<_> = (0..=3).flat_map(|g| (0..3).map(move |island| (g, island))).collect();
    assert_eq!(found, expected);
    let evaluations: u64 = rows.iter().map(|row| row.evaluations).sum();
    assert_eq!(run["evaluations"].as_u64(), Some(evaluations));
    // With an interval of 1 and a lag of 1 the first immigrants come at the beginning of generation 3.
    let immigrants: Vec<_> = rows.iter().map(|row| row.immigrants).collect();
    assert_eq!(immigrants, [0, 0, 0, 0, 0, 0, 0, 0, 0, 2, 2, 2]);
}

#[test]
fn the_last_lines_say_what_was_evaluated_what_failed_and_what_was_not_evaluated_again() {
    let world = World::new();
    let ending = world.islands(&format!("--n 2 --seed 5 --out run --no-monitor {TINY}"));
    let summary: Value = serde_json::from_str(&world.read("run/summary.json")).unwrap();
    let count = |name: &str| summary[name].as_u64().unwrap();
    assert!(count("reused") > 0, "{summary}");
    let found = format!("found in {} evaluations, ", count("evaluations"));
    let failed = format!("; {} failed", count("failures"));
    let reused = format!("reused   {} scores, of genomes known already", count("reused"));
    let lines: Vec<&str> = ending.stdout.lines().collect();
    assert!(lines[3].starts_with(&found) && lines[3].ends_with(&failed), "{ending:?}");
    assert_eq!(lines[4], reused);
    let rows = metrics::read(world.read("run/metrics.csv").as_bytes()).unwrap();
    assert_eq!(rows.iter().map(|row| row.reused).sum::<u64>(), count("reused"));
    assert_eq!(rows.iter().map(|row| row.failures).sum::<u64>(), count("failures"));
}

#[test]
fn the_champion_in_the_file_gets_exactly_the_fitness_that_is_claimed() {
    for task in ["walk", "travel"] {
        let world = World::new();
        let run = world
            .json(&format!("--n 2 --seed 7 --task {task} --out run --no-monitor --json {TINY}"));
        let scores =
            world.json(&format!("evaluate run/champion.csv --task {task} --robustness 0 --json"));
        let [claimed, found] = [&run["best_fitness"], &scores["genomes"][0]["fitness"]];
        assert_eq!(found.as_f64().unwrap().to_bits(), claimed.as_f64().unwrap().to_bits());
    }
}

#[test]
fn run_is_what_the_program_does_without_a_word() {
    let world = World::new();
    let [without, with] = [("a", "--n 3"), ("b", "run --n 3")].map(|(out, verb)| {
        let run = world.json(&format!("{verb} --seed 3 --out {out} --no-monitor --json {TINY}"));
        run["digest"].clone()
    });
    assert_eq!(without, with);
}

#[test]
fn a_run_needs_no_folder_to_be_named() {
    let world = World::new();
    let arguments = format!("--n 1 --seed 3 --no-monitor --json {TINY}");
    let folders = [(); 2].map(|()| world.json(&arguments)["run_dir"].clone());
    assert_eq!(folders, ["runs/walk-seed3", "runs/walk-seed3-2"]);
    assert!(world.files().iter().all(|file| file.starts_with("runs/")));
}

#[test]
fn one_island_exchanges_nothing() {
    let world = World::new();
    world.digest("run", &format!("--n 1 --seed 3 {TINY}"));
    let rows = metrics::read(world.read("run/metrics.csv").as_bytes()).unwrap();
    assert_eq!(rows.len(), 4);
    assert!(rows.iter().all(|row| row.immigrants == 0));
}

#[test]
fn an_archipelago_of_one_evolves_as_if_there_were_no_migration() {
    let world = World::new();
    let often = world.digest("often", &format!("--n 1 --seed 3 {TINY}"));
    let never = world.digest("never", &format!("--n 1 --seed 3 {TINY} --migrants 0"));
    assert_eq!(often, never);
    let among_two = |name, migrants| {
        world.digest(name, &format!("--n 2 --seed 3 {TINY} --migrants {migrants}"))
    };
    assert_ne!(among_two("two-often", 2), among_two("two-never", 0));
}

#[test]
#[cfg(feature = "view")]
fn a_run_without_a_monitor_loses_nothing_but_the_film() {
    let world = World::new();
    let watched = world.json(&format!("--n 2 --seed 11 --out watched --json {TINY}"));
    let alone = world.json(&format!("--n 2 --seed 11 --out alone --no-monitor --json {TINY}"));
    assert_eq!(watched["digest"], alone["digest"]);
    assert_eq!(watched["recording"], "watched/recording.rrd");
    assert_eq!(alone.get("recording"), None);
    let files = |run: &str| -> Vec<String> {
        let files = world.files().into_iter();
        files.filter_map(|file| file.strip_prefix(run).map(str::to_owned)).collect()
    };
    let mut expected = files("watched/");
    expected.retain(|file| file != "recording.rrd");
    assert_eq!(files("alone/"), expected);
    world.assert_left_nothing();
}

#[test]
fn more_islands_than_cores_work() {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let world = World::new();
    let islands = cores + 3;
    let settings = "--seed 3 --population 2 --robustness 0 --generations 2 --genes 1 --elites 1 --migration-interval 1";
    world.digest("run", &format!("--n {islands} {settings}"));
    let rows = metrics::read(world.read("run/metrics.csv").as_bytes()).unwrap();
    assert_eq!(rows.len(), islands * 3);
}

#[test]
fn two_runs_at_once_do_not_disturb_each_other() {
    let world = World::new();
    let arguments = |out| format!("--n 2 --seed 3 --out {out} --json {TINY}");
    let runs = ["a", "b"].map(|out| world.start(&arguments(out)));
    let [a, b] = runs.map(Running::wait);
    for ending in [&a, &b] {
        assert_eq!(ending.code, Some(0), "{ending:?}");
        assert!(!ending.stderr.contains("warning"), "{ending:?}");
    }
    let address = |ending: &Ending| {
        let line =
            ending.stderr.lines().find_map(|line| line.strip_prefix("watch it live:  rerun "));
        line.map(str::to_owned)
    };
    assert_eq!(address(&a).is_some(), cfg!(feature = "view"));
    assert!(address(&a).is_none() || address(&a) != address(&b), "{a:?} {b:?}");
    let digests = [a, b].map(|ending| ending.json()["digest"].clone());
    assert_eq!(digests[0], digests[1]);
    assert_eq!(digests[0], world.digest("alone", &format!("--n 2 --seed 3 {TINY}")));
}

#[test]
fn flags_win_over_the_file_and_the_file_over_the_defaults() {
    let world = World::new();
    world.write(
        "wish.toml",
        "population = 3\ngenerations = 9\ngenes = 1\nislands = 2\nelites = 1\n",
    );
    world.json("--config wish.toml --generations 1 --seed 3 --out run --no-monitor --json");
    let config = Config::read(&world.path("run/run.toml")).unwrap();
    let expected = Config {
        population: 3,
        generations: 1,
        genes: 1,
        islands: 2,
        elites: 1,
        seed: Some(3),
        launch: config.launch.clone(),
        ..Config::default()
    };
    assert_eq!(config, expected);
}

#[test]
fn a_runs_configuration_reproduces_it() {
    let world = World::new();
    let arguments = format!("--n 2 --seed 13 --selection roulette --crossover-rate 0.3 {TINY}");
    let first = world.digest("first", &arguments);
    assert_eq!(world.digest("second", "--config first/run.toml"), first);
    assert_ne!(world.digest("third", "--config first/run.toml --seed 14"), first);
    let ids = ["first", "second"].map(|run| run_id(&world.read(&format!("{run}/run.toml"))));
    assert_ne!(ids[0], ids[1]);
}

#[test]
fn a_seed_that_was_picked_is_printed_and_reproduces_the_run() {
    let world = World::new();
    let ending = world.islands(&format!("--n 1 --out run --no-monitor --json {TINY}"));
    let run = ending.json();
    let seed = run["seed"].as_u64().unwrap();
    assert!(ending.stderr.contains(&format!("seed {seed}")), "{ending:?}");
    let again = world.digest("again", &format!("--n 1 --seed {seed} {TINY}"));
    assert_eq!(again, run["digest"]);
}

#[test]
fn a_runs_folder_may_have_any_name_that_is_text() {
    use std::ffi::OsString;
    use std::os::unix::ffi::OsStringExt;
    let world = World::new();
    let run = |name: &[u8]| {
        let out = OsString::from_vec([b"--out=", name].concat());
        let settings = format!("--n 1 --seed 3 --quiet {TINY}");
        world.command(&settings).arg(out).output().unwrap()
    };
    assert!(run(b"--parent=1").status.success());
    assert!(world.path("--parent=1/summary.json").exists());
    let before = world.files();
    let refused = run(b"not \xff text");
    assert_eq!(refused.status.code(), Some(2), "{refused:?}");
    let said = String::from_utf8(refused.stderr).unwrap();
    assert_eq!(
        said,
        "error: the folder's name not \u{fffd} text is not UTF-8: choose another one\n"
    );
    assert_eq!(world.files(), before);
    world.assert_left_nothing();
}

#[test]
fn a_launcher_needs_as_much_memory_for_a_long_run_as_for_a_short_one() {
    let world = World::new();
    let run = "--problem sphere --dimensions 500 --n 2 --seed 3 --population 4 --no-monitor --quiet --json";
    let [short, long] = [200, 1_500].map(|generations| {
        let out = format!("run-{generations}");
        let running = world.start(&format!("{run} --generations {generations} --out {out}"));
        let peak_kb = peak_memory_kb(&running);
        let ending = running.wait();
        assert_eq!(ending.code, Some(0), "{ending:?}");
        let dir = RunDir::at(world.path(&out));
        let logs = [0, 1].map(|island| std::fs::metadata(dir.champions(island)).unwrap().len());
        (peak_kb, logs.iter().sum::<u64>() / 1_000)
    });
    let (more_kb, more_on_disk_kb) = (long.0.saturating_sub(short.0), long.1 - short.1);
    assert!(more_on_disk_kb > 4_000, "{short:?}, {long:?}");
    assert!(more_kb < more_on_disk_kb / 2, "{short:?}, {long:?}");
}

/// The most memory that a process had until it ended, in kilobytes.
fn peak_memory_kb(running: &Running) -> u64 {
    let status = format!("/proc/{}/status", running.pid());
    let mut peak_kb = 0;
    while running.is_alive() {
        let text = std::fs::read_to_string(&status).unwrap_or_default();
        let line = text.lines().find_map(|line| line.strip_prefix("VmHWM:"));
        let said = line.and_then(|line| line.trim().strip_suffix(" kB")?.parse().ok());
        peak_kb = peak_kb.max(said.unwrap_or(0));
        sleep(Duration::from_millis(10));
    }
    assert!(peak_kb > 1_000, "{peak_kb} kB");
    peak_kb
}
