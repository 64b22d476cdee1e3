//! Same seed, same bits: whatever the threads, the processes and the day.
//!
//! `tests/golden` holds configurations and, beside each, the digest that it has had since it was committed.
//! After a change that is meant to change results, write them anew and say so in the commit:
//! `ISLANDS_BLESS=1 cargo test --release golden`.

use crate::support::World;
use islands::archipelago::{Digest, Step, lockstep};
use islands::formats::metrics::{self, Row};
use islands::runs::catalogue::Visitor;
use islands::runs::config::Config;
use islands::runs::kind::Kind;
use islands::runs::subject::Subject;
use islands::simulation::Engine;
use islands::store::RunDir;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

const BLESS: &str = "ISLANDS_BLESS";

/// The digest and the metrics of a configuration's archipelago, evolved in this process.
pub fn in_lockstep(config: &Config) -> (String, Vec<Row>) {
    config.visit(Lockstep(config))
}

struct Lockstep<'a>(&'a Config);

impl Visitor for Lockstep<'_> {
    type Output = (String, Vec<Row>);

    fn visit<P: Subject>(self, problem: P) -> Self::Output {
        let mut rows = Vec::new();
        let observe = |step: &Step<P::Gene>| rows.push(Row::new(&step.report, 0.0));
        let islands = lockstep::run(&problem, &self.0.archipelago(), self.0.generations, observe);
        (Digest::of(&islands).to_string(), rows)
    }
}

/// The same of a run in processes.
pub fn in_processes(world: &World, name: &str, settings: &str) -> (String, Vec<Row>) {
    let digest = world.digest(name, settings);
    let file = fs::File::open(RunDir::at(world.path(name)).metrics()).unwrap();
    let timeless = |row| Row { seconds: 0.0, ..row };
    (digest, metrics::read(file).unwrap().into_iter().map(timeless).collect())
}

#[test]
fn the_number_of_threads_changes_no_digest_and_no_metric() {
    let world = World::new();
    let settings = "--n 2 --seed 17 --population 6 --robustness 3 --generations 3 --genes 2 --migration-interval 1";
    let run = |threads| {
        let name = format!("threads-{threads}");
        in_processes(&world, &name, &format!("{settings} --threads {threads}"))
    };
    let one = run(1);
    assert_eq!(one.1.len(), 8);
    assert_eq!(run(2), one);
    assert_eq!(run(5), one);
}

#[test]
fn processes_that_exchange_migrants_equal_an_archipelago_in_one_process() {
    let world = World::new();
    let settings = "--seed 19 --population 4 --robustness 0 --generations 3 --genes 2";
    for (name, more) in [
        ("three", "--n 3 --migration-interval 1"),
        ("three-at-once", "--n 3 --migration-interval 2 --migration-lag 0"),
        ("two-send-all", "--n 2 --migration-interval 1 --migrants 4"),
        (
            "torus",
            "--n 6 --topology torus --emigrants tournament:2 --replacement similar --migration-interval 1",
        ),
        (
            "star",
            "--n 4 --topology star --emigrants random --replacement random --migration-interval 1",
        ),
        (
            "random",
            "--n 5 --topology random-regular:2 --replacement similar --migration-interval 1",
        ),
    ] {
        let found = in_processes(&world, name, &format!("{settings} {more}"));
        let config = Config::read(&RunDir::at(world.path(name)).config()).unwrap();
        assert_eq!(found, in_lockstep(&config), "{name}");
        assert!(found.1.iter().any(|row| row.immigrants > 0), "{name}");
    }
}

#[test]
fn every_part_of_a_seed_matters() {
    let digest = |seed| {
        let small = Config { islands: 1, population: 2, elites: 1, genes: 1, ..Config::default() };
        in_lockstep(&Config { seed: Some(seed), generations: 0, ..small }).0
    };
    let seeds = [0, 1, 1 << 32, i64::MAX as u64];
    let digests: BTreeSet<String> = seeds.map(digest).into();
    assert_eq!(digests.len(), seeds.len());
}

#[test]
fn golden_runs_have_had_the_same_digest_since_they_were_committed() {
    let goldens = goldens();
    let names: Vec<_> = goldens.iter().map(|path| path.file_stem().unwrap()).collect();
    let expected = [
        "ackley-crowding",
        "climb-featherstone",
        "climb-quartile",
        "climb-rapier",
        "climb-terrain",
        "course-coursework",
        "debug-featherstone",
        "debug",
        "double-pole-species",
        "griewank-sharing",
        "rastrigin",
        "royal-road-hill-climb",
        "schwefel-map-elites",
        "sphere-cma-es",
        "trap-afpo",
        "trap",
        "travel-lecture",
        "travel-worst",
        "walk-featherstone",
        "walk-native",
        "xor-species",
    ];
    assert_eq!(names, expected);
    let world = World::new();
    let mut wrong = Vec::new();
    for config in &goldens {
        let name = config.file_stem().unwrap().to_str().unwrap();
        let terrain = config.with_extension("obj");
        let terrain = match terrain.exists() {
            true => format!("--terrain {}", terrain.display()),
            false => String::new(),
        };
        let settings = format!("--config {} {terrain}", config.display());
        let (found, rows) = in_processes(&world, name, &settings);
        // One that nobody travels in would not show a change of the exchange.
        let is_idle = name.starts_with("debug")
            || Config::read(config).unwrap().archipelago().migration.migrants == 0;
        assert!(is_idle || rows.iter().any(|row| row.immigrants > 0), "{name}");
        let file = config.with_extension("digest");
        if std::env::var_os(BLESS).is_some() {
            fs::write(&file, format!("{found}\n")).unwrap();
        }
        let expected = fs::read_to_string(&file).unwrap_or_default();
        if expected.trim_end() != found {
            wrong.push(format!("{name} has {found}, not {expected:?}"));
        }
    }
    let advice = "if results are meant to change: ISLANDS_BLESS=1 cargo test --release golden";
    assert!(wrong.is_empty(), "{}\n{advice}", wrong.join("\n"));
}

/// The gate runs this on a processor of another year, too, which it emulates: hence one process and little work.
#[test]
fn small_golden_runs_have_their_digest_in_one_process() {
    let is_small = |path: &PathBuf| {
        let config = Config::read(path).unwrap();
        match config.problem {
            Kind::Creatures => config.generations <= 1,
            Kind::Function(_) | Kind::Bits(_) => true,
            Kind::Network(_) => false,
        }
    };
    let small: Vec<PathBuf> = goldens().into_iter().filter(is_small).collect();
    let engines: BTreeSet<_> =
        small.iter().map(|path| Config::read(path).unwrap().engine.to_string()).collect();
    assert_eq!(engines.len(), Engine::ALL.len(), "both engines are tried");
    for path in small {
        let expected = fs::read_to_string(path.with_extension("digest")).unwrap();
        assert_eq!(in_lockstep(&Config::read(&path).unwrap()).0, expected.trim_end(), "{path:?}");
    }
}

/// What a debug build makes of those called so is part of the gate.
#[test]
fn every_engine_has_a_golden_run_and_one_for_a_debug_build() {
    let engine = |path: &PathBuf| Config::read(path).unwrap().engine;
    let is_debug =
        |path: &&PathBuf| path.file_stem().unwrap().to_str().unwrap().starts_with("debug");
    let (debug, release): (Vec<_>, Vec<_>) = goldens().into_iter().partition(|p| is_debug(&p));
    for wanted in Engine::ALL {
        assert!(debug.iter().any(|path| engine(path) == wanted), "{wanted} in debug");
        assert!(release.iter().any(|path| engine(path) == wanted), "{wanted}");
    }
}

/// The configurations, in order.
fn goldens() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden");
    let files = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut configs: Vec<_> =
        files.filter(|path| path.extension().is_some_and(|end| end == "toml")).collect();
    configs.sort();
    configs
}
