//! What the command line takes, what it refuses, and how it says so.

use crate::formats::course::{FIXTURES, fixture};
use crate::support::{World, assert_same};
use expect_test::{Expect, expect};
use islands::creature::encodings::course::{PARAMETER_COUNT, VALUE_MAX};
use islands::creature::{Course, Gene, Profile, develop};
use islands::evolution::Problem;
use islands::formats::{Inspection, genome_csv};
use islands::problems::{Locomotion, Task};
use islands::rng::{Purpose, Source};
use serde_json::Value;

/// Asserts that each of these is refused, and with which sentence.
fn refused<const N: usize>(world: &World, wishes: [&str; N], expected: Expect) {
    let sentences = wishes.map(|wish| world.refusal(wish));
    expected.assert_eq(&sentences.join("\n"));
}

fn random_genome(genes: usize, index: u32) -> Vec<Gene> {
    let problem = Locomotion { encoding: Course { genes, ..Course::DEFAULT }, ..LOCOMOTION };
    problem.random_genome(&mut Source { seed: 29, island: 0 }.stream(0, index, Purpose::Genesis))
}

const LOCOMOTION: Locomotion =
    Locomotion { encoding: Course { genes: 1, ..Course::DEFAULT }, ..Locomotion::DEFAULT };

fn csv(genome: &[Gene]) -> Vec<u8> {
    let mut file = Vec::new();
    genome_csv::write(genome, &mut file).unwrap();
    file
}

#[test]
fn impossible_wishes_for_a_run_are_refused_with_a_sentence_that_says_what_to_do() {
    let wishes = [
        "--n 0",
        "--n 257",
        "run --n 0",
        "--population 1",
        "--population 4 --migrants 5",
        "--population 4 --elites 4",
        "--genes 13",
        "--threads 0",
        "--grow-rate 1.5",
        "--crossover-rate NaN",
        "--migration-interval 0",
        "--seed 18446744073709551615",
    ];
    refused(
        &World::new(),
        wishes,
        expect![[r#"
        islands (--n) must be from 1 to 256, not 0
        islands (--n) must be from 1 to 256, not 257
        islands (--n) must be from 1 to 256, not 0
        population must be from 2 to 100000, not 1
        5 migrants are more than there can be: take at most 4, with a population of 4
        elites must be from 0 to 3, not 4
        genes must be from 1 to 12, not 13
        threads must be from 1 to 4096, not 0
        grow-rate must be from 0 to 1, not 1.5
        crossover-rate must be from 0 to 1, not NaN
        migration-interval must be from 1 to 1000000000, not 0
        seed must be at most 9223372036854775807"#]],
    );
}

#[test]
fn an_unknown_name_is_refused_with_those_that_are_known() {
    let wishes = ["--engine bullet", "--profile mine", "--selection luck", "--selection rank:3"];
    refused(
        &World::new(),
        wishes,
        expect![[r#"
            invalid value 'bullet' for '--engine <ENGINE>': unknown engine “bullet”: choose one of rapier, featherstone
            invalid value 'mine' for '--profile <PROFILE>': unknown profile “mine”: choose one of native, lecture, coursework
            invalid value 'luck' for '--selection <SCHEME>': unknown selection “luck”: choose one of roulette, sus, tournament:3, rank:1.8, truncation:0.3
            invalid value 'rank:3' for '--selection <SCHEME>': rank takes a number from 1 to 2"#]],
    );
}

#[test]
fn a_folder_that_cannot_be_used_is_refused_and_left_as_it_was() {
    let world = World::new();
    world.write("plain", "a file");
    std::fs::create_dir(world.path("full")).unwrap();
    world.write("full/precious", "a file");
    let wishes = ["--out plain --n 1", "--out plain/run --n 1", "--out full --n 1"];
    refused(
        &world,
        wishes,
        expect![[r#"
            cannot make the folder plain: File exists (os error 17); choose another folder with --out
            cannot make the folder plain/run: Not a directory (os error 20); choose another folder with --out
            cannot use full: it is not empty; choose another folder with --out"#]],
    );
    assert_eq!(world.files(), ["full/precious", "plain"]);
}

#[test]
fn a_configuration_that_cannot_be_used_is_refused() {
    let world = World::new();
    world.write("broken.toml", "islands = [");
    world.write("text.toml", "population = \"many\"\n");
    world.write("impossible.toml", "population = 1\n");
    world.write("unknown.toml", "popluation = 3\n");
    let wishes = ["nowhere.toml", "broken.toml", "text.toml", "impossible.toml"];
    let wishes = wishes.map(|name| format!("--config {name}"));
    refused(
        &world,
        wishes.each_ref().map(String::as_str),
        expect![[r#"
            cannot use nowhere.toml: No such file or directory (os error 2); name a file such as a run's run.toml
            cannot use broken.toml: line 1: unclosed array, expected `]`
            cannot use text.toml: line 1: invalid type: string "many", expected usize
            population must be from 2 to 100000, not 1"#]],
    );
    let sentence = world.refusal("--config unknown.toml");
    let expected =
        "cannot use unknown.toml: line 1: unknown setting popluation: see islands run --help";
    assert!(sentence.starts_with(expected), "{sentence}");
}

#[test]
fn a_genome_that_cannot_be_read_is_refused_by_every_command() {
    let world = World::new();
    world.write("broken.csv", "0.5,0.5\n");
    world.write("good.csv", csv(&random_genome(1, 0)));
    let wishes = [
        "evaluate nowhere.csv",
        "evaluate good.csv broken.csv --json",
        "evaluate good.csv --threads 0",
        "evaluate good.csv --repeat 0",
        "inspect nowhere.csv",
        "inspect broken.csv --json",
        "inspect .",
    ];
    refused(
        &world,
        wishes,
        expect![[r#"
            cannot use nowhere.csv: No such file or directory (os error 2); name a file with a gene a line, such as a run's champion.csv
            cannot use broken.csv: line 1 has 2 columns instead of 17: write a gene a line, its numbers separated by commas
            --threads and --repeat must be at least 1, and at most 4096 and 1000000
            --threads and --repeat must be at least 1, and at most 4096 and 1000000
            cannot use nowhere.csv: No such file or directory (os error 2); name a file with a gene a line, such as a run's champion.csv
            cannot use broken.csv: line 1 has 2 columns instead of 17: write a gene a line, its numbers separated by commas
            cannot use .: it is no regular file; name a file with a gene a line, such as a run's champion.csv"#]],
    );
}

#[test]
#[cfg(feature = "view")]
fn a_film_of_nothing_or_to_nowhere_is_refused() {
    let world = World::new();
    world.write("broken.csv", "0.5,0.5\n");
    world.write("good.csv", csv(&random_genome(1, 0)));
    world.write("huge.csv", csv(&huge()));
    let wishes = [
        "replay nowhere.csv --out film.rrd",
        "replay broken.csv --out film.rrd",
        "replay huge.csv --profile coursework --out film.rrd",
        "replay good.csv --out good.csv/film.rrd",
        "monitor nowhere",
    ];
    refused(
        &world,
        wishes,
        expect![[r#"
            cannot use nowhere.csv: No such file or directory (os error 2); name a file with a gene a line, such as a run's champion.csv
            cannot use broken.csv: line 1 has 2 columns instead of 17: write a gene a line, its numbers separated by commas
            cannot build huge.csv: the body has more than 512 links, the most that profile coursework builds
            cannot write the recording good.csv/film.rrd: Not a directory (os error 20); choose another file with --out
            there is no run in nowhere: name the folder of one, such as runs/walk-seed7"#]],
    );
}

#[test]
fn every_command_has_help() {
    let world = World::new();
    for command in ["", "run", "experiment", "evaluate", "inspect", "replay", "monitor", "island"] {
        let ending = world.islands(&format!("{command} --help"));
        assert_eq!(ending.code, Some(0), "{command}");
        assert!(ending.stdout.contains("Usage: islands"), "{command}: {}", ending.stdout);
        assert_eq!(ending.stderr, "");
    }
    let version = world.islands("--version").stdout;
    assert_eq!(version, format!("islands {}\n", env!("CARGO_PKG_VERSION")));
}

#[test]
fn evaluate_scores_each_file_and_measures_its_speed() {
    let world = World::new();
    let genomes = [1, 2].map(|genes| random_genome(genes, genes as u32));
    world.write("a.csv", csv(&genomes[0]));
    world.write("b.csv", csv(&genomes[1]));
    for settings in ["--threads 1", "--threads 3 --repeat 2", ""] {
        let scores = world.json(&format!("evaluate a.csv b.csv a.csv {settings} --json"));
        for (i, file) in [0, 1, 0].into_iter().enumerate() {
            let genome = &genomes[file];
            let fitness = scores["genomes"][i]["fitness"].as_f64().unwrap();
            assert_eq!(fitness.to_bits(), LOCOMOTION.evaluate(genome).fitness.get().to_bits());
            assert_eq!(scores["genomes"][i]["outcome"], "scored");
            assert_eq!(scores["genomes"][i]["genome"], ["a.csv", "b.csv"][file]);
        }
        assert_eq!(scores["genomes"].as_array().unwrap().len(), 3);
        let repeats = if settings.contains("--repeat 2") { 2 } else { 1 };
        // What is measured is done, also a file that is named twice.
        assert_eq!(scores["evaluations"], 3 * repeats);
        for key in ["evaluations_per_second", "steps_per_second"] {
            assert!(scores[key].as_f64().unwrap() > 0.0, "{key} in {scores}");
        }
    }
}

#[test]
fn evaluate_takes_every_task_and_profile() {
    let world = World::new();
    let genome = random_genome(2, 3);
    world.write("genome.csv", csv(&genome));
    for task in Task::ALL {
        for profile in Profile::ALL {
            let scores = world
                .json(&format!("evaluate genome.csv --task {task} --profile {profile} --json"));
            let encoding = Course { profile, ..LOCOMOTION.encoding };
            let expected = Locomotion { encoding, task, ..LOCOMOTION }.evaluate(&genome);
            assert_eq!(scores["genomes"][0]["fitness"], expected.fitness.saturated());
            assert_eq!(scores["genomes"][0]["outcome"], expected.outcome.to_string());
            assert_eq!(
                (&scores["task"], &scores["profile"]),
                (&task.to_string().into(), &profile.to_string().into())
            );
        }
    }
}

#[test]
fn values_of_one_and_more_are_clamped_with_a_warning() {
    let world = World::new();
    world.write("ones.csv", ["1.0"; PARAMETER_COUNT].join(","));
    let ending = world.islands("evaluate ones.csv");
    assert_eq!(ending.code, Some(0));
    assert_eq!(ending.stderr.lines().count(), PARAMETER_COUNT);
    assert!(ending.stderr.starts_with("warning: ones.csv: line 1, column 1"), "{ending:?}");
}

/// Each gene's link is built twice on the link before it: 1023 links.
fn huge() -> Vec<Gene> {
    let mut gene = Gene([0.5; PARAMETER_COUNT]);
    (gene.0[3], gene.0[6]) = (0.4, VALUE_MAX);
    vec![gene; 10]
}

#[test]
fn a_body_that_is_too_large_has_the_worst_fitness_and_json_can_say_it() {
    let world = World::new();
    world.write("huge.csv", csv(&huge()));
    let scores = world.json("evaluate huge.csv --profile coursework --json");
    assert_eq!(scores["genomes"][0]["outcome"], "too large");
    assert_eq!(scores["genomes"][0]["fitness"], f64::MIN);
    assert!(!scores.to_string().contains("null"), "{scores}");
    let sentence = world.refusal("inspect huge.csv --profile coursework");
    expect!["cannot build huge.csv: the body has more than 512 links, the most that profile coursework builds"]
        .assert_eq(&sentence);
}

#[test]
fn inspect_shows_the_courses_bodies_link_for_link() {
    let world = World::new();
    for i in 0..FIXTURES {
        let name = format!("genome_{i}.csv");
        world.write(&name, fixture(&name));
        let found = world.json(&format!("inspect {name} --profile coursework --json"));
        let expected = fixture(&format!("genome_{i}.expected.json"));
        let expected: Value = serde_json::from_str(&expected).unwrap();
        assert_same(&found, &expected, &name);
    }
}

#[test]
fn inspect_shows_our_bodies_and_cuts_them_as_told() {
    let world = World::new();
    let genome = random_genome(5, 4);
    world.write("genome.csv", csv(&genome));
    for profile in [Profile::Native, Profile::Lecture] {
        for max_links in [3, 32] {
            let arguments =
                format!("inspect genome.csv --profile {profile} --max-links {max_links}");
            let found = world.json(&format!("{arguments} --json"));
            let development = develop(&genome, profile, max_links).unwrap();
            let expected = Inspection::new(&development, profile, "genome.csv");
            assert_same(&found, &serde_json::to_value(expected).unwrap(), "inspection");
            let links = development.tree.len();
            assert!(links <= max_links);
            // A line a link below the heading.
            assert_eq!(world.islands(&arguments).stdout.lines().count(), links + 1);
        }
    }
}
