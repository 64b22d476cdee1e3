//! Any process of a run may die at any moment: the run goes on, and ends in the same bits.

use crate::support::{Running, World, await_generation, checkpoints, signal, try_signal, until};
use islands::store::{RunDir, checkpoint};
use std::fs;
use std::process::{Command, Stdio};

/// A run of a second or two in which every generation matters to every island.
const RUN: &str = "--n 3 --seed 29 --population 5 --robustness 0 --generations 16 --genes 2 --migration-interval 2";

fn start(world: &World, settings: &str) -> Running {
    world.start(&format!("--out run --no-monitor --json {settings}"))
}

#[test]
fn an_island_that_is_killed_twenty_times_in_fifty_generations_changes_nothing() {
    let world = World::new();
    let settings = "--n 3 --seed 31 --population 4 --robustness 0 --generations 50 --genes 2";
    let expected = world.digest("undisturbed", settings);
    let dir = RunDir::at(world.path("run"));
    let run = start(&world, settings);
    for death in 1..=20 {
        await_generation(&dir, 3, 2 * death);
        signal(run.child("--index=1"), "KILL");
        let said = "island 1 died (signal: 9 (SIGKILL)); it is started again\n";
        until("its death is noticed", || {
            world.read("run/run.log").matches(said).count() == death as usize
        });
    }
    let ending = run.wait();
    assert_eq!(ending.code, Some(0), "{ending:?}");
    assert_eq!(ending.json()["digest"], expected);
    let log = world.read("run/run.log");
    let recoveries = log.lines().filter(|line| line.contains("island 1 goes on after generation"));
    assert!(recoveries.clone().all(|line| line.ends_with("s after its death")), "{log}");
    // One that is killed again before it goes on has not recovered.
    assert!(recoveries.count() >= 15, "{log}");
    world.assert_left_nothing();
}

#[test]
fn all_islands_may_die_at_once_again_and_again() {
    let world = World::new();
    let expected = world.digest("undisturbed", RUN);
    let dir = RunDir::at(world.path("run"));
    let run = start(&world, RUN);
    for generation in [0, 3, 4, 9, 13] {
        await_generation(&dir, 3, generation);
        for pid in run.children() {
            try_signal(pid, "KILL");
        }
    }
    let ending = run.wait();
    assert_eq!(ending.json()["digest"], expected, "{ending:?}");
    world.assert_left_nothing();
}

#[test]
fn a_run_whose_program_is_removed_goes_on_with_it() {
    let world = World::new();
    let expected = world.digest("undisturbed", RUN);
    let copy = world.path("copy");
    fs::copy(env!("CARGO_BIN_EXE_islands"), &copy).unwrap();
    let mut command = Command::new(&copy);
    let original = world.command(&format!("--out run --no-monitor --json {RUN}"));
    command.args(original.get_args()).current_dir(world.path("")).stdin(Stdio::null());
    command.envs(original.get_envs().filter_map(|(name, value)| Some((name, value?))));
    let run = Running::of(command);
    await_generation(&RunDir::at(world.path("run")), 3, 2);
    fs::remove_file(&copy).unwrap();
    signal(run.child("--index=1"), "KILL");
    let ending = run.wait();
    assert_eq!(ending.code, Some(0), "{ending:?}");
    assert!(ending.stderr.contains("island 1 died"), "{ending:?}");
    assert_eq!(ending.json()["digest"], expected);
    world.assert_left_nothing();
}

#[test]
fn an_island_with_rare_checkpoints_evolves_again_what_it_had_not_saved() {
    let world = World::new();
    let expected = world.digest("undisturbed", RUN);
    let dir = RunDir::at(world.path("run"));
    let run = start(&world, &format!("{RUN} --checkpoint-interval 6"));
    for generation in [5, 11, 13] {
        await_generation(&dir, 3, generation);
        signal(run.child("--index=2"), "KILL");
    }
    let ending = run.wait();
    assert_eq!(ending.json()["digest"], expected, "{ending:?}");
    let rows = fs::read_to_string(world.path("run/metrics.csv")).unwrap();
    assert_eq!(rows, timeless_rows(&rows, &world.read("undisturbed/metrics.csv")));
    let saved: Vec<_> =
        fs::read_dir(dir.checkpoints(2)).unwrap().map(|f| f.unwrap().file_name()).collect();
    assert_eq!(saved.len(), 2, "{saved:?}");
    assert!(dir.checkpoint(2, 12).exists() && dir.checkpoint(2, 16).exists(), "{saved:?}");
}

/// The rows of `expected` with the seconds of `found`, which no seed fixes.
fn timeless_rows(found: &str, expected: &str) -> String {
    let row = |(found, expected): (&str, &str)| {
        let seconds = found.rsplit_once(',').unwrap().1;
        format!("{},{seconds}\n", expected.rsplit_once(',').unwrap().0)
    };
    assert_eq!(found.lines().count(), expected.lines().count());
    found.lines().zip(expected.lines()).map(row).collect()
}

/// Interrupts a run after some generations, does something to its files, and goes on.
fn after_harm(settings: &str, harm: impl Fn(&RunDir)) -> (String, String, String) {
    let world = World::new();
    let expected = world.digest("undisturbed", settings);
    let dir = RunDir::at(world.path("run"));
    let run = start(&world, settings);
    await_generation(&dir, 3, 7);
    run.signal("INT");
    assert_eq!(run.wait().code, Some(130));
    harm(&dir);
    let ending = world.islands("resume run --no-monitor --json");
    assert_eq!(ending.code, Some(0), "{ending:?}");
    world.assert_left_nothing();
    let log = world.read("run/run.log");
    assert!(
        log.lines().all(|line| line.contains(" INFO ") || ending.stderr.contains(&line[35..])),
        "{log}"
    );
    (expected, ending.json()["digest"].as_str().unwrap().to_owned(), ending.stderr)
}

fn cut(path: &std::path::Path) {
    let bytes = fs::read(path).unwrap();
    fs::write(path, &bytes[..bytes.len() / 2]).unwrap();
}

fn flip(path: &std::path::Path, at: usize) {
    let mut bytes = fs::read(path).unwrap();
    bytes[at] ^= 1;
    fs::write(path, bytes).unwrap();
}

#[test]
fn a_damaged_checkpoint_is_named_and_the_one_before_it_used() {
    for harm in [|path: &std::path::Path| cut(path), |path: &std::path::Path| flip(path, 99)] {
        let (expected, found, said) = after_harm(RUN, |dir| harm(&checkpoints(dir, 1)[0]));
        assert_eq!(found, expected);
        let warnings: Vec<_> = said.lines().filter(|line| line.starts_with("warning: ")).collect();
        assert_eq!(warnings.len(), 1, "{said}");
        let is_said = warnings[0].starts_with("warning: island 1: run/checkpoints/island-1/")
            && warnings[0].contains(".ckpt is damaged: ");
        assert!(is_said, "{said}");
        assert!(said.contains("island 1 goes on after generation"), "{said}");
    }
}

#[test]
fn without_a_whole_checkpoint_an_island_starts_again_from_the_seed() {
    let (expected, found, said) = after_harm(RUN, |dir| {
        checkpoints(dir, 0).iter().for_each(|path| cut(path));
        fs::remove_dir_all(dir.checkpoints(2)).unwrap();
    });
    assert_eq!(found, expected);
    for island in [0, 2] {
        let warning = format!(
            "warning: island {island}: no checkpoint is of use: it starts again from the seed"
        );
        assert!(said.lines().any(|line| line == warning), "{said}");
    }
}

#[test]
fn damaged_logs_are_evolved_again_too() {
    type Log = fn(&RunDir) -> std::path::PathBuf;
    let logs: [(&str, Log); 4] = [
        ("reports", |dir| dir.reports(1)),
        ("lineages", |dir| dir.lineages(1)),
        ("migrations", |dir| dir.migrations(1)),
        ("champions", |dir| dir.champions(1)),
    ];
    for (name, log) in logs {
        let (expected, found, said) = after_harm(RUN, |dir| flip(&log(dir), 20));
        assert_eq!(found, expected, "{name}");
        let reason = format!("the island's {name} do not reach generation");
        assert!(said.contains(&reason) && said.contains("starts again from the seed"), "{said}");
    }
}

#[test]
fn a_checkpoint_of_another_format_version_is_a_clear_error() {
    let world = World::new();
    let dir = RunDir::at(world.path("run"));
    let run = start(&world, RUN);
    await_generation(&dir, 3, 3);
    run.signal("INT");
    assert_eq!(run.wait().code, Some(130));
    let newest = &checkpoints(&dir, 1)[0];
    let mut bytes = fs::read(newest).unwrap();
    bytes[8] = 2;
    let sum = bytes.len() - 8;
    let hash = blake3::hash(&bytes[..sum]);
    bytes[sum..].copy_from_slice(&hash.as_bytes()[..8]);
    fs::write(newest, bytes).unwrap();
    assert!(checkpoint::load::<islands::creature::Gene>(newest).is_err());
    let said = world.refusal("resume run --no-monitor");
    assert!(said.contains("has format version 2, and this program reads version 1"), "{said}");
}
