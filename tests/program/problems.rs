//! Numbers and bits on the same islands as creatures.

use crate::promises::determinism::{in_lockstep, in_processes};
use crate::support::{World, await_generation, run_id};
use expect_test::expect;
use islands::problems::{Benchmark, Function};
use islands::runs::config::Config;
use islands::store::RunDir;
use std::fs;

const RASTRIGIN: &str = "--problem rastrigin --dimensions 5 --n 2 --seed 3 --population 8 --generations 30 \
                         --migration-interval 3 --checkpoint-interval 4";
const ONEMAX: &str = "--problem onemax --dimensions 40 --n 3 --seed 4 --population 6 --generations 20 \
                      --migration-interval 2 --migration-lag 0";

#[test]
fn processes_that_evolve_numbers_or_bits_equal_an_archipelago_in_one_process() {
    let world = World::new();
    let rotated = format!("{RASTRIGIN} --rotated --instance 5");
    for (name, settings) in [("numbers", RASTRIGIN), ("rotated", &rotated), ("bits", ONEMAX)] {
        let found = in_processes(&world, name, settings);
        let config = Config::read(&RunDir::at(world.path(name)).config()).unwrap();
        assert_eq!(found, in_lockstep(&config), "{name}");
        assert!(found.1.iter().any(|row| row.immigrants > 0), "{name}");
        let best = |generation| {
            let rows = found.1.iter().filter(|row| row.generation == generation);
            rows.filter_map(|row| row.best).reduce(f64::max).unwrap()
        };
        assert!(best(config.generations) > best(0), "{name} gets better");
    }
}

#[test]
fn whoever_evaluates_a_champion_gets_its_fitness_to_the_last_bit() {
    let world = World::new();
    let problems = [
        ("a", "--problem ackley --rotated --dimensions=4"),
        ("b", "--problem schwefel --instance 9 --dimensions=4"),
        ("c", "--problem trap --block 4 --dimensions=12"),
        ("d", "--problem royal-road --dimensions=64"),
    ];
    for (name, problem) in problems {
        let rest = "--n 1 --seed 3 --population 6 --generations 5 --no-monitor --json";
        let run = world.json(&format!("{problem} {rest} --out {name}"));
        let scores = world.json(&format!("evaluate {name}/champion.csv {problem} --json"));
        assert_eq!(scores["genomes"][0]["fitness"], run["best_fitness"], "{problem}");
        assert_eq!(scores["problem"], run["problem"]);
        let other = problem.split("--dimensions").next().unwrap();
        let other = format!("evaluate {name}/champion.csv {other} --dimensions 500");
        assert!(world.refusal(&other).contains("--dimensions"), "{problem}");
    }
}

#[test]
fn a_champion_stands_in_a_table_with_the_variables_that_its_genes_are() {
    let world = World::new();
    world.digest("run", RASTRIGIN);
    let problem = Benchmark::new(Function::Rastrigin, 5, 1, false);
    let table = world.read("run/champion.csv");
    let (head, rows) = table.split_once('\n').unwrap();
    assert_eq!(head, "gene,x");
    assert_eq!(rows.lines().count(), 5);
    for row in rows.lines() {
        let cells: Vec<f64> = row.split(',').map(|cell| cell.parse().unwrap()).collect();
        assert_eq!(problem.variable(islands::problems::Real(cells[0])), cells[1]);
    }
    assert!(!world.path("run/champion.urdf").exists());
}

#[test]
fn a_run_of_numbers_whose_launcher_is_killed_goes_on_to_the_same_result_and_verifies() {
    let world = World::new();
    // Long enough to be killed in the middle.
    let settings = RASTRIGIN.replace("--generations 30", "--generations 1500");
    let expected = world.digest("undisturbed", &settings);
    let dir = RunDir::at(world.path("run"));
    {
        let run = world.start(&format!("--out run --no-monitor --quiet {settings}"));
        await_generation(&dir, 2, 20);
        run.signal("KILL");
        run.wait();
    }
    assert!(!dir.summary().exists(), "it was killed before its end");
    let result = world.json("resume run --no-monitor --json");
    assert_eq!(result["digest"], expected);
    let verdict = world.json("verify run --thorough --json");
    assert_eq!((&verdict["ok"], &verdict["digest"]), (&true.into(), &expected.into()));
    for file in ["champion.csv", "metrics.csv"] {
        let timeless = |run: &str| {
            let text = world.read(&format!("{run}/{file}"));
            let line = |line: &str| line.rsplit_once(',').map(|(line, _)| line.to_owned());
            text.lines().map(line).collect::<Vec<_>>()
        };
        assert_eq!(timeless("run"), timeless("undisturbed"), "{file}");
    }
    assert!(!run_id(&world.read("run/run.toml")).is_empty());
    world.assert_left_nothing();
}

#[test]
fn a_champion_of_bits_that_was_changed_is_found_out() {
    let world = World::new();
    world.digest("run", ONEMAX);
    assert_eq!(world.json("verify run --json")["ok"], true);
    let path = world.path("run/champion.csv");
    let text = fs::read_to_string(&path).unwrap();
    fs::write(&path, text.replacen('1', "0", 1)).unwrap();
    let ending = world.islands("verify run");
    assert_eq!(ending.code, Some(1), "{ending:?}");
    assert!(ending.stdout.contains("champion.csv is damaged"), "{ending:?}");
}

#[test]
fn a_run_of_a_problem_says_all_that_decides_it_and_nothing_else() {
    let world = World::new();
    let settings = "--problem royal-road --n 1 --seed 3 --generations 2";
    let first = world.digest("first", settings);
    let said = world.read("first/run.toml");
    let said = said.split("\n[launch]").next().unwrap();
    expect![[r#"
        islands = 1
        seed = 3
        problem = "royal-road"
        algorithm = "ga"
        generations = 2
        population = 50

        [vectors]
        dimensions = 64
        block = 8

        [genetic-algorithm]
        selection = "tournament:3"
        elites = 2
        survival = "generational"
        crossover = "one-point"
        crossover-rate = 0.9
        point-rate = 0.015625
        heterogeneous = false

        [migration]
        topology = "ring"
        migration-interval = 5
        migrants = 2
        migration-lag = 1
        emigrants = "best"
        replacement = "worst"
        exchange = "sync"

        [running]
        checkpoint-interval = 50
    "#]]
    .assert_eq(said);
    assert_eq!(world.digest("second", "--config first/run.toml"), first);
    let other = "--config first/run.toml --problem onemax --dimensions 10";
    assert!(world.refusal(other).contains("block means nothing to onemax"));
    assert_ne!(world.digest("third", "--config first/run.toml --dimensions 32"), first);
    // What means nothing is not written down: with other dimensions its default is another.
    world.digest("random", "--problem sphere --algorithm random --n 1 --generations 1");
    world.digest("wider", "--config random/run.toml --dimensions 8");
    world
        .json("--problem sphere --dimensions 2 --n 1 --seed 3 --generations 1 --no-monitor --json");
    assert!(world.path("runs/sphere-seed3/summary.json").exists());
}

#[test]
fn a_run_may_begin_with_given_points_of_its_own_length() {
    let world = World::new();
    world.write("best.csv", "0.25\n0.5\n0.75\n");
    let settings = "--problem sphere --n 2 --seed 3 --generations 1 --seed-genomes best.csv";
    let score = world.json("evaluate best.csv --problem sphere --dimensions 3 --json");
    world.digest("run", &format!("{settings} --dimensions 3"));
    let config = Config::read(&RunDir::at(world.path("run")).config()).unwrap();
    assert_eq!(config.seed_genomes.unwrap().count, 1);
    let rows = islands::formats::metrics::read(world.read("run/metrics.csv").as_bytes()).unwrap();
    let fitness = score["genomes"][0]["fitness"].as_f64().unwrap();
    assert!(rows.iter().all(|row| row.best.unwrap() >= fitness));
    assert_eq!(world.json("verify run --json")["ok"], true);
    let refused = world.refusal(&format!("{settings} --dimensions 4"));
    assert!(refused.contains("3 genes where there must be 4"), "{refused}");
}

#[test]
fn what_makes_no_sense_for_a_problem_is_refused_with_a_sentence() {
    let world = World::new();
    world.digest("run", RASTRIGIN);
    let refusals = [
        "--problem cube",
        "--problem sphere --task travel",
        "--problem sphere --genes 4",
        "--problem rastrigin --block 4",
        "--problem onemax --rotated",
        "--dimensions 5",
        "--problem trap --dimensions 12",
        "--problem rosenbrock --dimensions 1",
        "--problem sphere --dimensions 1001",
        "resume run --problem sphere",
        "resume run --dimensions 6",
        "replay run",
        "inspect run/champion.csv",
        "export run/champion.csv --format urdf --out body.urdf",
        "evaluate run/champion.csv",
        "evaluate run/champion.csv --problem rastrigin",
        "evaluate run/champion.csv --problem rastrigin --dimensions 5 --task course",
    ];
    #[cfg(feature = "view")]
    expect![[r#"
        invalid value 'cube' for '--problem <PROBLEM>': unknown problem “cube”: choose one of creatures, sphere, rastrigin, rosenbrock, ackley, schwefel, griewank, onemax, trap, royal-road, xor, double-pole, double-pole-blind
        task means nothing to sphere: leave it out, or choose another --problem
        genes means nothing to sphere: leave it out, or choose another --problem
        block means nothing to rastrigin: leave it out, or choose another --problem
        rotated means nothing to onemax: leave it out, or choose another --problem
        dimensions means nothing to creatures: leave it out, or choose another --problem
        12 bits cannot be cut into blocks of 5: change --dimensions or --block
        dimensions must be from 2 to 1000, not 1
        dimensions must be from 1 to 1000, not 1001
        a run cannot go on with another problem: it is rastrigin of 5, not sphere of 5; leave that out, or start a new run
        a run cannot go on with another problem: it is rastrigin of 5, not rastrigin of 6; leave that out, or start a new run
        replay shows creatures, and this is a run of rastrigin, whose genomes have no bodies
        cannot use run/champion.csv: it is a genome of another problem, and describes no creature; islands evaluate takes it with the --problem that it is of
        cannot use run/champion.csv: it is a genome of another problem, and describes no creature; islands evaluate takes it with the --problem that it is of
        cannot use run/champion.csv: it is a genome of another problem, and describes no creature; islands evaluate takes it with the --problem that it is of
        cannot use run/champion.csv: the file holds 5 genes where there must be 30: give a gene a line, or another --dimensions
        task means nothing to rastrigin: leave it out, or choose another --problem"#]].assert_eq(&refusals.map(|wish| world.refusal(wish)).join("\n"));
    #[cfg(not(feature = "view"))]
    let _ = refusals.map(|wish| world.refusal(wish));
}
