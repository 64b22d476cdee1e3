//! The files of format v1, which are read forever.
//!
//! `tests/fixtures/v1` holds a run as version 0.1.0 left it, and a checkpoint of a version to come. The format is
//! what it is: only before a release may they be made anew, with
//! `ISLANDS_BLESS=1 UPDATE_EXPECT=1 cargo test --release format`.

use crate::hostile::pieces::checkpoint_file;
use crate::support::World;
use expect_test::expect;
use islands::archipelago::{Champion, Digest, Island, Outbox};
use islands::creature::{Course, Gene};
use islands::formats::{genome_csv, metrics};
use islands::runs::config::Config;
use islands::store::{Checkpoint, Entry, RecordLog, RunDir, checkpoint};
use serde::{Serialize, de::DeserializeOwned};
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

const SETTINGS: &str = "--n 2 --seed 5 --population 3 --elites 1 --generations 3 --genes 1 --max-genes 3 \
                        --migration-interval 1";
const GENERATIONS: u32 = 3;

fn fixtures() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/v1")
}

/// The run of the fixtures. They are made anew if that is wished, once.
static RUN: LazyLock<RunDir> = LazyLock::new(|| {
    let dir = RunDir::at(fixtures().join("run"));
    if std::env::var_os("ISLANDS_BLESS").is_some() {
        bless(&dir);
    }
    dir
});

fn bless(dir: &RunDir) {
    let world = World::new();
    world.digest("run", SETTINGS);
    let _ = fs::remove_dir_all(dir.path());
    for name in world.files() {
        let to = fixtures().join(&name);
        fs::create_dir_all(to.parent().unwrap()).unwrap();
        fs::copy(world.path(&name), to).unwrap();
    }
    // Whatever version 2 will be: what is before the body and after it is in the same places.
    let ours = fs::read(dir.checkpoint(0, GENERATIONS)).unwrap();
    let body = &ours[20..ours.len() - 8];
    fs::write(version_2(), checkpoint_file(2, body)).unwrap();
}

fn version_2() -> PathBuf {
    fixtures().join("version-2.ckpt")
}

fn load(path: &Path) -> Checkpoint<Gene> {
    checkpoint::load(path).unwrap_or_else(|error| panic!("{error}"))
}

/// The records of a log, which are all that it holds.
fn records<T: Serialize + DeserializeOwned>(path: &Path) -> Vec<T> {
    assert!(path.is_file(), "{}", path.display());
    let contents = RecordLog::read(path).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(contents.torn_bytes, 0, "{}", path.display());
    contents.records
}

#[test]
fn a_finished_run_of_format_v1_says_what_it_always_said() {
    let dir = &RUN;
    let config = Config::read(&dir.config()).unwrap();
    config.check().unwrap();
    let last: Vec<Island<Gene>> =
        (0..2).map(|i| load(&dir.checkpoint(i, GENERATIONS)).island).collect();
    let summary: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(dir.summary()).unwrap()).unwrap();
    assert_eq!(summary["digest"], Digest::of(&last).to_string());
    let rows = metrics::read(File::open(dir.metrics()).unwrap()).unwrap();
    let genome = genome_csv::read(&Course::DEFAULT, File::open(dir.champion_genome()).unwrap())
        .unwrap()
        .genome;
    let best = last.iter().map(|it| &it.champion).max_by_key(|it| it.fitness).unwrap();
    assert_eq!(genome, best.genome);

    let mut said = vec![format!("digest {}", Digest::of(&last)), format!("{} rows", rows.len())];
    for (i, island) in (0..).zip(&last) {
        let champions: Vec<Champion<Gene>> = records(&dir.champions(i));
        let entries: Vec<Entry> = records(&dir.reports(i));
        let outboxes: Vec<Outbox<Gene>> = records(&dir.migrations(i));
        assert_eq!(champions.last().unwrap().individual, island.champion);
        let genes = entries.iter().map(|entry| entry.report.statistics.best.get().to_bits());
        let migrants: Vec<usize> = outboxes.iter().map(|outbox| outbox.migrants.len()).collect();
        said.push(format!(
            "island {i}: {} champions, the last {:x}; best {:x?}; migrants {migrants:?}; {:?}",
            champions.len(),
            island.champion.fitness.get().to_bits(),
            genes.collect::<Vec<_>>(),
            island.effort,
        ));
    }
    expect![[r#"
        digest 3282a69b28ca655206d88b446ac6258a1e48bc61e6a9cd5eddaf650b2b04f1b9
        8 rows
        island 0: 2 champions, the last 3ff928b2297524d8; best [3ed5891c6b19b02b, 3ff928b2297524d8, 3ff928b2297524d8, 3ff928b2297524d8]; migrants [2, 2, 2]; Effort { evaluations: 9, reused: 0, outcomes: Outcomes([9, 0, 0, 0, 0, 0, 0]) }
        island 1: 2 champions, the last 3ff928b2297524d8; best [3ec9cf6713256333, 3ec9cf6713256333, 3ec9cf6713256333, 3ff928b2297524d8]; migrants [2, 2, 2]; Effort { evaluations: 6, reused: 3, outcomes: Outcomes([6, 0, 0, 0, 0, 0, 0]) }"#]].assert_eq(&said.join("\n"));
}

#[test]
fn a_checkpoint_of_format_v1_is_written_back_to_the_same_bytes() {
    let dir = &RUN;
    for island in 0..2 {
        for generation in [GENERATIONS - 1, GENERATIONS] {
            let path = dir.checkpoint(island, generation);
            let found = load(&path);
            assert_eq!((found.island.index, found.island.generation), (island, generation));
            assert_eq!(checkpoint::to_bytes(&found), fs::read(path).unwrap());
        }
    }
}

#[test]
fn a_checkpoint_of_format_v2_is_refused_by_its_version() {
    let _ = &*RUN;
    let path = version_2();
    let error = checkpoint::load::<Gene>(&path).unwrap_err().to_string();
    let expected = "has format version 2, and this program reads version 1";
    assert_eq!(error, format!("{} {expected}", path.display()));
}
