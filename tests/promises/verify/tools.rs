//! Doing harm to a copy of a run, and looking whether it is found.

use crate::support::{Ending, TINY, World};
use islands::creature::Gene;
use islands::evolution::Fitness;
use islands::store::{Checkpoint, RecordLog, RunDir, checkpoint};
use serde::{Serialize, de::DeserializeOwned};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::SystemTime;

/// A world in which two islands have evolved in the folder `run`.
pub fn evolved() -> World {
    let world = World::new();
    world.digest("run", &format!("--n 2 --seed 3 {TINY}"));
    world
}

/// A copy of that run which something is done to.
pub fn changed(world: &World, change: impl FnOnce(&RunDir)) -> RunDir {
    let path = world.path("changed");
    if path.exists() {
        fs::remove_dir_all(&path).unwrap();
    }
    let copied = Command::new("cp").arg("-a").arg(world.path("run")).arg(&path).status().unwrap();
    assert!(copied.success());
    let dir = RunDir::at(path);
    change(&dir);
    dir
}

/// Verifies, which must change no file.
pub fn verify(world: &World, arguments: &str) -> Ending {
    let before = contents(&world.path(""));
    let ending = world.islands(&format!("verify {arguments}"));
    assert!(contents(&world.path("")) == before, "verify changed something");
    ending
}

/// Changes a copy of the run and verifies it: something must be found, and that file be named.
pub fn finds(
    world: &World,
    file: impl FnOnce(&RunDir) -> PathBuf,
    change: impl FnOnce(&RunDir),
) -> Value {
    changed(world, change);
    let ending = verify(world, "changed --json");
    let verdict = ending.json();
    assert_eq!((ending.code, &verdict["ok"]), (Some(1), &false.into()), "{ending:?}");
    let file = file(&RunDir::at("changed"));
    let name = file.to_str().unwrap();
    let named = |said: &Value| said.as_str().unwrap().contains(name);
    assert!(verdict["damaged"].as_array().unwrap().iter().any(named), "{name}: {verdict}");
    let sentence =
        ending.stderr.strip_prefix("error: the run in changed does not hold what it claims");
    assert_eq!(sentence.unwrap().trim_end().lines().count(), 1, "{ending:?}");
    verdict
}

/// Every file below a folder: its bytes and when it was changed.
fn contents(folder: &Path) -> BTreeMap<PathBuf, (Vec<u8>, SystemTime)> {
    let mut contents = BTreeMap::new();
    let mut left = vec![folder.to_owned()];
    while let Some(path) = left.pop() {
        let status = fs::symlink_metadata(&path).unwrap();
        if status.is_dir() {
            left.extend(fs::read_dir(&path).unwrap().map(|entry| entry.unwrap().path()));
        }
        let bytes = if status.is_file() { fs::read(&path).unwrap() } else { Vec::new() };
        contents.insert(path, (bytes, status.modified().unwrap()));
    }
    contents
}

/// Flips a bit of the byte at a place that the file's length decides.
pub fn flip(path: &Path, at: impl FnOnce(usize) -> usize) {
    let mut bytes = fs::read(path).unwrap();
    let at = at(bytes.len());
    bytes[at] ^= 1;
    fs::write(path, bytes).unwrap();
}

/// Cuts bytes off the end.
pub fn cut(path: &Path, bytes: usize) {
    let whole = fs::read(path).unwrap();
    fs::write(path, &whole[..whole.len() - bytes]).unwrap();
}

/// Adds what is no whole record.
pub fn lengthen(path: &Path) {
    let bytes = [fs::read(path).unwrap(), vec![0xee; 7]].concat();
    fs::write(path, bytes).unwrap();
}

/// Writes a log again, with right checksums.
pub fn forge<T: Serialize + DeserializeOwned>(path: &Path, forge: impl FnOnce(&mut Vec<T>)) {
    let mut records = RecordLog::<T>::read(path).unwrap().records;
    forge(&mut records);
    let mut log = RecordLog::open(path).unwrap();
    log.truncate(0).unwrap();
    records.iter().for_each(|record| log.append(record).unwrap());
}

/// Writes a checkpoint again, with a right checksum.
pub fn forge_state(
    dir: &RunDir,
    island: u32,
    generation: u32,
    forge: impl FnOnce(&mut Checkpoint<Gene>),
) {
    let path = dir.checkpoint(island, generation);
    let mut saved = checkpoint::load(&path).unwrap();
    forge(&mut saved);
    checkpoint::save(dir.path(), &path, &saved).unwrap();
}

/// The next better fitness that there is.
pub fn a_bit_more(fitness: &mut Fitness) {
    *fitness = Fitness::new(fitness.get().next_up());
}
