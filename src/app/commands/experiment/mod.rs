//! `islands experiment`: settings are compared, each over many seeds.
//!
//! A [`definition`] is read, and every run of it checked before the first is begun. [`workers`] do those that an
//! [`archive`] does not hold yet, each [`trial`] in lockstep in this process, and [`progress`] shows how many. Then
//! an [`analysis`] of all is laid out in [`tables`] and drawn.

mod analysis;
mod archive;
mod args;
mod definition;
mod progress;
mod tables;
#[cfg(test)]
mod tests;
mod trial;
mod workers;

pub use args::ExperimentArgs;

use crate::app::console::{print, say};
use crate::app::processes::parent_link::StopSignal;
use crate::app::table::lay_out;
use crate::runs::Failure;
use crate::runs::config::{FILE_BYTES_MAX, THREADS_MAX};
use crate::store::{ExperimentDir, StoreError, file};
use analysis::{Comparison, Summary};
use archive::Run;
use definition::{Definition, Plan};
use progress::Progress;
use serde::Serialize;
use std::path::{Path, PathBuf};
use workers::Job;

/// Runs what is missing of an experiment, and writes its results.
///
/// # Errors
/// With exit code 2, before anything was run, if it makes no sense; with 130 if it was interrupted.
pub fn run(args: &ExperimentArgs) -> Result<(), Failure> {
    let threads = threads(args)?;
    let definition = Definition::read(&args.file)?;
    let plan = definition.plan().map_err(|reason| {
        Failure::usage(format!("cannot use {}: {reason}", args.file.display()))
    })?;
    let dir = ExperimentDir::at(folder(args)?);
    let stop = StopSignal::from_signals()?;
    let _claim = dir.claim().map_err(|error| match error {
        StoreError::UnderWay { .. } => Failure::usage(format!(
            "the experiment in {} is under way in another process",
            dir.path().display()
        )),
        error => Failure::usage(format!("{error}; choose another folder with --out")),
    })?;
    let mut found = found(&dir, &plan)?;
    let has_changed = renew(&dir, &definition)?;
    let kept = found.iter().flatten().flatten().count();
    if !args.quiet {
        announce(&plan, kept, has_changed);
    }
    complete(&dir, &plan, &mut found, threads, &stop, args)?;
    let runs: Vec<Vec<Run>> =
        found.into_iter().map(|runs| runs.into_iter().flatten().collect()).collect();
    let result = Outcome::of(&plan, &runs, &dir, kept);
    result.write(&dir, &plan, &runs)?;
    result.present(args.json);
    Ok(())
}

fn threads(args: &ExperimentArgs) -> Result<usize, Failure> {
    match args.threads {
        None => Ok(std::thread::available_parallelism().map_or(1, usize::from)),
        Some(threads) if (1..=THREADS_MAX).contains(&threads) => Ok(threads),
        Some(_) => Err(Failure::usage(format!("--threads must be from 1 to {THREADS_MAX}"))),
    }
}

fn folder(args: &ExperimentArgs) -> Result<PathBuf, Failure> {
    let stem = args.file.file_stem().unwrap_or_default();
    let folder = args.out.clone().unwrap_or_else(|| Path::new("experiments").join(stem));
    match folder.to_str() {
        Some(_) => Ok(folder),
        None => Err(Failure::usage("the folder's name is not UTF-8: choose another with --out")),
    }
}

/// The runs that have finished, of each setting and seed.
fn found(dir: &ExperimentDir, plan: &Plan) -> Result<Vec<Vec<Option<Run>>>, StoreError> {
    let each = plan.settings.iter();
    each.map(|setting| {
        plan.seeds.iter().map(|&seed| archive::load(dir, plan, setting, seed)).collect()
    })
    .collect()
}

/// Writes the definition, and says whether there was another one.
fn renew(dir: &ExperimentDir, definition: &Definition) -> Result<bool, Failure> {
    let new = definition.to_toml();
    let old = file::read_text(&dir.definition(), FILE_BYTES_MAX).ok();
    if old.as_ref() != Some(&new) {
        dir.write(&dir.definition(), |out| out.write_all(new.as_bytes()))?;
    }
    Ok(old.is_some_and(|old| old != new))
}

fn announce(plan: &Plan, kept: usize, has_changed: bool) {
    let all = plan.settings.len() * plan.seeds.len();
    let missing = all - kept;
    if has_changed {
        say(&format!(
            "the definition has changed: of its {all} runs {kept} are there already and {missing} are to be run; \
             what only the old one asked for stays in the folder, but not in the results"
        ));
    } else if kept > 0 {
        say(&format!("{kept} of {all} runs are there already"));
    }
}

/// Does the runs that are missing.
fn complete(
    dir: &ExperimentDir,
    plan: &Plan,
    found: &mut [Vec<Option<Run>>],
    threads: usize,
    stop: &StopSignal,
    args: &ExperimentArgs,
) -> Result<(), Failure> {
    let jobs = missing(plan, found);
    let all = plan.settings.len() * plan.seeds.len();
    let mut progress = Progress::new(all - jobs.len(), all, args.quiet || jobs.is_empty());
    let worked =
        workers::work_off(&jobs, plan.evaluations, threads, stop, |job, trial, seconds| {
            let setting = &plan.settings[job.setting];
            let run = Run { seed: job.seed, key: plan.key(setting, job.seed), seconds, trial };
            archive::save(dir, &run)?;
            let best = run.trial.worth();
            let (name, seed) = (&setting.name, job.seed);
            progress.advance(&format!("{name}  seed {seed}  best {best}  {seconds:.1} s"));
            let place = plan.seeds.iter().position(|&seed| seed == job.seed);
            found[job.setting][place.expect("a job has a seed of the plan")] = Some(run);
            Ok(())
        });
    progress.finish();
    worked?;
    let done = found.iter().flatten().flatten().count();
    if done < all {
        return Err(Failure::interrupted(format!(
            "interrupted: {done} of {all} runs are kept in {}; the same command goes on",
            dir.path().display()
        )));
    }
    Ok(())
}

/// What is to be done, seed by seed, so that what is there after an interruption is of all settings.
fn missing(plan: &Plan, found: &[Vec<Option<Run>>]) -> Vec<Job> {
    let places = (0..plan.seeds.len()).flat_map(|s| (0..plan.settings.len()).map(move |i| (i, s)));
    let missing = places.filter(|&(setting, seed)| found[setting][seed].is_none());
    missing
        .map(|(setting, seed)| {
            let seed = plan.seeds[seed];
            Job { setting, seed, config: plan.settings[setting].config(seed) }
        })
        .collect()
}

/// What came of it all.
#[derive(Serialize)]
struct Outcome {
    /// The folder.
    out: String,
    /// All runs.
    runs: usize,
    /// Those of them that had been there already.
    kept: usize,
    /// The unit of fitness.
    unit: String,
    settings: Vec<Summary>,
    comparisons: Vec<Comparison>,
    version: &'static str,
}

impl Outcome {
    fn of(plan: &Plan, runs: &[Vec<Run>], dir: &ExperimentDir, kept: usize) -> Self {
        let first = runs.iter().flatten().next();
        Self {
            out: dir.path().display().to_string(),
            runs: runs.iter().map(Vec::len).sum(),
            kept,
            unit: first.map(|run| run.trial.unit.clone()).unwrap_or_default(),
            settings: analysis::summaries(plan, runs),
            comparisons: analysis::comparisons(plan, runs),
            version: env!("CARGO_PKG_VERSION"),
        }
    }

    fn write(&self, dir: &ExperimentDir, plan: &Plan, runs: &[Vec<Run>]) -> Result<(), Failure> {
        let Self { settings, comparisons, .. } = self;
        let files = [
            ("runs.csv", tables::runs_csv(plan, runs)),
            ("curves.csv", tables::curves_csv(plan, runs)),
            ("summary.csv", tables::summary_csv(settings)),
            ("comparisons.csv", tables::comparisons_csv(comparisons)),
            ("summary.md", tables::summary_md(plan, &self.unit, settings, comparisons).into()),
            ("convergence.svg", analysis::convergence(plan, runs).to_svg().into()),
        ];
        for (name, bytes) in files {
            dir.write(&dir.path().join(name), |out| out.write_all(&bytes))?;
        }
        Ok(())
    }

    fn present(&self, as_json: bool) {
        if as_json {
            print(&serde_json::to_string(self).expect("it is plain data"));
            return;
        }
        print(&lay_out(&tables::settings(&self.settings)));
        if !self.comparisons.is_empty() {
            print("");
            print(&lay_out(&tables::pairs(&self.comparisons)));
        }
        print(&format!("\nfiles    {}", self.out));
    }
}
