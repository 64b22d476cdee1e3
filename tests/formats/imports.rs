//! Genomes of the course come in: whatever state their files are in, and as those that a run begins with.

use crate::formats::course::fixture;
use crate::support::{TINY, World};
use expect_test::expect;
use islands::archipelago::{Digest, lockstep};
use islands::creature::encodings::course::VALUE_MAX;
use islands::creature::{Course, Gene};
use islands::evolution::Founders;
use islands::formats::genome_csv;
use islands::runs::config::Config;
use islands::store::RunDir;
use serde_json::{Value, json};
use std::fs;
use std::path::Path;

/// A gene of 17 times the same.
fn line(cell: &str) -> String {
    [cell; 17].join(",")
}

/// A folder as people have them.
fn mess() -> World {
    let world = World::new();
    for folder in ["elites", "elites/old", "elites/other"] {
        fs::create_dir(world.path(folder)).unwrap();
    }
    let files = [
        ("elites/elite_0.csv", format!("{},\n", line("0.25"))),
        ("elites/elite_1.csv", format!("{}\r\n\r\n{},\r\n", line("0.5"), line("0.1"))),
        ("elites/old/elite_0.csv", format!("\u{feff}{}", line("1.077"))),
        ("elites/old/EMPTY.CSV", String::new()),
        ("elites/old/eighteen.csv", format!("{}\n{},0.9\n", line("0.5"), line("0.5"))),
        ("elites/old/nineteen.csv", format!("{},0.9,0.9,\n", line("0.5"))),
        ("elites/other/notes.txt", "no genome".to_owned()),
        ("elites/other/picture.csv", "\u{89}PNG".to_owned()),
        ("elites/other/negative.csv", line("-0.5")),
    ];
    for (name, contents) in files {
        world.write(name, contents);
    }
    world
}

#[test]
fn a_folder_of_files_in_any_state_is_read_and_what_was_refused_is_said() {
    let world = mess();
    let ending = world.islands("import elites --out genomes --json");
    assert_eq!(ending.code, Some(1));
    expect![[r#"
        warning: elites/old/elite_0.csv: 17 value(s) of 1 and more are now just under 1
        refused: elites/old/EMPTY.CSV: the file holds no gene: give one with at least one line of 17 numbers
        refused: elites/old/eighteen.csv: line 2 has 18 columns instead of 17: leave out the additional one, link-geometry, usually with --drop-column 6
        refused: elites/old/nineteen.csv: line 1 has 19 columns instead of 17: leave out the additional ones, sensor gain and bias, usually with --drop-column 18 --drop-column 19
        refused: elites/other/negative.csv: line 1, column 1 (link-shape) holds "-0.5": write a number from 0 (included) to 1 (excluded) there
        refused: elites/other/picture.csv: line 1 has 1 column instead of 17: write a gene a line, its numbers separated by commas
        error: 5 of the files could not be read
    "#]].assert_eq(&ending.stderr);
    let report = ending.json();
    assert_eq!((&report["read"], &report["out"]), (&json!(3), &json!("genomes")));
    assert_eq!(report["refused"].as_array().unwrap().len(), 5);
    assert_eq!(report["clamped"], json!([{"file": "elites/old/elite_0.csv", "values": 17}]));
    let imported =
        |name: &str| genome_csv::read(&Course::DEFAULT, world.read(name).as_bytes()).unwrap();
    assert_eq!(imported("genomes/elite_0.csv").genome, [Gene([0.25; 17])]);
    assert_eq!(imported("genomes/elite_0-2.csv").genome, [Gene([VALUE_MAX; 17])]);
    assert_eq!(imported("genomes/elite_1.csv").genome.len(), 2);
    assert_eq!(fs::read_dir(world.path("genomes")).unwrap().count(), 3);
}

#[test]
fn files_with_more_columns_are_read_once_it_is_said_which_to_leave_out() {
    let world = World::new();
    let cells: Vec<String> = (0..17).map(|i| format!("0.{i:02}")).collect();
    let with = |at: usize, cell: &str| {
        let mut cells = cells.clone();
        cells.insert(at, cell.to_owned());
        cells.join(",")
    };
    world.write("18.csv", with(5, "sphere"));
    world.write("19.csv", format!("{},0.7,-9", cells.join(",")));
    world.write("mixed.csv", format!("{}\n{}\n", with(5, "0.9"), cells.join(",")));
    world.json("import 18.csv mixed.csv --drop-column 6 --out a --json");
    world.json("import 19.csv --drop-column 18 --drop-column 19 --out b --json");
    let read = |name: &str| {
        genome_csv::read(&Course::DEFAULT, world.read(name).as_bytes()).unwrap().genome
    };
    let plain = genome_csv::read(&Course::DEFAULT, cells.join(",").as_bytes()).unwrap().genome;
    assert_eq!((read("a/18.csv"), read("b/19.csv")), (plain.clone(), plain.clone()));
    assert_eq!(read("a/mixed.csv"), [plain[0], plain[0]]);
    let evaluated = world.json("evaluate 18.csv --profile coursework --drop-column 6 --json");
    let scored = world.json("evaluate a/18.csv --profile coursework --json");
    assert_eq!(evaluated["genomes"][0]["fitness"], scored["genomes"][0]["fitness"]);
}

#[test]
fn genomes_of_other_scales_become_the_same_bodies_or_are_refused() {
    let world = World::new();
    world.write("short.csv", line("0.4"));
    world.write("long.csv", line("0.9"));
    let ending = world.islands("import short.csv long.csv --scale link-length=4 --out own");
    assert_eq!(ending.code, Some(1));
    expect![[r#"
        refused: long.csv: gene 1 cannot be said in the course's terms: its link-length is 3.6, and in the course always below 2; leave it as it is, and give --scale to the command that uses it
        error: 1 of the files could not be read
    "#]].assert_eq(&ending.stderr);
    let length = |wish: &str| {
        let body = world.json(&format!("inspect {wish} --profile coursework --json"));
        body["links"][0]["length"].as_f64().unwrap()
    };
    assert_eq!(length("own/short.csv"), 1.6);
    assert_eq!(length("long.csv --scale link-length=4"), 3.6);
}

#[test]
fn what_cannot_be_imported_at_all_is_refused() {
    let world = mess();
    fs::create_dir(world.path("empty")).unwrap();
    let wishes = [
        "import nowhere --out a",
        "import empty --out a",
        "import elites/*.tsv --out a",
        "import elites --out elites",
        "import elites --drop-column 0",
        "import elites --drop-column 3 --drop-column 3",
        "import elites --scale length=1",
        "import elites --scale link-length",
        "import elites --profile native --scale link-length=1",
    ];
    let sentences = wishes.map(|wish| {
        let ending = world.islands(wish);
        assert_eq!(ending.code, Some(2), "{wish}: {ending:?}");
        let error = ending.stderr.lines().find(|line| line.starts_with("error: "));
        error.unwrap_or_default().to_owned()
    });
    expect![[r#"
        error: none of the files could be read
        error: there is no CSV file in empty
        error: there is no CSV file in elites/*.tsv
        error: cannot use elites: it is not empty; choose another folder with --out
        error: --drop-column takes different columns from 1 to 18 of lines with 18
        error: --drop-column takes different columns from 1 to 19 of lines with 19
        error: invalid value 'length=1' for '--scale <NAME=SCALE>': "length" has no scale to change: choose one of link-length, link-radius, link-recurrence, joint-origin-rpy-1, joint-origin-rpy-2, joint-origin-rpy-3, joint-origin-xyz-1, joint-origin-xyz-2, joint-origin-xyz-3, control-freq
        error: invalid value 'link-length' for '--scale <NAME=SCALE>': write a parameter and its scale, such as link-length=1, not "link-length"
        error: only profile coursework has scales to change, not native"#]]
    .assert_eq(&sentences.join("\n"));
}

#[test]
fn thousands_of_files_are_read_in_one_go() {
    let world = World::new();
    fs::create_dir(world.path("many")).unwrap();
    for i in 0..3_000 {
        let cells = if i % 1_000 == 999 { "" } else { &line(&format!("0.{i:04}")) };
        world.write(&format!("many/elite_{i}.csv"), cells);
    }
    let report = world.islands("import many --out genomes --json").json();
    assert_eq!(report["read"], 2_997);
    let refused = report["refused"].as_array().unwrap().iter().map(|r| r["file"].clone());
    let expected = [1999, 2999, 999].map(|i| Value::from(format!("many/elite_{i}.csv")));
    assert_eq!(refused.collect::<Vec<_>>(), expected);
}

const SEEDED: &str = "--n 2 --seed 23 --profile coursework --task course --max-genes 6";

/// A folder with five genomes of the course.
fn elites() -> World {
    let world = World::new();
    fs::create_dir(world.path("elites")).unwrap();
    for i in 0..5 {
        let name = format!("genome_{i}.csv");
        world.write(&format!("elites/{name}"), fixture(&name));
    }
    world
}

fn founders() -> Vec<Vec<Gene>> {
    let read = |i| {
        genome_csv::read(&Course::DEFAULT, fixture(&format!("genome_{i}.csv")).as_bytes()).unwrap()
    };
    (0..5).map(|i| read(i).genome).collect()
}

#[test]
fn every_island_begins_with_as_many_of_the_genomes_as_it_has_room_for() {
    let world = elites();
    let run = format!("--out run {SEEDED} {TINY} --seed-genomes elites");
    let digest = world.digest("run", &run.replace("--out run ", ""));
    let config = Config::read(&RunDir::at(world.path("run")).config()).unwrap();
    let (problem, founders) = (config.locomotion(), Founders(founders()));
    let mut firsts = Vec::new();
    let (archipelago, generations) = (config.archipelago(), config.generations);
    let islands = lockstep::run_from(&problem, &founders, &archipelago, generations, |step| {
        if step.report.generation == 0 {
            firsts
                .push(step.island.population.iter().map(|i| i.genome.clone()).collect::<Vec<_>>());
        }
    });
    assert_eq!(Digest::of(&islands).to_string(), digest);
    let dealt = |places: [usize; 4]| places.map(|place| founders.0[place].clone()).to_vec();
    assert_eq!(firsts, [dealt([0, 1, 2, 3]), dealt([4, 0, 1, 2])]);
}

#[test]
fn where_there_are_fewer_genomes_than_room_the_rest_is_as_random_as_ever() {
    let world = World::new();
    world.write("one.csv", fixture("genome_0.csv"));
    let settings = format!("{SEEDED} {TINY}");
    world.digest("run", &format!("{settings} --seed-genomes one.csv"));
    let config = Config::read(&RunDir::at(world.path("run")).config()).unwrap();
    let first = |founders: Vec<Vec<Gene>>| {
        let (problem, founders) = (config.locomotion(), Founders(founders));
        let islands = lockstep::run_from(&problem, &founders, &config.archipelago(), 0, |_| ());
        islands.into_iter().map(|it| it.population).collect::<Vec<_>>()
    };
    let one = founders()[0].clone();
    for (founded, random) in first(vec![one.clone()]).iter().zip(&first(vec![])) {
        assert_eq!(founded[0].genome, one);
        assert_ne!(random[0].genome, one);
        assert_eq!(founded[1..], random[1..]);
    }
}

#[test]
fn a_run_keeps_what_it_began_with_and_can_be_run_again_resumed_and_verified() {
    let world = elites();
    let settings = format!("{SEEDED} {TINY}");
    let digest = world.digest("run", &format!("{settings} --seed-genomes elites/*.csv"));
    fs::remove_dir_all(world.path("elites")).unwrap();
    assert_eq!(world.digest("again", "--config run/run.toml"), digest);
    let longer = world.json("resume run --generations 5 --no-monitor --quiet --json");
    let whole = world.digest("whole", "--config run/run.toml --generations 5");
    assert_eq!(longer["digest"], whole);
    let verified = world.json("verify run --json");
    assert_eq!(verified["ok"], true);
    let random = world.digest("random", &settings);
    assert_ne!(random, digest);
}

#[test]
fn genomes_to_begin_with_that_are_gone_or_changed_are_missed() {
    let world = elites();
    let settings = format!("{SEEDED} {TINY}");
    world.digest("run", &format!("{settings} --seed-genomes elites"));
    let copy = world.read("run/seed-genomes.csv");
    world.write("run/seed-genomes.csv", copy.replacen('1', "2", 1));
    let resumed = world.refusal("resume run --generations 9");
    let again = world.refusal("--config run/run.toml --out again");
    fs::remove_file(world.path("run/seed-genomes.csv")).unwrap();
    let gone = world.refusal("resume run --generations 9");
    expect![[r#"
        cannot use run/seed-genomes.csv: it is not what run.toml says of it; the run begins with the genomes in it
        cannot use run/seed-genomes.csv: it is not what run.toml says of it; the run begins with the genomes in it
        cannot use run/seed-genomes.csv: No such file or directory (os error 2); the run begins with the genomes in it"#]].assert_eq(&[resumed, again, gone].join("\n"));
    let verified = world.islands("verify run --json");
    assert_eq!(verified.code, Some(1));
    assert!(Path::new(&world.path("run/summary.json")).exists());
}

#[test]
fn genomes_that_no_run_can_begin_with_are_refused() {
    let world = elites();
    world.write("broken.csv", "0.5");
    let wishes = [
        "run --seed-genomes broken.csv --out run",
        "run --seed-genomes nowhere.csv --out run",
        "run --seed-genomes nowhere* --out run",
        "run --seed-genomes elites/genome_4.csv --max-genes 4 --out run",
        "run --seed-genomes elites --scale link-length=1 --out run",
    ];
    let sentences = wishes.map(|wish| world.refusal(wish));
    expect![[r#"
        cannot begin with broken.csv: line 1 has 1 column instead of 17: write a gene a line, its numbers separated by commas (islands import sorts out what can be read)
        cannot begin with nowhere.csv: No such file or directory (os error 2) (islands import sorts out what can be read)
        there is no CSV file in nowhere*
        a genome to begin with has 5 genes, more than --max-genes 4: allow more
        only profile coursework has scales to change, not native"#]].assert_eq(&sentences.join("\n"));
}
