//! Sound inputs of each kind, and how they are damaged.

use super::pieces::{self, RUN_ID, SETTINGS, Sum, archipelago, part, place};
use super::wire;
use crate::formats::course::fixture;
use islands::archipelago::{Step, lockstep};
use islands::creature::{Course, Creature, Gene, Profile, express};
use islands::formats::metrics::{self, Row};
use islands::formats::{genome_csv, urdf};
use islands::runs::config::Config;
use islands::store::{Checkpoint, Entry, encode};
use islands::transport::Limits;
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

/// What island 0 of a small archipelago did, generation by generation.
pub fn steps() -> Vec<Step<Gene>> {
    let mut steps = Vec::new();
    lockstep::run(&Sum, &archipelago(), 3, |step| {
        if step.island.index == 0 {
            steps.push(step.clone());
        }
    });
    steps
}

/// The body of a checkpoint of a generation.
pub fn checkpoint_body(step: &Step<Gene>) -> Vec<u8> {
    encode(&Checkpoint { settings: SETTINGS.to_owned(), island: step.island.clone() })
}

pub fn checkpoints() -> Vec<Vec<u8>> {
    let bodies: Vec<Vec<u8>> = steps().iter().map(checkpoint_body).collect();
    let files = bodies.iter().map(|body| pieces::sealed_checkpoint(body));
    files.collect::<Vec<_>>().into_iter().chain(bodies).collect()
}

/// The parts of a run directory: the logs, then two checkpoints.
fn parts() -> Vec<Vec<u8>> {
    let steps = steps();
    let mut parts = Vec::new();
    for step in &steps {
        let champion = step.champion.as_ref().map(encode);
        parts.extend(champion.map(|champion| part(place::CHAMPIONS, &champion)));
        parts.push(part(place::REPORTS, &encode(&Entry { report: step.report, seconds: 0.5 })));
        parts.push(part(place::LINEAGES, &encode(&step.births)));
        let outbox = step.outbox.as_ref().map(encode);
        parts.extend(outbox.map(|outbox| part(place::MIGRATIONS, &outbox)));
    }
    for step in &steps[2..] {
        let place = place::CHECKPOINT + place::GENERATION * step.report.generation as u8;
        parts.push(part(place, &checkpoint_body(step)));
        parts.push(part(place + place::RAW - place::GENERATION, b""));
    }
    parts
}

pub fn run_dirs() -> Vec<Vec<u8>> {
    let parts = parts();
    let others = parts[parts.len() - 4..].concat();
    vec![parts.concat(), others]
}

pub fn logs() -> Vec<Vec<u8>> {
    let of = |log: u8| {
        let records = parts().into_iter().filter(|part| part[0] == log);
        records.collect::<Vec<_>>().concat()
    };
    let raw = [place::CHAMPIONS, place::REPORTS, place::MIGRATIONS, place::LINEAGES].map(of);
    raw.iter().map(|raw| pieces::sealed_records(raw)).chain(raw.clone()).collect()
}

pub fn genomes() -> Vec<Vec<u8>> {
    let odd =
        "\u{feff}1.0,0,1e-300,.5,+0.25,-0,5e-324,1e300,0.1,0.2,0.3,0.4,0.5,0.6,0.7,0.8,0.9\r\n\r\n";
    vec![fixture("genome_0.csv").into_bytes(), fixture("genome_3.csv").into_bytes(), odd.into()]
}

pub fn urdfs() -> Vec<Vec<u8>> {
    let genome =
        genome_csv::read(&Course::DEFAULT, fixture("genome_1.csv").as_bytes()).unwrap().genome;
    let Creature { morphology, controller } = express(&genome, Profile::Lecture, 4).unwrap();
    let mut ours = Vec::new();
    urdf::write(&morphology, &controller, "ours", &mut ours).unwrap();
    let theirs = include_str!("../fixtures/physics/hand/wheels2.urdf");
    let odd = r#"<robot name="odd"><link name="world"/><joint name="j" type="fixed"><parent link="world"/>
        <child link="a"/><origin rpy="1 2 3"/></joint><link name="a"><inertial><mass value="1e9"/>
        <inertia ixx="1e-9" iyy="1" izz="1"/></inertial><visual><geometry><capsule radius="1e-9"
        length="1e9"/></geometry></visual><visual><origin xyz="1 0 0"/><geometry><sphere radius="1"/>
        </geometry></visual></link></robot>"#;
    vec![ours, theirs.into(), odd.into()]
}

pub fn configs() -> Vec<Vec<u8>> {
    let full = Config { seed: Some(7), threads: Some(2), ..Config::default() };
    let launched = "[launch]\nversion = \"0.1.0\"\nrun-id = \"00112233445566ff\"\n";
    let numbers = "problem = \"rastrigin\"\ndimensions = 7\nrotated = true\n";
    let bits = "problem = \"royal-road\"\nblock = 4\npoint-rate = 0.25\n";
    let begun = format!("selection = \"rank:1.5\"\n{launched}");
    vec![full.to_toml().into(), begun.into(), numbers.into(), bits.into()]
}

pub fn tables() -> Vec<Vec<u8>> {
    let steps = steps();
    let rows = steps.iter().map(|step| Ok(Row::new(&step.report, 0.25)));
    let mut table = Vec::new();
    metrics::write(rows, true, &mut table).unwrap();
    vec![table]
}

pub fn outboxes() -> Vec<Vec<u8>> {
    let limits = Limits::of(RUN_ID, &archipelago());
    let outboxes = steps().into_iter().filter_map(|step| step.outbox);
    let bytes = outboxes.map(|outbox| {
        let genes: Vec<Gene> = outbox.migrants.iter().flat_map(|one| one.genome.clone()).collect();
        wire::batch_bytes(limits.batch(&outbox).unwrap(), &genes)
    });
    bytes.collect()
}

pub fn reports() -> Vec<Vec<u8>> {
    let limits = Limits::of(RUN_ID, &archipelago());
    let bytes = steps().into_iter().map(|step| {
        let champion = step.champion.as_ref();
        let header = limits.report(&step.report, 0.5, champion).unwrap();
        wire::report_bytes(header, champion.map_or(&[], |champion| &champion.individual.genome))
    });
    bytes.collect()
}

/// What is written over numbers and between words: the ends of every range, and one beyond.
const NUMBERS: [u64; 12] = [
    0,
    1,
    0xffff,
    1 << 20,
    1 << 30,
    u32::MAX as u64,
    1 << 62,
    u64::MAX,
    // As f64: 1, infinity, NaN and -0.
    0x3ff0_0000_0000_0000,
    0x7ff0_0000_0000_0000,
    0x7ff8_0000_0000_0000,
    1 << 63,
];
const WORDS: [&str; 20] = [
    "-1",
    "1e999",
    "nan",
    "-inf",
    "18446744073709551615",
    "0x7f",
    ",",
    ",,,,",
    "\n",
    "\r\n\r",
    "\"",
    "[[[[",
    "a.b.c.d=",
    "tournament:1e308",
    "\u{feff}",
    "\u{1b}[2J",
    "é",
    "islands",
    " = ",
    "[launch]",
];

/// Damages an input in a few places.
pub fn damage(sound: &[u8], rng: &mut ChaCha8Rng) -> Vec<u8> {
    let mut bytes = sound.to_vec();
    for _ in 0..rng.random_range(1..=3) {
        let at = rng.random_range(0..=bytes.len());
        let end = (at + rng.random_range(0..40)).min(bytes.len());
        match rng.random_range(0..7) {
            0 => bytes
                .iter_mut()
                .skip(at)
                .take(1)
                .for_each(|byte| *byte ^= 1 << rng.random_range(0..8)),
            1 => drop(bytes.drain(at..end)),
            2 => bytes.truncate(at),
            3 => drop(bytes.splice(at..at, bytes[at..end].to_vec())),
            4 => drop(bytes.splice(at..at, WORDS[rng.random_range(0..WORDS.len())].bytes())),
            5 => bytes[at..end].fill(rng.random()),
            _ => {
                let number = NUMBERS[rng.random_range(0..NUMBERS.len())].to_le_bytes();
                let width = [2, 4, 8][rng.random_range(0..3)];
                bytes.iter_mut().skip(at).zip(&number[..width]).for_each(|(to, from)| *to = *from);
            }
        }
    }
    bytes
}

/// Bytes without any sense.
pub fn noise(rng: &mut ChaCha8Rng) -> Vec<u8> {
    let length = 1_usize << rng.random_range(0..11);
    (0..rng.random_range(0..=length)).map(|_| rng.random()).collect()
}
