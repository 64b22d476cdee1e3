//! Bodies travel: as URDF and back without a bit lost, and to other programs in the formats that they read.

use crate::formats::course::{FIXTURES, fixture};
use crate::support::World;
use expect_test::expect;
use islands::creature::encodings::course::profile::COURSEWORK_LINKS_MAX;
use islands::creature::{Course, Creature, Gene, Profile};
use islands::evolution::Problem;
use islands::formats::{genome_csv, urdf};
use islands::problems::{Locomotion, Task};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use serde_json::Value;
use std::fs;

pub fn locomotion(profile: Profile, genes: usize) -> Locomotion {
    let encoding = Course { profile, genes, ..Course::DEFAULT };
    Locomotion { encoding, task: Task::Course, ..Locomotion::default() }
}

pub fn creature(profile: Profile, genome: &[Gene]) -> Creature {
    locomotion(profile, 1).express(genome).unwrap()
}

pub fn written(creature: &Creature) -> String {
    let mut file = Vec::new();
    urdf::write(&creature.morphology, &creature.controller, "it", &mut file).unwrap();
    String::from_utf8(file).unwrap()
}

fn there_and_back(creature: &Creature) -> Creature {
    let body = urdf::read(&written(creature)).unwrap();
    assert_eq!(body.notes, Vec::<String>::new());
    body.creature
}

#[test]
fn every_genome_of_the_course_is_the_same_body_after_a_journey_through_urdf() {
    for i in 0..FIXTURES {
        let genome =
            genome_csv::read(&Course::DEFAULT, fixture(&format!("genome_{i}.csv")).as_bytes())
                .unwrap();
        for profile in Profile::ALL {
            let creature = creature(profile, &genome.genome);
            assert_eq!(there_and_back(&creature), creature, "genome {i} as {profile}");
        }
    }
}

#[test]
fn a_thousand_random_genomes_are_the_same_bodies_after_a_journey_through_urdf() {
    let mut rng = ChaCha8Rng::seed_from_u64(53);
    let [mut bodies, mut links] = [0; 2];
    for index in 0.. {
        let profile = Profile::ALL[index % 3];
        let problem = locomotion(profile, 1 + index / 3 % 6);
        // What is larger than the profile builds has no body.
        let Ok(creature) = problem.express(&problem.random_genome(&mut rng)) else { continue };
        assert!(there_and_back(&creature) == creature, "genome {index} as {profile}");
        links += creature.morphology.links.len();
        bodies += 1;
        if bodies == 1_000 {
            break;
        }
    }
    assert!(links > 5_000, "{links}");
}

#[test]
fn a_body_from_urdf_moves_by_the_same_bits_as_the_genome_that_it_was_written_from() {
    let mut rng = ChaCha8Rng::seed_from_u64(59);
    for profile in Profile::ALL {
        let problem = locomotion(profile, 3);
        let genome = problem.random_genome(&mut rng);
        let creature = problem.express(&genome).unwrap();
        assert_eq!(problem.film_body(&there_and_back(&creature)), problem.film(&genome).unwrap());
    }
}

#[test]
fn inspect_and_replay_take_a_body_that_was_exported() {
    let world = World::new();
    world.write("genome.csv", fixture("genome_3.csv"));
    let coursework = "--profile coursework";
    let export = format!("export genome.csv {coursework} --format urdf --out body.urdf");
    assert_eq!(world.islands(&export).code, Some(0));
    let body = world.json("inspect body.urdf --json");
    let genome = world.json(&format!("inspect genome.csv {coursework} --json"));
    let masses = |of: &Value| -> Vec<f64> {
        of["links"].as_array().unwrap().iter().map(|l| l["mass"].as_f64().unwrap()).collect()
    };
    assert_eq!(masses(&body), masses(&genome));
    let lines = world.islands("inspect body.urdf").stdout.lines().count();
    assert_eq!(lines, masses(&body).len() + 1);
    #[cfg(feature = "view")]
    {
        let replay = format!("replay genome.csv body.urdf {coursework} --task course --out it.rrd");
        let ending = world.islands(&replay);
        assert_eq!(ending.code, Some(0), "{ending:?}");
        let scores: Vec<&str> = ending.stdout.lines().map(|line| &line[..20]).collect();
        assert_eq!(scores[0], scores[1]);
    }
}

#[test]
fn evaluate_scores_a_body_by_the_same_bits_as_the_genome_that_it_was_written_from() {
    let world = World::new();
    world.write("genome.csv", fixture("genome_3.csv"));
    let coursework = "--profile coursework";
    let export = format!("export genome.csv {coursework} --format urdf --out body.urdf");
    assert_eq!(world.islands(&export).code, Some(0));
    for trial in ["--task course", "--task travel --engine featherstone --robustness 2"] {
        let evaluate = format!("evaluate body.urdf genome.csv {coursework} {trial} --repeat 2");
        let scores = world.json(&format!("{evaluate} --json"));
        assert_eq!(
            (&scores["evaluations"], &scores["genomes"][0]["genome"]),
            (&4.into(), &"body.urdf".into())
        );
        let [body, genome] = [0, 1].map(|i| &scores["genomes"][i]);
        assert_eq!(body["outcome"], "scored");
        assert_eq!([&body["fitness"], &body["outcome"]], [&genome["fitness"], &genome["outcome"]]);
    }
}

#[test]
fn a_body_of_another_program_is_inspected_and_scored_and_what_does_not_count_is_said() {
    let world = World::new();
    let hand = "tests/fixtures/physics/hand/wheels2.urdf";
    fs::copy(format!("{}/{hand}", env!("CARGO_MANIFEST_DIR")), world.path("wheels.urdf")).unwrap();
    let ending = world.islands("inspect wheels.urdf");
    assert_eq!(ending.code, Some(0));
    expect![[r#"
        link  name  parent  shape     size m                 mass kg  joint  amplitude rad/s  torque N·m
        0     l0    -       box       0.800 × 0.800 × 0.200  0.128    root
        1     l1    0       cylinder  0.600 × 0.600 × 0.200  0.057    hinge
        2     l2    0       cylinder  0.600 × 0.600 × 0.200  0.057    hinge
    "#]]
    .assert_eq(&ending.stdout);
    expect![[r#"
        warning: wheels.urdf: 2 joint(s) turn without the limits that they have there
        warning: wheels.urdf: 2 hinge(s) without a motor, since the file does not say how they are driven
    "#]]
    .assert_eq(&ending.stderr);
    let scored = world.islands("evaluate wheels.urdf");
    assert_eq!((scored.code, scored.stderr), (Some(0), ending.stderr));
    assert!(scored.stdout.ends_with("wheels.urdf\n"), "{}", scored.stdout);
}

#[test]
fn every_format_is_written_and_replaces_what_was_there() {
    let world = World::new();
    world.write("genome.csv", fixture("genome_1.csv"));
    let beginnings: [(&str, &[u8]); 5] = [
        ("csv", b"0."),
        ("urdf", b"<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<robot name=\"genome\">"),
        ("mjcf", b"<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<mujoco model=\"genome\">"),
        ("stl", b"islands"),
        ("motion", b"time_s,link,x_m,y_m,z_m,qx,qy,qz,qw\n0,0,"),
    ];
    for (format, beginning) in beginnings {
        world.write("it", "old");
        let command = format!("export genome.csv --profile coursework --format {format} --out it");
        let ending = world.islands(&command);
        assert_eq!((ending.code, ending.stderr.as_str()), (Some(0), ""), "{format}");
        let bytes = fs::read(world.path("it")).unwrap();
        assert!(bytes.starts_with(beginning), "{format}: {}", bytes[..60].escape_ascii());
    }
    assert_eq!(world.files(), ["genome.csv", "it"]);
}

#[test]
fn a_genome_of_the_course_is_exported_byte_for_byte_and_one_of_another_scale_rescaled() {
    let world = World::new();
    world.write("genome.csv", fixture("genome_2.csv"));
    let export = "export genome.csv --profile coursework --format csv --out it.csv";
    assert_eq!(world.islands(export).code, Some(0));
    assert_eq!(world.read("it.csv"), fixture("genome_2.csv"));
    assert_eq!(world.islands(&format!("{export} --scale link-length=1")).code, Some(0));
    let [theirs, own] = ["genome.csv --scale link-length=1", "it.csv"].map(|file| {
        world.json(&format!("inspect {file} --profile coursework --json"))["links"].take()
    });
    assert!(theirs.as_array().unwrap().len() > 1);
    for (theirs, own) in theirs.as_array().unwrap().iter().zip(own.as_array().unwrap()) {
        let difference = theirs["length"].as_f64().unwrap() - own["length"].as_f64().unwrap();
        assert!(difference.abs() < 1e-15);
    }
}

#[test]
fn every_part_can_be_printed_by_itself() {
    let world = World::new();
    world.write("genome.csv", fixture("genome_0.csv"));
    let command = "export genome.csv --profile coursework --format stl --parts --out it.stl";
    assert_eq!(world.islands(command).code, Some(0));
    assert_eq!(world.files(), ["genome.csv", "it-link_0.stl", "it.stl"]);
    assert_eq!(fs::read(world.path("it.stl")).unwrap().len() % 50, 84 % 50);
}

#[test]
fn what_cannot_be_exported_is_refused_with_the_reason() {
    let world = World::new();
    let half = ["0.4"; 17].join(",");
    world.write("half.csv", &half);
    world.write("half.urdf", "<robot/>");
    world.write("robot.urdf", "<robot><link name='a'/></robot>");
    let many = ["0.4,0.4,0.4,0.4,0.4,0.4,0.99,0.4,0.4,0.4,0.4,0.4,0.4,0.4,0.4,0.4,0.4,"; 12];
    world.write("huge.csv", many.join("\n"));
    let wishes = [
        "export half.csv --format csv --out it.csv",
        "export half.csv --profile lecture --format csv --out it.csv",
        "export half.csv --format urdf --out nowhere/it.urdf",
        "export half.csv --format stl --size 0 --out it.stl",
        "export half.csv --format gltf --out it",
        "export half.csv --scale link-length=1 --format urdf --out it",
        "export half.csv --profile coursework --scale link-mass=1 --format urdf --out it",
        "export half.csv --drop-column 19 --format urdf --out it",
        "export half.urdf --format urdf --out it",
        "export robot.urdf --format mjcf --out it",
        "export huge.csv --profile coursework --format urdf --out it",
        "inspect half.urdf",
        "evaluate half.urdf",
    ];
    let sentences = wishes.map(|wish| world.refusal(wish));
    expect![[r#"
        cannot export half.csv: gene 1 cannot be said in the course's terms: its link hangs by its end on its parent's surface, and in the course by its middle anywhere
        cannot export half.csv: gene 1 cannot be said in the course's terms: its density is 0.460 kg/m³ and its motor's top speed 0.100 rad/s, and in the course both are 1
        cannot write nowhere/it.urdf: No such file or directory (os error 2); choose another file with --out
        --size must be from 0.000001 to 1000000
        invalid value 'gltf' for '--format <FORMAT>': unknown format “gltf”: choose one of csv, urdf, mjcf, stl, motion
        only profile coursework has scales to change, not native
        invalid value 'link-mass=1' for '--scale <NAME=SCALE>': "link-mass" has no scale to change: choose one of link-length, link-radius, link-recurrence, joint-origin-rpy-1, joint-origin-rpy-2, joint-origin-rpy-3, joint-origin-xyz-1, joint-origin-xyz-2, joint-origin-xyz-3, control-freq
        --drop-column takes different columns from 1 to 18 of lines with 18
        cannot use half.urdf: the links do not make one tree: there is no link
        cannot use robot.urdf: link "a" has no <collision> or <visual> that it could be made of: give it one, or fix it to its parent
        cannot build huge.csv: the body has more than 512 links, the most that profile coursework builds
        cannot use half.urdf: the links do not make one tree: there is no link
        cannot use half.urdf: the links do not make one tree: there is no link"#]].assert_eq(&sentences.join("\n"));
    let creature = locomotion(Profile::Coursework, 1)
        .express(&genome_csv::read(&Course::DEFAULT, many.join("\n").as_bytes()).unwrap().genome);
    assert!(creature.is_err(), "over {COURSEWORK_LINKS_MAX} links");
}
