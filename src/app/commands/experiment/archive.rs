//! The runs that have finished, a file each.

use super::definition::{Plan, Setting};
use super::trial::Trial;
use crate::runs::Failure;
use crate::store::{ExperimentDir, StoreError, file};
use serde::{Deserialize, Serialize};
use std::io::ErrorKind;
use std::path::PathBuf;

/// No file of a run is larger, in bytes: a generation takes some hundred.
const RUN_BYTES_MAX: usize = 1 << 30;

/// A run that has finished.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Run {
    /// Its seed.
    pub seed: u64,
    /// The hash of all that decided it.
    pub key: String,
    /// How long it took; the only thing that is not fixed by the others.
    pub seconds: f64,
    /// What it came to.
    pub trial: Trial,
}

/// Where a run lies.
pub fn path(dir: &ExperimentDir, plan: &Plan, setting: &Setting, seed: u64) -> PathBuf {
    dir.run(seed, &plan.key(setting, seed))
}

/// The run of a setting with a seed, if it has finished. What is damaged has not.
///
/// # Errors
/// If it is there, but cannot be read.
pub fn load(
    dir: &ExperimentDir,
    plan: &Plan,
    setting: &Setting,
    seed: u64,
) -> Result<Option<Run>, StoreError> {
    let bytes = match file::read(&path(dir, plan, setting, seed), RUN_BYTES_MAX) {
        Err(StoreError::Io { source, .. }) if source.kind() == ErrorKind::NotFound => {
            return Ok(None);
        }
        bytes => bytes?,
    };
    let is_it = |run: &Run| {
        let rises = run.trial.curve.is_sorted_by_key(|point| point.evaluations);
        rises
            && !run.trial.curve.is_empty()
            && run.seed == seed
            && run.key == plan.key(setting, seed)
    };
    Ok(serde_json::from_slice(&bytes).ok().filter(is_it))
}

/// Keeps a run.
///
/// # Errors
/// If it cannot be written.
pub fn save(dir: &ExperimentDir, run: &Run) -> Result<(), Failure> {
    let path = dir.run(run.seed, &run.key);
    Ok(dir.write(&path, |out| Ok(serde_json::to_writer(out, run)?))?)
}
