//! Whatever searches, the promises hold: real processes equal one process, a killed run goes on to the same result,
//! and what it claims can be verified.

use crate::promises::determinism::{in_lockstep, in_processes};
use crate::support::{World, await_generation};
use islands::runs::config::Config;
use islands::store::RunDir;
use std::collections::BTreeSet;
use std::fs;

/// Ways to search that differ in as much as possible; among them every algorithm, survival and adaptation.
const WAYS: [&str; 11] = [
    "--problem sphere --dimensions 4 --algorithm cma-es",
    "--problem sphere --dimensions 4 --algorithm hill-climb --mutation gaussian",
    "--problem onemax --dimensions 30 --algorithm random",
    "--problem rastrigin --dimensions 4 --algorithm panmictic --selection sus",
    "--problem ackley --dimensions 4 --survival crowding --crossover blend --adaptation one-fifth",
    "--problem griewank --dimensions 4 --survival sharing:0.2 --heterogeneous --topology hypercube",
    "--problem trap --dimensions 30 --survival afpo --crossover uniform --topology star",
    "--problem schwefel --dimensions 4 --survival map-elites:5 --topology full",
    "--problem rosenbrock --dimensions 4 --selection rank --crossover two-point --emigrants random \
     --replacement similar --topology bidirectional-ring --adaptation one-fifth",
    "--problem xor",
    "--problem double-pole --start random:4 --survival species:2 --replacement similar",
];

const SIZE: &str = "--n 4 --seed 3 --population 8 --generations 25";

/// A way with its size; where there are exchanges, there are many.
fn sized(way: &str) -> String {
    let exchanges = if way.contains("--algorithm") { "" } else { "--migration-interval 2" };
    format!("{way} {SIZE} {exchanges}")
}

#[test]
fn whatever_searches_processes_equal_an_archipelago_in_one_process_and_verify() {
    let world = World::new();
    let mut digests = BTreeSet::new();
    for (number, way) in WAYS.into_iter().enumerate() {
        let name = format!("run-{number}");
        let found =
            in_processes(&world, &name, &format!("{} --threads {}", sized(way), number % 3 + 1));
        let config = Config::read(&RunDir::at(world.path(&name)).config()).unwrap();
        assert_eq!(found, in_lockstep(&config), "{way}");
        let verdict = world.json(&format!("verify {name} --thorough --json"));
        assert_eq!(verdict["ok"], true, "{way}: {verdict}");
        digests.insert(found.0);
    }
    assert_eq!(digests.len(), WAYS.len());
}

/// On a royal road most mutants are worth as much as their mother. A climber that took none of them stayed at 24 of 64.
#[test]
fn a_climber_crosses_what_is_flat() {
    let settings =
        "problem = \"royal-road\"\nislands = 1\nalgorithm = \"hill-climb\"\ngenerations = 1300";
    for seed in 1..=5 {
        let config = Config { seed: Some(seed), ..Config::parse(settings).unwrap() };
        let (_, rows) = in_lockstep(&config);
        assert_eq!(rows.last().unwrap().best, Some(64.0), "seed {seed}");
    }
}

#[test]
fn whatever_searches_a_run_whose_processes_are_killed_comes_to_the_same() {
    let world = World::new();
    for (number, way) in
        WAYS.into_iter().enumerate().filter(|(number, _)| [0, 4, 6, 7, 9].contains(number))
    {
        let settings = format!("{} --generations 400 --checkpoint-interval 3", sized(way));
        let settings = settings.replace("--generations 25 ", "");
        let expected = world.digest(&format!("undisturbed-{number}"), &settings);
        let name = format!("killed-{number}");
        let dir = RunDir::at(world.path(&name));
        let run = world.start(&format!("--out {name} --no-monitor --quiet {settings}"));
        await_generation(&dir, 4, 30);
        if let Some(island) = run.find_child("--index=1") {
            crate::support::try_signal(island, "KILL");
        }
        await_generation(&dir, 4, 80);
        run.signal("KILL");
        run.wait();
        let result = world.json(&format!("resume {name} --no-monitor --json"));
        assert_eq!(result["digest"], expected, "{way}");
    }
    world.assert_left_nothing();
}

#[test]
fn a_map_of_elites_is_left_with_a_genome_in_each_cell() {
    let world = World::new();
    let way = "--robustness 0 --survival map-elites:6 --genes 3";
    world.digest("run", &format!("--n 2 --seed 3 --population 10 --generations 3 {way}"));
    let mut table = csv::Reader::from_path(world.path("run/map.csv")).unwrap();
    let names = table.headers().unwrap().clone();
    assert_eq!(&names[0], "links cell");
    let rows: Vec<_> = table.records().map(Result::unwrap).collect();
    let cells: BTreeSet<_> =
        rows.iter().map(|row| (row[0].to_owned(), row[1].to_owned())).collect();
    assert!(rows.len() > 2 && cells.len() == rows.len(), "{rows:?}");
    assert_eq!(fs::read_dir(world.path("run/map")).unwrap().count(), rows.len());
    let some = &rows[rows.len() / 2];
    let scores = world.json(&format!("evaluate run/{} --robustness 0 --json", &some[6]));
    assert_eq!(scores["genomes"][0]["fitness"].as_f64(), some[4].parse().ok());
    assert_eq!(world.json("verify run --json")["ok"], true);
}

#[test]
fn what_cannot_search_there_is_refused() {
    let world = World::new();
    let refusal = world.refusal("run --problem onemax --algorithm cma-es");
    assert!(refusal.contains("cma-es learns from numbers"), "{refusal}");
    let refusal = world.refusal("run --survival map-elites:1");
    assert!(refusal.contains("map-elites takes a whole number from 2 to 64"), "{refusal}");
}
