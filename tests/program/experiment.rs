//! Experiments: many runs in one process, each the one that `islands run` makes; what is there is not run again.

use crate::support::{Ending, World, until};
use expect_test::expect;
use std::collections::BTreeMap;
use std::fs;

const BASE: &str = "[base]\nrobustness = 0\njudged = false\nengine = \"featherstone\"\nislands = 2\npopulation = 4\ngenes = 2\nmigration-interval = 1\n";
const GRID: &str = "[grid]\nmigrants = [0, 1]\nselection = [\"rank:1.8\", \"tournament:2\"]\n";

/// The rows of a table, a map from column to cell each.
fn rows(world: &World, name: &str) -> Vec<BTreeMap<String, String>> {
    let mut reader = csv::Reader::from_path(world.path(name)).unwrap();
    reader.deserialize().map(Result::unwrap).collect()
}

/// Everything that an experiment has left but the time that it took.
fn results(world: &World, folder: &str) -> BTreeMap<String, String> {
    let files = ["curves.csv", "summary.csv", "comparisons.csv", "summary.md", "convergence.svg"];
    let files = files.into_iter().chain(["experiment.toml"]);
    let mut all: BTreeMap<String, String> =
        files.map(|name| (name.to_owned(), world.read(&format!("{folder}/{name}")))).collect();
    let timeless = |line: &str| line.rsplit_once(',').unwrap().0.to_owned();
    let runs: Vec<String> =
        world.read(&format!("{folder}/runs.csv")).lines().map(timeless).collect();
    all.insert("runs.csv".to_owned(), runs.join("\n"));
    all
}

fn finished_runs(world: &World, folder: &str) -> Vec<String> {
    let names = fs::read_dir(world.path(folder).join("runs")).into_iter().flatten();
    let mut names: Vec<_> =
        names.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

fn says(ending: &Ending, sentence: &str) {
    assert!(ending.code == Some(0) && ending.stderr.contains(sentence), "{ending:?}");
}

#[test]
fn each_run_has_the_digest_that_islands_run_prints() {
    let world = World::new();
    world.write("tiny.toml", format!("seeds = [3, 8]\n{BASE}generations = 3\n{GRID}"));
    let result = world.json("experiment tiny.toml --json --threads 2");
    assert_eq!((&result["runs"], &result["kept"]), (&8.into(), &0.into()));
    assert_eq!(result["unit"], "m");
    let settings = "--n 2 --population 4 --robustness 0 --genes 2 --migration-interval 1 --engine featherstone";
    let rows = rows(&world, "experiments/tiny/runs.csv");
    assert_eq!(rows.len(), 8);
    for (index, row) in rows.iter().enumerate() {
        let [seed, migrants, selection] = ["seed", "migrants", "selection"].map(|key| &row[key]);
        assert_eq!(row["setting"], format!("migrants={migrants},selection={selection}"));
        let own = format!("--seed {seed} --migrants {migrants} --selection {selection}");
        let run = world.json(&format!(
            "run --no-monitor --quiet --json --generations 3 --out {index} {settings} {own}"
        ));
        assert_eq!(row["digest"], run["digest"], "{row:?}");
        assert_eq!(row["evaluations"], run["evaluations"].to_string());
        let validated: f64 = row["validated"].parse().unwrap();
        assert_eq!(validated.to_bits(), run["validated"].as_f64().unwrap().to_bits());
        let apart: f64 = row["apart"].parse().unwrap();
        assert!((0.0..=1.0).contains(&apart), "{row:?}");
        assert_eq!((row["final_generation"].as_str(), row["success"].as_str()), ("3", ""));
    }
    world.assert_left_nothing();
}

#[test]
fn a_run_that_its_budget_ended_is_the_run_of_as_many_generations() {
    let world = World::new();
    world.write("tiny.toml", format!("seeds = 1\nevaluations = 19\ntarget = 0.0\n{BASE}"));
    world.json("experiment tiny.toml --quiet --json --out here");
    let row = &rows(&world, "here/runs.csv")[0];
    let last: u32 = row["final_generation"].parse().unwrap();
    let settings = "--n 2 --population 4 --robustness 0 --genes 2 --migration-interval 1 --engine featherstone";
    let digest = world.digest("run", &format!("--seed 1 --generations {last} {settings}"));
    assert_eq!(row["digest"], digest);
    let curve = rows(&world, "here/curves.csv");
    assert_eq!(curve.len() as u32, last + 1);
    let evaluations = |generation: u32| curve[generation as usize]["evaluations"].parse::<u64>();
    assert!(evaluations(last).unwrap() >= 19 && evaluations(last - 1).unwrap() < 19);
    assert_eq!(row["success"], "true");
    assert_eq!(row["evaluations_to_target"], "8", "random creatures get further than nowhere");
}

#[test]
fn an_experiment_that_is_interrupted_keeps_what_has_finished_and_goes_on_whatever_the_threads() {
    let world = World::new();
    world.write("some.toml", format!("seeds = 5\n{BASE}generations = 8\n{GRID}"));
    let running = world.start("experiment some.toml --out a --threads 3");
    until("some runs have finished", || finished_runs(&world, "a").len() >= 2);
    let refusal = world.islands("experiment some.toml --out a");
    assert_eq!(refusal.code, Some(2));
    assert_eq!(refusal.stderr, "error: the experiment in a is under way in another process\n");
    running.signal("INT");
    let ending = running.wait();
    assert_eq!((ending.code, ending.stdout.as_str()), (Some(130), ""), "{ending:?}");
    let kept = finished_runs(&world, "a");
    let said = ending.stderr.lines().next_back().unwrap();
    let count = kept.len();
    assert_eq!(
        said,
        format!("error: interrupted: {count} of 20 runs are kept in a; the same command goes on")
    );
    assert!((2..20).contains(&count) && !world.path("a/.partial").exists());

    let old = kept.iter().map(|name| world.read(&format!("a/runs/{name}"))).collect::<Vec<_>>();
    let ending = world.islands("experiment some.toml --out a --threads 3 --json");
    says(&ending, &format!("{count} of 20 runs are there already"));
    assert_eq!(ending.json()["kept"], count);
    let new = kept.iter().map(|name| world.read(&format!("a/runs/{name}"))).collect::<Vec<_>>();
    assert!(old == new, "what was there was not run again");
    world.json("experiment some.toml --out b --threads 1 --json --quiet");
    assert_eq!(results(&world, "a"), results(&world, "b"));
    world.assert_left_nothing();
}

#[test]
fn a_definition_that_has_changed_runs_only_what_is_missing_and_says_so() {
    let world = World::new();
    let definition = |seeds: &str, more: &str, migrants: &str| {
        format!("seeds = {seeds}\n{more}{BASE}generations = 2\n[grid]\nmigrants = {migrants}\n")
    };
    let go = |text: String| {
        world.write("small.toml", text);
        world.islands("experiment small.toml --out a --json")
    };
    let first = go(definition("3", "", "[0, 1]"));
    assert!(first.code == Some(0) && !first.stderr.contains("definition"), "{first:?}");
    let more = go(definition("[2, 3, 4]", "target = 0.5\n", "[1, 2]"));
    says(
        &more,
        "the definition has changed: of its 6 runs 2 are there already and 4 are to be run",
    );
    assert_eq!(more.json()["settings"].as_array().unwrap().len(), 2);
    assert_eq!(rows(&world, "a/runs.csv").len(), 6);
    // What the first definition asked for is still there.
    let back = go(definition("3", "", "[0, 1]"));
    says(&back, "of its 6 runs 6 are there already");
    assert_eq!(back.json()["kept"], 6);
    assert_eq!(back.json()["settings"], first.json()["settings"]);
}

#[test]
fn a_run_whose_file_is_damaged_is_run_again() {
    let world = World::new();
    world.write("small.toml", format!("seeds = 2\n{BASE}generations = 2\n"));
    world.json("experiment small.toml --out a --json");
    let before = results(&world, "a");
    let names = finished_runs(&world, "a");
    assert_eq!(names.len(), 2);
    let whole = world.read(&format!("a/runs/{}", names[0]));
    world.write(&format!("a/runs/{}", names[0]), &whole[..whole.len() / 2]);
    // A file that says that it is another one is damaged, too.
    world.write(&format!("a/runs/{}", names[1]), whole);
    let again = world.json("experiment small.toml --out a --json");
    assert_eq!(again["kept"], 0);
    assert_eq!(results(&world, "a"), before);
}

#[test]
fn an_experiment_that_makes_no_sense_is_refused_before_anything_is_made() {
    let world = World::new();
    world.write("unknown.toml", "[base]\npopluation = 3\n");
    world.write("impossible.toml", "[grid]\nmigrants = [1, 30]\n");
    world.write("fine.toml", "");
    fs::create_dir(world.path("full")).unwrap();
    world.write("full/precious", "");
    let refusals = [
        "nowhere.toml",
        "unknown.toml",
        "impossible.toml",
        "fine.toml --out full",
        "fine.toml --threads 0",
    ]
    .map(|arguments| world.refusal(&format!("experiment {arguments}")));
    expect![[r#"
        cannot use nowhere.toml: No such file or directory (os error 2); name the file of an experiment, see islands experiment --help
        cannot use unknown.toml: [base] has an unknown setting popluation: see islands run --help
        cannot use impossible.toml: setting migrants=30: 30 migrants are more than there can be: take at most 24, with a population of 24
        cannot use full: it holds something that is no experiment; choose another folder with --out
        --threads must be from 1 to 4096"#]]
    .assert_eq(&refusals.join("\n"));
}
